"""What a folder of tables needs to be flown as it is: the script, as fly.py, and reference.csv, in metres."""

from __future__ import annotations

import csv
import shutil
from pathlib import Path

from sweep.grid import Grid


def complete(folder: Path, grid: Grid, unit: float, script: str) -> None:
    """`unit`: of the meshes, in metres. `script`: its name beside this file."""
    reference = grid.reference
    with open(folder / "reference.csv", "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("area_m2", "length_m", "moment_center_m"))
        writer.writerow((reference["area"] * unit**2, reference["length"] * unit, reference["moment_center"][0] * unit))
    shutil.copyfile(Path(__file__).with_name(script), folder / "fly.py")
