#!/usr/bin/python3
"""How a case scales: strong and weak, measured here, and a model of it drawn out to 10,000 ranks.

Runs the program at several numbers of ranks and writes scaling.json, scaling.txt, scaling.svg and scaling.png. More ranks than
cores are fine for what does not depend on time: iterations, messages, bytes, ghosts, balance. Times are compared only where every
rank has a core.

The model of one iteration on P ranks of n = N/P cells:

    t = w n (1 + imbalance) + m L + b g / B + 2 log2(P) L,      g = s n^(2/3) ghosts a rank

Fitted to the runs: w (core time of a cell and iteration, all cores at work), imbalance, s, b (bytes a ghost and iteration) and m
(messages of the busiest rank an iteration). L and B, latency and bandwidth of a rank's messages, are of the network: this machine's
own (measured by the bench program) for comparison, and those of --latency and --bandwidth for the extrapolation. Nothing is taken
off for the overlap of messages and work. Needs Debian's python3-numpy and python3-matplotlib (hence /usr/bin/python3).
"""

from __future__ import annotations

import argparse
import json
import math
import os
import subprocess
import sys
from dataclasses import asdict, dataclass
from pathlib import Path

try:
    import matplotlib
    import numpy as np
except ImportError as error:
    sys.exit(f"scaling.py: {error}; run scripts/install.sh, and then this with /usr/bin/python3")
matplotlib.use("Agg")
import matplotlib.pyplot as plt

import drawing

ROOT = Path(__file__).resolve().parents[1]
BLUE, RED, GREEN, GREY = "#1f5fa8", "#c0392b", "#2e8b57", "#909090"
WEAK_ITERATIONS = 20  # meshes differ, so iterations to a residual do not compare
SURFACE = 2 / 3  # power of n that the surface of a compact part grows with


@dataclass(frozen=True)
class Run:
    """One run of the program, from its result.json."""

    ranks: int
    cells: int
    iterations: int
    wall_s: float
    cpu_s: float
    halo_fraction: float  # of the wall time, spent waiting
    halo_bytes_per_iteration: float
    most_messages_per_iteration: float
    ghost_fraction: float
    load_imbalance: float

    @property
    def cells_per_rank(self) -> float:
        return self.cells / self.ranks

    @property
    def ghosts_per_rank(self) -> float:
        return self.ghost_fraction * self.cells_per_rank

    @property
    def core_seconds(self) -> float:
        """Of a cell and iteration, waiting included."""
        return self.cpu_s / (self.cells * self.iterations)


@dataclass(frozen=True)
class Network:
    latency_s: float
    bytes_per_s: float  # of one rank


@dataclass(frozen=True)
class Model:
    """Coefficients of the formula above."""

    work_s: float
    imbalance: float
    ghosts: float  # s
    bytes_per_ghost: float  # b
    messages: float  # m
    iterations_one: float
    iterations_per_doubling: float  # share added by each doubling of the ranks

    def parts(self, cells: float, ranks: float, network: Network) -> tuple[float, float, float, float]:
        """Seconds of work, latency, bandwidth and reduction in one iteration."""
        n = cells / ranks
        if ranks <= 1:
            return self.work_s * n, 0, 0, 0
        volume = self.bytes_per_ghost * self.ghosts * n**SURFACE
        return (
            self.work_s * n * (1 + self.imbalance),
            self.messages * network.latency_s,
            volume / network.bytes_per_s,
            2 * math.log2(ranks) * network.latency_s,
        )

    def seconds(self, cells: float, ranks: float, network: Network) -> float:
        return sum(self.parts(cells, ranks, network))

    def efficiency(self, cells: float, ranks: float, network: Network) -> float:
        """Of one iteration, against the work alone."""
        return self.work_s * cells / ranks / self.seconds(cells, ranks, network)

    def iterations_share(self, ranks: float) -> float:
        """Iterations over those on one rank; a guess beyond the ranks that were run."""
        return 1 + self.iterations_per_doubling * math.log2(ranks)


def run(arguments: argparse.Namespace, mesh: Path, ranks: int, most_iterations: int | None = None) -> Run:
    """A steady run; its folder stays. The cost of an iteration needs no more than `most_iterations`."""
    folder = arguments.out / f"{mesh.stem}_{ranks}"
    settings = [f"mesh.file={mesh.resolve()}", f"steady.orders={arguments.orders}", "output.flow=false", "output.surface=false"]
    if most_iterations:
        settings.append(f"steady.max_iterations={most_iterations}")
    overrides = [part for setting in [*settings, *arguments.set] for part in ("--set", setting)]
    launcher = ["mpirun", "-n", str(ranks)] if ranks > 1 else []
    command = [*launcher, str(arguments.program.resolve()), "run", str(arguments.case), "--out", str(folder), "--overwrite", "--quiet", *overrides]
    environment = {**os.environ, "OMPI_MCA_rmaps_base_oversubscribe": "1"}
    done = subprocess.run(command, capture_output=True, text=True, env=environment)
    if done.returncode != 0:
        sys.exit(f"scaling.py: {' '.join(command)} failed:\n{done.stderr}")
    for checkpoint in folder.glob("checkpoint_*"):
        checkpoint.unlink()  # nothing goes on from here
    result = json.loads((folder / "result.json").read_text())
    measured = {key: result["performance"][key] for key in Run.__dataclass_fields__ if key in result["performance"]}
    print(f"{mesh.name} on {ranks} ranks: {measured['iterations']} iterations", file=sys.stderr)
    return Run(ranks=ranks, cells=result["mesh"]["cells"], **measured)


def fit(strong: list[Run], weak: list[Run], cores: int) -> Model:
    """Least squares where there is more than one run to fit to."""
    cut = [r for r in strong + weak if r.ranks > 1]
    timed = [r for r in strong if r.ranks <= cores]
    busiest = max(timed, key=lambda r: r.ranks)
    surface = np.array([r.cells_per_rank**SURFACE for r in cut])
    ghosts = np.array([r.ghosts_per_rank for r in cut])
    one = next(r for r in strong if r.ranks == 1)
    doublings = np.array([math.log2(r.ranks) for r in strong])
    growth = np.array([r.iterations / one.iterations - 1 for r in strong])
    return Model(
        work_s=busiest.core_seconds * (1 - busiest.halo_fraction),
        imbalance=max(r.load_imbalance for r in cut),
        ghosts=float(np.exp(np.mean(np.log(ghosts / surface)))),
        bytes_per_ghost=float(np.mean([r.halo_bytes_per_iteration / (r.ghost_fraction * r.cells) for r in cut])),
        messages=max(r.most_messages_per_iteration for r in cut),
        iterations_one=one.iterations,
        iterations_per_doubling=float(doublings @ growth / (doublings @ doublings)),
    )


def own_network(arguments: argparse.Namespace, mesh: Path) -> Network | None:
    """This machine's messages, when the bench program is there."""
    if not arguments.bench.exists():
        return None
    command = ["mpirun", "-n", "2", str(arguments.bench.resolve()), str(arguments.case), f"mesh.file={mesh.resolve()}"]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"scaling.py: {' '.join(command)} failed:\n{done.stderr}")
    measured = json.loads(done.stdout)
    return Network(measured["latency_s"], measured["message_bytes_per_s"])


def measured_table(title: str, runs: list[Run], cores: int) -> list[str]:
    base = runs[0]
    lines = [
        title,
        "ranks     cells  iterations  /first  us/cell/it  efficiency  waiting  ghosts  imbalance  MB sent/it  messages/it",
    ]
    for r in runs:
        timed = r.ranks <= cores
        efficiency = f"{base.core_seconds / r.core_seconds:10.2f}" if timed else "         -"
        waiting = f"{100 * r.halo_fraction:6.1f}%" if timed else "      -"
        lines.append(
            f"{r.ranks:5} {r.cells:9} {r.iterations:11} {r.iterations / base.iterations:7.3f} {1e6 * r.core_seconds:11.3f} "
            f"{efficiency}  {waiting} {100 * r.ghost_fraction:6.1f}% {100 * r.load_imbalance:9.1f}% "
            f"{1e-6 * r.halo_bytes_per_iteration:11.2f} {r.most_messages_per_iteration:12.0f}"
        )
    return [*lines, ""]


def model_table(model: Model, network: Network, sizes: list[float], ranks: list[int]) -> list[str]:
    lines = [
        f"MODEL, not measured: one iteration, latency {1e6 * network.latency_s:g} us and {network.bytes_per_s / 1e9:g} GB/s a rank",
        "    cells  ranks  cells/rank  ms/iteration  work  latency  bandwidth  reduction  efficiency",
    ]
    for cells in sizes:
        for count in ranks:
            if cells / count < 1000:
                continue
            parts = model.parts(cells, count, network)
            total = sum(parts)
            shares = "  ".join(f"{100 * part / total:{width}.0f}%" for part, width in zip(parts, (3, 6, 8, 8)))
            lines.append(
                f"{cells:9.2e} {count:6} {cells / count:11.0f} {1e3 * total:13.2f}  {shares}  "
                f"{model.efficiency(cells, count, network):10.2f}"
            )
    return lines


def picture(strong: list[Run], weak: list[Run], model: Model, network: Network, sizes: list[float], stem: Path) -> None:
    figure, ((iterations, ghosts), (speed, together)) = plt.subplots(2, 2, figsize=(10, 7.5), layout="constrained")
    counts = [r.ranks for r in strong]
    iterations.plot(counts, [r.iterations / strong[0].iterations for r in strong], "o-", color=BLUE, label="measured")
    iterations.axhline(1.15, color=RED, linestyle="--", linewidth=1, label="1.15")
    iterations.set(xlabel="ranks", ylabel="iterations / those on one rank", ylim=(0.9, 1.25), xscale="log")
    iterations.minorticks_off()
    iterations.set_xticks(counts, labels=[str(count) for count in counts])
    cut = sorted((r for r in strong + weak if r.ranks > 1), key=lambda r: r.cells_per_rank)
    per_rank = np.geomspace(cut[0].cells_per_rank / 2, 2 * cut[-1].cells_per_rank, 50)
    ghosts.loglog([r.cells_per_rank for r in cut], [r.ghosts_per_rank for r in cut], "o", color=BLUE, label="measured")
    ghosts.loglog(per_rank, model.ghosts * per_rank**SURFACE, color=GREY, label=f"{model.ghosts:.1f} n^(2/3)")
    ghosts.set(xlabel="cells a rank", ylabel="ghosts a rank")
    many = np.geomspace(1, 10_000, 60)
    for cells, color in zip(sizes, (BLUE, GREEN, RED)):
        speed.loglog(many, [cells / model.seconds(cells, p, network) for p in many], color=color, label=f"model, {cells:.1e} cells")
    speed.loglog(many, many / model.work_s, color=GREY, linestyle=":", label="work alone")
    speed.set(xlabel="ranks", ylabel="cells updated a second", title="strong scaling, model")
    for cells, color in zip((10_000, 50_000, 200_000), (RED, GREEN, BLUE)):
        together.semilogx(
            many, [model.efficiency(cells * p, p, network) for p in many], color=color, label=f"model, {cells} cells a rank"
        )
    together.set(xlabel="ranks", ylabel="efficiency of an iteration", ylim=(0, 1.05), title="weak scaling, model")
    drawing.finish(figure, stem)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("mesh", type=Path, help="mesh of the strong scaling (best prepared by alphadot partition)")
    parser.add_argument(
        "--ranks", type=int, nargs="+", default=[1, 2, 4, 8, 16], help="of the strong scaling (default: 1 2 4 8 16)"
    )
    parser.add_argument("--weak", nargs="+", default=[], metavar="MESH:RANKS", help="meshes with as many cells a rank each")
    parser.add_argument("--case", type=Path, default=ROOT / "cases" / "basic_finner" / "derivatives.toml")
    parser.add_argument("--orders", type=float, default=6, help="decades that the residual must drop (default: 6)")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="replace a key of the case")
    parser.add_argument("--program", type=Path, default=ROOT / "build" / "alphadot")
    parser.add_argument(
        "--bench", type=Path, default=ROOT / "build-bench" / "alphadot_bench", help="measures this machine's messages"
    )
    parser.add_argument("--latency", type=float, default=2.0, help="us, of the network of the model (default: 2)")
    parser.add_argument(
        "--bandwidth", type=float, default=0.4, help="GB/s a rank, of the network of the model (default: 0.4: 64 ranks on 25)"
    )
    parser.add_argument("--out", type=Path, default=Path("runs/scaling"), help="folder (default: runs/scaling)")
    arguments = parser.parse_args()
    weak_meshes = []
    for pair in arguments.weak:
        mesh, _, ranks = pair.rpartition(":")
        if not mesh or not ranks.isdigit() or int(ranks) < 1:
            parser.error(f"--weak {pair}: expected MESH:RANKS")
        weak_meshes.append((Path(mesh), int(ranks)))
    for file in (arguments.mesh, arguments.case, arguments.program, *(mesh for mesh, _ in weak_meshes)):
        if not file.exists():
            parser.error(f"there is no {file}")
    counts = sorted(set(arguments.ranks))
    if counts[0] != 1 or len(counts) < 2:
        parser.error("--ranks needs 1 and at least one more")
    arguments.out.mkdir(parents=True, exist_ok=True)

    cores = len(os.sched_getaffinity(0))
    load = os.getloadavg()[0]
    strong = [run(arguments, arguments.mesh, ranks) for ranks in counts]
    weak = [run(arguments, mesh, ranks, WEAK_ITERATIONS) for mesh, ranks in weak_meshes]
    model = fit(strong, weak, cores)
    network = Network(1e-6 * arguments.latency, 1e9 * arguments.bandwidth)
    own = own_network(arguments, arguments.mesh)
    sizes = [float(strong[0].cells), 1e8, 1e9]

    lines = measured_table(f"Strong scaling, measured on {cores} cores (load {load:.1f} at the start)", strong, cores)
    if weak:
        lines += measured_table("Weak scaling, measured", weak, cores)
    lines += [f"Model: {json.dumps({key: float(f'{value:.4g}') for key, value in asdict(model).items()})}", ""]
    if own and cores > 1:
        two = next((r for r in strong if r.ranks == 2), None)
        lines.append(f"this machine's messages: latency {1e6 * own.latency_s:.2f} us, {own.bytes_per_s / 1e9:.2f} GB/s")
        if two:
            modelled = 1e3 * model.seconds(two.cells, 2, own)
            lines.append(
                f"an iteration on 2 ranks: model {modelled:.1f} ms, processor time {1e3 * two.cpu_s / two.iterations / 2:.1f} ms"
            )
        lines.append("")
    lines += model_table(model, network, sizes, [16, 64, 256, 1024, 4096, 10_000])
    lines.append(
        f"iterations on 10,000 ranks: {model.iterations_share(10_000):.2f} times those on one, if they grew as up to {counts[-1]}"
    )
    text = "\n".join(lines)
    (arguments.out / "scaling.txt").write_text(text + "\n")
    data = {
        "cores": cores,
        "load": load,
        "strong": [asdict(r) for r in strong],
        "weak": [asdict(r) for r in weak],
        "model": asdict(model),
        "network_of_the_model": asdict(network),
        "network_of_this_machine": asdict(own) if own else None,
        "modelled": [
            {
                "cells": cells,
                "ranks": p,
                "seconds": model.seconds(cells, p, network),
                "efficiency": model.efficiency(cells, p, network),
            }
            for cells in sizes
            for p in (1, 16, 64, 256, 1024, 4096, 10_000)
        ],
    }
    (arguments.out / "scaling.json").write_text(json.dumps(data, indent=2) + "\n")
    picture(strong, weak, model, network, sizes, arguments.out / "scaling")
    print(text)


if __name__ == "__main__":
    main()
