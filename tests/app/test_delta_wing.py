#!/usr/bin/python3
"""A mesh that Gmsh's own command makes of cases/delta_wing/wing.geo, through its case, to derivatives beside linear theory.

usage: test_delta_wing.py CASE_FOLDER. Theory: 4 / B and what follows from it, see the README there. The wing is 2 % thick. By
second-order theory that moves the neutral point forward by 0.0085 root chords, and so takes 5 % off Cm_alpha, and as much of the rate
derivatives; CN_alpha, where the front and rear halves of a section cancel, and Cm_alphadot, next to the area's centre, feel little.
"""

from __future__ import annotations

import json
import math
import shutil
import sys
import tempfile
import unittest
from pathlib import Path
from subprocess import run as call

from program import run

CASE = Path(sys.argv.pop())
B = math.sqrt(3.0)  # at Mach 2
THEORY = {
    "CN_alpha": (4 / B, 0.01),
    "Cm_alpha": (-2 / 3 / B, 0.08),
    "CN_q": (4 / 3 / B, 0.10),
    "Cm_q": (-2 / 3 / B, 0.08),
    "CN_alphadot": (-8 / 3 / B**3, 0.06),
    "Cm_alphadot": (2 / 3 / B**3, 0.03),
}


class DeltaWing(unittest.TestCase):
    def test_beside_linear_theory(self) -> None:
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            for file in ("wing.geo", "wing.toml"):
                shutil.copy(CASE / file, folder)
            call(["gmsh", "-3", "wing.geo", "-o", "wing.su2"], cwd=folder, check=True, capture_output=True)
            outcome = run(folder, "derivatives", "wing.toml", "--out", "wing", ranks=2)
            self.assertEqual(outcome.codes, [0, 0], outcome.err)
            result = json.loads((folder / "wing" / "result.json").read_text())
        self.assertEqual(result["status"], "converged")
        for name, (value, tolerance) in THEORY.items():
            with self.subTest(name):
                self.assertAlmostEqual(result["derivatives"][name]["value"], value, delta=tolerance * abs(value))
        # Two thirds of the root chord, where the area has its centre, less what the thickness takes.
        self.assertAlmostEqual(result["longitudinal"]["neutral_point_x"], 2 / 3 - 0.0085, delta=0.005)


if __name__ == "__main__":
    unittest.main()
