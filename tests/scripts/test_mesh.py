#!/usr/bin/python3
"""Meshes from descriptions: components, areas, symmetry, numbers of cells, files, and refusals that leave nothing behind."""

from __future__ import annotations

import contextlib
import math
import subprocess
import sys
import tempfile
import tomllib
import unittest
from collections.abc import Iterator
from pathlib import Path

import gmsh
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))

from meshing import toolbox as meshing
from meshing.description import read_description
from meshing.mesher import Made, make_mesh
from meshing.missile import Missile

BODY = '[flight]\nmach = 2\n[[body]]\nshape = "cone"\nlength = 3\ndiameter = 1\n[[body]]\nshape = "cylinder"\nlength = 5\n'
FINS = "[[fins]]\nnumber = 4\nx_end = 8\nroot_chord = 1\nspan = 1\nthickness = 0.08\n"


@contextlib.contextmanager
def mesher() -> Iterator[None]:
    gmsh.initialize(readConfigFiles=False)
    gmsh.option.setNumber("General.Terminal", 0)
    try:
        yield
    finally:
        gmsh.finalize()


def area(mesh: meshing.TetMesh, name: str) -> float:
    return float(np.linalg.norm(meshing.area_vectors(mesh.points, mesh.patches[name]), axis=1).sum())


class Meshes(unittest.TestCase):
    def made(self, text: str, cells: int = 15_000, model: str | None = None) -> tuple[Missile, Made]:
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "missile.toml"
            file.write_text(text)
            missile = read_description(file)
        with mesher():
            made = make_mesh(missile, model, cells)
        self.assertLess(abs(len(made.mesh.tets) / cells - 1.0), 0.15)
        return missile, made

    def test_quarter_becomes_a_symmetric_half(self) -> None:
        _, made = self.made(BODY + FINS + 'section = "single_wedge"\n')
        self.assertEqual(made.model, "half")
        self.assertEqual(list(made.mesh.patches), ["nose", "body", "fin_1", "fin_2", "fin_3", "base", "symmetry", "farfield"])
        self.assertTrue(meshing.is_symmetric(made.mesh, 2))
        # Half a disc, and the blunt trailing edges of 0.08 by 1 of one whole fin and two halves.
        self.assertAlmostEqual(area(made.mesh, "base"), math.pi / 8.0 + 2 * 0.08, delta=0.01)
        # Of a half fin one side and half of the tip; its root is a little above 0.5 d.
        half = math.hypot(1.0, 0.04) + 0.5 * 0.04
        self.assertAlmostEqual(area(made.mesh, "fin_1"), half, delta=0.01)
        self.assertAlmostEqual(area(made.mesh, "fin_2"), 2.0 * half, delta=0.02)
        # Off the fins and the tip the facets are those of a prism and of a pyramid, none tilted along the stream.
        for name, low, high in (("body", 3.0, 6.65), ("nose", 1.2, 3.0)):
            triangles = made.mesh.patches[name]
            x = made.mesh.points[triangles, 0]
            vectors = meshing.area_vectors(made.mesh.points, triangles[(x.min(axis=1) > low - 1e-6) & (x.max(axis=1) < high + 1e-6)])
            self.assertGreater(len(vectors), 50)
            self.assertLess(np.ptp(vectors[:, 0] / np.linalg.norm(vectors, axis=1)), 1e-6)

    def test_three_fins_have_a_half_and_a_full_model(self) -> None:
        text = BODY + FINS.replace("number = 4", "number = 3") + 'section = "flat"\nsweep = 30\ntip_chord = 0.5\n'
        _, half = self.made(text)
        self.assertNotIn("fin_3", half.mesh.patches)
        _, full = self.made(text, 30_000, "full")
        self.assertTrue(meshing.is_symmetric(full.mesh, 1))
        self.assertNotIn("symmetry", full.mesh.patches)
        self.assertAlmostEqual(area(full.mesh, "fin_2"), area(full.mesh, "fin_3"), places=12)
        self.assertAlmostEqual(area(full.mesh, "fin_1"), 2.0 * area(half.mesh, "fin_1"), delta=0.02)

    def test_deflected_panels_need_all_around(self) -> None:
        _, made = self.made(BODY + FINS + "deflection = 5\n", 30_000)
        self.assertEqual(made.model, "full")
        areas = [area(made.mesh, f"fin_{i}") for i in range(1, 5)]
        # Both sides, double wedge, and the tip.
        np.testing.assert_allclose(areas, 4.0 * math.hypot(0.5, 0.04) + 0.04, rtol=0.02)

    def test_subsonic_far_field_is_a_sphere(self) -> None:
        _, made = self.made(BODY.replace("mach = 2", "mach = [0.5, 0.8]") + FINS)
        far = made.mesh.points[np.unique(made.mesh.patches["farfield"])]
        np.testing.assert_allclose(np.linalg.norm(far - [4.0, 0.0, 0.0], axis=1), 50 * 8.0, rtol=1e-6)

    def test_a_body_alone_with_boattail_and_steps(self) -> None:
        text = BODY + '[[body]]\nshape = "cylinder"\nlength = 1\nstart_diameter = 0.8\n[[body]]\nshape = "cone"\nlength = 1\ndiameter = 0.5\n'
        _, made = self.made(text)
        # The step faces backwards: it is a base, like the end.
        self.assertAlmostEqual(area(made.mesh, "base"), math.pi / 8.0 * (1.0 - 0.64 + 0.25), delta=0.01)
        self.assertAlmostEqual(area(made.mesh, "boattail"), 0.5 * math.pi * (0.4 + 0.25) * math.hypot(1.0, 0.15), delta=0.02)

    def test_half_of_what_is_not_symmetric_is_refused(self) -> None:
        with self.assertRaisesRegex(meshing.MeshError, "not symmetric about y = 0"):
            self.made(BODY + FINS + "cant = 2\n", model="half")


class Program(unittest.TestCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        (self.folder / "missile.toml").write_text(BODY + FINS)

    def run_mesh(self, *options: str, code: int) -> str:
        command = [sys.executable, "-B", str(ROOT / "scripts" / "mesh.py"), *options]
        done = subprocess.run(command, cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def test_writes_mesh_case_report_and_picture(self) -> None:
        self.run_mesh("missile.toml", "--cells", "8000", code=0)
        written = sorted(file.name for file in (self.folder / "missile").iterdir())
        self.assertEqual(written, ["case.toml", "mesh.msh", "picture.png", "report.txt"])
        case = tomllib.loads((self.folder / "missile" / "case.toml").read_text())
        self.assertEqual(case["mesh"]["file"], "mesh.msh")
        self.assertEqual(case["reference"], {"length": 1, "area": 0.7853981634, "moment_center": [4, 0, 0], "model": "half"})
        with mesher():
            mesh = meshing.read(self.folder / "missile" / "mesh.msh")
        self.assertEqual(set(case["boundary"]), set(mesh.patches))
        self.assertEqual({kind for kind in case["boundary"].values()}, {"wall", "jet", "symmetry", "farfield"})

    def test_a_mesh_alone(self) -> None:
        self.run_mesh("missile.toml", "--cells", "8000", "-o", "half.msh", code=0)
        with mesher():
            self.assertLess(abs(len(meshing.read(self.folder / "half.msh").tets) / 8000 - 1.0), 0.15)
        self.assertEqual(sorted(file.name for file in self.folder.iterdir()), ["half.msh", "missile.toml"])
        self.assertIn("half.msh holds one mesh", self.run_mesh("missile.toml", "--level", "tiny", "coarse", "-o", "half.msh", code=2))

    def test_help_needs_python_alone(self) -> None:
        bare = [sys.executable, "-S", "-B", str(ROOT / "scripts" / "mesh.py")]  # -S: without the packages of Debian
        done = subprocess.run([*bare, "--help"], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("--level", done.stdout)
        done = subprocess.run([*bare, "--keys"], capture_output=True, text=True)
        self.assertNotEqual(done.returncode, 0)
        self.assertRegex(done.stderr, r"^alphadot mesh: No module named '\w+'; install the Debian packages python3-gmsh")

    def test_mistakes(self) -> None:
        (self.folder / "wrong.toml").write_text(BODY + FINS.replace("span = 1", "span = 0"))
        said = self.run_mesh("wrong.toml", code=1)
        self.assertIn("wrong.toml:14: span = 0: must be a number above 0", said)
        self.assertFalse((self.folder / "wrong").exists())
        self.assertIn("give a description", self.run_mesh(code=2))
        self.assertIn("it makes 5,000", self.run_mesh("missile.toml", "--cells", "10", code=2))
        self.assertIn("not LOW:HIGH", self.run_mesh("missile.toml", "--mach", "fast", code=2))
        self.assertIn("root_chord", self.run_mesh("--keys", code=0))


if __name__ == "__main__":
    unittest.main()
