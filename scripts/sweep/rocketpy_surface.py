"""Tables for RocketPy: CSV files of a GenericSurface and of a LinearGenericSurface, and a script that flies them.

RocketPy's body axes are starboard, down and forward; its alpha = atan2(w, u) and beta = atan2(v, u); its moments pitch, yaw and roll are
Cm, Cn and Cl. Its coefficients of lift, side force and drag are turned into the body by the matrix of its documentation
(docs, "Generic Surfaces"), which turns the other way from the wind. They are written so that this matrix gives the forces computed.
"""

from __future__ import annotations

import csv
import math
import shutil
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from sweep import fly_folder
from sweep.database import COEFFICIENTS
from sweep.grid import Grid

STATIC = ("cL", "cQ", "cD", "cm", "cn", "cl")
MOMENTS = {"cm": "Cm", "cn": "Cn", "cl": "Cl"}


def write(folder: Path, grid: Grid, unit: float, axial: bool) -> list[str]:
    """generic/*.csv (static, over alpha, beta and Mach), linear/*.csv (about zero incidence, over Mach), reference.csv and fly.py; what
    could not be written, and why."""
    shutil.rmtree(folder, ignore_errors=True)
    left_out = []
    for part in ("generic", "linear"):
        (folder / part).mkdir(parents=True)
    axes, values, note = static_axial(grid) if axial and len(grid.beta) == 1 else static(grid)
    left_out += note
    if any(len(axis) > 1 for axis in axes.values()):
        for name in STATIC:
            write_table(folder / "generic" / f"{name}.csv", axes, name, values[name])
    linear = linear_set(grid)
    if isinstance(linear, str):
        left_out.append(f"rocketpy/linear: {linear}")
    else:
        for name, numbers in linear.items():
            write_table(folder / "linear" / f"{name}.csv", {"mach": grid.mach}, name, numbers)
    fly_folder.complete(folder, grid, unit, "fly_rocketpy.py")
    return left_out


def write_table(path: Path, axes: dict[str, Sequence[float]], name: str, values: np.ndarray) -> None:
    """A regular grid, the last axis fastest; only axes with more than one value."""
    kept = {axis: numbers for axis, numbers in axes.items() if len(numbers) > 1}
    nodes = np.stack([part.ravel() for part in np.meshgrid(*kept.values(), indexing="ij")], axis=1)
    with open(path, "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow((*kept, name))
        writer.writerows(np.column_stack([nodes, np.asarray(values).reshape(-1)]).tolist())


def in_frame(alpha: float, beta: float, coefficients: dict[str, float]) -> dict[str, float]:
    """RocketPy's six at its angles (rad): lift, side force and drag that its matrix turns into (CY, -CN, -CA)."""
    ca, sa, cb, sb = math.cos(alpha), math.sin(alpha), math.cos(beta), math.sin(beta)
    axial, side, normal = (coefficients.get(name, 0.0) for name in ("CA", "CY", "CN"))
    along = sa * normal - ca * axial
    out = {"cL": ca * normal + sa * axial, "cQ": cb * side + sb * along, "cD": sb * side - cb * along}
    return out | {own: coefficients.get(name, 0.0) for own, name in MOMENTS.items()}


Tables = tuple[dict[str, Sequence[float]], dict[str, np.ndarray], list[str]]


def gathered(axes: dict[str, Sequence[float]], each: Iterable[dict[str, float]]) -> dict[str, np.ndarray]:
    """Values in the order of the axes."""
    rows = list(each)
    return {name: np.array([row[name] for row in rows]).reshape([len(axis) for axis in axes.values()]) for name in STATIC}


def static(grid: Grid) -> Tables:
    """Over alpha, beta and Mach. RocketPy's beta has tan(beta) = tan(ours) / cos(alpha): its nodes are at the same numbers, and the
    values there linear between ours, never outside of them."""
    axes = {"alpha": np.radians(grid.alpha), "beta": np.radians(grid.beta), "mach": grid.mach}

    def each():
        for alpha in grid.alpha:
            for beta in grid.beta:
                ours = math.degrees(math.atan(math.tan(math.radians(beta)) * math.cos(math.radians(alpha))))
                for mach in grid.mach:
                    column = lambda name: [grid.at(mach, alpha, node).coefficients.get(name, 0.0) for node in grid.beta]
                    at = {name: float(np.interp(ours, grid.beta, column(name))) for name in COEFFICIENTS}
                    yield in_frame(math.radians(alpha), math.radians(beta), at)

    return axes, gathered(axes, each()), []


def static_axial(grid: Grid) -> Tables:
    """Of a configuration that looks the same from all sides: the loads at the total incidence, turned into its plane. Nodes whose
    corner is beyond the largest incidence computed are left out."""
    known = [alpha for alpha in grid.alpha if alpha >= 0.0]
    if not known or known[0] > 0.0:
        return static(grid)
    total = lambda a, b: math.degrees(math.atan(math.hypot(math.tan(math.radians(a)), math.tan(math.radians(b)))))
    kept = [alpha for alpha in known if total(alpha, alpha) <= known[-1] + 1e-9]
    nodes = sorted({sign * alpha for alpha in kept for sign in (-1.0, 1.0)})
    axes = {"alpha": np.radians(nodes), "beta": np.radians(nodes), "mach": grid.mach}

    def each():
        for alpha in nodes:
            for beta in nodes:
                incidence = total(alpha, beta)
                across = math.tan(math.radians(incidence))
                cosine = math.tan(math.radians(alpha)) / across if across else 1.0
                sine = math.tan(math.radians(beta)) / across if across else 0.0
                for mach in grid.mach:
                    column = lambda name: [grid.at(mach, a, grid.beta[0]).coefficients[name] for a in known]
                    at = lambda name: float(np.interp(incidence, known, column(name)))
                    normal, moment = (at(name) if across else 0.0 for name in ("CN", "Cm"))
                    yield in_frame(math.radians(alpha), math.radians(beta), {
                        "CA": at("CA"), "CN": normal * cosine, "CY": -normal * sine, "Cm": moment * cosine, "Cn": -moment * sine
                    })  # fmt: skip

    left = [alpha for alpha in known if alpha not in kept]
    note = f"rocketpy/generic: alpha and beta end at {kept[-1]:g} deg; both at the next value are beyond {known[-1]:g} deg in all"
    return axes, gathered(axes, each()), [note] if left else []


def linear_set(grid: Grid) -> dict[str, np.ndarray] | str:
    """The coefficients and their derivatives at zero incidence over Mach, or why there are none."""
    if len(grid.mach) < 2:
        return "needs two Mach numbers or more"
    zero = grid.nearest_zero()
    if abs(zero.alpha[0]) > 1e-6 or abs(zero.beta[0]) > 1e-6:
        return "nothing was computed at zero incidence"
    axial, side, normal = (zero.values(name).ravel() for name in ("CA", "CY", "CN"))
    out = {"cL_0": normal, "cQ_0": side, "cD_0": axial} | {f"{own}_0": zero.values(name).ravel() for own, name in MOMENTS.items()}
    own = {"cL": "CN", "cQ": "CY", "cD": "CA", **MOMENTS}
    known = zero.derivatives
    for variable in ("alpha", "beta", "p", "q", "r"):
        for name, ours in own.items():
            if f"{ours}_{variable}" in known:
                out[f"{name}_{variable}"] = zero.values(f"{ours}_{variable}").ravel()
    # The matrix turns with the angles.
    for name, change in {"cL_alpha": axial, "cD_alpha": -normal, "cQ_beta": -axial, "cD_beta": side}.items():
        if name in out:
            out[name] = out[name] + change
    for name in ("cL", "cQ", "cD", "cm", "cn"):  # in a flight along a straight path alphadot is q, and betadot is -r
        for rate, angle, sign in (("q", "alphadot", 1.0), ("r", "betadot", -1.0)):
            if f"{name}_{rate}" in out and f"{own[name]}_{angle}" in known:
                out[f"{name}_{rate}_{angle}"] = out[f"{name}_{rate}"] + sign * zero.values(f"{own[name]}_{angle}").ravel()
    return out
