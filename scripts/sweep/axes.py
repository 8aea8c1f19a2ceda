"""Axes of a sweep: values as a number, a list, a range or the columns of a CSV file; total incidence and roll angle as alpha and beta."""

from __future__ import annotations

import csv
import itertools
import math
from collections.abc import Mapping
from pathlib import Path

from sweep.errors import SweepError

WORDS = ("mesh", "method")
RATES = ("p", "q", "r")  # of a steady turn, times length / 2V
NUMBERS = (*RATES, "alpha", "beta", "alpha_t", "phi", "mach")
AXES = (*WORDS, *NUMBERS)  # in the order in which they multiply, the last fastest; deflections between mesh and method
BODY_ANGLES, TOTAL_ANGLES = ("alpha", "beta"), ("alpha_t", "phi")
MOST = 100_000  # values of a range


def from_total(alpha_t: float, phi: float) -> tuple[float, float]:
    """Angles of attack and sideslip, degrees, of a body that meets the wind at the total incidence alpha_t with its cross-flow at the
    roll angle phi: (u, v, w) = V (cos alpha_t, sin alpha_t sin phi, sin alpha_t cos phi) on axes forward, starboard and down. At
    phi = 0 all of it is alpha, at 90 all is beta."""
    t, f = math.radians(alpha_t), math.radians(phi)
    alpha = math.degrees(math.atan2(math.sin(t) * math.cos(f), math.cos(t)))
    beta = math.degrees(math.asin(math.sin(t) * math.sin(f)))
    return round(alpha, 12) + 0.0, round(beta, 12) + 0.0  # cos 90 deg is not quite 0 on a computer


def to_total(alpha: float, beta: float) -> tuple[float, float]:
    """Total incidence and roll angle of the cross-flow, degrees: the inverse of from_total, phi from -180 to 180, 0 along the wind."""
    a, b = math.radians(alpha), math.radians(beta)
    forward, starboard, down = math.cos(a) * math.cos(b), math.sin(b), math.sin(a) * math.cos(b)
    across = math.hypot(starboard, down)
    return math.degrees(math.atan2(across, forward)), math.degrees(math.atan2(starboard, down)) if across > 0.0 else 0.0


def is_number(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def numbers(where: str, key: str, value: object) -> list[float]:
    """The values of an axis: 2, [1.5, 2], {from = 0, to = 10, step = 2.5} or {from = 0, to = 10, count = 5}. Raises SweepError."""
    if isinstance(value, dict):
        return spread(where, key, value)
    values = value if isinstance(value, list) else [value]
    if not values or not all(map(is_number, values)):
        some = "a number, a list of them or a range such as {from = 0, to = 10, step = 2}"
        raise SweepError(f"{where}: {key} must be {some}, not {value!r}")
    return [float(item) for item in values]


def spread(where: str, key: str, value: dict) -> list[float]:
    """The values of a range, both ends among them."""
    if value.keys() not in ({"from", "to", "step"}, {"from", "to", "count"}) or not all(map(is_number, value.values())):
        raise SweepError(f"{where}: {key}: a range has from, to, and either step or count, all of them numbers, not {value!r}")
    first, last = float(value["from"]), float(value["to"])
    if "count" in value:
        steps = value["count"] - 1
        if not isinstance(steps, int) or steps < 1:
            raise SweepError(f"{where}: {key}: count is {value['count']!r}; a range has two values or more")
    else:
        step = float(value["step"])
        steps = round((last - first) / step) if step else 0
        if steps < 1 or abs(first + steps * step - last) > 1e-6 * abs(step):
            raise SweepError(f"{where}: {key}: steps of {step:g} do not lead from {first:g} to {last:g}")
    if steps > MOST:
        raise SweepError(f"{where}: {key}: has {steps + 1:,} values")
    return [round(first + (last - first) * i / steps, 10) for i in range(steps + 1)]


def words(where: str, key: str, value: object) -> list[str]:
    values = value if isinstance(value, list) else [value]
    if not values or not all(isinstance(item, str) for item in values):
        raise SweepError(f"{where}: {key} must be text or a list of it, not {value!r}")
    return values


def matrix(file: Path, controls: Mapping[str, object]) -> list[dict]:
    """The rows of a CSV file whose first line names axes or controls. Raises SweepError."""
    known = (*AXES, *controls)
    try:
        with open(file, newline="") as lines:
            table = csv.reader((line for line in lines if line.strip() and not line.lstrip().startswith("#")), skipinitialspace=True)
            names = [name.strip() for name in next(table, [])]
            unknown = [name for name in names if name not in known]
            if not names or unknown:
                raise SweepError(f"{file}: its first line must name axes, of {', '.join(known)}; not {', '.join(unknown) or 'nothing'}")
            return [row_of(file, number, names, row) for number, row in enumerate(table, 1)]
    except (OSError, UnicodeDecodeError) as error:
        raise SweepError(f"{file}: {getattr(error, 'strerror', None) or 'is not a text file'}") from None


def row_of(file: Path, number: int, names: list[str], row: list[str]) -> dict:
    if len(row) != len(names):
        raise SweepError(f"{file}: row {number} has {len(row)} cells under {len(names)} names")
    out: dict = {}
    for name, text in zip(names, row):
        try:
            out[name] = text.strip() if name in WORDS else float(text)
        except ValueError:
            raise SweepError(f"{file}: row {number}: {name} is '{text.strip()}', not a number") from None
    return out


def points(where: str, block: dict, rows: list[dict], controls: Mapping[str, object]) -> list[dict]:
    """Every combination of the lists of a block, for each row of its matrix; a column of the matrix takes the place of a list.

    Each has mesh, method, mach, alpha and beta; alpha_t and phi where they are given; and `deflection`, degrees by control. Raises
    SweepError.
    """
    lists = {"mesh": [""], "method": ["derivatives"], "alpha": [0.0], "beta": [0.0]}
    if any(key in block for key in TOTAL_ANGLES) or any(key in row for key in TOTAL_ANGLES for row in rows[:1]):
        del lists["alpha"], lists["beta"]
        lists |= {"alpha_t": [0.0], "phi": [0.0]}
    lists |= {key: words(where, key, block[key]) for key in WORDS if key in block}
    lists |= {key: numbers(where, key, block[key]) for key in NUMBERS if key in block}
    turned = block.get("deflection", {})
    if not isinstance(turned, dict) or turned.keys() - controls.keys():
        raise SweepError(f"{where}: deflection must be a table of controls, and those of [controls] are {', '.join(controls) or 'none'}")
    lists |= {name: numbers(where, f"deflection.{name}", value) for name, value in turned.items()}
    order = ("mesh", *controls, "method", *NUMBERS)
    out = []
    for row in rows:
        own = lists | {key: [value] for key, value in row.items()}
        if "mach" not in own:
            raise SweepError(f"{where}: a [[runs]] block has no mach; for example mach = [1.5, 2.0]")
        keys = [key for key in order if key in own]
        out += [as_point(dict(zip(keys, values)), controls) for values in itertools.product(*(own[key] for key in keys))]
    return out


def as_point(point: dict, controls: Mapping[str, object]) -> dict:
    deflection = {name: point.pop(name) for name in controls if name in point}
    if "alpha_t" in point:
        point["alpha"], point["beta"] = from_total(point["alpha_t"], point["phi"])
    return point | {"deflection": deflection}
