#!/usr/bin/python3
"""Draws the response of a thin section to a step in alpha beside exact linear theory of the flat plate.

  ./indicial.py RUN [-o indicial.png]     RUN: folder of `alphadot run step.toml`

Needs Debian's python3-matplotlib and python3-numpy.
"""

from __future__ import annotations

import argparse
import math
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

PLATE = Path(__file__).parent / "reference" / "exact_indicial_plate.csv"
STEP = math.radians(0.1)  # motion.amplitude of step.toml


def columns(file: Path) -> np.ndarray:
    """A table by the names of its columns, without the comments before it."""
    lines = [line for line in file.read_text().splitlines() if not line.startswith("#")]
    return np.genfromtxt(lines, delimiter=",", names=True, deletechars="")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("run", type=Path, help="folder with history.csv")
    parser.add_argument("-o", "--output", type=Path, default=Path("indicial.png"))
    arguments = parser.parse_args()
    exact, found = columns(PLATE), columns(arguments.run / "history.csv")[1:]  # without the loads before the step

    figure, axes = plt.subplots(1, 2, figsize=(8, 3.2), layout="constrained")
    for panel, load, name, label in ((axes[0], "total/CN", "CL", "CL"), (axes[1], "total/Cm", "Cm_LE", "Cm, leading edge")):
        panel.plot(exact["U_t_over_c"], exact[name], color="#202020", lw=1, label="flat plate, exact")
        panel.plot(found["t_star"] / 2, found[load] / STEP, "o", ms=3, color="#1f5fa8", label="thin section, computed")
        panel.set(xlabel="V t / c", ylabel=f"{label}, per rad of the step", xlim=(0, found["t_star"][-1] / 2))
        panel.grid(alpha=0.25)
        panel.legend(fontsize=8)
    figure.savefig(arguments.output, dpi=110)


if __name__ == "__main__":
    main()
