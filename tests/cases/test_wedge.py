#!/usr/bin/python3
"""Derivatives of the sharp wedge for k -> 0 beside their exact values (cases/wedge/reference)."""

from __future__ import annotations

import math
import tempfile
import unittest
from pathlib import Path

from exact_case import ExactCase, run, table

from exact import Longitudinal

AREA = {"tiny": 0.18, "coarse": 0.045}  # twice the chord times the width of the slab
NAMES = ("CN_alpha", "CN_q", "Cm_q", "CN_alphadot", "Cm_alphadot")
EXACT = {row["axis_x_over_c"]: row for row in table("wedge/reference/exact_wedge_derivatives.csv")}
MIDDLE, APEX = 0.5, 0.0  # of the chord, the case's moment centre


def derivatives(level: str) -> Longitudinal:
    """About the middle of the chord, per radian."""
    with tempfile.TemporaryDirectory() as folder:
        found = run(Path(folder), "derivatives", "wedge/derivatives.toml", f"wedge_{level}.msh", {"reference.area": AREA[level]})
    return Longitudinal.of({name: entry["value"] for name, entry in found["derivatives"].items()})


class Wedge(ExactCase):
    def test_derivatives(self) -> None:
        tiny, coarse = derivatives("tiny"), derivatives("coarse")
        for name in NAMES:
            self.assert_close(name, getattr(coarse, name), EXACT[MIDDLE][name], 0.01)
        # About the apex nothing is a small difference. CN_alpha is right to 1e-3 from the first.
        moved = [found.about(APEX - MIDDLE).as_dict() for found in (tiny, coarse)]
        # A quarter of the cell size: a quarter of the errors at the first order, a sixteenth at the second. Some change sign on the way,
        # so that they count together.
        errors = [
            math.hypot(*(found[name] / EXACT[APEX][name] - 1.0 for name in NAMES[1:])) for found in moved
        ]  # fmt: skip
        self.assertLess(errors[1], 0.2 * errors[0])


if __name__ == "__main__":
    unittest.main()
