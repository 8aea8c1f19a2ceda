#!/usr/bin/python3
"""How much derivatives scatter from mesh to mesh: meshes of one description that differ a little in their number of cells.

  mesh_noise.py DESCRIPTION --out FOLDER [--cells 150000] [--meshes 8] [--spread 3] [--mach 1.58 1.75 2.1 2.5] [--alpha 1.5]

Sizes of cells go from SPREAD percent below to as much above that of the middle mesh, at equal steps. FOLDER/noise.csv grows by a row a
mesh and Mach number; what stands there is not computed again. Then prints mean and standard deviation over the meshes of each derivative,
and what the standard deviation is about a line through the sizes, which leaves the error of discretisation out, and seconds of processor.
"""

from __future__ import annotations

import argparse
import csv
import json
import re
import subprocess
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
DERIVATIVES = ("CN_alpha", "Cm_alpha", "CN_q", "Cm_q", "CN_alphadot", "Cm_alphadot")
COLUMNS = ("mesh", "cells", "mach", "status", "meshing_s", "solving_s", *DERIVATIVES)


def parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("description", type=Path)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--cells", type=int, default=150_000)
    parser.add_argument("--meshes", type=int, default=8)
    parser.add_argument("--spread", type=float, default=3.0, help="percent of the size of cells")
    parser.add_argument("--mach", type=float, nargs="+", default=[1.58, 1.75, 2.1, 2.5])
    parser.add_argument("--alpha", type=float, default=1.5, help="degrees")
    parser.add_argument("--program", default=str(ROOT / "build" / "alphadot"))
    parser.add_argument("--set", nargs="+", default=[], metavar="KEY=VALUE", dest="settings")
    arguments = parser.parse_args()
    if arguments.meshes < 3:
        parser.error("--meshes: at least 3")
    return arguments


def known(file: Path) -> list[dict[str, str]]:
    if not file.exists():
        return []
    with open(file) as lines:
        return list(csv.DictReader(lines))


def cells_of(arguments: argparse.Namespace) -> list[int]:
    """Of each mesh: the number of cells goes with the inverse cube of their size."""
    sizes = 1.0 + 0.01 * arguments.spread * np.linspace(-1.0, 1.0, arguments.meshes)
    return [round(arguments.cells / size**3) for size in sizes]


def mesh_of(arguments: argparse.Namespace, cells: int) -> Path:
    """The case of a mesh, made unless it is there."""
    folder = arguments.out / f"cells_{cells}"
    if not (folder / "case.toml").exists():
        command = [sys.executable, "-B", str(ROOT / "scripts" / "mesh.py"), str(arguments.description), "-o", str(folder)]
        subprocess.run([*command, "--cells", str(cells), "--no-picture"], check=True, stdout=subprocess.DEVNULL)
    return folder / "case.toml"


def meshing_seconds(case: Path) -> float:
    """Of processor, as the report beside the case has it."""
    return float(re.search(r"model, ([0-9.]+) s of processor", (case.parent / "report.txt").read_text())[1])


def run(arguments: argparse.Namespace, case: Path, mach: float) -> dict:
    """The result of the linear solves at a Mach number."""
    out = case.parent / f"mach_{mach:g}"
    settings = [f"freestream.mach={mach}", f"freestream.alpha={arguments.alpha}", "output.flow=false", "output.surface=false"]
    command = [arguments.program, "derivatives", str(case), "--out", str(out), "--quiet"]
    command += [word for setting in (*settings, *arguments.settings) for word in ("--set", setting)]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode not in (0, 5):
        sys.exit(f"mesh_noise.py: {case}: {done.stderr}")
    return json.loads((out / "result.json").read_text())


def summary(rows: list[dict[str, str]]) -> str:
    lines = ["  Mach  meshes      cells  derivative            mean        sd  sd about a line"]
    for mach in sorted({float(row["mach"]) for row in rows}):
        here = [row for row in rows if float(row["mach"]) == mach]
        cells = np.array([float(row["cells"]) for row in here])
        for name in DERIVATIVES if len(here) > 2 else ():
            values = np.array([float(row[name]) for row in here])
            size = cells ** (-1.0 / 3.0)
            rest = values - np.polyval(np.polyfit(size, values, 1), size)
            about = np.sqrt(np.sum(rest**2) / (len(here) - 2))
            lines.append(f"{mach:6.2f}{len(here):8d}{cells.mean():11.0f}  {name:14s}{values.mean():12.4f}{values.std(ddof=1):10.4f}{about:17.4f}")
        meshing, solving = (np.mean([float(row[name]) for row in here]) for name in ("meshing_s", "solving_s"))
        lines.append(f"{mach:6.2f}  {meshing:.1f} s of processor for a mesh, {solving:.1f} s for flow and linear solves on it")
    return "\n".join(lines)


def main() -> int:
    arguments = parse()
    arguments.out.mkdir(parents=True, exist_ok=True)
    file = arguments.out / "noise.csv"
    rows = known(file)
    for number, wanted in enumerate(cells_of(arguments)):
        for mach in arguments.mach:
            if any(int(row["mesh"]) == wanted and float(row["mach"]) == mach for row in rows):
                continue
            case = mesh_of(arguments, wanted)
            result = run(arguments, case, mach)
            row = {"mesh": wanted, "cells": result["mesh"]["cells"], "mach": mach, "status": result["status"]}
            row |= {"meshing_s": meshing_seconds(case), "solving_s": round(result["performance"]["cpu_s"], 2)}
            row |= {name: result["derivatives"][name]["value"] for name in DERIVATIVES}
            with open(file, "a", newline="") as lines:
                writer = csv.DictWriter(lines, COLUMNS)
                if not rows:
                    writer.writeheader()
                writer.writerow(row)
            rows.append({name: str(value) for name, value in row.items()})
    print(summary(rows))
    return 0 if all(row["status"] == "converged" for row in rows) else 5


if __name__ == "__main__":
    sys.exit(main())
