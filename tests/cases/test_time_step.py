#!/usr/bin/python3
"""The uncertainty of a motion holds what its time step does: the wedge's plunge and pitch with few steps a cycle beside many.

The reference is the motion with 96 steps a cycle. Backward differences that are not fitted to the frequency are off by
(2 pi / steps)^2 / 3 in the rate derivatives: 5.1 % with 16 steps, and 0.14 % with the 96 of the reference.
"""

from __future__ import annotations

import tempfile
import unittest
from pathlib import Path

from exact_case import ExactCase, run

SETTINGS = {"reference.area": 0.18}


def derivatives(case: str, code: int = 0, **settings: object) -> dict[str, dict]:
    changes = SETTINGS | {name.replace("_", ".", 1): value for name, value in settings.items()}
    with tempfile.TemporaryDirectory() as folder:
        return run(Path(folder), "run", f"wedge/{case}.toml", "wedge_tiny.msh", changes, code=code)["derivatives"]


class TimeStep(ExactCase):
    def check(self, case: str) -> None:
        fine = derivatives(case, unsteady_steps_per_cycle=96)
        for steps in (16, 24, 48):
            found = derivatives(case, unsteady_steps_per_cycle=steps)
            for name, entry in found.items():
                with self.subTest(name, case=case, steps=steps):
                    error = abs(entry["value"] - fine[name]["value"])
                    self.assertLessEqual(error, entry["uncertainty"] + fine[name]["uncertainty"])
            for name in ("CN_alphadot", "Cm_alphadot", "CN_q_plus_alphadot", "Cm_q_plus_alphadot"):
                if name in found:  # a small uncertainty, too
                    self.assertLess(found[name]["uncertainty"], 0.025 * abs(fine[name]["value"]), f"{name}, {steps} steps")

    def test_plunge(self) -> None:
        self.check("plunge")

    def test_pitch(self) -> None:
        self.check("pitch")

    def test_few_inner_iterations(self) -> None:
        """Three iterations a step do not reach the tolerance, but the uncertainty holds what they leave."""
        whole = derivatives("plunge", unsteady_steps_per_cycle=24)
        cut = derivatives("plunge", unsteady_steps_per_cycle=24, unsteady_max_inner=3, code=5)
        for name, entry in cut.items():
            with self.subTest(name):
                self.assertIs(entry["converged"], False)
                self.assertLessEqual(abs(entry["value"] - whole[name]["value"]), entry["uncertainty"])


if __name__ == "__main__":
    unittest.main()
