#!/usr/bin/python3
"""scripts/treatments.py on the wedge: a field velocity and a rigid grid are the same equations, a deforming grid is near them."""

from __future__ import annotations

import csv
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

from exact_case import CASES, MESHES

SCRIPT = CASES.parent / "scripts" / "treatments.py"
SETTINGS = {
    "mesh.file": MESHES / "wedge_tiny.msh",
    "reference.area": 0.18,
    "motion.reduced_frequency": 0.1,
    "unsteady.steps_per_cycle": 16,
    "output.flow": "false",
    "output.surface": "false",
}


class Treatments(unittest.TestCase):
    def test_table_and_loops(self) -> None:
        overrides = [part for key, value in SETTINGS.items() for part in ("--set", f"{key}={value}")]
        with tempfile.TemporaryDirectory() as folder:
            command = [SCRIPT, CASES / "wedge" / "plunge.toml", "--out", folder, "--program", os.environ["ALPHADOT"], *overrides]
            subprocess.run(["/usr/bin/python3", "-B", *map(str, command)], check=True)
            with open(Path(folder) / "treatments.csv") as file:
                field, rigid, deforming = csv.DictReader(file)
            for suffix in ("svg", "png"):
                self.assertGreater((Path(folder) / f"loops.{suffix}").stat().st_size, 1000)
        self.assertEqual([row["treatment"] for row in (field, rigid, deforming)], ["field_velocity", "rigid_grid", "deforming_grid"])
        # Both end their inner iterations at the same tolerance; between them are round-off and nothing else.
        self.assertLess(float(rigid["difference"]), 1e-8)
        self.assertLess(float(deforming["difference"]), 1e-3)
        for name in ("CN_alpha", "CN_alphadot", "Cm_alphadot"):
            self.assertLess(abs(float(deforming[name]) / float(field[name]) - 1.0), 0.005, name)
        for row in (field, rigid, deforming):
            self.assertGreater(float(row["cpu_s_per_cycle"]), 0.0)
        self.assertEqual(float(field["ratio"]), 1.0)


if __name__ == "__main__":
    unittest.main()
