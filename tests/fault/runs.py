"""What the fault tests share: a small plunge run that can be started, watched, disturbed and compared.

Set by CTest: ALPHADOT (the program), MPIEXEC. Needs the standard library only.
"""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "app"))
from program import CASE, PROGRAM, box, gmsh_text, write_case  # noqa: E402

SECONDS = 200  # before a run counts as hanging, on a machine that has other work too
PLUNGE = """
[motion]
kind = "plunge"
reduced_frequency = 0.02

[unsteady]
steps_per_cycle = 16
"""
STEPS = 24  # of the default one and a half cycles
COMPARED = ("history.h5", "history.csv", "flow.vtkhdf", "surface.vtkhdf")


def make_case(folder: Path, cells: int = 3, case: str = CASE + PLUNGE) -> None:
    """case.toml and its mesh, the unit cube in 6 cells^3 tetrahedra."""
    write_case(folder, case, gmsh_text(*box(cells)))


def settings(**values: object) -> list[str]:
    """--set arguments; the first underscore of a name stands for the dot: checkpoint_steps=1."""
    return [part for name, value in values.items() for part in ("--set", f"{name.replace('_', '.', 1)}={value}")]


def command(out: Path, *arguments: object, ranks: int = 1, verb: str = "run") -> list[str]:
    launcher = [os.environ["MPIEXEC"], "-n", str(ranks)] if ranks > 1 else []
    return [*launcher, PROGRAM, verb, "case.toml", "--out", str(out), *map(str, arguments)]


def run(
    folder: Path, out: Path, *arguments: object, ranks: int = 1, verb: str = "run", **options: object
) -> subprocess.CompletedProcess[str]:
    """A run to its end; raises subprocess.TimeoutExpired when it hangs."""
    line = command(out, *arguments, ranks=ranks, verb=verb)
    return subprocess.run(line, cwd=folder, capture_output=True, text=True, timeout=SECONDS, **options)


class CaseInFolder(unittest.TestCase):
    """The case in a folder of its own, and names for the folders of an undisturbed and of a disturbed run."""

    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        make_case(self.folder)
        self.full, self.part = self.folder / "full", self.folder / "part"


class LiveRun:
    """A run in the background, in a process group of its own, its messages in a file."""

    def __init__(self, folder: Path, out: Path, *arguments: object, ranks: int = 1, verb: str = "run") -> None:
        self.log = folder / "log"
        line = command(out, *arguments, ranks=ranks, verb=verb)
        with open(self.log, "w") as log:
            self.process = subprocess.Popen(line, cwd=folder, stdout=log, stderr=log, start_new_session=True)
        self.ranks = ranks

    def text(self) -> str:
        return self.log.read_text()

    def announced(self) -> int:
        """Number of the latest checkpoint that the run has told of, or 0."""
        return max(map(int, re.findall(r"^checkpoint checkpoint_(\d+)", self.text(), re.MULTILINE)), default=0)

    def wait_for(self, pattern: str) -> None:
        """Until the run has said it; fails when it ends before."""
        end = time.monotonic() + SECONDS
        while not re.search(pattern, self.text()):
            if self.process.poll() is not None or time.monotonic() > end:
                raise AssertionError(f"the run never said {pattern}:\n{self.text()}")
            time.sleep(0.01)

    def rank_pids(self) -> list[int]:
        """Process ids of the program on each rank."""
        if self.ranks == 1:
            return [self.process.pid]
        children = Path(f"/proc/{self.process.pid}/task").glob("*/children")
        return sorted(int(pid) for file in children for pid in file.read_text().split())

    def kill(self) -> None:
        """SIGKILL for mpirun and every rank, as when a node loses power."""
        for pid in [*(self.rank_pids() if self.process.poll() is None else []), self.process.pid]:
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
        self.wait()

    def wait(self) -> int:
        return self.process.wait(SECONDS)


def checkpoints(out: Path) -> list[Path]:
    return sorted(out.glob("checkpoint_*.vtkhdf"))


def result(out: Path) -> dict:
    return json.loads((out / "result.json").read_text())


def derivatives(out: Path) -> dict[str, float]:
    return {name: entry["value"] for name, entry in result(out)["derivatives"].items()}


def differences(one: Path, other: Path) -> list[str]:
    """Final files of two runs that differ in any bit, the last checkpoint included."""
    pairs = [(one / name, other / name) for name in COMPARED]
    pairs.append((checkpoints(one)[-1], checkpoints(other)[-1]))
    out = [b.name for a, b in pairs if a.read_bytes() != b.read_bytes()]
    return out + (["derivatives"] if derivatives(one) != derivatives(other) else [])
