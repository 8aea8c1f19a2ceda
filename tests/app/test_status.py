#!/usr/bin/python3
"""What was asked for and not reached: a status and an exit code of its own, in everything that a run prints and leaves."""

from __future__ import annotations

import csv
import json
import re
import tempfile
import unittest
from pathlib import Path

from program import CASE, RANKS, Outcome, box, gmsh_text, run, write_case

NOT_CONVERGED = 5
CUT_SOLVE = ("--set", "derivatives.max_iterations=2")
CUT_MARCH = ("--set", "steady.max_iterations=5")
PLUNGE = """
[motion]
kind = "plunge"
reduced_frequency = 0.02

[unsteady]
steps_per_cycle = 16
"""
STEPS, FITTED = 24, 17  # of the default one and a half cycles; from the end of the first half on


class Status(unittest.TestCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        write_case(self.folder, CASE + PLUNGE, gmsh_text(*box(3)))

    def run_short(self, verb: str, *arguments: str) -> Outcome:
        outcome = run(self.folder, verb, "case.toml", "--out", "out", "--overwrite", *arguments)
        self.assertEqual(outcome.codes, [NOT_CONVERGED] * RANKS, outcome.err)
        return outcome

    def result(self, folder: str = "out") -> dict:
        return json.loads((self.folder / folder / "result.json").read_text())

    def text(self, name: str) -> str:
        return (self.folder / "out" / name).read_text()

    def assert_everything_says(self, outcome: Outcome, *words: str) -> None:
        """The last printed line, result.json and what watch shows; words are regular expressions."""
        self.assertRegex(outcome.err.splitlines()[-1], "^not converged: ")
        result = self.result()
        self.assertEqual(result["status"], "not_converged")
        watched = run(self.folder, "watch", "out", "--once", ranks=1).out
        for word in words:
            self.assertRegex(outcome.err.splitlines()[-1], word)
            self.assertRegex(" ".join(result["not_reached"]), word)
            self.assertRegex(watched, f"state +not_converged: .*{word}")

    def assert_tables_say(self, word: str) -> None:
        for name in ("derivatives.csv", "derivatives.stability_axes.csv"):
            self.assertRegex(self.text(name), f"(?m)^# Status: not_converged: .*{word}")
        self.assertRegex(self.text("derivatives.st"), f"(?m)Status: not_converged: .*{word}")
        self.assertRegex(self.text("derivatives.jsbsim.xml"), f"(?m)^ +Status: not_converged: .*{word}")

    def test_linear_solves(self) -> None:
        """Five hundredths are left where a thousandth was asked for."""
        outcome = self.run_short("derivatives", *CUT_SOLVE)
        reached = r"the linear residual for alpha dropped [0-2]\.\d of 3 decades in 2 iterations"
        self.assert_everything_says(outcome, reached)
        self.assert_tables_say(reached)
        self.assertEqual({entry["converged"] for entry in self.result()["derivatives"].values()}, {False})
        self.assertRegex(outcome.out, r"\nCm_alpha .*; not converged\n")

    def test_only_what_rests_on_a_cut_solve_is_marked(self) -> None:
        """alphadot needs no more iterations than alpha, but its right-hand side is alpha's response."""
        run(self.folder, "derivatives", "case.toml", "--out", "whole")
        counts = re.findall(r"(\w+) +(\d+) iterations", run(self.folder, "derivatives", "case.toml", "--out", "whole").err)
        first, second = int(dict(counts)["alpha"]), int(dict(counts)["alphadot"])
        cut = min(first, second) - 1 if first != second else first - 1
        outcome = run(self.folder, "derivatives", "case.toml", "--out", "out", "--set", f"derivatives.max_iterations={cut}")
        self.assertEqual(outcome.codes, [NOT_CONVERGED] * RANKS, outcome.err)
        result = self.result()
        short = {re.search(r"for (\w+) ", line)[1] for line in result["not_reached"]}
        marked = {name.split("_")[1] for name, entry in result["derivatives"].items() if not entry["converged"]}
        self.assertEqual(marked, short | ({"alphadot"} if "alpha" in short else set()))
        with open(self.folder / "out" / "derivatives.csv") as file:
            rows = list(csv.DictReader(line for line in file if line[0] != "#"))
        for row in rows:
            if row["name"] in result["derivatives"]:
                self.assertEqual(row["converged"] == "yes", result["derivatives"][row["name"]]["converged"])

    def test_march_of_the_linear_response(self) -> None:
        outcome = self.run_short("derivatives", "--set", "derivatives.method=march", *CUT_SOLVE)
        self.assert_everything_says(outcome, r"the linear residual for alpha dropped -?\d\.\d of 3 decades")

    def test_steady_march(self) -> None:
        reached = r"the steady residual dropped \d\.\d of 10 decades in 5 iterations"
        outcome = self.run_short("derivatives", *CUT_MARCH)
        self.assert_everything_says(outcome, reached)
        self.assert_tables_say(reached)
        self.assertEqual({entry["converged"] for entry in self.result()["derivatives"].values()}, {False})
        outcome = self.run_short("run", "--set", "motion.kind=none", *CUT_MARCH)
        self.assert_everything_says(outcome, reached)

    def test_a_motion_does_not_forget_its_steady_flow(self) -> None:
        reached = r"the steady residual dropped \d\.\d of 10 decades in 5 iterations"
        for arguments in (CUT_MARCH, ("--restart", *CUT_MARCH)):
            outcome = self.run_short("run", *arguments)
            self.assert_everything_says(outcome, reached)
            self.assertRegex(self.text("history.csv"), f"(?m)^# Status: not_converged: {reached}, worst: cell ")
            self.assertEqual({entry["converged"] for entry in self.result()["derivatives"].values()}, {False})
        derived = run(self.folder, "derive", "out/history.h5", ranks=1).out
        self.assertRegex(derived, f"(?m)^Status: not_converged: {reached}, worst: cell ")

    def test_inner_iterations(self) -> None:
        outcome = self.run_short("run", "--set", "unsteady.inner_tolerance=1e-7", "--set", "unsteady.max_inner=3")
        self.assert_everything_says(outcome, rf"the inner iterations of {FITTED} of {FITTED} time steps left up to \S+ times what")
        self.assertEqual({entry["converged"] for entry in self.result()["derivatives"].values()}, {False})

    def test_coarser_mesh(self) -> None:
        (self.folder / "box2.msh").write_text(gmsh_text(*box(2)))
        outcome = self.run_short("derivatives", "--set", 'derivatives.coarser_meshes=["box2.msh"]', *CUT_MARCH)
        self.assert_everything_says(outcome, r"on \S*box2.msh: the steady residual dropped")
        self.assertEqual(self.result("out/mesh_2")["status"], "not_converged")

    def test_what_was_reached_says_nothing(self) -> None:
        outcome = run(self.folder, "derivatives", "case.toml", "--out", "out")
        self.assertEqual(outcome.codes, [0] * RANKS, outcome.err)
        self.assertRegex(outcome.err.splitlines()[-1], "^converged; written to out$")
        self.assertEqual(self.result()["not_reached"], [])
        self.assertEqual({entry["converged"] for entry in self.result()["derivatives"].values()}, {True})
        self.assertIn("# Status: converged\n", self.text("derivatives.csv"))

    def test_uncertainty_without_the_mesh_is_called_so(self) -> None:
        outcome = run(self.folder, "derivatives", "case.toml", "--out", "out")
        self.assertIn("\nUncertainty: solver only; mesh not assessed\n", outcome.out)
        self.assertRegex(outcome.out, r"\nname +value +solver only +linear +steady +method\n")
        self.assertIn("# Uncertainty: solver only; mesh not assessed\n", self.text("derivatives.csv"))
        self.assertIn("# Uncertainty: solver only; mesh not assessed\n", self.text("derivatives.stability_axes.csv"))
        self.assertEqual(self.result()["uncertainty"], "solver only; mesh not assessed")
        (self.folder / "box2.msh").write_text(gmsh_text(*box(2)))
        meshes = 'derivatives.coarser_meshes=["box2.msh"]'
        outcome = run(self.folder, "derivatives", "case.toml", "--out", "out", "--set", meshes)
        self.assertRegex(outcome.out, r"\nname +value +uncertainty +linear +steady +mesh +method\n")
        self.assertIn("# Uncertainty: solver and mesh\n", self.text("derivatives.csv"))
        self.assertEqual(self.result()["uncertainty"], "solver and mesh")


class Motions(unittest.TestCase):
    """Those that cannot give derivatives are refused before anything is computed, and by check; one step more is not."""

    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        write_case(self.folder)

    def outcome(self, verb: str, settings: dict[str, object]) -> Outcome:
        return run(self.folder, verb, "case.toml", *(word for key, value in settings.items() for word in ("--set", f"{key}={value}")))

    def test_limits(self) -> None:
        harmonic = {"motion.kind": "pitch"}
        short = {"unsteady.duration": 4}
        for settings, key, refused, least in (
            (harmonic, "unsteady.cycles", 1.25, 1.5),
            (harmonic, "unsteady.steps_per_cycle", 12, 13),
            (harmonic, "unsteady.max_inner", 2, 3),
            ({"motion.kind": "step_alpha"} | short, "unsteady.steps", 10, 11),
            ({"motion.kind": "step_q", "motion.amplitude": 0.01} | short, "unsteady.steps", 10, 11),
            ({"motion.kind": "ramp_alpha"} | short, "unsteady.steps", 13, 14),
        ):
            for verb in ("check", "run"):
                with self.subTest(key, verb=verb, settings=settings):
                    outcome = self.outcome(verb, settings | {key: refused})
                    self.assertEqual(outcome.codes, [1] * RANKS, outcome.err)
                    self.assertEqual(len(outcome.errors), 1)
                    self.assertIn(f"{key}", outcome.err)
                    self.assertRegex(outcome.err, rf"\b{least}\b")
                    self.assertNotIn("steady ", outcome.err)
            with self.subTest(key, settings=settings, least=least):
                out = f"{settings['motion.kind']}_{key}"
                outcome = self.outcome("run", settings | {key: least, "output.folder": out})
                self.assertIn(outcome.codes, ([0] * RANKS, [NOT_CONVERGED] * RANKS), outcome.err)
                result = json.loads((self.folder / out / "result.json").read_text())
                self.assertGreater(len(result["derivatives"]), 0, outcome.err)


if __name__ == "__main__":
    unittest.main()
