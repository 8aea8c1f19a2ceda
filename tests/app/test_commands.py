#!/usr/bin/python3
"""The verbs of the program on a plunge over the wall of a tiny box: what they print, and the files that a run leaves."""

from __future__ import annotations

import csv
import json
import math
import tempfile
import unittest
from pathlib import Path
from subprocess import PIPE
from subprocess import run as call

from program import CASE, PROGRAM, RANKS, Outcome, box, gmsh_text, run, write_case

PLUNGE = """
[motion]
kind = "plunge"
reduced_frequency = 0.02

[unsteady]
steps_per_cycle = 16
"""
CUBES = 6  # along each edge of the box
CELLS = 6 * CUBES**3
STEPS = 24  # of the default one and a half cycles


class Commands(unittest.TestCase):
    folder: Path
    outcome: Outcome

    @classmethod
    def setUpClass(cls) -> None:
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = Path(temporary.name)
        write_case(cls.folder, CASE + PLUNGE, gmsh_text(*box(CUBES)))
        cls.outcome = run(cls.folder, "run", "case.toml", "--out", "plunge")

    def succeeded(self, *arguments: str) -> str:
        """What the program prints."""
        outcome = run(self.folder, *arguments)
        self.assertEqual(outcome.codes, [0] * RANKS, outcome.err)
        self.assertEqual(outcome.err, "")
        return outcome.out

    def result(self, folder: str = "plunge") -> dict:
        return json.loads((self.folder / folder / "result.json").read_text())

    def test_run_succeeds(self) -> None:
        self.assertEqual(self.outcome.codes, [0] * RANKS, self.outcome.err)
        self.assertRegex(self.outcome.out, r"\nCm_alphadot +-?\d")
        for text in ("Reference: length", "Steady: CA"):  # results, not progress
            self.assertIn(text, self.outcome.out)
            self.assertNotIn(text, self.outcome.err)

    def test_result(self) -> None:
        result = self.result()
        self.assertEqual(result["status"], "completed")
        self.assertEqual(result["ranks"], RANKS)
        self.assertEqual(result["mesh"]["cells"], CELLS)
        self.assertLessEqual({"length", "area", "moment_center", "rate", "axes"}, result["reference"].keys())
        self.assertLessEqual({"CA", "CY", "CN", "Cl", "Cm", "Cn"}, result["forces"].keys())
        for name in ("CN_alpha", "Cm_alpha", "CN_alphadot", "Cm_alphadot"):
            entry = result["derivatives"][name]
            self.assertEqual(entry.keys(), {"value", "uncertainty", "method", "converged", "parts"})
            self.assertIs(entry["converged"], True)
            self.assertEqual(entry["parts"].keys(), {"fit", "inner", "time_step", "amplitude", "bends"})
            self.assertAlmostEqual(sum(entry["parts"].values()), entry["uncertainty"], delta=1e-12)
        self.assertEqual(result["uncertainty"], "solver only; mesh not assessed")
        self.assertEqual(result["not_reached"], [])
        cost = result["performance"]
        for name in ("wall_s", "cpu_s", "iterations", "core_us_per_cell_iteration", "bytes_per_cell", "checkpoint_wall_s"):
            self.assertGreater(cost[name], 0)
        self.assertLess(cost["checkpoint_wall_s"], cost["wall_s"])
        self.assertEqual(cost["checkpoints"], 2)  # after the steady state and at the end
        self.assertEqual(cost["restart_wall_s"], 0)
        self.assertRegex(result["provenance"]["version"], r"^\d+\.\d+\.\d+")

    def table(self, folder: str) -> dict[str, dict[str, str]]:
        """Rows of derivatives.csv by their names."""
        with open(self.folder / folder / "derivatives.csv") as file:
            return {row["name"]: row for row in csv.DictReader(line for line in file if not line.startswith("#"))}

    def assert_flat_plate(self, derivatives: dict) -> None:
        """The wall is the upper side of a plate at Mach 2, whose leading edge is the moment centre.

        Busemann: CN = c1 alpha - c2 alpha^2. Linear theory for slow plunge: Cp = -c1 (alpha - alphadot x / (V beta^2)).
        """
        gamma, beta2 = 1.4, 2.0**2 - 1.0
        c1 = 2.0 / math.sqrt(beta2)
        c2 = ((gamma + 1.0) * 2.0**4 - 4.0 * beta2) / (2.0 * beta2**2)
        slope = c1 - 2.0 * c2 * math.radians(1.0)
        exact = {"CN_alpha": (slope, 0.01), "Cm_alpha": (-slope / 2.0, 0.01), "CN_alphadot": (-c1 / beta2, 0.05)}
        for name, (value, tolerance) in exact.items():
            with self.subTest(name):
                self.assertAlmostEqual(derivatives[name]["value"], value, delta=tolerance * abs(value))

    def assert_balance(self, result: dict, rows: dict[str, dict[str, str]]) -> None:
        """The load of a plate in incidence acts in its middle, half a length behind the moment centre at x = 0."""
        force, moment = (result["derivatives"][name] for name in ("CN_alpha", "Cm_alpha"))
        margin = -moment["value"] / force["value"]
        error = (moment["uncertainty"] + margin * force["uncertainty"]) / force["value"]
        linear = (moment["parts"]["linear"] + margin * force["parts"]["linear"]) / force["value"]
        self.assertAlmostEqual(margin, 0.5, delta=0.005)
        for name, in_result in (("static_margin", "static_margin"), ("neutral_point_x", "neutral_point")):
            self.assertAlmostEqual(float(rows[name]["value"]), margin, delta=1e-12)
            self.assertAlmostEqual(float(rows[name]["uncertainty"]), error, delta=1e-12)
            self.assertAlmostEqual(float(rows[name]["linear"]), linear, delta=1e-12)
            self.assertEqual(result["longitudinal"][f"{in_result}_uncertainty"], float(rows[name]["uncertainty"]))

    def test_derivatives_of_the_plunge(self) -> None:
        self.assert_flat_plate(self.result()["derivatives"])

    def test_derivatives_by_linear_solves(self) -> None:
        printed = run(self.folder, "derivatives", "case.toml", "--out", "linear").out
        result = self.result("linear")
        self.assertEqual(result["status"], "converged")
        self.assert_flat_plate(result["derivatives"])
        self.assertLess(result["derivatives"]["CN_alphadot"]["uncertainty"], 1e-3)
        self.assert_balance(result, self.table("linear"))
        self.assertRegex(printed, r"\nneutral_point_x +0\.50\d+ ± \S+ +\S+ +\S+ +centre \+ margin")

    def test_uncertainty_of_the_limiter(self) -> None:
        limiter_part = {}
        for limiter in ("venkatakrishnan", "none"):
            changes = (f"space.limiter={limiter}", "space.limiter_threshold=0.01", "derivatives.limiter_uncertainty=true")
            options = [word for change in changes for word in ("--set", change)]
            self.succeeded("derivatives", "case.toml", *options, "--out", limiter, "--quiet")
            found = self.result(limiter)["derivatives"]
            for entry in found.values():
                self.assertEqual(entry["parts"].keys(), {"linear", "steady", "limiter"})
                self.assertAlmostEqual(sum(entry["parts"].values()), entry["uncertainty"], delta=1e-15)
            rows = self.table(limiter)
            limiter_part[limiter] = {name: float(row["limiter"]) for name, row in rows.items()}
            for name, entry in found.items():
                self.assertEqual(float(rows[name]["limiter"]), entry["parts"]["limiter"])
        self.assertGreater(limiter_part["venkatakrishnan"]["CN_alphadot"], 1e-4)
        self.assertEqual(set(limiter_part["none"].values()), {0.0})

    def test_history(self) -> None:
        with open(self.folder / "plunge" / "history.csv") as file:
            lines = list(file)
        self.assertIn("# Status: completed\n", lines)
        rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
        self.assertEqual(len(rows), STEPS)
        self.assertEqual(float(rows[-1]["step"]), STEPS)
        for column in ("t_star", "alpha", "total/CN", "total/Cm", "error/Cm", "wall/Cm"):
            self.assertIn(column, rows[0])
        quarter = math.degrees(float(rows[3]["alpha"]))  # of a cycle
        self.assertAlmostEqual(quarter, 1.0 + 1.0, places=9)

    def test_pictures_are_vtkhdf(self) -> None:
        for name in ("flow.vtkhdf", "surface.vtkhdf"):
            content = (self.folder / "plunge" / name).read_bytes()
            self.assertTrue(content.startswith(b"\x89HDF"))
            self.assertIn(b"UnstructuredGrid", content)

    def test_resolved_case_gives_the_same_run(self) -> None:
        self.succeeded("run", "plunge/resolved_case.toml", "--out", "again", "--quiet")
        first, again = (self.result(folder)["derivatives"]["Cm_alphadot"]["value"] for folder in ("plunge", "again"))
        self.assertAlmostEqual(first, again, delta=1e-9)

    def test_derive(self) -> None:
        """The history and the result of a motion say the same, also about another centre."""
        derivatives = {name: entry["value"] for name, entry in self.result()["derivatives"].items()}
        self.assertIn("Cm_alphadot", self.succeeded("derive", "plunge/history.h5"))
        words = ("--center", 0, "--center", 0.25, "--json")
        items = json.loads(self.succeeded("derive", "plunge/history.h5", "plunge/result.json", *words))
        for history, result in zip(items[:2], items[2:], strict=True):
            steps, steady = history.pop("loads"), result.pop("loads")
            self.assertEqual(history | {"file": "plunge/result.json"}, result)
            self.assertEqual([len(column) for column in (*steps.values(), *steady.values())], 6 * [STEPS] + 6 * [1])
            dx = history["center"][0]
            self.assertAlmostEqual(steady["Cm"][0], self.result()["forces"]["Cm"] + dx * self.result()["forces"]["CN"], delta=1e-12)
            with open(self.folder / "plunge" / "history.csv") as file:
                rows = csv.DictReader(line for line in file if not line.startswith("#"))
                recorded = [float(row["total/Cm"]) + dx * float(row["total/CN"]) for row in rows]
            for found, expected in zip(steps["Cm"], recorded, strict=True):
                self.assertAlmostEqual(found, expected, delta=1e-12)
        self.assertEqual({name: entry["value"] for name, entry in items[0]["derivatives"].items()}, derivatives)
        moved = derivatives["Cm_alpha"] + 0.25 * derivatives["CN_alpha"]
        self.assertAlmostEqual(items[1]["derivatives"]["Cm_alpha"]["value"], moved, delta=1e-12)

    def test_info(self) -> None:
        self.assertIn(f"{CELLS} tetrahedra", self.succeeded("info", "box.msh"))
        self.assertIn(f"{STEPS} steps", self.succeeded("info", "plunge/history.h5"))
        self.assertIn('"status": "completed"', self.succeeded("info", "plunge/result.json"))

    def test_info_of_checkpoints(self) -> None:
        first, last = sorted((self.folder / "plunge").glob("checkpoint_*.vtkhdf"))
        steady = self.succeeded("info", first)
        for part in ("whole", "steady march, iteration ", f"{CELLS} cells, hash ", "states: flow", "alphadot 0.", "mach = 2.0"):
            self.assertIn(part, steady)
        motion = self.succeeded("info", last)
        time = 2 * math.pi * 1.5 / 0.02  # k t* is the phase
        for part in (f"motion (plunge), step {STEPS}, t* = {time:.6g}", "latest_level", f"history: {STEPS} steps"):
            self.assertIn(part, motion)
        cut = self.folder / "cut.vtkhdf"
        cut.write_bytes(last.read_bytes()[:-1])
        done = run(self.folder, "info", cut, ranks=1)
        self.assertEqual(done.codes, [1])
        self.assertIn("not a whole checkpoint: it is cut short", done.err)

    def test_check(self) -> None:
        self.assertIn(f"{CELLS} cells", self.succeeded("check", "case.toml"))

    def test_keys(self) -> None:
        self.assertIn("reduced_frequency", self.succeeded("keys"))

    def test_what_cannot_be_printed(self) -> None:
        """Also of what fits into the buffer, so that its loss is seen at the end only."""
        result = str(self.folder / "plunge/result.json")
        for arguments in (["keys"], ["check", "case.toml"], ["derive", result], ["info", result]):
            with self.subTest(verb=arguments[0]), open("/dev/full", "w") as full:
                done = call([PROGRAM, *arguments], cwd=self.folder, stdout=full, stderr=PIPE, text=True)
                self.assertEqual(done.returncode, 1)
                self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
                self.assertRegex(done.stderr, "error: standard output: .*No space left on device; ")

    def test_help_names_the_verbs(self) -> None:
        text = self.succeeded("--help")
        for verb in ("run", "derivatives", "adjoint", "check", "derive", "info"):
            self.assertRegex(text, rf"\n  {verb} ")

    def test_version(self) -> None:
        self.assertRegex(self.succeeded("--version"), r"^alphadot \d+\.\d+\.\d+")


if __name__ == "__main__":
    unittest.main()
