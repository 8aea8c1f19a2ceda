"""What the tests of sweep.py share: a folder with cases and a sweep file, and sweep.py with the stub in place of mpirun."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
import unittest
from collections.abc import Callable
from pathlib import Path

HERE = Path(__file__).resolve().parent
SCRIPTS = HERE.parents[1] / "scripts"
SWEEP = SCRIPTS / "sweep.py"
STUB = HERE / "stub_alphadot.py"
sys.path.insert(0, str(SCRIPTS))

HEAD = 'title = "Try"\ncase = "good.toml"\nfolder = "runs"\nalpha = 1.5\n'


class Workspace(unittest.TestCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        self.file = self.folder / "try.toml"
        for title in ("good", "short", "bad", "slow"):
            (self.folder / f"{title}.toml").write_text(f'title = "{title}"\n')

    def write(self, blocks: str, head: str = HEAD) -> None:
        self.file.write_text(head + blocks)

    def start(self, verb: str, *options: object) -> subprocess.Popen:
        environment = os.environ | {"MPIEXEC": str(STUB), "ALPHADOT": str(STUB)}
        command = [sys.executable, "-B", str(SWEEP), verb, str(self.file), *map(str, options)]
        process = subprocess.Popen(command, env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(lambda: (process.kill(), process.communicate()))
        return process

    def sweep(self, verb: str, *options: object, code: int = 0) -> str:
        """What sweep.py prints; its exit code must be `code`."""
        process = self.start(verb, *options)
        out, err = process.communicate(timeout=30)
        self.assertEqual(process.returncode, code, out + err)
        return out + err

    def calls(self, name: str) -> list[str]:
        """How the stub was called for a run: "start" or "restart"."""
        file = self.folder / "runs" / name / "calls.txt"
        return file.read_text().split() if file.exists() else []

    def wait_for(self, condition: Callable[[], bool]) -> None:
        end = time.monotonic() + 20
        while not condition():
            self.assertLess(time.monotonic(), end, "what was waited for did not happen")
            time.sleep(0.02)
