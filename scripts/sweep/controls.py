"""What a control does to the coefficients: the runs with it deflected, less those with everything at rest."""

from __future__ import annotations

import numpy as np

from sweep.database import COEFFICIENTS, Point
from sweep.errors import SweepError
from sweep.grid import Grid, make_grid
from sweep.jsbsim import Control


def read_controls(points: list[Point], grid: Grid) -> tuple[list[Control], list[str]]:
    """The controls of a series, on that part of its grid (at the least sideslip) where each was computed; and what is left out."""
    own = [point for point in points if point.series == grid.series]
    names = list(dict.fromkeys(name for point in own for name, value in point.run.deflections.items() if value))
    out, left_out = [], []
    together = {point.run.name for point in own if sum(map(bool, point.run.deflections.values())) > 1}
    if together:
        left_out.append(f"{len(together)} runs with more than one control deflected: a table has each alone")
    for name in names:
        grids: dict[float, Grid] = {}
        for degrees in sorted({point.run.deflections.get(name, 0.0) for point in own} - {0.0}):
            try:
                grids[degrees] = make_grid(points, grid.series, {name: degrees})
            except SweepError as error:
                left_out.append(f"{name} at {degrees:g} degrees: {error}")
        control = control_of(name, grids, grid)
        if control is None:
            left_out.append(f"{name}: nothing in common with the runs at rest")
        else:
            out.append(control)
            left_out += [f"{name} at {degrees:g}: {line}" for degrees, found in grids.items() for line in found.left_out]
    return out, left_out


def control_of(name: str, grids: dict[float, Grid], rest: Grid) -> Control | None:
    beta = min(rest.beta, key=abs)
    every = [rest, *grids.values()]
    mach = sorted(set.intersection(*(set(grid.mach) for grid in every)))
    alpha = sorted(set.intersection(*(set(grid.alpha) for grid in every)))
    if not grids or not mach or not alpha or any(beta not in grid.beta for grid in every):
        return None
    degrees = sorted([0.0, *grids])
    changes = {}
    for coefficient in COEFFICIENTS:
        value = lambda grid, m, a: grid.at(m, a, beta).coefficients.get(coefficient, 0.0)
        changes[coefficient] = np.array([
            [[value(grids[d], m, a) - value(rest, m, a) if d else 0.0 for a in alpha] for m in mach] for d in degrees
        ])  # fmt: skip
    return Control(name, degrees, mach, alpha, changes)


def trim_angles(control: Control, rest: Grid) -> list[tuple[float, float, float, float]]:
    """Degrees, Mach number, and where between the angles computed Cm is zero: alpha, and CN there; linear between them."""
    beta = min(rest.beta, key=abs)
    out = []
    for i, degrees in enumerate(control.degrees):
        for j, mach in enumerate(control.mach):
            total = lambda name: [rest.at(mach, a, beta).coefficients[name] + d for a, d in zip(control.alpha, control.changes[name][i, j])]
            moment, normal = total("Cm"), total("CN")
            for k in range(len(control.alpha) - 1):
                low, high = moment[k], moment[k + 1]
                if low * high < 0.0 or (low == 0.0 and high != 0.0):
                    share = low / (low - high)
                    alpha = control.alpha[k] + share * (control.alpha[k + 1] - control.alpha[k])
                    out.append((degrees, mach, alpha, normal[k] + share * (normal[k + 1] - normal[k])))
    return out
