#!/usr/bin/python3
"""A detached shock before a blunt nose and wakes behind blunt trailing edges that are walls: flows that come to rest by default.

usage: test_blunt_fins.py CASE. Expectations: six decades without a change of the case, and the same on two ranks.
"""

from __future__ import annotations

import json
import math
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

    def test_edges_may_be_jets(self) -> None:
        """7 % of the mean chord of 0.6 times the span of 0.6, of the panels in the plane of symmetry half and twice, over pi / 4."""
        area = 0.07 * 0.6 * 0.6 / math.cos(math.radians(5.1)) / (math.pi / 4)  # edges swept forward by 5.1 degrees
        found, outcome = self.flow(1.4, 2, **{"mesh.aft_jets": '["fin_1","fin_2","fin_3"]'})
        self.assertEqual(found["status"], "converged")
        said = {name: float(number) for name, number in re.findall(r"(fin_\d_aft): (\S+) reference areas look aft", outcome.out + outcome.err)}
        self.assertEqual(set(said), {"fin_1_aft", "fin_2_aft", "fin_3_aft"})
        for name, expected in (("fin_1_aft", area), ("fin_2_aft", 2 * area), ("fin_3_aft", area)):
            self.assertAlmostEqual(said[name] / expected, 1.0, delta=0.03)
        self.assertNotIn("cells behind walls", outcome.out + outcome.err)

    def test_says_what_is_wrong(self) -> None:
        outcome = run(self.folder, "run", CASE, "--out", self.folder / "wrong", "--set", 'mesh.aft_jets=["base","foo"]', ranks=1)
        self.assertEqual(outcome.codes, [1])
        for name in ("base", "foo"):
            self.assertIn(f'mesh.aft_jets names "{name}", which is no wall', outcome.err)

    def test_two_ranks_find_the_same(self) -> None:
        one, two = (self.flow(2.2, ranks)[0]["forces"] for ranks in (1, 2))
        for load in ("CA", "CN", "Cm"):
            self.assertAlmostEqual(two[load], one[load], delta=1e-5)


if __name__ == "__main__":
    unittest.main()
