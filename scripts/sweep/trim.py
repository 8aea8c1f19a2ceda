"""Trim from what a sweep has computed: where a control and the incidence leave no pitching moment about a centre of gravity.

Between the angles computed every quantity is bilinear in incidence and deflection; outside of them nothing is said. A control of which
there are no runs with it deflected, but derivatives by it, is taken as linear up to a stated deflection.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from run_csv import rows_of
from sweep.controls import deflected, shared
from sweep.database import Point, read_points
from sweep.dynamics import about_center
from sweep.errors import SweepError
from sweep.grid import Grid, choose_series, make_grid, why_not
from sweep.plan import Sweep
from sweep.text import aligned

DERIVATIVES = ("CN_alpha", "Cm_alpha", "Cm_q", "Cm_alphadot")
LINEAR = 5.0  # degrees
ZERO = 1e-12  # of a pitching moment that symmetry makes zero


@dataclass(frozen=True)
class Plane:
    """Quantities over incidence and deflection at one Mach number: [alpha][deflection], NaN where a run does not give one."""

    control: str
    mach: float
    alpha: list[float]  # degrees, sorted, as the deflections
    degrees: list[float]
    is_linear: bool  # in the deflection, from derivatives by it
    values: dict[str, np.ndarray] = field(repr=False)

    def trimmed(self, wanted: Sequence[float] = ()) -> list[Trim]:
        """Where Cm = 0: at every incidence and every deflection computed, and at the normal forces wanted; by incidence."""
        moment = self.values["Cm"]
        found: dict[tuple[float, float], Trim] = {}

        def add(i: int, j: int, u: float, v: float) -> None:
            trim = self.at(i, j, u, v)
            found.setdefault((round(trim.alpha, 9), round(trim.degrees, 9)), trim)

        for i, j in np.ndindex(moment.shape):
            for u, v in crossings(moment[i : i + 2, j : j + 2]):
                add(i, j, u, v)
        for target in wanted:
            for i, j in np.ndindex(len(self.alpha) - 1, len(self.degrees) - 1):
                cell = np.s_[i : i + 2, j : j + 2]
                for u, v in common_zeros(moment[cell], self.values["CN"][cell] - target):
                    add(i, j, u, v)
        return sorted(found.values(), key=lambda trim: (trim.alpha, trim.degrees))

    def at(self, i: int, j: int, u: float, v: float) -> Trim:
        """In the cell from alpha[i] and degrees[j] on, u and v from 0 to 1 within it."""
        value = lambda of: float(bilinear(of[i : i + 2, j : j + 2], u, v))
        place = lambda axis, index, share: axis[index] + (share * (axis[index + 1] - axis[index]) if share else 0.0)
        return Trim(self, place(self.alpha, i, u), place(self.degrees, j, v), {name: value(of) for name, of in self.values.items()})


@dataclass(frozen=True)
class Trim:
    """A point of it, with everything known there."""

    plane: Plane
    alpha: float
    degrees: float
    values: dict[str, float]

    @property
    def static_margin(self) -> float:
        return -self.values["Cm_alpha"] / self.values["CN_alpha"]

    @property
    def damping(self) -> float:
        return self.values["Cm_q"] + self.values["Cm_alphadot"]


def bilinear(corners: np.ndarray, u: float, v: float) -> float:
    """Of a cell, or of what is left of one at the end of an axis."""
    across = corners[0] if u == 0.0 else (1.0 - u) * corners[0] + u * corners[1]
    return across[0] if v == 0.0 else (1.0 - v) * across[0] + v * across[1]


def crossings(corners: np.ndarray) -> Iterable[tuple[float, float]]:
    """Zeros on the first two edges of a cell, u and v; its first corner among them."""
    first = corners[0, 0]
    if abs(first) <= ZERO:
        yield 0.0, 0.0
        return
    if corners.shape[0] > 1 and first * corners[1, 0] < 0.0 and abs(corners[1, 0]) > ZERO:
        yield first / (first - corners[1, 0]), 0.0
    if corners.shape[1] > 1 and first * corners[0, 1] < 0.0 and abs(corners[0, 1]) > ZERO:
        yield 0.0, first / (first - corners[0, 1])


def common_zeros(f: np.ndarray, g: np.ndarray) -> list[tuple[float, float]]:
    """Where two bilinear functions, by their values at the corners, are both zero in a cell."""
    terms = lambda c: (c[0, 0], c[1, 0] - c[0, 0], c[0, 1] - c[0, 0], c[1, 1] - c[1, 0] - c[0, 1] + c[0, 0])
    a, b = terms(f), terms(g)
    # f = 0 gives v = -(a0 + a1 u) / (a2 + a3 u), and g = 0 with it a polynomial of u.
    polynomial = [b[1] * a[3] - b[3] * a[1], b[0] * a[3] + b[1] * a[2] - b[2] * a[1] - b[3] * a[0], b[0] * a[2] - b[2] * a[0]]
    out = []
    for root in np.roots(polynomial):
        below = a[2] + a[3] * root.real
        if abs(root.imag) > 1e-9 or not below:
            continue
        u, v = root.real, -(a[0] + a[1] * root.real) / below
        if all(-1e-9 <= share <= 1.0 + 1e-9 for share in (u, v)):
            out.append((min(max(u, 0.0), 1.0), min(max(v, 0.0), 1.0)))
    return out


def planes(points: list[Point], grid: Grid, wanted: Sequence[str], linear: float) -> tuple[list[Plane], list[str]]:
    """Of every control wanted, or of those that were deflected, or of those with derivatives that pitch alone; and what is left out.
    Raises SweepError."""
    turned, left_out = deflected(points, grid)
    names = list(wanted) or list(turned) or [name for name in grid.controls if pitches(grid, name)]
    if not names:
        raise SweepError("trim needs runs with a control deflected, or derivatives by one that pitches alone; see --control")
    unknown = [name for name in names if name not in turned and name not in grid.controls]
    if unknown:
        known = ", ".join(dict.fromkeys([*turned, *grid.controls])) or "none"
        raise SweepError(f"there is no control '{unknown[0]}' in series '{grid.series}'; there are {known}")
    out: list[Plane] = []
    for name in names:
        if name not in turned:
            out += by_derivatives(grid, name, linear)
            left_out.append(f"{name}: no run has it deflected; linear, up to {linear:g} degrees, stability and damping as at rest")
            continue
        axes = shared(turned[name])
        if axes is None:
            left_out.append(f"{name}: nothing in common with the runs at rest")
            continue
        every, (machs, alpha, beta) = turned[name], axes
        for mach in machs:
            at = [[grid.at(mach, a, beta) for grid in every.values()] for a in alpha]
            panels = dict.fromkeys(panel for row in at for point in row for panel in point.panels)
            values = {quantity: array(at, lambda point: number(point, quantity)) for quantity in ("CN", "CA", "Cm", *DERIVATIVES)}
            values |= {f"Ch@{panel}": array(at, lambda point: point.panels.get(panel, {}).get("Ch", math.nan)) for panel in panels}
            out.append(Plane(name, mach, alpha, list(every), False, values))
    return out, left_out


def pitches(grid: Grid, control: str) -> bool:
    """Does it move the pitching moment, and those of the side by less than a hundredth of that?"""
    of = lambda name: 0.0 if (values := grid.values(f"{name}_{control}")) is None else float(np.abs(values).max())
    return of("Cm") > 100.0 * max(of("Cl"), of("Cn"), 1e-9)


def by_derivatives(grid: Grid, control: str, linear: float) -> list[Plane]:
    """A control at rest and at both ends of what counts as linear."""
    beta, steps = min(grid.beta, key=abs), (-linear, 0.0, linear)
    out = []
    for mach in grid.mach:
        points = [grid.at(mach, a, beta) for a in grid.alpha]
        slopes = [panel_slopes(point, control) for point in points]
        panels = dict.fromkeys(panel for own in slopes for panel in own)

        def spread(at: list[float], by: list[float]) -> np.ndarray:
            return np.array([[value + math.radians(step) * slope for step in steps] for value, slope in zip(at, by)])

        values = {
            name: spread([number(point, name) for point in points], [number(point, f"{name}_{control}") for point in points])
            for name in ("CN", "CA", "Cm")
        }
        values |= {name: spread([number(point, name) for point in points], [0.0] * len(points)) for name in DERIVATIVES}
        values |= {
            f"Ch@{panel}": spread(
                [point.panels.get(panel, {}).get("Ch", math.nan) for point in points], [own.get(panel, math.nan) for own in slopes]
            )
            for panel in panels
        }
        out.append(Plane(control, mach, grid.alpha, list(steps), True, values))
    return out


def panel_slopes(point: Point, control: str) -> dict[str, float]:
    """Of every panel's hinge moment by a control, per radian."""
    try:
        rows = rows_of(point.run.folder / "panels.csv")
    except OSError:
        return {}
    return {row["panel"]: float(row["value"]) for row in rows if row["name"] == f"Ch_{control}"}


def array(points: list[list[Point]], value) -> np.ndarray:
    return np.array([[value(point) for point in row] for row in points])


def number(point: Point, name: str) -> float:
    """A coefficient or a derivative; what symmetry makes zero is in none of them."""
    if name in point.coefficients:
        return point.coefficients[name]
    if name in point.derivatives:
        return point.derivatives[name].value
    return 0.0 if name.startswith("CA_") else math.nan


@dataclass(frozen=True)
class Request:
    """What is to be trimmed, and how."""

    series: str | None = None
    controls: Sequence[str] = ()
    normal_forces: Sequence[float] = ()  # CN at which it is wanted
    centers: Sequence[float | list[float]] = ()  # in the mesh's unit; none: those of [[mass]], or the runs' own
    linear: float = LINEAR


SHOWN = (  # of a row: name, heading for the eye, format
    ("state", "centre", ""), ("control", "control", ""), ("mach", "Mach", ".4g"), ("deflection", "deflection, deg", "z.3f"),
    ("alpha", "alpha, deg", "z.3f"), ("CN", "CN", "z.4f"), ("CA", "CA", ".4f"), ("static_margin", "margin", ".3f"), ("Cm_q", "Cm_q", ".1f"),
    ("Cm_alphadot", "Cm_alphadot", ".1f"), ("Cm_q_plus_Cm_alphadot", "sum", ".1f"),
)  # fmt: skip
NAMES = tuple(name for name, *_ in SHOWN) + ("linear",)


def trim(sweep: Sweep, program: Path, request: Request) -> tuple[list[dict], list[str]]:
    """A row a trimmed point, by centre, control, Mach number and incidence; and what is not there and why. Raises SweepError."""
    points = [point for point in read_points(sweep) if point.coefficients and not point.image]
    series = choose_series(points, request.series)
    good = [point for point in points if point.series == series]
    rows: list[dict] = []
    notes = [why_not(point) for point in good if not point.is_good]
    for label, center in centers(sweep, request):
        moved = good if center is None else about(sweep, program, good, center)
        grid = make_grid(moved, series)
        found, left_out = planes(moved, grid, request.controls, request.linear)
        notes += [*grid.left_out, *left_out]
        for plane in found:
            trims = plane.trimmed(request.normal_forces)
            rows += [row_of(label, trim) for trim in trims]
            notes += missing(label, plane, trims, request.normal_forces)
    return rows, list(dict.fromkeys(notes))


def centers(sweep: Sweep, request: Request) -> list[tuple[str, float | list[float] | None]]:
    """Each with its name."""
    if request.centers:
        names = [f"x = {at:g}" if isinstance(at, float) else f"x, y, z = {', '.join(f'{x:g}' for x in at)}" for at in request.centers]
        return list(zip(names, request.centers))
    states = sweep.content.get("mass", [])
    return [(state.get("label", f"state {i}"), state["center"]) for i, state in enumerate(states, 1)] or [("centre of the runs", None)]


def about(sweep: Sweep, program: Path, points: list[Point], center: float | list[float]) -> list[Point]:
    """Points about a centre; those without derivatives are not moved by the program, and left out."""
    good = [point for point in points if point.is_good and point.derivatives]
    if not good:
        raise SweepError("moments are moved to other centres with their derivatives, and no converged run has any")
    return about_center(sweep, program, good, center)


def row_of(label: str, trim: Trim) -> dict:
    known, plane = trim.values, trim.plane
    values = (
        label, plane.control, plane.mach, trim.degrees, trim.alpha, known["CN"], known["CA"], trim.static_margin, known["Cm_q"],
        known["Cm_alphadot"], trim.damping, "yes" if plane.is_linear else "no",
    )  # fmt: skip
    return dict(zip(NAMES, values)) | {name: value for name, value in known.items() if name.startswith("Ch@")}


def missing(label: str, plane: Plane, trims: list[Trim], wanted: Sequence[float]) -> list[str]:
    """What was asked for and is not within what was computed."""
    at = f"{label}, {plane.control}, Mach {plane.mach:g}"
    span = lambda values: f"{min(values):.4g} to {max(values):.4g}"
    if not trims:
        inside = f"alpha {span(plane.alpha)}, deflection {span(plane.degrees)} degrees"
        return [f"{at}: no trim within {inside}: Cm is {span(plane.values['Cm'].ravel())}"]
    forces = [trim.values["CN"] for trim in trims]
    reached = lambda target: any(math.isclose(force, target, rel_tol=1e-9, abs_tol=1e-12) for force in forces)
    without = [target for target in wanted if not reached(target)]
    return [f"{at}: CN = {target:g} is not trimmed within what was computed: CN is {span(forces)}" for target in without]


def text(rows: list[dict], notes: list[str]) -> str:
    """Tables for the eye, one a centre."""
    out = []
    for label in dict.fromkeys(row["state"] for row in rows):
        head, values, forms = shown([row for row in rows if row["state"] == label])
        cells = [list(map(cell, own, forms)) for own in values]
        title = f"{label}: Cm = 0; derivatives per rad, margin in lengths, Ch of hinges"
        out += [title, aligned([head[1:], *(own[1:] for own in cells)]), ""]
    return "\n".join([*out, *notes])


def shown(rows: list[dict]) -> tuple[list[str], list[list], list[str]]:
    """For the eye: headings, values and how they are written; nothing of what no row knows."""
    columns = [*SHOWN, *((name, name, ".4f") for name in hinge_names(rows))]
    columns = [own for own in columns if any(isinstance(row.get(own[0]), str) or math.isfinite(row.get(own[0], math.nan)) for row in rows)]
    return [head for _, head, _ in columns], [[row.get(name) for name, _, _ in columns] for row in rows], [form for *_, form in columns]


def cell(value: str | float | None, form: str) -> str:
    if value is None or isinstance(value, str):
        return value or "-"
    return format(value, form) if math.isfinite(value) else "-"


def hinge_names(rows: list[dict]) -> list[str]:
    return list(dict.fromkeys(name for row in rows for name in row if name.startswith("Ch@")))


def write_csv(path: Path, rows: list[dict], notes: list[str]) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    names = [*NAMES, *hinge_names(rows)]
    with open(path, "w", newline="") as file:
        file.write("# Trim: Cm = 0 about each centre; degrees, derivatives per rad, rates times length / 2V, margin in lengths.\n")
        file.write("# Bilinear between the angles computed; Ch@PANEL: hinge moment of a panel; linear: from derivatives by the control.\n")
        file.writelines(f"# {note}\n" for note in notes)
        writer = csv.DictWriter(file, names, lineterminator="\n")
        writer.writeheader()
        known = lambda value: isinstance(value, str) or math.isfinite(value)
        writer.writerows({name: value for name, value in row.items() if known(value)} for row in rows)
