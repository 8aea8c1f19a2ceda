#!/usr/bin/python3
"""Bad input ends the program with one clear error that names the file, and a non-zero exit code on every rank, in time."""

from __future__ import annotations

import subprocess
import tempfile
import unittest
from pathlib import Path

from program import CASE, PROGRAM, RANKS, box, gmsh_text, run, write_case


class Faults(unittest.TestCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def refused(
        self, *says: str, case: str = CASE, mesh: str | None = None, out: str = "out", arguments: tuple = (), errors: int = 1
    ) -> None:
        """The run of this case and mesh fails on every rank; the first of its `errors` contains all of `says`."""
        write_case(self.folder, case, mesh)
        outcome = run(self.folder, "run", "case.toml", "--out", out, *arguments)
        self.assertEqual(outcome.codes, [1] * RANKS, outcome.err)
        self.assertEqual(len(outcome.errors), errors, outcome.err)
        for part in says:
            self.assertIn(part, outcome.errors[0])
        self.assertNotIn("internal error", outcome.err)
        self.assertFalse((self.folder / out / "result.json").exists())

    def changed_mesh(self, old: str, new: str) -> tuple[str, int]:
        """The cube's mesh file with one text replaced, and the line of that."""
        text = gmsh_text(*box(2))
        self.assertIn(old, text)
        return text.replace(old, new, 1), text[: text.index(old)].count("\n") + 1

    def test_missing_case_file(self) -> None:
        outcome = run(self.folder, "run", "none.toml")
        self.assertEqual(outcome.codes, [1] * RANKS)
        self.assertEqual(len(outcome.errors), 1, outcome.err)
        self.assertIn("none.toml", outcome.errors[0])

    def test_missing_mesh_file(self) -> None:
        self.refused("none.msh", case=CASE.replace("box.msh", "none.msh"))

    def test_patch_without_boundary_condition(self) -> None:
        self.refused("case.toml", '"wall"', case=CASE.replace('wall = "wall"\n', ""))

    def test_boundary_condition_without_patch(self) -> None:
        self.refused("case.toml", '"fins"', case=CASE + 'fins = "wall"\n')

    def test_mesh_without_a_named_group(self) -> None:
        points, cells, patches = box(2)
        del patches["wall"]
        self.refused("box.msh", mesh=gmsh_text(points, cells, patches), case=CASE.replace('wall = "wall"\n', ""))

    def test_inverted_cell(self) -> None:
        points, cells, patches = box(2)
        a, b, c, d = cells[20]
        cells[20] = (a, c, b, d)
        write_case(self.folder, mesh=gmsh_text(points, cells, patches))
        outcome = run(self.folder, "check", "case.toml")
        self.assertEqual(outcome.codes, [0] * RANKS)
        self.assertIn("1 of 48 tetrahedra were left-handed and have been turned", outcome.out + outcome.err)

    def test_flat_cell(self) -> None:
        points, cells, patches = box(2)
        points[13] = (0.0, 0.5, 0.5)  # the middle of the cube, moved onto its side
        self.refused("box.msh", "volume", mesh=gmsh_text(points, cells, patches))

    def test_unknown_key(self) -> None:
        self.refused("case.toml:6", "machh", "did you mean freestream.mach?", case=CASE.replace("mach =", "mach = 2.0\nmachh ="))

    def test_negative_mach(self) -> None:
        self.refused("case.toml:5", "mach", case=CASE.replace("mach = 2.0", "mach = -2.0"))

    def test_negative_mach_by_override(self) -> None:
        self.refused("--set freestream.mach=-2", arguments=("--set", "freestream.mach=-2"))

    def test_nan_in_the_case(self) -> None:
        self.refused("case.toml:6", "alpha", case=CASE.replace("alpha = 1.0", "alpha = nan"))

    def test_nan_in_the_mesh(self) -> None:
        mesh, line = self.changed_mesh("\n14 0.5 0.5 0.5\n", "\n14 nan 0.5 0.5\n")
        self.refused(f"box.msh:{line + 1}", mesh=mesh)

    def test_broken_toml(self) -> None:
        self.refused("case.toml:4", case=CASE.replace("[freestream]", "[freestream"))

    def test_truncated_mesh(self) -> None:
        mesh = gmsh_text(*box(2))
        self.refused("box.msh:", mesh=mesh[: len(mesh) // 2])

    def test_empty_mesh(self) -> None:
        self.refused("box.msh", mesh="")

    def test_more_ranks_than_cells(self) -> None:
        points = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)]
        cells = [(0, 1, 2, 3)] if RANKS > 1 else []
        patches = {"wall": [(0, 1, 2)], "sides": [(0, 1, 3)], "farfield": [(0, 2, 3), (1, 2, 3)]}
        self.refused("box.msh", mesh=gmsh_text(points, cells, patches))

    def test_folder_below_a_file(self) -> None:
        (self.folder / "file").touch()
        self.refused("file/out", out="file/out")

    def test_folder_that_cannot_be_made(self) -> None:
        self.refused("/proc/out", out="/proc/out")

    def test_wrong_mesh_format(self) -> None:
        self.refused("box.msh", "$MeshFormat", mesh="a cube of cells\n")
        self.refused("box.msh", "STL, a surface without a volume", mesh="solid cube\n facet normal 0 0 1\n")

    def test_mesh_with_an_unknown_suffix(self) -> None:
        (self.folder / "box.stl").write_text("solid cube\n")
        self.refused("box.stl", case=CASE.replace("box.msh", "box.stl"))

    def test_every_problem_of_a_case_at_once(self) -> None:
        case = CASE.replace("mach = 2.0", "mach = -2.0").replace('farfield = "farfield"', 'farfield = "wal"')
        write_case(self.folder, case)
        outcome = run(self.folder, "check", "case.toml")
        self.assertEqual(outcome.codes, [1] * RANKS)
        self.assertEqual(len(outcome.errors), 2, outcome.err)
        self.assertIn("case.toml:5", outcome.errors[0])
        self.assertIn("case.toml:11", outcome.errors[1])

    def test_every_problem_of_case_and_files_at_once(self) -> None:
        """Keys, patches of the mesh, the table of the motion and coarser meshes, which need no sound case to be looked at."""
        case = CASE.replace("alpha = 1.0", "alpha = 1000.0").replace('wall = "wall"\n', 'fins = "wall"\n')
        case += '[motion]\nkind = "table"\ntable_file = "motion.txt"\n[unsteady]\nduration = 9\nsteps = 0\n'
        case += '[derivatives]\ncoarser_meshes = ["none.msh", "other.msh"]\n'
        (self.folder / "motion.txt").write_text("t_star alpha\n0 1\n1 2\n")
        (self.folder / "other.msh").write_text(gmsh_text(*box(1)))
        write_case(self.folder, case)
        outcome = run(self.folder, "check", "case.toml")
        self.assertEqual(outcome.codes, [1] * RANKS)
        for words in (
            "case.toml:6: freestream.alpha must be a number from -180 to 180",
            "needs unsteady.steps >= 1",
            'case.toml: patch "wall" of the mesh has no boundary condition',
            'case.toml:9: [boundary] names "fins", which the mesh does not have',
            "motion.txt: the table ends at t_star = 1, before unsteady.duration",
            "derivatives.coarser_meshes, none.msh: no such mesh",
            'derivatives.coarser_meshes, other.msh: patch "wall" of the mesh has no boundary condition',
        ):
            self.assertEqual(outcome.err.count(words), 1, words + "\n" + outcome.err)

    def test_check_looks_at_coarser_meshes(self) -> None:
        write_case(self.folder, CASE + '[derivatives]\ncoarser_meshes = ["none.msh", "box.msh"]\n')
        outcome = run(self.folder, "check", "case.toml")
        self.assertEqual(outcome.codes, [1] * RANKS)
        self.assertIn("derivatives.coarser_meshes, none.msh: no such mesh", outcome.err)
        self.assertIn("derivatives.coarser_meshes, box.msh: 48 cells are not coarser than the 48", outcome.err)

    def test_inputs_that_are_no_files_of_their_kind(self) -> None:
        write_case(self.folder)
        (self.folder / "large.toml").write_text("#" * 10_000_000)
        (self.folder / "large.txt").write_text("#" * 17_000_000)
        for case, says in ((".", "not a regular file"), ("/dev/zero", "not a regular file"), ("large.toml", "too large")):
            outcome = run(self.folder, "check", case)
            self.assertEqual((outcome.codes, len(outcome.errors)), ([1] * RANKS, 1), outcome.err)
            self.assertIn(says, outcome.err)
        for table, says in ((".", "not a regular file"), ("/dev/zero", "not a regular file"), ("large.txt", "too large"), ("x", "no such")):
            words = ("motion.kind=table", f"motion.table_file={table}", "unsteady.duration=1", "unsteady.steps=4")
            outcome = run(self.folder, "check", "case.toml", *(part for word in words for part in ("--set", word)))
            self.assertEqual((outcome.codes, len(outcome.errors)), ([1] * RANKS, 1), outcome.err)
            self.assertIn(says, outcome.err)

    def test_names_of_walls_that_the_history_has(self) -> None:
        for name in ("total", "error", "step", "t_star"):
            with self.subTest(name=name):
                mesh = gmsh_text(*box(2)).replace('"wall"', f'"{name}"')
                self.refused(f'a wall cannot be called "{name}"', mesh=mesh, case=CASE.replace("wall =", f"{name} ="))

    def test_numbers_of_the_command_line(self) -> None:
        for arguments in (("watch", ".", "--interval", "nan"), ("watch", ".", "--interval", "inf")):
            with self.subTest(arguments=arguments):
                outcome = run(self.folder, *arguments)
                self.assertEqual(outcome.codes, [2] * RANKS)
                self.assertIn("no number from", outcome.out + outcome.err)

    @unittest.skipIf(RANKS > 1, "the launcher would feel the limit too")
    def test_memory_that_does_not_suffice(self) -> None:
        """Some of these limits are met while the mesh is read, some in the march."""
        write_case(self.folder, CASE, gmsh_text(*box(24)))
        for megabytes in (150, 175, 200):
            with self.subTest(megabytes=megabytes):
                limit = f"ulimit -v {megabytes << 10}; exec {PROGRAM} run case.toml --overwrite"
                done = subprocess.run(["/bin/sh", "-c", limit], cwd=self.folder, capture_output=True, text=True, timeout=60)
                self.assertEqual(done.returncode, 1, done.stderr)
                self.assertEqual(done.stderr.count("error"), 1, done.stderr)
                self.assertIn("the memory does not suffice", done.stderr)
                self.assertIn("use more ranks", done.stderr)

    def test_wrong_command_line(self) -> None:
        for arguments in ((), ("fly",), ("run",), ("run", "case.toml", "--fast")):
            with self.subTest(arguments=arguments):
                self.assertEqual(run(self.folder, *arguments).codes, [2] * RANKS)

    def test_files_of_another_kind(self) -> None:
        (self.folder / "history.h5").write_text("not HDF5")
        (self.folder / "result.json").write_text("{}")
        for arguments in (("derive", "history.h5"), ("derive", "none.h5"), ("info", "result.json"), ("info", "none.msh")):
            with self.subTest(arguments=arguments):
                outcome = run(self.folder, *arguments)
                self.assertEqual(outcome.codes, [1] * RANKS, outcome.err)
                self.assertEqual(len(outcome.errors), 1, outcome.err)
                self.assertIn(arguments[1], outcome.errors[0])


if __name__ == "__main__":
    unittest.main()
