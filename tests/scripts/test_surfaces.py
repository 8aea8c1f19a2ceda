#!/usr/bin/python3
"""Bodies by their surfaces alone, from CAD and from triangulations made here: what is read, what is refused, and their meshes."""

from __future__ import annotations

import math
import sys
import tempfile
import unittest
from pathlib import Path

import gmsh
import numpy as np
from surface_bodies import Triangles, cone_cylinder, delta_wing, ellipsoid, revolved, write_cad, write_iges, write_stl

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))

from meshing import toolbox as meshing
from meshing.mesher import Made, make_mesh
from meshing.program import read_missile
from meshing.toml_file import DescriptionError

CELLS = 6_000


class Files(unittest.TestCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def read(self, name: str, text: str) -> object:
        (self.folder / name).write_text(text)
        return read_missile(self.folder / name, None)

    def described(self, file: Path, more: str = "") -> object:
        return self.read("missile.toml", f'flight = {{mach = 2}}\n[surface]\nfile = "{file.name}"\n{more}')

    def refused(self, file: Path, *words: str) -> None:
        with self.assertRaises(DescriptionError) as caught:
            read_missile(file, None)
        for word in (file.name, *words):
            self.assertIn(word, str(caught.exception))

    def stl(self, body: Triangles, binary: bool = False) -> Path:
        return write_stl(self.folder / "body.stl", {"body": body}, binary)


class Reading(Files):
    def test_stl_of_both_kinds(self) -> None:
        # Of a cone and a cylinder with 24 sides the volume is that of the round ones times the polygon's share of the circle.
        polygon = 12.0 / math.pi * math.sin(math.pi / 12.0)
        for binary in (False, True):
            shape = read_missile(self.stl(cone_cylinder(), binary), None)
            self.assertAlmostEqual(shape.surface.volume, math.pi / 4.0 * (3.0 / 3.0 + 4.0) * polygon, places=4)
            self.assertEqual(shape.surface.names, ("body", "base"))
            self.assertAlmostEqual(shape.diameter, math.cos(math.pi / 24.0), places=5)
            self.assertTrue(shape.is_symmetric(1) and shape.is_symmetric(2))

    def test_obj_with_polygons_and_groups(self) -> None:
        points, _ = delta_wing()
        lines = ["v {} {} {}".format(*p) for p in points]
        lines += ["o upper", "f 1/1 2/1 4/1", "f 1 4 3", "f 4 2 6", "f -3 6 3", "g lower side", "f 1 5 2", "f 1 3 5", "f 5 6 2", "f 5 3 6"]
        shape = self.read("wing.obj", "\n".join(lines))
        self.assertEqual(shape.surface.names, ("upper", "lower_side"))
        self.assertAlmostEqual(shape.surface.volume, 0.6 * 0.1 / 3.0, places=9)

    def test_cart3d_with_its_names(self) -> None:
        points, triangles = delta_wing()
        rows = [f"{len(points)} {len(triangles)}", *(" ".join(map(str, p)) for p in points), *(" ".join(map(str, t + 1)) for t in triangles)]
        labels = [str(1 + (i >= 4)) for i in range(len(triangles))]
        (self.folder / "Config.xml").write_text(
            '<Configuration Name="c"><Component Name="Upper" Type="tri"><Data>Face Label=1</Data></Component></Configuration>'
        )
        shape = self.read("wing.i.tri", "\n".join([*rows, *labels]))
        self.assertEqual(shape.surface.names, ("Upper", "part_2"))

    def test_iges_and_brep(self) -> None:
        # A cone of 300 and a cylinder of 400 behind it, of radius 50: pi r^2 (l / 3 + l'). IGES has a unit and loose faces, BREP a solid
        # and no unit; the fins of the solid are eight wedges of 80 by 100 by 4 / 2 outside of the body.
        round_body = math.pi * 50.0**2 * (300.0 / 3.0 + 400.0)
        profile = [(0.0, 0.0), (300.0, 50.0), (700.0, 50.0), (700.0, 0.0)]
        for file, volume, length in (
            (write_iges(self.folder / "body.iges", profile), 1e-9 * round_body, 0.7),
            (write_cad(self.folder / "body.brep", "finned"), round_body + 8 * 80.0 * 100.0 * 2.0, 700.0),
        ):
            with self.subTest(file.name):
                shape = read_missile(file, None)
                self.assertAlmostEqual(shape.length / length, 1.0, places=9)
                self.assertAlmostEqual(shape.surface.volume / volume, 1.0, delta=0.01)  # 30 sides around: 0.7 % less
                self.assertEqual(shape.surface.names, ("body", "base"))
                self.assertTrue(shape.is_symmetric(1) and shape.is_symmetric(2))
        self.refused(write_iges(self.folder / "open.igs", profile[:-1]), "its faces do not close one")

    def test_axes_boxes_and_units(self) -> None:
        points, triangles = cone_cylinder()
        forward = np.column_stack([-points[:, 0], points[:, 1], -points[:, 2]])  # flying along its own x, z down
        write_stl(self.folder / "body.stl", {"body": (forward, triangles)})
        parts = '[[parts]]\nname = "nose"\nlow = [-1, -1, -1]\nhigh = [3, 1, 1]\n'
        shape = self.described(self.folder / "body.stl", 'axes = ["-x", "y", "-z"]\n' + parts)
        self.assertEqual((shape.surface.points[:, 0].min(), shape.surface.points[:, 0].max()), (0.0, 7.0))
        self.assertEqual(shape.surface.names, ("body", "nose", "base"))
        with self.assertRaisesRegex(DescriptionError, "missile.toml:4: axes.*mirror image"):
            self.described(self.folder / "body.stl", 'axes = ["-x", "y", "z"]\n')
        with self.assertRaisesRegex(DescriptionError, "missile.toml:5: low.*|nothing of the surface"):
            self.described(self.folder / "body.stl", '[[parts]]\nname = "far"\nlow = [9, 9, 9]\nhigh = [10, 10, 10]\n')

    def test_holes_and_crossings_have_coordinates(self) -> None:
        points, triangles = cone_cylinder()
        hole = np.delete(triangles, np.flatnonzero(np.all(points[triangles][:, :, 0] > 6.99, axis=1)), axis=0)
        self.refused(self.stl((points, hole)), "a hole around (7,", "open edges")
        other = points * [1.0, 1.0, 1.0] + [2.0, 0.4, 0.1]
        both = np.concatenate([points, other]), np.concatenate([triangles, triangles + len(points)])
        self.refused(self.stl(both), "cross each other near (", "unite them")
        folded = points.copy()
        folded[0] = [3.6, 0.9, 0.0]  # the tip turned back, through the sides of the cone
        self.refused(self.stl((folded, triangles)), "crosses itself near (")

    def test_damaged_files(self) -> None:
        file = self.stl(cone_cylinder(), binary=True)
        file.write_bytes(file.read_bytes()[:-20])
        self.refused(file, "is damaged")
        (self.folder / "bad.step").write_text("ISO-10303-21;\n")
        self.refused(self.folder / "bad.step", "cannot read it as a body")
        self.refused(self.folder / "none.step", "No such file")
        with self.assertRaisesRegex(DescriptionError, "what is '.3dm'"):
            self.read("body.3dm", "")


class Meshes(Files):
    def made(self, file: Path, model: str) -> Made:
        shape = read_missile(file, None)
        gmsh.initialize(readConfigFiles=False)
        gmsh.option.setNumber("General.Terminal", 0)
        try:
            made = make_mesh(shape, None, CELLS)
        finally:
            gmsh.finalize()
        self.assertEqual(made.model, model)
        self.assertLess(abs(len(made.mesh.tets) / CELLS - 1.0), 0.15)
        return made

    def area(self, made: Made, name: str) -> float:
        return float(np.linalg.norm(meshing.area_vectors(made.mesh.points, made.mesh.patches[name]), axis=1).sum())

    def test_five_solids(self) -> None:
        base = math.pi * 0.05**2
        for make, model, names, share in (
            ("finned", "half", {"body", "base"}, 0.5), ("one_fin", "full", {"body", "base"}, 1.0),
            ("apart", "half", {"part_1", "part_2", "base"}, 0.5), ("blunt", "half", {"body", "base"}, 0.5),
            ("boattailed", "half", {"body", "base"}, 0.5),
        ):  # fmt: skip
            with self.subTest(make):
                made = self.made(write_cad(self.folder / f"{make}.step", make), model)
                walls = set(made.mesh.patches) - {"symmetry", "farfield"}
                self.assertTrue(names <= walls, walls)
                exact = share * base * (0.49 if make == "boattailed" else 1.0)
                # As few cells make a disc of as few as twelve sides.
                self.assertAlmostEqual(self.area(made, "base"), exact, delta=0.06 * exact)

    def test_iges(self) -> None:
        made = self.made(write_iges(self.folder / "body.igs", [(0.0, 0.0), (300.0, 50.0), (700.0, 50.0), (700.0, 0.0)]), "half")
        cone = 0.5 * math.pi * 0.05 * (math.hypot(0.3, 0.05) + 2.0 * 0.4)
        self.assertAlmostEqual(self.area(made, "body"), cone, delta=0.03 * cone)

    def test_five_triangulations(self) -> None:
        points, triangles = cone_cylinder()
        tilted = points + 0.1 * np.column_stack([0.0 * points[:, 0], np.maximum(points[:, 0] - 3.0, 0.0) ** 2 / 16.0, 0.0 * points[:, 0]])
        flare = revolved([(0, 0), (1, 0.3), (3, 0.3), (4, 0.6), (4, 0.2), (4, 0)], 24)
        for name, body, model in (
            ("cone", (points, triangles), "half"), ("bent", (tilted, triangles), "full"), ("ellipsoid", ellipsoid(), "half"),
            ("wing", delta_wing(), "half"), ("flare", flare, "half"),
        ):  # fmt: skip
            with self.subTest(name):
                made = self.made(write_stl(self.folder / f"{name}.stl", {name: body}), model)
                own = np.linalg.norm(np.cross(*(body[0][body[1]][:, i] - body[0][body[1]][:, 0] for i in (1, 2))), axis=1).sum() / 2.0
                walls = sum(self.area(made, patch) for patch in set(made.mesh.patches) - {"symmetry", "farfield"})
                self.assertAlmostEqual(walls, own * (0.5 if model == "half" else 1.0), delta=0.03 * own)


if __name__ == "__main__":
    unittest.main()
