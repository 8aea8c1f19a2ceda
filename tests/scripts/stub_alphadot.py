#!/usr/bin/python3
"""Stands in for `mpirun -n N alphadot VERB CASE --set KEY=VALUE ... --out DIR [--restart]`, and for
`alphadot derive FILE ... [--center X] --json`.

Does as the title of its case says: "good" writes a result; "short" one that is not converged; "bad" fails with a message; "slow" shows progress and waits until it
is told to stop, writes a checkpoint, and is done when it is restarted. Notes every call in calls.txt of its folder.

About another centre it gives Cm_alpha as if the normal force were 10 alpha, with an uncertainty of 0.25: numbers that no formula but
its own has. Notes these calls in derive.txt beside the runs' folders: how many files, and the centre.
"""

from __future__ import annotations

import json
import signal
import sys
import time
import tomllib
from pathlib import Path



def derive(files: list[str], x: float | None) -> None:
    items = []
    for file in files:
        result = json.loads(Path(file).read_text())
        derivatives, center = result["derivatives"], result["reference"]["moment_center"]
        if x is not None:
            derivatives["Cm_alpha"] = derivatives["Cm_alpha"] | {
                "value": derivatives["Cm_alpha"]["value"] + 10 * (x - center[0]), "uncertainty": 0.25
            }  # fmt: skip
            center = [x, *center[1:]]
        kept = {key: result[key] for key in ("status", "message", "reference", "freestream")}
        loads = {name: [value] for name, value in result["forces"].items() if name[0] == "C"}
        items.append(kept | {"file": file, "center": center, "derivatives": derivatives, "loads": loads})
    with open(Path(files[0]).parents[1] / "derive.txt", "a") as calls:
        print(len(files), x, file=calls)
    print(json.dumps(items))


if sys.argv[1] == "derive":
    about = float(sys.argv[sys.argv.index("--center") + 1].split(",")[0]) if "--center" in sys.argv else None
    derive([word for word in sys.argv[2:] if word.endswith(".json")], about)
    sys.exit()

arguments = sys.argv[sys.argv.index("-n") + 3 :]
verb, case = arguments[:2]
settings = dict(word.split("=", 1) for before, word in zip(arguments, arguments[1:]) if before == "--set")
folder = Path(arguments[arguments.index("--out") + 1])
restart = "--restart" in arguments
title = tomllib.loads(Path(case).read_text()).get("title", "good")
with open(folder / "calls.txt", "a") as calls:
    print("restart" if restart else "start", file=calls)


def end(status: str, code: int) -> None:
    mach, alpha = float(settings["freestream.mach"]), float(settings["freestream.alpha"])
    method = "linear solve, k -> 0" if verb == "derivatives" else "harmonic fit"
    names = {
        "CN_alpha": 24 / mach,
        "Cm_alpha": -60 / mach,
        "CN_alphadot": 25.0,
        "Cm_alphadot": -20.0,
        "CN_q": 150 / mach,
        "Cm_q": -700 / mach,
    }
    result = {
        "status": status,
        "message": "the linear residual for alpha dropped 1.3 of 3 decades" if status == "not_converged" else "",
        "title": title,
        "ranks": int(sys.argv[sys.argv.index("-n") + 1]),
        "mesh": {"file": settings.get("mesh.file", "x.msh"), "cells": 1000, "points": 300, "hash": "0123456789abcdef"},
        "reference": {
            "length": 1.0, "area": 0.785, "moment_center": [5.5, 0, 0], "model": "half", "rate": "length / (2 V)", "axes": "body"
        },
        "freestream": {"mach": mach, "alpha": alpha, "beta": 0.0, "gamma": 1.4},
        "forces": {"CA": 0.1, "CN": 0.2, "Cm": -0.4, "components": {"body": {}}, "excluded": ["base"]},
        "uncertainty": "solver only; mesh not assessed",
        "derivatives": {name: {"value": value, "uncertainty": 0.1, "method": method} for name, value in names.items()},
        "performance": {
            "wall_s": 10.0, "cpu_s": 19.0, "iterations": 60, "halo_fraction": None,
            "core_us_per_cell_iteration": 3.0, "bytes_per_cell": 1100.0,
        },
        "provenance": {"version": "0.1.0", "commit": "abc", "date": "2025-01-01T00:00:00Z"},
    }  # fmt: skip
    (folder / "result.json").write_text(json.dumps(result))
    sys.exit(code)


def stop(*_: object) -> None:
    (folder / "checkpoint_000001.vtkhdf").touch()
    end("interrupted", 3)


if title == "bad":
    print("alphadot: error: bad.toml:2: no such mesh", file=sys.stderr)
    sys.exit(1)
if title == "slow" and not restart:
    signal.signal(signal.SIGUSR2, stop)
    progress = {"phase": "motion", "seconds_left": 7.2, "step": 3, "of_steps": 10}
    (folder / "progress.json").write_text(json.dumps(progress))
    (folder / "started").touch()
    time.sleep(30)
    sys.exit("nobody stopped the stub")
(folder / "steady.csv").write_text("iteration,orders,cfl,CA,CN,Cm\n1,0,20,0.3,0.1,-0.2\n60,10.1,1e6,0.1,0.2,-0.4\n")
if title == "short":
    (folder / "checkpoint_000001.vtkhdf").touch()
    end("not_converged", 5)
end("converged" if verb == "derivatives" else "completed", 0)
