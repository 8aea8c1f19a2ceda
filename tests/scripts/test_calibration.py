#!/usr/bin/python3
"""scripts/calibration.py: its two sets have nothing in common, and its tables count what they say."""

from __future__ import annotations

import itertools
import sys
import unittest
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
import calibration
from calibration import NAMES, Condition, Entry

CONDITION = Condition("fit", "wing", 45, 2, (1.0, 2.0, 4.0))
EXACT = CONDITION.exact.as_dict()


def run(shares: tuple[float, float, float], uncertainties: tuple[float, float, float] = (0, 0, 0)) -> list[Entry]:
    """Every derivative on three meshes wrong by these shares of its exact value."""
    return [
        Entry(CONDITION, name, EXACT[name], tuple(EXACT[name] * (1 + share) for share in shares), uncertainties)
        for name in NAMES
    ]


class Calibration(unittest.TestCase):
    def test_sets_share_neither_condition_nor_mesh(self) -> None:
        fit, validation = ([c for c in calibration.conditions() if c.used_for == word] for word in ("fit", "validation"))
        self.assertEqual({c.body for c in fit}, {c.body for c in validation})
        for a, b in itertools.product(fit, validation):
            self.assertNotEqual((a.body, a.angle, a.mach), (b.body, b.angle, b.mach))
            if a.body == b.body:
                self.assertFalse(set(a.sizes) & set(b.sizes))

    def test_differences_of_second_order_give_the_error(self) -> None:
        """c h^2 with h = 1, 2, 4: each pair of meshes tells the error of the finest, as the program has it."""
        entries = run((0.01, 0.04, 0.16))
        errors = [entry.error for entry in entries]
        for meshes in (2, 3):
            np.testing.assert_allclose(calibration.differences(entries, meshes), errors, rtol=1e-12)

    def test_no_way_of_the_program_is_widened_by_a_mesh(self) -> None:
        way = calibration.WAYS["both, by median, never wider (the program's)"]
        for shares in ((0.01, 0.011, 0.3), (0.01, 0.05, 0.05)):
            self.assertTrue((way(run(shares), 3) <= way(run(shares), 2)).all())

    def test_counts(self) -> None:
        self.assertEqual(calibration.coverage(np.array([1.0, 2.0, 4.0, 5.0]), np.array([2.0, 4.0, 3.0, 10.0])), ["75 %", "2"])
        header, fit, *_ = calibration.summary(run((0.01, 0.0, 0.0), (0.0, 1.0, 1.0)))
        self.assertEqual(fit[:2], ["fit", str(len(NAMES))])
        self.assertEqual([cell for name, cell in zip(header, fit) if "coverage" in name], ["0 %", "100 %", "100 %"])


if __name__ == "__main__":
    unittest.main()
