#!/usr/bin/python3
"""The limit of low frequency to second order beside plunges at two frequencies, on the sharp cone.

The loads in phase with alpha are X_alpha - k^2 X_alphaddot + O(k^4): their difference between two frequencies gives X_alphaddot by
motions in time alone. The difference leaves out what amplitude and time step (the same share of a cycle) do to both.
"""

from __future__ import annotations

import tempfile
import unittest
from pathlib import Path

from exact import ExactCase, run

FREQUENCIES = (0.1, 0.2)


class Frequency(ExactCase):
    def derivatives(self, verb: str, case: str, settings: dict[str, object]) -> dict:
        with tempfile.TemporaryDirectory() as folder:
            return run(Path(folder), verb, f"sharp_cone/{case}", "cone_tiny.msh", settings)["derivatives"]

    def test_second_derivatives(self) -> None:
        linear = self.derivatives("derivatives", "derivatives.toml", {"derivatives.second_order": "true", "derivatives.orders": 5})
        slow, fast = (
            self.derivatives("run", "plunge.toml", {"motion.reduced_frequency": k, "unsteady.steps_per_cycle": 48})
            for k in FREQUENCIES
        )
        for name in ("CN", "Cm"):
            change = fast[f"{name}_alpha"]["value"] - slow[f"{name}_alpha"]["value"]
            found = -change / (FREQUENCIES[1] ** 2 - FREQUENCIES[0] ** 2)
            self.assert_close(f"{name}_alphaddot", found, linear[f"{name}_alphaddot"]["value"], 0.02)


if __name__ == "__main__":
    unittest.main()
