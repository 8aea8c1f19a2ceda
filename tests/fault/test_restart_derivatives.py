#!/usr/bin/python3
"""Derivatives from linear solves go on as well: from the steady march, the steady state and after each group of solves."""

from __future__ import annotations

import os
import signal
import subprocess
import time
import unittest
from pathlib import Path

from runs import CaseInFolder, LiveRun, checkpoints, derivatives, make_case, result, run, settings

FILES = ("derivatives.csv", "components.csv", "derivatives.st", "derivatives.jsbsim.xml", "flow.vtkhdf", "surface.vtkhdf")
EVERY = settings(checkpoint_iterations=1, checkpoint_keep=100, derivatives_limiter_uncertainty="true")
SLOW = settings(derivatives_directions=2, derivatives_orders=12, derivatives_max_iterations=100000, steady_sweeps=1)


class RestartDerivatives(CaseInFolder):
    def run_ok(self, out: Path, *arguments: object, ranks: int = 1, verb: str = "derivatives") -> subprocess.CompletedProcess[str]:
        done = run(self.folder, out, *arguments, ranks=ranks, verb=verb)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done

    def assert_same(self) -> None:
        self.assertEqual([name for name in FILES if (self.full / name).read_bytes() != (self.part / name).read_bytes()], [])
        self.assertEqual(derivatives(self.full), derivatives(self.part))

    def test_from_every_checkpoint(self) -> None:
        for ranks in (1, 2):
            self.run_ok(self.full, *EVERY, ranks=ranks)
            files = checkpoints(self.full)
            self.assertGreaterEqual(len(files), 8)  # in the march, at its end, after each of three groups, twice
            taken = []
            for file in files if ranks == 1 else files[-6:]:
                done = self.run_ok(self.part, *EVERY, "--restart", file, ranks=ranks)
                found = [line.split()[0] for line in done.stderr.splitlines() if "taken from the checkpoint" in line]
                taken += map(int, found)
                self.assert_same()
            # alpha, beta, q; p, r; the rates of alpha and beta; all of them with the limiter held
            self.assertEqual(taken, [3, 5, 7, 10, 12, 14])

    def test_on_other_ranks(self) -> None:
        tight = settings(steady_orders=11, derivatives_orders=10, checkpoint_keep=10)
        self.run_ok(self.full, *tight)
        for file in checkpoints(self.full)[:2]:  # the steady state, and the first group
            self.run_ok(self.part, *tight, "--restart", file, ranks=2)
            found = derivatives(self.part)
            for name, value in derivatives(self.full).items():
                self.assertAlmostEqual(found[name], value, delta=1e-6 * max(abs(value), 1e-2), msg=name)

    def test_stopped_and_killed_in_the_linear_solves(self) -> None:
        make_case(self.folder, cells=10)
        for number, ranks, code in ((signal.SIGUSR2, 2, 3), (signal.SIGTERM, 1, 3), (signal.SIGKILL, 1, -signal.SIGKILL)):
            with self.subTest(number=number):
                live = LiveRun(self.folder, self.part, *SLOW, ranks=ranks, verb="derivatives")
                self.addCleanup(lambda live=live: live.kill() if live.process.poll() is None else None)
                live.wait_for("checkpoint checkpoint_")  # of the steady state
                time.sleep(0.1)
                os.kill(live.process.pid, number)
                self.assertEqual(live.wait(), code, live.text())
                self.assertEqual(result(self.part)["status"], "interrupted")
                self.assertEqual(result(self.part)["derivatives"], {})
                self.assertFalse((self.part / "derivatives.csv").exists())
                newest = checkpoints(self.part)[-1]
                done = self.run_ok(self.part, "--restart")
                self.assertIn(f"goes on from {newest}", done.stderr)
                for file in self.part.iterdir():
                    file.unlink()

    def test_solves_under_other_settings_are_not_taken(self) -> None:
        self.run_ok(self.part)
        done = self.run_ok(self.part, "--restart", *settings(derivatives_orders=6))
        self.assertIn("goes on from", done.stderr)
        self.assertNotIn("taken from", done.stderr)

    def test_the_uncertainty_of_the_limiter_can_be_added(self) -> None:
        self.run_ok(self.full, *settings(derivatives_limiter_uncertainty="true"))
        self.run_ok(self.part)
        done = self.run_ok(self.part, "--restart", *settings(derivatives_limiter_uncertainty="true"))
        self.assertIn("7 linear solves are taken from the checkpoint", done.stderr)
        self.assert_same()

    def test_a_motion_begins_from_them_but_gives_none(self) -> None:
        self.run_ok(self.part)
        self.run_ok(self.part, "--restart", "--overwrite", verb="run")
        self.assertEqual(result(self.part)["status"], "completed")
        done = run(self.folder, self.part, "--restart", "--overwrite", verb="derivatives")
        self.assertEqual(done.returncode, 1)
        self.assertEqual(done.stderr.count("alphadot: error: "), 1)
        self.assertIn("was made in a motion", done.stderr)


if __name__ == "__main__":
    unittest.main()
