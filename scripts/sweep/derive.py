"""Derivatives of finished runs about any centre. The program moves them, `alphadot derive`: no formula of it stands here."""

from __future__ import annotations

import json
import math
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from sweep.plan import SweepError

NAMES = ("CN_alpha", "Cm_alpha", "CN_alphadot", "Cm_alphadot", "CN_q", "Cm_q")


@dataclass(frozen=True)
class Derivatives:
    """Of one run, per radian, about a centre at x = center (in reference lengths from the nose); NaN where the run gives none. And
    the pitching moment about it: of the steady flow from a result.json, of every step from a history.h5."""

    mach: float
    method: str
    center: float
    uncertainty: dict[str, float]  # by name, those that the run gives; NaN where it knows none
    Cm: list[float]
    CN_alpha: float
    Cm_alpha: float
    CN_alphadot: float
    Cm_alphadot: float
    CN_q: float
    Cm_q: float

    @staticmethod
    def of(item: dict) -> Derivatives:
        """From an item of the list that `alphadot derive --json` prints."""
        found = item["derivatives"]
        return Derivatives(
            mach=item["freestream"]["mach"],
            method=found["Cm_alphadot"]["method"],
            center=item["center"][0] / item["reference"]["length"],
            Cm=item["loads"]["Cm"],
            uncertainty={name: math.nan if entry["uncertainty"] is None else entry["uncertainty"] for name, entry in found.items()},
            **{name: found[name]["value"] if name in found else math.nan for name in NAMES},
        )


class Runs:
    """Derivatives of some runs, by their result.json or history.h5, in this order: one call of the program a centre for them all."""

    def __init__(self, program: Path, files: Sequence[Path]) -> None:
        """Raises SweepError when the program cannot read one of them."""
        self.program = program
        items = self.derive(files)
        self.here = [Derivatives.of(item) for item in items]
        self.files = list(files)
        self.lengths = [item["reference"]["length"] for item in items]
        self.known: dict[float, list[Derivatives]] = {}

    def about(self, center: float) -> list[Derivatives]:
        """About another centre, in reference lengths from the nose."""
        if center not in self.known:
            moved: dict[int, Derivatives] = {}
            for length in dict.fromkeys(self.lengths):  # one, but for runs of different configurations
                alike = [index for index, own in enumerate(self.lengths) if own == length]
                items = self.derive([self.files[index] for index in alike], center * length)
                moved |= {index: Derivatives.of(item) for index, item in zip(alike, items, strict=True)}
            self.known[center] = [moved[index] for index in range(len(self.files))]
        return self.known[center]

    def derive(self, files: Sequence[Path], center: float | Sequence[float] | None = None) -> list[dict]:
        """What `alphadot derive` says, about x or (x, y, z) in the mesh's unit. Raises SweepError."""
        if not files:
            return []
        at = [center] if isinstance(center, (int, float)) else center or []
        about = ["--center", ",".join(map(repr, at))] if at else []
        command = [self.program, "derive", *files, *about, "--json"]
        done = subprocess.run(list(map(str, command)), capture_output=True, text=True)
        if done.returncode != 0:
            raise SweepError(done.stderr.strip() or f"{self.program} derive ended with code {done.returncode}")
        return json.loads(done.stdout)
