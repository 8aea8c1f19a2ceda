#!/usr/bin/python3
"""The sweep file: what it expands to, and what is refused."""

from __future__ import annotations

import unittest

from workspace import HEAD, SCRIPTS, Workspace

from sweep.meshes import mesh_settings
from sweep.plan import SweepError, read_sweep
from sweep.runner import Runner


class Plan(Workspace):
    def names(self) -> list[str]:
        return [run.name for run in read_sweep(self.file).runs]

    def refused(self, blocks: str, *words: str, head: str = HEAD) -> None:
        self.write(blocks, head)
        with self.assertRaises(SweepError) as caught:
            read_sweep(self.file)
        for word in (str(self.file), *words):
            self.assertIn(word, str(caught.exception))

    def test_lists_multiply(self) -> None:
        self.write('[[runs]]\nmach = [1.5, 2]\nmethod = ["derivatives", "plunge"]\nmesh = ["coarse", "fine"]\nalpha = [0, 1.5]\n')
        names = self.names()
        self.assertEqual(len(names), 16)
        self.assertEqual(names[:2], ["derivatives_coarse_m1.5_a0", "derivatives_coarse_m2_a0"])
        self.assertEqual(names[-1], "plunge_fine_m2_a1.5")

    def test_command_line(self) -> None:
        self.write('[[runs]]\nmethod = "plunge"\nmach = 2.5\nmesh = "coarse"\nranks = 3\nset."unsteady.cycles" = 2.5\n'
                   'set.space.order = 1\nset.components = {tail = ["a", "b"]}\nset.control_sets = {}\n')
        run = read_sweep(self.file).runs[0]
        command = " ".join(Runner(self.folder / "alphadot").command(run, run.case))
        self.assertIn(f"-n 3 {self.folder}/alphadot run {self.folder}/good.toml --out {self.folder}/runs/{run.name}", command)
        for setting in ("freestream.mach=2.5", "freestream.alpha=1.5", "motion.kind=plunge", "unsteady.cycles=2.5", "space.order=1",
                        'components.tail=["a", "b"]', "control_sets={"):  # fmt: skip
            self.assertIn(f"--set {setting}", command)
        self.assertEqual(mesh_settings(run), {"mesh.file": f"{self.folder}/coarse.msh"})

    def test_level_of_a_description(self) -> None:
        self.write('[[runs]]\nmach = 2.5\nmesh = ["coarse", "other.msh"]\n')
        (self.folder / "good.toml").write_text('[mesh]\nfrom = "missile.toml"\n')
        level, file = read_sweep(self.file).runs
        self.assertEqual(mesh_settings(level), {"mesh.level": "coarse"})
        self.assertEqual(mesh_settings(file), {"mesh.file": f"{self.folder.resolve()}/other.msh"})

    def test_case_without_mesh_level_keeps_its_own(self) -> None:
        self.write("[[runs]]\nmach = 2\n")
        self.assertEqual(mesh_settings(read_sweep(self.file).runs[0]), {})

    def test_label_tells_runs_apart(self) -> None:
        blocks = '[[runs]]\nmach = 2\n\n[[runs]]\nmach = 2\nset."space.order" = 1\n'
        self.refused(blocks, "derivatives_m2_a1.5", "label")
        self.write(blocks.replace("mach = 2\nset", 'mach = 2\nlabel = "first_order"\nset'))
        self.assertEqual(self.names(), ["derivatives_m2_a1.5", "first_order_m2_a1.5"])

    def test_mistakes_are_named(self) -> None:
        self.refused("", "[[runs]]")
        self.refused("[[runs]]\nmach = 2\nangle = 1\n", "angle", "alpha")
        self.refused("[[runs]]\nalpha = 1\n", "mach")
        self.refused('[[runs]]\nmach = "fast"\n', "mach", "fast")
        self.refused('[[runs]]\nmach = 2\nlabel = "../up"\n', "../up")
        self.refused("[[runs]]\nmach = 2\nranks = 0\n", "ranks")
        self.refused("[[runs]]\nmach = 2\n", "case", head="")
        self.refused("[[runs\n", "TOML")

    def test_comments_and_checkpoints_do_not_count(self) -> None:
        self.write("[[runs]]\nmach = 2\n")
        before = read_sweep(self.file).runs[0].identity()
        (self.folder / "good.toml").write_text('# a remark\ntitle   =  "good"\n[checkpoint]\nminutes = 1\n')
        self.assertEqual(read_sweep(self.file).runs[0].identity(), before)
        (self.folder / "good.toml").write_text('title = "other"\n')
        self.assertNotEqual(read_sweep(self.file).runs[0].identity(), before)

    def test_table_one(self) -> None:
        sweep = read_sweep(SCRIPTS.parent / "cases" / "basic_finner" / "table1.toml")
        self.assertEqual([run.mach for run in sweep.runs if run.method == "derivatives"], [1.58, 1.75, 1.89, 2.10, 2.50])
        self.assertEqual([run.mach for run in sweep.runs if run.method == "plunge"], [1.58, 2.50])
        self.assertTrue(all(run.case.exists() for run in sweep.runs))


if __name__ == "__main__":
    unittest.main()
