#!/usr/bin/python3
"""A thin section that oscillates, or meets a sinusoidal gust, by linear solves, beside exact linear theory of the flat plate."""

from __future__ import annotations

import csv
import tempfile
import unittest
from pathlib import Path

from exact_case import ExactCase, run, table

PLATE = table("diamond/reference/exact_oscillating_plate.csv")
VARIABLES = ("alpha", "q", "gust")  # of the table's rows, in turn
# What thickness takes off by Busemann's second-order theory, quasi-steadily: the faces ahead of the middle bear a share e more and
# those behind it e less, which is half of e off a moment about the nose (0.55 %, cases/diamond/README.md). A load that grows with x, as
# that of q does, has a quarter of its force and an eighth of its moment ahead of the middle: e / 2 and 3 e / 4.
THICKNESS = {
    ("CN", "alpha"): 0.0, ("Cm", "alpha"): 0.0055, ("CN", "q"): 0.0055, ("Cm", "q"): 0.00825, ("CN", "gust"): 0.0, ("Cm", "gust"): 0.0055,
}  # fmt: skip


class OscillatingPlate(ExactCase):
    def test_alpha_q_and_gust(self) -> None:
        """Within 1 % of the modulus."""
        with tempfile.TemporaryDirectory() as folder:
            settings = {"reference.area": 0.09, "motion.kind": "none"}
            run(Path(folder), "frequency", "diamond/step.toml", "thin_small.msh", settings, options=["--k", "0.01,0.1,0.5,1", "--gusts"])
            with open(Path(folder) / "frequency.csv") as file:
                found = {
                    (float(row["k"]), row["variable"], row["coefficient"]): (float(row["in_phase"]), float(row["out_of_phase"]))
                    for row in csv.DictReader(line for line in file if line[0] != "#")
                    if row["part"] == "total"
                }
        rows = [row for row in PLATE if row["Mach"] == 2.0]
        self.assertEqual(len(rows), 12)
        for row, variable in zip(rows, VARIABLES * 4, strict=True):
            for load in ("CN", "Cm"):
                exact = complex(row[f"{load}_in_phase"], row["k"] * row[f"{load}_out_of_phase"])
                exact *= 1 - THICKNESS[load, variable]
                in_phase, out_of_phase = found[row["k"], variable, load]
                error = abs(complex(in_phase, row["k"] * out_of_phase) - exact)
                with self.subTest(load=load, variable=variable, k=row["k"]):
                    self.assertLessEqual(error, 0.01 * abs(exact), f"{in_phase}, {out_of_phase} is not {row}")


if __name__ == "__main__":
    unittest.main()
