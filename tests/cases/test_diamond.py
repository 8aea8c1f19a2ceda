#!/usr/bin/python3
"""Steady flow over the diamond section beside oblique shocks and Prandtl-Meyer expansions (cases/diamond/reference)."""

from __future__ import annotations

import math
import tempfile
import unittest
from pathlib import Path

from exact_case import ExactCase, run, table

# Twice the chord times the width of the slab, which shrinks with the cells as cases/diamond/mesh.py makes it.
AREA = {"tiny": 0.18, "coarse": 0.045}
FINER = 4.0  # by so much cells of the coarse mesh are smaller than those of the tiny one
EXACT = {row["alpha_deg"]: row for row in table("diamond/reference/exact_diamond.csv")}


class Diamond(ExactCase):
    def loads(self, level: str, alpha: float) -> dict[str, float]:
        """CN, CD and Cm about the leading edge."""
        settings = {"reference.area": AREA[level], "freestream.alpha": alpha, "steady.orders": 6}
        with tempfile.TemporaryDirectory() as folder:
            forces = run(Path(folder), "run", "diamond/steady.toml", f"diamond_{level}.msh", settings)["forces"]
        drag = forces["CA"] * math.cos(math.radians(alpha)) + forces["CN"] * math.sin(math.radians(alpha))
        return {"CN": forces["CN"], "CD": drag, "Cm_LE": forces["Cm"]}

    def test_loads(self) -> None:
        for alpha in (0.0, 1.0, 3.0):
            loads = self.loads("coarse", alpha)
            for name, value in loads.items():
                if EXACT[alpha][name] == 0.0:  # by symmetry of flow and mesh
                    self.assertLess(abs(value), 1e-6, name)
                else:
                    self.assert_close(f"{name} at {alpha} degrees", value, EXACT[alpha][name], 0.01)

    def test_errors_fall_with_the_cell_size(self) -> None:
        # First order: at a shock, and at the corners where shocks and fans begin, a scheme without oscillations has no more. Drag
        # has passed its exact value on these meshes: its error is in the noise.
        tiny, coarse = self.loads("tiny", 1.0), self.loads("coarse", 1.0)
        for name in ("CN", "Cm_LE"):
            exact = EXACT[1.0][name]
            self.assertGreater(abs(tiny[name] - exact) / abs(coarse[name] - exact), FINER, name)


if __name__ == "__main__":
    unittest.main()
