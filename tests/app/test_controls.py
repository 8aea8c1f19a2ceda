#!/usr/bin/python3
"""Walls that turn about hinges: derivatives by their deflections, by solves and by adjoints, panels' own loads, where loads sit.

A cube whose floor is a plate with a flap behind it, and whose side y = 1 is a wall too. Expectations: differences of steady flows with
the controls deflected by a hundredth of a degree; parts add up to the whole to round-off; moments moved to the hinge by hand.
"""

from __future__ import annotations

import csv
import json
import math
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np
from program import RANKS, box, gmsh_text, run, write_case

CASE = """\
[mesh]
file = "box.msh"
[reference]
length = 2.0
moment_center = [0.5, 0, 0.2]
model = "half"
[freestream]
mach = 2.0
alpha = 1.0
[boundary]
fore = "wall"
flap = "wall"
side = "wall"
middle = "symmetry"
farfield = "farfield"
[components]
plate = ["fore", "flap"]
[derivatives]
control_rates = true
[control_sets]
both = {flap = 1, side = -0.5}
[[controls]]
name = "flap"
patches = ["flap"]
hinge = {point = [0.5, 0, 0], axis = [0, 2, 0]}
[[controls]]
name = "side"
patches = ["side"]
hinge = {point = [0.25, 1, 0.5], axis = [0, 0, 1]}
"""
DEEP = ("--set", "derivatives.orders=9")
COEFFICIENTS = ("CA", "CY", "CN", "Cl", "Cm", "Cn")
VARIABLES = ("alpha", "q", "alphadot", "flap", "side", "both", "flapdot", "sidedot", "bothdot")


def mesh() -> str:
    points, cells, patches = box(4)
    fore = [face for face in patches["wall"] if sum(points[p][0] for p in face) < 1.5]
    side = [face for face in patches["sides"] if points[face[0]][1] == 1]
    split = {
        "fore": fore,
        "flap": [face for face in patches["wall"] if face not in fore],
        "side": side,
        "middle": [face for face in patches["sides"] if face not in side],
        "farfield": patches["farfield"],
    }
    return gmsh_text(points, cells, split)


class Controls(unittest.TestCase):
    folder: Path
    result: dict

    @classmethod
    def setUpClass(cls) -> None:
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = Path(temporary.name)
        write_case(cls.folder, CASE, mesh())
        cls.result = cls.done("derivatives", "forward", *DEEP)

    @classmethod
    def done(cls, verb: str, out: str, *words: str) -> dict:
        outcome = run(cls.folder, verb, "case.toml", "--out", out, *words)
        assert outcome.codes == [0] * RANKS, outcome.err
        return json.loads((cls.folder / out / "result.json").read_text())

    def rows(self, table: str, out: str = "forward") -> list[dict[str, str]]:
        lines = (self.folder / out / table).read_text().splitlines()
        return list(csv.DictReader(line for line in lines if not line.startswith("#")))

    def values(self) -> dict[str, float]:
        return {name: entry["value"] for name, entry in self.result["derivatives"].items()}

    def panels(self, out: str = "forward") -> dict[str, dict[str, float]]:
        found: dict[str, dict[str, float]] = {}
        for row in self.rows("panels.csv", out):
            found.setdefault(row["panel"], {})[row["name"]] = float(row["value"])
        return found

    def test_are_differences_of_flows_with_the_controls_deflected(self) -> None:
        found, panels = self.values(), self.panels()
        for control in ("flap", "side"):
            below, above = (
                self.done("run", f"{control}_{sign}", "--set", f"deflections.{control}={0.01 * sign}")["forces"] for sign in (-1, 1)
            )
            slope = lambda low, high: (high - low) / math.radians(0.02)
            for name in ("CA", "CN", "Cm"):
                expected = slope(below[name], above[name])
                self.assertAlmostEqual(found[f"{name}_{control}"], expected, delta=1e-4 * max(abs(expected), 0.1), msg=f"{name} {control}")
            for panel, loads in above["panels"].items():
                for name in ("CNp", "Ch", "Cb"):
                    expected = slope(below["panels"][panel][name], loads[name])
                    got = panels[panel][f"{name}_{control}"]
                    self.assertAlmostEqual(got, expected, delta=1e-4 * max(abs(expected), 0.1), msg=f"{name} of {panel} by {control}")
        self.assertGreater(abs(found["CN_flap"]), 0.5)

    def test_turn_by_transpiration_too(self) -> None:
        """Flat walls beside the flap and under uniform flow: what the deforming mesh says within what its cells leave, per cent of each."""
        passing = ("--set", "space.deflection=transpiration")
        solved = self.done("derivatives", "passing", *DEEP, *passing)["derivatives"]
        flows = [self.done("run", f"passing_{sign}", *passing, "--set", f"deflections.flap={0.01 * sign}")["forces"] for sign in (-1, 1)]
        for name in ("CN", "Cm"):
            value = solved[f"{name}_flap"]["value"]
            expected = (flows[1][name] - flows[0][name]) / math.radians(0.02)
            self.assertAlmostEqual(value, expected, delta=1e-4 * abs(expected), msg=name)
            self.assertAlmostEqual(value, self.values()[f"{name}_flap"], delta=0.03 * abs(value), msg=name)
            rate = solved[f"{name}_flapdot"]["value"]
            self.assertAlmostEqual(rate, self.values()[f"{name}_flapdot"], delta=0.1 * abs(rate), msg=name)

    def test_adjoints_know_walls_turned_by_transpiration(self) -> None:
        turned = ("--set", "space.deflection=transpiration", "--set", "deflections.flap=2")
        solved = self.done("derivatives", "turned", *DEEP, *turned)["derivatives"]
        adjoint = self.done("adjoint", "turned_adjoint", "--of", "CN,Cm", *DEEP, *turned)["derivatives"]
        for name in ("CN_alpha", "Cm_alpha", "CN_q", "CN_flap", "Cm_flap", "CN_side"):
            value = solved[name]["value"]
            self.assertAlmostEqual(adjoint[name]["value"], value, delta=1e-5 * max(abs(value), 0.1), msg=name)
        self.assertFalse((self.folder / "turned_adjoint" / "surface_sensitivity.csv").exists())

    def test_sets_are_sums(self) -> None:
        found = self.values()
        for name in ("CA", "CN", "Cm"):
            for rate in ("", "dot"):
                expected = found[f"{name}_flap{rate}"] - 0.5 * found[f"{name}_side{rate}"]
                self.assertAlmostEqual(found[f"{name}_both{rate}"], expected, delta=1e-13)
        none = self.done("derivatives", "without_rates", "--set", "derivatives.control_rates=false")["derivatives"]
        self.assertFalse([name for name in none if name.endswith("flapdot")])

    def test_what_the_solves_leave_is_in_the_uncertainty(self) -> None:
        shallow = self.done("derivatives", "shallow", "--set", "derivatives.orders=2")["derivatives"]
        for name, value in self.values().items():
            self.assertLessEqual(abs(shallow[name]["value"] - value), shallow[name]["uncertainty"], name)
        for row in self.rows("panels.csv", "shallow"):
            if row["uncertainty"]:
                exact = self.panels()[row["panel"]][row["name"]]
                self.assertLessEqual(abs(float(row["value"]) - exact), float(row["uncertainty"]), f"{row['name']} of {row['panel']}")

    def test_adjoints_say_the_same(self) -> None:
        found = self.done("adjoint", "adjoint", *DEEP, "--of", "CN,Cm,CA@flap")["derivatives"]
        parts = {row["name"]: float(row["value"]) for row in self.rows("components.csv") if row["component"] == "flap" and row["value"]}
        for variable in ("flap", "side", "both"):
            for name, expected in ((f"CN_{variable}", None), (f"Cm_{variable}", None), (f"CA_{variable}@flap", parts[f"CA_{variable}"])):
                expected = self.values()[name] if expected is None else expected
                self.assertAlmostEqual(found[name]["value"], expected, delta=1e-6 * max(abs(expected), 0.1), msg=name)

    def test_the_limiter_is_held_in_the_change_too(self) -> None:
        """Flows whose limiter is frozen differ by what solves with the limiter held say: here by little, as the flow is smooth."""
        held = self.done("derivatives", "held", *DEEP, "--set", "derivatives.limiter_uncertainty=true")["derivatives"]
        none = self.done("derivatives", "none", *DEEP, "--set", "derivatives.limiter_uncertainty=true", "--set", "space.limiter=none")
        self.assertGreater(held["CN_flap"]["parts"]["limiter"], 0)
        self.assertLess(held["CN_flap"]["parts"]["limiter"], 0.2 * abs(held["CN_flap"]["value"]))
        self.assertLess(none["derivatives"]["CN_flap"]["parts"]["limiter"], 1e-6)  # nothing is held

    def test_walls_add_up(self) -> None:
        parts = {}
        for row in self.rows("components.csv"):
            if row["value"]:
                parts.setdefault(row["component"], {})[row["name"]] = float(row["value"])
        for name, value in self.values().items():
            own = [parts[wall][name] for wall in ("fore", "flap", "side")]
            self.assertAlmostEqual(sum(own), value, delta=1e-13 * sum(map(abs, own)), msg=name)

    def test_panels_are_moved_to_their_hinges(self) -> None:
        """The flap, by hand: M about the hinge is M + (centre - hinge) x F; without the mirror image."""
        one_side = {row["name"]: float(row["one_side"]) for row in self.rows("components.csv") if row["component"] == "flap"}
        found = self.panels()["flap"]
        length = 2.0
        for variable in VARIABLES:
            of = lambda name: one_side[f"{name}_{variable}"]
            self.assertAlmostEqual(found[f"CNp_{variable}"], of("CN"))
            # Axis y; centre - hinge is (0, 0, 0.2).
            self.assertAlmostEqual(found[f"Ch_{variable}"], of("Cm") + 0.2 / length * of("CA"))
            self.assertAlmostEqual(found[f"Cb_{variable}"], -of("Cl") - 0.2 / length * of("CY"))
        self.assertAlmostEqual(found["x_cp_flap"], -length * found["Ch_flap"] / found["CNp_flap"])
        # The pressure acts on the flap, 0.5 long and 1 wide.
        self.assertTrue(0 < found["x_cp_flap"] < 0.5 and 0 < found["s_cp_flap"] < 1)
        side, steady = self.panels()["side"], self.result["forces"]
        self.assertAlmostEqual(side["CNp"], -steady["one_side"]["side"]["CY"])  # x cross z is -y

    def test_slices_add_up(self) -> None:
        derivatives, forces, panels = self.values(), self.result["forces"], self.panels()
        last: dict[tuple[str, str], float] = {}
        for table, along in (("along_body.csv", "x"), ("along_panels.csv", "s")):
            for row in self.rows(table):
                last[row["of"], row["name"]] = float(row["running"])
                width = float(row[f"{along}_to"]) - float(row[f"{along}_from"])
                self.assertAlmostEqual(width, 0.01 if row["of"] != "flap" or along == "s" else 0.005, places=9)
        for variable in ("", *(f"_{name}" for name in VARIABLES)):
            for name in ("CA", "CN", "Cm"):
                value = forces[name] if not variable else derivatives[name + variable]
                found = last.get(("total", name + variable), 0)
                self.assertAlmostEqual(found, value, delta=1e-12 * max(1, abs(value)), msg=name + variable)
            for panel in ("flap", "side"):
                for name in ("CNp", "Ch", "Cb"):
                    if (panel, name + variable) in last:
                        value = panels[panel][name + variable]
                        self.assertAlmostEqual(last[panel, name + variable], value, delta=1e-12 * max(1, abs(value)))
        self.assertIn(("plate", "CN_flap"), last)
        self.assertIn(("flap", "Ch_alphadot"), last)
        outcome = run(self.folder, "derivatives", "case.toml", "--out", "none_of_them", "--set", "output.stations=0")
        self.assertEqual(outcome.codes, [0] * RANKS)
        self.assertFalse((self.folder / "none_of_them/along_body.csv").exists())

    def test_pressures_on_the_surface_add_up(self) -> None:
        """Derivatives of Cp times area vectors are those of the forces; the file holds walls alone, the plane of symmetry another."""
        with h5py.File(self.folder / "forward/surface.vtkhdf") as file:
            data = file["VTKHDF"]
            triangles = data["Points"][()].astype(float)[data["Connectivity"][()].reshape(-1, 3)]
            patch, names = data["CellData/patch"][()], data["FieldData/patch_names"].asstr()[()].tolist()
            fields = {name: values[()].astype(float) for name, values in data["CellData"].items()}
            self.assertEqual(set(data["PointData"]), set(fields) - {"patch"})
        self.assertEqual({names[index] for index in patch}, {"fore", "flap", "side"})
        areas = 0.5 * np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
        for variable in ("alpha", "q", "alphadot"):
            force = 2 * (fields[f"cp_{variable}"][:, None] * areas).sum(axis=0)  # of both halves, over an area of 1
            for name, found in (("CA", force[0]), ("CN", force[2])):
                wanted = self.values().get(f"{name}_{variable}", 0.0)  # CA: no wall looks forward
                self.assertAlmostEqual(found, wanted, delta=2e-6 * (1 + abs(wanted)), msg=f"{name}_{variable}")
        self.assertIn("cp_flap", fields)
        self.assertNotIn("cp_both", fields)
        with h5py.File(self.folder / "forward/symmetry.vtkhdf") as file:
            self.assertEqual(set(file["VTKHDF/CellData"]), {"patch", "pressure", "cp"})

    def test_other_programs_have_them(self) -> None:
        values = self.values()
        text = (self.folder / "forward/derivatives.st").read_text()
        self.assertRegex(text, r"flap  d1 +side  d2 +both  d3")
        alpha = math.radians(1)
        lift = values["CN_side"] * math.cos(alpha) - values["CA_side"] * math.sin(alpha)
        self.assertIn(f"CLd02 ={lift:11.6f}", text)
        self.assertLess(text.index("Cmd01"), text.index("Neutral point"))
        xml = (self.folder / "forward/derivatives.jsbsim.xml").read_text()
        self.assertIn("<property>fcs/flap-rad</property>", xml)
        derived = run(self.folder, "derive", "forward/result.json", "--center", "0.7,0,0.2", "--json", ranks=1)
        self.assertEqual(derived.codes, [0], derived.err)
        moved = values["Cm_flap"] + 0.1 * values["CN_flap"]  # 0.2 over the length of 2
        self.assertIn(f"{moved:.6g}"[:7], derived.out)

    def test_says_what_is_wrong(self) -> None:
        control = "controls=[{name='flap',patches=['flap'],hinge={point=[0,0,0],axis=[0,1,0]}}]"
        for setting, part in (
            ("controls=[{name='flap',patches=['flop'],hinge={point=[0,0,0],axis=[0,1,0]}}]", '"flop", which is no wall of the case'),
            ("controls=[{name='flap',patches=['flap'],hinge={point=[0,0,0]}}]", '"flap": hinge: axis is missing'),
            ("controls=[{name='flap',patches=['flap'],hinge={point=[0,0],axis=[0,1,0]}}]", '"flap": hinge: point: must be three numbers'),
            ("controls=[{name='flap',patch=['flap'],hinge={point=[0,0,0],axis=[0,1,0]}}]", '"patch" is no key of it'),
            ("controls=[{patches=['flap'],hinge={point=[0,0,0],axis=[0,1,0]}}]", "number 1: name is missing"),
            (control.replace("axis=[0,1,0]", "axis=[0,0,0]"), "the axis of the hinge has no direction"),
            (control.replace("name='flap'", "name='alphadot'"), '"alphadot" cannot name a control'),
            (control.replace("name='flap'", "name='a b'"), '"a b" cannot name a control'),
            (control.replace("flap'],", "middle'],"), '"middle", which is no wall of the case'),
            ("control_sets.both={flop=1}", 'names "flop", which is no control'),
            ("control_sets.flap={flap=1}", 'there are two controls "flap"'),
            ("control_sets.both={}", "control_sets.both has no controls"),
            ("control_sets.both={flap='x'}", '"flap" must be a number'),
            (control.replace("name='flap'", "name='flapdot'"), '"flapdot" cannot name a control'),
            ("deflections.flop=1", "deflections.flop names no control"),
            ("control_sets={both={flop=1}}", 'names "flop", which is no control'),
            ("control_sets=3", "control_sets is a table; set its keys"),
            ("freestream={mach=2}", "freestream is a table; set its keys"),
            ("components={''=['flap']}", "a set has no name"),
            (control.replace("['flap']", "['flap','flap']"), "names a wall twice"),
            ("deflections.flap=90", "must be a number from -45 to 45"),
        ):
            outcome = run(self.folder, "check", "case.toml", "--set", setting)
            self.assertEqual(outcome.codes, [1] * RANKS, setting)
            self.assertTrue(any(part in line for line in outcome.errors), (setting, outcome.err))
        only_flap = run(self.folder, "check", "case.toml", "--set", control, "--set", "control_sets={}")
        self.assertEqual(only_flap.codes, [0] * RANKS, only_flap.err)
        text = CASE.replace("axis = [0, 2, 0]", "axis = [0, 2]")
        (self.folder / "wrong.toml").write_text(text)
        line = 1 + text[: text.index("axis = [0, 2]")].count("\n")
        self.assertIn(f"wrong.toml:{line}: ", run(self.folder, "check", "wrong.toml").errors[0])

    def test_says_what_cannot_turn(self) -> None:
        turned = "controls=[{name='flap',patches=['flap'],hinge={point=[0.5,0,0],axis=[1,0,1]}}]"
        for words, part in (
            (("--set", turned, "--set", "control_sets.both={flap=1}"), "control flap turns walls out of the plane of symmetry"),
            (("--set", turned.replace("point=[0.5,0,0],axis=[1,0,1]", "point=[-3,0,0],axis=[0,1,0]"), "--set", "control_sets.both={flap=1}",
              "--set", "deflections.flap=-20"), "the mesh folds while flap is deflected by -20 degrees"),
        ):
            outcome = run(self.folder, "run", "case.toml", "--out", "cannot", *words)
            self.assertEqual(outcome.codes, [1] * RANKS, outcome.err)
            self.assertEqual(len(outcome.errors), 1)
            self.assertIn(part, outcome.errors[0])


if __name__ == "__main__":
    unittest.main()
