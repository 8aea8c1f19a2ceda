#!/usr/bin/python3
"""The model of scripts/scaling.py: runs made from known coefficients give these back, and what follows from them."""

from __future__ import annotations

import math
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))
from scaling import SURFACE, Model, Network, Run, fit

WORK, GHOSTS, BYTES, MESSAGES, GROWTH = 8e-7, 7.5, 320.0, 60.0, 0.02
CELLS, CORES = 1_000_000, 2
NETWORK = Network(latency_s=2e-6, bytes_per_s=4e8)


def made(ranks: int, cells: int = CELLS) -> Run:
    """A run that the model with the coefficients above describes, without waiting."""
    share = 0.0 if ranks == 1 else GHOSTS * (cells / ranks) ** (SURFACE - 1)
    iterations = round(1000 * (1 + GROWTH * math.log2(ranks)))
    return Run(
        ranks=ranks,
        cells=cells,
        iterations=iterations,
        wall_s=WORK * cells * iterations / ranks,
        cpu_s=WORK * cells * iterations,
        halo_fraction=0.0,
        halo_bytes_per_iteration=BYTES * share * cells,
        most_messages_per_iteration=0.0 if ranks == 1 else MESSAGES,
        ghost_fraction=share,
        load_imbalance=0.0 if ranks == 1 else 0.01,
    )


class Scaling(unittest.TestCase):
    def setUp(self) -> None:
        self.model = fit([made(ranks) for ranks in (1, 2, 4, 8, 16)], [made(16, 8 * CELLS)], CORES)

    def test_fit_gives_the_coefficients_back(self) -> None:
        expected = Model(WORK, 0.01, GHOSTS, BYTES, MESSAGES, 1000, GROWTH)
        for name in Model.__dataclass_fields__:
            value = getattr(expected, name)
            self.assertAlmostEqual(getattr(self.model, name), value, delta=1e-9 * value, msg=name)

    def test_one_rank_only_works(self) -> None:
        self.assertAlmostEqual(self.model.seconds(CELLS, 1, NETWORK), WORK * CELLS, places=12)
        self.assertEqual(self.model.efficiency(CELLS, 1, NETWORK), 1)

    def test_parts_by_hand(self) -> None:
        """1000 cells a rank on 1024 ranks: 750 ghosts."""
        work, latency, bandwidth, reduction = self.model.parts(1024e3, 1024, NETWORK)
        self.assertAlmostEqual(work, 1000 * WORK * 1.01, places=12)
        self.assertAlmostEqual(latency, 60 * 2e-6, places=12)
        self.assertAlmostEqual(bandwidth, 750 * 320 / 4e8, places=9)
        self.assertAlmostEqual(reduction, 2 * 10 * 2e-6, places=12)

    def test_efficiency_falls_with_the_ranks(self) -> None:
        values = [self.model.efficiency(1e8, ranks, NETWORK) for ranks in (1, 16, 256, 4096, 10_000)]
        self.assertEqual(values, sorted(values, reverse=True))
        self.assertGreater(values[-1], 0)


if __name__ == "__main__":
    unittest.main()
