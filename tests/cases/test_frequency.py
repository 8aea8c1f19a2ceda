#!/usr/bin/python3
"""Linear solves beside plunges at two frequencies, on the sharp cone: the limit of low frequency to second order, and either frequency.

The loads in phase with alpha are X_alpha - k^2 X_alphaddot + O(k^4): their difference between two frequencies gives X_alphaddot by
motions in time alone. It is some 1e-3 of the loads, so inner iterations must go on for longer than usual. The second-order backward
differences of the motion make its square of a frequency larger by 2/3 (omega dt)^2, 0.3 % with the case's 96 steps a cycle.
"""

from __future__ import annotations

import cmath
import math
import tempfile
import unittest
from collections.abc import Sequence
from pathlib import Path

from exact_case import ExactCase, run

FREQUENCIES = (0.1, 0.2)


class Frequency(ExactCase):
    def derivatives(self, verb: str, case: str, settings: dict[str, object], options: Sequence[str] = ()) -> dict:
        with tempfile.TemporaryDirectory() as folder:
            return run(Path(folder), verb, f"sharp_cone/{case}", "cone_tiny.msh", settings, options=options)["derivatives"]

    def test_second_derivatives(self) -> None:
        linear = self.derivatives("derivatives", "derivatives.toml", {"derivatives.second_order": "true", "derivatives.orders": 5})
        slow, fast = (
            self.derivatives("run", "plunge.toml", {"motion.reduced_frequency": k, "unsteady.inner_tolerance": 1e-5})
            for k in FREQUENCIES
        )
        for name in ("CN", "Cm"):
            change = fast[f"{name}_alpha"]["value"] - slow[f"{name}_alpha"]["value"]
            found = -change / (FREQUENCIES[1] ** 2 - FREQUENCIES[0] ** 2)
            self.assert_close(f"{name}_alphaddot", found, linear[f"{name}_alphaddot"]["value"], 0.01)
        options = ["--k", ",".join(map(str, FREQUENCIES))]
        response = self.derivatives("frequency", "derivatives.toml", {}, options)
        for k, plunge in zip(FREQUENCIES, (slow, fast), strict=True):
            for name in ("CN", "Cm"):
                linear_load, load = (
                    complex(at(f"{name}_alpha")["value"], k * at(f"{name}_alphadot")["value"])
                    for at in (lambda entry, k=k: response[f"{entry}, k = {k:g}"], plunge.__getitem__)
                )
                self.assert_close(f"{name} at k = {k}", abs(load), abs(linear_load), 0.002)
                self.assertLess(abs(math.degrees(cmath.phase(load / linear_load))), 0.2, f"{name} at k = {k}")

    def test_pitch_and_plunge_with_the_step_refined(self) -> None:
        """At k = 0.5, where the parts out of phase are as large as they get: histories of 24 and 48 steps a cycle, extrapolated."""
        k = 0.5
        response = self.derivatives("frequency", "derivatives.toml", {"derivatives.orders": 4}, ["--k", str(k)])
        linear = lambda entry: response[f"{entry}, k = {k:g}"]["value"]
        for motion, rate in (("plunge", "alphadot"), ("pitch", "q_plus_alphadot")):
            coarse, fine = (
                self.derivatives("run", "plunge.toml", {
                    "motion.kind": motion, "motion.reduced_frequency": k, "motion.amplitude": 0.05, "unsteady.steps_per_cycle": steps,
                    "unsteady.inner_tolerance": 1e-4,
                })
                for steps in (24, 48)
            )  # fmt: skip
            for name in ("CN", "Cm"):
                by_steps = [complex(run[f"{name}_alpha"]["value"], k * run[f"{name}_{rate}"]["value"]) for run in (coarse, fine)]
                load = (4 * by_steps[1] - by_steps[0]) / 3
                expected = complex(linear(f"{name}_alpha"), k * linear(f"{name}_{rate}"))
                if motion == "pitch":  # theta drives both the incidence and the rate, which has a rate of its own
                    expected -= k**2 * linear(f"{name}_qdot")
                self.assert_close(f"{name}, {motion}", abs(load), abs(expected), 0.002)
                self.assertLess(abs(math.degrees(cmath.phase(load / expected))), 0.2, f"{name}, {motion}")


if __name__ == "__main__":
    unittest.main()
