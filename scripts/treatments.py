#!/usr/bin/python3
"""One harmonic motion by field velocity, on a rigid and on a deforming grid: derivatives, cost, and loops over each other.

Runs the steady flow of a case once, and from it the case's motion in each treatment. Writes treatments.txt and treatments.csv
(derivatives, the greatest difference of the histories from the first treatment's, processor time of a cycle), loops.svg and
loops.png (the paper's Fig. 4). Needs Debian's python3-numpy, python3-h5py and python3-matplotlib (hence /usr/bin/python3).
"""

from __future__ import annotations

import argparse
import csv
import math
import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

try:
    import h5py
    import matplotlib.pyplot as plt
    import numpy as np

    from sweep.figures import COLORS, STYLE, read_columns, save
    from sweep.text import aligned
    from table_one import read_result
except ImportError as error:
    sys.exit(f"treatments.py: {error}; run scripts/install.sh, and then this with /usr/bin/python3")

ROOT = Path(__file__).resolve().parents[1]
TREATMENTS = ("field_velocity", "rigid_grid", "deforming_grid")
LONGITUDINAL = ("CN", "Cm")
MARKERS = ("-", "o", "x")


@dataclass(frozen=True)
class Run:
    """The case's motion in one treatment."""

    treatment: str
    derivatives: dict[str, float]  # per radian
    history: dict[str, np.ndarray]
    reduced_frequency: float
    cpu_s: float  # of the motion, over all ranks

    @property
    def cycles(self) -> float:
        return self.reduced_frequency * self.history["t_star"][-1] / (2.0 * math.pi)

    @property
    def cpu_per_cycle(self) -> float:
        return self.cpu_s / self.cycles

    @property
    def fitted(self) -> np.ndarray:
        """Steps of the whole cycles that derivatives are fitted to."""
        return self.history["t_star"] > math.pi / self.reduced_frequency - 1e-6

    def difference(self, other: Run) -> float:
        """Greatest difference of CN and Cm at any step, over half the range that the other's runs through."""
        names = [f"total/{name}" for name in LONGITUDINAL]
        return max(2.0 * np.abs(self.history[name] - other.history[name]).max() / np.ptp(other.history[name]) for name in names)


def call(arguments: argparse.Namespace, folder: Path, *options: str) -> None:
    """`alphadot run CASE` in `folder`."""
    launcher = ["mpirun", "-n", str(arguments.ranks)] if arguments.ranks > 1 else []
    overrides = [part for setting in arguments.set for part in ("--set", setting)]
    command = [*launcher, arguments.program, "run", arguments.case, "--out", folder, "--overwrite", "--quiet", *overrides, *options]
    done = subprocess.run(command, text=True, stderr=subprocess.PIPE, env={**os.environ, "OMPI_MCA_rmaps_base_oversubscribe": "1"})
    if done.returncode != 0:
        sys.exit(f"treatments.py: {' '.join(map(str, command))} failed:\n{done.stderr}")


def read_run(folder: Path, treatment: str) -> Run:
    result = read_result(folder)
    with h5py.File(folder / "history.h5") as file:
        k = float(file.attrs["reduced_frequency"])
    derivatives = {name: entry["value"] for name, entry in result["derivatives"].items() if name.startswith(LONGITUDINAL)}
    return Run(treatment, derivatives, read_columns(folder / "history.csv"), k, result["performance"]["motion_cpu_s"])


def table(runs: list[Run]) -> list[list[str]]:
    first = runs[0]
    rows = [["treatment", *first.derivatives, "difference", "cpu_s_per_cycle", "ratio"]]
    for run in runs:
        values = [f"{run.derivatives[name]:.5g}" for name in first.derivatives]
        cost = [f"{run.cpu_per_cycle:.4g}", f"{run.cpu_per_cycle / first.cpu_per_cycle:.3f}"]
        rows.append([run.treatment, *values, f"{run.difference(first):.1e}", *cost])
    return rows


def draw_loops(runs: list[Run], folder: Path) -> None:
    """Cm against alpha, and what is left without the static part: the parabola through the first treatment's cycle."""
    first = runs[0]
    alpha = lambda run: np.degrees(run.history["alpha"][run.fitted])
    cm = lambda run: run.history["total/Cm"][run.fitted]
    static = np.polynomial.Polynomial.fit(alpha(first), cm(first), 2)
    with plt.rc_context(STYLE):
        figure, (whole, rest) = plt.subplots(1, 2, figsize=(9.0, 3.8), layout="constrained")
        for index, (run, color, look) in enumerate(zip(runs, COLORS, MARKERS)):
            style = {"color": color, "label": run.treatment.replace("_", " "), "mfc": "none", "ms": 7 - index, "lw": 1.6}
            whole.plot(alpha(run), cm(run), look, **style)
            rest.plot(alpha(run), 1e3 * (cm(run) - static(alpha(run))), look, **style)
        whole.set(xlabel="angle of attack α, deg", ylabel="Cm, nose up +", title="Cm against alpha")
        rest.set(xlabel="angle of attack α, deg", ylabel="10³ × (Cm − static part)", title="without its static part")
        whole.legend()
        save(figure, folder, "loops", "Loops of the treatments")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("case", type=Path, help="with a harmonic [motion]")
    parser.add_argument("--out", type=Path, default=Path("runs/treatments"), help="folder (default: runs/treatments)")
    parser.add_argument("--only", nargs="+", choices=TREATMENTS, default=TREATMENTS, help="treatments (default: all)")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="replace a key of the case")
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--program", type=Path, default=ROOT / "build" / "alphadot")
    arguments = parser.parse_args()
    for file in (arguments.case, arguments.program):
        if not file.exists():
            parser.error(f"there is no {file}")

    # Each treatment goes on from the checkpoint of this run of no time steps: the cost is that of the motion alone.
    steady = arguments.out / "steady"
    call(arguments, steady, "--set", "motion.kind=none")
    checkpoint = max(steady.glob("checkpoint_*.vtkhdf"))
    for treatment in arguments.only:
        call(arguments, arguments.out / treatment, "--set", f"motion.treatment={treatment}", "--restart", str(checkpoint))
    runs = [read_run(arguments.out / treatment, treatment) for treatment in arguments.only]

    rows = table(runs)
    with open(arguments.out / "treatments.csv", "w", newline="") as file:
        csv.writer(file).writerows(rows)
    text = aligned(rows)
    (arguments.out / "treatments.txt").write_text(text + "\n")
    draw_loops(runs, arguments.out)
    print(text)


if __name__ == "__main__":
    main()
