#!/usr/bin/python3
"""Cost of the solver on this machine beside its targets, as JSON. scripts/bench.sh builds and meshes what this needs.

Every figure is the least of the repetitions: what else the machine does only adds. Processor time is that of one core; the speed-up of
two ranks is one of wall time, and worth nothing on a machine that is busy, which the record says.
"""

from __future__ import annotations

import argparse
import datetime
import json
import os
import platform
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
BUILD = ROOT / "build-bench"
CASE = ROOT / "cases" / "basic_finner" / "derivatives.toml"
ORDERS = 6

# Open MPI refuses to run as root unless it is told to; each rank is to have a core of its own.
ENVIRONMENT = os.environ | {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


def machine() -> dict:
    """What was measured on."""
    cpu = next((line.split(":", 1)[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")), "unknown")
    memory = next(int(line.split()[1]) for line in open("/proc/meminfo") if line.startswith("MemTotal"))
    return {
        "cpu": cpu,
        "cores": len(os.sched_getaffinity(0)),
        "memory_gb": round(memory / 2**20, 1),
        "system": platform.platform(),
        "load_before": round(os.getloadavg()[0], 2),
    }


def kernels(repetitions: int) -> dict[str, dict[str, float]]:
    """Microseconds of one core per cell, and bytes per cell, of every benchmark in tests/bench."""
    command = [BUILD / "tests/bench/bench_solver", CASE, "--benchmark_format=json", f"--benchmark_repetitions={repetitions}"]
    done = subprocess.run(command, capture_output=True, text=True, env=ENVIRONMENT)
    if done.returncode:
        sys.exit(f"bench.py: {done.stderr}")
    out: dict[str, dict[str, float]] = {}
    for entry in json.loads(done.stdout)["benchmarks"]:
        if entry.get("error_occurred"):
            sys.exit(f"bench.py: {entry['name']}: {entry['error_message']}")
        if entry["run_type"] != "iteration":
            continue
        best = out.setdefault(entry["run_name"], {"us_per_cell": float("inf")})
        best["us_per_cell"] = min(best["us_per_cell"], 1e6 / entry["items_per_second"])
        if "bytes_per_cell" in entry:
            best["bytes_per_cell"] = entry["bytes_per_cell"]
    return out


def steady(ranks: int, repetitions: int) -> dict:
    """A steady solve by the program with its defaults; the least wall and processor seconds of the march."""
    runs = []
    for _ in range(repetitions):
        with tempfile.TemporaryDirectory() as folder:
            settings = [f"steady.orders={ORDERS}", "output.flow=false", "output.surface=false"]
            overrides = [word for setting in settings for word in ("--set", setting)]
            command = ["mpirun", "-n", str(ranks), BUILD / "alphadot", "run", CASE, "--out", folder, "--quiet", *overrides]
            done = subprocess.run(command, capture_output=True, text=True, env=ENVIRONMENT)
            if done.returncode:
                sys.exit(f"bench.py: {done.stderr}")
            runs.append(json.loads((Path(folder) / "result.json").read_text()))
    if any(run["status"] != "converged" for run in runs):
        sys.exit(f"bench.py: {runs[0]['message']}")
    performance = [run["performance"] for run in runs]
    return {
        "ranks": ranks,
        "cells": runs[0]["mesh"]["cells"],
        "iterations": performance[0]["iterations"],
        "wall_s": min(entry["steady_wall_s"] for entry in performance),
        "cpu_s": min(entry["steady_cpu_s"] for entry in performance),
        "bytes_per_cell": performance[0]["bytes_per_cell"],
        "program": runs[0]["provenance"],
    }


def figure(name: str, unit: str, value: float, at_most: float | None = None, at_least: float | None = None) -> dict:
    """A measured value beside its target."""
    bound = {"at_most": at_most} if at_most is not None else {"at_least": at_least}
    met = value <= at_most if at_most is not None else value >= at_least
    return {"name": name, "unit": unit, "target": bound, "measured": round(value, 4), "met": met}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=ROOT / "runs" / "bench.json", help="file to write (default: runs/bench.json)")
    parser.add_argument("--repetitions", type=int, default=5, help="of everything (default: 5)")
    arguments = parser.parse_args()

    record = machine()
    timed = kernels(arguments.repetitions)
    one, two = (steady(ranks, arguments.repetitions) for ranks in (1, 2))
    program = one.pop("program")
    del two["program"]
    per_100k = 1e5 / one["cells"]
    figures = [
        figure("second-order residual", "us/cell", timed["residual"]["us_per_cell"], at_most=0.35),
        figure("block LU-SGS iteration, two sweeps", "us/cell", timed["block_lu_sgs_iteration"]["us_per_cell"], at_most=0.8),
        figure("six orders at Mach 2.5", "s of one core per 100,000 cells", one["cpu_s"] * per_100k, at_most=5.0),
        figure("six orders at Mach 2.5", "iterations", one["iterations"], at_most=70),
        figure("memory, matrix-free LU-SGS", "bytes/cell", timed["lu_sgs_iteration"]["bytes_per_cell"], at_most=700),
        figure("memory, block LU-SGS", "bytes/cell", timed["block_lu_sgs_iteration"]["bytes_per_cell"], at_most=1400),
        figure("two ranks over one, six orders", "ratio of wall times", one["wall_s"] / two["wall_s"], at_least=1.85),
    ]
    out = {
        "date": datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds"),
        "machine": record,
        "program": program,
        "repetitions": arguments.repetitions,
        "figures": figures,
        "kernels": timed,
        "steady": [one, two],
    }
    arguments.out.parent.mkdir(parents=True, exist_ok=True)
    arguments.out.write_text(json.dumps(out, indent=2) + "\n")

    print(f"{record['cpu']}, {record['cores']} cores, load {record['load_before']} before")
    for entry in figures:
        ((bound, target),) = entry["target"].items()
        verdict = "met" if entry["met"] else "MISSED"
        label = f"{entry['name']} [{entry['unit']}]"
        print(f"{label:<66} {entry['measured']:>9g}  {bound.replace('_', ' ')} {target:<6g} {verdict}")
    if record["load_before"] > 0.5:
        print("the machine was busy: the ratio of wall times says little")
    print(f"written to {arguments.out}")


if __name__ == "__main__":
    main()
