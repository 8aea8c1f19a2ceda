"""The verb "frequency": joins the limit of low frequency, says what was not reached, goes on from its checkpoints.

Environment: see program.py.
"""

from __future__ import annotations

import csv
import json
import math
import tempfile
import unittest
from pathlib import Path

import numpy as np
from program import CASE, RANKS, Outcome, box, gmsh_text, run, write_case


class FrequencyTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = Path(temporary.name)
        write_case(cls.folder, CASE, gmsh_text(*box(3)))

    def run_as(self, code: int, verb: str, out: str, *arguments: str) -> Outcome:
        done = run(self.folder, verb, "case.toml", "--out", out, *arguments)
        self.assertEqual(done.codes, [code] * RANKS, done.err)
        return done

    def derivatives(self, out: str) -> dict[str, dict]:
        return json.loads((self.folder / out / "result.json").read_text())["derivatives"]

    def test_joins_the_limit(self) -> None:
        """What the second order adds at k = 0.001 is 1e-6 of the derivatives, by the rate of a body one length long."""
        self.run_as(0, "derivatives", "limit", "--set", "derivatives.orders=8")
        self.run_as(0, "frequency", "slow", "--k", "0.001")
        limit, slow = self.derivatives("limit"), self.derivatives("slow")
        for name in [f"{load}_{by}" for load in ("CN", "Cm") for by in ("alpha", "q", "alphadot")] + ["CY_beta", "Cl_p", "Cn_r", "CY_betadot"]:
            entry = slow[f"{name}, k = 0.001"]
            allowed = entry["uncertainty"] + limit[name]["uncertainty"] + 1e-5 * abs(limit[name]["value"])
            self.assertLessEqual(abs(entry["value"] - limit[name]["value"]), allowed, name)
            self.assertLess(entry["uncertainty"], 0.01 * max(1, abs(entry["value"])), name)
        both = slow["Cm_q, k = 0.001"]["value"] + slow["Cm_alphadot, k = 0.001"]["value"]
        self.assertAlmostEqual(slow["Cm_q_plus_alphadot, k = 0.001"]["value"], both)

    def test_what_the_steady_residual_leaves_is_in_the_uncertainty(self) -> None:
        """Of a flow six decades down; against one twelve decades down, by linear solves of the same depth."""
        for out, orders in (("shallow", 6), ("deep", 12)):
            words = ("steady.orders=%d" % orders, "derivatives.orders=9", "space.freeze_orders=0")
            self.run_as(0, "frequency", out, "--k", "0.1,0.5", *(part for word in words for part in ("--set", word)))
        exact = self.derivatives("deep")
        for name, entry in self.derivatives("shallow").items():
            self.assertLessEqual(abs(entry["value"] - exact[name]["value"]), entry["uncertainty"] + exact[name]["uncertainty"], name)

    def test_table(self) -> None:
        """Parts sum to the whole; modulus and phase are those of both parts; frequencies in order, each once."""
        self.run_as(0, "frequency", "table", "--k", "0.5,0.1,0.5")
        with open(self.folder / "table/frequency.csv") as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        self.assertEqual([k for k in dict.fromkeys(row["k"] for row in rows)], [f"{k:.17g}" for k in (0.1, 0.5)])
        total, wall = ([row for row in rows if row["part"] == part] for part in ("total", "wall"))
        self.assertEqual(len(total), 2 * 5 * 6)
        for whole, part in zip(total, wall, strict=True):
            for column in ("in_phase", "out_of_phase"):
                self.assertAlmostEqual(float(whole[column]), float(part[column]))
            response = complex(float(whole["in_phase"]), float(whole["k"]) * float(whole["out_of_phase"]))
            self.assertAlmostEqual(float(whole["modulus"]), abs(response))
            self.assertAlmostEqual(math.cos(math.radians(float(whole["phase_deg"]))) * abs(response), response.real)

    def test_rational_fit(self) -> None:
        """The states of its file, solved for by numpy, answer as the table says, within the errors that it states."""
        self.run_as(0, "frequency", "fit", "--k", "0.02,0.1,0.2,0.3,0.4,0.5")
        read = lambda name: list(csv.DictReader(line for line in (self.folder / "fit" / name).read_text().splitlines() if line[0] != "#"))
        fit, table = read("rational_fit.csv"), [row for row in read("frequency.csv") if row["part"] == "total"]
        self.assertEqual({row["variable"] for row in fit}, {"alpha", "q", "beta", "p", "r"})
        for variable, load in (("alpha", "CN"), ("alpha", "Cm"), ("q", "Cm"), ("beta", "Cl")):
            entries = {(row["matrix"], row["row"], row["column"]): float(row["value"]) for row in fit if row["variable"] == variable}
            states = [str(n + 1) for n in range(sum(matrix == "c" and row == load for matrix, row, _ in entries))]
            a = np.array([[entries.get(("A", i, j), 0.0) for j in states] for i in states])
            b, c = np.array([entries.get(("b", i, "1"), 0.0) for i in states]), np.array([entries["c", load, n] for n in states])
            self.assertLess(max(np.linalg.eigvals(a).real), 0)
            rows = [row for row in table if (row["variable"], row["coefficient"]) == (variable, load)]
            self.assertEqual(len(rows), 6)
            size = max(float(row["modulus"]) for row in rows)
            for row in rows:
                k = float(row["k"])
                found = c @ np.linalg.solve(1j * k * np.eye(len(states)) - a, b) + entries["d", load, "1"]
                error = abs(found - complex(float(row["in_phase"]), k * float(row["out_of_phase"])))
                self.assertLessEqual(error, entries["error", load, "1"] * size * 1.0001 + 1e-12, (variable, load, k))
            self.assertLess(entries["error", load, "1"], 0.05)
        self.run_as(0, "frequency", "few", "--k", "0.1,0.2,0.3")
        self.assertFalse((self.folder / "few/rational_fit.csv").exists())

    def test_says_what_was_not_reached(self) -> None:
        for settings, part in (
            ({"derivatives.max_iterations": 2}, "the linear residual for alpha at k = 0.1 dropped"),
            ({"steady.orders": 2}, "decades down"),
        ):
            with self.subTest(settings):
                words = [word for key, value in settings.items() for word in ("--set", f"{key}={value}")]
                done = self.run_as(5, "frequency", "cut", "--overwrite", "--k", "0.1", *words)
                self.assertIn(part, done.err.splitlines()[-1])
                self.assertFalse(any(entry["converged"] for entry in self.derivatives("cut").values()))
                self.assertIn("# Status: not_converged", (self.folder / "cut/frequency.csv").read_text())

    def test_cut_solves_are_within_their_errors(self) -> None:
        self.run_as(0, "frequency", "exact", "--k", "0.3", "--set", "derivatives.orders=8")
        self.run_as(0, "frequency", "loose", "--k", "0.2,0.3", "--set", "derivatives.orders=1")
        exact, loose = self.derivatives("exact"), self.derivatives("loose")
        for name, entry in exact.items():
            error = abs(loose[name]["value"] - entry["value"])
            self.assertLessEqual(error, loose[name]["uncertainty"] + entry["uncertainty"], name)

    def test_goes_on_from_its_checkpoints(self) -> None:
        """What was solved for stays; the rest may begin from something else, and ends within what is printed."""
        self.run_as(0, "frequency", "whole", "--k", "0.1,0.2")
        self.run_as(0, "frequency", "part", "--k", "0.1")
        before = self.derivatives("part")
        done = self.run_as(0, "frequency", "part", "--k", "0.1,0.2", "--restart")
        self.assertIn("5 linear solves are taken from the checkpoint", done.err)
        whole, part = self.derivatives("whole"), self.derivatives("part")
        self.assertEqual(part.keys(), whole.keys())
        for name, entry in before.items():
            self.assertEqual(part[name]["value"], entry["value"], name)
        for name, entry in whole.items():
            allowed = entry["uncertainty"] + part[name]["uncertainty"]
            self.assertLessEqual(abs(part[name]["value"] - entry["value"]), allowed, name)

    def test_refuses(self) -> None:
        for k in ("0", "-1", "nan", "x", "1e9"):
            done = run(self.folder, "frequency", "case.toml", "--k", k)
            self.assertEqual(done.codes, [2] * RANKS, k)
        self.assertEqual(run(self.folder, "frequency", "case.toml").codes, [2] * RANKS)


if __name__ == "__main__":
    unittest.main()
