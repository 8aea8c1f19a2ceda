#!/usr/bin/python3
"""What stands finished in the folder of a run stays until something new stands, and no folder holds the results of two flows."""

from __future__ import annotations

import json
import re
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

from program import CASE, PROGRAM, RANKS, Outcome, box, gmsh_text, run, write_case

PLUNGE = '[motion]\nkind = "plunge"\nreduced_frequency = 0.02\n[unsteady]\nsteps_per_cycle = 16\n'
OF_DERIVATIVES = ("derivatives.csv", "derivatives.stability_axes.csv", "derivatives.st", "derivatives.jsbsim.xml")


def content(folder: Path) -> dict[str, bytes]:
    return {file.name: file.read_bytes() for file in folder.iterdir() if file.is_file()}


class RunFolder(unittest.TestCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        self.out = self.folder / "out"
        write_case(self.folder, CASE + PLUNGE)

    def call(self, verb: str, *arguments: str, code: int = 0, out: str = "out", case: str = "case.toml") -> Outcome:
        outcome = run(self.folder, verb, case, "--out", out, *arguments)
        self.assertEqual(outcome.codes, [code] * RANKS, outcome.err)
        return outcome

    def refused(self, verb: str, *arguments: str, says: tuple[str, ...], **options: str) -> None:
        """With one error, and without a change of any file."""
        folder = self.folder / options.get("out", "out")
        before = content(folder)
        outcome = self.call(verb, *arguments, code=1, **options)
        self.assertEqual(len(outcome.errors), 1, outcome.err)
        for part in says:
            self.assertIn(part, outcome.errors[0])
        self.assertNotIn("steady ", outcome.err)
        self.assertEqual(content(folder), before)

    def result(self) -> dict:
        return json.loads((self.out / "result.json").read_text())

    def test_results_of_another_flow_are_replaced_when_asked_for_and_whole(self) -> None:
        self.call("derivatives")
        faster = ("--set", "freestream.mach=3")
        says = ("its freestream.mach is 2.0, not 3.0", "derivatives.csv", "--overwrite")
        self.refused("run", *faster, says=says)
        self.refused("derivatives", *faster, says=says[:1])
        self.refused("run", says=("derivatives.csv, derivatives.stability_axes.csv", "no file of this run"))
        self.call("run", *faster, "--overwrite")
        self.assertEqual(self.result()["freestream"]["mach"], 3.0)
        self.assertEqual([name for name in OF_DERIVATIVES if (self.out / name).exists()], [])
        self.refused("run", "--set", "motion.amplitude=2", *faster, says=("its motion.amplitude is 1.0, not 2.0",))
        self.call("run", "--set", "motion.kind=none", *faster, "--overwrite", "--set", "output.flow=false")
        names = {file.name for file in self.out.iterdir() if not file.name.startswith("checkpoint")}
        self.assertEqual(names, {"result.json", "resolved_case.toml", "steady.csv", "surface.vtkhdf", "symmetry.vtkhdf"})

    def test_another_mesh_under_the_same_name(self) -> None:
        self.call("derivatives")
        (self.folder / "box.msh").write_text(gmsh_text(*box(3)))
        self.refused("derivatives", says=("it is of another mesh",))

    def test_the_same_flow_again(self) -> None:
        self.call("run")
        self.call("run", "--set", "steady.orders=9", "--set", "unsteady.cycles=2")
        self.assertIn("orders = 9", self.result()["case"])

    def test_overwriting_leaves_checkpoints_alone_until_it_stands(self) -> None:
        self.call("run")
        kept = sorted(self.out.glob("checkpoint_*"))
        faster = ("--set", "freestream.mach=3", "--overwrite")
        before = {name: data for name, data in content(self.out).items() if name != "steady.csv"}  # it grows live
        self.call("run", *faster, "--set", "checkpoint.wall_limit_minutes=1e-9", code=3)
        after = content(self.out)
        self.assertEqual({name: after.get(name) for name in before}, before)
        self.call("run", *faster)
        self.assertEqual([file.name for file in kept if file.exists()], [])

    def test_a_run_without_a_result_leaves_the_finished_one(self) -> None:
        for verb in ("run", "derivatives"):
            self.call(verb, "--overwrite")
            finished = {name: data for name, data in content(self.out).items() if name in ("result.json", "history.h5", "derivatives.csv")}
            stopped = ("--set", "checkpoint.wall_limit_minutes=1e-9")
            longer = ("--restart", "--set", "unsteady.cycles=1000", *stopped)
            typo = ("--set", 'derivatives.coarser_meshes=["typo.msh"]')
            for arguments, code in ((stopped, 3), *([(longer, 3)] if verb == "run" else [(typo, 1)])):
                with self.subTest(verb=verb, arguments=arguments):
                    outcome = self.call(verb, *arguments, code=code)
                    if code == 3:
                        self.assertIn("the finished result of before is left in", outcome.err)
                    self.assertEqual({name: content(self.out)[name] for name in finished}, finished)

    def test_files_of_no_result(self) -> None:
        self.out.mkdir()
        (self.out / "derivatives.csv").write_text("mine\n")
        self.refused("run", says=("derivatives.csv: of no result that is there",))
        self.refused("derivatives", says=("derivatives.csv: of no result that is there",))

    def test_inputs_stay(self) -> None:
        before = content(self.folder)
        self.call("run", out=".")
        after = content(self.folder)
        self.assertEqual({name: after[name] for name in before}, before)
        self.assertIn("mach = 2.0", after["resolved_case.toml"].decode())
        outcome = self.call("run", out=".", case="resolved_case.toml", code=1)
        self.assertIn("resolved_case.toml: the run would replace this file, which it reads", outcome.err)
        self.assertEqual((self.folder / "resolved_case.toml").read_bytes(), after["resolved_case.toml"])

    def test_one_run_at_a_time(self) -> None:
        command = [PROGRAM, "run", "case.toml", "--out", "out", "--set", "unsteady.cycles=10000"]
        first = subprocess.Popen(command, cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(lambda: (first.kill(), first.wait()))
        end = time.monotonic() + 60
        while not (self.out / "result.json").exists():
            self.assertLess(time.monotonic(), end)
            time.sleep(0.02)
        outcome = self.call("run", code=1)
        self.assertIn("another run works in this folder", outcome.err)
        first.send_signal(signal.SIGKILL)
        first.wait()
        self.call("run", "--restart")
        self.assertEqual(list(self.out.glob(".alphadot*")), [])

    def test_every_file_says_what_it_is_of(self) -> None:
        origin = rf"Mach 2, alpha 1 deg, beta 0 deg, gamma 1.4; mesh box.msh, hash {'[0-9a-f]' * 16}; alphadot \d+\.\d+\.\d+"
        files = {
            "run": ("history.csv", "steady.csv", "flow.vtkhdf", "surface.vtkhdf", "symmetry.vtkhdf", "resolved_case.toml"),
            "derivatives": (*OF_DERIVATIVES, "steady.csv", "flow.vtkhdf"),
            "adjoint": ("adjoint.csv", "adjoint.vtkhdf", "surface_sensitivity.csv", "surface_sensitivity.vtkhdf", "steady.csv"),
        }
        for verb, names in files.items():
            outcome = self.call(verb, out=verb)
            self.assertRegex(outcome.out, f"(?m)^Flow: {origin}$")
            for name in names:
                with self.subTest(verb=verb, name=name):
                    self.assertRegex((self.folder / verb / name).read_bytes(), origin.encode())
            result = json.loads((self.folder / verb / "result.json").read_text())
            self.assertEqual((result["verb"], result["freestream"]["mach"], result["mesh"]["file"][-7:]), (verb, 2.0, "box.msh"))
        told = run(self.folder, "derive", "run/history.h5", ranks=1)
        self.assertRegex(told.out, f"(?m)^Flow: {origin}$")

    def test_one_neutral_point(self) -> None:
        self.call("derivatives")
        point = self.result()["longitudinal"]["neutral_point_x"]
        row = re.search(r"(?m)^neutral_point_x,([^,]+),", (self.out / "derivatives.csv").read_text())[1]
        self.assertEqual(float(row), point)
        avl = re.search(r"Xnp = *(\S+)", (self.out / "derivatives.st").read_text())[1]
        self.assertEqual(avl, f"{point:.6f}")
        xml = re.search(r"Neutral point at x = (\S+)\.\n", (self.out / "derivatives.jsbsim.xml").read_text())[1]
        self.assertEqual(xml, f"{point:.6g}")


if __name__ == "__main__":
    unittest.main()
