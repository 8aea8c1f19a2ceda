"""Interference: the loads of a body in the presence of fins, less those of the body alone at the same condition."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

from run_csv import rows_of
from sweep.database import COEFFICIENTS, in_order
from sweep.errors import SweepError
from sweep.state import RESULT, read_json

SAME = (("freestream", ("mach", "alpha", "beta", "gamma")), ("reference", ("length", "area", "moment_center", "model")))


@dataclass(frozen=True)
class Row:
    """A coefficient or a derivative of it: of the whole, of the body in it, of the others in it, of the body alone."""

    name: str
    total: float
    body: float
    others: float
    alone: float
    uncertainty: float  # of the interference, NaN where it is not known

    @property
    def interference(self) -> float:
        """What the fins do to the body."""
        return self.body - self.alone


def walls_of(result: dict, folder: Path) -> dict[str, dict[str, tuple[float, float]]]:
    """By wall, value and uncertainty of every coefficient and derivative. Raises SweepError."""
    try:
        rows = [row for row in rows_of(folder / "components.csv") if row["component"] == row["walls"] and row["value"]]
    except OSError as error:
        raise SweepError(f"{folder / 'components.csv'}: {error.strerror}; give the folder of a run of `alphadot derivatives`") from None
    out: dict[str, dict[str, tuple[float, float]]] = {}
    for row in rows:
        out.setdefault(row["component"], {})[row["name"]] = (float(row["value"]), float(row["uncertainty"]))
    for wall, own in out.items():
        own |= {name: (value, 0.0) for name, value in result["forces"]["components"][wall].items() if name in COEFFICIENTS}
    return out


def interference(folder: Path, alone: Path) -> list[Row]:
    """Of the run in a folder, whose walls of the names of `alone` are the body. Raises SweepError."""
    results = [read_json(of / RESULT) for of in (folder, alone)]
    for of, result in zip((folder, alone), results):
        if not result.get("derivatives"):
            raise SweepError(f"{of / RESULT}: has no derivatives; give the folder of a run of `alphadot derivatives`")
    for table, keys in SAME:
        for key in keys:
            ours, theirs = (result[table][key] for result in results)
            if ours != theirs:
                raise SweepError(f"{alone}: its {table}.{key} is {theirs}, not {ours} as in {folder}")
    whole, body = (walls_of(result, of) for result, of in zip(results, (folder, alone)))
    missing = body.keys() - whole.keys()
    if missing:
        raise SweepError(f"{folder}: has no wall {', '.join(sorted(missing))} of {alone}; the body must have the same names in both")
    if body.keys() == whole.keys():
        raise SweepError(f"{alone}: has all walls of {folder}; it must be without fins")
    sums = lambda walls, name: [sum(of.get(name, (0.0, 0.0))[i] for of in walls) for i in (0, 1)]
    names = {name for of in body.values() for name in of}
    out = []
    for name in [*(name for name in COEFFICIENTS if name in names), *in_order(sorted(names - set(COEFFICIENTS)))]:
        inside, error = sums([whole[wall] for wall in body], name)
        others, _ = sums([of for wall, of in whole.items() if wall not in body], name)
        bare, error_alone = sums(body.values(), name)
        out.append(Row(name, inside + others, inside, others, bare, error + error_alone if "_" in name else math.nan))
    return out
