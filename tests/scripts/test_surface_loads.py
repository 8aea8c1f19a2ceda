#!/usr/bin/python3
"""Cuts of a surface whose pressure is linear in space, and interference of loads that are known."""

from __future__ import annotations

import csv
import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np
from scipy.spatial import ConvexHull
from workspace import SCRIPTS

from sweep import cuts
from sweep.errors import SweepError
from sweep.interference import interference
from sweep.surface import Surface

RADIUS = 0.5


def cylinder() -> tuple[np.ndarray, np.ndarray]:
    """Points and triangles of one along x from 0 to 2."""
    angle = np.linspace(0, 2 * np.pi, 48, endpoint=False)
    ring = np.column_stack([np.zeros_like(angle), RADIUS * np.sin(angle), RADIUS * np.cos(angle)])
    points = np.vstack([ring, ring + [2.0, 0, 0]])
    return points, ConvexHull(points, qhull_options="QJ").simplices


def write_surface(path: Path) -> None:
    """As the program does: a cylinder, and a panel above it in the plane y = 0.1; cp = 2 x - z, its derivative 3 + y."""
    points, corners = cylinder()
    panel = np.array([[1, 0.1, 0.5], [2, 0.1, 0.5], [2, 0.1, 1.5], [1.5, 0.1, 1.5]], float)
    patch = np.repeat([0, 1], [len(corners), 2]).astype(np.int32)
    corners = np.vstack([corners, len(points) + np.array([[0, 1, 2], [0, 2, 3]])])
    points = np.vstack([points, panel])
    with h5py.File(path, "w") as file:
        group = file.create_group("VTKHDF")
        group["Points"], group["Connectivity"], group["CellData/patch"] = points, corners.reshape(-1), patch
        group["CellData/patch"].attrs["names"] = np.bytes_("tube\nfin 1\n")
        group["PointData/cp"], group["PointData/cp_alpha"] = 2 * points[:, 0] - points[:, 2], 3 + points[:, 1]


class Cuts(unittest.TestCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        write_surface(self.folder / "surface.vtkhdf")
        self.surface = Surface.read(self.folder / "surface.vtkhdf")

    def check(self, cut: cuts.Cut) -> None:
        x, y, z = np.moveaxis(cut.ends, -1, 0)
        np.testing.assert_allclose(cut.values["cp"], 2 * x - z, atol=1e-6)
        np.testing.assert_allclose(cut.values["cp_alpha"], 3 + y, atol=1e-6)

    def test_across(self) -> None:
        cut = cuts.across_x(self.surface, 0.7)
        self.check(cut)
        np.testing.assert_allclose(cut.ends[..., 0], 0.7)
        length = np.linalg.norm(np.diff(cut.ends, axis=1), axis=-1).sum()
        self.assertAlmostEqual(length, 48 * 2 * RADIUS * np.sin(np.pi / 48), places=5)  # once around, each piece once
        self.assertEqual(set(cut.patch), {"tube"})

    def test_along(self) -> None:
        cut = cuts.along_y(self.surface, 0.0)
        self.check(cut)
        length = np.linalg.norm(np.diff(cut.ends, axis=1), axis=-1).sum()
        self.assertAlmostEqual(length, 2 * (2 + 2 * RADIUS), places=4)

    def test_across_a_panel(self) -> None:
        """At half of its span it reaches from 1.25 to 2: z = 1 is half-way up."""
        cut = cuts.across_fin(self.surface, "fin 1", 0.5)
        self.check(cut)
        self.assertAlmostEqual(cut.ends[..., 2].min(), 1.0, places=6)
        self.assertAlmostEqual(cut.ends[..., 0].min(), 1.25, places=6)
        self.assertAlmostEqual(cut.ends[..., 0].max(), 2.0, places=6)
        with self.assertRaisesRegex(SweepError, "there is no patch 'fin_2'; there are tube, fin 1"):
            cuts.across_fin(self.surface, "fin_2", 0.5)

    def test_script(self) -> None:
        command = [sys.executable, "-B", SCRIPTS / "pressure_cuts.py", self.folder, "--x", "0.7", "--fin", "fin 1=0.5"]
        command += ["--of", "cp,cp_alpha"]
        done = subprocess.run([*command, "-o", self.folder / "cuts"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = list(csv.DictReader((self.folder / "cuts.csv").read_text().splitlines()[2:]))
        self.assertEqual({row["cut"] for row in rows}, {"x = 0.7", "fin 1 = 0.5"})
        self.assertAlmostEqual(float(rows[0]["cp"]), 2 * float(rows[0]["x"]) - float(rows[0]["z"]), places=5)
        self.assertTrue((self.folder / "cuts.png").exists())
        done = subprocess.run([*command[:-4], "--fin", "body=2"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        done = subprocess.run([*command[:3], self.folder / "none"], capture_output=True, text=True)
        self.assertIn("give the folder of a run", done.stderr)
        self.assertEqual(done.returncode, 1)


class Interference(unittest.TestCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def write(self, name: str, walls: dict[str, tuple[float, float]], mach: float = 2.0) -> Path:
        """A run whose walls have CN and CN_alpha."""
        folder = self.folder / name
        folder.mkdir()
        components = {wall: {"CN": steady} for wall, (steady, _) in walls.items()}
        (folder / "result.json").write_text(json.dumps({
            "freestream": {"mach": mach, "alpha": 1, "beta": 0, "gamma": 1.4},
            "reference": {"length": 1, "area": 1, "moment_center": [0, 0, 0], "model": "half"},
            "forces": {"components": components | {"set": {"CN": 99.0}}}, "derivatives": {"CN_alpha": {}},
        }))  # fmt: skip
        rows = [f"{wall},{wall},CN_alpha,{by},0.25" for wall, (_, by) in walls.items()]
        lines = ["# Components", "component,walls,name,value,uncertainty", *rows, "set,nose tube,CN_alpha,99,0.25"]
        (folder / "components.csv").write_text("\n".join(lines) + "\n")
        return folder

    def test_body_in_the_presence_of_fins(self) -> None:
        whole = self.write("whole", {"nose": (0.1, 2.0), "tube": (0.2, 1.5), "fin_1": (0.4, 6.0)})
        alone = self.write("alone", {"nose": (0.1, 2.0), "tube": (0.05, 0.5)})
        steady, slope = interference(whole, alone)
        self.assertEqual((slope.name, slope.total, slope.body, slope.others, slope.alone), ("CN_alpha", 9.5, 3.5, 6.0, 2.5))
        self.assertEqual((slope.interference, slope.uncertainty), (1.0, 1.0))
        self.assertAlmostEqual(steady.interference, 0.15)
        done = subprocess.run([sys.executable, "-B", SCRIPTS / "interference.py", whole, alone], capture_output=True, text=True)
        self.assertRegex(done.stdout, r"CN_alpha +9.5 +3.5 +6 +2.5 +1 +1\n")

    def test_what_is_no_pair(self) -> None:
        whole = self.write("whole", {"nose": (0.1, 2.0), "fin_1": (0.4, 6.0)})
        for name, walls, mach, words in (
            ("faster", {"nose": (0.1, 2.0)}, 2.5, "freestream.mach is 2.5, not 2.0"),
            ("other", {"cone": (0.1, 2.0)}, 2.0, "has no wall cone"),
            ("same", {"nose": (0.1, 2.0), "fin_1": (0.4, 6.0)}, 2.0, "must be without fins"),
        ):
            with self.assertRaisesRegex(SweepError, words):
                interference(whole, self.write(name, walls, mach))


if __name__ == "__main__":
    unittest.main()
