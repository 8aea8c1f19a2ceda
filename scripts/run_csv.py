"""Tables that a run of the program leaves in its folder: CSV below lines of comments."""

from __future__ import annotations

import csv
import sys
from pathlib import Path


def rows_of(path: Path) -> list[dict[str, str]]:
    """Its rows by the names of the columns. Raises OSError."""
    with open(path, newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def rows_of_run(folder: Path, name: str, verb: str) -> list[dict[str, str]]:
    """Those of a file in the folder of a run of that verb, for a script that has nothing to do without them: it ends."""
    try:
        return rows_of(folder / name)
    except OSError as error:
        sys.exit(f"{Path(sys.argv[0]).name}: {folder / name}: {error.strerror}; give the folder of a run of `alphadot {verb}`")
