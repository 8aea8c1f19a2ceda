"""Everything about a sweep as one table: a row a run (and a mirror image), a column a quantity; as CSV and as HDF5."""

from __future__ import annotations

import csv
import math
import os
from itertools import chain
from math import isfinite
from pathlib import Path

import h5py
import numpy as np

from sweep.atmosphere import air_at
from sweep.axes import RATES, to_total
from sweep.database import COEFFICIENTS, KNOWN, Point, by_control, in_order
from sweep.plan import Sweep

Columns = dict[str, list]
ABOUT = (
    "Angles in degrees; derivatives per radian, rates times length / 2V; NAME.uncertainty is a half width, the sum of NAME.<source>.",
    "CA aft, CN up, CY starboard; Cl, Cm, Cn about axes forward, starboard, down; about the moment centre (x_ref, y_ref, z_ref).",
    "alpha_t and phi: total incidence, and the roll angle of the cross-flow from below towards starboard. CN@PATCH: the part of a patch.",
    "Of a control's panel by itself: CNp across its hinge, Ch about it, Cb of bending; x_cp, s_cp from the hinge's point, in mesh units.",
    "p, q, r: a steady turn, times length / 2V.",
    "image: planes in which the run is mirrored (its own symmetry), empty for a run itself. x_cp = x_ref - length Cm / CN.",
)


def columns_of(points: list[Point]) -> Columns:
    """Every column, None where a point has no value."""
    controls = list(dict.fromkeys(name for point in points for name in point.run.deflections))
    out: Columns = {
        "run": [point.run.name for point in points],
        "image": [point.image for point in points],
        "status": [point.state.phase.value for point in points],
        "converged": [None if not point.coefficients else point.is_good for point in points],
        "method": [point.run.method for point in points],
        "label": [point.run.label for point in points],
        "mesh": [point.run.mesh or (point.result.get("mesh") or {}).get("file") or "" for point in points],
        "mach": [point.run.mach for point in points],
        "alpha": [point.alpha for point in points],
        "beta": [point.beta for point in points],
    }
    out["alpha_t"], out["phi"] = map(list, zip(*(to_total(point.alpha, point.beta) for point in points)))
    for name in (name for name in RATES if any(name in point.run.rates for point in points)):
        out[name] = [point.run.rates.get(name, 0.0) for point in points]
    for name in controls:
        out[name] = [point.run.deflections.get(name, 0.0) for point in points]
    for name in COEFFICIENTS:
        out[name] = [point.coefficients.get(name) for point in points]
    out["x_cp"] = [x_cp(point) for point in points]
    out["static_margin"] = [number(point.static_margin) for point in points]
    known = [point.derivatives for point in points]
    for name in in_order(dict.fromkeys(chain.from_iterable(known))):
        found = [derivatives.get(name, ABSENT) for derivatives in known]
        values, uncertainties, converged, parts = zip(*found)
        out[name] = list(values)
        out[f"{name}.uncertainty"] = list(map(number, uncertainties))
        out[f"{name}.converged"] = list(converged)
        for part in dict.fromkeys(chain.from_iterable(parts)):
            out[f"{name}.{part}"] = [own.get(part) for own in parts]
    components = [point.components for point in points]
    for patch in dict.fromkeys(patch for own in components for patch in own):
        loads = [own.get(patch, NOTHING) for own in components]
        for name in COEFFICIENTS:
            out[f"{name}@{patch}"] = [own.get(name) for own in loads]
    panels = [point.panels for point in points]
    for panel in dict.fromkeys(panel for own in panels for panel in own):
        loads = [own.get(panel, NOTHING) for own in panels]
        for name in PANEL:
            out[f"{name}@{panel}"] = [own.get(name) for own in loads]
    return out | provenance(points)


NOTHING: dict = {}
ABSENT = (None, None, None, NOTHING)  # in the place of an Estimate
PANEL = ("CNp", "Ch", "Cb", "x_cp", "s_cp")


def provenance(points: list[Point]) -> Columns:
    part = lambda table: [point.result.get(table) or NOTHING for point in points]
    reference, mesh, source, cost = map(part, ("reference", "mesh", "provenance", "performance"))
    out: Columns = {name: [own.get(name) for own in reference] for name in ("length", "area", "model")}
    centers = [own.get("moment_center") or [None] * 3 for own in reference]
    out |= dict(zip(("x_ref", "y_ref", "z_ref"), map(list, zip(*centers))))
    out["uncertainty_of"] = [point.result.get("uncertainty") for point in points]
    out["cells"] = [own.get("cells") for own in mesh]
    out["mesh_hash"] = [own.get("hash") for own in mesh]
    out |= {name: [own.get(name) for own in source] for name in ("version", "commit", "date")}
    out["cpu_s"] = [own.get("cpu_s") for own in cost]
    out["message"] = [point.state.detail for point in points]
    return out


def x_cp(point: Point) -> float | None:
    """Centre of pressure, in the mesh's unit; None where there is no normal force to speak of."""
    if math.isnan(point.pressure_center):
        return None
    reference = point.result["reference"]
    return reference["moment_center"][0] + reference["length"] * point.pressure_center


def number(value: float | None) -> float | None:
    return value if value is not None and isfinite(value) else None


def write_csv(path: Path, columns: Columns, title: str) -> None:
    """Numbers with all their digits, yes and no, and nothing where there is no value."""
    word = {True: "yes", False: "no", None: ""}
    shown = [list(map(word.get, values)) if name.endswith("converged") else values for name, values in columns.items()]
    with open(path, "w", newline="") as file:
        file.write("".join(f"# {line}\n" for line in (title, *ABOUT)))
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows(zip(*shown))


def write_hdf5(path: Path, columns: Columns, title: str) -> None:
    """A dataset a column, all of one length: Cm_q/value, Cm_q/uncertainty, ... of derivatives, components/PATCH/CN, the others under
    their name. NaN where a number is missing; flags are 1, 0 and -1 where there is none."""
    temporary = path.with_name(path.name + ".tmp")
    with h5py.File(temporary, "w") as file:
        file.attrs["title"] = title
        file.attrs["about"] = "\n".join(ABOUT)
        for name, values in columns.items():
            file[place(name)] = array(values)
    os.replace(temporary, path)


def place(name: str) -> str:
    if "@" in name:
        return "components/{1}/{0}".format(*name.split("@", 1))
    if name in KNOWN or ("." not in name and by_control(name)):
        return f"{name}/value"
    return name.replace(".", "/")


def array(values: list) -> np.ndarray:
    kind = next((type(value) for value in values if value is not None), float)
    if kind is str:
        return np.array([value or "" for value in values], dtype=h5py.string_dtype())
    if kind is bool:
        return np.array([-1 if value is None else int(value) for value in values], dtype=np.int8)
    return np.array(values, dtype=float)


LOADS = ("FA", "FY", "FN", "Ml", "Mm", "Mn")


def loads_of(points: list[Point], sweep: Sweep) -> Columns:
    """Flight condition and dimensional loads of every point with a result at every altitude of the sweep; SI units."""
    rows = []
    for point in points:
        if not point.coefficients:
            continue
        length = point.result["reference"]["length"] * sweep.unit
        area = point.result["reference"]["area"] * sweep.unit**2
        for altitude in sweep.altitudes:
            air = air_at(altitude)
            speed = point.run.mach * air.sound_speed
            pressure = 0.5 * air.density * speed**2
            scales = [pressure * area] * 3 + [pressure * area * length] * 3
            loads = [scale * point.coefficients.get(name, math.nan) for name, scale in zip(COEFFICIENTS, scales)]
            reynolds = air.density * speed * length / air.viscosity
            rows.append((
                point.run.name, point.image, point.is_good, point.run.mach, point.alpha, point.beta,
                altitude, air.temperature, air.pressure, air.density, speed, pressure, reynolds, *loads,
            ))  # fmt: skip
    names = "run image converged mach alpha beta altitude_m T_K p_Pa rho_kg_m3 V_m_s q_Pa reynolds".split()
    units = [f"{name}_{'N' if name[0] == 'F' else 'Nm'}" for name in LOADS]
    return dict(zip((*names, *units), map(list, zip(*rows)))) if rows else {}
