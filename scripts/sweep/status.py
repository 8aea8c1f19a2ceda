"""The table of a sweep: which runs wait, run, are done, were interrupted, or failed and why."""

from __future__ import annotations

import shutil
from pathlib import Path
from statistics import median

from meshing.limits import LEVELS
from sweep.meshes import mesh_file
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
    return sum(file.stat().st_size for file in folder.rglob("*") if file.is_file())


def expected_size(run: Run) -> float | None:
    """Of a run that is not done, by the cells of its mesh; None where they are not known. Bytes as seen on rockets of 27,000 to 199,000
    cells: surface.vtkhdf and symmetry.vtkhdf take 12 a cell, a flow.vtkhdf 76, the mesh file 52, all tables and texts some 60,000."""
    file = mesh_file(run)
    if run.is_described:
        cells = LEVELS.get(run.mesh or "coarse", 0) * (2 if run.model == "full" else 1)
    else:
        cells = file.stat().st_size / 52 if file and file.exists() else LEVELS.get(run.mesh, 0)
    return 6e4 + cells * (12 + 76 * bool(run.volume)) if cells else None


def disk_text(found: list[tuple[Run, State]]) -> str:
    """What the runs take on the disk, by some of those that are done, or by their cells before; "" where those are not known."""
    done = [run.folder for run, state in found if state.phase is Phase.DONE]
    some = done[:: max(1, len(done) // 20)]
    each = sum(map(folder_size, some)) / len(some) if some else found and expected_size(found[0][0])
    if not each:
        return ""
    free = shutil.disk_usage(next(path for path in (found[0][0].folder, *found[0][0].folder.parents) if path.exists())).free
    need = each * (len(found) - len(done))
    text = f"disk: {'' if some else 'about '}{size(each)} a run, {size(each * len(found))} for all, {size(free)} free"
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
