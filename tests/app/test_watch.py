#!/usr/bin/python3
"""The verb watch, and the files it reads: on a run at work, on what a killed one leaves, on an ended one, and on a sweep."""

from __future__ import annotations

import csv
import json
import os
import re
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

from program import CASE, PROGRAM, box, gmsh_text, run, write_case

STEPS_PER_CYCLE = 64
STEPS = 96  # of the default one and a half cycles
PLUNGE = f"""
[motion]
kind = "plunge"
reduced_frequency = 0.02

[unsteady]
steps_per_cycle = {STEPS_PER_CYCLE}
"""
LONG = ("--set", "unsteady.cycles=1000")  # a run that does not end by itself


class Watch(unittest.TestCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        write_case(self.folder, CASE + PLUNGE, gmsh_text(*box(3)))

    def start(self, *arguments: str) -> subprocess.Popen:
        """A run in the background, in the folder "live"."""
        command = [PROGRAM, "run", "case.toml", *([] if "--out" in arguments else ["--out", "live"]), *arguments]
        process = subprocess.Popen(command, cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(lambda: (process.kill(), process.wait()))
        return process

    def rows(self, name: str, folder: str = "live") -> list[dict[str, str]]:
        try:
            text = (self.folder / folder / name).read_text()
        except OSError:
            return []
        lines = text[: text.rfind("\n") + 1].splitlines()
        return list(csv.DictReader(line for line in lines if not line.startswith("#")))

    def wait_for_steps(self, steps: int) -> None:
        end = time.monotonic() + 60
        while len(self.rows("history.csv")) < steps:
            self.assertLess(time.monotonic(), end, "the history does not grow")
            time.sleep(0.05)

    def watch(self, *arguments: str, code: int = 0) -> str:
        outcome = run(self.folder, "watch", *arguments, ranks=1)
        self.assertEqual(outcome.codes, [code], outcome.err)
        return outcome.out + outcome.err

    def test_run_at_work_then_killed(self) -> None:
        process = self.start(*LONG)
        # 2 s after that at the latest, the progress holds derivatives: those of six tenths of a cycle.
        self.wait_for_steps(int(0.6 * STEPS_PER_CYCLE) + 2)
        time.sleep(2.5)
        page = self.watch("live", "--once")
        self.assertRegex(page, r"state +running\n")
        step = int(re.search(r"phase +step (\d+)/64000, alpha", page)[1])
        self.assertGreater(step, 0.6 * STEPS_PER_CYCLE)
        self.assertRegex(page, r"left +\d+")
        self.assertRegex(page, r"residual +\S+  1e-\d+\.\d after \d+ iterations")
        self.assertRegex(page, r"so far +Cm_alpha -\d")
        steady = self.rows("steady.csv")
        self.assertEqual([int(row["iteration"]) for row in steady], list(range(1, len(steady) + 1)))
        process.kill()
        process.wait()
        progress = self.folder / "live" / "progress.json"
        os.utime(progress, (time.time() - 100, time.time() - 100))
        self.assertRegex(self.watch("live", "--once"), r"state +running, silent for 1 min")

    def test_follows_to_the_end(self) -> None:
        """Without --once it ends with the run, and what it shows is what the result holds."""
        self.start()
        self.wait_for_steps(1)
        page = self.watch("live", "--interval", "0.2")
        last = page[page.rindex("live") :]
        self.assertRegex(last, r"state +completed\n")
        derivatives = json.loads((self.folder / "live" / "result.json").read_text())["derivatives"]
        shown = re.search(r"Cm_alphadot (\S+) \+-", last)[1]
        self.assertEqual(shown, f"{derivatives['Cm_alphadot']['value']:+.4g}")
        self.assertIn("(+-: solver only; mesh not assessed)", last)
        self.assertFalse((self.folder / "live" / "progress.json").exists())

    def test_estimate_on_the_way_tends_to_the_result(self) -> None:
        """On one cycle it rests on half of it; the loads are harmonic but for 1 % (see test_commands.py)."""
        process = self.start(*LONG)
        self.wait_for_steps(STEPS_PER_CYCLE)
        time.sleep(2.5)
        so_far = json.loads((self.folder / "live" / "progress.json").read_text())["derivatives"]
        process.kill()
        process.wait()
        outcome = run(self.folder, "run", "case.toml", "--out", "whole", "--quiet", ranks=1)
        self.assertEqual(outcome.codes, [0], outcome.err)
        result = json.loads((self.folder / "whole" / "result.json").read_text())["derivatives"]
        for name in ("CN_alpha", "Cm_alpha", "CN_alphadot", "Cm_alphadot"):
            value = result[name]["value"]
            self.assertAlmostEqual(so_far[name], value, delta=0.05 * abs(value), msg=name)

    def test_history_goes_on_where_a_restart_does(self) -> None:
        outcome = run(self.folder, "run", "case.toml", "--out", "live", ranks=1)
        self.assertEqual(outcome.codes, [0], outcome.err)
        before = self.rows("history.csv"), self.rows("steady.csv")
        self.start("--restart", *LONG)
        self.wait_for_steps(STEPS + 3)
        self.assertEqual(self.rows("history.csv")[:STEPS], before[0])
        self.assertEqual(self.rows("steady.csv"), before[1])

    def test_sweep_folder(self) -> None:
        self.start(*LONG, "--out", "sweep/b_live")
        outcome = run(self.folder, "derivatives", "case.toml", "--out", "sweep/a_linear", "--quiet", ranks=1)
        self.assertEqual(outcome.codes, [0], outcome.err)
        end = time.monotonic() + 60
        while not self.rows("history.csv", "sweep/b_live"):
            self.assertLess(time.monotonic(), end)
            time.sleep(0.05)
        page = self.watch("sweep", "--once")
        self.assertRegex(page, r"a_linear +converged\n +CA .* Cm_alphadot .*\(\+-: solver only; mesh not assessed\)\n")
        self.assertRegex(page, r"b_live +running, ")
        self.assertIn("2 runs, 1 at work", page)

    def test_many_runs_are_counted(self) -> None:
        """Those that came to a good end are a number; the others are named, by the head of a result that may be long."""
        for number in range(100):
            folder = self.folder / "many" / f"run_{number:02}"
            folder.mkdir(parents=True)
            status, message = ("not_converged", 'dropped "1.3" of 3') if number == 7 else ("converged", "")
            text = json.dumps({"status": status, "message": message, "case": "x" * 10_000})
            (folder / "result.json").write_text(text[:50] if number == 8 else text)
        page = self.watch("many", "--once")
        self.assertRegex(page, r'\n  run_07  not_converged: dropped "1.3" of 3\n')
        self.assertNotIn("run_01", page)
        self.assertIn("100 runs: 99 converged 1 not_converged\n", page)

    def test_nothing_to_watch(self) -> None:
        self.assertIn("no such folder", self.watch("nowhere", "--once", code=1))
        self.assertIn("there is no run", self.watch(".", "--once", code=1))


if __name__ == "__main__":
    unittest.main()
