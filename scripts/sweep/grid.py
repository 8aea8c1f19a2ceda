"""Points of one series on a grid over Mach, alpha and beta, as files of tables want them. Nothing on it is extrapolated or filled in."""

from __future__ import annotations

import itertools
import math
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from functools import cached_property
from operator import itemgetter

import numpy as np

from sweep.database import COEFFICIENTS, Estimate, Point, by_control, in_order
from sweep.errors import SweepError

PITCH_TO_YAW = {  # of a configuration that looks the same from all sides: (yaw, pitch, sign), about its axis
    "CY": ("CN", -1.0), "Cn": ("Cm", -1.0)
}  # fmt: skip
YAW_RATES = {"beta": ("alpha", 1.0), "betadot": ("alphadot", 1.0), "r": ("q", -1.0)}


@dataclass(frozen=True)
class Grid:
    """Converged, undeflected points of a series: one at every combination of the axes, which are sorted; angles in degrees."""

    series: str
    mach: list[float]
    alpha: list[float]
    beta: list[float]
    points: dict[tuple[float, float, float], Point]
    left_out: list[str] = field(default_factory=list)  # what is not on the grid, and why

    @property
    def reference(self) -> dict:
        return next(iter(self.points.values())).result["reference"]

    @property
    def shape(self) -> tuple[int, int, int]:
        return len(self.mach), len(self.alpha), len(self.beta)

    def at(self, mach: float, alpha: float, beta: float) -> Point:
        return self.points[mach, alpha, beta]

    @cached_property
    def ordered(self) -> list[Point]:
        """Its points, the last axis fastest."""
        return [self.points[key] for key in itertools.product(self.mach, self.alpha, self.beta)]

    def values(self, name: str) -> np.ndarray | None:
        """(Mach, alpha, beta) of a coefficient or a derivative; None unless every point has it."""
        if name in COEFFICIENTS:
            return self.array(map(itemgetter(name), [point.coefficients for point in self.ordered]))
        return self.array(entry.value for entry in map(itemgetter(name), [point.derivatives for point in self.ordered]))

    def uncertainties(self, name: str) -> np.ndarray:
        """The same of a derivative that every point has."""
        return self.array(point.derivatives[name].uncertainty for point in self.ordered)

    def array(self, values: Iterable[float]) -> np.ndarray | None:
        try:
            return np.fromiter(values, float, len(self.ordered)).reshape(self.shape)
        except KeyError:
            return None

    @cached_property
    def derivatives(self) -> list[str]:
        """Names of those that every point has."""
        points = iter(self.points.values())
        shared = dict.fromkeys(next(points).derivatives)
        for point in points:
            shared = {name: None for name in shared if name in point.derivatives}
        return in_order(shared)

    @property
    def controls(self) -> list[str]:
        """Names of controls with derivatives that every point has; their rates are none."""
        return [name for name in dict.fromkeys(map(by_control, self.derivatives)) if name and not name.endswith("dot")]

    def nearest_zero(self) -> "Grid":
        """The part of it at the least incidence and sideslip."""
        alpha, beta = min(self.alpha, key=abs), min(self.beta, key=abs)
        kept = {key: point for key, point in self.points.items() if key[1:] == (alpha, beta)}
        return replace(self, alpha=[alpha], beta=[beta], points=kept)


def choose_series(points: list[Point], wanted: str | None) -> str:
    """The series that tables are made of: as wanted, or that with most converged points, linear solves before others, the finest mesh.
    Raises SweepError."""
    count = Counter(point.series for point in points if point.is_good)
    if not count:
        raise SweepError("no run is done and converged: there is nothing to make tables of; see sweep.py status")
    if wanted is not None:
        if wanted not in count:
            raise SweepError(f"no converged run is of the series '{wanted}'; there are {', '.join(count)}")
        return wanted
    cells = {point.series: (bool(point.derivatives), point.result["mesh"]["cells"]) for point in points if point.is_good}
    return max(count, key=lambda series: (cells[series][0], count[series], cells[series][1]))


def make_grid(points: list[Point], series: str, deflections: dict[str, float] | None = None) -> Grid:
    """The largest full grid that is found by leaving out, one after the other, the value of an axis at which most is missing. Raises
    SweepError."""
    turned = {name: value for name, value in (deflections or {}).items() if value}
    own = [point for point in points if point.series == series and not any(point.run.rates.values())]
    own = [point for point in own if {name: value for name, value in point.run.deflections.items() if value} == turned]
    good = {(point.run.mach, round(point.alpha, 9), round(point.beta, 9)): point for point in own if point.is_good}
    left_out = [why_not(point) for point in own if not point.is_good and not point.image]
    axes = [sorted({key[axis] for key in good}) for axis in range(3)]
    present = set(good)
    while len(present) < math.prod(map(len, axes)):
        every = math.prod(map(len, axes))
        counts = [(Counter(key[axis] for key in present), axis) for axis in range(3)]
        filled = [(count[value] * len(axes[axis]) / every, axis, value) for count, axis in counts for value in axes[axis]]
        share, axis, value = min(filled, key=lambda item: (item[0], -abs(item[2])))
        axes[axis].remove(value)
        name = ("Mach", "alpha =", "beta =")[axis]
        left_out.append(f"{name} {value:g}: {1 - share:.0%} of its combinations were not computed or not converged")
        present = {key for key in present if key[axis] != value}
    if not present:
        raise SweepError(f"the converged runs of '{series}' are on no grid over Mach, alpha and beta")
    references = [point.result["reference"] for point in good.values()]
    if len({(of["length"], of["area"], *of["moment_center"]) for of in references}) > 1:
        raise SweepError(f"the runs of '{series}' have different references; give one of their blocks a label")
    return Grid(series, *axes, {key: good[key] for key in present}, left_out)


def why_not(point: Point) -> str:
    """Why a run is not used."""
    loose = [name for name, entry in point.derivatives.items() if not entry.converged]
    detail = point.state.detail or (f"{', '.join(loose)} not converged" if loose else "")
    return f"{point.run.name}: {point.state.phase.value}{': ' if detail else ''}{detail}"


def completed_by_roll(grid: Grid) -> Grid:
    """The side's derivatives from those in pitch; nothing where sideslip is an axis of the grid."""
    if len(grid.beta) > 1:
        return grid
    return replace(grid, points={key: with_side(point) for key, point in grid.points.items()})


def with_side(point: Point) -> Point:
    """The side's derivatives from those in pitch, of a configuration that looks the same from all sides (three or more equal fins, at
    small incidence), unless it has them. At an incidence in the plane of symmetry a sideslip turns the force about the axis:
    CY_beta = -CN / sin(alpha), and -CN_alpha at zero; rates have the value of pitch at the same incidence."""
    if "CY_beta" in point.derivatives:
        return point
    found = dict(point.derivatives)
    for side, (pitch, sign) in PITCH_TO_YAW.items():
        for rate, (own, turn) in YAW_RATES.items():
            source = point.derivatives.get(f"{pitch}_{own}")
            if source is None:
                continue
            value = sign * turn * source.value
            if rate == "beta" and abs(point.alpha) > 1e-6:
                value = sign * point.coefficients[pitch] / math.sin(math.radians(point.alpha))
            found[f"{side}_{rate}"] = Estimate(value, source.uncertainty, source.converged)
    return replace(point, derivatives=found)
