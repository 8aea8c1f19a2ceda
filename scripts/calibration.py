#!/usr/bin/python3
"""Holds the printed uncertainties of linear solves against exact derivatives: how often they hold the error, and how wide they are.

Runs cones, wedges, diamonds and a thin delta wing on three meshes each and takes from the program itself the derivatives by alpha, q
and alphadot, loads CN and Cm, with their uncertainties: without a coarser mesh, with one and with two. The exact values come from
scripts/exact. The cases are two sets without a common mesh or condition: the factor of src/analysis/mesh_convergence.cpp was chosen
on the first, and the second shows what they are worth. The sharp delta wing is 0.1 % thick, its exact values are those of no thickness
(0.4 % apart by the trend in cases/delta_wing).

Writes calibration.csv, calibration.txt and calibration.png into --out. The text also tells which factor would cover 95 % of the first
set, for the program's way from differences of meshes to intervals and for others. Two minutes of processor; needs Debian's
python3-numpy, python3-matplotlib and gmsh (hence /usr/bin/python3).
"""

from __future__ import annotations

import argparse
import csv
import json
import math
import os
import subprocess
import sys
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

try:
    import matplotlib
    import numpy as np
except ImportError as error:
    sys.exit(f"calibration.py: {error}; run scripts/install.sh, and then this with /usr/bin/python3")
matplotlib.use("Agg")
import matplotlib.pyplot as plt

from exact import Longitudinal, cone, diamond, wedge, wing
from sweep.figures import COLORS, STYLE
from sweep.text import aligned

ROOT = Path(__file__).resolve().parents[1]
CASES = ROOT / "cases"
NAMES = tuple(Longitudinal.__dataclass_fields__)
COARSER = ("none", "one", "two")  # coarser meshes
COVERAGE = 0.95
RIDGE = 0.0005  # of the wing: half its thickness in the middle, in root chords


@dataclass(frozen=True)
class Condition:
    """One body in one stream on three meshes."""

    used_for: str  # "fit" or "validation"
    body: str
    angle: float  # half-angle, or sweep of the wing; degrees
    mach: float
    sizes: tuple[float, float, float]  # of the cells, the finest first, as the mesh generator takes them

    @property
    def name(self) -> str:
        return f"{self.used_for}_{self.body}_{self.angle:g}_mach_{self.mach:g}"

    @property
    def width(self) -> float:
        """Of the slab of a section: two layers of the best tetrahedra on the coarsest mesh."""
        return 1.8 * self.sizes[2]

    @property
    def exact(self) -> Longitudinal:
        if self.body == "cone":
            return cone.derivatives(self.angle, self.mach).about(2 / 3)
        if self.body == "wing":
            return wing.delta(self.mach, self.angle).about(0.5)
        return {"wedge": wedge, "diamond": diamond}[self.body].derivatives(self.angle, self.mach).about(0.5)

    def mesh(self, size: float, folder: Path) -> Path:
        """Makes it where it is not yet there. Cones have one of their own for each Mach number, others one for all."""
        stem = f"{self.body}_{self.angle:g}_{size:g}" + (f"_mach_{self.mach:g}" if self.body == "cone" else "")
        path = folder / f"{stem}.msh"
        if path.exists():
            return path
        part = path.with_name(f"{self.name}_{path.name}")
        if self.body == "wing":
            line = ["gmsh", "-3", "-setnumber", "ridge", RIDGE, "-clscale", size, CASES / "delta_wing" / "wing.geo", "-o", part]
        else:
            generator = {"cone": "sharp_cone"}.get(self.body, self.body)
            shape = ["--mach", self.mach] if self.body == "cone" else ["--width", self.width]
            shape += [] if self.body == "wedge" else ["--half-angle", self.angle]
            line = ["/usr/bin/python3", CASES / generator / "mesh.py", *shape, "--size", size, "-o", part]
        done = subprocess.run([str(word) for word in line], capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"calibration.py: {part} was not made: {done.stderr or done.stdout}")
        return part.rename(path)

    @property
    def case(self) -> tuple[str, dict[str, object]]:
        """Case file below cases/, and what replaces its keys."""
        stream = {"freestream.mach": self.mach, "freestream.alpha": 0}
        if self.body == "cone":
            return "sharp_cone/derivatives.toml", stream | {"reference.area": math.pi * math.tan(math.radians(self.angle)) ** 2}
        if self.body == "wing":
            return "delta_wing/wing.toml", stream
        slab = {"reference.area": 2 * self.width, "reference.moment_center": "[0.5,0,0]"}
        return {"wedge": "wedge/derivatives.toml", "diamond": "diamond/steady.toml"}[self.body], stream | slab


def conditions() -> list[Condition]:
    """Meshes of the validation have other sizes than those of the fit."""
    sets = {
        "fit": {
            ("cone", (0.05, 0.07, 0.1)): ((10, 2), (15, 3), (8, 4), (12, 2.5)),
            ("wedge", (1 / 30, 0.05, 0.1)): ((5, 2), (5, 3)),
            ("diamond", (1 / 30, 0.05, 0.1)): ((5, 2), (5, 2.5)),
            ("wing", (1.3, 1.8, 2.5)): ((45, 1.6), (45, 2.5)),
        },
        "validation": {
            ("cone", (0.055, 0.08, 0.11)): ((10, 1.7), (7, 2.5), (12, 3.5), (15, 2.2), (20, 5)),
            ("wedge", (0.04, 0.06, 0.12)): ((5, 2.2), (5, 3.6)),
            ("diamond", (0.04, 0.06, 0.12)): ((3, 2.2), (3, 2.7), (3, 3.6)),
            ("wing", (1.4, 2.0, 2.8)): ((45, 1.8), (45, 2.2), (45, 2.8)),
        },
    }
    return [
        Condition(used_for, body, angle, mach, sizes)
        for used_for, groups in sets.items()
        for (body, sizes), streams in groups.items()
        for angle, mach in streams
    ]


@dataclass(frozen=True)
class Entry:
    """One derivative of one condition on its finest mesh."""

    condition: Condition
    name: str
    exact: float
    values: tuple[float, ...]  # on each mesh, the finest first
    uncertainties: tuple[float, ...]  # with as many coarser meshes as COARSER says

    @property
    def error(self) -> float:
        return abs(self.values[0] - self.exact)


def call(program: Path, condition: Condition, meshes: list[Path], coarser: int, out: Path) -> dict:
    """The result of the finest mesh with this number of coarser ones; goes on from what a run with less of them has left."""
    case, changes = condition.case
    changes = changes | {"mesh.file": meshes[0], "output.flow": "false", "output.surface": "false"}
    if coarser:
        changes["derivatives.coarser_meshes"] = json.dumps([str(path) for path in meshes[1 : coarser + 1]])
    words = [word for key, value in changes.items() for word in ("--set", f"{key}={value}")]
    command = [program, "derivatives", CASES / case, "--out", out, "--overwrite", "--quiet", *words, *(["--restart"] if coarser else [])]
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode not in (0, 5):
        sys.exit(f"calibration.py: {condition.name}: {done.stderr}")
    return json.loads((out / "result.json").read_text())


def computed(condition: Condition, program: Path, folder: Path) -> list[Entry]:
    """Nothing when a run did not reach what it was asked for, which its result then says."""
    meshes = [condition.mesh(size, folder) for size in condition.sizes]
    out = folder / condition.name
    found = [call(program, condition, meshes, coarser, out) for coarser in range(len(COARSER))]
    if any(result["status"] != "converged" for result in found):
        print(f"{condition.name} is left out: {found[-1]['status']}: {found[-1]['message']}", file=sys.stderr)
        return []
    levels = [found[0], *(json.loads((out / f"mesh_{i}" / "result.json").read_text()) for i in (2, 3))]
    exact = condition.exact.as_dict()
    value = lambda result, name: result["derivatives"][name]["value"]
    width = lambda result, name: result["derivatives"][name]["uncertainty"]
    return [
        Entry(condition, name, exact[name], tuple(value(r, name) for r in levels), tuple(width(r, name) for r in found))
        for name in NAMES
    ]


def coverage(errors: np.ndarray, widths: np.ndarray) -> list[str]:
    """Share of errors inside, and the median of half width over error."""
    return [f"{100 * np.mean(errors <= widths):.0f} %", f"{np.median(widths / np.maximum(errors, 1e-12)):.2g}"]


def summary(entries: list[Entry]) -> list[list[str]]:
    """Of both sets, and of the second body by body."""
    rows = [["cases", "entries", *(f"{word}, {what}" for word in COARSER for what in ("coverage", "width / error"))]]
    second = [entry for entry in entries if entry.condition.used_for == "validation"]
    groups = {"fit": [entry for entry in entries if entry.condition.used_for == "fit"], "validation": second}
    groups |= {f"  {body}": [e for e in second if e.condition.body == body] for body in ("cone", "wedge", "diamond", "wing")}
    for name, group in groups.items():
        if group:
            errors = np.array([entry.error for entry in group])
            cells = [coverage(errors, np.array([entry.uncertainties[i] for entry in group])) for i in range(len(COARSER))]
            rows.append([name, str(len(group)), *(cell for pair in cells for cell in pair)])
    return rows


def runs_of(entries: list[Entry]) -> Iterable[list[Entry]]:
    return (entries[i : i + len(NAMES)] for i in range(0, len(entries), len(NAMES)))


def differences(run: list[Entry], meshes: int) -> np.ndarray:
    """Error of the finest mesh by differences of 2 or 3 meshes at the second order, root mean square of the pairs: (entries,).

    Spacings as the generators take them.
    """
    h, values = np.array(run[0].condition.sizes), np.array([entry.values for entry in run])
    errors = [(values[:, i + 1] - values[:, i]) * h[0] ** 2 / (h[i + 1] ** 2 - h[i] ** 2) for i in range(meshes - 1)]
    return np.sqrt(np.mean(np.square(errors), axis=0))


def scales(run: list[Entry]) -> np.ndarray:
    """Root mean square about centres a fifth of the body's length before and behind: (entries,)."""
    here = Longitudinal(**{entry.name: entry.values[0] for entry in run})
    before, behind = (np.array(list(here.about(dx).as_dict().values())) for dx in (-0.2, 0.2))
    return np.sqrt(0.5 * (before**2 + behind**2))


def pooled(mean: Callable[[np.ndarray], float], run: list[Entry], meshes: int) -> np.ndarray:
    """The same share of each scale: a mean over the entries."""
    return scales(run) * mean(differences(run, meshes) / scales(run))


def limited(widths: Callable[[list[Entry], int], np.ndarray], run: list[Entry], meshes: int) -> np.ndarray:
    """A further mesh widens nothing."""
    return np.min([widths(run, count) for count in range(2, meshes + 1)], axis=0)


ROOT_MEAN_SQUARE = lambda shares: float(np.sqrt(np.mean(shares**2)))
MEDIAN = lambda shares: float(np.median(shares))
WAYS: dict[str, Callable[[list[Entry], int], np.ndarray]] = {
    "entry by entry": differences,
    "pooled by root mean square": lambda run, n: pooled(ROOT_MEAN_SQUARE, run, n),
    "pooled by median": lambda run, n: pooled(MEDIAN, run, n),
    "both, by root mean square": lambda run, n: np.hypot(differences(run, n), pooled(ROOT_MEAN_SQUARE, run, n)),
    "both, by median": lambda run, n: np.hypot(differences(run, n), pooled(MEDIAN, run, n)),
    "both, by median, never wider (the program's)": lambda run, n: limited(
        lambda run, n: np.hypot(differences(run, n), pooled(MEDIAN, run, n)), run, n
    ),
}


def ways(entries: list[Entry]) -> list[list[str]]:
    """Ways from differences to widths: the factor from the first set, and what it does on the second."""
    rows = [["way from differences to widths", *(f"{word}, {what}" for word in COARSER[1:] for what in ("factor", "coverage", "width / error"))]]
    sets = {name: [e for e in entries if e.condition.used_for == name] for name in ("fit", "validation")}
    errors = {name: np.array([entry.error for entry in group]) for name, group in sets.items()}
    for way, widths in WAYS.items():
        row = [way]
        for meshes in (2, 3):
            of = {name: np.concatenate([widths(run, meshes) for run in runs_of(group)]) for name, group in sets.items()}
            factor = float(np.quantile(errors["fit"] / of["fit"], COVERAGE))
            row += [f"{factor:.2f}", *coverage(errors["validation"], factor * of["validation"])]
        rows.append(row)
    return rows


def draw(entries: list[Entry], path: Path) -> None:
    """Error over half width, both by the exact value, with one panel for each number of coarser meshes."""
    second = [entry for entry in entries if entry.condition.used_for == "validation"]
    least = 1e-6
    with plt.rc_context(STYLE):
        figure, panels = plt.subplots(1, len(COARSER), figsize=(11.0, 3.9), sharex=True, sharey=True, layout="constrained")
        for i, (axes, word) in enumerate(zip(panels, COARSER)):
            for body, color in zip(("cone", "wedge", "diamond", "wing"), COLORS):
                group = [entry for entry in second if entry.condition.body == body]
                share = lambda values: np.maximum(np.array(values) / [abs(entry.exact) for entry in group], least)
                axes.plot(share([e.uncertainties[i] for e in group]), share([e.error for e in group]), "o", ms=4, color=color, label=body)
            errors, widths = np.array([e.error for e in second]), np.array([e.uncertainties[i] for e in second])
            inside, ratio = coverage(errors, widths)
            ends = np.array([least, 10.0])
            axes.fill_between(ends, ends, least, color="0.92", zorder=0)
            axes.set(xscale="log", yscale="log", xlim=(1e-5, 10.0), ylim=(1e-5, 10.0), xlabel="± of the program, share of the value")
            title = "solver only; mesh not assessed" if i == 0 else f"{word} coarser mesh{'es' if i > 1 else ''}"
            axes.set_title(f"{title}\n{inside} inside, width / error {ratio}")
        panels[0].set_ylabel("error, share of the value")
        panels[0].legend(loc="lower right")
        figure.savefig(path, dpi=110)
        plt.close(figure)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", type=Path, default=ROOT / "build" / "alphadot")
    parser.add_argument("--out", type=Path, default=ROOT / "runs" / "calibration", help="folder (default: runs/calibration)")
    parser.add_argument("--jobs", type=int, default=2, help="conditions at a time (default: 2)")
    arguments = parser.parse_args()
    if not arguments.program.exists():
        parser.error(f"there is no {arguments.program}")
    os.environ |= {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_ess_singleton_isolated": "1"}
    arguments.out.mkdir(parents=True, exist_ok=True)
    with ThreadPoolExecutor(arguments.jobs) as pool:
        entries = [e for found in pool.map(lambda c: computed(c, arguments.program, arguments.out), conditions()) for e in found]
    with open(arguments.out / "calibration.csv", "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["set", "case", "name", "exact", "fine", "medium", "coarse", *(f"uncertainty_{word}" for word in COARSER)])
        writer.writerows([e.condition.used_for, e.condition.name, e.name, e.exact, *e.values, *e.uncertainties] for e in entries)
    text = f"{aligned(summary(entries))}\n\n{aligned(ways(entries))}\n"
    (arguments.out / "calibration.txt").write_text(text)
    draw(entries, arguments.out / "calibration.png")
    print(text, end="")


if __name__ == "__main__":
    main()
