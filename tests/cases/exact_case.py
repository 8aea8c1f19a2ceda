"""What the comparisons with exact solutions share: runs of a case on a mesh, and the tables of exact values.

Set by CTest: ALPHADOT (the program), MESHES (folder of the meshes that the fixtures make).
"""

from __future__ import annotations

import csv
import json
import os
import subprocess
import sys
import unittest
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))  # exact solutions
CASES = ROOT / "cases"
MESHES = Path(os.environ["MESHES"])


def run(
    folder: Path, verb: str, case: str, mesh: str, settings: dict[str, object], start: Path | None = None, code: int = 0,
    options: Sequence[str] = (),
) -> dict:
    """The result of `alphadot verb cases/<case>` on a mesh of MESHES, in `folder`; `settings` replace keys of the case.

    Goes on from the newest checkpoint in the folder `start`, if given. `code` is the exit code that it must end with. CTest's own
    limit ends a run that hangs.
    """
    overrides = []
    for key, value in {"mesh.file": MESHES / mesh, **settings}.items():
        overrides += ["--set", f"{key}={value}"]
    if start:
        overrides += ["--restart", max(start.glob("checkpoint_*.vtkhdf"))]
    command = [os.environ["ALPHADOT"], verb, CASES / case, "--out", folder, "--quiet", *overrides, *options]
    done = subprocess.run(command)
    if done.returncode != code:
        raise subprocess.CalledProcessError(done.returncode, command)
    return json.loads((folder / "result.json").read_text())


def table(path: str) -> list[dict[str, float]]:
    """Rows of a file of exact values below cases/; columns that are no numbers are left out."""

    def number(text: str) -> float | None:
        try:
            return float(text)
        except ValueError:
            return None

    with open(CASES / path) as file:
        rows = csv.DictReader(line for line in file if not line.startswith("#"))
        return [{name: number(value) for name, value in row.items() if number(value) is not None} for row in rows]


def cone_derivatives() -> dict[str, float]:
    """Of the sharp cone in cone lengths, about two thirds of its length: the row of its cases."""
    rows = table("sharp_cone/reference/exact_cone_derivatives.csv")
    # The column of the reference length is a word; rates by the base diameter make the rows that are left out larger.
    return min((row for row in rows if row["x_ref_over_l"] > 0.5), key=lambda row: row["CN_q"])


class ExactCase(unittest.TestCase):
    """A comparison with exact values."""

    def assert_close(self, name: str, found: float, exact: float, share: float, of: float | None = None) -> None:
        """`found` is within `share` of the exact value (or `of` another scale)."""
        with self.subTest(name):
            self.assertLessEqual(abs(found - exact), share * abs(exact if of is None else of), f"{found} is not {exact}")
