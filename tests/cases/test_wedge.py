#!/usr/bin/python3
"""Derivatives of the sharp wedge for k -> 0 beside their exact values (cases/wedge/reference)."""

from __future__ import annotations

import tempfile
import unittest
from pathlib import Path

from exact import ExactCase, run, table

AREA = {"tiny": 0.18, "coarse": 0.045}  # twice the chord times the width of the slab
NAMES = ("CN_alpha", "CN_q", "Cm_q", "CN_alphadot", "Cm_alphadot")
(EXACT,) = (row for row in table("wedge/reference/exact_wedge_derivatives.csv") if row["axis_x_over_c"] == 0.5)


def derivatives(level: str) -> dict[str, float]:
    """About the middle of the chord, per radian."""
    with tempfile.TemporaryDirectory() as folder:
        found = run(Path(folder), "derivatives", "wedge/derivatives.toml", f"wedge_{level}.msh", {"reference.area": AREA[level]})
    return {name: found["derivatives"][name]["value"] for name in NAMES}


class Wedge(ExactCase):
    def test_derivatives(self) -> None:
        tiny, coarse = derivatives("tiny"), derivatives("coarse")
        for name in NAMES:
            self.assert_close(name, coarse[name], EXACT[name], 0.01)
        # CN_alpha is right to less than 1e-3 from the first.
        for name in NAMES[1:]:
            with self.subTest(name):
                self.assertLess(abs(coarse[name] - EXACT[name]), abs(tiny[name] - EXACT[name]))


if __name__ == "__main__":
    unittest.main()
