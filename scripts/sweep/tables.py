"""The tables of a report, each to be shown in the page and written as a CSV file."""

from __future__ import annotations

import csv
import io
import math
from dataclasses import dataclass, field

from sweep.database import COEFFICIENTS, SIDE, by_control, group, in_order, known
from sweep.errors import SweepError
from sweep.interference import interference
from sweep.results import Entry, Results, finite, relative
from sweep.text import duration
from table_one import FREE_FLIGHT_CENTER

Cell = str | float | int | None


@dataclass(frozen=True)
class Table:
    """Rows under columns; `formats` says how the numbers of a column are shown, e.g. "+.1f"; the CSV has all digits."""

    name: str
    caption: str
    columns: list[str]
    rows: list[list[Cell]]
    formats: list[str]
    marked: set[int] = field(default_factory=set)  # columns of errors, shown apart
    joined: set[int] = field(default_factory=set)  # columns of uncertainties, shown in the cell before them
    hidden: set[int] = field(default_factory=set)  # columns of the file alone

    def shown(self, row: list[Cell]) -> list[str]:
        out = [show(cell, form) for cell, form in zip(row, self.formats)]
        for index in self.joined:
            if out[index] != "–":
                out[index - 1] += f" ± {out[index]}"
        return out

    def csv(self) -> str:
        text = io.StringIO()
        text.write(f"# {self.caption}\n")
        writer = csv.writer(text, lineterminator="\n")
        writer.writerows([self.columns, *self.rows])
        return text.getvalue()


def show(cell: Cell, form: str) -> str:
    if cell is None or (isinstance(cell, float) and not math.isfinite(cell)):
        return "–"
    if isinstance(cell, str):
        return cell
    return format(cell, f"z{form}" if form[:1] == "." else form).replace("-", "−")  # a true minus sign, and none before zero


def method_label(entry: Entry) -> str:
    """Short, for the eye: the result's own text names the frequency as well."""
    return "linear solve" if entry.run.label == "derivatives" else entry.run.label.replace("_", " ")


def table_one_tables(results: Results) -> list[Table]:
    """Table I of the paper, one table a derivative: ours about 5.5 d and about the fitted centre, and how far off we are."""
    center, paper = results.center, results.published.paper
    about = f"about {FREE_FLIGHT_CENTER} d and about x_ref = {center:.3f} d, fitted to the paper's static values"
    wanted = [
        ("static", "Cm_alpha", f"Static derivative Cm_alpha, per rad, {about}", "%"),
        ("acceleration", "Cm_alphadot", f"Acceleration derivative Cm_alphadot, per rad of alphadot d/2V, {about}", "diff"),
        ("damping", "Cm_q", f"Damping derivative Cm_q, per rad of q d/2V, {about}", "%"),
    ]
    tables = []
    for key, name, caption, kind in wanted:
        experiment = key == "static"
        unit = "%" if kind == "%" else "difference"
        columns = [
            "Mach",
            "method",
            f"here, {FREE_FLIGHT_CENTER} d",
            f"here, {center:.2f} d",
            "paper, field velocity",
            "paper, grid motion",
        ]
        columns += ["experiment"] if experiment else []
        columns += [
            f"{FREE_FLIGHT_CENTER} d / field, {unit}",
            f"{center:.2f} d / field, {unit}",
            f"{center:.2f} d / grid, {unit}",
        ]
        columns += [f"{center:.2f} d / experiment, {unit}", "paper / experiment, %"] if experiment else []
        if kind != "%":
            columns = [column.replace(" / ", " − ").replace(", difference", "") for column in columns]
        rows = []
        for entry in results.beside_paper:
            row = {k: float(v) for k, v in paper[entry.mach].items()}
            plain, fitted = (getattr(results.about(entry, x), name) for x in (FREE_FLIGHT_CENTER, center))
            if not finite(plain):
                continue
            compare = relative if kind == "%" else (lambda value, of: value - of)
            field, grid = row[f"{key}_field"], row[f"{key}_grid"]
            cells: list[Cell] = [entry.mach, method_label(entry), plain, fitted, field, grid]
            tunnel = [row["static_experiment"]] if experiment else []
            errors = [compare(plain, field), compare(fitted, field), compare(fitted, grid)]
            errors += [compare(fitted, tunnel[0]), relative(field, tunnel[0])] if experiment else []
            rows.append([*cells, *tunnel, *errors])
        first = 6 + experiment
        digits = ".1f" if name == "Cm_q" else ".2f"
        formats = [".2f", "", *[digits] * (first - 2), *["+.1f" if kind == "%" else "+.2f"] * (len(columns) - first)]
        tables.append(Table(f"table1_{key}", caption, columns, rows, formats, set(range(first, len(columns)))))
    return tables


def with_uncertainties(entry: Entry, names: list[str]) -> list[Cell]:
    """Mach number, incidence, and each derivative with its uncertainty behind it."""
    found = entry.result["derivatives"]
    cells: list[Cell] = [entry.mach, entry.run.alpha]
    for name in names:
        cells += [found[name]["value"], found[name]["uncertainty"]] if name in found else [None, None]
    return cells


def derivative_table(results: Results) -> Table:
    """Every derivative of the moment and the normal force, about the centre of the run."""
    names = ["CN_alpha", "Cm_alpha", "CN_alphadot", "Cm_alphadot", "CN_q", "Cm_q"]
    columns = ["Mach", "alpha, deg", *(word for name in names for word in (name, "±")), "centre x, d", "run"]
    rows = [[*with_uncertainties(entry, names), results.here(entry).center, entry.label] for entry in results.with_derivatives]
    formats = [".4g", ".4g", *[".3f", ".1g"] * 2, *[".2f", ".1g"] * 4, "g", ""]
    return Table(
        "derivatives",
        f"Derivatives, per rad; rates times length / 2V; moments about the centre of the run; ±: {results.uncertainty}",
        columns,
        rows,
        formats,
        joined=set(range(3, 14, 2)),
        hidden={14},
    )


def plane_table(results: Results, name: str, caption: str, names: list[str]) -> Table:
    """Some derivatives of every run that has them."""
    columns = ["Mach", "alpha, deg", *(word for name in names for word in (name, "±")), "run"]
    rows = [[*with_uncertainties(entry, names), entry.label] for entry in results.with_derivatives]
    formats = [".4g", ".4g", *[".3g", ".1g"] * len(names), ""]
    joined = set(range(3, 2 + 2 * len(names), 2))
    return Table(name, caption, columns, rows if names else [], formats, joined=joined, hidden={len(columns) - 1})


def found(results: Results) -> list[str]:
    """Derivatives that some run has."""
    return in_order(filter(known, (name for entry in results.with_derivatives for name in entry.result["derivatives"])))


def side_table(results: Results) -> Table:
    """Derivatives of the side of full models."""
    names = [name for name in SIDE if any(name in entry.result["derivatives"] for entry in results.with_derivatives)]
    return plane_table(results, "side", "Derivatives of the side, per rad; rates times length / 2V", names)


def is_zero(entry: dict) -> bool:
    """Not told from zero by its uncertainty."""
    return entry["uncertainty"] is not None and abs(entry["value"] or 0.0) <= entry["uncertainty"]


def cross_tables(results: Results) -> tuple[Table, list[str]]:
    """Loads out of the plane of symmetry by variables in it, and the reverse; and those that are zero in every run."""
    names = [name for name in found(results) if group(name) == "cross"]
    own = lambda name: [entry.result["derivatives"][name] for entry in results.with_derivatives if name in entry.result["derivatives"]]
    zeros = [name for name in names if all(map(is_zero, own(name)))]
    shown = [name for name in names if name not in zeros]
    return plane_table(results, "cross", "Cross derivatives, per rad; rates times length / 2V", shown), zeros


def control_table(results: Results) -> Table:
    """Derivatives by controls, a row a control of a run; without loads that are zero in all of them."""
    rows: list[list[Cell]] = []
    used: set[str] = set()
    for entry in results.with_derivatives:
        derivatives = entry.result["derivatives"]
        for control in dict.fromkeys(filter(None, map(by_control, derivatives))):
            own = {name: derivatives.get(f"{name}_{control}") for name in COEFFICIENTS}
            used |= {name for name, load in own.items() if load and not is_zero(load)}
            cells = [cell for load in own.values() for cell in ([load["value"], load["uncertainty"]] if load else [None, None])]
            rows.append([control, entry.mach, entry.run.alpha, *cells, entry.label])
    columns = ["control", "Mach", "alpha, deg", *(word for name in COEFFICIENTS for word in (name, "±")), "run"]
    idle = {3 + 2 * index for index, name in enumerate(COEFFICIENTS) if name not in used}
    joined = {4 + 2 * index for index in range(len(COEFFICIENTS))}
    formats = ["", ".4g", ".4g", *[".4g", ".1g"] * len(COEFFICIENTS), ""]
    caption = "Derivatives by deflections, per rad, and by their rates (dot)"
    return Table("by_controls", caption, columns, sorted(rows, key=lambda row: row[0]), formats, joined=joined, hidden=idle)


def interference_table(results: Results) -> Table:
    """Body in the presence of fins less the body alone, where the sweep has both at one condition; by the same walls."""
    names = ["CN_alpha", "Cm_alpha", "CN_q", "Cm_q", "CN_alphadot", "Cm_alphadot"]
    walls = lambda entry: set(entry.result["forces"]["components"])
    condition = lambda entry: (entry.mach, entry.run.alpha, entry.run.beta)
    rows: list[list[Cell]] = []
    for whole in results.with_derivatives:
        bodies = [bare for bare in results.with_derivatives if condition(bare) == condition(whole) and walls(bare) < walls(whole)]
        if not bodies or not whole.run.is_plain:
            continue
        bare = min(bodies, key=lambda entry: len(walls(entry)))
        try:
            found = {row.name: row for row in interference(whole.run.folder, bare.run.folder)}
        except SweepError:
            continue  # of another reference: no pair
        cells = [getattr(found.get(name), value, None) for name in names for value in ("interference", "uncertainty")]
        rows.append([whole.mach, whole.run.alpha, *cells, whole.label, bare.label])
    columns = ["Mach", "alpha, deg", *(word for name in names for word in (name, "±")), "run", "body alone"]
    caption = "Interference: the body in the presence of fins less the body alone, per rad; ± of the solves, not of the meshes"
    formats = [".4g", ".4g", *[".3f", ".1g"] * 2, *[".2f", ".1g"] * 4, "", ""]
    return Table("interference", caption, columns, rows, formats, joined=set(range(3, 14, 2)), hidden={14})


def force_table(results: Results) -> Table:
    """Forces and moment of the steady flow."""
    columns = ["Mach", "alpha, deg", "CA", "CN", "Cm", "centre x, d", "run"]
    rows = []
    for entry in results.entries:
        forces, reference = entry.result["forces"], entry.result["reference"]
        center = reference["moment_center"][0] / reference["length"]
        rows.append([entry.mach, entry.run.alpha, forces["CA"], forces["CN"], forces["Cm"], center, entry.label])
    return Table(
        "forces",
        "Steady flow: axial and normal force, pitching moment",
        columns,
        rows,
        [".4g", ".4g", ".5f", ".5f", ".5f", "g", ""],
        hidden={5},
    )


def cost_table(results: Results) -> Table:
    columns = [
        "run",
        "cells",
        "ranks",
        "iterations",
        "wall, s",
        "processor, s",
        "µs / cell / iteration",
        "bytes / cell",
        "halo wait, %",
        "end",
    ]
    rows: list[list[Cell]] = []
    for entry in results.entries:
        cost, mesh = entry.result["performance"], entry.result["mesh"]
        halo = cost["halo_fraction"]
        rows.append(
            [entry.label, mesh["cells"], entry.result["ranks"], cost["iterations"], cost["wall_s"], cost["cpu_s"]]
            + [
                cost["core_us_per_cell_iteration"],
                cost["bytes_per_cell"],
                None if halo is None else 100 * halo,
                entry.state.detail,
            ]
        )
    total = lambda index: sum(row[index] or 0 for row in rows)
    rows.append(["all", None, None, total(3), total(4), total(5), None, None, None, f"{duration(total(4))} of wall clock"])
    formats = ["", ",d", "d", ",d", ".1f", ".1f", ".2f", ".0f", ".1f", ""]
    return Table("cost", "What the runs took, each in its last attempt", columns, rows, formats)
