#!/usr/bin/python3
"""A tolerance in place of a mesh: `alphadot derivatives DESCRIPTION --tolerance T` from outside, on a cone with a cylinder.

Environment: see program.py. The expected value is the same on a mesh without adaptation that has more cells than any of these.
"""

from __future__ import annotations

import json
import os
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

from program import PROGRAM

MISSILE = """flight = {mach = [1.9, 2.1]}
[[body]]
shape = "cone"
length = 3
diameter = 1
[[body]]
shape = "cylinder"
length = 2
"""
GOALS = ("--goals", "Cm_alpha,Cm_alphadot", "--cells", "15000")
OPTIONS = ("derivatives", "missile.toml", *GOALS, "--set", "freestream.mach=2", "--out", "out")


def run(folder: Path, *arguments: object) -> subprocess.CompletedProcess:
    return subprocess.run([PROGRAM, *map(str, arguments)], cwd=folder, capture_output=True, text=True, timeout=250)


TOLERANCE = "20%CN_alpha,Cm_alphadot=50%CN_alphadot"


class ToleranceTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = Path(temporary.name)
        (cls.folder / "missile.toml").write_text(MISSILE)
        cls.first = run(cls.folder, *OPTIONS, "--tolerance", TOLERANCE)

    def found(self) -> dict:
        return json.loads((self.folder / "out" / "adaptation.json").read_text())

    def runs(self) -> dict[str, int]:
        return {str(file): file.stat().st_mtime_ns for file in sorted((self.folder / "out").rglob("result.json"))}

    def test_holds_what_a_finer_mesh_gives(self) -> None:
        self.assertEqual(self.first.returncode, 0, self.first.stderr)
        found = self.found()
        entries = found["streams"][0]["derivatives"]
        self.assertLessEqual(entries["Cm_alpha"]["uncertainty"], 0.2 * entries["CN_alpha"]["value"])
        self.assertEqual(len(found["families"][-1]["streams"][0]["members"]), 5)
        mesh = run(self.folder, "mesh", "missile.toml", "-o", "fine", "--cells", "30000", "--no-picture")
        self.assertEqual(mesh.returncode, 0, mesh.stderr)
        fine = run(self.folder, "derivatives", "fine/case.toml", "--set", "freestream.mach=2", "--out", "fine/run")
        self.assertEqual(fine.returncode, 0, fine.stderr)
        for name, entry in json.loads((self.folder / "fine/run/result.json").read_text())["derivatives"].items():
            if name in entries and not name.startswith("CA"):  # of a body at no incidence these are zero
                self.assertLessEqual(abs(entry["value"] - entries[name]["value"]), entries[name]["uncertainty"], name)

    def test_finds_again_what_is_there(self) -> None:
        before, values = self.runs(), self.found()["families"]
        start = time.monotonic()
        again = run(self.folder, *OPTIONS, "--tolerance", TOLERANCE)
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertEqual(self.runs(), before)
        self.assertEqual(self.found()["families"], values)
        # A run that was killed is done again, and that one alone.
        (killed,) = (self.folder / "out").glob("family_1/run_1.18/done.json")
        killed.unlink()
        self.assertEqual(run(self.folder, *OPTIONS, "--tolerance", TOLERANCE).returncode, 0)
        changed = [file for file, when in self.runs().items() if before.get(file) != when]
        self.assertEqual(changed, [str(killed.with_name("result.json"))])
        again, first = (families[-1]["streams"][0]["derivatives"]["Cm_alpha"]["value"] for families in (self.found()["families"], values))
        self.assertEqual(again, first)
        self.assertLess(time.monotonic() - start, 60.0)

    def test_a_budget_that_is_too_small_is_said(self) -> None:
        done = run(self.folder, *OPTIONS, "--tolerance", "0.01%")
        self.assertEqual(done.returncode, 5, done.stderr)
        self.assertEqual(self.found()["status"], "out_of_budget")
        self.assertIn("out_of_budget: the interval of", done.stdout)
        self.assertIn("# Status: out_of_budget", (self.folder / "out/adaptation.csv").read_text())

    def test_says_what_is_wrong(self) -> None:
        (self.folder / "own.toml").write_text('[mesh]\nfile = "own.msh"\n')
        for options, code, part in (
            (("missile.toml", "--tolerance", "much"), 1, "'much' is no tolerance"),
            (("missile.toml", "--tolerance", "1%,Cn_r=1%"), 1, "none of the goals"),
            (("missing.toml", "--tolerance", "1%"), 1, "no such file"),
            (("own.toml", "--tolerance", "1%"), 1, "set [mesh] from"),
            ((*OPTIONS[1:], "--goals", "Cm_r", "--tolerance", "1%"), 1, "holds an adaptation of something else"),
            (("missile.toml", "--out", "wrong", "--goals", "Cm_beta", "--cells", "15000", "--tolerance", "1%"), 1, "Cm_beta"),
            (("missile.toml", "--tolerance", "1%", "--cells", "few"), 2, "'few' is no number"),
        ):
            done = run(self.folder, "derivatives", *options)
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertIn(part, done.stderr)
            self.assertNotIn("Traceback", done.stderr)

    def test_is_not_started_under_mpirun(self) -> None:
        command = [os.environ["MPIEXEC"], "-n", "2", PROGRAM, *OPTIONS, "--tolerance", "1%"]
        done = subprocess.run(command, cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertEqual(done.stderr.count("say --ranks N"), 1, done.stderr)

    def test_sizes_from_what_is_none(self) -> None:
        (self.folder / "none.vtkhdf").write_text("nothing")
        command = [PROGRAM, "mesh", "missile.toml", "-o", "none", "--cells", "9000", "--no-picture", "--sizes", "none.vtkhdf"]
        done = subprocess.run(command, cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, 1)
        self.assertIn("give indicator.vtkhdf", done.stderr)
        self.assertNotIn("Traceback", done.stderr)


if __name__ == "__main__":
    unittest.main()
