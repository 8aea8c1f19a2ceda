#!/usr/bin/python3
"""Draws what `alphadot frequency` has found: Bode and Nyquist diagrams of the loads.

    scripts/bode.py RUN [RUN ...] [--of CN,Cm] [--by alpha] [--part total] [-o bode]

One colour a run; the bars are the printed uncertainties, the lines of the whole configuration the run's rational fit. Needs Debian's
python3-numpy and python3-matplotlib.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

try:
    import matplotlib.pyplot as plt
    import numpy as np

    from drawing import finish
    from run_csv import rows_of_run
except ImportError as error:
    sys.exit(f"bode.py: {error}; run scripts/install.sh, and then this with /usr/bin/python3")


def rational_fit(run: Path, load: str, variable: str, k: np.ndarray) -> np.ndarray | None:
    """The response that the states of rational_fit.csv give; nothing where there is none."""
    if not (run / "rational_fit.csv").exists():
        return None
    rows = [row for row in rows_of_run(run, "rational_fit.csv", "frequency") if row["variable"] == variable]
    value = lambda matrix, row, column: next(
        (float(r["value"]) for r in rows if (r["matrix"], r["row"], r["column"]) == (matrix, str(row), str(column))), 0.0
    )
    if not any(row["matrix"] == "d" and row["row"] == load for row in rows):
        return None
    states = range(1, 1 + max((int(row["column"]) for row in rows if row["matrix"] == "c"), default=0))
    a = np.array([[value("A", i, j) for j in states] for i in states])
    b, c = np.array([value("b", i, 1) for i in states]), np.array([value("c", load, n) for n in states])
    return np.array([c @ np.linalg.solve(1j * at * np.eye(len(states)) - a, b) for at in k]) + value("d", load, 1)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("runs", nargs="+", type=Path, metavar="RUN", help="folder of `alphadot frequency`")
    parser.add_argument("--of", default="CN,Cm", help="loads (default: CN,Cm)")
    parser.add_argument("--by", default="alpha", help="variable that oscillates (default: alpha)")
    parser.add_argument("--part", default="total", help="of the configuration: total, or a patch (default: total)")
    parser.add_argument("-o", "--output", type=Path, default=Path("bode"), help="pictures without their suffix (default: bode)")
    arguments = parser.parse_args()
    loads = arguments.of.split(",")
    figure, axes = plt.subplots(len(loads), 3, figsize=(13, 3.8 * len(loads)), squeeze=False, layout="constrained")
    for run in arguments.runs:
        rows = rows_of_run(run, "frequency.csv", "frequency")
        for (modulus, phase, nyquist), load in zip(axes, loads, strict=True):
            mine = [row for row in rows if (row["part"], row["coefficient"], row["variable"]) == (arguments.part, load, arguments.by)]
            if not mine:
                sys.exit(f"bode.py: {run}/frequency.csv has no {load} by {arguments.by} of {arguments.part}")
            k, real, lag, real_error, lag_error = (
                np.array([float(row[name]) for row in mine])
                for name in ("k", "in_phase", "out_of_phase", "in_phase_uncertainty", "out_of_phase_uncertainty")
            )
            response, error = real + 1j * k * lag, np.hypot(real_error, k * lag_error)
            fine = np.geomspace(k[0], k[-1], 200)
            fit = rational_fit(run, load, arguments.by, fine) if arguments.part == "total" else None
            style = {"label": run.name, "marker": "o", "markersize": 3, "linestyle": "-" if fit is None else "none"}
            if fit is not None:
                color = modulus.plot(fine, np.abs(fit))[0].get_color()
                style["color"] = color
                phase.plot(fine, np.degrees(np.unwrap(np.angle(fit))), color=color)
                nyquist.plot(fit.real, fit.imag, color=color)
            modulus.errorbar(k, np.abs(response), error, **style)
            phase.errorbar(k, np.degrees(np.unwrap(np.angle(response))), np.degrees(error / np.abs(response)), **style)
            nyquist.plot(response.real, response.imag, **style)
            for at in {0, len(k) - 1}:
                nyquist.annotate(f"k = {k[at]:g}", (response[at].real, response[at].imag), fontsize=8)
            for plot, name in ((modulus, f"|{load}| per rad of {arguments.by}"), (phase, f"phase of {load}, degrees")):
                plot.set(xscale="log", xlabel="k = ω l / 2V", ylabel=name)
            nyquist.set(xlabel=f"{load} in phase", ylabel=f"{load} a quarter ahead")
    finish(figure, arguments.output)
    print(f"{arguments.output.with_suffix('.png')}, {arguments.output.with_suffix('.svg')}")


if __name__ == "__main__":
    main()
