"""All results of a sweep as points: condition, coefficients, derivatives with their uncertainty, components, and how the run ended."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cache, cached_property
from operator import itemgetter
from typing import NamedTuple

from sweep.plan import Run, Sweep
from sweep.state import RESULT, Phase, State, read_json, read_state

COEFFICIENTS = ("CA", "CY", "CN", "Cl", "Cm", "Cn")
VARIABLES = ("alpha", "beta", "p", "q", "r", "alphadot", "betadot", "alphaddot", "betaddot", "q_plus_alphadot", "r_minus_betadot")
NAMES = tuple(f"{coefficient}_{variable}" for variable in VARIABLES for coefficient in COEFFICIENTS)
KNOWN = frozenset(NAMES)
STREAM = ("mach", "gamma")  # what adjoints also differentiate by
SIDE = ("CY_beta", "Cn_beta", "Cl_beta", "Cn_r", "Cn_betadot", "Cl_p", "Cn_p", "Cl_r")  # of the motion out of the plane of symmetry
# What changes its sign in the mirror image about y = 0 and about z = 0; a derivative where one of its two halves does.
ODD = {
    "y": {"CY", "Cl", "Cn", "beta", "p", "r", "betadot", "betaddot", "r_minus_betadot"},
    "z": {"CN", "Cl", "Cm", "alpha", "p", "q", "alphadot", "alphaddot", "q_plus_alphadot"},
}


def by_control(name: str) -> str | None:
    """The control of a derivative's name, CN_tail_pitch; None where it is one by a flight variable, or none of the whole configuration."""
    coefficient, _, variable = name.partition("_")
    other = coefficient in COEFFICIENTS and variable.isidentifier() and name not in KNOWN and variable not in STREAM
    return variable if other else None


@cache
def known(name: str) -> str | None:
    """The name of a derivative, the same object wherever it stands; None for what a table of derivatives has no place for."""
    return name if name in KNOWN or by_control(name) else None


def group(name: str) -> str:
    """longitudinal, lateral, cross (loads out of the plane of symmetry by variables in it, and the reverse) or controls."""
    if by_control(name):
        return "controls"
    coefficient, variable = (word in ODD["y"] for word in name.split("_", 1))
    return "cross" if coefficient != variable else "lateral" if coefficient else "longitudinal"


def in_order(names: Iterable[str]) -> list[str]:
    """Names of derivatives as tables have them: by flight variables, then by controls as they come."""
    found = dict.fromkeys(names)
    return [name for name in NAMES if name in found] + [name for name in found if by_control(name)]


class Estimate(NamedTuple):
    """A derivative, per radian, rates times length / 2V; its uncertainty is a half width, NaN where it is not known."""

    value: float
    uncertainty: float = math.nan
    converged: bool = True
    parts: Mapping[str, float | None] = {}  # of the uncertainty, by source

    @staticmethod
    def of(entry: dict) -> Estimate:
        try:
            found = tuple.__new__(Estimate, OF_ENTRY(entry))  # there may be hundreds of thousands
        except KeyError:
            found = Estimate(entry["value"], entry["uncertainty"], entry.get("converged", True), entry.get("parts", {}))
        return found._replace(uncertainty=math.nan) if found.uncertainty is None else found


OF_ENTRY = itemgetter(*Estimate._fields)


@dataclass(frozen=True)
class Point:
    """A run at its condition, or its mirror image; without a result everything that comes from one is empty."""

    run: Run
    state: State
    alpha: float  # degrees
    beta: float
    image: str  # planes in which it is mirrored: "", "y", "z" or "yz"
    coefficients: dict[str, float]
    derivatives: dict[str, Estimate]
    components: dict[str, dict[str, float]]
    result: dict

    @cached_property
    def is_good(self) -> bool:
        """Did everything come to what was asked for?"""
        return self.state.phase is Phase.DONE and all(entry.converged for entry in self.derivatives.values())

    @property
    def series(self) -> str:
        """Runs of one series differ in their conditions, rotations and deflections alone."""
        return " ".join(word for word in (self.run.label, self.run.mesh) if word)

    @property
    def panels(self) -> dict[str, dict[str, float]]:
        """Loads of controls' panels, each by itself: CNp, Ch, Cb, x_cp, s_cp."""
        return {} if self.image else self.result.get("forces", {}).get("panels", {})

    @property
    def is_deflected(self) -> bool:
        return any(self.run.deflections.values())

    @property
    def static_margin(self) -> float:
        """In lengths behind the centre; NaN where it is not known."""
        found = [self.derivatives.get(name) for name in ("CN_alpha", "Cm_alpha")]
        return -found[1].value / found[0].value if all(found) and found[0].value else math.nan

    @property
    def pressure_center(self) -> float:
        """Of the normal force, in lengths behind the centre; NaN where there is no incidence or no force to speak of."""
        force, moment = self.coefficients.get("CN"), self.coefficients.get("Cm")
        return math.nan if not force or moment is None or abs(self.alpha) < 1e-6 else -moment / force


def read_points(sweep: Sweep) -> list[Point]:
    """A point a run, in their order, and then the mirror images that the symmetry of the sweep tells."""
    points = list(map(point_of, sweep.runs))
    return points + (list(images(points, sweep.symmetry)) if sweep.symmetry else [])


def point_of(run: Run) -> Point:
    result = read_json(f"{run.folder}/{RESULT}")
    state = read_state(run, result)
    if state.phase not in (Phase.DONE, Phase.SHORT):
        return Point(run, state, run.alpha, run.beta, "", {}, {}, {}, {})
    forces = result.get("forces", {})
    return Point(
        run,
        state,
        run.alpha,
        run.beta,
        "",
        {name: forces[name] for name in COEFFICIENTS if forces.get(name) is not None},
        {
            own: Estimate.of(entry)
            for name, entry in result.get("derivatives", {}).items()
            if entry["value"] is not None and (own := known(name))
        },
        forces.get("components", {}),
        result,
    )


def images(points: Iterable[Point], planes: set[str]) -> Iterable[Point]:
    """Mirror images of plain points, but for conditions that were computed."""
    points = list(points)
    known = {(point.series, point.run.method, point.run.mach, round(point.alpha, 9), round(point.beta, 9)) for point in points}
    for kind in ("y", "z", "yz"):
        for point in points if set(kind) <= planes else []:
            alpha = -point.alpha if "z" in kind else point.alpha
            beta = -point.beta if "y" in kind else point.beta
            key = (point.series, point.run.method, point.run.mach, round(alpha, 9), round(beta, 9))
            if not point.run.is_plain or not point.coefficients or key in known:
                continue
            known.add(key)
            yield mirrored(point, kind, alpha + 0.0, beta + 0.0)


def mirrored(point: Point, kind: str, alpha: float, beta: float) -> Point:
    """The patches and the controls of a mirror image have other names, and are left out."""

    def sign(*words: str) -> float:
        return math.prod(-1.0 for plane in kind for word in words if word in ODD[plane])

    coefficients = {name: sign(name) * value + 0.0 for name, value in point.coefficients.items()}
    derivatives = {
        name: entry._replace(value=sign(*name.split("_", 1)) * entry.value + 0.0)
        for name, entry in point.derivatives.items()
        if not by_control(name)
    }
    return replace(point, alpha=alpha, beta=beta, image=kind, coefficients=coefficients, derivatives=derivatives, components={})
