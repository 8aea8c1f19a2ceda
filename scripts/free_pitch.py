#!/usr/bin/python3
"""A body that swings freely in pitch beside what the derivatives by linear solves on the same mesh predict of it.

With the moment of inertia J over rho l^5, S over l^2 and t* = 2 V t / l,
    J alpha'' = S / 8 (Cm_alpha alpha + (Cm_q + Cm_alphadot) alpha'),
which swings as exp(-damping t*) cos(k t*). J is the one asked for, or that with which the body swings at --k. Runs `alphadot
derivatives` at zero incidence and `alphadot run` with motion.kind = "free" from --release degrees, and prints both. --center moves the
moment centre, about which the body turns, along x. Writes free_pitch.csv; with Debian's python3-matplotlib also free_pitch.png.
"""

from __future__ import annotations

import argparse
import csv
import json
import math
import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
COLUMNS = ("Mach", "center", "inertia", "k_predicted", "k", "k_half_width", "damping_predicted", "damping", "damping_half_width")


def call(arguments: argparse.Namespace, verb: str, folder: Path, settings: dict[str, object]) -> dict:
    """The result of `alphadot verb CASE` in `folder`."""
    launcher = ["mpirun", "-n", str(arguments.ranks)] if arguments.ranks > 1 else []
    overrides = [*arguments.set, *(f"{key}={value}" for key, value in settings.items())]
    options = [part for setting in overrides for part in ("--set", setting)]
    command = [*launcher, arguments.program, verb, arguments.case, "--out", folder, "--overwrite", "--quiet", *options]
    done = subprocess.run(command, text=True, stderr=subprocess.PIPE, env={**os.environ, "OMPI_MCA_rmaps_base_oversubscribe": "1"})
    if done.returncode != 0:
        sys.exit(f"free_pitch.py: {' '.join(map(str, command))} failed:\n{done.stderr}")
    return json.loads((folder / "result.json").read_text())


def swing(arguments: argparse.Namespace, mach: float) -> dict[str, float]:
    """One row of the table."""
    settings: dict[str, object] = {"freestream.mach": mach, "freestream.alpha": 0, "motion.kind": "none"}
    if arguments.center is not None:
        settings |= {"reference.moment_center": f"[{arguments.center}, 0, 0]", "motion.axis_point": f"[{arguments.center}, 0, 0]"}
    folder = arguments.out / f"{mach:g}"
    linear = call(arguments, "derivatives", folder / "linear", settings)
    reference = linear["reference"]
    area = reference["area"] / reference["length"] ** 2
    by_angle, by_q, by_rate = (linear["derivatives"][name]["value"] for name in ("Cm_alpha", "Cm_q", "Cm_alphadot"))
    if by_angle >= 0:
        sys.exit(f"free_pitch.py: Cm_alpha is {by_angle:+.4g} at Mach {mach:g}: about this centre the body does not swing")
    inertia = arguments.inertia or float(f"{area * -by_angle / (8 * arguments.k**2):.6g}")
    share = area / (8 * inertia)
    damping = -share * (by_q + by_rate) / 2
    if share * -by_angle <= damping**2:
        sys.exit(f"free_pitch.py: a body with inertia {inertia:g} does not swing at Mach {mach:g}: it is damped too much")
    k = math.sqrt(-share * by_angle - damping**2)
    flight = call(arguments, "run", folder / "flight", {
        **settings, "freestream.alpha": arguments.release, "motion.kind": "free", "body.free": '["pitch"]',
        "body.inertia": f"[{inertia}, {inertia}, {inertia}]", "unsteady.steps": round(arguments.cycles * arguments.steps),
        "unsteady.duration": f"{arguments.cycles * 2 * math.pi / k:.6g}",
    })  # fmt: skip
    if "decay" not in flight:
        sys.exit(f"free_pitch.py: {flight['message']}")
    found = flight["decay"]
    return dict(zip(COLUMNS, (
        mach, reference["moment_center"][0], inertia, k, found["k"], found["k_uncertainty"], damping, found["damping"],
        found["damping_uncertainty"],
    ), strict=True))  # fmt: skip


def draw(rows: list[dict[str, float]], release: float, out: Path) -> None:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    import numpy as np

    figure, panels = plt.subplots(len(rows), 1, figsize=(7, 2.4 * len(rows)), squeeze=False, layout="constrained")
    for row, panel in zip(rows, panels[:, 0], strict=True):
        file = out / f"{row['Mach']:g}" / "flight" / "history.csv"
        lines = [line for line in file.read_text().splitlines() if not line.startswith("#")]
        history = np.genfromtxt(lines, delimiter=",", names=True, deletechars="")
        t, k, damping = history["t_star"], row["k_predicted"], row["damping_predicted"]
        # Released at rest.
        predicted = release * np.exp(-damping * t) * (np.cos(k * t) + damping / k * np.sin(k * t))
        panel.plot(t, predicted, color="#202020", lw=1, label="predicted by linear solves")
        panel.plot(t, np.degrees(history["alpha"]), "o", ms=3, color="#1f5fa8", label="flown")
        panel.set(xlabel="t* = 2 V t / l", ylabel="α, deg", title=f"Mach {row['Mach']:g}")
        panel.grid(alpha=0.25)
    panels[0, 0].legend(fontsize=8)
    figure.savefig(out / "free_pitch.png", dpi=110)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("case", type=Path, help="of a body that is trimmed at zero incidence")
    parser.add_argument("--mach", type=float, nargs="+", required=True)
    parser.add_argument("--center", type=float, help="x of the moment centre, about which the body turns (default: the case's)")
    parser.add_argument("--inertia", type=float, help="moment of inertia in pitch over rho length^5 (default: that for --k)")
    parser.add_argument("--k", type=float, default=0.01, help="reduced frequency, about (default: 0.01)")
    parser.add_argument("--release", type=float, default=0.5, help="degrees of incidence (default: 0.5)")
    parser.add_argument("--cycles", type=float, default=2, help="(default: 2)")
    parser.add_argument("--steps", type=int, default=48, help="time steps a cycle (default: 48)")
    parser.add_argument("--out", type=Path, default=Path("runs/free_pitch"), help="folder (default: runs/free_pitch)")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="replace a key of the case")
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--program", type=Path, default=ROOT / "build" / "alphadot")
    arguments = parser.parse_args()
    for file in (arguments.case, arguments.program):
        if not file.exists():
            parser.error(f"there is no {file}")
    for name in ("k", "release", "cycles", "steps"):
        if getattr(arguments, name) <= 0:
            parser.error(f"--{name} must be positive")

    rows = [swing(arguments, mach) for mach in arguments.mach]
    with open(arguments.out / "free_pitch.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS)
        writer.writeheader()
        writer.writerows(rows)
    print("Mach    inertia   k predicted   k flown              off     damping predicted   flown                   off")
    for row in rows:
        off = [100 * (row[name] / row[f"{name}_predicted"] - 1) for name in ("k", "damping")]
        print(f"{row['Mach']:<7g} {row['inertia']:<9.5g} {row['k_predicted']:<13.5g} {row['k']:.5g} ± {row['k_half_width']:<8.1g} "
              f"{off[0]:+6.2f} %   {row['damping_predicted']:<19.4g} {row['damping']:.4g} ± {row['damping_half_width']:<9.1g} "
              f"{off[1]:+6.2f} %")  # fmt: skip
    try:
        draw(rows, arguments.release, arguments.out)
    except ImportError:
        pass


if __name__ == "__main__":
    main()
