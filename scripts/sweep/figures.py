"""Line figures of a report: derivatives against Mach number, loops of the moment, convergence.

Each is a panel of its own, so that the page can set them side by side on a desk and one below the other on a phone.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import h5py
import matplotlib.pyplot as plt
import numpy as np

from sweep import cuts
from sweep.derive import Derivatives, Runs
from sweep.picture import Picture
from sweep.results import Entry, Results, finite
from sweep.tables import method_label
from table_one import FREE_FLIGHT_CENTER, HERE, MEASURED, OTHER, PAPER, SZNAJDER_CENTER, Row, column

STEADY, HISTORY = "steady.csv", "history.csv"  # of a run: a row an iteration, a row a step
SIZE = (5.2, 4.0)
COLORS = (HERE, "#e08214", "#7b3294", "#1b9e9e", "#8c510a", "#d01c8b")
STYLE = {
    "font.size": 10, "axes.grid": True, "grid.alpha": 0.25, "axes.spines.top": False, "axes.spines.right": False,
    "legend.fontsize": 8, "legend.framealpha": 0.85, "svg.hashsalt": "alphadot", "axes.axisbelow": True,
}  # fmt: skip


def save(figure: plt.Figure, folder: Path, name: str, title: str, caption: str = "") -> Picture:
    figure.savefig(folder / f"{name}.png", dpi=130)
    figure.savefig(folder / f"{name}.svg", metadata={"Date": None})
    plt.close(figure)
    return Picture(folder / f"{name}.svg", title, caption)


def panel(xlabel: str, ylabel: str) -> tuple[plt.Figure, plt.Axes]:
    figure, axes = plt.subplots(figsize=SIZE, layout="constrained")
    axes.set(xlabel=xlabel, ylabel=ylabel)
    return figure, axes


@dataclass(frozen=True)
class Quantity:
    """A sum of derivatives against Mach number, with the centres that published values of it refer to."""

    name: str
    title: str  # for the page
    symbol: str
    terms: tuple[str, ...]
    centers: tuple[float, ...] = (FREE_FLIGHT_CENTER,)
    fitted: bool = True  # does it depend on the centre, and does the paper have it?


QUANTITIES = (
    Quantity("cm_alpha", "Static moment", r"$C_{m\alpha}$", ("Cm_alpha",)),
    Quantity(
        "cm_alphadot", "Acceleration derivative", r"$C_{m\dot\alpha}$", ("Cm_alphadot",), (FREE_FLIGHT_CENTER, SZNAJDER_CENTER)
    ),
    Quantity("cm_q", "Damping by rotation alone", r"$C_{mq}$", ("Cm_q",), (FREE_FLIGHT_CENTER, SZNAJDER_CENTER)),
    Quantity("damping_sum", "Pitch damping, the sum", r"$C_{mq} + C_{m\dot\alpha}$", ("Cm_q", "Cm_alphadot")),
    Quantity("cn_alpha", "Normal force", r"$C_{N\alpha}$", ("CN_alpha",), fitted=False),
    Quantity("cn_alphadot", "Normal force by acceleration", r"$C_{N\dot\alpha}$", ("CN_alphadot",), fitted=False),
)


def mach_figures(results: Results, folder: Path) -> list[Picture]:
    return [draw_quantity(results, quantity, folder) for quantity in QUANTITIES if results.series]


def draw_quantity(results: Results, quantity: Quantity, folder: Path) -> Picture:
    own = results.here(results.with_derivatives[0]).center
    if results.published:
        centers = ([results.center] if quantity.fitted and results.center else []) + list(quantity.centers)
    else:
        centers = [own]
    figure, axes = panel("Mach number", "per rad")
    for index, entries in enumerate(results.series.values()):
        color = COLORS[index % len(COLORS)]
        # Runs in time are few, and stand beside the line of the first centre only.
        for center, style in zip(centers[: 1 if entries[0].run.is_motion else None], ("-", "--", ":")):
            label = ", ".join([*series_label(entries[0], results), *center_label(quantity, center, results)])
            draw_series(axes, results, entries, quantity, center, style, color, label)
    if results.published:
        draw_published(axes, results, quantity)
    if axes.get_ylim()[0] < 0 < axes.get_ylim()[1]:
        axes.axhline(0.0, color=MEASURED, lw=0.7)
    axes.set_title(quantity.symbol, fontsize=12)
    if axes.lines:
        axes.legend(handlelength=2.6)
    caption = f"{' + '.join(quantity.terms)}; bars: {results.uncertainty}"
    return save(figure, folder, f"mach_{quantity.name}", quantity.title, caption)


def series_label(entry: Entry, results: Results) -> list[str]:
    """What tells the series of an entry from the others."""
    _, meshes, alphas = (len(set(values)) for values in zip(*results.series))
    return [method_label(entry)] + [entry.run.mesh] * (meshes > 1) + [f"α = {entry.run.alpha:g}°"] * (alphas > 1)


def center_label(quantity: Quantity, center: float, results: Results) -> list[str]:
    """The centre, for moments."""
    if not quantity.terms[0].startswith("Cm"):
        return []
    return [f"{center:.2f} d" + (" (fitted)" if center == results.center else "")]


def draw_series(
    axes: plt.Axes, results: Results, entries: list[Entry], quantity: Quantity, center: float, style: str, color: str, label: str
) -> None:
    """A line with bars of uncertainty; of runs in time the marks alone."""
    found = [results.about(entry, center) for entry in entries]
    values = [sum(getattr(run, term) for term in quantity.terms) for run in found]
    errors = [sum(run.uncertainty.get(term, 0.0) for term in quantity.terms) for run in found]
    keep = [index for index, value in enumerate(values) if finite(value)]
    if keep:
        pick = lambda items: [items[index] for index in keep]
        mach = pick([entry.mach for entry in entries])
        if entries[0].run.is_motion:
            look = {"ls": "", "marker": "*", "ms": 10, "mec": "white", "zorder": 4}
        else:
            look = {"ls": style, "marker": "o", "ms": 4, "mec": color, "zorder": 3}
        axes.errorbar(mach, pick(values), pick(errors), color=color, mew=0.6, lw=1.6, capsize=3, label=label, **look)
        loose = [(entries[index].mach, values[index]) for index in keep if not entries[index].converged]
        for at, value in loose:
            known = "not converged" in axes.get_legend_handles_labels()[1]
            axes.plot(at, value, "X", color=PAPER, ms=9, mec="white", zorder=6, label=None if known else "not converged")


def draw_published(axes: plt.Axes, results: Results, quantity: Quantity) -> None:
    data = results.published
    paper = list(data.paper.values())
    sets: dict[str, list[tuple[list[Row], str, tuple[str, ...], str, str, str]]] = {
        "cm_alpha": [
            (paper, "mach", ("static_field",), "s", PAPER, "paper, field velocity"),
            (paper, "mach", ("static_experiment",), "^", MEASURED, "paper, tunnel experiment"),
            (data.flight, "Mach", ("Cma",), "x", OTHER, "free flight, DREV, 5.5 d"),
        ],
        "cm_alphadot": [
            (paper, "mach", ("acceleration_field",), "s", PAPER, "paper, field velocity"),
            (of(data.sznajder, "Cm_alphadot"), "Mach", ("value",), "d", OTHER, "RANS, Sznajder (read ±8), 6.1 d"),
        ],
        "cm_q": [
            (paper, "mach", ("damping_field",), "s", PAPER, "paper, field velocity"),
            (of(data.sznajder, "Cmq"), "Mach", ("value",), "d", OTHER, "RANS, Sznajder (read ±15), 6.1 d"),
        ],
        "damping_sum": [
            (paper, "mach", ("damping_field", "acceleration_field"), "s", PAPER, "paper, field velocity"),
            (data.rans, "Mach", ("PDM",), "D", OTHER, "RANS, ARL, 5.5 d"),
            (data.flight, "Mach", ("Cmq_plus_Cmad",), "x", MEASURED, "free flight, DREV, 5.5 d"),
        ],
        "cn_alpha": [(data.flight, "Mach", ("CNa",), "x", MEASURED, "free flight, DREV")],
    }
    for rows, mach, names, marker, color, label in sets.get(quantity.name, []):
        values = sum(column(rows, name) for name in names)
        axes.plot(column(rows, mach), values, marker, mfc="none", ms=7, color=color, label=label, zorder=2)


def of(rows: list[Row], quantity: str) -> list[Row]:
    return [row for row in rows if row["quantity"] == quantity]


def read_columns(path: Path) -> dict[str, np.ndarray]:
    """Columns of a CSV file of a run, or {} if there is none."""
    try:
        with open(path) as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    except OSError:
        return {}
    return {name: column(rows, name) for name in rows[0]} if rows else {}


def loop_figures(results: Results, folder: Path) -> list[Picture]:
    """Fig. 4 of the paper for every plunge."""
    pictures = []
    for entry in results.with_derivatives:
        history = read_columns(entry.run.folder / HISTORY)
        if entry.run.method == "plunge" and "total/Cm" in history:
            center = results.center or results.here(entry).center
            steps = Runs(results.program, [entry.run.folder / "history.h5"]).about(center)[0]
            pictures += draw_loop(entry, history, results.about(entry, center), steps, folder)
    return pictures


def draw_loop(
    entry: Entry, history: dict[str, np.ndarray], here: Derivatives, steps: Derivatives, folder: Path
) -> list[Picture]:
    """The loop of Cm against alpha, and the same without its static part, where it can be seen; `here` and `steps` are from the
    result.json and the history.h5 of the run, about one centre.

    The static part is a parabola: the line that the derivative gives, and mean and curvature fitted to what the ellipse leaves.
    """
    with h5py.File(entry.run.folder / "history.h5") as file:
        k, mean, amplitude = (float(file.attrs[name]) for name in ("reduced_frequency", "alpha", "amplitude"))
    alpha = np.degrees(history["alpha"])
    cm = np.array(steps.Cm)
    fitted = history["t_star"] > math.pi / k - 1e-6  # the fit leaves out the first half cycle
    phase = np.linspace(0.0, 2.0 * math.pi, 361)
    swept = mean + amplitude * np.sin(phase)
    opening = lambda angle: here.Cm_alphadot * math.radians(amplitude) * k * np.cos(angle)
    line = lambda degrees: here.Cm[0] + here.Cm_alpha * np.radians(degrees - mean)
    left = cm - line(alpha) - opening(k * history["t_star"])
    columns = np.stack([np.ones_like(alpha), (alpha - mean) ** 2], axis=1)
    offset, curvature = np.linalg.lstsq(columns[fitted], left[fitted], rcond=None)[0]
    static = lambda degrees: line(degrees) + offset + curvature * (degrees - mean) ** 2
    rest, ellipse = cm - static(alpha), opening(phase)
    pictures = []
    for name, scale, base_at, base_curve, ylabel, title in (
        ("loop", 1.0, static(alpha), static(swept), f"Cm about {here.center:.3f} d, nose up +", "Cm against alpha"),
        ("loop_open", 1e3, 0.0 * alpha, 0.0 * swept, "10³ × (Cm − static part)", "without its static part"),
    ):
        figure, axes = panel("angle of attack α, deg", ylabel)
        axes.plot(
            swept[90:271],
            scale * base_curve[90:271],
            color=MEASURED,
            lw=1,
            ls="--",
            label=rf"static part, slope $C_{{m\alpha}}$ = {here.Cm_alpha:.2f}",
        )
        curve = scale * (base_curve + ellipse)
        axes.plot(swept, curve, color=PAPER, lw=1.6, label=rf"ellipse, $C_{{m\dot\alpha}}$ = {here.Cm_alphadot:.2f}")
        points = scale * (base_at + rest)
        axes.plot(alpha[~fitted], points[~fitted], "o", ms=4, mfc="none", color=HERE, label="first half cycle")
        axes.plot(alpha[fitted], points[fitted], "o", ms=4, color=HERE, label="cycle that is fitted")
        if name == "loop_open":
            for at in (0, 180):
                axes.annotate(
                    "", (swept[at + 12], curve[at + 12]), (swept[at], curve[at]), arrowprops={"arrowstyle": "-|>", "color": PAPER}
                )
        axes.set_title(f"Mach {entry.mach:g}: {title}", fontsize=11)
        axes.legend()
        caption = f"α = {mean:g}° + {amplitude:g}° sin(k t*), k = {k:g}"
        pictures.append(save(figure, folder, f"{name}_{entry.run.name}", f"Mach {entry.mach:g}: {title}", caption))
    return pictures


NAMED = 10  # marches that a legend has room for
MANY = "all in grey; named are those that ended short and took longest"


def draw_marches(axes: plt.Axes, histories: list[tuple[Entry, dict[str, np.ndarray]]]) -> None:
    """Each with its name; of many only those that are not converged and the longest, the others in grey."""
    rank = lambda item: (item[0].converged, -float(item[1]["iteration"][-1]))
    named = sorted(histories, key=rank)[: NAMED if len(histories) <= NAMED else 6]
    names = {entry.run.name for entry, _ in named}
    for entry, history in histories:
        if entry.run.name not in names:
            axes.plot(history["iteration"], -history["orders"], color="#8a97a5", lw=0.6, alpha=0.35, rasterized=True)
    for index, (entry, history) in enumerate(named):
        color = PAPER if not entry.converged else plt.get_cmap("viridis")(index / max(1, len(named) - 1) * 0.92)
        style = "--" if entry.run.is_motion else "-"
        axes.plot(history["iteration"], -history["orders"], style, color=color, lw=1.3, label=entry.label.replace("_", " "))
    axes.legend(fontsize=7)


def convergence_figures(results: Results, folder: Path) -> list[Picture]:
    """The steady marches in one figure, the inner iterations of the motions in another."""
    pictures = []
    histories = [(entry, read_columns(entry.run.folder / STEADY)) for entry in results.entries]
    histories = [(entry, history) for entry, history in histories if "orders" in history]
    if histories:
        figure, axes = panel("iteration", "density residual, decades")
        draw_marches(axes, histories)
        axes.set_title("Steady marches", fontsize=11)
        pictures.append(save(figure, folder, "convergence_steady", "Steady marches", MANY if len(histories) > NAMED else ""))
    motions = [(entry, read_columns(entry.run.folder / HISTORY)) for entry in results.entries if entry.run.is_motion]
    motions = [(entry, history) for entry, history in motions if "inner_iterations" in history]
    if motions:
        figure, axes = panel("t* = 2 V t / length", "inner iterations a step")
        for (entry, history), color in zip(motions[:NAMED], COLORS * 2):
            axes.plot(history["t_star"], history["inner_iterations"], color=color, lw=1.3, label=entry.label.replace("_", " "))
        axes.set_ylim(bottom=0)
        axes.set_title("Motions", fontsize=11)
        axes.legend(fontsize=7)
        pictures.append(save(figure, folder, "convergence_motion", "Motions: work of each time step"))
        figure, axes = panel("t* = 2 V t / length", "|error of Cm| left by the inner iterations")
        for (entry, history), color in zip(motions[:NAMED], COLORS * 2):
            axes.semilogy(
                history["t_star"],
                np.abs(history["error/Cm"]) + 1e-16,
                color=color,
                lw=1.3,
                label=entry.label.replace("_", " "),
            )
        axes.set_title("Motions", fontsize=11)
        axes.legend(fontsize=7)
        pictures.append(save(figure, folder, "convergence_error", "Motions: error left in Cm"))
    return pictures


def cut_figures(flows: list[list[cuts.Cut]], names: Sequence[str], colors: Sequence[tuple], folder: Path) -> list[Picture]:
    """A panel a cut and quantity that some flow has, a line a flow."""
    out = []
    labels = dict.fromkeys(one.label for flow in flows for one in flow)
    for number, label in enumerate(labels, 1):
        same = [(one, color) for flow, color in zip(flows, colors) for one in flow if one.label == label]
        for name in [name for name in names if any(name in one.values for one, _ in same)]:
            words = cuts.labels(same[0][0], name)
            figure, axes = panel(words["xlabel"], words["ylabel"])
            for one, color in same:
                if name in one.values:
                    cuts.draw(axes, one, name, color=color, linewidth=1.1)
            axes.set_title(f"{words['ylabel']}, {label}", fontsize=11)
            figure.savefig(folder / f"cut{number}_{name}.png", dpi=110)
            plt.close(figure)
            out.append(Picture(folder / f"cut{number}_{name}.png", f"{words['ylabel']} in the cut {label}"))
    return out
