#!/usr/bin/python3
"""The part of the mesh in the uncertainty of derivatives: one command on three meshes beside runs on each of them."""

from __future__ import annotations

import itertools
import json
import math
import statistics
import tempfile
import unittest
from pathlib import Path

from program import CASE, RANKS, Outcome, box, gmsh_text, run, write_case

RATIO = 6 / 4  # of the spacings of the two finer boxes
FORMAL_ORDER = 2
FACTOR, LEVER = 2.75, 0.2  # src/analysis/mesh_convergence.hpp
LOADS = ("CA", "CY", "CN", "Cl", "Cm", "Cn")
KINDS = (("alpha", "beta"), ("p", "q", "r"), ("alphadot", "betadot"))


def about(values: dict[str, float], dx: float) -> dict[str, float]:
    """Derivatives about a centre, also of rotation, dx reference lengths aft: the old one then moves with q and r."""
    get = lambda load, variable: values.get(f"{load}_{variable}", 0.0)
    moved = {}
    for variable in (name for kind in KINDS for name in kind):
        column = {load: get(load, variable) for load in LOADS}
        if variable == "q":
            column = {load: value - 2 * dx * get(load, "alpha") for load, value in column.items()}
        if variable == "r":
            column = {load: value + 2 * dx * get(load, "beta") for load, value in column.items()}
        column["Cm"] += dx * column["CN"]
        column["Cn"] += dx * column["CY"]
        moved |= {f"{load}_{variable}": value for load, value in column.items()}
    return moved


def half_widths(fine: dict[str, float], coarse: dict[str, float], body_length: float) -> dict[str, float]:
    """FACTOR hypot(e, s E): e of differences, s of centres around, E the median of e / s over kinds of loads and variables."""
    error = {name: abs(fine[name] - coarse[name]) / (RATIO**FORMAL_ORDER - 1) for name in fine}
    before, behind = (about(fine, sign * LEVER * body_length) for sign in (-1, 1))
    scale = {name: math.hypot(before[name], behind[name]) / math.sqrt(2) for name in fine}
    shares = []
    for kind, loads in itertools.product(KINDS, (LOADS[:3], LOADS[3:])):
        names = [name for load in loads for variable in kind if (name := f"{load}_{variable}") in fine]
        size = math.hypot(*(scale[name] for name in names))
        shares += [math.hypot(*(error[name] for name in names)) / size] if size > 0 else []
    return {name: FACTOR * math.hypot(error[name], scale[name] * statistics.median(shares)) for name in fine}


class CoarserMeshes(unittest.TestCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        write_case(self.folder, CASE, gmsh_text(*box(6)))
        for cubes in (3, 4):
            (self.folder / f"box{cubes}.msh").write_text(gmsh_text(*box(cubes)))

    def derivatives(self, out: str, *arguments: str) -> Outcome:
        return run(self.folder, "derivatives", "case.toml", "--out", out, *arguments)

    def on_meshes(self, out: str, meshes: str, *arguments: str) -> Outcome:
        return self.derivatives(out, "--set", f"derivatives.coarser_meshes={meshes}", *arguments)

    def found(self, out: str) -> dict:
        return json.loads((self.folder / out / "result.json").read_text())["derivatives"]

    def values(self, out: str) -> dict[str, float]:
        return {name: entry["value"] for name, entry in self.found(out).items()}

    def test_two_meshes_by_hand(self) -> None:
        outcome = self.on_meshes("both", '["box4.msh"]')
        self.assertEqual(outcome.codes, [0] * RANKS, outcome.err)
        self.assertIn("mesh 2 of 2: ", outcome.err)
        self.assertRegex(outcome.out, r"uncertainty +linear +steady +mesh +method")
        self.derivatives("fine")
        self.derivatives("coarse", "--set", "mesh.file=box4.msh")
        fine, coarse = self.values("fine"), self.values("coarse")
        self.assertEqual(self.values("both"), fine)
        self.assertEqual(self.values("both/mesh_2"), coarse)
        facts = json.loads((self.folder / "both" / "result.json").read_text())["configuration"]
        expected = half_widths(fine, coarse, facts["body_length"])
        for name, entry in self.found("both").items():
            step = (fine[name] - coarse[name]) / (RATIO**FORMAL_ORDER - 1)
            scale = max(abs(fine[name]), 1)
            self.assertAlmostEqual(entry["parts"]["mesh"], expected[name], delta=1e-9 * scale)
            self.assertAlmostEqual(entry["mesh_convergence"]["extrapolated"], fine[name] + step, delta=1e-12 * scale)
            self.assertIsNone(entry["mesh_convergence"]["observed_order"])
            self.assertEqual(set(entry["mesh_convergence"]), {"extrapolated", "observed_order"})
            self.assertAlmostEqual(entry["uncertainty"], sum(entry["parts"].values()), delta=1e-15 * scale)
        self.assertGreater(self.found("both")["CN_alphadot"]["parts"]["mesh"], 1e-3)

    def test_three_meshes(self) -> None:
        """Where an order is observed, e32 / e21 = r21^p (r32^p - 1) / (r21^p - 1), or p was cut to the formal one."""
        self.assertEqual(self.on_meshes("three", '["box4.msh", "box3.msh"]').codes, [0] * RANKS)
        fine, medium, coarse = (self.values(out) for out in ("three", "three/mesh_2", "three/mesh_3"))
        orders = {}
        for name, entry in self.found("three").items():
            order = entry["mesh_convergence"]["observed_order"]
            if order is None:
                continue
            orders[name] = order
            changes = (coarse[name] - medium[name]) / (medium[name] - fine[name])
            a, b = RATIO**order, (4 / 3) ** order
            expected = a * (b - 1) / (a - 1)
            with self.subTest(name):
                if order < FORMAL_ORDER:
                    self.assertAlmostEqual(changes, expected, delta=1e-6 * expected)
                else:
                    self.assertGreater(changes, expected)
        self.assertGreater(len(orders), 3)
        self.on_meshes("two", '["box4.msh"]')
        for name, entry in self.found("three").items():
            self.assertLessEqual(entry["uncertainty"], self.found("two")[name]["uncertainty"], name)

    def test_stopped_on_a_coarser_mesh_it_goes_on(self) -> None:
        (self.folder / "part").mkdir()
        (self.folder / "part" / "stop").touch()
        meshes = '["box4.msh", "box3.msh"]'
        self.assertEqual(self.on_meshes("part", meshes).codes, [3] * RANKS)
        result = json.loads((self.folder / "part" / "result.json").read_text())
        self.assertEqual(result["status"], "interrupted")
        self.assertIn("box4.msh: stopped by the file", result["message"])
        self.assertFalse((self.folder / "part" / "stop").exists())
        outcome = self.on_meshes("part", meshes, "--restart")
        self.assertEqual(outcome.codes, [0] * RANKS, outcome.err)
        self.assertIn("goes on from part/mesh_2/checkpoint_000001.vtkhdf", outcome.err)
        again = self.on_meshes("part", meshes, "--restart")
        self.assertEqual(again.err.count("linear solves are taken from the checkpoint"), 3)
        self.on_meshes("full", meshes)
        self.assertEqual(self.found("part"), self.found("full"))

    def test_mistakes_are_told_before_anything_is_computed(self) -> None:
        (self.folder / "other.msh").write_text(gmsh_text(*box(2)).replace('"sides"', '"flanks"'))
        points, cells, patches = box(3)
        longer = [(2 * x, y, z) for x, y, z in points]
        (self.folder / "longer.msh").write_text(gmsh_text(longer, cells, patches))
        for meshes, words in (
            ('["longer.msh"]', "derivatives.coarser_meshes, longer.msh: its walls measure 2 reference areas, those of the mesh before 1"),
            ('["missing.msh"]', "derivatives.coarser_meshes, missing.msh: no such mesh"),
            ('["other.msh"]', 'derivatives.coarser_meshes, other.msh: patch "flanks" of the mesh has no boundary condition'),
            ('["box3.msh", "box4.msh"]', "derivatives.coarser_meshes, box4.msh: 384 cells are not coarser than the 162"),
            ('["box.msh"]', "derivatives.coarser_meshes, box.msh: 1296 cells are not coarser than the 1296"),
            ('["a", "b", "c"]', "derivatives.coarser_meshes must be a list of at most 2 texts"),
        ):
            with self.subTest(meshes):
                outcome = self.on_meshes("none", meshes)
                self.assertEqual(outcome.codes, [1] * RANKS)
                self.assertIn(words, outcome.err)
                self.assertNotIn("steady ", outcome.err)


if __name__ == "__main__":
    unittest.main()
