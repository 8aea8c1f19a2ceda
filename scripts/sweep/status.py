"""The table of a sweep: which runs wait, run, are done, were interrupted, or failed and why."""

from __future__ import annotations

from statistics import median

from sweep.plan import Run, Sweep
from sweep.state import Phase, State, read_state
from sweep.text import aligned, duration


def states(sweep: Sweep) -> list[tuple[Run, State]]:
    return [(run, read_state(run)) for run in sweep.runs]


def time_left(found: list[tuple[Run, State]]) -> float | None:
    """Seconds for what is not done, by the runs of the same method and mesh that are; None while there are none of them.

    A run that is at work counts as half.
    """
    left = 0.0
    for run, state in found:
        share = {Phase.WAITING: 1.0, Phase.INTERRUPTED: 1.0, Phase.RUNNING: 0.5}.get(state.phase, 0.0)
        if share:
            alike = [s.seconds for r, s in found if s.seconds is not None and (r.method, r.mesh) == (run.method, run.mesh)]
            if not alike:
                return None
            left += share * median(alike)
    return left


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
    return f"{sweep.title}: {len(found)} runs in {sweep.folder}\n\n{aligned(rows)}\n\n{summary}\n"
