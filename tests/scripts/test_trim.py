#!/usr/bin/python3
"""Trim, for a configuration whose loads are bilinear in incidence and deflection: the zeros are those of a root finder on its formulas."""

from __future__ import annotations

import csv
import json
import math
import unittest

from scipy.optimize import brentq, fsolve
from stub_runs import finish
from workspace import Workspace

from sweep.plan import Run, read_sweep

HEAD = 'case = "missile.toml"\nfolder = "runs"\n[controls]\npitch = {canard = [1, 1, -1, -1]}\n'
RUNS = "[[runs]]\nmach = [1.5, 2]\nalpha = [0, 4, 10]\ndeflection.pitch = [-5, 0, 5]\n"


def loads(mach: float, alpha: float, degrees: float) -> dict[str, float]:
    """Of everything, by degrees: a tail behind the centre, a canard before it whose wash takes part of the tail away."""
    a, d = alpha / 10, degrees / 10
    return {
        "CN": (4 * a + 0.6 * d - 0.3 * a * d) / mach, "CA": 0.2 + 0.05 * a + 0.02 * a * d,
        "Cm": (-6 * a + 5 * d + 1.5 * a * d + 0.4) / mach,
        "CN_alpha": 23 + 2 * a, "Cm_alpha": -34 + 9 * d, "Cm_q": -300 - 20 * a, "Cm_alphadot": -50 + 30 * a * d, "Ch": 0.1 * a + 0.3 * d,
    }  # fmt: skip


def leave(run: Run, degrees: float, more: dict[str, float], status: str = "converged") -> None:
    """The run's folder, with the panel's hinge moment."""
    found = loads(run.mach, run.alpha, degrees)
    derivatives = {name: value for name, value in found.items() if "_" in name} | more
    finish([run], lambda *_: ({name: found[name] for name in ("CN", "CA", "Cm")}, derivatives), lambda _: status)
    file = run.folder / "result.json"
    result = json.loads(file.read_text())
    result["forces"]["panels"] = {"canard_1": {"CNp": 1.0, "Ch": found["Ch"], "Cb": 1.0, "x_cp": 0.0, "s_cp": 0.0}}
    file.write_text(json.dumps(result))


class Trim(Workspace):
    def made(self, blocks: str = RUNS, ends: dict[str, str] = {}) -> None:
        (self.folder / "missile.toml").write_text('[[body]]\nshape = "cone"\n')
        self.write(blocks, HEAD)
        for run in read_sweep(self.file).runs:
            leave(run, run.deflections["pitch"], {}, ends.get(run.name, "converged"))

    def rows(self) -> list[dict]:
        with open(self.folder / "runs/table/trim.csv") as file:
            rows = csv.DictReader(line for line in file if not line.startswith("#"))
            value = lambda key, text: text if key in ("state", "control", "linear") else float(text or "nan")
            return [{key: value(key, text) for key, text in row.items()} for row in rows]

    def test_everything_is_that_of_the_formulas(self) -> None:
        self.made()
        said = self.sweep("trim", "--CN", 1, 3)
        rows = self.rows()
        for row in rows:
            wanted = loads(row["mach"], row["alpha"], row["deflection"])
            self.assertAlmostEqual(wanted["Cm"], 0, places=9)
            for name in ("CN", "CA", "Cm_q", "Cm_alphadot"):
                self.assertAlmostEqual(row[name], wanted[name], places=9, msg=name)
            self.assertAlmostEqual(row["Ch@canard_1"], wanted["Ch"], places=9)
            self.assertAlmostEqual(row["static_margin"], -wanted["Cm_alpha"] / wanted["CN_alpha"], places=9)
            self.assertAlmostEqual(row["Cm_q_plus_Cm_alphadot"], wanted["Cm_q"] + wanted["Cm_alphadot"], places=9)
        at = lambda mach, name, value: [row for row in rows if row["mach"] == mach and abs(row[name] - value) < 1e-9]
        for degrees in (0, 5):  # -5 holds it at no incidence above zero
            alpha = brentq(lambda alpha: loads(2, alpha, degrees)["Cm"], 0, 10)
            self.assertAlmostEqual(at(2, "deflection", degrees)[0]["alpha"], alpha)
        for alpha in (0, 4):
            degrees = brentq(lambda degrees: loads(2, alpha, degrees)["Cm"], -5, 5)
            self.assertAlmostEqual(at(2, "alpha", alpha)[0]["deflection"], degrees)
        self.assertFalse(at(2, "alpha", 10) or at(2, "deflection", -5))
        alpha, degrees = fsolve(lambda x: (loads(2, *x)["Cm"], loads(2, *x)["CN"] - 1), (4, 4), xtol=1e-13)
        found = at(2, "CN", 1)[0]
        self.assertAlmostEqual(found["alpha"], alpha, places=8)
        self.assertAlmostEqual(found["deflection"], degrees, places=8)
        self.assertRegex(said, r"pitch, Mach 2: CN = 3 is not trimmed within what was computed: CN is -0\.0\d+ to 1\.\d+")

    def test_what_was_not_computed_is_not_trimmed(self) -> None:
        """Without the runs at 5 degrees of Mach 2 nothing above 0 is said there; a control that has no say says so."""
        self.made(ends={f"derivatives_m2_a{alpha}_pitch5": "not_converged" for alpha in (0, 4, 10)})
        said = self.sweep("trim")
        self.assertIn("derivatives_m2_a4_pitch5: not converged", said)
        self.assertEqual({row["mach"] for row in self.rows()}, {1.5})
        self.made("[[runs]]\nmach = 2\nalpha = [4, 10]\ndeflection.pitch = [-5, 0]\n")
        for run in read_sweep(self.file).runs:
            leave(run, run.deflections["pitch"], {})
        said = self.sweep("trim")
        self.assertIn("no trim within alpha 4 to 10, deflection -5 to 0 degrees: Cm is", said)
        said = self.sweep("trim", "--control", "roll", code=1)
        self.assertIn("there is no control 'roll' in series 'derivatives'; there are pitch", said)

    def test_by_derivatives_alone(self) -> None:
        """Linear in the deflection up to what is said: Cm(alpha, 0) + Cm_elevator d; roll, which does not pitch, is not taken."""
        self.write("[[runs]]\nmach = 2\nalpha = [0, 4, 10]\n", 'case = "good.toml"\nfolder = "runs"\n')
        slope = math.degrees(5 / 10 / 2)  # per rad
        for run in read_sweep(self.file).runs:
            leave(run, 0.0, {"CN_elevator": 1.5, "Cm_elevator": slope, "Cm_roll": 0.0, "Cl_roll": -1.0})
            (run.folder / "panels.csv").write_text(f"# Panels\npanel,name,value\ncanard_1,Ch_elevator,{math.degrees(0.03)}\n")
        said = self.sweep("trim")
        self.assertIn("elevator: no run has it deflected; linear, up to 5 degrees", said)
        row = next(row for row in self.rows() if row["alpha"] == 4)
        degrees = -math.degrees(loads(2, 4, 0)["Cm"] / slope)
        self.assertAlmostEqual(row["deflection"], degrees)
        self.assertAlmostEqual(row["CN"], loads(2, 4, 0)["CN"] + 1.5 * math.radians(degrees))
        self.assertAlmostEqual(row["Ch@canard_1"], loads(2, 4, 0)["Ch"] + 0.03 * degrees)
        self.assertEqual({row["linear"] for row in self.rows()}, {"yes"})
        self.assertNotIn(10, {row["alpha"] for row in self.rows()})
        self.sweep("trim", "--linear", 15)
        self.assertIn(10, {row["alpha"] for row in self.rows()})

    def test_centres_of_gravity(self) -> None:
        """Each is asked from the program once; the runs' own without [[mass]]."""
        self.made()
        said = self.sweep("trim", "--center", "0.6", "0.7,0,0")
        calls = (self.folder / "runs/derive.txt").read_text().splitlines()
        self.assertEqual(calls, ["18 0.6", "18 0.7"])
        self.assertEqual(list(dict.fromkeys(row["state"] for row in self.rows())), ["x = 0.6", "x, y, z = 0.7, 0, 0"])
        self.assertIn("x, y, z = 0.7, 0, 0: Cm = 0", said)
        self.assertIn("X,Y,Z", self.sweep("trim", "--center", "0.6,1", code=2))


if __name__ == "__main__":
    unittest.main()
