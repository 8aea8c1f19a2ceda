"""Finished runs made in a moment: folders with the record and the result.json that the program would leave, of known coefficients."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable

from workspace import SCRIPTS  # noqa: F401: the scripts are on the path

from sweep.plan import Run, Sweep

Numbers = dict[str, float]
Model = Callable[[float, float, float], tuple[Numbers, Numbers]]  # of Mach, alpha, beta in degrees: coefficients, derivatives


def result(run: Run, coefficients: Numbers, derivatives: Numbers, status: str = "converged") -> dict:
    """As result.json has it; every uncertainty is 1 % of the value, two thirds of it the mesh's."""
    of = lambda value: {
        "value": value, "uncertainty": 0.01 * abs(value), "method": "linear solve, k -> 0", "converged": status == "converged",
        "parts": {"linear": 0.01 * abs(value) / 3, "mesh": 0.02 * abs(value) / 3},
    }  # fmt: skip
    forces = {name: coefficients.get(name, 0.0) for name in ("CA", "CY", "CN", "Cl", "Cm", "Cn")}
    half = {name: 0.5 * value for name, value in forces.items()}
    return {
        "status": status,
        "message": "the steady march dropped 2.1 of 6 decades" if status == "not_converged" else "",
        "title": "stub",
        "ranks": run.ranks,
        "mesh": {"file": "x.msh", "cells": 100_000, "points": 20_000, "hash": "0123456789abcdef"},
        "reference": {
            "length": 0.1, "area": 0.008, "moment_center": [0.5, 0, 0], "model": "full", "rate": "times length / (2 V)", "axes": "body"
        },
        "freestream": {"mach": run.mach, "alpha": run.alpha, "beta": run.beta, "gamma": 1.4},
        "forces": forces | {"components": {"body": half, "tail_1": half}, "excluded": ["base"]},
        "derivatives": {name: of(value) for name, value in derivatives.items()},
        "uncertainty": "solver and mesh",
        "performance": {
            "wall_s": 10.0, "cpu_s": 19.0, "iterations": 60, "halo_fraction": None,
            "core_us_per_cell_iteration": 3.0, "bytes_per_cell": 1100.0,
        },
        "provenance": {"version": "0.1.0", "commit": "abc", "date": "2025-01-01T00:00:00Z"},
    }  # fmt: skip


def finish(runs: Iterable[Run], model: Model, status: Callable[[Run], str] = lambda run: "converged") -> None:
    """Leaves the folders of runs that came to their end, or failed."""
    for run in runs:
        run.folder.mkdir(parents=True, exist_ok=True)
        (run.folder / "run.json").write_text(json.dumps({"identity": run.identity(), "attempt": 1}))
        end = status(run)
        if end == "failed":
            (run.folder / "end.json").write_text(json.dumps({"code": 1, "stopped": False, "reason": "no such mesh"}))
        else:
            (run.folder / "result.json").write_text(json.dumps(result(run, *model(run.mach, run.alpha, run.beta), end)))
            rows = ("iteration,orders,cfl,CA,CN,Cm", "1,0,20,0.3,0.1,-0.2", "30,4,1e6,0.1,0.2,-0.4", "60,8,1e6,0.1,0.2,-0.4", "")
            (run.folder / "steady.csv").write_text("\n".join(rows))


def finish_all(sweep: Sweep, model: Model) -> None:
    finish(sweep.runs, model)
