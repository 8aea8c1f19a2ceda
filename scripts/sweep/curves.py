"""Coefficients, derivatives and balance against angle of attack and against Mach number: panels that share one legend."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import matplotlib.pyplot as plt
from matplotlib.colors import to_hex

from sweep.database import Point
from sweep.figures import panel, save
from sweep.page import Key
from sweep.picture import Picture

MOST_LINES = 8  # of one colour scale in a panel; more are a smear
DASHES = ("-", "--", ":", "-.")
BAD = "#b3541e"

Value = Callable[[Point], tuple[float, float]]  # with its uncertainty, NaN where there is none


@dataclass(frozen=True)
class Curve:
    """A quantity of a point."""

    name: str
    symbol: str
    title: str
    value: Value


def coefficient(name: str, symbol: str, title: str) -> Curve:
    return Curve(name, symbol, title, lambda point: (point.coefficients.get(name, math.nan), math.nan))


def derivative(name: str, symbol: str, title: str) -> Curve:
    def value(point: Point) -> tuple[float, float]:
        entry = point.derivatives.get(name)
        return (entry.value, entry.uncertainty) if entry else (math.nan, math.nan)

    return Curve(name, symbol, title, value)


def damping(point: Point) -> tuple[float, float]:
    found = [point.derivatives.get(name) for name in ("Cm_q", "Cm_alphadot")]
    return (sum(entry.value for entry in found), sum(entry.uncertainty for entry in found)) if all(found) else (math.nan, math.nan)


def margin(point: Point) -> tuple[float, float]:
    """Static margin in lengths; its uncertainty as of a quotient whose halves err together the worst way."""
    force, moment = (point.derivatives.get(name) for name in ("CN_alpha", "Cm_alpha"))
    value = point.static_margin
    if not math.isfinite(value):
        return math.nan, math.nan
    return value, (moment.uncertainty + abs(value) * force.uncertainty) / abs(force.value)


def pressure_center(point: Point) -> tuple[float, float]:
    """Lengths from the nose; at zero incidence the neutral point, which it tends to."""
    reference = point.result["reference"]
    at = reference["moment_center"][0] / reference["length"]
    value, error = margin(point) if math.isnan(point.pressure_center) else (point.pressure_center, math.nan)
    return at + value, error


STATIC = (
    coefficient("CN", "$C_N$", "Normal force"),
    coefficient("Cm", "$C_m$", "Pitching moment"),
    Curve("x_cp", "$x_{cp}/l$", "Centre of pressure, from the nose", pressure_center),
    coefficient("CA", "$C_A$", "Axial force"),
    coefficient("CY", "$C_Y$", "Side force"),
    coefficient("Cn", "$C_n$", "Yawing moment"),
    coefficient("Cl", "$C_l$", "Rolling moment"),
)
ASIDE = tuple(curve for curve in STATIC if curve.name in ("CY", "Cn", "Cl", "CN", "Cm", "CA"))
PITCH = (
    derivative("CN_alpha", r"$C_{N\alpha}$", "Normal force"),
    derivative("Cm_alpha", r"$C_{m\alpha}$", "Static moment"),
    Curve("margin", "$(x_n - x_c)/l$", "Static margin", margin),
    derivative("Cm_q", "$C_{mq}$", "Damping by rotation"),
    derivative("Cm_alphadot", r"$C_{m\dot\alpha}$", "Acceleration derivative"),
    Curve("damping", r"$C_{mq} + C_{m\dot\alpha}$", "Pitch damping, the sum", damping),
    coefficient("CA", "$C_A$", "Axial force"),
    Curve("x_cp_mach", "$x_{cp}/l$", "Centre of pressure, from the nose", pressure_center),
)
SIDE = (
    derivative("CY_beta", r"$C_{Y\beta}$", "Side force"),
    derivative("Cn_beta", r"$C_{n\beta}$", "Weathercock stability"),
    derivative("Cl_beta", r"$C_{l\beta}$", "Roll by sideslip"),
    derivative("Cn_r", "$C_{nr}$", "Yaw damping"),
    derivative("Cn_betadot", r"$C_{n\dot\beta}$", "Lag in sideslip"),
    derivative("Cl_p", "$C_{lp}$", "Roll damping"),
    derivative("Cn_p", "$C_{np}$", "Magnus moment, inviscid"),
    derivative("Cl_r", "$C_{lr}$", "Roll by yaw rate"),
)


def few(values: Sequence[float]) -> list[float]:
    """So many of the sorted values as a panel can show, both ends among them."""
    if len(values) <= MOST_LINES:
        return list(values)
    return [values[round(i * (len(values) - 1) / (MOST_LINES - 1))] for i in range(MOST_LINES)]


@dataclass(frozen=True)
class Family:
    """Panels over one variable with a line for each value of another, and a dash for each series."""

    points: list[Point]
    across: str  # "alpha", "beta" or "mach": along the axis
    folder: Path

    @property
    def other(self) -> str:
        return "alpha" if self.across == "mach" else "mach"

    def of(self, point: Point, name: str) -> float:
        return {"mach": point.run.mach, "alpha": point.alpha, "beta": point.beta}[name]

    @property
    def values(self) -> list[float]:
        return sorted({self.of(point, self.other) for point in self.points})

    @property
    def series(self) -> list[str]:
        return list(dict.fromkeys(point.series for point in self.points))

    def color(self, value: float) -> tuple:
        shown = few(self.values)
        return plt.get_cmap("viridis")(0.9 * shown.index(value) / max(1, len(shown) - 1))

    def legend(self) -> list[Key]:
        """One for all panels: colours of values, dashes of series."""
        name = "Mach {:.4g}" if self.other == "mach" else "α = {:.4g}°"
        keys = [Key(name.format(value), to_hex(self.color(value)), "solid") for value in few(self.values)]
        if len(self.series) > 1:
            keys += [Key(name, "#1c2733", ("solid", "dashed", "dotted", "dashed")[i % 4]) for i, name in enumerate(self.series)]
        if any(not point.is_good for point in self.points):
            keys.append(Key("not converged", BAD, "cross"))
        return keys

    def pictures(self, curves: Sequence[Curve]) -> list[Picture]:
        return [picture for curve in curves if (picture := self.draw(curve)) is not None]

    def draw(self, curve: Curve) -> Picture | None:
        """None where nothing is known of the quantity, or all of it is zero, as the lateral loads of a symmetric flow are."""
        found = [(point, *curve.value(point)) for point in self.points]
        found = [item for item in found if math.isfinite(item[1])]
        if len({self.of(point, self.across) for point, *_ in found}) < 2 or max(abs(value) for _, value, _ in found) < 1e-6:
            return None
        names = {"alpha": "angle of attack α, deg", "beta": "sideslip β, deg", "mach": "Mach number"}
        figure, axes = panel(names[self.across], "")
        for number, series in enumerate(self.series):
            for value in few(self.values):
                line = sorted(
                    (self.of(point, self.across), at, error, point.is_good)
                    for point, at, error in found
                    if point.series == series and self.of(point, self.other) == value
                )
                self.draw_line(axes, line, self.color(value), DASHES[number % 4])
        if axes.get_ylim()[0] < 0 < axes.get_ylim()[1]:
            axes.axhline(0.0, color="#202020", lw=0.7)
        axes.set_title(curve.symbol, fontsize=12)
        return save(figure, self.folder, f"{self.across}_{curve.name}", curve.title)

    def draw_line(self, axes: plt.Axes, line: list[tuple[float, float, float, bool]], color: tuple, dash: str) -> None:
        if not line:
            return
        at, values, errors, good = zip(*line)
        bars = [error if math.isfinite(error) else 0.0 for error in errors]
        axes.errorbar(at, values, bars if any(bars) else None, color=color, ls=dash, lw=1.5, marker="o", ms=3, capsize=2, elinewidth=0.8)
        bad = [(x, y) for x, y, is_good in zip(at, values, good) if not is_good]
        if bad:
            axes.plot(*zip(*bad), "X", color=BAD, ms=8, mec="white", zorder=5)


def families(points: list[Point], folder: Path) -> tuple[Family, Family, Family]:
    """Against alpha, against Mach number, and against beta: undeflected points without mirror images, the first two at the least
    sideslip, the last at the least incidence."""
    own = [point for point in points if point.coefficients and not point.image and point.run.is_plain]
    alpha, beta = (min((abs(getattr(point, name)) for point in own), default=0.0) for name in ("alpha", "beta"))
    ahead = [point for point in own if abs(point.beta) == beta]
    aside = [point for point in own if abs(point.alpha) == alpha]
    return Family(ahead, "alpha", folder), Family(ahead, "mach", folder), Family(aside, "beta", folder)
