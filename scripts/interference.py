#!/usr/bin/python3
"""What fins do to a body: its loads and their derivatives in the presence of fins, less those of the body alone.

    scripts/interference.py RUN BODY_ALONE [-o interference.csv]

Two runs of `alphadot derivatives` at the same condition with the same reference, the second of a mesh without the fins; walls of the same
names are the body. Differences of meshes are in the differences: the ± is that of the solves.
"""

from __future__ import annotations

import argparse
import csv
import math
import sys
from pathlib import Path

from sweep.errors import SweepError
from sweep.interference import interference
from sweep.text import aligned

COLUMNS = ("name", "whole", "body", "fins", "body_alone", "interference", "uncertainty")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("run", type=Path, metavar="RUN", help="folder of the run with fins")
    parser.add_argument("alone", type=Path, metavar="BODY_ALONE", help="folder of the run without")
    parser.add_argument("-o", "--output", type=Path, help="CSV with all digits")
    arguments = parser.parse_args()
    try:
        rows = interference(arguments.run, arguments.alone)
    except SweepError as error:
        sys.exit(f"interference.py: {error}")
    cells = [(row.name, row.total, row.body, row.others, row.alone, row.interference, row.uncertainty) for row in rows]
    number = lambda value: f"{value:.5g}" if math.isfinite(value) else "-"
    print(aligned([COLUMNS[:-1] + ("±",), *((name, *map(number, values)) for name, *values in cells)]))
    if arguments.output:
        with open(arguments.output, "w", newline="") as file:
            file.write(f"# Interference: {arguments.run} less {arguments.alone}; per radian, rates times length / 2V; ± of the solves\n")
            writer = csv.writer(file, lineterminator="\n")
            writer.writerows([COLUMNS, *cells])
        print(arguments.output)


if __name__ == "__main__":
    main()
