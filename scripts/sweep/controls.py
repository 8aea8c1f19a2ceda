"""What a control does to the coefficients: the runs with it deflected, less those with everything at rest."""

from __future__ import annotations

import numpy as np

from sweep.database import COEFFICIENTS, Point
from sweep.errors import SweepError
from sweep.grid import Grid, make_grid
from sweep.jsbsim import Control


def deflected(points: list[Point], rest: Grid) -> tuple[dict[str, dict[float, Grid]], list[str]]:
    """Of the series of a grid at rest: by control the grids that were computed, by its degrees, with `rest` at 0; and what is left out."""
    own = [point for point in points if point.series == rest.series]
    out: dict[str, dict[float, Grid]] = {}
    left_out = []
    together = {point.run.name for point in own if sum(map(bool, point.run.deflections.values())) > 1}
    if together:
        left_out.append(f"{len(together)} runs with more than one control deflected: a table has each alone")
    for name in dict.fromkeys(name for point in own for name, value in point.run.deflections.items() if value):
        grids = {0.0: rest}
        for degrees in sorted({point.run.deflections.get(name, 0.0) for point in own} - {0.0}):
            try:
                grids[degrees] = make_grid(points, rest.series, {name: degrees})
                left_out += [f"{name} at {degrees:g}: {line}" for line in grids[degrees].left_out]
            except SweepError as error:
                left_out.append(f"{name} at {degrees:g} degrees: {error}")
        out[name] = dict(sorted(grids.items()))
    return out, left_out


def shared(grids: dict[float, Grid]) -> tuple[list[float], list[float], float] | None:
    """Mach numbers, angles of attack and the least sideslip at which every one of the grids has a point; None where there is none."""
    common = lambda axis: set.intersection(*(set(getattr(grid, axis)) for grid in grids.values()))
    mach, alpha, beta = map(common, ("mach", "alpha", "beta"))
    least = min(grids[0.0].beta, key=abs)
    return (sorted(mach), sorted(alpha), least) if len(grids) > 1 and mach and alpha and least in beta else None


def read_controls(points: list[Point], grid: Grid) -> tuple[list[Control], list[str]]:
    """The controls of a series, on that part of its grid (at the least sideslip) where each was computed; and what is left out."""
    found, left_out = deflected(points, grid)
    out = []
    for name, grids in found.items():
        control = control_of(name, grids)
        if control is None:
            left_out.append(f"{name}: nothing in common with the runs at rest")
        else:
            out.append(control)
    return out, left_out


def control_of(name: str, grids: dict[float, Grid]) -> Control | None:
    axes = shared(grids)
    if axes is None:
        return None
    mach, alpha, beta = axes
    changes = {}
    for coefficient in COEFFICIENTS:
        value = lambda grid: np.array([[grid.at(m, a, beta).coefficients.get(coefficient, 0.0) for a in alpha] for m in mach])
        rest = value(grids[0.0])
        changes[coefficient] = np.array([value(grid) - rest for grid in grids.values()])
    return Control(name, list(grids), mach, alpha, changes)
