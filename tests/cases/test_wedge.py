#!/usr/bin/python3
"""Derivatives of the sharp wedge for k -> 0 beside their exact values (cases/wedge/reference)."""

from __future__ import annotations

import math
import tempfile
import unittest
from pathlib import Path

from exact_case import ExactCase, run, table

from exact import Longitudinal

AREA = {"tiny": 0.18, "coarse": 0.045}  # twice the chord times the width of the slab
# All of it about the middle of its chord.
TURNED = '[{name = "turned", patches = ["body", "base"], hinge = {point = [0.5, 0, 0], axis = [0, 1, 0]}}]'
NAMES = ("CN_alpha", "CN_q", "Cm_q", "CN_alphadot", "Cm_alphadot")
EXACT = {row["axis_x_over_c"]: row for row in table("wedge/reference/exact_wedge_derivatives.csv")}
MIDDLE, APEX = 0.5, 0.0  # of the chord, the case's moment centre


def computed(level: str) -> dict:
    settings = {"reference.area": AREA[level], "controls": TURNED, "derivatives.control_rates": "true"}
    with tempfile.TemporaryDirectory() as folder:
        return run(Path(folder), "derivatives", "wedge/derivatives.toml", f"wedge_{level}.msh", settings)


def derivatives(found: dict) -> Longitudinal:
    """About the middle of the chord, per radian."""
    return Longitudinal.of({name: entry["value"] for name, entry in found["derivatives"].items()})


class Wedge(ExactCase):
    def test_derivatives(self) -> None:
        tiny, coarse = map(derivatives, (TINY, COARSE))
        for name in NAMES:
            self.assert_close(name, getattr(coarse, name), EXACT[MIDDLE][name], 0.01)
        # About the apex nothing is a small difference. CN_alpha is right to 1e-3 from the first.
        moved = [found.about(APEX - MIDDLE).as_dict() for found in (tiny, coarse)]
        # A quarter of the cell size: a quarter of the errors at the first order, a sixteenth at the second. Some change sign on the way,
        # so that they count together.
        errors = [
            math.hypot(*(found[name] / EXACT[APEX][name] - 1.0 for name in NAMES[1:])) for found in moved
        ]  # fmt: skip
        self.assertLess(errors[1], 0.2 * errors[0])

    def test_turned_as_a_whole(self) -> None:
        """In the stream it is the same as incidence, and its force turns along: CN_turned = CN_alpha - CA, CA_turned = CN = 0. While it
        turns it pitches, at an incidence that changes: CN_turneddot = CN_q + CN_alphadot."""
        found = {name: entry["value"] for name, entry in COARSE["derivatives"].items()}
        exact = EXACT[MIDDLE]
        for name, expected in (("CN", exact["CN_alpha"] - COARSE["forces"]["CA"]), ("Cm", exact["Cm_alpha"]), ("CA", 0.0)):
            print(f"{name}_turned {found[f'{name}_turned']:.5f}, exact {expected:.5f}")
            self.assertAlmostEqual(found[f"{name}_turned"], expected, delta=0.01 * exact["CN_alpha"])
        for name in ("CN", "Cm"):
            of_q, of_lag = exact[f"{name}_q"], exact[f"{name}_alphadot"]
            print(f"{name}_turneddot {found[f'{name}_turneddot']:.5f}, exact {of_q + of_lag:.5f}")
            self.assertAlmostEqual(found[f"{name}_turneddot"], of_q + of_lag, delta=0.01 * (abs(of_q) + abs(of_lag)))


class Steps(ExactCase):
    """Derivatives from steps in time beside the linear solves' on the same mesh: within their +-, or said not to be had."""

    def step(self, code: int = 0, **settings: object) -> dict:
        keys = {"reference.area": AREA["tiny"], **{key.replace("__", "."): value for key, value in settings.items()}}
        with tempfile.TemporaryDirectory() as folder:
            return run(Path(folder), "run", "wedge/step.toml", "wedge_tiny.msh", keys, code=code)

    def test_a_response_that_is_cut_is_none(self) -> None:
        # At Mach 2 the slowest wave, of speed V - a = V / 2, takes two chords of flight to cross one: t* = 4.
        for steps, duration, part in ((30, 3.0, "the response is not over"), (12, 6.0, "the time steps are too long")):
            found = self.step(5, freestream__mach=2.0, unsteady__steps=steps, unsteady__duration=duration)
            self.assertEqual(found["status"], "not_converged")
            self.assertIn(part, found["message"])
            self.assertTrue(all(not entry["converged"] for entry in found["derivatives"].values()))

    def test_a_large_step_is_not_linear(self) -> None:
        found = self.step(freestream__mach=2.0, motion__amplitude=5.0, unsteady__steps=60, unsteady__duration=6.0)["derivatives"]
        with tempfile.TemporaryDirectory() as folder:
            settings = {"reference.area": AREA["tiny"], "freestream.mach": 2.0}
            linear = run(Path(folder), "derivatives", "wedge/derivatives.toml", "wedge_tiny.msh", settings)["derivatives"]
        for name in ("CA_alpha", "CN_alpha", "Cm_alpha", "CN_alphadot", "Cm_alphadot"):
            with self.subTest(name):
                error = abs(found[name]["value"] - linear[name]["value"])
                self.assertLessEqual(error, found[name]["uncertainty"])
        self.assertGreater(abs(found["CN_alpha"]["value"] - linear["CN_alpha"]["value"]), 1e-3)  # or the test would show nothing


if __name__ == "__main__":
    TINY, COARSE = map(computed, ("tiny", "coarse"))
    unittest.main()
