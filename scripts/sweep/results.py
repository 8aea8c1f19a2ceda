"""What the runs of a sweep have found, and the published values beside it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

import table_one
from sweep.database import Point, read_points
from sweep.derive import Derivatives, Runs
from sweep.plan import Run, Sweep
from sweep.state import RESULT, Phase, State
from table_one import Row, column, fitted_center


@dataclass(frozen=True)
class Entry:
    """A run that came to its end, converged or not."""

    run: Run
    state: State
    result: dict

    @property
    def mach(self) -> float:
        return self.result["freestream"]["mach"]

    @property
    def has_derivatives(self) -> bool:
        return "Cm_alphadot" in self.result["derivatives"]

    @property
    def converged(self) -> bool:
        """False when something that was asked for was not reached."""
        return self.state.phase is Phase.DONE

    @property
    def label(self) -> str:
        """Its name, with a mark that nobody overlooks where it is not converged."""
        return self.run.name if self.converged else f"{self.run.name} (not converged)"

    @property
    def series(self) -> tuple[str, str, float]:
        """What it has in common with those that make a line over Mach number with it."""
        return (self.run.label, self.run.mesh, self.run.alpha)


@dataclass(frozen=True)
class Published:
    """Published values of the configuration, in d and per rad."""

    paper: dict[float, Row]
    flight: list[Row]
    rans: list[Row]
    sznajder: list[Row]

    @staticmethod
    def of(sweep: Sweep) -> Published | None:
        """Those of the Basic Finner, if that is what the sweep is about."""
        if not sweep.runs or sweep.runs[0].case.parent.resolve() != table_one.REFERENCE.parent.resolve():
            return None
        near = lambda row: 1.4 <= float(row["Mach"]) <= 2.8
        read = table_one.read_table
        return Published(
            {float(row["mach"]): row for row in read("paper_table1.csv")},
            read("finner_free_flight_DREV_TM_9703.csv", lambda row: near(row) and row["flag"] == "ok"),
            read("finner_rans_ARL_TR_6725.csv", lambda row: near(row) and row["method"] == "planar_pitching"),
            read("finner_sznajder2025.csv", near),
        )


@dataclass(frozen=True)
class Results:
    """All that a report is made of."""

    sweep: Sweep
    program: Path
    entries: list[Entry]
    unfinished: list[tuple[Run, State]]
    published: Published | None
    points: list[Point]

    @staticmethod
    def of(sweep: Sweep, program: Path) -> Results:
        points = read_points(sweep)
        own = [point for point in points if not point.image]
        ended = (Phase.DONE, Phase.SHORT)
        entries = [Entry(point.run, point.state, point.result) for point in own if point.state.phase in ended]
        entries.sort(key=lambda entry: (entry.converged, entry.series, entry.mach))
        unfinished = [(point.run, point.state) for point in own if point.state.phase not in ended]
        unfinished.sort(key=lambda pair: pair[1].phase is not Phase.FAILED)
        return Results(sweep, program, entries, unfinished, Published.of(sweep), points)

    @cached_property
    def with_derivatives(self) -> list[Entry]:
        return [entry for entry in self.entries if entry.has_derivatives]

    @cached_property
    def place(self) -> dict[str, int]:
        """Of a run among those with derivatives."""
        return {entry.run.name: index for index, entry in enumerate(self.with_derivatives)}

    @cached_property
    def derived(self) -> Runs:
        """What the program says about those with derivatives, in their order. Raises SweepError."""
        return Runs(self.program, [entry.run.folder / RESULT for entry in self.with_derivatives])

    def about(self, entry: Entry, center: float) -> Derivatives:
        """Of an entry with derivatives, about a centre in reference lengths from the nose."""
        return self.derived.about(center)[self.place[entry.run.name]]

    def here(self, entry: Entry) -> Derivatives:
        """The same about the centre of the run."""
        return self.derived.here[self.place[entry.run.name]]

    @cached_property
    def uncertainty(self) -> str:
        """What the uncertainties hold: with or without the mesh's part."""
        return table_one.uncertainty_of(entry.result for entry in self.with_derivatives)

    @cached_property
    def series(self) -> dict[tuple[str, str, float], list[Entry]]:
        out: dict[tuple[str, str, float], list[Entry]] = {}
        for entry in sorted(self.with_derivatives, key=lambda entry: entry.mach):
            out.setdefault(entry.series, []).append(entry)
        return out

    @cached_property
    def beside_paper(self) -> list[Entry]:
        """Runs at a Mach number and angle of attack of the paper's Table I."""
        if not self.published:
            return []
        at_paper = lambda entry: entry.mach in self.published.paper and abs(entry.run.alpha - 1.5) < 1e-9
        return [entry for entry in self.with_derivatives if at_paper(entry)]

    @cached_property
    def center(self) -> float | None:
        """The moment centre that fits the paper's static values best, by the series that has most of its Mach numbers."""
        if not self.beside_paper:
            return None
        # Of series as long as each other: linear solves, then the finest mesh.
        rank = lambda entries: (len(entries), not entries[0].run.is_motion, entries[0].result["mesh"]["cells"])
        groups: dict[tuple, list[Entry]] = {}
        for entry in self.beside_paper:
            groups.setdefault(entry.series, []).append(entry)
        best = max(groups.values(), key=rank)
        static = column([self.published.paper[entry.mach] for entry in best], "static_field")
        return fitted_center(self.derived, [self.place[entry.run.name] for entry in best], static)


def finite(value: float | None) -> bool:
    return value is not None and math.isfinite(value)


def relative(value: float, of: float) -> float:
    """In percent."""
    return 100 * (value / of - 1) if of else np.nan
