#!/usr/bin/python3
"""Basic Finner derivatives beside Table I, Fig. 4 and Fig. 5 of the field-velocity paper and other published values.

Reads what scripts/demo.sh has run: FOLDER/plunge (a harmonic plunge) and FOLDER/mach_* (derivatives at the paper's Mach numbers).
Prints the comparison and writes it to FOLDER as table_one.txt, loop.png and mach.png. Needs Debian's python3-numpy, python3-h5py
and python3-matplotlib (hence /usr/bin/python3).
"""

from __future__ import annotations

import argparse
import csv
import json
import math
import sys
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

try:
    import h5py
    import matplotlib
    import numpy as np
except ImportError as error:
    sys.exit(f"table_one.py: {error}; run scripts/install.sh, and then this with /usr/bin/python3")
matplotlib.use("Agg")
import matplotlib.pyplot as plt

from sweep.derive import Derivatives, Runs
from sweep.plan import SweepError
from sweep.runner import find_program

REFERENCE = Path(__file__).resolve().parents[1] / "cases" / "basic_finner" / "reference"
FREE_FLIGHT_CENTER = 5.5  # d from the nose: DREV-TM-9703, ARL-TR-6725
SZNAJDER_CENTER = 6.1
HERE, PAPER, MEASURED, OTHER = "#1f5fa8", "#c0392b", "#202020", "#2e8b57"
CM_ALPHA, CM_ALPHADOT, CM_Q = r"$C_{m\alpha}$", r"$C_{m\dot\alpha}$", r"$C_{mq}$"

Row = dict[str, str]


def read_result(folder: Path) -> dict:
    """The result.json of a run that came to its end."""
    path = folder / "result.json"
    result = json.loads(path.read_text())
    if result["status"] not in ("converged", "completed"):
        sys.exit(f"table_one.py: {path}: the run ended as '{result['status']}': {result['message']}")
    return result


def read_table(name: str, keep: Callable[[Row], bool] = lambda row: True) -> list[Row]:
    """Rows of a file of published values."""
    with open(REFERENCE / name) as file:
        return [row for row in csv.DictReader(line for line in file if not line.startswith("#")) if keep(row)]


def column(rows: Iterable[Row], name: str) -> np.ndarray:
    return np.array([float(row[name]) for row in rows])


def fitted_center(runs: Runs, of: Sequence[int], static: np.ndarray) -> float:
    """The one centre that brings Cm_alpha of the runs with the numbers `of` nearest to `static` (n,): least squares on the relative
    misfit. Cm_alpha is linear in the centre: two centres tell the rest."""
    start = runs.here[of[0]].center
    first, second = (np.array([runs.about(at)[index].Cm_alpha for index in of]) / static for at in (start, start + 1.0))
    slope, wanted = second - first, 1.0 - first
    return start + float(slope @ wanted / (slope @ slope))


def number(value: float) -> str:
    """A value in a column of the table; a dash where there is none."""
    return f"{'-':>7}" if math.isnan(value) else f"{value:7.1f}"


def percent(value: float, of: float) -> str:
    return f"{100 * (value / of - 1):+6.1f} %"


def uncertainty_of(results: Iterable[dict]) -> str:
    """What the uncertainties of some results hold."""
    return "; ".join(dict.fromkeys(result.get("uncertainty") or "not known" for result in results))


def table(plain: list[Derivatives], fitted: list[Derivatives], paper: dict[float, Row], reference: dict, uncertainty: str) -> str:
    """The comparison as text: runs about 5.5 d, then about the fitted centre beside the paper's values."""
    width, center = max(len(run.method) for run in plain), fitted[0].center
    head = f"  Mach  {'method':<{width}}"
    start = lambda run: f"  {run.mach:4.2f}  {run.method:<{width}}"
    lines = [
        "Basic Finner at alpha = 1.5 deg, beside Table I of the field-velocity paper (Euler, k = 0.01) and its tunnel experiment",
        "",
        f"  Reference: length {reference['length']:g} d, area {reference['area']:.6f} d^2 (pi/4, whole model); x in d from the nose.",
        f"  Axes: {reference['axes']}.",
        f"  Per radian; rates times {reference['rate']}: Cm_alphadot = dCm / d(alphadot d / 2V).",
        f"  Uncertainty, in each run's result.json: {uncertainty}.",
        f"  Centre: the paper does not state its own. x_ref = {center:.3f} d is one least-squares fit, on relative misfit, to its",
        "  five static values. Its acceleration and damping values are not in the fit: about x_ref ours are predictions of them.",
        "",
        f"About {FREE_FLIGHT_CENTER} d, the centre of the free-flight data",
        f"{head}  CN_alpha  Cm_alpha  CN_alphadot  Cm_alphadot     Cm_q",
    ]
    for run in plain:
        acceleration = f"{run.CN_alphadot:11.2f}  {run.Cm_alphadot:11.2f}"
        lines.append(f"{start(run)}  {run.CN_alpha:8.3f}  {run.Cm_alpha:8.3f}  {acceleration}  {number(run.Cm_q)}")
    beside = [(run, {name: float(value) for name, value in paper[run.mach].items()}) for run in fitted]
    columns = f"{head}      here  paper: field      grid"
    values = lambda run, name, row, key: (
        f"{start(run)}  {getattr(run, name):8.2f}  {row[key + '_field']:12.2f}  {row[key + '_grid']:8.2f}"
    )
    lines += ["", f"Cm_alpha about x_ref = {center:.3f} d, fitted", f"{columns}  here/field  experiment  here/experiment"]
    for run, row in beside:
        tunnel = row["static_experiment"]
        lines.append(
            f"{values(run, 'Cm_alpha', row, 'static')}  {percent(run.Cm_alpha, row['static_field']):>10}"
            f"  {tunnel:10.2f}  {percent(run.Cm_alpha, tunnel):>15}"
        )
    lines += ["", f"Cm_alphadot about x_ref = {center:.3f} d, predicted", f"{columns}  here - field"]
    for run, row in beside:
        lines.append(f"{values(run, 'Cm_alphadot', row, 'acceleration')}  {run.Cm_alphadot - row['acceleration_field']:+12.2f}")
    lines += ["", f"Cm_q (the paper's damping derivative) about x_ref = {center:.3f} d, predicted", f"{columns}  here/field"]
    for run, row in beside:
        if not math.isnan(run.Cm_q):
            lines.append(f"{values(run, 'Cm_q', row, 'damping')}  {percent(run.Cm_q, row['damping_field']):>10}")
    return "\n".join(lines) + "\n"


def draw_loop(folder: Path, steady: Derivatives, steps: Derivatives, picture: Path) -> None:
    """Fig. 4: Cm against alpha, and what is left without the static part, where the loop can be seen; from what the folder's
    result.json and history.h5 say about one centre."""
    with open(folder / "history.csv") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    with h5py.File(folder / "history.h5") as history:
        k, mean, amplitude = (float(history.attrs[name]) for name in ("reduced_frequency", "alpha", "amplitude"))
    alpha = np.degrees(column(rows, "alpha"))
    cm = np.array(steps.Cm)
    fitted = column(rows, "t_star") > math.pi / k - 1e-6  # the fit leaves out the first half cycle

    static = lambda degrees: steady.Cm[0] + steady.Cm_alpha * np.radians(degrees - mean)
    rest = cm - static(alpha)
    phase = np.linspace(0.0, 2.0 * math.pi, 361)
    swept = mean + amplitude * np.sin(phase)
    # Cm is a little quadratic in alpha: the mean of the cycle is not the steady value.
    ellipse = np.mean(rest[fitted]) + steady.Cm_alphadot * math.radians(amplitude) * k * np.cos(phase)

    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.8), layout="constrained")
    for axes, points, line, loop in (
        (left, cm, static(swept), static(swept) + ellipse),
        (right, 1e3 * rest, 0.0 * swept, 1e3 * ellipse),
    ):
        axes.plot(swept[90:271], line[90:271], color=MEASURED, lw=1.0, ls="--", label=f"static line, {CM_ALPHA} = {steady.Cm_alpha:.2f}")
        axes.plot(swept, loop, color=PAPER, lw=1.6, label=f"ellipse, {CM_ALPHADOT} = {steady.Cm_alphadot:.2f}")
        axes.plot(alpha[~fitted], points[~fitted], "o", ms=4, mfc="none", color=HERE, label="computed, first half cycle")
        axes.plot(alpha[fitted], points[fitted], "o", ms=4, color=HERE, label="computed, the cycle that is fitted")
        axes.set_xlabel("angle of attack α, deg")
        axes.grid(alpha=0.3)
    for at in (0, 180):
        ends = [(swept[i], 1e3 * ellipse[i]) for i in (at + 12, at)]
        right.annotate("", *ends, arrowprops={"arrowstyle": "-|>", "color": PAPER, "mutation_scale": 18})
    left.set_ylabel(f"Cm about x = {steady.center:.3f} d from the nose, nose up +")
    left.set_title("The loop (the paper's Fig. 4)", fontsize=11)
    left.legend(fontsize=9)
    right.set_ylabel("10³ × (Cm − static line)")
    right.set_title(rf"Without its static part: area = $\pi\, k\, \alpha_m^2$ {CM_ALPHADOT}", fontsize=11)
    figure.suptitle(
        f"Basic Finner, plunge at Mach {steady.mach:g}: α = {mean:g}° + {amplitude:g}° sin(k t*), k = ωd/2V = {k:g}\n"
        "length d, area πd²/4; derivatives per rad, α̇ times d/2V",
        fontsize=11,
    )
    figure.savefig(picture, dpi=110)


def draw_mach(runs: Runs, of: slice, paper: list[Row], center: float, picture: Path) -> None:
    """Fig. 5: derivatives of the runs `of` against Mach number; ours about the centre of each set of published values."""
    in_range = lambda row: 1.5 <= float(row["Mach"]) <= 2.75
    flight = read_table("finner_free_flight_DREV_TM_9703.csv", lambda row: in_range(row) and row["flag"] == "ok")
    rans = read_table("finner_rans_ARL_TR_6725.csv", lambda row: in_range(row) and row["method"] == "planar_pitching")
    sznajder = read_table("finner_sznajder2025.csv", lambda row: in_range(row) and row["quantity"] == "Cm_alphadot")

    def ours(axes: plt.Axes, names: tuple[str, ...], *also_about: float) -> None:
        for x, style in zip((center, FREE_FLIGHT_CENTER, *also_about), ("o-", "o--", "o:")):
            sweep = runs.about(x)[of]
            values = [sum(getattr(run, name) for name in names) for run in sweep]
            label = f"alphadot, about {x:.2f} d" + (" (fitted)" if x == center else "")
            axes.plot([run.mach for run in sweep], values, style, color=HERE, lw=1.6, ms=4, label=label)

    def published(axes: plt.Axes, rows: list[Row], mach: str, names: tuple[str, ...], style: str, color: str, label: str) -> None:
        values = sum(column(rows, name) for name in names)
        axes.plot(column(rows, mach), values, style, mfc="none", ms=7, color=color, label=label)

    figure, (static, acceleration, damping) = plt.subplots(1, 3, figsize=(14, 5.2), layout="constrained")
    ours(static, ("Cm_alpha",))
    published(static, paper, "mach", ("static_field",), "s", PAPER, "paper, field velocity")
    published(static, paper, "mach", ("static_experiment",), "^", MEASURED, "paper, tunnel experiment")
    published(static, flight, "Mach", ("Cma",), "x", OTHER, f"free flight, DREV, {FREE_FLIGHT_CENTER} d")
    static.set_title(f"Static: {CM_ALPHA}", fontsize=11)

    ours(acceleration, ("Cm_alphadot",), SZNAJDER_CENTER)
    published(acceleration, paper, "mach", ("acceleration_field",), "s", PAPER, "paper, field velocity")
    published(acceleration, sznajder, "Mach", ("value",), "d", OTHER, f"RANS, Sznajder (read ±8), {SZNAJDER_CENTER} d")
    acceleration.axhline(0.0, color=MEASURED, lw=0.6)
    acceleration.set_title(f"Acceleration: {CM_ALPHADOT}", fontsize=11)

    ours(damping, ("Cm_q", "Cm_alphadot"))
    published(damping, paper, "mach", ("damping_field", "acceleration_field"), "s", PAPER, "paper, field velocity")
    published(damping, rans, "Mach", ("PDM",), "D", OTHER, f"RANS, ARL, {FREE_FLIGHT_CENTER} d")
    published(damping, flight, "Mach", ("Cmq_plus_Cmad",), "x", OTHER, f"free flight, DREV, {FREE_FLIGHT_CENTER} d")
    damping.set_title(f"Pitch damping: {CM_Q} + {CM_ALPHADOT}", fontsize=11)

    for axes, corner in ((static, "lower right"), (acceleration, "upper right"), (damping, "lower right")):
        axes.set_xlabel("Mach number")
        axes.set_ylabel("derivative, per rad")
        axes.set_xlim(1.45, 2.8)
        axes.grid(alpha=0.3)
        axes.legend(fontsize=8, handlelength=3.0, loc=corner)
    figure.suptitle(
        "Basic Finner (the paper's Fig. 5): derivatives of Cm, nose up +, per rad; length d, area πd²/4, rates times d/2V\n"
        f"moment centre in d from the nose; the paper's is not stated: {center:.2f} d is fitted to its static values",
        fontsize=11,
    )
    figure.savefig(picture, dpi=110)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path, help="folder of scripts/demo.sh, with the runs plunge and mach_*")
    parser.add_argument("--program", metavar="FILE", help="the program (default: $ALPHADOT, build/alphadot, or on the PATH)")
    arguments = parser.parse_args()
    folder, plunge = arguments.folder, arguments.folder / "plunge"
    results = {path.parent: read_result(path.parent) for path in folder.glob("mach_*/result.json")}
    mach_of = lambda run: results[run]["freestream"]["mach"]
    sweep = sorted(results, key=mach_of)
    rows = read_table("paper_table1.csv")
    paper = {float(row["mach"]): row for row in rows}
    if list(map(mach_of, sweep)) != list(paper):
        parser.error(f"{folder}/mach_* hold Mach {list(map(mach_of, sweep))}, wanted are the paper's {list(paper)}")
    results[plunge] = read_result(plunge)

    try:
        files = [*(run / "result.json" for run in [*sweep, plunge]), plunge / "history.h5"]
        runs = Runs(find_program(arguments.program), files)
        center = fitted_center(runs, range(len(sweep)), column(rows, "static_field"))
        *plain, _ = runs.about(FREE_FLIGHT_CENTER)
        *fitted, steps = runs.about(center)
        text = table(plain, fitted, paper, results[plunge]["reference"], uncertainty_of(results.values()))
        (folder / "table_one.txt").write_text(text)
        draw_loop(plunge, fitted[-1], steps, folder / "loop.png")
        draw_mach(runs, slice(len(sweep)), rows, center, folder / "mach.png")
    except SweepError as error:
        sys.exit(f"table_one.py: {error}")
    print(text)
    print(f"Table:                                         {folder}/table_one.txt")
    print(f"Loop of Cm against alpha, the paper's Fig. 4:  {folder}/loop.png")
    print(f"Derivatives against Mach number, its Fig. 5:   {folder}/mach.png")


if __name__ == "__main__":
    main()
