#!/usr/bin/python3
"""A disk that is full at any write, and a folder that goes away: the run says so, keeps what was whole, and ends or goes on."""

from __future__ import annotations

import os
import resource
import shutil
import subprocess
import unittest

from runs import CaseInFolder, LiveRun, checkpoints, differences, result, run, settings

SHORT = settings(motion_kind="step_alpha", unsteady_duration=4, unsteady_steps=12, checkpoint_steps=1)

LIVE = ("steady.csv", "progress.json")  # for who watches: a run does without
OF_VERB = {"run": ("history.h5", "history.csv"), "derivatives": ("derivatives.csv", "derivatives.st", "derivatives.jsbsim.xml")}


def largest_file(size: int) -> dict[str, object]:
    """Options of subprocess.run: no file of the run may grow above `size` bytes."""
    return {"preexec_fn": lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))}


class Disk(CaseInFolder):
    def full_run(self) -> None:
        done = run(self.folder, self.full, *SHORT)
        self.assertEqual(done.returncode, 0, done.stderr)

    def assert_says_why(self, done: subprocess.CompletedProcess[str]) -> None:
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertEqual(done.stderr.count("alphadot: error"), 1, done.stderr)
        self.assertNotIn("internal error", done.stderr)
        self.assertRegex(done.stderr, "File too large|No space left|check free space")

    def assert_kept_what_was_announced(self, done: subprocess.CompletedProcess[str]) -> None:
        """The last announced checkpoint is whole, no part of a file is left, and the run can go on."""
        self.assertEqual(list(self.part.glob("*.part")), [])
        announced = [line.split()[1] for line in done.stderr.splitlines() if line.startswith("checkpoint ")]
        self.assertEqual([file.name for file in checkpoints(self.part)], announced[-2:])
        again = run(self.folder, self.part, "--restart", *SHORT)
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertNotIn("not taken", again.stderr)
        self.assertEqual(differences(self.full, self.part), [])

    def test_files_that_may_not_grow(self) -> None:
        self.full_run()
        sizes = sorted({file.stat().st_size for file in self.full.iterdir()})
        # Each file in turn is the first that does not fit; in a checkpoint, at several places in it.
        for limit in {0, 500, *(size - 1 for size in sizes), *(sizes[-1] * part // 5 for part in range(1, 5))}:
            with self.subTest(limit=limit):
                shutil.rmtree(self.part, ignore_errors=True)
                done = run(self.folder, self.part, *SHORT, **largest_file(limit))
                self.assert_says_why(done)
                self.assert_kept_what_was_announced(done)

    def test_each_file_alone_on_a_full_disk(self) -> None:
        """Whichever file it is that does not fit, the error names it, and the run can go on."""
        for verb in ("run", "derivatives"):
            full, part = self.folder / f"full_{verb}", self.folder / f"part_{verb}"
            self.assertEqual(run(self.folder, full, *SHORT, verb=verb).returncode, 0)
            names = {file.name for file in full.iterdir() if file.name not in LIVE}
            self.assertLessEqual({"resolved_case.toml", "result.json", "flow.vtkhdf", "surface.vtkhdf", *OF_VERB[verb]}, names)
            for name in sorted(names):
                with self.subTest(verb=verb, name=name):
                    shutil.rmtree(part, ignore_errors=True)
                    part.mkdir()
                    (part / f"{name}.part").symlink_to("/dev/full")
                    done = run(self.folder, part, *SHORT, verb=verb)
                    self.assertEqual(done.returncode, 1, done.stderr)
                    self.assertEqual(done.stderr.count("alphadot: error"), 1, done.stderr)
                    self.assertRegex(done.stderr, rf"alphadot: error: .*{name}.*: No space left on device")
                    self.assertEqual(list(part.glob("*.part")), [])
                    again = run(self.folder, part, "--restart", *SHORT, verb=verb)
                    self.assertEqual(again.returncode, 0, again.stderr)
                    self.assertNotIn("not taken", again.stderr)
                    self.assertEqual([file for file in OF_VERB[verb] if (full / file).read_bytes() != (part / file).read_bytes()], [])

    def test_live_tables_are_no_reason_to_end(self) -> None:
        self.part.mkdir()
        for name in LIVE:
            (self.part / name).symlink_to("/dev/full")
        done = run(self.folder, self.part, *SHORT)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(result(self.part)["status"], "completed")

    @unittest.skipUnless(os.geteuid() == 0, "only root can mount a small disk")
    def test_small_disk(self) -> None:
        self.full_run()
        needed = sum(file.stat().st_size for file in self.full.iterdir())
        for part in (0.02, 0.3, 0.6, 0.9):
            with self.subTest(part=part):
                self.part.mkdir()
                size = f"size={max(4096, int(part * needed))}"
                if subprocess.run(["mount", "-t", "tmpfs", "-o", size, "tmpfs", self.part], capture_output=True).returncode:
                    self.skipTest("no small disk can be mounted here")
                try:
                    done = run(self.folder, self.part, *SHORT)
                    self.assert_says_why(done)
                    subprocess.run(["mount", "-o", "remount,size=100M", self.part], check=True)
                    self.assert_kept_what_was_announced(done)
                finally:
                    subprocess.run(["umount", "--lazy", self.part], check=True)
                    self.part.rmdir()

    def test_a_case_may_go_on_without_checkpoints(self) -> None:
        self.full_run()
        largest = max(file.stat().st_size for file in checkpoints(self.full))
        go_on = settings(checkpoint_on_failure="continue")
        done = run(self.folder, self.part, *SHORT, *go_on, **largest_file(largest - 1))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("no checkpoint could be written, the run goes on", done.stderr)
        self.assertEqual(result(self.part)["status"], "completed")
        self.assertEqual((self.full / "history.csv").read_bytes(), (self.part / "history.csv").read_bytes())

    def test_a_folder_that_vanishes(self) -> None:
        live = LiveRun(self.folder, self.part, *settings(unsteady_cycles=10000, checkpoint_steps=20))
        live.wait_for("checkpoint checkpoint_000002")
        self.part.rename(self.folder / "elsewhere")
        self.assertEqual(live.wait(), 1, live.text())
        self.assertIn("No such file or directory", live.text())
        self.assertGreaterEqual(len(checkpoints(self.folder / "elsewhere")), 2)


if __name__ == "__main__":
    unittest.main()
