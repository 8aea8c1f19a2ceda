#!/usr/bin/python3
"""A description in place of a case: meshed once, found again, and refused at Mach numbers that its mesh is not for."""

from __future__ import annotations

import tempfile
import unittest
from pathlib import Path

from program import RANKS, run

MISSILE = """flight = {mach = [1.8, 2.5]}
[[body]]
shape = "cone"
length = 3
diameter = 1
[[body]]
shape = "cylinder"
length = 4
"""


class DescribedCase(unittest.TestCase):
    def test_meshed_once(self) -> None:
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "missile.toml").write_text(MISSILE)
            options = ("check", "missile.toml", "--set", "mesh.level=tiny")
            first = run(folder, *options)
            self.assertEqual(first.codes, [0] * RANKS, first.err)
            (kept,) = (folder / "meshes").iterdir()
            meshes = sorted(kept.glob("*.msh"))
            self.assertEqual([mesh.name for mesh in meshes], ["tiny.msh"])
            made = meshes[0].stat().st_mtime_ns
            # The same again, with another Mach number of the range: no other mesh.
            again = run(folder, *options, "freestream.mach=2.5")
            self.assertEqual(again.codes, [0] * RANKS, again.err)
            self.assertEqual([path.name for path in (folder / "meshes").iterdir()], [kept.name])
            self.assertEqual(meshes[0].stat().st_mtime_ns, made)
            outside = run(folder, *options, "freestream.mach=3")
            self.assertEqual(outside.codes, [1] * RANKS)
            self.assertIn("missile.toml: the mesh is for Mach 1.8 to 2.5, not for freestream.mach = 3", outside.err)

    def test_case_that_takes_its_mesh_from_a_description(self) -> None:
        case = """[mesh]
from = "bodies/missile.toml"
level = "tiny"
[reference]
model = "half"
[freestream]
mach = 2
[boundary]
nose = "wall"
body = "wall"
base = "jet"
symmetry = "symmetry"
farfield = "farfield"
"""
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "bodies").mkdir()
            (folder / "bodies" / "missile.toml").write_text(MISSILE)
            (folder / "case.toml").write_text(case)
            first = run(folder, "check", "case.toml")
            self.assertEqual(first.codes, [0] * RANKS, first.err)
            (kept,) = (folder / "bodies" / "meshes").iterdir()
            mesh = kept / "tiny.msh"
            made = mesh.stat().st_mtime_ns
            # 30,000 cells, within 15 %.
            self.assertRegex(first.out, r"\b(2[6-9]|3[0-4]),?\d{3} cells")
            # Found again from elsewhere and at another Mach number.
            again = run(folder, "check", folder / "case.toml", "--set", "freestream.mach=2.5")
            self.assertEqual(again.codes, [0] * RANKS, again.err)
            self.assertEqual([path.name for path in (folder / "bodies" / "meshes").iterdir()], [kept.name])
            self.assertEqual(mesh.stat().st_mtime_ns, made)
            outside = run(folder, "check", "case.toml", "--set", "freestream.mach=1.5")
            self.assertEqual(outside.codes, [1] * RANKS)
            self.assertIn("missile.toml: the mesh is for Mach 1.8 to 2.5, not for freestream.mach = 1.5", outside.err)
            both = run(folder, "check", "case.toml", "--set", "mesh.from=bodies/missile.toml", "mesh.file=x.msh")
            self.assertEqual(both.codes, [1] * RANKS)
            self.assertIn("mesh.from and mesh.file are both given", both.err)
            # What the mesh comes from is read again.
            (folder / "bodies" / "missile.toml").write_text(MISSILE.replace("length = 4", "length = -4"))
            wrong = run(folder, "check", "case.toml")
            self.assertEqual(wrong.codes, [1] * RANKS)
            self.assertIn("missile.toml:8: length = -4", wrong.err)

    def test_mistakes_are_those_of_the_description(self) -> None:
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "missile.toml").write_text(MISSILE.replace("length = 4", "length = -4"))
            done = run(folder, "check", "missile.toml")
            self.assertEqual(done.codes, [1] * RANKS)
            self.assertIn("missile.toml:8: length = -4", done.err)
            self.assertEqual(list((folder / "meshes").glob("*")), [])


if __name__ == "__main__":
    unittest.main()
