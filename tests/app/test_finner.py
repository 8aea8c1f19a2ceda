#!/usr/bin/python3
"""Steady flow over the Basic Finner on a small mesh: symmetries, high incidence, and independence of the number of ranks.

Arguments: the meshes of the half and the full model, and those of unittest.
"""

from __future__ import annotations

import json
import sys
import tempfile
import unittest
from pathlib import Path

from program import run

CASES = Path(__file__).resolve().parents[2] / "cases" / "basic_finner"
HALF, FULL = CASES / "derivatives.toml", CASES / "roll.toml"


def steady_forces(mesh: Path, ranks: int, alpha: float, beta: float = 0.0, case: Path = HALF) -> dict[str, float]:
    """Converged coefficients of the whole configuration at Mach 2.5."""
    overrides = []
    for setting in (
        f"mesh.file={mesh}", f"freestream.alpha={alpha}", f"freestream.beta={beta}", "output.flow=false", "output.surface=false",
    ):  # fmt: skip
        overrides += ["--set", setting]
    with tempfile.TemporaryDirectory() as folder:
        outcome = run(Path(folder), "run", case, "--out", "run", "--quiet", *overrides, ranks=ranks)
        if outcome.codes != [0] * ranks:
            raise AssertionError(outcome.err)
        result = json.loads((Path(folder) / "run" / "result.json").read_text())
    assert result["status"] == "converged", result["message"]
    return {name: result["forces"][name] for name in ("CA", "CY", "CN", "Cm", "Cn")}


class Finner(unittest.TestCase):
    mesh: Path
    full_mesh: Path

    def test_no_normal_force_and_no_moment_at_zero_incidence(self) -> None:
        forces = steady_forces(self.mesh, 2, 0.0)
        self.assertGreater(forces["CA"], 0.05)
        self.assertLess(abs(forces["CN"]), 1e-6)
        self.assertLess(abs(forces["Cm"]), 1e-6)

    def test_converges_where_cells_would_run_into_vacuum(self) -> None:
        # Behind the fins' trailing edges, from 15 degrees on.
        for alpha in (15.0, 20.0):
            with self.subTest(alpha=alpha):
                steady_forces(self.mesh, 1, alpha)

    def test_sideslip_is_incidence_turned_by_a_right_angle(self) -> None:
        # Four fins alike. The mesh is not the same after the turn: its error remains, 0.6 % of the force and 1.9 % of the moment.
        up = steady_forces(self.full_mesh, 1, 5.0, case=FULL)
        aside = steady_forces(self.full_mesh, 1, 0.0, 5.0, case=FULL)
        self.assertAlmostEqual(aside["CY"], -up["CN"], delta=0.01 * up["CN"])
        self.assertAlmostEqual(aside["Cn"], -up["Cm"], delta=0.03 * abs(up["Cm"]))
        for forces, names in ((up, ("CY", "Cn")), (aside, ("CN", "Cm"))):
            for name in names:
                self.assertLess(abs(forces[name]), 1e-6, name)

    def test_same_at_any_number_of_ranks(self) -> None:
        alone = steady_forces(self.mesh, 1, 1.5)
        for ranks in (2, 3, 4):
            together = steady_forces(self.mesh, ranks, 1.5)
            for name, value in alone.items():
                with self.subTest(ranks=ranks, name=name):
                    self.assertAlmostEqual(together[name], value, delta=1e-6 * abs(value))


if __name__ == "__main__":
    Finner.mesh, Finner.full_mesh = (Path(sys.argv.pop(1)).resolve() for _ in range(2))
    unittest.main()
