#!/usr/bin/python3
"""Descriptions of missiles: what they say, and what is refused, with line and remedy."""

from __future__ import annotations

import math
import sys
import tempfile
import tomllib
import unittest
from pathlib import Path
from types import SimpleNamespace

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))

from meshing import planforms, profiles
from meshing.case_file import controls
from meshing.description import SCHEMAS, describe_keys, read_description
from meshing.missile import Missile
from meshing.sections import KINDS, Section
from meshing.toml_file import DescriptionError

BODY = '[[body]]\nshape = "cone"\nlength = 3\ndiameter = 1\n[[body]]\nshape = "cylinder"\nlength = 7\n'
FINS = "[[fins]]\nnumber = 4\nx_end = 10\nroot_chord = 1\nspan = 1\nthickness = 0.08\n"


class Described(unittest.TestCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.file = Path(temporary.name) / "missile.toml"

    def read(self, text: str) -> Missile:
        self.file.write_text(text)
        return read_description(self.file)

    def refused(self, text: str, line: int, *words: str) -> None:
        """The description is refused with one message, which names the line and says all of `words`."""
        with self.assertRaises(DescriptionError) as caught:
            self.read(text)
        self.assertEqual(len(caught.exception.problems), 1, caught.exception.problems)
        for word in (f"{self.file}:{line}:", *words):
            self.assertIn(word, str(caught.exception))


class Reading(Described):
    def test_reference_and_moment_center_by_default(self) -> None:
        missile = self.read(BODY)
        self.assertEqual(missile.reference.length, 1.0)
        self.assertAlmostEqual(missile.reference.area, math.pi / 4.0)
        self.assertEqual(missile.reference.moment_center, (5.0, 0.0, 0.0))
        self.assertTrue(any("no moment_center" in note for note in missile.notes))

    def test_names_of_components(self) -> None:
        missile = self.read(BODY + '[[body]]\nshape = "cone"\nlength = 1\ndiameter = 0.8\n[[body]]\nshape = "cylinder"\nlength = 1\n')
        self.assertEqual([segment.name for segment in missile.body.segments], ["nose", "body", "boattail", "body_2"])

    def test_panels_with_a_hinge_are_controls(self) -> None:
        """Their hinge lines, and signs so that pitch lifts, yaw pushes to starboard and roll turns one way round."""
        made = lambda missile, model: SimpleNamespace(model=model, mesh=SimpleNamespace(patches=[panel.name for panel in missile.panels]))
        text = lambda missile, model: tomllib.loads("\n".join(controls(missile, made(missile, model))))
        missile = self.read(BODY + FINS + "hinge = 0.4\n")
        full = text(missile, "full")
        self.assertEqual([control["name"] for control in full["controls"]], ["fin_1", "fin_2", "fin_3", "fin_4"])
        up, starboard = full["controls"][:2]
        self.assertEqual((up["patches"], up["hinge"]), (["fin_1"], {"point": [9.4, 0, 0.5], "axis": [0, 0, 1]}))
        self.assertEqual(starboard["hinge"], {"point": [9.4, 0.5, 0], "axis": [0, 1, 0]})
        axes = {control["name"]: np.array(control["hinge"]["axis"], dtype=float) for control in full["controls"]}
        forces = {name: np.cross([1, 0, 0], axis) for name, axis in axes.items()}  # where a positive deflection pushes
        push = lambda name: sum(share * forces[panel] for panel, share in full["control_sets"][f"fin_{name}"].items())
        np.testing.assert_allclose([push("pitch"), push("yaw"), push("roll")], [[0, 0, 2], [0, 2, 0], [0, 0, 0]], atol=1e-12)
        turn = {panel: np.cross(axes[panel], forces[panel])[0] for panel in axes}
        self.assertEqual({share * turn[panel] for panel, share in full["control_sets"]["fin_roll"].items()}, {1.0})
        half = text(missile, "half")  # those up and down cannot turn there
        self.assertEqual([control["name"] for control in half["controls"]], ["fin_2", "fin_4"])
        self.assertEqual(list(half["control_sets"]), ["fin_pitch"])
        self.assertEqual(text(self.read(BODY + FINS), "full"), {})
        wing = self.read(BODY + "[[wings]]\nx = 5\nroot_chord = 1\nspan = 1\nthickness = 0.05\nhinge = 0.5\n")
        self.assertEqual(text(wing, "full")["control_sets"]["wing_pitch"], {"wing_1": 1, "wing_2": -1})

    def test_where_panels_stand(self) -> None:
        # The second of four from up (z) towards starboard (y) is to starboard; x_end - root_chord is the leading edge.
        panel = self.read(BODY + FINS).panels[1]
        corner = panel.to_space(np.array([[0.0, panel.root, 0.0], [1.0, panel.tip, 0.0]]))
        np.testing.assert_allclose(corner, [[9.0, 0.5, 0.0], [10.0, 1.5, 0.0]], atol=1e-12)

    def test_positive_deflection_raises_the_leading_edge_of_the_starboard_panel(self) -> None:
        panel = self.read(BODY + FINS + "deflection = [0, 10, 0, -10]\n").panels[1]
        lead = panel.to_space(np.array([[0.0, 1.0, 0.0]]))[0]
        self.assertAlmostEqual(lead[2], 0.5 * math.sin(math.radians(10.0)))
        np.testing.assert_allclose(panel.to_local(lead[None]), [[0.0, 1.0, 0.0]], atol=1e-12)

    def test_symmetries_are_those_that_are_there(self) -> None:
        for more, wanted in (
            ("", (True, True)), ("roll = 45\n", (True, True)), ("roll = 10\n", (False, False)), ("cant = 1\n", (False, False)),
            ("deflection = [0, 5, 0, -5]\n", (True, False)), ("deflection = [5, 0, -5, 0]\n", (False, True)),
            ("deflection = [0, 5, 0, 5]\n", (False, False)),
        ):  # fmt: skip
            missile = self.read(BODY + FINS + more)
            self.assertEqual((missile.is_symmetric(1), missile.is_symmetric(2)), wanted, more)
        three = self.read(BODY + FINS.replace("number = 4", "number = 3"))
        self.assertEqual((three.is_symmetric(1), three.is_symmetric(2)), (True, False))

    def test_wings_are_each_others_mirror_image(self) -> None:
        wings = FINS.replace("[[fins]]\nnumber = 4", "[[wings]]")
        wings = wings.replace("thickness = 0.08", "thickness_ratio = 0.12") + 'section = "naca"\ncamber = 0.02\n'
        missile = self.read(BODY + wings + "dihedral = 5\nincidence = 2\nheight = -0.2\n")
        self.assertEqual((missile.is_symmetric(1), missile.is_symmetric(2)), (True, False))
        one, other = missile.panels
        local = np.array([[0.2, 1.2, 0.05], [0.9, 0.8, -0.02]])
        np.testing.assert_allclose(one.to_space(local) * [1.0, -1.0, 1.0], other.to_space(local), atol=1e-12)
        self.assertGreater(one.to_space(np.array([[0.5, one.tip, 0.0]]))[0, 2], -0.2)  # dihedral goes up

    def test_every_key_is_described(self) -> None:
        text = describe_keys()
        for _, schema in SCHEMAS.values():
            for key in schema:
                self.assertIn(f"  {key} ", text)


class Refusals(Described):
    def test_values_and_keys(self) -> None:
        self.refused(BODY + FINS + "sapn = 2\n", 14, "no key 'sapn'", "did you mean 'span'?")
        self.refused(BODY.replace("length = 3", "length = -3"), 3, "length = -3", "above 0")
        self.refused(BODY.replace('"cone"', '"kone"'), 2, "kone", "did you mean 'cone'?")
        self.refused(BODY + FINS.replace("number = 4", "number = 4.5"), 9, "number = 4.5", "whole number")
        self.refused(BODY + FINS.replace("root_chord = 1\n", ""), 8, "needs the key 'root_chord'")
        self.refused(BODY + FINS.replace("x_end = 10", "x_end = 11.1"), 10, "must stand on the body")
        self.refused(BODY + FINS + "x = 9\n", 14, "either 'x'")
        self.refused(BODY + FINS + "deflection = [1, 2]\n", 14, "2 values for 4 panels")
        self.refused(BODY + FINS + "bevel = 0.1\n", 14, "no bevels")
        self.refused(BODY + FINS + "hinge = 1.2\n", 14, "at most the root chord, 1")
        self.refused(BODY + FINS + "hinge = -0.1\n", 14, "at least 0")
        self.refused(BODY + '[flight]\nmach = [2, 1.5]\n', 9, "lowest Mach number comes first")
        self.refused(BODY + "[[body]]\nshape = \"cylinder\"\n", 8, "needs the key 'length'")
        self.refused(BODY.replace("[[body]]", "[body]", 1).split("[[body]]")[0], 1, "[[body]]", "two brackets")
        self.refused('title = "x"\nflight = {mach = -1}\n' + BODY, 2, "mach = -1", "each a number above 0")
        self.refused("unit = 3\n" + BODY, 1, "unit = 3", "one of m, mm")
        self.refused("title = \"x\n", 1, "is not TOML")

    def test_all_mistakes_are_told_at_once(self) -> None:
        with self.assertRaises(DescriptionError) as caught:
            self.read(BODY.replace("diameter = 1", "diameter = true") + FINS.replace("span = 1", "span = 0"))
        self.assertEqual(len(caught.exception.problems), 2)

    def test_a_missing_file(self) -> None:
        with self.assertRaisesRegex(DescriptionError, "No such file"):
            read_description(self.file)


class Profiles(unittest.TestCase):
    def test_shapes_reach_from_tip_to_shoulder(self) -> None:
        x = np.linspace(0.0, 1.0, 101)
        for shape in (profiles.haack(0.0), profiles.haack(1 / 3), profiles.power(0.5), profiles.elliptic(), profiles.parabolic(1.0),
                      profiles.ogive(3.0), profiles.ogive(3.0, 0.5)):  # fmt: skip
            r = shape(x)
            np.testing.assert_allclose([r[0], r[-1]], [0.0, 1.0], atol=1e-12)
            self.assertTrue(np.all(np.diff(r) > -1e-12))

    def test_tangent_ogive(self) -> None:
        # A circle of radius (L^2 + R^2) / 2R, tangent to the cylinder: r(L/2) by Pythagoras.
        rho = 0.5 * (9.0 + 1.0)
        self.assertAlmostEqual(float(profiles.ogive(3.0)(np.array([0.5]))[0]), math.sqrt(rho**2 - 1.5**2) - (rho - 1.0), places=12)

    def test_von_karman_has_its_volume(self) -> None:
        # Integration of the ordinates by parts: half of the cylinder around it.
        x = np.linspace(0.0, 1.0, 20001)
        r = profiles.haack(0.0)(x)
        self.assertAlmostEqual(float(np.mean(0.5 * (r[1:] ** 2 + r[:-1] ** 2))), 0.5, places=6)

    def test_blunted_noses_touch_sphere_and_shoulder(self) -> None:
        for kind in ("cone", "tangent_ogive"):
            cap, rest = profiles.blunted("nose", kind, 2.0, 0.5, 0.1).pieces
            np.testing.assert_allclose(np.hypot(cap.points[:, 0] - 0.1, cap.points[:, 1]), 0.1, atol=1e-9)
            np.testing.assert_allclose(rest.points[-1], [2.0, 0.5], atol=1e-9)
            fine = profiles.fine(rest.points)
            slope = (fine[1] - fine[0]) / np.hypot(*(fine[1] - fine[0]))
            radial = (rest.points[0] - [0.1, 0.0]) / 0.1
            self.assertAlmostEqual(float(slope @ radial), 0.0, delta=5e-3)  # no corner where they meet


class Fins(unittest.TestCase):
    def test_sections_have_their_thickness(self) -> None:
        for kind in KINDS:
            upper, lower = Section(kind, bevels=(0.2, 0.2)).outline(2.0, 0.1)
            self.assertAlmostEqual(float((upper[:, 1] - lower[:, 1]).max()), 0.1, delta=1e-4, msg=kind)
            np.testing.assert_allclose([upper[0, 0], upper[-1, 0]], [0.0, 2.0], atol=1e-12)

    def test_naca_2412(self) -> None:
        # Report 460: highest camber 2 % at 40 %, thickness 12 %.
        upper, lower = Section("naca", camber=0.02, camber_place=0.4).outline(1.0, 0.12)
        x = np.linspace(0.0, 1.0, 2001)
        middle = 0.5 * (np.interp(x, *upper.T) + np.interp(x, *lower.T))
        self.assertAlmostEqual(float(middle.max()), 0.02, delta=4e-4)
        self.assertAlmostEqual(float(x[middle.argmax()]), 0.4, delta=0.05)

    def test_polygon_becomes_stations(self) -> None:
        made = planforms.polygon([(0.0, 0.0), (1.0, 1.0), (1.5, 1.0), (1.4, 0.5), (1.2, 0.0)])
        exact = 0.5 * abs(sum(a * d - b * c for (a, b), (c, d) in zip(
            [(0, 0), (1, 1), (1.5, 1), (1.4, 0.5), (1.2, 0)], [(1, 1), (1.5, 1), (1.4, 0.5), (1.2, 0), (0, 0)])))  # fmt: skip
        self.assertAlmostEqual(made.area, exact, delta=2e-3 * exact)

    def test_ellipse_keeps_its_area(self) -> None:
        # Half an ellipse, pi / 4 times root chord and span; what is cut at the tip and by straight stretches is 2 %.
        self.assertAlmostEqual(planforms.ellipse(1.0, 0.5).area, 0.25 * math.pi * 0.5, delta=0.02 * 0.25 * math.pi * 0.5)


if __name__ == "__main__":
    unittest.main()
