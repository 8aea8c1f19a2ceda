"""How far a run is, read from the files in its folder."""

from __future__ import annotations

import json
import os
import re
import time
from dataclasses import dataclass
from enum import Enum
from pathlib import Path

from sweep.lock import is_locked
from sweep.plan import Run
from sweep.text import duration

LOCK, LOG, RECORD, END = "lock", "log.txt", "run.json", "end.json"
RESULT, PROGRESS = "result.json", "progress.json"  # by the program; the latter while it runs
GOOD_ENDS = ("converged", "completed")
SHORT_END = "not_converged"  # to the end, but something that was asked for was not reached
TAIL = 20_000  # bytes of a log that are searched for errors


class Phase(Enum):
    """A run that is not converged came to its end with all of its numbers, but some of them are not what was asked for."""

    WAITING = "waiting"
    RUNNING = "running"
    DONE = "done"
    SHORT = "not converged"
    INTERRUPTED = "interrupted"
    FAILED = "failed"


@dataclass(frozen=True)
class State:
    phase: Phase
    detail: str = ""
    seconds: float | None = None  # of wall clock, when it came to its end


def read_json(path: Path | str) -> dict:
    """Content of a file, or {} where there is none that can be read."""
    try:
        with open(path, "rb", buffering=0) as file:
            content = json.loads(file.read())
        return content if isinstance(content, dict) else {}
    except (OSError, ValueError):
        return {}


WORD, TEXT, NUMBER = (re.compile(rb'"%s":\s*%s' % pair) for pair in (
    (b"status", rb'"(\w*)"'), (b"message", rb'("(?:[^"\\\\]|\\\\.)*")'), (b"wall_s", rb"([-+.\deE]+)")
))  # fmt: skip


def ending(path: Path | str) -> dict:
    """How a result.json says that its run ended, as in the whole of it: status, message and performance.wall_s. A hundredth of the
    work of parsing it, for there may be thousands; {} where there is none that can be read."""
    try:
        with open(path, "rb", buffering=0) as file:
            raw = file.read()
    except OSError:
        return {}
    status, message, wall = WORD.search(raw), TEXT.search(raw), NUMBER.search(raw)
    if not raw.lstrip(b"{ \n").startswith(b'"status"') or not status or not message or not raw.rstrip().endswith(b"}"):
        return read_json(path)  # not as the program writes it
    performance = {"performance": {"wall_s": float(wall[1])}} if wall else {}
    return {"status": status[1].decode(), "message": json.loads(message[1])} | performance


def write_json(path: Path, content: object) -> None:
    """Writes through a temporary file: whoever reads sees the old content or the new."""
    temporary = path.with_name(path.name + ".tmp")
    temporary.write_text(json.dumps(content, indent=1) + "\n")
    os.replace(temporary, path)


def log_tail(folder: Path) -> str:
    try:
        with open(folder / LOG, "rb") as file:
            file.seek(max(0, os.path.getsize(folder / LOG) - TAIL))
            return file.read().decode(errors="replace")
    except OSError:
        return ""


def progress(folder: Path) -> str:
    """The latest progress of a run: "steady 1e-6.1, steady in 13 s", "step 12/72, 3 min 20 s left", "linear solves"."""
    found = read_json(folder / PROGRESS)
    phase, left = found.get("phase", "starting"), found.get("seconds_left")
    if phase == "steady":
        phase = f"steady 1e-{found['orders']:.1f}"
        return phase if left is None else f"{phase}, steady in {duration(left)}"
    elif phase == "motion":
        phase = f"step {found['step']:.0f}/{found['of_steps']:.0f}"
    return phase if left is None else f"{phase}, {duration(left)} left"


def seconds_spent(run: Run) -> float:
    """Wall clock since the latest attempt at a run began."""
    try:
        return time.time() - (run.folder / RECORD).stat().st_mtime
    except OSError:
        return 0.0


def reason(folder: Path) -> str:
    """Why a run failed, from its result or the errors in its log."""
    message = read_json(folder / RESULT).get("message")
    if message:
        return message
    attempt = log_tail(folder).rsplit("\n== ", 1)[-1]
    errors = [line for line in attempt.splitlines() if re.search(r"\b(error|diverged)\b", line, re.IGNORECASE)]
    return re.sub(r"^alphadot: (internal )?error: ", "", errors[0]) if errors else ""


def without_cycles(identity: dict) -> tuple[dict, float]:
    """An identity but for the cycles of its motion, and those (0: as the case says)."""
    settings = dict(identity.get("settings", {}))
    cycles = settings.pop("unsteady.cycles", 0.0)
    return identity | {"settings": settings}, cycles


def is_extension(record: dict, run: Run) -> bool:
    """Was the run made with everything the same but fewer cycles? Then it can go on from its last checkpoint."""
    (old, old_cycles), (wanted, cycles) = without_cycles(record.get("identity", {})), without_cycles(run.identity())
    return run.is_motion and old == wanted and old_cycles < cycles


def checkpoints(run: Run) -> list[Path]:
    """What a restart of the run can start from."""
    return sorted(run.folder.glob("checkpoint_*.vtkhdf"))


def remove_checkpoints(run: Run) -> None:
    """Also those of its coarser meshes."""
    for file in (*checkpoints(run), *run.folder.glob("mesh_*/checkpoint_*.vtkhdf")):
        file.unlink()


def read_state(run: Run, result: dict | None = None) -> State:
    """As the files in its folder have it; `result`: what is in its result.json, where that has been read."""
    if is_locked(f"{run.folder}/{LOCK}"):
        return State(Phase.RUNNING, progress(run.folder))
    return state_at_rest(run, result)


def state_at_rest(run: Run, result: dict | None = None) -> State:
    """The state of a run that nobody works on."""
    record = read_json(f"{run.folder}/{RECORD}")  # thousands of paths: as text they cost less
    if not record:
        return State(Phase.WAITING)
    end = read_json(f"{run.folder}/{END}")
    result = ending(f"{run.folder}/{RESULT}") if result is None else result
    if record.get("identity") != run.identity():
        if is_extension(record, run):
            return State(Phase.INTERRUPTED, f"to go on to {run.settings['unsteady.cycles']:g} cycles")
        return State(Phase.WAITING, "settings changed since it ran")
    status = result.get("status")
    if status in (*GOOD_ENDS, SHORT_END):
        phase = Phase.SHORT if status == SHORT_END else Phase.DONE
        return State(phase, result.get("message") or status, result.get("performance", {}).get("wall_s"))
    if status == "interrupted" or end.get("stopped") or not (end or status):
        return State(Phase.INTERRUPTED, "goes on from its checkpoint" if checkpoints(run) else "starts again")
    return State(Phase.FAILED, end.get("reason") or reason(run.folder) or status or "no reason found; see its log.txt")
