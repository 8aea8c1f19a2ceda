#!/usr/bin/python3
"""The verb derive: moment transfer of results, several files and centres at once, and what it refuses.

The body of the tests is made of points that each feel their own relative wind w and answer with the force D w: its derivatives about
any centre follow from rigid-body kinematics alone, written down for each centre anew.
"""

from __future__ import annotations

import json
import tempfile
import unittest
from itertools import product
from pathlib import Path

from program import RANKS, Outcome, run

# Place and matrix D of each point, over q S and V; V = 1 and length = 2, so that a unit reduced rate is 1 per second.
LENGTH = 2.0
POINTS = [
    ((0.3, 0.1, -0.2), ((0.1, 0.0, 0.2), (0.0, 0.7, -0.1), (0.3, 0.2, 1.9))),
    ((1.7, -0.4, 0.1), ((0.2, -0.1, 0.0), (0.4, 0.9, 0.0), (-0.2, 0.1, 2.3))),
    ((3.1, 0.5, 0.4), ((0.1, 0.3, 0.1), (-0.2, 1.1, 0.5), (0.1, -0.4, 0.8))),
]
ROTATIONS = {"p": (-1.0, 0.0, 0.0), "q": (0.0, 1.0, 0.0), "r": (0.0, 0.0, -1.0)}  # x aft, y to starboard, z up
WINDS = {"alpha": (0.0, 0.0, 1.0), "beta": (0.0, -1.0, 0.0)}
OWN = (0.5, 0.0, 0.0)
PARTS = ("linear", "mesh")

Vector = tuple[float, float, float]


def cross(a: Vector, b: Vector) -> Vector:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def body_about(center: Vector) -> dict[str, float]:
    """Derivatives by alpha, beta, p, q and r about a centre that the rates are about, too."""
    out = {}
    for variable in (*WINDS, *ROTATIONS):
        force, moment = [0.0] * 3, [0.0] * 3
        for place, matrix in POINTS:
            arm = tuple(a - b for a, b in zip(place, center))
            if variable in WINDS:
                wind = WINDS[variable]
            else:  # the point moves by rotation x arm, the wind against it
                wind = tuple(-x for x in cross(ROTATIONS[variable], arm))
            push = tuple(sum(d * w for d, w in zip(row, wind)) for row in matrix)
            force = [a + b for a, b in zip(force, push)]
            moment = [a + b / LENGTH for a, b in zip(moment, cross(arm, push))]
        values = (*force, -moment[0], moment[1], -moment[2])
        out |= {f"{name}_{variable}": value for name, value in zip(("CA", "CY", "CN", "Cl", "Cm", "Cn"), values)}
    return out


def result_text(**changes: object) -> str:
    """A result.json about OWN, with parts of 1 % and 2 %."""
    entries = {
        name: {
            "value": value,
            "uncertainty": 0.03 * abs(value),
            "method": "linear solve",
            "converged": True,
            "parts": {"linear": 0.01 * abs(value), "mesh": 0.02 * abs(value)},
        }
        for name, value in body_about(OWN).items()
    }
    result = {
        "status": "converged", "message": "", "title": "points", "verb": "derivatives",
        "mesh": {"file": "points.msh", "hash": "0123456789abcdef"},
        "reference": {
            "length": LENGTH, "area": 1.0, "moment_center": list(OWN), "model": "full", "rate": "length / (2 V)", "axes": "body",
        },
        "freestream": {"mach": 2.0, "alpha": 0.0, "beta": 0.0, "gamma": 1.4},
        "forces": {"CA": 0.1, "CY": 0.02, "CN": 0.3, "Cl": 0.004, "Cm": -0.5, "Cn": 0.06},
        "derivatives": entries, "uncertainty": "solver and mesh", "provenance": {"version": "0.1.0"},
    }  # fmt: skip
    return json.dumps(result | changes, indent=1)


class Derive(unittest.TestCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        self.write("result.json", result_text())

    def write(self, name: str, text: str) -> None:
        (self.folder / name).write_text(text)

    def derive(self, *arguments: object) -> Outcome:
        outcome = run(self.folder, "derive", *arguments)
        self.assertEqual(outcome.codes, [0] * RANKS, outcome.err)
        return outcome

    def list_of(self, *arguments: object) -> list[dict]:
        return json.loads(self.derive("--json", *arguments).out)

    def refused(self, *arguments: object) -> str:
        """The one error that it says."""
        outcome = run(self.folder, "derive", *arguments)
        self.assertEqual(outcome.codes, [1] * RANKS, outcome.err)
        self.assertEqual(outcome.out, "")
        (line,) = outcome.err.splitlines()
        return line

    def assert_is_body(self, item: dict, without: str = "") -> None:
        """What derive says about a centre is what kinematics say about it, but for the columns of `without`."""
        expected = {name: value for name, value in body_about(tuple(item["center"])).items() if name[-1] not in without}
        self.assertEqual(item["derivatives"].keys(), expected.keys())
        for name, value in expected.items():
            self.assertAlmostEqual(item["derivatives"][name]["value"], value, delta=1e-12, msg=f"{name} about {item['center']}")

    def test_along_the_axis(self) -> None:
        outcome = self.derive("result.json", "--json", "--center", "-1.5", "--center", "4,0,0")
        self.assertEqual(outcome.err, "")
        items = json.loads(outcome.out)
        self.assertEqual([item["center"] for item in items], [[-1.5, 0, 0], [4, 0, 0]])
        for item in items:
            self.assert_is_body(item)
            self.assertEqual(item["left_out"], [])

    def test_off_the_axis(self) -> None:
        """Derivatives by speed are not known: by q above, by r beside the run's own centre are left out, and this is said once."""
        centers = {"0.2,0,0.7": "q", "0.2,-0.3,0": "r", "3,0.4,-0.6": "qr"}
        outcome = self.derive("result.json", "result.json", "--json", *(word for at in centers for word in ("--center", at)))
        self.assertEqual(outcome.err.count("left out"), 1, outcome.err)
        self.assertIn("by q, r", outcome.err)
        items = json.loads(outcome.out)
        self.assertEqual(len(items), 2 * len(centers))
        for item, without in zip(items, 2 * list(centers.values())):
            self.assert_is_body(item, without)
            self.assertEqual(item["left_out"], list(without))

    def test_all_digits(self) -> None:
        """About its own centre every number comes back as it was, to the last bit."""
        (item,) = self.list_of("result.json")
        self.assertEqual(item["file"], "result.json")
        self.assertEqual(item["status"], "converged")
        self.assertEqual(item["reference"], {"length": LENGTH, "area": 1.0, "model": "full"})
        self.assertEqual(item["freestream"], {"mach": 2.0, "alpha": 0.0, "beta": 0.0, "gamma": 1.4})
        self.assertEqual(item["uncertainty"], "solver and mesh")
        self.assertEqual(item["derivatives"], json.loads(result_text())["derivatives"])

    def test_loads(self) -> None:
        """M' = M - offset x F, offset = (1, -2, 0.5) lengths; in mesh axes M = (-Cl, Cm, -Cn), F = (CA, CY, CN)."""
        (item,) = self.list_of("result.json", "--center", f"{OWN[0] + 2},-4,1")
        moment = (-0.004 - (-2 * 0.3 - 0.5 * 0.02), -0.5 - (0.5 * 0.1 - 1 * 0.3), -0.06 - (1 * 0.02 + 2 * 0.1))
        expected = {"CA": 0.1, "CY": 0.02, "CN": 0.3, "Cl": -moment[0], "Cm": moment[1], "Cn": -moment[2]}
        for name, value in expected.items():
            self.assertEqual(len(item["loads"][name]), 1)
            self.assertAlmostEqual(item["loads"][name][0], value, delta=1e-15)

    def test_uncertainty(self) -> None:
        """Its magnitudes add, part by part: Cm_q' = Cm_q + x CN_q - 2 x (Cm_alpha + x CN_alpha), x = -3 / 2 lengths."""
        old, (item,) = body_about(OWN), self.list_of("result.json", "--center", OWN[0] - 3.0)
        carried = abs(old["Cm_q"]) + 1.5 * abs(old["CN_q"]) + 3 * abs(old["Cm_alpha"]) + 4.5 * abs(old["CN_alpha"])
        entry = item["derivatives"]["Cm_q"]
        for found, share in ((entry["parts"]["linear"], 0.01), (entry["parts"]["mesh"], 0.02), (entry["uncertainty"], 0.03)):
            self.assertAlmostEqual(found, share * carried, delta=1e-12)
        self.assertEqual(item["uncertainty"], "solver and mesh")

    def test_uncertainty_without_the_mesh_says_so(self) -> None:
        derivatives = json.loads(result_text())["derivatives"]
        for entry in derivatives.values():
            del entry["parts"]["mesh"]
        self.write("result.json", result_text(derivatives=derivatives))
        (item,) = self.list_of("result.json", "--center", 3)
        self.assertEqual(item["uncertainty"], "solver only; mesh not assessed")
        self.assertIn("Uncertainty: solver only; mesh not assessed", self.derive("result.json").out)

    def test_files_and_centers_in_their_order(self) -> None:
        self.write("other.json", result_text(title="other"))
        self.write("centers", "# aft to fore\n2.5\n\n  1 , 0,0   # in between\n-0.5\n")
        items = self.list_of("other.json", "result.json", "--center", 7, "--centers", "centers")
        self.assertEqual([item["file"] for item in items], 4 * ["other.json"] + 4 * ["result.json"])
        self.assertEqual([item["center"][0] for item in items], 2 * [7, 2.5, 1, -0.5])

    def test_tables(self) -> None:
        text = self.derive("result.json", "--center", 0, "--center", 1.25).out
        self.assertEqual(text.count("File: result.json\n"), 2)
        for center in ("(0, 0, 0)", "(1.25, 0, 0)"):
            self.assertIn(f"moment centre and axis of rotation {center}", text)
        header, *lines = text[text.index("      x_cg") :].strip().splitlines()
        self.assertEqual(header.split(), "x_cg Cm_alpha ± Cm_q ± Cm_alphadot ± Cm_q+Cm_alphadot ± static margin ±".split())
        for line, x in zip(lines, (0.0, 1.25), strict=True):
            about = body_about((x, 0.0, 0.0))
            at, slope, _, _, damping, _, _, none, no_sum, margin, _, _ = line.split()
            self.assertEqual((float(at), none, no_sum), (x, "-", "-"))  # alphadot is not in the file
            for found, expected in (
                (slope, about["Cm_alpha"]), (damping, about["Cm_q"]), (margin, -about["Cm_alpha"] / about["CN_alpha"])
            ):  # fmt: skip
                self.assertAlmostEqual(float(found), expected, delta=1e-5 * abs(expected))

    def test_one_center_needs_no_travel(self) -> None:
        self.assertNotIn("x_cg", self.derive("result.json").out)

    def test_not_converged(self) -> None:
        derivatives = json.loads(result_text())["derivatives"]
        for name, entry in derivatives.items():
            entry["converged"] = not name.endswith("_alpha")
        reason = "the linear residual for alpha dropped 1.3 of 3 decades"
        self.write("result.json", result_text(status="not_converged", message=reason, derivatives=derivatives))
        text = self.derive("result.json", "--center", 2).out
        self.assertLess(text.index(f"Status: not_converged: {reason}\n"), text.index("name "))
        (item,) = self.list_of("result.json", "--center", 2)
        self.assertEqual((item["status"], item["message"]), ("not_converged", reason))
        loose = {name.split("_")[1] for name, entry in item["derivatives"].items() if not entry["converged"]}
        self.assertEqual(loose, {"alpha", "q"})  # q about another centre rests on alpha

    def test_unknown_uncertainty(self) -> None:
        """Null, as a cut solve leaves it: unknown stays so for all that rests on it, and for nothing else."""
        derivatives = json.loads(result_text())["derivatives"]
        for name, entry in derivatives.items():
            if name.endswith("_alpha"):
                entry |= {"uncertainty": None, "converged": False} | ({"parts": dict.fromkeys(entry["parts"])} if "parts" in entry else {})
        self.write("result.json", result_text(status="not_converged", derivatives=derivatives))
        (item,) = self.list_of("result.json", "--center", 2)
        unknown = {name.split("_", 1)[1] for name, entry in item["derivatives"].items() if entry["uncertainty"] is None}
        self.assertEqual(unknown, {"alpha", "q"})  # q about another centre rests on alpha
        self.assertIn("± inf", self.derive("result.json").out)

    def test_refused_results(self) -> None:
        whole = result_text()
        lines = whole.splitlines()
        half = len(lines) // 2
        other = json.loads(whole)["derivatives"]
        null = other | {"Cm_q": other["Cm_q"] | {"value": None}}
        negative = other | {"Cm_q": other["Cm_q"] | {"uncertainty": -0.1}}
        rates = {name: entry for name, entry in other.items() if name.endswith("_q")}
        uneven = other | {"Cm_q": other["Cm_q"] | {"parts": {"mesh": 0.1}}}
        for text, said in (
            ("\n".join(lines[:half]), rf"a\.json:{half}: the file is cut"),
            ("", r"a\.json:1: the file is cut"),
            ("1,2", r"a\.json:1: this is no JSON"),
            ("[1]", r"a\.json: the whole is not an object"),
            (result_text(derivatives={}, status="diverged", message="vacuum"), r"a\.json: holds no derivatives: .* diverged: vacuum"),
            (result_text(verb="adjoint"), r"a\.json: this is a result of the verb adjoint"),
            (result_text(derivatives={"Cm_mach": other["Cm_q"]}), r"a\.json: Cm_mach is no stability derivative"),
            (result_text(derivatives=null), r"a\.json: derivatives\.Cm_q\.value is null"),
            (result_text(derivatives=negative), r"a\.json: derivatives\.Cm_q has a negative uncertainty"),
            (result_text(derivatives=uneven), r"a\.json: the uncertainty of \S+ has other parts"),
            (result_text(derivatives=rates), r"a\.json: the derivatives with respect to alpha are missing"),
            (result_text(status="well"), r"a\.json: .*unknown status, well"),
            (result_text(forces={"CA": 0.1}), r"a\.json: forces\.CY is missing"),
            (result_text(reference={}), r"a\.json: reference\.length is missing"),
            (result_text(freestream=2), r"a\.json: freestream is not an object"),
        ):
            with self.subTest(said):
                self.write("a.json", text)
                self.assertRegex(self.refused("result.json", "a.json", "--center", 3), said)

    def test_other_refused_files(self) -> None:
        self.assertIn("nowhere.json", self.refused("result.json", "nowhere.json"))
        self.assertIn("nowhere.h5", self.refused("nowhere.h5"))
        self.write("text.h5", "no history")
        self.assertIn("text.h5", self.refused("text.h5"))

    def test_refused_centers(self) -> None:
        for center in ("nan", "inf", "-inf", "1,2", "1,2,3,4", "1,nan,3", "1e999", "2e12", "", "1,,3", "x", "1 2 3", "1,2,3,"):
            with self.subTest(center):
                outcome = run(self.folder, "derive", "result.json", "--center", center)
                self.assertEqual(outcome.codes, [2] * RANKS)  # a wrong command line
                self.assertIn(f'"{center}" is no moment centre', outcome.out + outcome.err)
        for text, said in (
            ("1\n# two\n2,0\n", 'centers:3: "2,0" is no moment centre'),
            ("1\nnan # none\n", 'centers:2: "nan" is no moment centre'),
            ("# nothing\n\n", "centers: holds no centre"),
        ):
            with self.subTest(said):
                self.write("centers", text)
                self.assertIn(said, self.refused("result.json", "--centers", "centers"))
        self.assertIn("nowhere", self.refused("result.json", "--centers", "nowhere"))

    def test_moved_back(self) -> None:
        """A half model, too: there and back again, by results that are written down from what it prints."""
        for center, model in product((3.25, -8.0), ("half", "full")):
            own = json.loads(result_text())
            own["reference"]["model"] = model
            self.write("there.json", json.dumps(own))
            (item,) = self.list_of("there.json", "--center", center)
            own["reference"]["moment_center"][0] = center
            self.write("there.json", json.dumps(own | {"derivatives": item["derivatives"]}))
            (back,) = self.list_of("there.json", "--center", OWN[0])
            self.assert_is_body(back)


if __name__ == "__main__":
    unittest.main()
