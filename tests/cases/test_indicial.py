#!/usr/bin/python3
"""A thin section's response to a step in alpha beside exact linear theory of the flat plate (cases/diamond/reference)."""

from __future__ import annotations

import csv
import math
import tempfile
import unittest
from pathlib import Path

import numpy as np

from exact_case import ExactCase, run, table

PLATE = table("diamond/reference/exact_indicial_plate.csv")
STEP = math.radians(0.1)


class Indicial(ExactCase):
    def test_lift_and_moment(self) -> None:
        # A cell of the small mesh is twice the coarse one's, and so is the time step, in which the wave crosses one cell.
        settings = {"reference.area": 0.09, "unsteady.steps": 44}
        with tempfile.TemporaryDirectory() as folder:
            run(Path(folder), "run", "diamond/step.toml", "thin_small.msh", settings)
            with open(Path(folder) / "history.csv") as file:
                rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(line for line in file if line[0] != "#")]
        _, start, *rest = rows  # the loads before the step and those just after it
        self.assert_close("CL just after the step", start["total/CN"] / STEP, PLATE[0]["CL"], 0.01)
        chords = [row["U_t_over_c"] for row in PLATE]
        for load, name in (("total/CN", "CL"), ("total/Cm", "Cm_LE")):
            exact = [row[name] for row in PLATE]
            for row in rest:
                t = 0.5 * row["t_star"]
                self.assert_close(f"{name} after {t:g} chords", row[load] / STEP, float(np.interp(t, chords, exact)), 0.02)


if __name__ == "__main__":
    unittest.main()
