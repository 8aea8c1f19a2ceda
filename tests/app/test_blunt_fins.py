#!/usr/bin/python3
"""A detached shock before a blunt nose and wakes behind blunt trailing edges that are walls: flows that come to rest by default.

usage: test_blunt_fins.py CASE. Expectations: six decades without a change of the case, and the same on two ranks.
"""

from __future__ import annotations

import json
import re
import sys
import tempfile
import unittest
from pathlib import Path

from program import Outcome, run

CASE = Path(sys.argv.pop())
MACHS = (1.4, 2.2)  # within the range that the mesh is made for


class BluntFins(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def flow(self, mach: float, ranks: int = 1, **settings: object) -> tuple[dict, Outcome]:
        settings |= {"freestream.mach": mach, "freestream.alpha": 2, "steady.orders": 6, "output.flow": "false", "output.surface": "false"}
        words = [word for key, value in settings.items() for word in ("--set", f"{key}={value}")]
        out = self.folder / f"{mach}_{ranks}"
        outcome = run(self.folder, "run", CASE, "--out", out, *words, ranks=ranks)
        return json.loads((out / "result.json").read_text()), outcome

    def test_comes_to_rest(self) -> None:
        for mach in MACHS:
            with self.subTest(mach=mach):
                found, outcome = self.flow(mach)
                self.assertEqual((found["status"], found["message"]), ("converged", ""), outcome.err)
                self.assertLess(found["performance"]["iterations"], 400)  # attempts in vain included
                count = re.search(r"(\d+) cells behind walls that face aft are of first order", outcome.out + outcome.err)
                self.assertIsNotNone(count)
                self.assertLess(int(count[1]), 0.05 * found["mesh"]["cells"])

    def test_two_ranks_find_the_same(self) -> None:
        one, two = (self.flow(2.2, ranks)[0]["forces"] for ranks in (1, 2))
        for load in ("CA", "CN", "Cm"):
            self.assertAlmostEqual(two[load], one[load], delta=1e-5)


if __name__ == "__main__":
    unittest.main()
