#!/usr/bin/python3
"""Holds the intervals of `alphadot derivatives --tolerance` against exact derivatives of cones: how often they hold, how wide they are.

  adaptation_calibration.py --out FOLDER [--cells 40000] [--set fit|validation]

Each cone is described, meshed and adapted once, with the budget of cells alone to end it; every family of meshes on the way gives an
interval for CN and Cm by alpha, q and alphadot. The constants of scripts/adaptation/family.py were chosen on made-up families, without
any of these; a change of them is to be made on the first set, and the second, of other angles and Mach numbers, to tell what it is worth.
Prints a row a cone and the share of entries inside, and writes calibration.csv.
"""

from __future__ import annotations

import argparse
import csv
import json
import math
import statistics
import subprocess
import sys
from pathlib import Path

from exact import Longitudinal, cone

ROOT = Path(__file__).resolve().parents[1]
CONES = {
    "fit": ((10.0, 2.0), (15.0, 2.6), (6.0, 1.8)),  # half angle in degrees, Mach number
    "validation": ((5.0, 2.2), (8.0, 1.6), (12.5, 3.0), (20.0, 2.3)),
}
NAMES = tuple(Longitudinal.__dataclass_fields__)


def description(angle: float, mach: float) -> str:
    """A cone of length 1, moments about two thirds of it."""
    area = math.pi * math.tan(math.radians(angle)) ** 2
    return f"""flight = {{mach = {mach}, alpha = 0}}
reference = {{length = 1.0, area = {area!r}, moment_center = {2.0 / 3.0!r}}}
[[body]]
shape = "cone"
length = 1.0
diameter = {2.0 * math.tan(math.radians(angle))!r}
"""


def adapted(angle: float, mach: float, arguments: argparse.Namespace) -> dict:
    """What an adaptation leaves; found again where it is there."""
    folder = arguments.out / f"cone_{angle:g}_mach_{mach:g}"
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / "cone.toml"
    file.write_text(description(angle, mach))
    command = [arguments.program, "derivatives", file, "--tolerance", "0.0001%", "--cells", arguments.cells, "--out", folder / "adapted"]
    done = subprocess.run([*map(str, command), "--set", f"freestream.mach={mach}"], capture_output=True, text=True)
    if done.returncode != 5:
        sys.exit(f"adaptation_calibration.py: {folder}: {done.stderr}")
    return json.loads((folder / "adapted" / "adaptation.json").read_text())


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, required=True, metavar="FOLDER")
    parser.add_argument("--cells", type=int, default=40_000, help="of the finest mesh (default: 40,000)")
    parser.add_argument("--set", choices=CONES, nargs="+", default=list(CONES), dest="sets")
    parser.add_argument("--program", default=str(ROOT / "build" / "alphadot"))
    arguments = parser.parse_args()
    rows = []
    for used_for in arguments.sets:
        for angle, mach in CONES[used_for]:
            exact = cone.derivatives(angle, mach).about(2.0 / 3.0).as_dict()
            for number, family in enumerate(adapted(angle, mach, arguments)["families"], 1):
                for name in NAMES:
                    found = family["streams"][0]["derivatives"][name]
                    error, half_width = found["value"] - exact[name], found["uncertainty"]
                    numbers = (number, family["cells"], name, exact[name], found["value"], half_width, error / half_width)
                    rows.append((used_for, angle, mach, *numbers))
            own = [row for row in rows if row[:3] == (used_for, angle, mach)]
            text = "  ".join(f"{row[5]} {row[7]:.4g} ± {row[8]:.2g} ({row[9]:+.2f})" for row in own[-len(NAMES) :])
            print(f"{used_for}: cone {angle:g} deg, Mach {mach:g}: {text}", flush=True)
    for used_for in arguments.sets:
        shares = [abs(row[-1]) for row in rows if row[0] == used_for]
        inside = sum(share <= 1.0 for share in shares)
        print(f"{used_for}: {inside} of {len(shares)} inside; median of half width over error {1.0 / statistics.median(shares):.1f}")
    with open(arguments.out / "calibration.csv", "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        names = ("set", "half_angle", "mach", "family", "cells", "derivative", "exact", "value", "uncertainty", "error over uncertainty")
        writer.writerow(names)
        writer.writerows(rows)
    return 0


if __name__ == "__main__":
    sys.exit(main())
