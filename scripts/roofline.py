#!/usr/bin/python3
"""The solver's kernels against the bandwidth and the peak of this machine.

Runs the bench program (build-bench/alphadot_bench, made by `cmake --preset bench && cmake --build --preset bench`) on one rank and
on every core, and writes roofline.json, roofline.txt, roofline.svg and roofline.png. Bytes are the least that must move when every
array passes through the caches once a loop; flops are counted by the solver's own source; bandwidth is a triad's over arrays that
no cache holds; times are of the processor, the best of several. Needs Debian's python3-matplotlib (hence /usr/bin/python3).
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

try:
    import matplotlib
except ImportError as error:
    sys.exit(f"roofline.py: {error}; run scripts/install.sh, and then this with /usr/bin/python3")
matplotlib.use("Agg")
import matplotlib.pyplot as plt

import drawing

ROOT = Path(__file__).resolve().parents[1]
Measured = dict[str, Any]


def bench(program: Path, case: Path, mesh: Path, ranks: int) -> Measured:
    """What the bench program prints."""
    launcher = ["mpirun", "-n", str(ranks)] if ranks > 1 else []
    command = [*launcher, str(program.resolve()), str(case), f"mesh.file={mesh.resolve()}"]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"roofline.py: {' '.join(command)} failed:\n{done.stderr}")
    return json.loads(done.stdout)


def table(measured: list[Measured]) -> str:
    """One line a kernel and number of ranks. Times are of one core, all ranks at work."""
    lines = ["ranks  kernel        bytes/cell  flops/cell  ns/cell  at bandwidth  at peak  times bandwidth limit"]
    for run in measured:
        for k in run["kernels"]:
            lines.append(
                f"{run['ranks']:5}  {k['name']:12}  {k['bytes_per_cell']:10.0f}  {k['flops_per_cell']:10.0f}  "
                f"{k['core_ns_per_cell']:7.1f}  {k['bandwidth_limit_ns']:12.1f}  {k['flop_limit_ns']:7.1f}  "
                f"{k['times_bandwidth_limit']:21.2f}"
            )
    lines.append("")
    for run in measured:
        lines.append(
            f"{run['ranks']} rank(s), {run['cells']} cells: triad {run['triad_bytes_per_s'] / 1e9:.1f} GB/s, "
            f"peak {run['peak_flops'] / 1e9:.0f} Gflop/s in all"
        )
    lines.append(f"load of the machine when measured: {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")
    return "\n".join(lines)


def picture(run: Measured, stem: Path) -> None:
    """The roofline of all cores, with the kernels on it."""
    figure, axes = plt.subplots(figsize=(6.4, 4.4), layout="constrained")
    bandwidth, peak = run["triad_bytes_per_s"], run["peak_flops"]
    intensities = [10 ** (-1.5 + 0.05 * i) for i in range(65)]
    axes.loglog(intensities, [min(peak, bandwidth * x) / 1e9 for x in intensities], color="#202020", label="triad and peak")
    for k, color in zip(run["kernels"], ("#1f5fa8", "#c0392b", "#e08214", "#2e8b57", "#7b3294")):
        rate = run["ranks"] * k["flops_per_cell"] / k["core_ns_per_cell"]
        axes.loglog(k["flops_per_cell"] / k["bytes_per_cell"], rate, "o", color=color, label=k["name"])
    axes.set(xlabel="flops a byte", ylabel="Gflop/s", title=f"{run['ranks']} ranks, {run['cells']} cells")
    drawing.finish(figure, stem)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("mesh", type=Path, help="mesh of the case, of 100,000 cells or more (no cache must hold its arrays)")
    parser.add_argument("--case", type=Path, default=ROOT / "cases" / "basic_finner" / "derivatives.toml")
    parser.add_argument("--bench", type=Path, default=ROOT / "build-bench" / "alphadot_bench", help="the bench program")
    parser.add_argument("--ranks", type=int, nargs="+", default=sorted({1, os.cpu_count() or 1}))
    parser.add_argument("--out", type=Path, default=Path("runs/roofline"), help="folder (default: runs/roofline)")
    arguments = parser.parse_args()
    for file in (arguments.mesh, arguments.case, arguments.bench):
        if not file.exists():
            parser.error(f"there is no {file}")
    measured = [bench(arguments.bench, arguments.case, arguments.mesh, ranks) for ranks in arguments.ranks]
    arguments.out.mkdir(parents=True, exist_ok=True)
    text = table(measured)
    (arguments.out / "roofline.json").write_text(json.dumps(measured, indent=2) + "\n")
    (arguments.out / "roofline.txt").write_text(text + "\n")
    picture(measured[-1], arguments.out / "roofline")
    print(text)


if __name__ == "__main__":
    main()
