#!/usr/bin/python3
"""Draws where along the body its derivatives sit, as `alphadot derivatives` has found them.

    scripts/along_body.py RUN [RUN ...] [--of CN,Cm] [--by alpha,q,alphadot] [--part total] [-o along_body]

A row of pictures a load: what it holds per unit of length, and below it the sum from the nose on, which ends at the derivative itself.
One curve a run. With `--part NAME` of a set of walls of [components]. Needs Debian's python3-numpy and python3-matplotlib.
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
    sys.exit(f"along_body.py: {error}; run scripts/install.sh, and then this with /usr/bin/python3")

Curve = tuple[np.ndarray, np.ndarray, np.ndarray]  # ends of the slices, per unit of length, sum up to each end


def curves_of(folder: Path, part: str) -> dict[str, Curve]:
    found: dict[str, list[tuple[float, ...]]] = {}
    for row in rows_of_run(folder, "along_body.csv", "derivatives"):
        if row["of"] == part:
            numbers = tuple(float(row[key]) for key in ("x_from", "x_to", "per_length", "running"))
            found.setdefault(row["name"], []).append(numbers)
    if not found:
        sys.exit(f"along_body.py: {folder / 'along_body.csv'} has nothing of {part}")
    return {name: curve(np.array(rows)) for name, rows in found.items()}


def curve(rows: np.ndarray) -> Curve:
    return np.append(rows[:, 0], rows[-1, 1]), rows[:, 2], np.append(0.0, rows[:, 3])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("runs", nargs="+", type=Path, metavar="RUN", help="folder of `alphadot derivatives`")
    parser.add_argument("--of", default="CN,Cm", help="loads (default: CN,Cm)")
    parser.add_argument("--by", default="alpha,q,alphadot", help="variables (default: alpha,q,alphadot)")
    parser.add_argument("--part", default="total", help="of the configuration: total, or a set of [components] (default: total)")
    parser.add_argument("-o", "--output", type=Path, default=Path("along_body"), help="pictures without their suffix (default: along_body)")
    arguments = parser.parse_args()
    loads, variables = arguments.of.split(","), arguments.by.split(",")
    size = {"figsize": (4.6 * len(variables), 4.6 * len(loads)), "squeeze": False, "layout": "constrained", "sharex": True}
    figure, axes = plt.subplots(2 * len(loads), len(variables), **size)
    for run in arguments.runs:
        curves = curves_of(run, arguments.part)
        for i, load in enumerate(loads):
            for j, variable in enumerate(variables):
                name = f"{load}_{variable}"
                if name not in curves:
                    sys.exit(f"along_body.py: {run}/along_body.csv has no {name} of {arguments.part}")
                ends, per_length, running = curves[name]
                axes[2 * i, j].stairs(per_length, ends, label=run.name)
                axes[2 * i, j].set(title=name, ylabel=f"d {name} / dx")
                axes[2 * i + 1, j].plot(ends, running, label=f"{run.name}: {running[-1]:.4g}")
                axes[2 * i + 1, j].set(ylabel=f"{name} up to x", xlabel="x")
    finish(figure, arguments.output)
    print(f"{arguments.output.with_suffix('.png')}, {arguments.output.with_suffix('.svg')}")


if __name__ == "__main__":
    main()
