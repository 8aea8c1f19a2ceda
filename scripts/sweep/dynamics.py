"""Motions of a body in flight from its derivatives: short period, weathercock and roll, about its centre of gravity.

Small disturbances of a straight path without thrust at constant speed V, about an incidence alpha (Etkin and Reid, Dynamics of Flight,
ch. 6; Murphy, Free Flight Motion of Symmetric Missiles, BRL 1216, without spin). With k = q S / (m V) and t = l / 2V:

  alpha' = q - k (CL_alpha alpha + CL_alphadot t alpha' + CL_q t q)
  q' = (q S l / Iyy) (Cm_alpha alpha + Cm_alphadot t alpha' + Cm_q t q)

and the same in yaw with beta' = -r + k (...), r' = ..., where CL_alpha = CN_alpha - CA at alpha = 0. Roll: p' = (q S l / Ixx) Cl_p t p.
"""

from __future__ import annotations

import cmath
import csv
import math
from dataclasses import dataclass, replace
from pathlib import Path

from sweep.atmosphere import air_at
from sweep.database import Estimate, Point, read_points
from sweep.derive import Runs
from sweep.errors import SweepError
from sweep.grid import with_side
from sweep.plan import Sweep
from sweep.state import RESULT
from sweep.text import aligned


@dataclass(frozen=True)
class Mode:
    """x'' + 2 zeta omega x' + omega^2 x = 0: frequency without damping (rad/s; NaN where it diverges without swinging), damping ratio,
    and the real part of the slowest root (1/s), positive where it grows."""

    omega: float
    zeta: float
    growth: float

    @staticmethod
    def of(trace: float, determinant: float) -> Mode:
        root = cmath.sqrt(0.25 * trace**2 - determinant)
        growth = max((0.5 * trace + root).real, (0.5 * trace - root).real)
        omega = math.sqrt(determinant) if determinant > 0.0 else math.nan
        return Mode(omega, -0.5 * trace / omega if determinant > 0.0 else math.nan, growth)


UNKNOWN = Mode(math.nan, math.nan, math.nan)


@dataclass(frozen=True)
class Flight:
    """What turns coefficients into accelerations; SI units."""

    speed: float
    pressure: float  # dynamic
    length: float
    area: float
    mass: float
    inertia: tuple[float, float, float]

    @property
    def t(self) -> float:
        return 0.5 * self.length / self.speed

    def planar(self, force: dict[str, float], moment: dict[str, float], inertia: float) -> Mode:
        """Of an angle and its rate of rotation, by coefficients that resist the angle: force and moment by angle, its rate, rotation."""
        k = self.pressure * self.area / (self.mass * self.speed)
        m = self.pressure * self.area * self.length / inertia
        lag = 1.0 + k * self.t * force["dot"]
        a_a, a_q = -k * force["angle"] / lag, (1.0 - k * self.t * force["rate"]) / lag
        q_a = m * (moment["angle"] + self.t * moment["dot"] * a_a)
        q_q = m * self.t * (moment["rate"] + moment["dot"] * a_q)
        return Mode.of(a_a + q_q, a_a * q_q - a_q * q_a)


def short_period(point: Point, flight: Flight) -> tuple[Mode, float]:
    """In pitch; and the value below which Cm_q + Cm_alphadot damps it."""
    known = point.derivatives
    if not {"CN_alpha", "Cm_alpha", "Cm_q"} <= known.keys():
        return UNKNOWN, math.nan
    value = lambda name: known[name].value if name in known else 0.0
    c, s = math.cos(math.radians(point.alpha)), math.sin(math.radians(point.alpha))
    drag = point.coefficients["CA"] * c + point.coefficients["CN"] * s
    lift = lambda variable: value(f"CN_{variable}") * c - value(f"CA_{variable}") * s
    force = {"angle": lift("alpha") - drag, "dot": lift("alphadot"), "rate": lift("q")}
    moment = {"angle": value("Cm_alpha"), "dot": value("Cm_alphadot"), "rate": value("Cm_q")}
    limit = 2.0 * flight.inertia[1] / (flight.mass * flight.length**2) * force["angle"]
    return flight.planar(force, moment, flight.inertia[1]), limit


def weathercock(point: Point, flight: Flight) -> Mode:
    """In yaw: with the angle -beta and the rotation r it is like pitch."""
    known = point.derivatives
    if not {"CY_beta", "Cn_beta", "Cn_r"} <= known.keys():
        return UNKNOWN
    value = lambda name: known[name].value if name in known else 0.0
    force = {"angle": -value("CY_beta") - point.coefficients["CA"], "dot": -value("CY_betadot"), "rate": value("CY_r")}
    moment = {"angle": -value("Cn_beta"), "dot": -value("Cn_betadot"), "rate": value("Cn_r")}
    return flight.planar(force, moment, flight.inertia[2])


def roll_rate(point: Point, flight: Flight) -> float:
    """The root of the roll mode, 1/s; NaN where Cl_p is not known."""
    known = point.derivatives.get("Cl_p")
    return math.nan if known is None else flight.pressure * flight.area * flight.length / flight.inertia[0] * flight.t * known.value


def about_center(sweep: Sweep, program: Path, points: list[Point], center: float | list[float]) -> list[Point]:
    """The same points with moments and rates about another centre, moved by the program."""
    runs = Runs(program, [])
    out = []
    for start in range(0, len(points), 500):  # a command line has its limits
        part = points[start : start + 500]
        items = runs.derive([point.run.folder / RESULT for point in part], center)
        for point, item in zip(part, items, strict=True):
            derivatives = {name: Estimate.of(entry) for name, entry in item["derivatives"].items()}
            loads = {name: values[0] for name, values in item["loads"].items()}
            moved = replace(point, coefficients=loads, derivatives=derivatives)
            out.append(with_side(moved) if sweep.is_axial else moved)
    return out


NAMES = (
    "state", "run", "mach", "alpha", "beta", "altitude_m", "V_m_s", "q_Pa", "static_margin", "Cm_alpha", "Cm_q", "Cm_alphadot",
    "Cm_q_plus_Cm_alphadot", "limit", "pitch_omega_rad_s", "pitch_zeta", "pitch_growth_1_s", "yaw_omega_rad_s", "yaw_zeta",
    "yaw_growth_1_s", "roll_root_1_s",
)  # fmt: skip


def dynamics(sweep: Sweep, program: Path) -> tuple[str, list[dict]]:
    """A text with a table a state of mass and the warnings, and all rows. Raises SweepError."""
    states = sweep.content.get("mass", [])
    if not states:
        wanted = "mass (kg), inertia = [Ixx, Iyy, Izz] (kg m2), center (of gravity, x in the mesh's unit)"
        raise SweepError(f"{sweep.file}: dynamics need [[mass]]: {wanted}")
    points = [point for point in read_points(sweep) if point.derivatives and not point.image and point.run.is_plain]
    good = [point for point in points if point.is_good]
    if not good:
        raise SweepError(f"{sweep.file}: no run with derivatives is done and converged; see sweep.py status")
    rows: list[dict] = []
    text = []
    for number, state in enumerate(states, 1):
        label = state.get("label", f"state {number}")
        moved = about_center(sweep, program, good, state["center"])
        own = [row_of(sweep, label, state, point, altitude) for point in moved for altitude in sweep.altitudes or [0.0]]
        rows += own
        text += [heading(label, state), aligned(shown(own)), ""]
    warned = list(dict.fromkeys(line for row in rows for line in warnings(row)))
    left = [f"left out: {point.run.name}: {point.state.detail}" for point in points if not point.is_good]
    return "\n".join([*text, *left, *warned]), rows


def heading(label: str, state: dict) -> str:
    inertia = ", ".join(f"{value:g}" for value in state["inertia"])
    return f"{label}: {state['mass']:g} kg, inertia ({inertia}) kg m2, centre of gravity {state['center']}"


def row_of(sweep: Sweep, label: str, state: dict, point: Point, altitude: float) -> dict:
    air, reference = air_at(altitude), point.result["reference"]
    speed = point.run.mach * air.sound_speed
    flight = Flight(
        speed, 0.5 * air.density * speed**2, reference["length"] * sweep.unit, reference["area"] * sweep.unit**2, state["mass"],
        tuple(state["inertia"]),
    )  # fmt: skip
    value = lambda name: point.derivatives[name].value if name in point.derivatives else math.nan
    pitch, limit = short_period(point, flight)
    yaw = weathercock(point, flight)
    values = (
        label, point.run.name, point.run.mach, point.alpha, point.beta, altitude, speed, flight.pressure, point.static_margin,
        value("Cm_alpha"), value("Cm_q"), value("Cm_alphadot"), value("Cm_q") + value("Cm_alphadot"), limit,
        pitch.omega, pitch.zeta, pitch.growth, yaw.omega, yaw.zeta, yaw.growth, roll_rate(point, flight),
    )  # fmt: skip
    return dict(zip(NAMES, values))


def shown(rows: list[dict]) -> list[list[str]]:
    """Rows for the eye: frequencies in Hz; sideslip where there is any."""
    aside = any(row["beta"] for row in rows)
    head = ["Mach", "alpha", *["beta"] * aside, "altitude, m", "margin, l", "Cm_q", "Cm_alphadot", "sum", "damped below"]
    head += ["pitch, Hz", "zeta", "yaw, Hz", "zeta", "roll, s"]
    cell = lambda value, form: "-" if not math.isfinite(value) else format(value, form)
    out = [head]
    for row in rows:
        hertz = [row[name] / (2.0 * math.pi) for name in ("pitch_omega_rad_s", "yaw_omega_rad_s")]
        roll = -1.0 / row["roll_root_1_s"] if row["roll_root_1_s"] else math.nan
        values = (row["mach"], row["alpha"], *[row["beta"]] * aside, row["altitude_m"], row["static_margin"], row["Cm_q"], row["Cm_alphadot"])
        values += (row["Cm_q_plus_Cm_alphadot"], row["limit"], hertz[0], row["pitch_zeta"], hertz[1], row["yaw_zeta"], roll)
        forms = ("g", "g", *["g"] * aside, "g", ".2f", ".1f", ".1f", ".1f", ".1f", ".3g", ".4f", ".3g", ".4f", ".3g")
        out.append([cell(value, form) for value, form in zip(values, forms)])
    return out


def warnings(row: dict) -> list[str]:
    """What a designer must not overlook."""
    at = f"{row['state']}, {row['run']}"
    high = f"{at} at {row['altitude_m']:g} m"
    out = []
    if row["static_margin"] < 0.0:
        before = f"the neutral point is {-row['static_margin']:.2f} lengths before the centre of gravity"
        out.append(f"warning: {at}: statically unstable, {before}")
    for name, mode in (("pitch", "short period"), ("yaw", "weathercock mode")):
        if row[f"{name}_growth_1_s"] > 0.0 and not (name == "pitch" and row["static_margin"] < 0.0):
            out.append(f"warning: {high}: the {mode} grows, damping ratio {row[f'{name}_zeta']:.4f}")
    if row["roll_root_1_s"] > 0.0:
        out.append(f"warning: {at}: Cl_p is positive, roll is driven")
    total, rotation, lag = (row[name] for name in ("Cm_q_plus_Cm_alphadot", "Cm_q", "Cm_alphadot"))
    if total > 0.0:
        out.append(f"warning: {at}: Cm_q + Cm_alphadot = {total:+.1f}: pitching is not damped by moments")
    elif lag > 0.0 > rotation:
        out.append(f"note: {at}: Cm_alphadot = {lag:+.1f} takes {-100 * lag / rotation:.2g} % of the damping by Cm_q away")
    return out


def write_csv(path: Path, rows: list[dict]) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    with open(path, "w", newline="") as file:
        file.write(f"# {__doc__.splitlines()[0]} Per radian, rates times length / 2V; margins in lengths; growth: real part of the root.\n")
        writer = csv.DictWriter(file, NAMES, lineterminator="\n")
        writer.writeheader()
        known = lambda value: not (isinstance(value, float) and math.isnan(value))
        writer.writerows({key: value for key, value in row.items() if known(value)} for row in rows)
