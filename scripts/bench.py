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
PLUNGE = CASE.with_name("plunge.toml")
MESH = CASE.with_name("coarse.msh")
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


def kernels(mesh: Path) -> dict:
    """What the bench program prints on one rank; each of its times is the best of several."""
    done = subprocess.run([BUILD / "alphadot_bench", CASE, f"mesh.file={mesh}"], capture_output=True, text=True, env=ENVIRONMENT)
    if done.returncode:
        sys.exit(f"bench.py: {done.stderr}")
    return json.loads(done.stdout)


def run(verb: str, case: Path, *settings: str, ranks: int = 1, options: tuple[str, ...] = ()) -> dict:
    """The result of one run of the program."""
    with tempfile.TemporaryDirectory() as folder:
        overrides = [word for setting in (*settings, "output.flow=false", "output.surface=false") for word in ("--set", setting)]
        command = ["mpirun", "-n", str(ranks), BUILD / "alphadot", verb, case, *options, "--out", folder, "--quiet", *overrides]
        done = subprocess.run(command, capture_output=True, text=True, env=ENVIRONMENT)
        if done.returncode:
            sys.exit(f"bench.py: {done.stderr}")
        result = json.loads((Path(folder) / "result.json").read_text())
    if result["status"] not in ("converged", "completed"):
        sys.exit(f"bench.py: {result['message']}")
    return result


def steady(ranks: int, repetitions: int) -> dict:
    """A steady solve by the program with its defaults; the least wall and processor seconds of the march."""
    runs = [run("run", CASE, f"steady.orders={ORDERS}", ranks=ranks) for _ in range(repetitions)]
    performance = [entry["performance"] for entry in runs]
    return {
        "ranks": ranks,
        "cells": runs[0]["mesh"]["cells"],
        "iterations": performance[0]["iterations"],
        "wall_s": min(entry["steady_wall_s"] for entry in performance),
        "cpu_s": min(entry["steady_cpu_s"] for entry in performance),
        "bytes_per_cell": performance[0]["bytes_per_cell"],
        "program": runs[0]["provenance"],
    }


def linear_solves(repetitions: int) -> dict:
    """The linear solves for alpha, q and alphadot after a steady state of so many orders, and the adjoints of CA, CN and Cm, both to as
    many; least processor seconds, and peak bytes a cell of each verb."""
    out: dict[str, float] = {}
    for _ in range(repetitions):
        forward = run("derivatives", CASE, f"steady.orders={ORDERS}")["performance"]
        deep, adjoint = (
            run(verb, CASE, f"steady.orders={ORDERS}", f"derivatives.orders={ORDERS}", options=options)["performance"]
            for verb, options in (("derivatives", ()), ("adjoint", ("--of", "CA,CN,Cm")))
        )
        found = {
            "linear_cpu_s": forward["linear_cpu_s"],
            "steady_cpu_s": forward["steady_cpu_s"],
            "deep_linear_cpu_s": deep["linear_cpu_s"],
            "adjoint_cpu_s": adjoint["linear_cpu_s"],
            "deep_peak_bytes_per_cell": deep["peak_bytes_per_cell"],
            "adjoint_peak_bytes_per_cell": adjoint["peak_bytes_per_cell"],
        }
        out = {name: min(value, out.get(name, value)) for name, value in found.items()}
    return out


def motions(mesh: Path) -> dict:
    """Processor seconds of the two motions that give the same derivatives, one and a half cycles each at k = 0.01, of the linear
    solves, and of the steady states before them (the motions can share one)."""
    at = f"mesh.file={mesh.resolve()}"
    plunge, pitch = (run("run", PLUNGE, at, f"motion.kind={kind}")["performance"] for kind in ("plunge", "pitch"))
    linear = run("derivatives", CASE, at)["performance"]
    return {
        "plunge_cpu_s": plunge["motion_cpu_s"],
        "pitch_cpu_s": pitch["motion_cpu_s"],
        "linear_cpu_s": linear["linear_cpu_s"],
        "steady_cpu_s": linear["steady_cpu_s"],
    }


def figure(name: str, unit: str, value: float, at_most: float | None = None, at_least: float | None = None) -> dict:
    """A measured value beside its target, if it has one."""
    target, met = {}, None
    if at_most is not None:
        target, met = {"at_most": at_most}, value <= at_most
    if at_least is not None:
        target, met = {"at_least": at_least}, value >= at_least
    return {"name": name, "unit": unit, "target": target, "measured": round(value, 4), "met": met}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=ROOT / "runs" / "bench.json", help="file to write (default: runs/bench.json)")
    parser.add_argument("--repetitions", type=int, default=5, help="of all solves (default: 5)")
    parser.add_argument("--motions", type=Path, metavar="MESH",
                        help="also plunge and pitch on this mesh beside the linear solves: minutes; the target is for the medium mesh")
    arguments = parser.parse_args()

    record = machine()
    timed = kernels(MESH)
    residual = next(kernel for kernel in timed["kernels"] if kernel["name"] == "residual")
    block, matrix_free = timed["iterations"]
    one, two = (steady(ranks, arguments.repetitions) for ranks in (1, 2))
    linear = linear_solves(arguments.repetitions)
    program = one.pop("program")
    del two["program"]
    per_100k = 1e5 / one["cells"]
    figures = [
        figure("second-order residual", "us/cell", 1e-3 * residual["core_ns_per_cell"], at_most=0.35),
        figure("block LU-SGS iteration, four pairs of passes", "us/cell", 1e-3 * block["core_ns_per_cell"], at_most=0.8),
        figure("six orders at Mach 2.5", "s of one core per 100,000 cells", one["cpu_s"] * per_100k, at_most=5.0),
        figure("six orders at Mach 2.5", "iterations", one["iterations"], at_most=70),
        figure("memory, matrix-free LU-SGS", "bytes/cell", matrix_free["held_bytes_per_cell"], at_most=700),
        figure("memory, block LU-SGS", "bytes/cell", block["held_bytes_per_cell"], at_most=1400),
        figure("two ranks over one, six orders", "ratio of wall times", one["wall_s"] / two["wall_s"], at_least=1.85),
        figure("alpha, q, alphadot over six orders", "ratio of s of a core", linear["linear_cpu_s"] / linear["steady_cpu_s"], at_most=1.3),
        figure("adjoints of CA, CN, Cm over alpha, q, alphadot", "ratio of s of a core",
               linear["adjoint_cpu_s"] / linear["deep_linear_cpu_s"], at_most=1.3),
        figure("the same, memory", "ratio of peak bytes a cell",
               linear["adjoint_peak_bytes_per_cell"] / linear["deep_peak_bytes_per_cell"], at_most=1.3),
    ]
    in_time = {}
    if arguments.motions:
        in_time = motions(arguments.motions)
        both, once, before = in_time["plunge_cpu_s"] + in_time["pitch_cpu_s"], in_time["linear_cpu_s"], in_time["steady_cpu_s"]
        figures += [
            figure("plunge and pitch over linear solves", "ratio of s of a core", both / once, at_least=25),
            figure("the same with the steady state in both", "ratio of s of a core", (both + before) / (once + before)),
        ]
    out = {
        "date": datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds"),
        "machine": record,
        "program": program,
        "repetitions": arguments.repetitions,
        "figures": figures,
        "kernels": timed,
        "steady": [one, two],
        "linear": linear,
        "motions": in_time,
    }
    arguments.out.parent.mkdir(parents=True, exist_ok=True)
    arguments.out.write_text(json.dumps(out, indent=2) + "\n")

    print(f"{record['cpu']}, {record['cores']} cores, load {record['load_before']} before")
    for entry in figures:
        label = f"{entry['name']} [{entry['unit']}]"
        print(f"{label:<66} {entry['measured']:>9g}", end="")
        for bound, target in entry["target"].items():
            print(f"  {bound.replace('_', ' ')} {target:<6g} {'met' if entry['met'] else 'MISSED'}", end="")
        print()
    if record["load_before"] > 0.5:
        print("the machine was busy: the ratio of wall times says little")
    print(f"written to {arguments.out}")


if __name__ == "__main__":
    main()
