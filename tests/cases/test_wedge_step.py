#!/usr/bin/python3
"""The sharp wedge's rate derivatives from step responses beside their exact values (cases/wedge/reference)."""

from __future__ import annotations

import tempfile
import unittest
from pathlib import Path

from exact_case import ExactCase, run, table

APEX = next(row for row in table("wedge/reference/exact_wedge_derivatives.csv") if row["axis_x_over_c"] == 0.0)
# In a time step the wave from the wall crosses one cell. About the apex nothing is a small difference.
SETTINGS = {
    "reference.area": 0.09,
    "reference.moment_center": "[0, 0, 0]",
    "unsteady.steps": 60,
    "unsteady.inner_tolerance": 0.01,
}


class Step(ExactCase):
    def check(self, motion: dict[str, object], names: tuple[str, ...]) -> None:
        with tempfile.TemporaryDirectory() as folder:
            found = run(Path(folder), "run", "wedge/step.toml", "wedge_small.msh", SETTINGS | motion)["derivatives"]
        for name in names:
            self.assert_close(name, found[name]["value"], APEX[name], 0.01)

    def test_alpha(self) -> None:
        self.check({}, ("CN_alpha", "CN_alphadot", "Cm_alphadot"))

    def test_q(self) -> None:
        self.check({"motion.kind": "step_q", "motion.amplitude": 0.001}, ("CN_q", "Cm_q"))


if __name__ == "__main__":
    unittest.main()
