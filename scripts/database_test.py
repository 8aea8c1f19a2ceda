#!/usr/bin/python3
"""An aerodynamic database from end to end, killed three times on its way: its numbers are those of one left alone.

  scripts/database_test.py [--case finner] [--level tiny] [--mach N] [--alpha N] [--compare N]

The canard-tail missile (or the Basic Finner) over Mach number, incidence and two deflections of its canards (tails), with all derivatives
in pitch; then its report and all tables. The kills are as when the power fails: SIGKILL to sweep.py, mpirun and every rank, after an
eighth, half and three quarters of the runs. Prints how long it took, what it is on the disk, and the largest difference to the same
runs (--compare of them, spread over the sweep) made in peace. Everything stays in runs/database_test. Needs the built program.
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
from pathlib import Path

from sweep.plan import Run, Sweep, read_sweep
from sweep.state import RESULT, Phase, read_state
from sweep.status import folder_size
from sweep.text import duration, size
from sweep_test import ROOT, start, with_descendants

FOLDER = ROOT / "runs" / "database_test"
CASES = {"canard_tail": ("canard", 1.8, 2.5), "basic_finner": ("fin", 1.6, 2.5)}  # what is deflected, Mach numbers of the mesh

SWEEP = """\
title = "Database of {case}"
case = "{missile}"
folder = "{folder}"
mesh = "{level}"
mesh_mach = [{low}, {high}]
symmetry = ["y"]
altitude = [0, 5000, 10000]
ranks = 2
[controls]
pitch = {{{fins} = {shares}}}
[[mass]]
mass = 40
inertia = [0.1, 8, 8]
center = {center}
[[runs]]
mach = {{from = {low}, to = {high}, count = {mach}}}
alpha = {{from = 0, to = 10, count = {alpha}}}
deflection.pitch = [0, 5]
"""


def write_sweep(arguments: argparse.Namespace, name: str) -> Path:
    fins, low, high = CASES[arguments.case]
    missile = ROOT / "cases" / arguments.case / "missile.toml"
    in_x = arguments.case == "canard_tail"
    file = FOLDER / f"{name}.toml"
    file.write_text(SWEEP.format(
        case=arguments.case, missile=missile, folder=FOLDER / name, level=arguments.level, low=low, high=high, fins=fins,
        shares=[1, 1, -1, -1] if in_x else [0, 1, 0, -1], center=0.85 if in_x else 5.5, mach=arguments.mach, alpha=arguments.alpha,
    ))  # fmt: skip
    return file


def ended(sweep: Sweep) -> int:
    return sum((run.folder / RESULT).exists() for run in sweep.runs)


def kill_after(file: Path, count: int) -> None:
    """Runs the sweep until so many runs have ended, and kills everything in the middle of the next."""
    sweep, process = read_sweep(file), start(file)
    while ended(sweep) < count:
        if process.poll() is not None:
            sys.exit("database_test.py: the sweep ended before it was killed")
        time.sleep(0.5)
    time.sleep(1.0)
    killed = with_descendants(process.pid)
    for pid in killed:
        os.kill(pid, signal.SIGKILL)
    process.wait()
    print(f"\n== killed {len(killed)} processes after {ended(sweep)} runs\n", flush=True)
    time.sleep(1.0)


def numbers(run: Run) -> dict[str, float]:
    result = json.loads((run.folder / RESULT).read_text())
    found = {name: entry["value"] for name, entry in result["derivatives"].items()}
    return found | {name: value for name, value in result["forces"].items() if isinstance(value, float)}


def largest_difference(runs: list[Run], others: list[Run]) -> float:
    """Of all numbers, relative to the largest of the kind in the pair."""
    worst = 0.0
    for one, other in zip(runs, others, strict=True):
        a, b = numbers(one), numbers(other)
        assert a.keys() == b.keys() and a, one.name
        worst = max(worst, *(abs(a[name] - b[name]) / max(abs(a[name]), abs(b[name]), 1e-9) for name in a))
    return worst


def tool(verb: str, file: Path) -> str:
    command = [sys.executable, "-B", str(ROOT / "scripts" / "sweep.py"), verb, str(file)]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"database_test.py: {verb}: {done.stderr}")
    return done.stdout


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--case", choices=CASES, default="canard_tail")
    parser.add_argument("--level", default="coarse")
    parser.add_argument("--mach", type=int, default=10, help="how many Mach numbers")
    parser.add_argument("--alpha", type=int, default=5, help="how many angles of attack")
    parser.add_argument("--compare", type=int, default=10, metavar="N", help="runs that are made again in peace")
    arguments = parser.parse_args()
    shutil.rmtree(FOLDER, ignore_errors=True)
    FOLDER.mkdir(parents=True)
    killed, whole = write_sweep(arguments, "killed"), write_sweep(arguments, "whole")
    sweep, alone = read_sweep(killed), read_sweep(whole)
    count, began = len(sweep.runs), time.monotonic()
    for share in (0.125, 0.5, 0.75):
        kill_after(killed, round(share * count))
    code = start(killed).wait()
    seconds = time.monotonic() - began
    if code not in (0, 5):
        sys.exit(f"database_test.py: the sweep ended with code {code}")
    print(tool("table", killed), tool("dynamics", killed)[-2000:], sep="\n")
    step = max(1, count // arguments.compare)
    names = [run.name for run in sweep.runs[::step]]
    subprocess.run([sys.executable, "-B", str(ROOT / "scripts" / "sweep.py"), "run", str(whole), "--only", *names], check=False)
    difference = largest_difference([sweep.find(name) for name in names], [alone.find(name) for name in names])
    phases = [read_state(run).phase for run in sweep.runs]
    runs = sum(folder_size(run.folder) for run in sweep.runs)
    table = sum(file.stat().st_size for file in (FOLDER / "killed" / "table").rglob("*") if file.is_file())
    print(
        f"{count} runs in {duration(seconds)} of wall clock, killed three times; {phases.count(Phase.DONE)} converged;"
        f" on the disk {size(runs)} of runs, {size(table)} of tables, a report of"
        f" {size((FOLDER / 'killed' / 'report.html').stat().st_size)}; the largest relative difference to {len(names)} runs in peace is {difference:.1e}"
    )
    return 0 if difference < 1e-12 else 1


if __name__ == "__main__":
    sys.exit(main())
