"""The verb "adjoint": derivatives by adjoints against those of the forward solves, and against runs at other Mach numbers, gases
and shapes.

Environment: see program.py.
"""

from __future__ import annotations

import csv
import json
import tempfile
import unittest
from pathlib import Path

from program import CASE, RANKS, box, gmsh_text, run, write_case

EXACT = ("--set", "steady.orders=12", "--set", "derivatives.orders=10", "--set", "space.freeze_orders=0")
AS_ONE = 1e-8  # of forward and adjoint at ten decades


class AdjointTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = Path(temporary.name)
        write_case(cls.folder, CASE, gmsh_text(*box(3)))
        cls.done = cls.run_ok("adjoint", "adjoint", *EXACT, "--of", "CN,Cm,Cl,Cm_alphadot,CN_alphadot,CN@wall")

    @classmethod
    def run_ok(cls, verb: str, out: str, *arguments: str) -> str:
        done = run(cls.folder, verb, "case.toml", "--out", out, *arguments)
        if done.codes != [0] * RANKS:
            raise AssertionError(done.err)
        return done.err

    @classmethod
    def result(cls, out: str) -> dict:
        return json.loads((cls.folder / out / "result.json").read_text())

    def derivatives(self, out: str) -> dict[str, float]:
        return {name: entry["value"] for name, entry in self.result(out)["derivatives"].items()}

    def test_gives_those_of_the_forward_solves(self) -> None:
        self.run_ok("derivatives", "forward", *EXACT)
        forward, adjoint = self.derivatives("forward"), self.derivatives("adjoint")
        rates = ("CN_alphadot", "Cm_alphadot")
        names = [f"{load}_{by}" for load in ("CN", "Cm") for by in ("alpha", "q")] + ["Cl_beta", "Cl_p", "Cl_r", *rates]
        for name in names:
            self.assertAlmostEqual(adjoint[name], forward[name], delta=AS_ONE * abs(forward[name]), msg=name)
        for name in ("CN_alpha", "CN_q", "CN_mach"):  # there is no other wall
            self.assertAlmostEqual(adjoint[f"{name}@wall"], adjoint[name], delta=AS_ONE * abs(adjoint[name]))

    def test_what_the_steady_residual_leaves_is_in_the_uncertainty(self) -> None:
        self.run_ok("adjoint", "shallow", *EXACT, "--set", "steady.orders=6", "--of", "CN,Cm,Cl,Cm_alphadot")
        exact = self.derivatives("adjoint")
        for name, entry in self.result("shallow")["derivatives"].items():
            self.assertLessEqual(abs(entry["value"] - exact[name]), entry["uncertainty"], name)

    # Steady runs a little above and below; the step leaves errors of 1e-8 of truncation and 1e-7 of convergence.
    def test_gives_those_by_mach_number_and_gas(self) -> None:
        found = self.derivatives("adjoint")
        for key, about, step in (("mach", 2.0, 1e-4), ("gamma", 1.4, 1e-4)):
            forces = []
            for sign in (1, -1):
                self.run_ok("run", "moved", "--overwrite", *EXACT, "--set", f"freestream.{key}={about + sign * step}")
                forces.append(self.result("moved")["forces"])
            for load in ("CN", "Cm"):
                difference = (forces[0][load] - forces[1][load]) / (2 * step)
                self.assertAlmostEqual(found[f"{load}_{key}"], difference, delta=1e-5 * abs(difference), msg=f"{load} {key}")

    # The wall's points go up along a wave, by the table of the walls' sensitivity: those inside stay where they are.
    def test_gives_those_by_the_shape(self) -> None:
        with open(self.folder / "adjoint/surface_sensitivity.csv") as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        points, cells, patches = box(3)
        self.assertEqual(len(rows), 16)

        def up(x: float, y: float) -> float:
            return x * x + 0.3 * y

        step, forces = 1e-5, []
        for sign in (1, -1):
            moved = [(x, y, z + (sign * step * up(x, y) if z == 0 else 0)) for x, y, z in points]
            write_case(self.folder, CASE, gmsh_text(moved, cells, patches))
            self.run_ok("run", "moved", "--overwrite", *EXACT)
            forces.append(self.result("moved")["forces"])
        write_case(self.folder, CASE, gmsh_text(points, cells, patches))
        for load in ("CN", "Cm"):
            found = sum(up(float(row["x"]), float(row["y"])) * float(row[f"{load}_by_z"]) for row in rows)
            difference = (forces[0][load] - forces[1][load]) / (2 * step)
            self.assertAlmostEqual(found, difference, delta=1e-5 * abs(difference), msg=load)

    def test_writes_its_files(self) -> None:
        for name in ("adjoint.csv", "adjoint.vtkhdf", "surface_sensitivity.vtkhdf", "flow.vtkhdf", "resolved_case.toml"):
            self.assertTrue((self.folder / "adjoint" / name).is_file(), name)
        table = (self.folder / "adjoint/adjoint.csv").read_text()
        self.assertIn("\nCm_alphadot,", table)
        self.assertIn("moment centre", table)

    def test_goes_on_from_its_checkpoints(self) -> None:
        self.run_ok("adjoint", "part", *EXACT, "--of", "CN,Cm")
        said = self.run_ok("adjoint", "part", *EXACT, "--restart", "--of", "CN,Cm,Cl,Cm_alphadot,CN_alphadot,CN@wall")
        self.assertIn("2 adjoints are taken from the checkpoint", said)
        whole, part = self.derivatives("adjoint"), self.derivatives("part")
        for name, value in whole.items():
            self.assertAlmostEqual(part[name], value, delta=AS_ONE * max(abs(value), 1), msg=name)

    def test_says_what_was_not_reached(self) -> None:
        """A cut linear solve, and a steady flow that is no more than begun: forward solves at ten decades tell what is right."""
        for settings, part in (
            ({"derivatives.max_iterations": 2}, "the linear residual for the adjoint of CN dropped"),
            ({"steady.orders": 2}, "decades down"),
            ({"steady.max_iterations": 5}, "the steady residual dropped"),
        ):
            with self.subTest(settings):
                words = [word for key, value in settings.items() for word in ("--set", f"{key}={value}")]
                done = run(self.folder, "adjoint", "case.toml", "--out", "cut", "--overwrite", "--of", "CN,CN_alphadot", *words)
                self.assertEqual(done.codes, [5] * RANKS, done.err)
                found = self.result("cut")
                self.assertEqual(found["status"], "not_converged")
                self.assertIn(part, found["message"] + " ".join(found["not_reached"]))
                self.assertFalse(any(entry["converged"] for entry in found["derivatives"].values()))
                self.assertIn(part, done.err.splitlines()[-1])
                self.assertIn("# Status: not_converged", (self.folder / "cut/adjoint.csv").read_text())

    def test_an_indicator_says_what_was_not_reached(self) -> None:
        """It rests on adjoints, on responses and on one more adjoint. A later run without one leaves none of another flow behind."""
        done = run(self.folder, "adjoint", "case.toml", "--out", "indicated", "--indicator", "CN_alpha", "--set", "derivatives.max_iterations=2")
        self.assertEqual(done.codes, [5] * RANKS, done.err)
        said = " ".join(self.result("indicated")["not_reached"])
        for part in ("for the adjoint of CN dropped", "for alpha dropped", "for the adjoint of CN_alpha to the steady flow dropped"):
            self.assertIn(part, said)
        self.assertTrue((self.folder / "indicated/indicator.vtkhdf").exists())
        self.run_ok("adjoint", "indicated", "--overwrite", "--set", "freestream.mach=1.9", "--of", "CN")
        self.assertFalse((self.folder / "indicated/indicator.vtkhdf").exists())

    def test_says_what_is_wrong(self) -> None:
        for arguments, part in (
            (("--of", "Cd"), 'no load "Cd"'),
            (("--of", "Cm_alpha"), 'no load "Cm_alpha"'),
            (("--of", "CN@wall+wall"), "CN@wall+wall names a wall twice"),
            (("--of", "Cm@farfield"), '"farfield" is no wall'),
            (("--of", "Cl", "--set", "reference.model=half"), "Cl of a half model is zero"),
            (("--set", "steady.scheme=lu_sgs"), "block_lu_sgs"),
        ):
            done = run(self.folder, "adjoint", "case.toml", "--out", "wrong", *arguments)
            self.assertEqual(done.codes, [1] * RANKS)
            self.assertEqual(len(done.errors), 1, done.err)
            self.assertIn(part, done.errors[0])

    def test_a_load_asked_for_twice(self) -> None:
        """Also by the name of a set of walls, which stands for them."""
        self.run_ok("adjoint", "twice", *EXACT, "--set", 'components.all=["wall"]', "--of", "CN,CN,CN@wall,CN@all")
        self.assertEqual({name for name in self.result("twice")["derivatives"] if name.startswith("CN_alpha")}, {"CN_alpha", "CN_alpha@wall"})

    def test_says_all_that_is_wrong(self) -> None:
        done = run(self.folder, "adjoint", "case.toml", "--out", "wrong", "--of", "Cm,Cd,CN@nose")
        self.assertEqual(done.codes, [1] * RANKS)
        self.assertEqual(len(done.errors), 2, done.err)
        for part in ('no load "Cd"', '"nose" is no wall'):
            self.assertIn(part, done.err)


if __name__ == "__main__":
    unittest.main()
