#!/usr/bin/python3
"""Runs that are told to stop, killed or hung: what they leave goes on to the same end, and says what happened."""

from __future__ import annotations

import os
import signal
import shutil
import subprocess
import time
import unittest
from pathlib import Path

from runs import SECONDS, STEPS, CaseInFolder, LiveRun, checkpoints, command, differences, make_case, result, run, settings

LONG = settings(unsteady_cycles=10000)  # minutes, if nobody stops it


class Stops(CaseInFolder):
    def start(self, *arguments: object, ranks: int = 1) -> LiveRun:
        live = LiveRun(self.folder, self.part, *arguments, ranks=ranks)
        self.addCleanup(lambda: live.kill() if live.process.poll() is None else None)
        return live

    def assert_goes_on_to_the_same_end(self, ranks: int = 1, steps: int | None = None) -> None:
        """Some steps further than the run came, which is as far as its history unless `steps` tells."""
        if steps is None:
            steps = int(self.history_steps(self.part))
        arguments = settings(unsteady_cycles=max(steps + 8, STEPS) / 16)
        for out, restart in ((self.full, []), (self.part, ["--restart"])):
            done = run(self.folder, out, *arguments, *restart, ranks=ranks)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertNotIn("not taken", done.stderr)
        self.assertEqual(differences(self.full, self.part), [])

    @staticmethod
    def history_steps(out: Path) -> int:
        lines = (out / "history.csv").read_text().splitlines()
        return len([line for line in lines if not line.startswith("#")]) - 1

    def stopped_by(self, number: int, ranks: int) -> None:
        live = self.start(*LONG, ranks=ranks)
        live.wait_for("step +1/")
        os.kill(live.process.pid, number)
        self.assertEqual(live.wait(), 3, live.text())
        self.assertEqual(result(self.part)["status"], "interrupted")
        self.assertIn("signal", result(self.part)["message"])
        self.assert_goes_on_to_the_same_end(ranks)

    def test_sigusr2(self) -> None:
        self.stopped_by(signal.SIGUSR2, 1)

    def test_sigusr2_through_mpirun(self) -> None:
        self.stopped_by(signal.SIGUSR2, 2)

    def test_sigterm(self) -> None:
        self.stopped_by(signal.SIGTERM, 1)

    def test_sighup(self) -> None:
        self.stopped_by(signal.SIGHUP, 1)

    def test_nohup(self) -> None:
        """A run that was started to outlive its terminal does."""
        before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
        try:
            live = self.start(*LONG)
        finally:
            signal.signal(signal.SIGHUP, before)
        live.wait_for("step +1/")
        os.kill(live.process.pid, signal.SIGHUP)
        with self.assertRaises(subprocess.TimeoutExpired):
            live.process.wait(2)
        live.kill()

    def test_output_that_nobody_reads(self) -> None:
        """As behind `| head`: the run goes on to its end, with its exit code."""
        for arguments, code in (((), 0), (settings(checkpoint_wall_limit_minutes=1e-9), 3)):
            with self.subTest(code=code):
                shutil.rmtree(self.part, ignore_errors=True)
                reading, writing = os.pipe()
                os.close(reading)
                done = subprocess.run(command(self.part, *arguments), cwd=self.folder, stdout=writing, stderr=writing, timeout=SECONDS)
                os.close(writing)
                self.assertEqual(done.returncode, code)
                self.assertEqual(result(self.part)["status"], "completed" if code == 0 else "interrupted")
                self.assertGreaterEqual(len(checkpoints(self.part)), 1)

    def test_before_there_is_anything_to_save(self) -> None:
        """While the mesh is read: at once, with the exit code of interrupted runs, and the folder as it was."""
        os.mkfifo(self.folder / "slow.msh")  # which nobody writes to
        for number in (signal.SIGTERM, signal.SIGINT, signal.SIGUSR2, signal.SIGHUP):
            with self.subTest(number=number):
                live = self.start(*settings(mesh_file="slow.msh"))
                while not (self.part / ".alphadot_lock").exists():
                    self.assertIsNone(live.process.poll())
                    time.sleep(0.01)
                os.kill(live.process.pid, number)
                self.assertEqual(live.process.wait(5), 3)
                self.assertIn("stopped by a signal before anything was computed", live.text())
                self.assertEqual([file.name for file in self.part.iterdir()], [".alphadot_lock"])
                (self.part / ".alphadot_lock").unlink()

    def test_sigint(self) -> None:
        self.stopped_by(signal.SIGINT, 1)

    def test_mpirun_leaves_a_second(self) -> None:
        """It then kills all ranks: in a step, in the writing of a checkpoint, or after the end. Nothing whole is lost."""
        for number, delay in ((signal.SIGTERM, 0.0), (signal.SIGINT, 0.013), (signal.SIGTERM, 0.029)):
            with self.subTest(number=number, delay=delay):
                for out in (self.full, self.part):
                    shutil.rmtree(out, ignore_errors=True)
                live = self.start(*LONG, *settings(checkpoint_steps=1), ranks=2)
                live.wait_for("checkpoint checkpoint_000003")
                time.sleep(delay)
                os.kill(live.process.pid, number)
                self.assertNotEqual(live.wait(), 0)
                self.assertEqual(result(self.part)["status"], "interrupted")
                newest = int(checkpoints(self.part)[-1].stem.split("_")[1])
                self.assertGreaterEqual(newest, live.announced())
                self.assert_goes_on_to_the_same_end(ranks=2, steps=newest - 1)  # the first one is the steady state

    def test_mpirun_leaves_a_second_in_the_steady_march(self) -> None:
        make_case(self.folder, cells=6)
        slow = settings(steady_cfl_start=0.002, steady_cfl_max=0.002, steady_krylov_directions=0, steady_max_iterations=1000000)  # minutes
        live = self.start(*slow, ranks=2)
        live.wait_for("steady +1 ")
        os.kill(live.process.pid, signal.SIGTERM)
        self.assertNotEqual(live.wait(), 0)
        self.assertEqual(result(self.part)["status"], "interrupted")
        done = run(self.folder, self.part, *settings(steady_max_iterations=1000000), "--restart", ranks=2)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(result(self.part)["status"], "completed")

    def test_sigusr1_makes_a_checkpoint_and_goes_on(self) -> None:
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                live = self.start(*LONG, ranks=ranks)
                live.wait_for("step +1/")
                before = live.announced()
                os.kill(live.rank_pids()[-1], signal.SIGUSR1)  # one rank is enough
                live.wait_for(rf"checkpoint checkpoint_{before + 1:06}")
                self.assertIsNone(live.process.poll())
                live.kill()
                self.assertEqual(result(self.part)["status"], "interrupted")

    def test_wall_limit(self) -> None:
        done = run(self.folder, self.part, *LONG, *settings(checkpoint_wall_limit_minutes=0.1))
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertIn("wall time limit", result(self.part)["message"])
        self.assertLess(result(self.part)["performance"]["wall_s"], 6)

    def test_checkpoints_by_the_clock(self) -> None:
        live = self.start(*LONG, *settings(checkpoint_minutes=0.003))
        live.wait_for("checkpoint checkpoint_000004")
        self.assertLessEqual(len(checkpoints(self.part)), 3)  # two are kept; one may be new
        live.kill()

    def test_a_killed_rank_ends_the_run(self) -> None:
        live = self.start(*LONG, ranks=2)
        live.wait_for("step +1/")
        os.kill(live.rank_pids()[1], signal.SIGKILL)
        self.assertNotEqual(live.wait(), 0)
        self.assertEqual(result(self.part)["status"], "interrupted")

    def test_a_hung_rank_ends_the_run(self) -> None:
        live = self.start(*LONG, *settings(checkpoint_watchdog_minutes=0.03), ranks=2)
        live.wait_for("step +1/")
        os.kill(live.rank_pids()[1], signal.SIGSTOP)
        self.assertNotEqual(live.wait(), 0)
        self.assertEqual(live.text().count("no iteration has ended for 0.03 minutes"), 1, live.text())
        self.assertEqual(result(self.part)["status"], "interrupted")

    def test_a_flow_that_breaks_down(self) -> None:
        # A stream straight away from a wall leaves a vacuum there.
        for stream in ({"freestream_mach": 100, "freestream_alpha": 90}, {"freestream_mach": 20, "freestream_alpha": 90, "motion_kind": "none"}):
            with self.subTest(stream=stream):
                shutil.rmtree(self.part, ignore_errors=True)
                done = run(self.folder, self.part, *settings(**stream, checkpoint_iterations=1))
                self.assertEqual(done.returncode, 4, done.stderr)
                self.assertEqual(result(self.part)["status"], "diverged")
                self.assertIn("diverged", done.stderr)


if __name__ == "__main__":
    unittest.main()
