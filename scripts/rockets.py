#!/usr/bin/python3
"""Every rocket of a folder from its design file to derivatives at a subsonic and a supersonic Mach number, beside Barrowman's method.

  rockets.py FOLDER --out RUNS [--mach 0.6 2] [--alpha 2] [--cells 100000] [NAME ...]

FOLDER holds descriptions (.toml), designs of OpenRocket (.ork) and of RASAero II (.CDX1). Each is meshed for each Mach number alone, without
any other choice, and `alphadot derivatives` run with the defaults. RUNS/rockets.csv grows by a row a rocket and Mach number; what stands
there is not computed again. Prints the table: cells, the smallest angle between faces, status, CN_alpha, neutral point, and below Mach 1
that of Barrowman's method and the difference as a share of the body's length.
"""

from __future__ import annotations

import argparse
import csv
import json
import re
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "scripts"))

from barrowman import neutral_point
from meshing.program import read_missile

COLUMNS = ("name", "mach", "cells", "angle", "status", "CN_alpha", "neutral_point", "barrowman_CN_alpha", "barrowman", "off", "seconds")


def parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("names", nargs="*", help="of the files to take, without their ends (default: all)")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--mach", type=float, nargs="+", default=[0.6, 2.0])
    parser.add_argument("--alpha", type=float, default=2.0, help="degrees")
    parser.add_argument("--cells", type=int, default=100_000)
    parser.add_argument("--program", default=str(ROOT / "build" / "alphadot"))
    return parser.parse_args()


def one(arguments: argparse.Namespace, design: Path, mach: float) -> dict[str, object]:
    """A row of the table."""
    start = time.perf_counter()
    folder = arguments.out / f"{design.stem}_{mach:g}"
    row: dict[str, object] = {"name": design.stem, "mach": mach}
    command = [sys.executable, "-B", str(ROOT / "scripts" / "mesh.py"), str(design), "-o", str(folder), "--mach", f"{mach:g}"]
    done = subprocess.run([*command, "--cells", str(arguments.cells)], capture_output=True, text=True)
    if done.returncode:
        return row | {"status": "not meshed: " + done.stderr.strip().splitlines()[-1]}
    row["angle"] = float(re.search(r"dihedral angles ([0-9.]+)", done.stdout)[1])
    settings = [f"freestream.mach={mach}", f"freestream.alpha={arguments.alpha}", "output.flow=false", "output.surface=false"]
    command = [arguments.program, "derivatives", str(folder / "case.toml"), "--out", str(folder / "run"), "--quiet"]
    done = subprocess.run([*command, *(word for setting in settings for word in ("--set", setting))], capture_output=True, text=True)
    row["seconds"] = round(time.perf_counter() - start, 1)
    if done.returncode not in (0, 5):
        return row | {"status": "failed: " + (done.stderr.strip() or done.stdout.strip()).splitlines()[-1]}
    result = json.loads((folder / "run" / "result.json").read_text())
    value = {name: result["derivatives"][name]["value"] for name in ("CN_alpha", "Cm_alpha")}
    missile = read_missile(design, None)
    # About the moment centre, in reference lengths.
    point = missile.reference.moment_center[0] - value["Cm_alpha"] / value["CN_alpha"] * missile.reference.length
    row |= {"cells": result["mesh"]["cells"], "status": result["status"], "CN_alpha": value["CN_alpha"], "neutral_point": point}
    if mach < 1.0:
        slope, theirs = neutral_point(missile, mach)
        row |= {"barrowman_CN_alpha": slope, "barrowman": theirs, "off": (point - theirs) / missile.body.length}
    return row


def table(rows: list[dict[str, str]]) -> str:
    lines = [f"{'':24s}{'Mach':>5s}{'cells':>9s}{'angle':>7s}{'CN_alpha':>10s}{'their':>8s}{'point':>9s}{'theirs':>9s}{'off, %':>8s}  status"]
    for row in sorted(rows, key=lambda row: (row["name"], float(row["mach"]))):
        number = lambda name, width, digits, factor=1.0: f"{factor * float(row[name]):{width}.{digits}f}" if row.get(name) else " " * width
        lines.append(
            f"{row['name']:24s}{float(row['mach']):5.2f}{number('cells', 9, 0)}{number('angle', 7, 2)}{number('CN_alpha', 10, 3)}"
            f"{number('barrowman_CN_alpha', 8, 3)}{number('neutral_point', 9, 4)}{number('barrowman', 9, 4)}{number('off', 8, 2, 100.0)}"
            f"  {row['status']}"
        )
    return "\n".join(lines)


def main() -> int:
    arguments = parse()
    arguments.out.mkdir(parents=True, exist_ok=True)
    designs = sorted(path for path in arguments.folder.iterdir() if path.suffix.lower() in (".toml", ".ork", ".cdx1"))
    designs = [path for path in designs if not arguments.names or path.stem in arguments.names]
    if not designs:
        sys.exit(f"rockets.py: {arguments.folder} holds no such description")
    file = arguments.out / "rockets.csv"
    rows: list[dict[str, str]] = []
    if file.exists():
        with open(file) as lines:
            rows = list(csv.DictReader(lines))
    for mach in arguments.mach:
        for design in designs:
            if any(row["name"] == design.stem and float(row["mach"]) == mach for row in rows):
                continue
            row = {name: str(value) for name, value in one(arguments, design, mach).items()}
            with open(file, "a", newline="") as lines:
                writer = csv.DictWriter(lines, COLUMNS)
                if not rows:
                    writer.writeheader()
                writer.writerow(row)
            rows.append(row)
    print(table(rows))
    return 0 if all(row["status"] == "converged" for row in rows) else 5


if __name__ == "__main__":
    sys.exit(main())
