#!/usr/bin/python3
"""Kills a sweep twice on its way, starts it again, and checks that its numbers are those of the same sweep left alone.

  scripts/sweep_test.py [SWEEP.toml] [--mesh LEVEL]      default: Table I of the Basic Finner

The kills are as when the power fails: SIGKILL to sweep.py, mpirun and every rank, once in a run of linear solves and once halfway
through a motion. Both sweeps are kept in runs/sweep_test; the one left alone is not repeated when it is there. Needs the built program.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

from sweep.plan import Run, read_sweep
from sweep.state import RESULT, Phase, checkpoints, read_json, read_state
from sweep.text import duration

ROOT = Path(__file__).resolve().parents[1]
FOLDER = ROOT / "runs" / "sweep_test"


def copy_of(sweep: Path, name: str, mesh: str | None) -> Path:
    """The sweep file with a folder of its own, beside the original for the sake of its relative paths."""
    lines = [line for line in sweep.read_text().splitlines() if not line.startswith(("folder", "mesh" if mesh else "folder"))]
    head = [f'folder = "{FOLDER / name}"'] + ([f'mesh = "{mesh}"'] if mesh else [])
    copy = sweep.with_name(f".{sweep.stem}_{name}.toml")
    copy.write_text("\n".join([*head, *lines]) + "\n")
    return copy


def start(sweep: Path) -> subprocess.Popen:
    return subprocess.Popen([sys.executable, "-B", str(ROOT / "scripts" / "sweep.py"), "run", str(sweep)])


def with_descendants(pid: int) -> list[int]:
    children = [int(word) for file in Path(f"/proc/{pid}/task").glob("*/children") for word in file.read_text().split()]
    return [pid, *(below for child in children for below in with_descendants(child))]


def kill_when(sweep: Path, moment: Callable[[Run], bool], what: str) -> None:
    """Runs the sweep until the moment has come in one of its runs, and kills everything."""
    runs, process = read_sweep(sweep).runs, start(sweep)
    while not any(moment(run) for run in runs):
        if process.poll() is not None:
            sys.exit(f"sweep_test.py: the sweep ended before {what}")
        time.sleep(0.2)
    killed = with_descendants(process.pid)
    for pid in killed:
        os.kill(pid, signal.SIGKILL)
    process.wait()
    print(f"\n== killed {len(killed)} processes {what}\n", flush=True)
    time.sleep(1.0)


def progress(run: Run) -> dict:
    return read_json(run.folder / "progress.json")


def in_linear_solves(run: Run) -> bool:
    return progress(run).get("phase") == "linear solves"


def halfway_in_motion(run: Run) -> bool:
    found = progress(run)
    return found.get("phase") == "motion" and 2 * found["step"] >= found["of_steps"] and len(checkpoints(run)) > 1


def to_the_end(sweep: Path) -> float:
    began = time.monotonic()
    if start(sweep).wait() != 0:
        sys.exit(f"sweep_test.py: {sweep.name} did not come to its end")
    return time.monotonic() - began


def largest_difference(one: Path, other: Path) -> float:
    """Between the derivatives of all runs of two sweeps, relative."""
    pairs = []
    for a, b in zip(read_sweep(one).runs, read_sweep(other).runs):
        assert a.name == b.name and read_state(a).phase is read_state(b).phase is Phase.DONE, a.name
        first, second = (json.loads((run.folder / RESULT).read_text())["derivatives"] for run in (a, b))
        assert first.keys() == second.keys() and first, a.name
        pairs += [(first[name]["value"], second[name]["value"]) for name in first]
    return max(abs(x - y) / max(abs(x), 1e-12) for x, y in pairs)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("sweep", type=Path, nargs="?", default=ROOT / "cases" / "basic_finner" / "table1.toml")
    parser.add_argument("--mesh", metavar="LEVEL", help="another mesh, for a quicker test")
    arguments = parser.parse_args()
    whole, killed = (copy_of(arguments.sweep, name, arguments.mesh) for name in ("whole", "killed"))
    try:
        seconds = to_the_end(whole)
        shutil.rmtree(FOLDER / "killed", ignore_errors=True)
        kill_when(killed, in_linear_solves, "in the linear solves")
        kill_when(killed, halfway_in_motion, "halfway through a motion")
        to_the_end(killed)
        difference = largest_difference(whole, killed)
        assert (FOLDER / "killed" / "report.html").exists()
        print(f"left alone: {duration(seconds)}; killed twice: the largest relative difference of a derivative is {difference:.1e}")
        if difference > 1e-12:
            sys.exit("sweep_test.py: the numbers differ")
    finally:
        whole.unlink()
        killed.unlink()


if __name__ == "__main__":
    main()
