#!/usr/bin/python3
"""Designs of OpenRocket and RASAero II: what is read from them, and what is refused. The files are written here."""

from __future__ import annotations

import gzip
import math
import sys
import tempfile
import unittest
import zipfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))

from meshing.missile import Missile
from meshing.openrocket import read_openrocket
from meshing.rasaero import read_rasaero
from meshing.toml_file import DescriptionError

NOSE = "<nosecone><length>0.2</length><shape>ogive</shape><shapeparameter>1.0</shapeparameter><aftradius>auto</aftradius></nosecone>"
FINS = (
    '<trapezoidfinset><fincount>3</fincount><rotation>20</rotation><axialoffset method="bottom">-0.01</axialoffset>'
    "<thickness>0.002</thickness><crosssection>square</crosssection><cant>0</cant><rootchord>0.08</rootchord><tipchord>0.04</tipchord>"
    "<sweeplength>0.05</sweeplength><height>0.06</height></trapezoidfinset>"
)
TUBE = "<bodytube><length>0.5</length><radius>0.025</radius><subcomponents>{}</subcomponents></bodytube>"
TAIL = "<transition><length>0.05</length><shape>conical</shape><foreradius>auto</foreradius><aftradius>0.02</aftradius></transition>"


def design(*stages: str, after: str = "") -> str:
    inside = "".join(f"<stage><name>s</name><subcomponents>{parts}</subcomponents></stage>" for parts in stages)
    return f'<openrocket version="1.9"><rocket><name>Try</name><subcomponents>{inside}</subcomponents></rocket>{after}</openrocket>'


class Rockets(unittest.TestCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def rocket(self, text: str, stages: list[int] | None = None) -> Missile:
        file = self.folder / "try.ork"
        file.write_text(text)
        return read_openrocket(file, stages)

    def refused(self, text: str, *words: str) -> None:
        with self.assertRaises(DescriptionError) as caught:
            self.rocket(text)
        for word in ("try.ork", *words):
            self.assertIn(word, str(caught.exception))

    def test_body_and_fins(self) -> None:
        missile = self.rocket(design(NOSE + TUBE.format(FINS) + TAIL))
        self.assertEqual([segment.name for segment in missile.body.segments], ["nose", "body", "boattail"])
        self.assertAlmostEqual(missile.body.length, 0.75)
        np.testing.assert_allclose(missile.body.radius(np.array([0.2, 0.7, 0.75])), [0.025, 0.025, 0.02], atol=1e-12)
        panel = missile.panels[0]
        self.assertEqual((len(missile.panels), panel.roll), (3, 20.0))
        # From the tube's aft end: 0.7 - 0.01 - 0.08.
        np.testing.assert_allclose([panel.x, panel.root, panel.planform.span, panel.planform.lead[1]], [0.61, 0.025, 0.06, 0.05])
        self.assertTrue(any("square" in note for note in missile.notes) and any("centre of gravity" in note for note in missile.notes))

    def test_packed_in_every_way(self) -> None:
        text = design(NOSE + TUBE.format(FINS))
        plain, packed, zipped = (self.folder / f"{name}.ork" for name in ("plain", "packed", "zipped"))
        plain.write_text(text)
        packed.write_bytes(gzip.compress(text.encode()))
        with zipfile.ZipFile(zipped, "w") as archive:
            archive.writestr("decals/a.png", "no picture")
            archive.writestr("rocket.ork", text)
        for file in (plain, packed, zipped):
            self.assertAlmostEqual(read_openrocket(file).body.length, 0.7)
        zipped.write_bytes(zipped.read_bytes()[:100])
        with self.assertRaisesRegex(DescriptionError, "damaged"):
            read_openrocket(zipped)

    def test_old_positions_and_free_form_fins(self) -> None:
        points = "".join(f'<point x="{x}" y="{y}"/>' for x, y in ((0, 0), (0.03, 0.04), (0.07, 0.04), (0.06, 0)))
        fins = (
            '<freeformfinset><position type="top">0.3</position><fincount>4</fincount><rotation>45</rotation><thickness>0.003</thickness>'
            f"<crosssection>rounded</crosssection><finpoints>{points}</finpoints></freeformfinset>"
        )
        panel = self.rocket(design(NOSE + TUBE.format(fins))).panels[0]
        # Polygon by the shoelace formula: 0.04 * (0.06 + 0.04) / 2.
        self.assertAlmostEqual(panel.planform.area, 0.002, delta=1e-5)
        self.assertAlmostEqual(panel.x, 0.5)

    def test_stages_by_choice(self) -> None:
        text = design(NOSE + TUBE.format(FINS), TUBE.format(FINS))
        self.assertAlmostEqual(self.rocket(text).body.length, 1.2)
        self.assertEqual(len(self.rocket(text).panels), 6)
        self.assertAlmostEqual(self.rocket(text, [1]).body.length, 0.7)
        with self.assertRaisesRegex(DescriptionError, "has 2 stages"):
            self.rocket(text, [3])

    def test_centre_of_gravity_of_a_simulation(self) -> None:
        data = '<simulations><simulation><flightdata><databranch types="Time,CG location"><datapoint>0,0.41</datapoint></databranch>'
        text = design(NOSE + TUBE.format(FINS), after=data + "</flightdata></simulation></simulations>")
        self.assertEqual(self.rocket(text).reference.moment_center[0], 0.41)

    def test_a_cone_of_base_drag_is_left_out(self) -> None:
        cone = TAIL.replace("<foreradius>auto", "<foreradius>0.00001")
        missile = self.rocket(design(NOSE + TUBE.format(FINS) + cone))
        self.assertAlmostEqual(missile.body.length, 0.7)
        self.assertTrue(any("base drag" in note for note in missile.notes))

    def test_clipped_transition_is_the_end_of_a_longer_nose(self) -> None:
        flare = TAIL.replace("conical", "ellipsoid").replace("0.02<", "0.05<")
        outline = self.rocket(design(NOSE + TUBE.format("") + flare)).body.outline()
        x, r = outline[outline[:, 0] > 0.7 + 1e-9].T
        # An ellipse of half axes a and 0.05 that ends at x = 0.75 and has the radius 0.025 at 0.7.
        a = 0.05 / math.sqrt(0.75)
        np.testing.assert_allclose(r, 0.05 * np.sqrt(1.0 - ((0.75 - x) / a) ** 2), atol=2e-5)

    def test_what_is_refused(self) -> None:
        self.refused(design(NOSE + TUBE.format("<tubefinset/>")), "tube fins are not modelled")
        self.refused(design(TUBE.format("")), "flat end")
        self.refused("<openrocket/>", "no design of OpenRocket")
        self.refused("<openrocket", "is not XML")
        self.refused(design(NOSE.replace("0.2<", "x<") + TUBE.format("")), "no usable <length>")

    def test_rasaero(self) -> None:
        fin = (
            "<Fin><Count>4</Count><Chord>2</Chord><Span>1.5</Span><SweepDistance>1</SweepDistance><TipChord>1</TipChord>"
            "<Thickness>0.1</Thickness><Location>2.5</Location><AirfoilSection>Double Wedge</AirfoilSection></Fin>"
        )
        text = (
            "<RASAeroDocument><RocketDesign><NoseCone><Length>6</Length><Diameter>2</Diameter><Shape>Von Karman Ogive</Shape></NoseCone>"
            f"<BodyTube><Length>20</Length><Diameter>2</Diameter><BoattailLength>1</BoattailLength><BoattailRearDiameter>1.5</BoattailRearDiameter>{fin}"
            "</BodyTube><UseBooster1>False</UseBooster1></RocketDesign></RASAeroDocument>"
        )
        file = self.folder / "try.CDX1"
        file.write_text(text)
        missile = read_rasaero(file)
        self.assertAlmostEqual(missile.body.length, 27 * 0.0254)
        self.assertAlmostEqual(missile.body.base_radius, 0.75 * 0.0254)
        # From the tube's aft end at 26 inches; a section 5 % thick.
        self.assertAlmostEqual(missile.panels[0].x, 23.5 * 0.0254)
        np.testing.assert_allclose(missile.panels[0].planform.thickness / missile.panels[0].planform.chord, 0.05)
        file.write_text(text.replace("Von Karman Ogive", "Strange"))
        with self.assertRaisesRegex(DescriptionError, "'Strange' is not known"):
            read_rasaero(file)


if __name__ == "__main__":
    unittest.main()
