"""The table of a sweep: which runs wait, run, are done, were interrupted, or failed and why."""

from __future__ import annotations

from statistics import median

from sweep.plan import Run, Sweep
from sweep.state import Phase, State, read_state, seconds_spent
from sweep.text import aligned, duration


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
