#!/usr/bin/python3
"""What is printed holds: on a cone whose base is a wall, so that its wake crosses the outflow, and on a cube with a plate.

In the wake's cells the passes of block LU-SGS over the plain Jacobian grow without bound. data/wake_cone.su2: gmsh -3 wake_cone.geo.
Expectations: differences of steady flows; the same case in another unit or place; the same case solved deeper.
"""

from __future__ import annotations

import json
import math
import re
import shutil
import tempfile
import unittest
from pathlib import Path

from program import RANKS, box, gmsh_text, run, write_case

DATA = Path(__file__).resolve().parent / "data"
CONE = """\
[mesh]
file = "cone.su2"
[reference]
length = 1.0
area = 0.12566
moment_center = [0.5, 0, 0]
model = "half"
[freestream]
mach = 2.0
alpha = 1.0
[boundary]
body = "wall"
symmetry = "symmetry"
farfield = "farfield"
"""
HARD = {"space.dissipative_lee": "false"}  # by default the wake comes to rest (see test_a_wake_comes_to_rest)
# The flow has no steady state with the default of 0.2 (see test_a_march_that_stalls).
STEADY = HARD | {"space.limiter_threshold": 0.05}


class Case(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def result(self, verb: str, settings: dict[str, object], case: str = "case.toml", ranks: int = RANKS) -> dict:
        words = [word for key, value in settings.items() for word in ("--set", f"{key}={value}")]
        self.runs = getattr(self, "runs", 0) + 1
        out = f"run_{self.runs}"
        self.outcome = run(self.folder, verb, case, "--out", out, *words, ranks=ranks)
        return json.loads((self.folder / out / "result.json").read_text())


class Wake(Case):
    def setUp(self) -> None:
        super().setUp()
        shutil.copy(DATA / "wake_cone.su2", self.folder / "cone.su2")
        (self.folder / "case.toml").write_text(CONE)

    def slopes(self) -> dict[str, float]:
        step = 0.01  # degrees; the flows are ten decades down
        below, above = (self.result("run", STEADY | {"freestream.alpha": 1.0 + d})["forces"] for d in (-step, step))
        return {name: (above[name] - below[name]) / math.radians(2 * step) for name in ("CN", "Cm")}

    def test_linear_solves_end_at_the_derivative(self) -> None:
        slopes = self.slopes()
        for method in ("gmres", "march"):
            found = self.result("derivatives", STEADY | {"derivatives.method": method})
            self.assertEqual(found["status"], "converged", self.outcome.err)
            for name, slope in slopes.items():
                with self.subTest(method=method, load=name):
                    entry = found["derivatives"][f"{name}_alpha"]
                    curvature = 2e-4 * abs(slope)  # of the difference itself, and its kinks
                    self.assertLessEqual(abs(entry["value"] - slope), entry["uncertainty"] + curvature)
                    self.assertLess(entry["uncertainty"], 5e-3)

    def test_what_the_linear_residual_leaves_is_in_the_uncertainty(self) -> None:
        """The residual that is left is that of the wake's few cells, which earlier ones hardly were; by the same solves nine decades down."""
        exact = self.result("derivatives", STEADY | {"derivatives.orders": 9})["derivatives"]
        for orders in (1, 2, 3):
            found = self.result("derivatives", STEADY | {"derivatives.orders": orders})["derivatives"]
            for name, entry in found.items():
                with self.subTest(orders=orders, name=name):
                    self.assertLessEqual(abs(entry["value"] - exact[name]["value"]), entry["uncertainty"] + exact[name]["uncertainty"])

    def test_a_wake_comes_to_rest(self) -> None:
        """By default, without a change of the case, and the cells that see to it are counted; some eighth of all."""
        found = self.result("run", {})
        self.assertEqual((found["status"], found["message"]), ("converged", ""))
        count = re.search(r"(\d+) cells behind walls that face aft are of first order", self.outcome.err + self.outcome.out)
        self.assertIsNotNone(count)
        self.assertLess(int(count[1]), found["mesh"]["cells"] / 8)

    def test_a_march_that_stalls(self) -> None:
        """It says so, and either comes to rest with a limiter that it names, or does not call itself converged."""
        found = self.result("run", HARD)
        self.assertIn("stalls", found["message"])
        self.assertIn("lowered to 0.05", found["message"])
        self.assertEqual(found["status"], "converged")

    def test_a_march_that_never_comes_to_rest_ends(self) -> None:
        """Barth & Jespersen's limiter switches between corners for ever (Venkatakrishnan 1995)."""
        found = self.result("run", HARD | {"space.limiter": "barth_jespersen", "steady.krylov_directions": 0})
        self.assertNotEqual(found["status"], "converged")
        self.assertIn("falls no more", found["message"])
        self.assertIn("worst: cell", found["message"])
        self.assertLess(found["performance"]["iterations"], 1500)  # 2000 are allowed to each beginning


    def test_any_number_of_ranks(self) -> None:
        """Other parts of the mesh make another preconditioner: results differ by what the linear solves leave, and say so."""
        runs = [self.result("derivatives", {}, ranks=ranks)["derivatives"] for ranks in (1, 2, 3)]
        deep = [self.result("derivatives", {"derivatives.orders": 9}, ranks=ranks)["derivatives"] for ranks in (1, 3)]
        for found, share in ((runs, None), (deep, 1e-7)):
            for other in found[1:]:
                for name, entry in found[0].items():
                    with self.subTest(name=name, share=share):
                        difference = abs(other[name]["value"] - entry["value"])
                        self.assertLessEqual(difference, entry["uncertainty"] + other[name]["uncertainty"])
                        if share:
                            variable = name.split("_", 1)[1]
                            largest = max(abs(e["value"]) for key, e in found[0].items() if key.endswith("_" + variable))
                            self.assertLessEqual(difference, share * largest)


class Units(Case):
    """A unit of length is a name: every coefficient and derivative is what it was, in the same iterations."""

    def test_units_and_places(self) -> None:
        points, cells, patches = box(4)
        # Far from the origin: coordinates of a thousand edges leave thirteen digits of a cell.
        for name, shift in (("here", 0.0), ("far", 1000.0)):
            moved = [(x + shift, y, z + shift) for x, y, z in points]
            (self.folder / f"{name}.msh").write_text(gmsh_text(moved, cells, patches))
        write_case(self.folder)
        expected = None
        for mesh, unit in (("here", 1.0), ("here", 1e-3), ("here", 1 / 0.0254), ("here", 1000.0), ("here", 1 / 7.3), ("far", 1.0)):
            shift = 1000.0 if mesh == "far" else 0.0
            found = self.result(
                "derivatives",
                {"mesh.file": f"{mesh}.msh", "mesh.scale": unit, "reference.length": 0.5 * unit, "reference.area": unit**2,
                 "reference.moment_center": [(0.5 + shift) * unit, 0.0, shift * unit], "freestream.mach": 3, "freestream.alpha": 4,
                 "derivatives.orders": 8},
            )  # fmt: skip
            self.assertEqual(self.outcome.codes, [0] * RANKS, self.outcome.err)
            values = {name: entry["value"] for name, entry in found["derivatives"].items()}
            values |= {name: found["forces"][name] for name in ("CA", "CN", "Cm")}
            expected = expected or (values, found["performance"]["iterations"])
            self.assertEqual(found["performance"]["iterations"], expected[1])
            for name, value in values.items():
                with self.subTest(mesh=mesh, unit=unit, name=name):
                    self.assertAlmostEqual(value, expected[0][name], delta=1e-6 * max(1.0, abs(expected[0][name])))


class StoppedEarly(Case):
    def test_what_the_steady_residual_leaves_is_in_the_uncertainty(self) -> None:
        write_case(self.folder, mesh=gmsh_text(*box(5)))
        stream = {"freestream.mach": 2.2, "freestream.alpha": 6}
        exact = self.result("derivatives", stream | {"derivatives.orders": 8})["derivatives"]
        for orders in (1, 2, 3, 4, 5, 6, 7):
            found = self.result("derivatives", stream | {"steady.orders": orders})["derivatives"]
            largest = max(abs(found[name]["value"] - exact[name]["value"]) for name in exact)
            for name, entry in found.items():
                with self.subTest(orders=orders, name=name):
                    error = abs(entry["value"] - exact[name]["value"])
                    self.assertLessEqual(error, entry["uncertainty"] + exact[name]["uncertainty"])
            if orders <= 2:  # it is the steady part that holds them
                self.assertGreater(largest, 3e-5)
                self.assertGreater(max(entry["parts"]["steady"] for entry in found.values()), 0.5 * largest)

    def test_what_the_linear_residual_leaves_is_in_the_uncertainty(self) -> None:
        """Few iterations, in which a load may stand still by chance; by the same solves nine decades down."""
        write_case(self.folder, mesh=gmsh_text(*box(5)))
        first_order = {"space.order": 1, "freestream.mach": 1.5, "freestream.alpha": 10}
        plain = first_order | {"space.flux": "van_leer", "space.limiter": "none", "space.gradient": "green_gauss", "steady.sweeps": 8}
        for case in (first_order, plain, {}, {"freestream.mach": 3, "freestream.alpha": 8, "steady.sweeps": 16}):
            for verb in ("derivatives", "adjoint"):
                exact = self.result(verb, case | {"derivatives.orders": 9})["derivatives"]
                for settings in ({"derivatives.orders": 1}, {"derivatives.orders": 2}, {}):
                    found = self.result(verb, case | settings)
                    self.assertEqual(found["status"], "converged", self.outcome.err)
                    for name, entry in found["derivatives"].items():
                        with self.subTest(case=case, verb=verb, settings=settings, name=name):
                            error = abs(entry["value"] - exact[name]["value"])
                            self.assertLessEqual(error, entry["uncertainty"] + exact[name]["uncertainty"])

    def test_a_cut_solve_knows_no_uncertainty(self) -> None:
        """Less than two decades down nothing is known of the error of a derivative, or of those that rest on it."""
        write_case(self.folder, mesh=gmsh_text(*box(5)))
        for verb in ("derivatives", "adjoint"):
            found = self.result(verb, {"derivatives.max_iterations": 1})
            self.assertEqual(found["status"], "not_converged")
            for name, entry in found["derivatives"].items():
                with self.subTest(verb=verb, name=name):
                    # A load that the plate does not bear is nought, whatever was solved for.
                    self.assertEqual(entry["uncertainty"], None if name[:2] in ("CN", "Cl", "Cm") else 0 if verb == "adjoint" else None)


if __name__ == "__main__":
    unittest.main()
