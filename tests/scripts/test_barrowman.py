#!/usr/bin/python3
"""Barrowman's method beside the formulas as they are published, in closed form, for a rocket of each of the usual parts.

J. S. and J. A. Barrowman, The Theoretical Prediction of the Center of Pressure, NARAM-8, 1966.
"""

from __future__ import annotations

import math
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))

from barrowman import neutral_point
from meshing.description import read_description

NOSE = '[[body]]\nshape = "{}"\nlength = 3\ndiameter = 1\n'
TUBE = '[[body]]\nshape = "cylinder"\nlength = 7\n'
BOATTAIL = '[[body]]\nshape = "cone"\nlength = 0.8\ndiameter = 0.6\n'
FINS = "[[fins]]\nnumber = {}\nroll = {}\nx = 8\nroot_chord = 1.5\ntip_chord = 0.7\nspan = 0.9\nsweep = {}\nthickness = 0.05\n"
SWEPT = 0.6  # of the tip's leading edge behind the root's


class Barrowman(unittest.TestCase):
    def method(self, text: str) -> tuple[float, float]:
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder, "missile.toml")
            file.write_text(text)
            return neutral_point(read_description(file))

    def fins(self, number: int, roll: float) -> str:
        return FINS.format(number, roll, math.degrees(math.atan2(SWEPT, 0.9)))

    def test_nose(self) -> None:
        slope, point = self.method(NOSE.format("cone") + TUBE)
        self.assertAlmostEqual(slope, 2.0, places=9)
        self.assertAlmostEqual(point, 2.0 / 3.0 * 3.0, places=9)
        # 0.466 of the length is for slender ones; this one is 3 calibres long.
        self.assertAlmostEqual(self.method(NOSE.format("tangent_ogive") + TUBE)[1], 0.466 * 3.0, delta=0.02)

    def test_boattail(self) -> None:
        slope, point = self.method(NOSE.format("cone") + TUBE + BOATTAIL)
        tail = 2.0 * (0.6**2 - 1.0)
        place = 10.0 + 0.8 / 3.0 * (1.0 + (1.0 - 1.0 / 0.6) / (1.0 - 1.0 / 0.6**2))
        self.assertAlmostEqual(slope, 2.0 + tail, places=9)
        self.assertAlmostEqual(point * slope, 2.0 * 2.0 + tail * place, places=9)

    def test_fins(self) -> None:
        bare, nose = self.method(NOSE.format("cone") + TUBE)
        root, tip, span, radius = 1.5, 0.7, 0.9, 0.5
        middle = math.hypot(span, SWEPT + 0.5 * tip - 0.5 * root)  # of the fin's mid-chord line
        place = 8.0 + SWEPT / 3.0 * (root + 2.0 * tip) / (root + tip) + (root + tip - root * tip / (root + tip)) / 6.0
        for number, roll in ((3, 0.0), (3, 17.0), (4, 0.0), (4, 45.0)):
            slope, point = self.method(NOSE.format("cone") + TUBE + self.fins(number, roll))
            fins = (1.0 + radius / (span + radius)) * 4.0 * number * span**2 / (1.0 + math.sqrt(1.0 + (2.0 * middle / (root + tip)) ** 2))
            self.assertAlmostEqual(slope, bare + fins, places=6)
            self.assertAlmostEqual(point, (bare * nose + fins * place) / (bare + fins), places=5)


if __name__ == "__main__":
    unittest.main()
