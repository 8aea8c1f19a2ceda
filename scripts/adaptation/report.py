"""What an adaptation leaves: a table, JSON, CSV and pictures."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable
from dataclasses import asdict
from pathlib import Path

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from adaptation.family import Interval
from adaptation.loop import Adaptation, Family, Outcome
from sweep.figures import COLORS, STYLE
from sweep.state import write_json
from sweep.text import aligned, duration, size

COLUMNS = ("derivative", "value", "uncertainty", "tolerance", "extrapolated", "order", "scatter", "finest", "middle", "coarsest")


def rows_of(family: Family, stream: str, adaptation: Adaptation) -> Iterable[tuple[str, Interval, float | None]]:
    """Goals first, with the tolerance asked for; then what else is not zero."""
    found = family.intervals[stream]
    values = {name: interval.value for name, interval in found.items()}
    for goal, tolerance in adaptation.tolerances.items():
        yield goal, found[goal], tolerance.half_width(goal, values)
    for name, interval in found.items():
        if name not in adaptation.tolerances:
            yield name, interval, None


def table(outcome: Outcome, adaptation: Adaptation) -> str:
    """The text that is printed at the end."""
    family = outcome.families[-1]
    lines = []
    for stream in adaptation.streams:
        members = sorted(family.members[stream.name], key=lambda member: member.factor)
        lines += [stream.name] if stream.name else []
        rows = [("name", "value", "", "tolerance", "order", "scatter", *(f"{member.cells:,}" for member in members[:2]), "coarsest")]
        for name, interval, asked in rows_of(family, stream.name, adaptation):
            order = "" if interval.order is None else f"{interval.order:.1f}"
            rows.append((
                name, f"{interval.value:.6g}", f"± {interval.uncertainty:.2g}", "" if asked is None else f"{asked:.2g}",
                order if interval.is_extrapolated else "not extrapolated", f"{interval.scatter:.2g}",
                *(f"{value:.6g}" for value in interval.levels),
            ))  # fmt: skip
        lines.append(aligned(rows))
    total = outcome.meshing + outcome.solving
    lines.append(
        f"{total.cpu:.0f} s of processor, {100.0 * outcome.meshing.cpu / max(total.cpu, 1e-9):.0f} % of it for meshes (one core); "
        f"{duration(total.wall)} wall; largest process {size(total.memory)}"
    )
    lines.append(f"{outcome.status}: {outcome.message}")
    return "\n".join(lines)


def write_report(outcome: Outcome, adaptation: Adaptation) -> None:
    """adaptation.json, adaptation.csv, convergence.png and cells.png in the folder."""
    folder = adaptation.folder
    family = outcome.families[-1]
    write_json(folder / "adaptation.json", {
        "status": outcome.status,
        "message": outcome.message,
        "not_reached": family.shortfalls,
        "tolerances": {goal: tolerance.text() for goal, tolerance in adaptation.tolerances.items()},
        "budget": asdict(adaptation.budget),
        "adapted": adaptation.adapts,
        "meshing": asdict(outcome.meshing),
        "solving": asdict(outcome.solving),
        "streams": [
            {
                "name": stream.name,
                "settings": list(stream.settings),
                "derivatives": {
                    name: asdict(interval) | {"tolerance": asked} for name, interval, asked in rows_of(family, stream.name, adaptation)
                },
            }
            for stream in adaptation.streams
        ],
        "families": [
            {
                "cells": one.cells,
                "cpu_s": one.cpu,
                "streams": [
                    {
                        "name": name,
                        "members": [asdict(member) for member in members],
                        "derivatives": {goal: asdict(interval) for goal, interval in one.intervals[name].items()},
                    }
                    for name, members in one.members.items()
                ],
            }
            for one in outcome.families
        ],
    })  # fmt: skip
    text = io.StringIO()
    text.write(f"# Status: {outcome.status}: {outcome.message}\n")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(("stream", *COLUMNS))
    for stream in adaptation.streams:
        for name, interval, asked in rows_of(family, stream.name, adaptation):
            order = "" if interval.order is None else interval.order
            extrapolated = "yes" if interval.is_extrapolated else "no"
            numbers = (interval.value, interval.uncertainty, asked or "", extrapolated, order, interval.scatter, *interval.levels)
            writer.writerow((stream.name, name, *numbers))
    (folder / "adaptation.csv").write_text(text.getvalue())
    with plt.rc_context(STYLE):
        _draw_convergence(outcome, adaptation)
        _draw_cells(outcome, adaptation)


def _draw_convergence(outcome: Outcome, adaptation: Adaptation) -> None:
    """Every goal against the square of the spacing, of all families, with the interval at none."""
    goals, streams = list(adaptation.tolerances), adaptation.streams
    shape = (len(streams), len(goals))
    figure, grid = plt.subplots(*shape, figsize=(3.6 * shape[1], 3.2 * shape[0]), layout="constrained", squeeze=False)
    for row, stream in zip(grid, streams):
        for axes, goal in zip(row, goals):
            for family, color in zip(outcome.families, COLORS * len(outcome.families)):
                members = family.members[stream.name]
                x = [member.cells ** (-2.0 / 3.0) * 1e3 for member in members]
                axes.plot(x, [member.values[goal] for member in members], "o", ms=4, color=color, label=f"family {family.number}")
                found = family.intervals[stream.name][goal]
                axes.errorbar([0.02 * max(x)], [found.value], yerr=[found.uncertainty], color=color, capsize=3, fmt="s", ms=4)
            axes.set(title=f"{goal} {stream.name}".strip(), xlabel="1000 cells$^{-2/3}$", xlim=(0, None))
    grid[0][0].legend()
    figure.savefig(adaptation.folder / "convergence.png", dpi=120)
    plt.close(figure)


def _draw_cells(outcome: Outcome, adaptation: Adaptation) -> None:
    """Sizes of cells in a slice beside y = 0: on the first mesh and on the middle one of the last family."""
    stream = adaptation.streams[0]
    suffix = f"_{stream.name}" if stream.name else ""
    files = [
        ("first mesh", adaptation.folder / "first" / f"indicator{suffix}" / "indicator.vtkhdf"),
        ("adapted mesh", adaptation.folder / f"family_{outcome.families[-1].number}" / f"run_1{suffix}" / "flow.vtkhdf"),
    ]
    files = [(title, file) for title, file in files if file.exists()]
    if not files:
        return
    figure, row = plt.subplots(1, len(files), figsize=(6.5 * len(files), 4.2), layout="constrained", sharey=True, squeeze=False)
    for axes, (title, path) in zip(row[0], files):
        centres, sizes = _cells(path)
        near = np.abs(centres[:, 1]) < np.maximum(0.5 * sizes, 0.01 * np.ptp(centres[:, 0]))
        order = np.argsort(-sizes[near])
        shown = axes.scatter(*centres[near][order][:, [0, 2]].T, c=np.log10(sizes[near][order]), s=2, cmap="viridis", rasterized=True)
        axes.set(title=f"{title}: {len(sizes):,} cells", aspect="equal", xlabel="x", ylabel="z")
        figure.colorbar(shown, ax=axes, shrink=0.7, label="log10 of the edge")
    figure.savefig(adaptation.folder / "cells.png", dpi=120)
    plt.close(figure)


def _cells(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Centres (n, 3) of a file's cells, and the edges of regular tetrahedra as large."""
    with h5py.File(path) as file:
        corners = file["VTKHDF/Points"][:].astype(float)[file["VTKHDF/Connectivity"][:].reshape(-1, 4)]
    volumes = np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1])) / 6.0
    return corners.mean(axis=1), (8.485 * volumes) ** (1.0 / 3.0)
