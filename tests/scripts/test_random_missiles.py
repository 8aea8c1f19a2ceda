#!/usr/bin/python3
"""Twenty descriptions drawn at random: each gives a mesh that holds all invariants, of about the cells asked for, or a refusal."""

from __future__ import annotations

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from random_missiles import random_missile

MESH = Path(__file__).resolve().parents[2] / "scripts" / "mesh.py"
CELLS = 12_000


class RandomMissiles(unittest.TestCase):
    def test_meshes_or_refusals(self) -> None:
        refused = []
        for seed in range(20):
            with self.subTest(seed=seed), tempfile.TemporaryDirectory() as folder:
                file = Path(folder) / "missile.toml"
                file.write_text(random_missile(seed))
                command = [sys.executable, "-B", str(MESH), str(file), "-o", f"{folder}/out", "--cells", str(CELLS), "--no-picture"]
                done = subprocess.run(command, capture_output=True, text=True, timeout=600)
                if done.returncode == 1:
                    refused.append(f"{seed}: {done.stderr}")
                    self.assertIn("alphadot mesh: error: ", done.stderr)
                    self.assertFalse(list(Path(folder, "out").glob("*")))
                    continue
                self.assertEqual(done.returncode, 0, done.stderr)
                cells = int(next(line for line in done.stdout.splitlines() if "tetrahedra" in line).split()[1].rstrip(","))
                self.assertLess(abs(cells / CELLS - 1.0), 0.15)
        self.assertLessEqual(len(refused), 2, refused)  # what is possible is made


if __name__ == "__main__":
    unittest.main()
