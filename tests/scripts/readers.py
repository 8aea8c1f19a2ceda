"""Independent readers of tables that `sweep.py table` writes, from the documentation of the formats; nothing of the writers is used.

JSBSim: "FGTable" and "FGFunction" of its reference manual: a product of properties, values and tables; linear between breakpoints, the
edge's value outside. X, Y, Z are forces forward, to starboard and down; ROLL, PITCH, YAW moments about these axes.
RocketPy: docs/user/rocket/generic_surface.rst: forces on axes starboard, down, forward are M_BA (cQ, -cL, -cD) q S, moments (cm, cn, cl)
q S l; of a linear surface C_0 + C_alpha alpha + C_beta beta and (l / 2V) (C_p p + C_q q + C_r r).
"""

from __future__ import annotations

import csv
import math
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np

JSBSIM_AXES = ("X", "Y", "Z", "ROLL", "PITCH", "YAW")


def linear(at: float, keys: list[float], values: list[float]) -> float:
    """Between the keys; the edge's value outside."""
    if at <= keys[0]:
        return values[0]
    for low, high, left, right in zip(keys, keys[1:], values, values[1:]):
        if at <= high:
            return left + (right - left) * (at - low) / (high - low)
    return values[-1]


def table_value(table: ElementTree.Element, properties: dict[str, float]) -> float:
    variables = {item.get("lookup", "row"): properties[item.text.strip()] for item in table.findall("independentVar")}
    read = lambda data: [list(map(float, line.split())) for line in data.text.strip().splitlines()]

    def plane(data: ElementTree.Element) -> float:
        rows = read(data)
        if "column" not in variables:
            return linear(variables["row"], [row[0] for row in rows], [row[1] for row in rows])
        heads, rows = rows[0], rows[1:]
        assert all(len(row) == len(heads) + 1 for row in rows)
        columns = [linear(variables["column"], heads, row[1:]) for row in rows]
        return linear(variables["row"], [row[0] for row in rows], columns)

    parts = table.findall("tableData")
    if "table" in variables:
        return linear(variables["table"], [float(part.get("breakPoint")) for part in parts], [plane(part) for part in parts])
    return plane(parts[0])


def value(element: ElementTree.Element, properties: dict[str, float]) -> float:
    if element.tag == "property":
        return properties[element.text.strip()]
    if element.tag == "value":
        return float(element.text)
    if element.tag == "table":
        return table_value(element, properties)
    parts = [value(child, properties) for child in element]
    if element.tag == "product":
        return math.prod(parts)
    assert element.tag == "difference", element.tag
    return parts[0] - sum(parts[1:])


def jsbsim_loads(path: Path, properties: dict[str, float]) -> dict[str, float]:
    """Forces and moments by axis."""
    root = ElementTree.parse(path).getroot()
    assert root.tag == "aerodynamics"
    out = dict.fromkeys(JSBSIM_AXES, 0.0)
    for axis in root.findall("axis"):
        assert axis.get("name") in out and len(axis), axis.get("name")
        out[axis.get("name")] += sum(value(function[0], properties) for function in axis.findall("function"))
    return out


def flown(
    mach: float, alpha: float = 0.0, beta: float = 0.0, *, speed: float, pressure: float, area: float, length: float, **rates: float
) -> dict[str, float]:
    """JSBSim's properties in a flight; degrees, rates in rad/s, other properties by their names."""
    names = {
        "p": "velocities/p-aero-rad_sec", "q": "velocities/q-aero-rad_sec", "r": "velocities/r-aero-rad_sec",
        "alphadot": "aero/alphadot-rad_sec", "betadot": "aero/betadot-rad_sec",
    }  # fmt: skip
    return {
        "velocities/mach": mach, "aero/alpha-rad": math.radians(alpha), "aero/beta-rad": math.radians(beta),
        "aero/qbar-area": pressure * area, "metrics/cbarw-ft": length, "aero/ci2vel": length / (2 * speed),
    } | {of: rates.pop(name, 0.0) for name, of in names.items()} | rates  # fmt: skip


def csv_value(path: Path, **at: float) -> float:
    """Of a regular grid, multilinear; raises where it would have to extrapolate, and for a grid that is not regular."""
    with open(path) as file:
        names, *rows = csv.reader(file)
    table = np.array(rows, dtype=float)
    keys = [sorted(set(table[:, i])) for i in range(len(names) - 1)]
    known = {tuple(row[:-1]): row[-1] for row in table}
    assert len(known) == len(table) == math.prod(map(len, keys)), path

    def inside(chosen: tuple[float, ...]) -> float:
        if len(chosen) == len(keys):
            return known[chosen]
        own, wanted = keys[len(chosen)], at[names[len(chosen)]]
        if not own[0] - 1e-12 <= wanted <= own[-1] + 1e-12:
            raise ValueError(f"{path}: {names[len(chosen)]} = {wanted} is outside")
        return linear(wanted, own, [inside((*chosen, key)) for key in own])

    return inside(())


def rocketpy_matrix(alpha: float, beta: float) -> np.ndarray:
    """M_BA."""
    c, s, cb, sb = math.cos(alpha), math.sin(alpha), math.cos(beta), math.sin(beta)
    return np.array([[1, 0, 0], [0, c, -s], [0, s, c]]) @ np.array([[cb, 0, -sb], [0, 1, 0], [sb, 0, cb]])


def rocketpy_generic(folder: Path, mach: float, alpha: float, beta: float) -> tuple[np.ndarray, np.ndarray]:
    """Force on axes starboard, down, forward over q S, and moments about them over q S l; radians."""
    c = {name: csv_value(folder / f"{name}.csv", mach=mach, alpha=alpha, beta=beta) for name in ("cL", "cQ", "cD", "cm", "cn", "cl")}
    return rocketpy_matrix(alpha, beta) @ (c["cQ"], -c["cL"], -c["cD"]), np.array([c["cm"], c["cn"], c["cl"]])


def rocketpy_linear(
    folder: Path, mach: float, alpha: float, beta: float, half_time: float, rates: dict[str, float], sums: bool = False
) -> tuple[np.ndarray, np.ndarray]:
    """The same of a linear surface; half_time: l / 2V, rates in rad/s; sums: with the files for q and alphadot together."""

    def part(name: str) -> float:
        together = {"q": "q_alphadot", "r": "r_betadot"}
        path = folder / f"{name}.csv"
        if sums and name[-1] in together and (folder / f"{name[:-1]}{together[name[-1]]}.csv").exists():
            path = folder / f"{name[:-1]}{together[name[-1]]}.csv"
        return csv_value(path, mach=mach) if path.exists() else 0.0

    c = {
        name: part(f"{name}_0") + part(f"{name}_alpha") * alpha + part(f"{name}_beta") * beta
        + half_time * sum(part(f"{name}_{rate}") * of for rate, of in rates.items())
        for name in ("cL", "cQ", "cD", "cm", "cn", "cl")
    }  # fmt: skip
    return rocketpy_matrix(alpha, beta) @ (c["cQ"], -c["cL"], -c["cD"]), np.array([c["cm"], c["cn"], c["cl"]])
