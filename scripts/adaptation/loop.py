"""The loop: a family of meshes, its intervals, where their errors are made, and finer cells there."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from adaptation.family import LEVER, FACTORS, Interval, Member, family_factors, intervals
from adaptation.steps import Cost, Mesh, Solved, StepError, Steps, tell
from adaptation.tolerance import Tolerance

FIRST = 20_000  # cells of the first mesh, from the description alone
SMALLEST = 25_000  # of the middle mesh of the first family
ORDER = 2.0 / 3.0  # of an interval in the number of cells
AIM = 0.8  # of the tolerance
YIELD = 1.2  # cells that meshes have over those asked for, until a family has told
LEAST, MOST = 1.5, 6.0  # times as many cells in the next family


@dataclass(frozen=True)
class Budget:
    """What ends an adaptation: cells of the finest mesh, minutes of the clock; None: no end."""

    cells: int
    minutes: float | None = None

    @property
    def middle(self) -> int:
        """Cells of the middle mesh of the largest family."""
        return int(self.cells * min(FACTORS) ** 3)


@dataclass(frozen=True)
class Stream:
    """One of the conditions that the meshes are adapted to at once: its name, and keys that replace those of the case."""

    name: str
    settings: Sequence[str] = ()


@dataclass
class Family:
    """The meshes of one size field, what was computed on them in each stream, and what that says."""

    number: int
    cells: int  # asked of the middle mesh
    members: dict[str, list[Member]] = field(default_factory=dict)  # by the stream's name
    intervals: dict[str, dict[str, Interval]] = field(default_factory=dict)
    shortfalls: list[str] = field(default_factory=list)  # runs that did not reach what they were to
    middle: Mesh | None = None
    cpu: float = 0.0  # seconds of processor since the beginning

    def misses(self, tolerances: Mapping[str, Tolerance]) -> dict[str, float]:
        """Uncertainty over tolerance of each goal in each stream, "Cm_q at mach=2"."""
        out = {}
        for stream, found in self.intervals.items():
            values = {name: interval.value for name, interval in found.items()}
            for goal, tolerance in tolerances.items():
                asked = tolerance.half_width(goal, values)
                out[f"{goal} at {stream}" if stream else goal] = found[goal].uncertainty / asked if asked > 0.0 else float("inf")
        return out


@dataclass
class Outcome:
    """How it ended: "converged", "not_converged" or "out_of_budget", with the reason, and all that was made."""

    status: str
    message: str
    families: list[Family]
    meshing: Cost
    solving: Cost


class Adaptation:
    """Brings the intervals of some derivatives below their tolerances."""

    def __init__(
        self, steps: Steps, folder: Path, streams: Sequence[Stream], tolerances: Mapping[str, Tolerance], budget: Budget, adapts: bool
    ) -> None:
        self.steps, self.folder, self.streams = steps, folder, streams
        self.tolerances, self.budget, self.adapts = tolerances, budget, adapts
        self.meshing, self.solving = Cost(), Cost()
        self._start = time.monotonic()
        self._spent_before = 0.0  # seconds of steps that were found
        self._seconds_a_cell = 0.0
        self._yield = YIELD

    def run(self) -> Outcome:
        families: list[Family] = []
        indicators = self._indicators_of_first() if self.adapts else []
        cells = min(SMALLEST, self.budget.middle)
        while True:
            families.append(self._family(len(families) + 1, cells, indicators))
            latest = families[-1]
            misses = latest.misses(self.tolerances)
            worst = max(misses, key=misses.get)
            if misses[worst] <= 1.0:
                if latest.shortfalls:
                    return self._end("not_converged", "; ".join(latest.shortfalls), families)
                return self._end("converged", "every interval is within its tolerance", families)
            left = f"the interval of {worst} is {misses[worst]:.3g} times its tolerance"
            growth = min(max((misses[worst] / AIM) ** (1.0 / ORDER), LEAST), MOST)
            cells = min(int(latest.cells * growth), self.budget.middle)
            if cells < 1.05 * latest.cells:
                left += f" with {self.budget.cells:,} cells on the finest mesh: allow more by --cells"
                return self._end("out_of_budget", left, families)
            if self.budget.minutes is not None and self._seconds() + self._forecast(cells) > 60.0 * self.budget.minutes:
                left += f", and the next family of meshes would take {self._forecast(cells) / 60.0:.1f} more minutes"
                return self._end("out_of_budget", left, families)
            tell(f"{left}: {growth:.2g} times as many cells")
            if self.adapts:
                indicators = self._indicators_on(latest.middle, self.folder / f"family_{latest.number}")

    def _end(self, status: str, message: str, families: list[Family]) -> Outcome:
        return Outcome(status, message, families, self.meshing, self.solving)

    def _indicators_of_first(self) -> list[Path]:
        mesh = self._mesh(self.folder / "first" / "mesh", min(FIRST, self.budget.middle), [], None)
        return self._indicators_on(mesh, self.folder / "first")

    def _indicators_on(self, mesh: Mesh, folder: Path) -> list[Path]:
        """Where the errors of the goals are made, in every stream."""
        files = []
        for stream in self.streams:
            options = ("adjoint", "--indicator", ",".join(self.tolerances))
            run = self._solve(mesh, folder / _folder_of("indicator", stream), stream, *options)
            files.append(run.folder / "indicator.vtkhdf")
        return files

    def _family(self, number: int, cells: int, indicators: Sequence[Path]) -> Family:
        family = Family(number, cells)
        start = self._seconds()
        for factor in family_factors():
            folder = self.folder / f"family_{number}"
            mesh = self._mesh(folder / f"mesh_{factor:g}", int(cells / self._yield), indicators, factor)
            family.middle = mesh if factor == 1.0 else family.middle
            for stream in self.streams:
                run = self._solve(mesh, folder / _folder_of(f"run_{factor:g}", stream), stream, "derivatives")
                member = Member(factor, run.cells, run.values, run.solver)
                family.members.setdefault(stream.name, []).append(member)
                if not run.is_converged:
                    family.shortfalls.append(f"{run.folder}: {run.result['message']}")
                missing = [goal for goal in self.tolerances if goal not in run.values]
                if missing:
                    raise StepError(f"the runs give no {', '.join(missing)}")
                arm = LEVER * run.result["configuration"]["body_length"] / run.result["reference"]["length"]
                goals = ", ".join(f"{goal} {run.values[goal]:.5g}" for goal in self.tolerances)
                tell(f"family {number}, sizes times {factor:g}: {run.cells:,} cells{', ' + stream.name if stream.name else ''}: {goals}")
        for stream in self.streams:
            family.intervals[stream.name] = intervals(family.members[stream.name], arm)
            for goal in self.tolerances:
                found = family.intervals[stream.name][goal]
                tell(f"  {goal} = {found.value:.5g} +- {found.uncertainty:.2g}{', ' + stream.name if stream.name else ''}")
        self._yield *= member.cells * member.factor**3 / cells  # of the finest
        family.cpu = (self.meshing + self.solving).cpu
        self._seconds_a_cell = (self._seconds() - start) / cells
        return family

    def _mesh(self, folder: Path, cells: int, indicators: Sequence[Path], factor: float | None) -> Mesh:
        start = time.monotonic()
        mesh = self.steps.mesh(folder, cells, indicators, factor)
        self.meshing += mesh.cost
        self._spent_before += max(mesh.cost.wall - (time.monotonic() - start), 0.0)
        return mesh

    def _solve(self, mesh: Mesh, folder: Path, stream: Stream, verb: str, *options: str) -> Solved:
        start = time.monotonic()
        run = self.steps.solve(mesh, folder, verb, stream.settings, *options)
        self.solving += run.cost
        self._spent_before += max(run.cost.wall - (time.monotonic() - start), 0.0)
        return run

    def _seconds(self) -> float:
        """Of the clock, with those of steps that were there."""
        return time.monotonic() - self._start + self._spent_before

    def _forecast(self, cells: int) -> float:
        return self._seconds_a_cell * cells


def _folder_of(name: str, stream: Stream) -> str:
    return f"{name}_{stream.name}" if stream.name else name
