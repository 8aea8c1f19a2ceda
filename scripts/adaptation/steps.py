"""The steps of an adaptation: meshes and runs in folders of their own, each found again when it is there."""

from __future__ import annotations

import json
import os
import resource
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from functools import cached_property
from math import isnan
from pathlib import Path

from sweep.database import Estimate
from sweep.state import GOOD_ENDS, RESULT, write_json

MESH_PROGRAM = Path(__file__).resolve().parents[1] / "mesh.py"
DONE = "done.json"  # of a step: what was asked, what it cost


class StepError(Exception):
    """What went wrong, with the program's own words."""


class Interrupted(Exception):
    """The program was told to stop and has written a checkpoint."""


@dataclass
class Cost:
    """Of a step: seconds of all processors and of the clock, and the largest process's memory in bytes."""

    cpu: float = 0.0
    wall: float = 0.0
    memory: int = 0

    def __add__(self, other: Cost) -> Cost:
        return Cost(self.cpu + other.cpu, self.wall + other.wall, max(self.memory, other.memory))


@dataclass(frozen=True)
class Mesh:
    """A mesh that is there: its case file, the mesh itself, and what tells it from one that was made for something else."""

    case: Path
    file: Path
    cost: Cost
    stamp: int = 0


@dataclass(frozen=True)
class Solved:
    """A run that is there."""

    folder: Path
    result: dict
    cost: Cost

    @property
    def cells(self) -> int:
        return self.result["mesh"]["cells"]

    @cached_property
    def estimates(self) -> dict[str, Estimate]:
        return {name: Estimate.of(entry) for name, entry in self.result["derivatives"].items() if entry["value"] is not None}

    @property
    def values(self) -> dict[str, float]:
        return {name: entry.value for name, entry in self.estimates.items()}

    @property
    def solver(self) -> dict[str, float]:
        """Uncertainties; one that is not known is as large as the value."""
        return {name: abs(e.value) if isnan(e.uncertainty) else e.uncertainty for name, e in self.estimates.items()}

    @property
    def is_converged(self) -> bool:
        return self.result["status"] in GOOD_ENDS


class Steps:
    """Makes meshes and runs below a folder."""

    def __init__(
        self, description: Path, case: Path | None, model: str | None, program: Path, settings: Sequence[str], ranks: int
    ) -> None:
        """`case`: a file that names the description, or None where the case that comes with a mesh will do; `model` of the mesh."""
        self.description, self.case, self.model = description, case, model
        self.program, self.settings, self.ranks = program, settings, ranks

    def mesh(self, folder: Path, cells: int, indicators: Sequence[Path], factor: float | None) -> Mesh:
        """Of about so many cells, or one of a family of them; from the description alone or as the indicators say."""
        asked = [cells, factor, [str(path) for path in indicators], [path.stat().st_mtime_ns for path in indicators]]
        done = _done(folder, asked)
        if done is None:
            partial = folder.with_name(f".{folder.name}.part")
            shutil.rmtree(partial, ignore_errors=True)
            partial.parent.mkdir(parents=True, exist_ok=True)
            command = ["/usr/bin/python3", "-B", MESH_PROGRAM, self.description, "-o", partial, "--cells", cells, "--no-picture"]
            command += ["--sizes", *indicators] if indicators else []
            command += ["--factors", factor] if factor else []
            command += ["--model", self.model] if self.model else []
            cost = self._call(command, partial.with_name(f"{folder.name}.log"))
            done = {"asked": asked, "cost": asdict(cost), "stamp": time.time_ns()}
            write_json(partial / DONE, done)
            shutil.rmtree(folder, ignore_errors=True)
            os.replace(partial, folder)
        (file,) = folder.glob("*.msh")
        return Mesh(folder / "case.toml", file, Cost(**done["cost"]), done["stamp"])

    def solve(self, mesh: Mesh, folder: Path, verb: str, settings: Sequence[str], *options: str) -> Solved:
        """Brings a run to its end, from its newest checkpoint where it was stopped. Raises Interrupted, StepError."""
        asked = [verb, *settings, *options, mesh.stamp]
        done = _done(folder, asked)
        if done is None:
            begun = folder.with_name(f"{folder.name}.begun.json")
            if begun.exists() and json.loads(begun.read_text()) != asked:
                shutil.rmtree(folder, ignore_errors=True)
            folder.parent.mkdir(parents=True, exist_ok=True)
            write_json(begun, asked)
            case = self.case or mesh.case
            keys = [f"mesh.file={mesh.file.resolve()}", "derivatives.coarser_meshes=[]", "output.surface=false", *self.settings, *settings]
            keys += ["mesh.from="] if self.case else []
            command = [*self._launcher(), self.program, verb, case, "--out", folder, "--overwrite", *options]
            command += [word for key in keys for word in ("--set", key)]
            if list(folder.glob("checkpoint_*")):
                command.append("--restart")
            done = {"asked": asked, "cost": asdict(self._call(command, folder.with_name(f"{folder.name}.log")))}
            for file in folder.glob("checkpoint_*"):
                file.unlink()
            write_json(folder / DONE, done)
            begun.unlink()
        return Solved(folder, json.loads((folder / RESULT).read_text()), Cost(**done["cost"]))

    def _launcher(self) -> list[str]:
        return [os.environ.get("MPIEXEC", "mpirun"), "-n", str(self.ranks)] if self.ranks > 1 else []

    def _call(self, command: Sequence[object], log: Path) -> Cost:
        """Runs a program; its output goes into the log. A run that is not converged is no error here."""
        words = [str(word) for word in command]
        before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
        with open(log, "w") as file:
            child = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=file, stderr=file, start_new_session=True)
        try:
            code = child.wait()
        except KeyboardInterrupt:
            child.send_signal(signal.SIGUSR2)  # writes a checkpoint and ends; mpirun passes it on
            child.wait()
            raise
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        if code == 3:
            raise Interrupted
        if code not in (0, 5):
            said = [line for line in log.read_text(errors="replace").splitlines() if line.strip()]
            errors = [line for line in said if "error" in line] or said[-1:]
            raise StepError("\n".join(errors) or f"{' '.join(words)} ended with code {code}")
        cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        return Cost(cpu, time.monotonic() - start, 1024 * after.ru_maxrss)


def _done(folder: Path, asked: list) -> dict | None:
    """Of a step that is there and was asked for the same."""
    file = folder / DONE
    done = json.loads(file.read_text()) if file.exists() else {}
    return done if done.get("asked") == json.loads(json.dumps(asked)) else None


def tell(text: str) -> None:
    """A line of progress."""
    print(text, file=sys.stderr, flush=True)
