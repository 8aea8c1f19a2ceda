"""Values and intervals from a family of meshes of one size field.

Errors of a second-order scheme fall with the square of the spacing h, and so does what is left to chance from mesh to mesh. A line
v = a + b h^2 through all meshes, least squares of residuals over h^2, gives at once the value a without spacing, its standard error, and
the scatter s h^2. Some meshes of the family are nearly as fine as each other, `JITTER` apart: what they differ by is scatter. From level
to level the line may be wrong as well, as a singular edge lets errors fall more slowly. So e = hypot(standard error, `TRUST` (a - finest
value)), and as the entries of one run are about equally wrong by their scales, the interval is U = `COVERAGE` hypot(e, s E) with E the
median of e by s. The extrapolated value is given only where the scatter of the coarsest level is below its difference to the finest one;
elsewhere it is the finest mesh's own.
"""

from __future__ import annotations

import math
import statistics
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

FACTORS, JITTER = (0.76, 1.0, 1.18), 0.02  # of the sizes; of the coarsest level a mesh finer and one coarser by this much, too
ORDER = 2
TRUST = 0.6
COVERAGE = 2.0
LEVER = 0.2  # lengths of the body between forces and moments
KINDS = (("alpha", "beta"), ("p", "q", "r"), ("alphadot", "betadot"))
FORCE_OF = {"Cm": "CN", "Cn": "CY"}


@dataclass(frozen=True)
class Member:
    """A mesh of a family: its factor on the sizes, its number of cells, and what was computed on it by the names of derivatives."""

    factor: float
    cells: int
    values: Mapping[str, float]
    solver: Mapping[str, float]  # uncertainty that the solver leaves

    @property
    def spacing(self) -> float:
        """In units of that of a million cells."""
        return (1e6 / self.cells) ** (1.0 / 3.0)


@dataclass(frozen=True)
class Interval:
    """What a family says of a derivative: value +- uncertainty holds the truth in about 95 % of entries.

    `scatter`: standard deviation from mesh to mesh as fine as the finest; `order` observed between the levels, None where there is none;
    `levels`: values of the finest, the middle and the coarsest level.
    """

    value: float
    uncertainty: float
    is_extrapolated: bool
    order: float | None
    scatter: float
    levels: tuple[float, ...]


def family_factors() -> list[float]:
    """The coarsest mesh comes first."""
    coarsest = max(FACTORS)
    jittered = [coarsest * (1.0 + JITTER), coarsest * (1.0 - JITTER)]
    return sorted({round(factor, 4) for factor in (*FACTORS, *jittered)}, reverse=True)


def intervals(members: Sequence[Member], arm: float) -> dict[str, Interval]:
    """Of every derivative that all members have; at least four of at least two levels. `arm`: LEVER body lengths in reference lengths."""
    members = sorted(members, key=lambda member: member.spacing)
    names = [name for name in members[0].values if all(name in member.values for member in members)]
    lines = {name: _Line(members, name) for name in names}
    scales = {name: _scale(name, members[0].values, arm) for name in names}
    relative = _relative_error(lines, scales)
    out = {}
    for name, line in lines.items():
        uncertainty = COVERAGE * math.hypot(line.error, relative * scales[name]) + members[0].solver.get(name, 0.0)
        out[name] = Interval(
            line.at_zero if line.is_resolved else line.levels[0], uncertainty, line.is_resolved, line.order, line.scatter, line.levels
        )
    return out


class _Line:
    """v = a + b h^2 through the members' values of one derivative, the finest member first."""

    def __init__(self, members: Sequence[Member], name: str) -> None:
        h2 = np.array([member.spacing for member in members]) ** ORDER
        values = np.array([member.values[name] for member in members])
        matrix = np.column_stack([1.0 / h2, np.ones(len(h2))])
        (self.at_zero, slope), *_ = np.linalg.lstsq(matrix, values / h2, rcond=None)
        rest = values / h2 - matrix @ [self.at_zero, slope]
        unit = math.sqrt(float(rest @ rest) / (len(values) - 2))  # scatter at h = 1
        deviation = unit * math.sqrt(np.linalg.inv(matrix.T @ matrix)[0, 0])
        finest, coarsest = h2[0], h2[-1]
        is_coarse = h2 > coarsest * (1.0 - 3.0 * JITTER) ** ORDER
        self.levels = (float(values[0]), *(float(v) for v in values[1:][~is_coarse[1:]]), float(values[is_coarse].mean()))
        self.scatter = unit * float(finest)
        difference = abs(self.levels[0] - self.levels[-1])
        self.is_resolved = unit * float(coarsest) < difference
        self.order = _observed_order(self.levels, np.sqrt([*h2[~is_coarse], h2[is_coarse].mean()])) if self.is_resolved else None
        self.at_zero = float(self.at_zero)
        self.error = math.hypot(deviation, TRUST * (self.at_zero - float(values[0])), 0.0 if self.is_resolved else self.scatter)


def _observed_order(levels: Sequence[float], spacings: Sequence[float]) -> float | None:
    """Of three levels, the finest first, that converge monotonically: (v3 - v2) / (v2 - v1) = (h3^p - h2^p) / (h2^p - h1^p)."""
    if len(levels) != 3 or levels[1] == levels[0]:
        return None
    ratio = (levels[2] - levels[1]) / (levels[1] - levels[0])
    fine, middle, coarse = spacings
    misfit = lambda p: (coarse**p - middle**p) / (middle**p - fine**p) - ratio
    low, high = 1e-3, 5.0
    if not misfit(low) < 0.0 < misfit(high):
        return None
    for _ in range(60):
        p = 0.5 * (low + high)
        low, high = (p, high) if misfit(p) < 0.0 else (low, p)
    return p


def _scale(name: str, values: Mapping[str, float], arm: float) -> float:
    """Root mean square of an entry about centres before and behind its own, as far as forces move it."""
    coefficient, _, variable = name.partition("_")
    return math.hypot(values[name], arm * values.get(f"{FORCE_OF.get(coefficient, '')}_{variable}", 0.0))


def _relative_error(lines: Mapping[str, _Line], scales: Mapping[str, float]) -> float:
    """Errors by scales: median of forces and moments by angles, rotations and rates of angles, each as a whole."""
    shares = []
    for variables in KINDS:
        for coefficients in (("CA", "CY", "CN"), ("Cl", "Cm", "Cn")):
            own = [name for c in coefficients for v in variables if (name := f"{c}_{v}") in lines]
            scale = math.hypot(*(scales[name] for name in own))
            if scale > 0.0:
                shares.append(math.hypot(*(lines[name].error for name in own)) / scale)
    return statistics.median(shares) if shares else 0.0
