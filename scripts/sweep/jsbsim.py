"""JSBSim's <aerodynamics> with <table>s over Mach, alpha and beta: static coefficients, rates, rates of the angles, controls."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from sweep.axes import BODY_ANGLES
from sweep.database import COEFFICIENTS
from sweep.grid import Grid

# The body's axes, forward, starboard and down; JSBSim also knows AXIAL and NORMAL, its schema does not.
AXES = {"CA": "X", "CY": "Y", "CN": "Z", "Cl": "ROLL", "Cm": "PITCH", "Cn": "YAW"}
OPPOSITE = ("CA", "CN")  # aft and up
ALPHA, BETA, MACH = "aero/alpha-rad", "aero/beta-rad", "velocities/mach"
REDUCED = {  # properties in rad/s; times aero/ci2vel, chord / 2V, they are what the derivatives are by
    "p": "velocities/p-aero-rad_sec", "q": "velocities/q-aero-rad_sec", "r": "velocities/r-aero-rad_sec",
    "alphadot": "aero/alphadot-rad_sec", "betadot": "aero/betadot-rad_sec",
}  # fmt: skip

Axis = tuple[str, Sequence[float]]  # property and breakpoints


@dataclass(frozen=True)
class Control:
    """Change of the coefficients by a control, the others at rest: degrees (sorted, 0 among them), and for each coefficient an array
    (degrees, Mach, alpha)."""

    name: str
    degrees: list[float]
    mach: list[float]
    alpha: list[float]
    changes: dict[str, np.ndarray]


def aerodynamics(grid: Grid, controls: Sequence[Control], title: str) -> str:
    """The XML element. JSBSim holds the value at the edge of a table outside of it."""
    out = ["<aerodynamics>", f"  <!-- {comment(grid, controls, title)} -->"]
    for coefficient in COEFFICIENTS:
        functions: list[str] = []
        for name, factors, axes, values in terms(grid, controls, coefficient):
            if np.any(values):
                functions += function(name, coefficient, factors, axes, values)
        if functions:
            out += [f'  <axis name="{AXES[coefficient]}">', *functions, "  </axis>"]
    return "\n".join([*out, "</aerodynamics>", ""])


def terms(grid: Grid, controls: Sequence[Control], coefficient: str):
    """Name, factors, axes and values of everything that makes up a coefficient."""
    axes: list[Axis] = [(ALPHA, np.radians(grid.alpha)), (MACH, grid.mach), (BETA, np.radians(grid.beta))]
    order = (1, 0, 2)  # from (Mach, alpha, beta) to the rows, columns and tables above
    static = grid.values(coefficient)
    if static is not None:
        yield coefficient, [], axes, static.transpose(order)
    for name in grid.derivatives:
        own, variable = name.split("_", 1)
        if own != coefficient:
            continue
        values = grid.values(name).transpose(order)
        if variable in REDUCED:
            yield name, [prop(REDUCED[variable]), prop("aero/ci2vel")], axes, values
        elif variable in BODY_ANGLES and len(getattr(grid, variable)) == 1:  # otherwise the static table has it
            at = math.radians(getattr(grid, variable)[0])
            angle = prop(f"aero/{variable}-rad")
            yield name, [f"<difference>{angle}<value>{at:.12g}</value></difference>" if at else angle], axes, values
        elif variable in linear_controls(grid, controls):
            yield name, [prop(f"fcs/{variable}-rad")], axes, values
    for control in controls:
        axes = [(ALPHA, np.radians(control.alpha)), (MACH, control.mach), (f"fcs/{control.name}-deg", control.degrees)]
        yield f"{coefficient}_{control.name}", [], axes, control.changes[coefficient].transpose((2, 1, 0))


def linear_controls(grid: Grid, controls: Sequence[Control]) -> list[str]:
    """Those that there are derivatives by, and no runs with them deflected."""
    tabulated = {control.name for control in controls}
    return [name for name in grid.controls if name not in tabulated]


def function(name: str, coefficient: str, factors: Sequence[str], axes: Sequence[Axis], values: np.ndarray) -> list[str]:
    scale = ["<value>-1</value>"] if coefficient in OPPOSITE else []
    scale += [prop("aero/qbar-area")] + ([prop("metrics/cbarw-ft")] if coefficient in ("Cl", "Cm", "Cn") else [])
    return [
        f'    <function name="aero/coefficient/{name}">',
        "      <product>",
        *(f"        {factor}" for factor in (*scale, *factors)),
        *table(axes, values),
        "      </product>",
        "    </function>",
    ]


def table(axes: Sequence[Axis], values: np.ndarray) -> list[str]:
    """A <table> over those axes that have more than one value, or a <value>: rows by the first, columns by the second."""
    kept = [axis for axis in axes if len(axis[1]) > 1]
    data = np.asarray(values).reshape([len(breakpoints) for _, breakpoints in kept])
    if not kept:
        return [f"        <value>{float(data):.12g}</value>"]
    lines = ["        <table>"]
    places = zip(("row", "column", "table"), kept)
    lines += [f'          <independentVar lookup="{place}">{of}</independentVar>' for place, (of, _) in places]
    if len(kept) < 3:
        lines += ["          <tableData>", *rows(kept, data), "          </tableData>"]
    else:
        for index, at in enumerate(kept[2][1]):
            lines += [f'          <tableData breakPoint="{at:.12g}">', *rows(kept[:2], data[:, :, index]), "          </tableData>"]
    return [*lines, "        </table>"]


def rows(axes: Sequence[Axis], data: np.ndarray) -> list[str]:
    line = lambda first, numbers: f"            {first:>18}" + "".join(f" {number:>18.12g}" for number in numbers)
    head = [line("", axes[1][1])] if len(axes) > 1 else []
    return head + [line(f"{at:.12g}", np.atleast_1d(numbers)) for at, numbers in zip(axes[0][1], data)]


def prop(name: str) -> str:
    return f"<property>{name}</property>"


def comment(grid: Grid, controls: Sequence[Control], title: str) -> str:
    """What the vehicle must have for these tables; a comment must not hold two hyphens in a row."""
    reference = grid.reference
    x, y, z = reference["moment_center"]
    span = lambda values: f"{values[0]:g} to {values[-1]:g}" if len(values) > 1 else f"{values[0]:g}"
    lines = [
        f"alphadot: {title}; {grid.series}; Mach {span(grid.mach)}, alpha {span(grid.alpha)} deg, beta {span(grid.beta)} deg.",
        f"Needs in the vehicle's metrics, in the mesh's unit: chord {reference['length']:g}, wingarea {reference['area']:g}, AERORP at"
        f" ({x:g}, {y:g}, {z:g}); the centre of gravity should be there too, for the rates are about it.",
        "Alpha and beta are tabulated where they were computed at more than one value, and linear about that one elsewhere.",
        "Outside the tables JSBSim holds their edge values.",
    ]
    for control in controls:
        turned = f"fcs/{control.name}-deg, {span(control.degrees)} degrees"
        lines.append(f"Control {control.name}: {turned}; it changes no rate's derivative here.")
    linear = linear_controls(grid, controls)
    if linear:
        lines.append(f"Linear in {', '.join(f'fcs/{name}-rad' for name in linear)}; a set and its own controls are the same deflections.")
    lines += [f"Left out: {line}." for line in grid.left_out]
    text = "\n       ".join(lines)
    while "--" in text:
        text = text.replace("--", "- -")
    return text
