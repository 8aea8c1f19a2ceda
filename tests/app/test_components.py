#!/usr/bin/python3
"""What each wall, and each set of walls, contributes to loads and derivatives; and the walls of a half model without their mirror image.

A cube with a plate below, its fore half "fore" and its aft half "aft", and a side y = 1 that is a wall too. Expectations: parts add up to
the whole to round-off; adjoints of the loads of some walls; differences of steady flows a little more and less inclined.
"""

from __future__ import annotations

import csv
import json
import math
import tempfile
import unittest
from pathlib import Path

from program import RANKS, Outcome, box, gmsh_text, run, write_case

CASE = """\
[mesh]
file = "box.msh"
[reference]
model = "half"
[freestream]
mach = 2.0
alpha = 1.0
[boundary]
fore = "wall"
aft = "wall"
side = "wall"
middle = "symmetry"
farfield = "farfield"
[components]
plate = ["fore", "aft"]
all = ["fore", "aft", "side"]
"""
DEEP = ("--set", "derivatives.orders=9")
COEFFICIENTS = ("CA", "CY", "CN", "Cl", "Cm", "Cn")


def mesh() -> str:
    points, cells, patches = box(4)
    fore = [face for face in patches["wall"] if sum(points[p][0] for p in face) < 1.5]
    side = [face for face in patches["sides"] if points[face[0]][1] == 1]
    split = {
        "fore": fore,
        "aft": [face for face in patches["wall"] if face not in fore],
        "side": side,
        "middle": [face for face in patches["sides"] if face not in side],
        "farfield": patches["farfield"],
    }
    return gmsh_text(points, cells, split)


class Components(unittest.TestCase):
    folder: Path

    @classmethod
    def setUpClass(cls) -> None:
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = Path(temporary.name)
        write_case(cls.folder, CASE, mesh())
        cls.done("derivatives", "forward", *DEEP)
        cls.rows = cls.table("forward")

    @classmethod
    def done(cls, verb: str, out: str, *words: str) -> dict:
        outcome = run(cls.folder, verb, "case.toml", "--out", out, *words)
        assert outcome.codes == [0] * RANKS, outcome.err
        return json.loads((cls.folder / out / "result.json").read_text())

    @classmethod
    def table(cls, out: str) -> list[dict[str, str]]:
        lines = (cls.folder / out / "components.csv").read_text().splitlines()
        return list(csv.DictReader(line for line in lines if not line.startswith("#")))

    def column(self, component: str, which: str = "value") -> dict[str, float]:
        return {row["name"]: float(row[which]) for row in self.rows if row["component"] == component and row[which]}

    def test_parts_add_up_to_the_whole(self) -> None:
        result = json.loads((self.folder / "forward/result.json").read_text())
        parts = [self.column(name) for name in ("fore", "aft", "side")]
        for name, entry in result["derivatives"].items():
            size = sum(abs(part[name]) for part in parts)
            self.assertAlmostEqual(sum(part[name] for part in parts), entry["value"], delta=1e-13 * size)
            self.assertAlmostEqual(self.column("all")[name], entry["value"], delta=1e-13 * size)
            self.assertAlmostEqual(self.column("plate")[name], parts[0][name] + parts[1][name], delta=1e-13 * size)
        loads = result["forces"]["components"]
        for name in ("CA", "CN", "Cm"):
            self.assertAlmostEqual(sum(loads[part][name] for part in ("fore", "aft", "side")), result["forces"][name], delta=1e-14)
        self.assertEqual({name.split("_")[0] for name in result["derivatives"]}, {"CA", "CN", "Cm"})  # the others cancel

    def test_what_the_solves_leave_is_in_the_uncertainty(self) -> None:
        """Against solves nine decades down."""
        self.done("derivatives", "shallow", "--set", "derivatives.orders=2")
        for row in self.table("shallow"):
            for which in ("value", "one_side"):
                if row[which]:
                    exact = self.column(row["component"], which)[row["name"]]
                    error = float(row["uncertainty" if which == "value" else "one_side_uncertainty"])
                    self.assertLessEqual(abs(float(row[which]) - exact), error, f"{row['component']} {row['name']} {which}")

    def test_adjoints_of_some_walls(self) -> None:
        found = self.done("adjoint", "adjoint", *DEEP, "--of", "CN@fore,Cm@fore+aft,CN_alphadot@side")["derivatives"]
        for name, component in (("CN_alpha", "fore"), ("CN_q", "fore"), ("Cm_alpha", "plate"), ("Cm_q", "plate"), ("CN_alphadot", "side")):
            walls = {"fore": "fore", "plate": "fore+aft", "side": "side"}[component]
            value, error = self.column(component)[name], self.column(component, "uncertainty")[name]
            entry = found[f"{name}@{walls}"]
            self.assertLessEqual(abs(entry["value"] - value), entry["uncertainty"] + error, name)

    def test_walls_of_a_half_model_alone(self) -> None:
        """The side pushes to port only without its mirror image."""
        step = 0.01  # degrees
        below, above = (self.done("run", f"at_{sign}", "--set", f"freestream.alpha={1 + sign * step}")["forces"] for sign in (-1, 1))
        for part in ("fore", "side", "plate"):
            found = self.column(part, "one_side")
            for name in COEFFICIENTS:
                slope = (above["one_side"][part][name] - below["one_side"][part][name]) / math.radians(2 * step)
                self.assertAlmostEqual(found[f"{name}_alpha"], slope, delta=1e-4 * max(abs(slope), 0.1), msg=f"{part} {name}")
            for name, value in self.column(part).items():
                self.assertEqual(value, 2 * found[name])
        self.assertGreater(abs(self.column("side", "one_side")["CY_q"]), 0.1)

    def test_table_says_what_it_is(self) -> None:
        text = (self.folder / "forward/components.csv").read_text()
        for part in ("Mach 2", "solver only; mesh not assessed", "Status: converged", "one_side: of the walls of the mesh"):
            self.assertIn(part, text)
        self.assertEqual({row["walls"] for row in self.rows if row["component"] == "plate"}, {"fore aft"})

    def test_says_what_is_wrong(self) -> None:
        for setting, part in (
            ("components.plate=['for']", 'components.plate names "for", which is no wall of the case'),
            ("components.plate=['middle']", 'components.plate names "middle", which is no wall'),
            ("components.plate=['fore','fore']", "components.plate names a wall twice"),
            ("components.plate=[]", "components.plate has no walls"),
            ("components.fore=['aft']", "components.fore has the name of a patch already"),
            ("components.total=['aft']", "components.total has the name of a column already"),
            ("components.plate=3", "components.plate must be"),
        ):
            outcome: Outcome = run(self.folder, "check", "case.toml", "--set", setting)
            self.assertEqual(outcome.codes, [1] * RANKS)
            self.assertEqual(len(outcome.errors), 1, outcome.err)
            self.assertIn(part, outcome.errors[0])


if __name__ == "__main__":
    unittest.main()
