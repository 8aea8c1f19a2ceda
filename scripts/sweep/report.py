"""The report on a sweep: report.html, and its tables and figures as files in report/."""

from __future__ import annotations

import os
import shutil
import time
from html import escape
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import to_hex

from sweep import curves, cuts, dynamics, figures, page, surface, tables, trim
from sweep.controls import read_controls
from sweep.grid import choose_series, make_grid
from sweep.plan import Sweep, SweepError
from sweep.results import Results, finite, relative
from sweep.state import Phase
from sweep.text import duration
from table_one import FREE_FLIGHT_CENTER, SZNAJDER_CENTER


def write_report(sweep: Sweep, program: Path) -> Path:
    """Writes report.html of what is done; the program moves derivatives to other centres. Raises SweepError when nothing is done."""
    results = Results.of(sweep, program)
    if not results.entries:
        raise SweepError(f"no run in {sweep.folder} is done: there is nothing to report; see sweep.py status")
    folder = sweep.folder / "report"
    shutil.rmtree(folder, ignore_errors=True)  # a figure of an older report would be mistaken for one of this
    folder.mkdir(parents=True)
    with plt.rc_context(figures.STYLE):
        moving, moving_warnings = motion(results)
        sections = [
            ("Not done", unfinished(results)),
            ("Beside the paper", beside_the_paper(results, folder)),
            ("Against angle of attack", against_alpha(results, folder)),
            ("Against sideslip", against_beta(results, folder)),
            ("Against Mach number", against_mach(results, folder)),
            ("Controls", deflected(results, folder)),
            ("Interference", write(tables.interference_table(results), folder)),
            ("Motion", moving),
            ("Loops", loops(results, folder)),
            ("Derivatives", derivatives(results, folder)),
            ("Surface pressure", pressures(results, folder)),
            ("Pressure cuts", pressure_cuts(results, folder)),
            ("Convergence", page.grid(figures.convergence_figures(results, folder))),
            ("Meshes", page.grid(surface.mesh_pictures(results, folder))),
            ("Cost", write(tables.cost_table(results), folder)),
            ("Provenance", provenance(results)),
        ]
    done, every = len(results.entries), len(sweep.runs)
    subtitle = f"{done} of {every} runs done · {time.strftime('%d %B %Y, %H:%M')}"
    top = warnings(results) + moving_warnings + page.cards(headline(results)) + conventions(results)
    file = sweep.folder / "report.html"
    temporary = file.with_suffix(".tmp")
    temporary.write_text(page.page(sweep.title, subtitle, top, sections))
    os.replace(temporary, file)
    return file


def write(table: tables.Table, folder: Path) -> str:
    """The table for the page, and as a file."""
    (folder / f"{table.name}.csv").write_text(table.csv())
    return page.table(table) if table.rows else ""


def headline(results: Results) -> list[tuple[str, str]]:
    """The figures that a reader should see first."""
    out = []
    if results.beside_paper:
        paper, center = results.published.paper, results.center
        pairs = [(results.about(entry, center), {k: float(v) for k, v in paper[entry.mach].items()}) for entry in results.beside_paper]
        static = max(abs(relative(here.Cm_alpha, row["static_field"])) for here, row in pairs)
        out.append((f"{static:.1f} %", f"largest difference of Cm_alpha from the paper, about the fitted centre {center:.2f} d"))
        acceleration = max(abs(here.Cm_alphadot - row["acceleration_field"]) for here, row in pairs)
        out.append((f"{acceleration:.1f} per rad", "largest difference of Cm_alphadot from the paper, a prediction"))
        damping = [abs(relative(here.Cm_q, row["damping_field"])) for here, row in pairs if finite(here.Cm_q)]
        if damping:
            out.append((f"{max(damping):.1f} %", "largest difference of Cm_q from the paper, a prediction"))
    else:
        out += balance(results)
    wall, processor = (sum(entry.result["performance"][key] or 0 for entry in results.entries) for key in ("wall_s", "cpu_s"))
    ranks = results.entries[0].result["ranks"]
    runs = f"{len(results.entries)} runs on {ranks} rank{'s' if ranks > 1 else ''}"
    out.append((duration(processor), f"of processor for {runs}, {duration(wall)} on the wall"))
    return out


def balance(results: Results) -> list[tuple[str, str]]:
    """Ranges over the converged runs of what stability and damping rest on."""
    good = [point for point in results.points if point.is_good and not point.image]

    def span(curve: curves.Curve, form: str) -> str:
        values = sorted(value for value, _ in map(curve.value, good) if finite(value))
        ends = list(dict.fromkeys(format(value, form).replace("-", "−") for value in values[:1] + values[-1:]))
        return " to ".join(ends)

    known = {curve.name: curve for curve in curves.PITCH}
    wanted = (("margin", ".2f", "lengths of static margin"), ("damping", ".0f", "Cm_q + Cm_alphadot, per rad; below zero damps"))
    return [(text, words) for name, form, words in wanted if (text := span(known[name], form))]


def warnings(results: Results) -> str:
    """Runs that failed, and those whose numbers are to be read with care."""
    failed = [f"{run.name}: {state.detail}" for run, state in results.unfinished if state.phase is Phase.FAILED]
    loose = [f"{entry.run.name}: {entry.state.detail}" for entry in results.entries if not entry.converged]
    return page.notices("Failed", failed) + page.notices("Not converged, what was asked for was not reached", loose)


def conventions(results: Results) -> str:
    """What every number on the page refers to."""
    reference = results.entries[0].result["reference"]
    center = ", ".join(f"{x:g}" for x in reference["moment_center"])
    rates = "Cm_alphadot = dCm / d(alphadot d/2V), Cm_q = dCm / d(q d/2V)"
    size = f"Length {reference['length']:g}, area {reference['area']:.6g}"
    pairs = [
        ("Units", f"Derivatives per radian; rates times {reference['rate'].removeprefix('times ')}: {rates}."),
        ("Reference", f"{size}, of the whole configuration ({reference['model']} model)."),
        ("Axes", f"{reference['axes']}. CA aft, CN up, Cm nose up."),
        ("Moment centre", f"Computed about ({center}), on the axis from the nose; moved to other centres by moment transfer."),
    ]
    if results.center:
        pairs.append(
            (
                "Fitted centre",
                f"The paper does not state its centre. x_ref = {results.center:.3f} d is one least-squares fit to its static "
                "values. Its acceleration and damping values are not in the fit: about x_ref ours are predictions of them. "
                f"Free-flight and ARL values are about {FREE_FLIGHT_CENTER} d.",
            )
        )
    return f'<section class="box">{page.terms(pairs)}</section>'


def beside_the_paper(results: Results, folder: Path) -> str:
    if not results.beside_paper:
        return ""
    note = (
        '<p class="note">Table I of the paper (Euler, harmonic plunge and pitch at k = 0.01, α = 1.5°), and its tunnel experiment. '
        f"Columns “{FREE_FLIGHT_CENTER} d” and “{results.center:.2f} d” are ours about these centres, in diameters from the nose. "
        "Cm_alphadot is a small difference of large terms and changes sign: there the difference counts, not the ratio.</p>"
    )
    return note + "".join(write(table, folder) for table in tables.table_one_tables(results))


BARS = "Bars are the uncertainty that the program gives for each derivative, a half width: "


def against_alpha(results: Results, folder: Path) -> str:
    family, _, _ = curves.families(results.points, folder)
    drawn = page.grid(family.pictures(curves.STATIC))
    return page.legend(family.legend()) + drawn if drawn else ""


def against_beta(results: Results, folder: Path) -> str:
    _, _, family = curves.families(results.points, folder)
    drawn = page.grid(family.pictures(curves.ASIDE))
    return page.legend(family.legend()) + drawn if drawn else ""


def over_mach(results: Results, folder: Path) -> str:
    _, family, _ = curves.families(results.points, folder)
    pitch, side = page.grid(family.pictures(curves.PITCH)), page.grid(family.pictures(curves.SIDE))
    if not pitch:
        return ""
    some = f" Lines are shown for {len(curves.few(family.values))} of {len(family.values)} values." if len(family.values) > 8 else ""
    note = f'<p class="note">{escape(BARS + results.uncertainty)}. Moments about the centre of the run.{some}</p>'
    return page.legend(family.legend()) + pitch + (f"<h3>The side</h3>{side}" if side else "") + note


def deflected(results: Results, folder: Path) -> str:
    """What controls change, and where they hold the body."""
    if not any(point.is_deflected for point in results.points):
        return ""
    try:
        grid = make_grid(results.points, choose_series(results.points, None))
    except SweepError as error:
        return f'<p class="note">{escape(str(error))}</p>'
    found, left_out = read_controls(results.points, grid)
    names = ("CA", "CN", "Cm", "CY", "Cn", "Cl")
    rows: list[list] = []
    for control in found:
        for i, j, k in np.ndindex(len(control.degrees), len(control.mach), len(control.alpha)):
            if control.degrees[i]:
                changes = [float(control.changes[name][i, j, k]) for name in names]
                rows.append([control.name, control.degrees[i], control.mach[j], control.alpha[k], *changes])
    columns = ["control", "deflection, deg", "Mach", "alpha, deg"]
    idle = {4 + index for index in range(len(names)) if not any(row[4 + index] for row in rows)}
    forms = ["", *[".4g"] * 3, *["+.4g"] * len(names)]
    changed = tables.Table("controls", "Changes by controls, the others at rest", [*columns, *names], rows, forms, hidden=idle)
    left = "".join(f'<p class="note">Left out: {escape(line)}.</p>' for line in left_out)
    return write(changed, folder) + trimmed(results, folder) + left


def trimmed(results: Results, folder: Path) -> str:
    """Where Cm = 0 about each centre of gravity, or what is in the way."""
    try:
        rows, notes = trim.trim(results.sweep, results.program, trim.Request())
    except SweepError as error:
        return f'<p class="note">Trim: {escape(str(error))}.</p>'
    head, cells, forms = trim.shown(rows) if rows else ([], [], [])
    name = "Trim: no pitching moment about the centre; bilinear between the angles computed; Ch: hinge moments of panels"
    table = tables.Table("trim", name, head, cells, forms)
    return write(table, folder) + "".join(f'<p class="note">{escape(note)}.</p>' for note in notes)


def motion(results: Results) -> tuple[str, str]:
    """The modes of motion where the sweep file says what the body weighs, and their warnings."""
    if not results.sweep.content.get("mass") or not any(point.is_good and point.derivatives for point in results.points):
        return "", ""
    _, rows = dynamics.dynamics(results.sweep, results.program)
    head, *cells = dynamics.shown(rows)
    cells = [[row["state"], *(cell.replace("-", "−") for cell in line)] for row, line in zip(rows, cells)]
    name = "Small disturbances of a straight path without thrust; margins in lengths; the sum damps where it is below the column beside it"
    unknown = {1 + index for index in range(len(head)) if all(line[1 + index] == "−" for line in cells)}
    table = tables.Table("dynamics", name, ["state", *head], cells, [""] + ["n"] * len(head), hidden=unknown)
    lines = list(dict.fromkeys(line for row in rows for line in dynamics.warnings(row)))
    return page.table(table), page.notices("Motion", lines)


def against_mach(results: Results, folder: Path) -> str:
    if not results.published:
        return over_mach(results, folder)
    drawn = page.grid(figures.mach_figures(results, folder))
    note = f"Bars are the uncertainty that the program gives: {results.uncertainty}."
    if results.published:
        note += " Moments: solid lines are about the centre fitted to the paper's static values, dashed ones about "
        note += f"{FREE_FLIGHT_CENTER} d, dotted ones about {SZNAJDER_CENTER} d."
    return f'{drawn}<p class="note">{note}</p>' if drawn else ""


def loops(results: Results, folder: Path) -> str:
    drawn = page.grid(figures.loop_figures(results, folder), broad=True)
    note = (
        "The paper's Fig. 4. The area of the loop is π k α<sub>m</sub>² Cm_alphadot: too slender to be seen beside the static part."
    )
    return f'{drawn}<p class="note">{note}</p>' if drawn else ""


def derivatives(results: Results, folder: Path) -> str:
    cross, zeros = tables.cross_tables(results)
    shown = (
        tables.derivative_table(results), tables.side_table(results), cross, tables.control_table(results), tables.force_table(results)
    )  # fmt: skip
    note = f'<p class="note">Zero within their ± in every run: {escape(", ".join(zeros))}.</p>' if zeros else ""
    return "".join(write(table, folder) for table in shown if table.rows) + note


def pressures(results: Results, folder: Path) -> str:
    scale, pictures = surface.pressure_pictures(results, folder)
    return page.scale(scale, "colours of the pressure coefficient") + page.grid(pictures, broad=True) if scale else ""


CUT = ("cp", "cp_alpha", "cp_q", "cp_alphadot", "cp_beta", "cp_betadot")  # what is drawn; the file has all


def pressure_cuts(results: Results, folder: Path) -> str:
    """Lines of the pressure and its derivatives where planes cut the body, a colour a flow; the sweep file's `cuts`, or the plane y = 0."""
    shown = surface.flows(results, plain=True)
    places = results.sweep.content.get("cuts", {"y": [0.0]})
    found: dict[str, list[cuts.Cut]] = {}
    missing: dict[str, int] = {}
    for entry in shown:
        of = surface.Surface.read(entry.run.folder / surface.FILE)
        own = {patch: shares for patch, shares in places.get("fins", {}).items() if patch in of.names}
        found[entry.run.name] = cuts.wanted(of, places | {"fins": own})
        for patch in places.get("fins", {}).keys() - own.keys():
            missing[patch] = missing.get(patch, 0) + 1
    if not found:
        return ""
    cuts.write_csv(folder / "pressure_cuts.csv", results.sweep.title, found)
    colors = [plt.get_cmap("viridis")(0.9 * index / max(1, len(shown) - 1)) for index in range(len(shown))]
    keys = [page.Key(surface.title_of(entry), to_hex(color), "solid") for entry, color in zip(shown, colors)]
    note = "".join(f'<p class="note">{count} of these flows have no patch {escape(patch)}.</p>' for patch, count in missing.items())
    return page.legend(keys) + page.grid(figures.cut_figures(list(found.values()), CUT, colors, folder)) + note


def unfinished(results: Results) -> str:
    rows = [[run.name, state.phase.value, state.detail] for run, state in results.unfinished]
    return (
        page.table(tables.Table("unfinished", "Runs without a result", ["run", "state", "reason or progress"], rows, ["", "", ""]))
        if rows
        else ""
    )


def provenance(results: Results) -> str:
    """What was used; values that differ between runs are all listed."""

    def distinct(values: list[str]) -> str:
        return "; ".join(dict.fromkeys(values))

    source = [entry.result["provenance"] for entry in results.entries]
    keys = ("version", "commit", "compiler", "flags", "build_type", "mpi", "hdf5", "cpu", "host")
    pairs = [(key.replace("_", " "), distinct([str(item.get(key, "")) for item in source])) for key in keys]
    dates = sorted(str(item.get("date", "")) for item in source)
    pairs.append(("runs", f"{dates[0]} to {dates[-1]}"))
    pairs.append(
        (
            "meshes",
            distinct(
                [f"{Path(entry.result['mesh']['file']).name}, hash {entry.result['mesh']['hash']}" for entry in results.entries]
            ),
        )
    )
    pairs.append(("cases", distinct([entry.run.case.name for entry in results.entries])))
    pairs.append(("sweep file", results.sweep.file.name))
    return page.terms(pairs)
