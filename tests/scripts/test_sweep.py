#!/usr/bin/python3
"""Running a sweep: what is done is not repeated, what was interrupted goes on, what is broken stops nothing else."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import time
import unittest

from workspace import STUB, Workspace

GOOD, BAD, SLOW, SHORT = "derivatives_m2_a1.5", "bad_m3_a1.5", "plunge_m2_a1.5", "short_m3_a1.5"
MIXED = '[[runs]]\nlabel = "bad"\ncase = "bad.toml"\nmach = 3\n\n[[runs]]\nmach = 2\n'
MOTION = '[[runs]]\nmethod = "plunge"\ncase = "slow.toml"\nmach = 2\n'


class Sweeps(Workspace):
    def phase(self, name: str) -> str:
        return re.search(rf"^{re.escape(name)} +(\w+)", self.sweep("status"), re.MULTILINE)[1]

    def start_slow(self):
        """A sweep at work on a run that waits to be stopped."""
        process = self.start("run", "--no-report")
        self.wait_for((self.folder / "runs" / SLOW / "started").exists)
        return process

    def test_broken_case_among_good_ones(self) -> None:
        self.write(MIXED)
        self.assertIn("2 waiting", self.sweep("status"))
        self.sweep("run", "--no-report", code=1)
        status = self.sweep("status")
        self.assertRegex(status, rf"{BAD} +failed +bad\.toml:2: no such mesh")
        self.assertRegex(status, rf"{GOOD} +done +10 s")

    def test_done_and_failed_are_not_repeated(self) -> None:
        self.write(MIXED)
        for _ in range(3):
            self.sweep("run", "--no-report", code=1)
        self.assertEqual(self.calls(GOOD), ["start"])
        self.assertEqual(self.calls(BAD), ["start"])

    def test_retry(self) -> None:
        self.write(MIXED)
        self.sweep("run", "--no-report", code=1)
        (self.folder / "bad.toml").write_text('title = "bad" # still\n')
        self.assertIn(BAD, self.sweep("retry"))
        self.sweep("run", "--no-report", code=1)
        self.assertEqual(len(self.calls(BAD)), 2)
        self.assertEqual(len(self.calls(GOOD)), 1)

    def test_not_converged_is_an_end_of_its_own(self) -> None:
        """The run has its numbers and is not repeated by itself; retry begins it anew, not from the checkpoint of its end."""
        self.write('[[runs]]\nlabel = "short"\ncase = "short.toml"\nmach = 3\n\n[[runs]]\nmach = 2\n')
        for _ in range(2):
            self.sweep("run", "--no-report", code=5)
        status = self.sweep("status")
        self.assertRegex(status, rf"{SHORT} +not converged +10 s +the linear residual for alpha dropped 1.3 of 3 decades")
        self.assertIn("1 done, 1 not converged", status)
        self.assertEqual(self.calls(SHORT), ["start"])
        self.assertIn(SHORT, self.sweep("retry"))
        self.sweep("run", "--no-report", code=5)
        self.assertEqual(self.calls(SHORT), ["start", "start"])
        self.assertEqual(self.calls(GOOD), ["start"])

    def test_time_left_is_not_told_while_it_cannot_be_known(self) -> None:
        """The run at work has taken longer than the one that is done."""
        slow = '[[runs]]\nmethod = "plunge"\ncase = "good.toml"\nmach = 1.5\n'
        self.write(slow)
        self.sweep("run", "--no-report")
        self.write(slow + MOTION)
        process = self.start_slow()
        self.assertRegex(self.sweep("status"), r"1 running, 1 done; about \d+ s left")
        record = self.folder / "runs" / SLOW / "run.json"
        os.utime(record, (time.time() - 11, time.time() - 11))  # the other one took 10 s
        self.assertNotIn("about", self.sweep("status"))
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=20)

    def test_changed_settings_are_run_afresh(self) -> None:
        self.write("[[runs]]\nmach = 2\n")
        self.sweep("run", "--no-report")
        self.write('[[runs]]\nmach = 2\nset."space.order" = 1\n')
        self.assertIn("settings changed", self.sweep("status"))
        self.sweep("run", "--no-report")
        self.assertEqual(self.calls(GOOD), ["start", "start"])

    def test_progress_then_stopped_then_restarted(self) -> None:
        self.write(MOTION)
        process = self.start_slow()
        self.assertRegex(self.sweep("status"), rf"{SLOW} +running +step 3/10, 7 s left")
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=20)
        self.assertEqual(process.returncode, 3)
        self.assertRegex(self.sweep("status"), rf"{SLOW} +interrupted +goes on from its checkpoint")
        self.sweep("run", "--no-report")
        self.assertEqual(self.calls(SLOW), ["start", "restart"])
        self.assertEqual(self.phase(SLOW), "done")

    def test_started_twice(self) -> None:
        self.write(MOTION)
        process = self.start_slow()
        self.assertIn(f"being run by process {process.pid}", self.sweep("run", code=1))
        self.assertIn("process", self.sweep("clean", code=1))
        self.assertEqual(self.calls(SLOW), ["start"])
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=20)

    def test_killed_sweep_leaves_no_stale_lock(self) -> None:
        """The program outlives its sweep.py, keeps its folder, and the next sweep.py waits for it and goes on."""
        self.write(MOTION)
        process = self.start_slow()
        process.kill()
        process.communicate()
        self.assertEqual(self.phase(SLOW), "running")
        after = self.start("run", "--no-report")
        waits = after.stdout.readline()
        self.assertRegex(waits, r"waits for process \d+")
        self.stub_of(SLOW, signal.SIGUSR2)
        after.communicate(timeout=20)
        self.assertEqual(after.returncode, 0)
        self.assertEqual(self.calls(SLOW), ["start", "restart"])

    def test_killed_altogether_starts_again(self) -> None:
        self.write(MOTION)
        process = self.start_slow()
        process.kill()
        process.communicate()
        self.stub_of(SLOW, signal.SIGKILL)
        self.wait_for(lambda: self.phase(SLOW) == "interrupted")
        (self.folder / "runs" / SLOW / "checkpoint_000001.vtkhdf").touch()
        self.sweep("run", "--no-report")
        self.assertEqual(self.calls(SLOW), ["start", "restart"])

    def stub_of(self, name: str, number: int) -> None:
        """Sends a signal to the stub that works in the folder of a run."""
        folder = str(self.folder / "runs" / name)
        for process in filter(str.isdigit, os.listdir("/proc")):
            try:
                with open(f"/proc/{process}/cmdline") as file:
                    words = file.read().split("\0")
            except OSError:
                continue
            if folder in words:
                os.kill(int(process), number)

    def test_extend_by_mach(self) -> None:
        self.write("[[runs]]\nmach = 2\n")
        self.sweep("run", "--no-report")
        self.assertIn("1 runs more", self.sweep("extend", "--mach", 2, 3))
        self.sweep("run", "--no-report")
        self.assertEqual(self.calls(GOOD), ["start"])
        self.assertEqual(self.calls("derivatives_m3_a1.5"), ["start"])

    def test_extend_by_cycles(self) -> None:
        self.write(MOTION.replace("slow", "good"))
        self.sweep("run", "--no-report")
        (self.folder / "runs" / SLOW / "checkpoint_000001.vtkhdf").touch()
        self.assertIn("to go on to 2.5 cycles", self.sweep("extend", "--cycles", 2.5))
        self.sweep("run", "--no-report")
        self.assertEqual(self.calls(SLOW), ["start", "restart"])

    def test_clean(self) -> None:
        self.write(MIXED)
        self.sweep("run", "--no-report", code=1)
        self.sweep("clean")
        self.assertFalse((self.folder / "runs" / BAD).exists())
        self.assertEqual(self.phase(GOOD), "done")
        self.sweep("clean", "--all")
        self.assertEqual(self.phase(GOOD), "waiting")

    def test_slurm_scripts(self) -> None:
        self.write(MIXED)
        self.sweep("slurm", "--time", "00:20:00", "--margin", 90)
        array = (self.folder / "runs" / "slurm" / "array.sbatch").read_text()
        for line in ("--array=0-1", "--ntasks=2", "--time=00:20:00", "--signal=B:USR2@90", "--requeue"):
            self.assertIn(f"#SBATCH {line}\n", array)
        self.assertIn(f"runs=({BAD} {GOOD})", array)

    def test_packed_array(self) -> None:
        """Three tasks for five runs; the last has one, and each task runs its own."""
        self.write("[[runs]]\nmach = {from = 1, to = 3, step = 0.5}\n")
        self.sweep("slurm", "--each", 2)
        script = self.folder / "runs" / "slurm" / "array.sbatch"
        self.assertIn("#SBATCH --array=0-2\n", script.read_text())
        for task, wanted in ((2, [0, 0, 0, 0, 1]), (0, [1, 1, 0, 0, 1])):
            environment = os.environ | {"MPIEXEC": str(STUB), "SLURM_ARRAY_TASK_ID": str(task)}
            done = subprocess.run(["bash", script], env=environment, capture_output=True, text=True, timeout=60)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            names = [f"derivatives_m{mach:g}_a1.5" for mach in (1, 1.5, 2, 2.5, 3)]
            self.assertEqual([len(self.calls(name)) for name in names], wanted)

    def test_a_stopped_task_has_work_left(self) -> None:
        """Also where one of its runs has failed: Slurm queues it again for the code."""
        self.write('[[runs]]\nlabel = "bad"\ncase = "bad.toml"\nmach = 3\n\n' + MOTION)
        process = self.start("run", "--only", BAD, SLOW)
        self.wait_for((self.folder / "runs" / SLOW / "started").exists)
        process.send_signal(signal.SIGUSR2)
        process.communicate(timeout=20)
        self.assertEqual(process.returncode, 3)
        self.sweep("run", "--only", BAD, SLOW, code=1)
        self.assertEqual(self.phase(SLOW), "done")

    def test_what_stays_on_the_disk(self) -> None:
        """No volumes unless asked for, no checkpoints of finished linear solves, and a word on how much there will be."""
        self.write('[[runs]]\nmach = [2, 3]\n\n[[runs]]\nmethod = "plunge"\nmach = 2\n\n[[runs]]\nlabel = "v"\nmach = 2\nset."output.flow" = true\n')
        checkpoint = lambda name: self.folder / "runs" / name / "checkpoint_000001.vtkhdf"
        for name in (GOOD, SLOW):
            checkpoint(name).parent.mkdir(parents=True)
        self.sweep("run", "--no-report", "--only", GOOD)
        for name in (GOOD, SLOW):
            (self.folder / "runs" / name / "end.json").unlink(missing_ok=True)
            (self.folder / "runs" / name / "result.json").unlink(missing_ok=True)
            checkpoint(name).touch()
        self.sweep("run", "--no-report")
        self.assertEqual(self.calls(GOOD), ["start", "restart"])
        self.assertFalse(checkpoint(GOOD).exists())
        log = lambda name: (self.folder / "runs" / name / "log.txt").read_text()
        self.assertIn("--set output.flow=false", log(GOOD))
        self.assertNotIn("output.flow=false", log("v_m2_a1.5"))
        self.assertRegex(self.sweep("status"), r"disk: [\d.]+ kB a run, [\d.]+ kB for all, [\d.,]+ GB free\n")

    def test_missing_program_is_named(self) -> None:
        self.write(MIXED)
        self.assertIn("/nowhere/alphadot", self.sweep("run", "--program", "/nowhere/alphadot", code=1))


if __name__ == "__main__":
    unittest.main()
