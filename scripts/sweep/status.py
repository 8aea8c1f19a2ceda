"""The table of a sweep: which runs wait, run, are done, were interrupted, or failed and why."""

from __future__ import annotations

import os
import shutil
from pathlib import Path
from statistics import median

from sweep.plan import Run, Sweep
from sweep.state import Phase, State, read_state, seconds_spent
from sweep.text import aligned, duration, size


def states(sweep: Sweep) -> list[tuple[Run, State]]:
    return [(run, read_state(run)) for run in sweep.runs]


def time_left(found: list[tuple[Run, State]]) -> float | None:
    """Seconds for what is not done, by the runs of the same method and mesh that are; None while that cannot be known: there are
    none of them, or a run at work has taken longer than they.
    """
    left = 0.0
    for run, state in found:
        if state.phase not in (Phase.WAITING, Phase.INTERRUPTED, Phase.RUNNING):
            continue
        alike = [s.seconds for r, s in found if s.seconds is not None and (r.method, r.mesh) == (run.method, run.mesh)]
        spent = seconds_spent(run) if state.phase is Phase.RUNNING else 0.0
        if not alike or spent > median(alike):
            return None
        left += median(alike) - spent
    return left


def folder_size(folder: Path) -> int:
    with os.scandir(folder) as entries:
        return sum(entry.stat().st_size for entry in entries if entry.is_file())


def disk_text(found: list[tuple[Run, State]]) -> str:
    """What the runs take on the disk, by some of those that are done; "" while there are none."""
    done = [run.folder for run, state in found if state.phase is Phase.DONE]
    some = done[:: max(1, len(done) // 20)]
    if not some:
        return ""
    each = sum(map(folder_size, some)) / len(some)
    free = shutil.disk_usage(some[0]).free
    need = each * (len(found) - len(done))
    text = f"disk: {size(each)} a run, {size(each * len(found))} for all, {size(free)} free"
    return text + (": NOT ENOUGH for what is left" if need > free else "")


def status_text(sweep: Sweep) -> str:
    found = states(sweep)
    rows = [("run", "state", "time", "")]
    for run, state in found:
        rows.append((run.name, state.phase.value, "" if state.seconds is None else duration(state.seconds), state.detail))
    counts = {phase: sum(state.phase is phase for _, state in found) for phase in Phase}
    summary = ", ".join(f"{count} {phase.value}" for phase, count in counts.items() if count)
    left = time_left(found)
    if left:
        summary += f"; about {duration(left)} left"
    disk = disk_text(found)
    summary += f"\n{disk}" if disk else ""
    return f"{sweep.title}: {len(found)} runs in {sweep.folder}\n\n{aligned(rows)}\n\n{summary}\n"
