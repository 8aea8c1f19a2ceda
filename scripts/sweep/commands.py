"""What sweep.py can be asked to do; one function a verb, each giving the exit code."""

from __future__ import annotations

import gc
import shutil
import sys
from argparse import Namespace
from contextlib import AbstractContextManager
from math import prod

from sweep import cluster
from sweep.lock import Locked, locked
from sweep.meshes import make_mesh
from sweep.plan import EXTENSIONS, Run, Sweep, SweepError, read_sweep, read_toml
from sweep.runner import Runner, find_program
from sweep.state import END, RESULT, Phase, checkpoints, read_state
from sweep.status import disk_text, states, status_text
from sweep.text import toml_key, toml_value

SWEEP_LOCK = "sweep.lock"
ENDED = {Phase.DONE, Phase.SHORT}


def exclusive(sweep: Sweep) -> AbstractContextManager[int]:
    """The lock of the whole sweep."""
    return locked(sweep.folder / SWEEP_LOCK)


def run(sweep: Sweep, arguments: Namespace) -> int:
    runner = Runner(find_program(arguments.program))
    runner.listen()
    if arguments.only:  # one job of many: the runs' own locks are enough
        return run_some(runner, [sweep.find(name) for name in arguments.only])
    told = disk_text(states(sweep))
    if told:
        print(told, flush=True)
    try:
        with exclusive(sweep):
            runner.run_all(sweep.runs)
    except Locked as error:
        raise SweepError(f"{sweep.file.name} is being run by {error}; see sweep.py status {sweep.file}") from None
    found = states(sweep)
    print(f"\n{status_text(sweep)}")
    if not arguments.no_report and any(state.phase in ENDED for _, state in found):
        report(sweep, arguments)
    return exit_code(found)


def run_some(runner: Runner, runs: list[Run]) -> int:
    """One after the other, until the program is told to stop. 1 when that has left nothing to go on from: or a job that is too short
    would be queued again and again."""
    before = [read_state(run).phase in ENDED for run in runs]
    runner.run_all(runs)
    found = [(run, read_state(run)) for run in runs]
    stopped = [run for run, state in found if state.phase is Phase.INTERRUPTED]
    if stopped and not any(map(checkpoints, stopped)) and [state.phase in ENDED for _, state in found] == before:
        print(f"{stopped[0].name}: has no checkpoint to go on from; give it more time")
        return 1
    left = {state.phase for _, state in found} - ENDED - {Phase.FAILED}
    return 3 if left else exit_code(found)


def exit_code(found: list) -> int:
    """As the program's: 1 when a run failed, 3 when some are still to be done, 5 when some are not converged."""
    phases = {state.phase for _, state in found}
    if Phase.FAILED in phases:
        return 1
    return 0 if phases == {Phase.DONE} else 5 if phases <= ENDED else 3


def status(sweep: Sweep, arguments: Namespace) -> int:
    print(status_text(sweep), end="")
    return 0


def report(sweep: Sweep, arguments: Namespace) -> int:
    try:  # matplotlib takes a second to load, and a cluster's nodes may not have it
        from sweep.report import write_report
    except ImportError as error:
        raise SweepError(f"{error}; run scripts/install.sh, and sweep.py with /usr/bin/python3") from None
    print(f"report: {write_report(sweep, find_program(arguments.program))}")
    return 0


def table(sweep: Sweep, arguments: Namespace) -> int:
    try:
        from sweep.tables_out import FOLDER, write_all
    except ImportError as error:
        raise SweepError(f"{error}; run scripts/install.sh, and sweep.py with /usr/bin/python3") from None
    gc.disable()  # the results of thousands of runs are millions of objects, none of them in a cycle
    lines = write_all(sweep, arguments.series, set(arguments.formats))
    print("\n".join([f"{sweep.folder / FOLDER}:", *lines]))
    return 0


def dynamics(sweep: Sweep, arguments: Namespace) -> int:
    from sweep import dynamics as modes

    text, rows = modes.dynamics(sweep, find_program(arguments.program))
    file = sweep.folder / "table" / "dynamics.csv"
    modes.write_csv(file, rows)
    print(f"{text}\nwritten: {file}")
    return 0


def trim(sweep: Sweep, arguments: Namespace) -> int:
    from sweep import trim as states

    request = states.Request(arguments.series, arguments.control, arguments.CN, arguments.center, arguments.linear)
    rows, notes = states.trim(sweep, find_program(arguments.program), request)
    file = sweep.folder / "table" / "trim.csv"
    states.write_csv(file, rows, notes)
    print(f"{states.text(rows, notes)}\nwritten: {file}")
    return 0


def extend(sweep: Sweep, arguments: Namespace) -> int:
    if not arguments.mach and not arguments.cycles:
        raise SweepError("extend needs --mach or --cycles")
    with exclusive(sweep):
        file = sweep.folder / EXTENSIONS
        before = read_toml(file) if file.exists() else {}
        blocks, cycles = before.get("runs", []), arguments.cycles or before.get("cycles")
        known = {(run.method, run.mach) for run in sweep.runs}
        methods = arguments.method or list(dict.fromkeys(run.method for run in sweep.runs))
        for method in methods if arguments.mach else []:
            new = [mach for mach in arguments.mach if (method, mach) not in known]
            if new:
                blocks.append({"method": method, "mach": new, **others(sweep, method)})
        lines = ["# Added by sweep.py extend; edit or delete as you like."]
        lines += [f"cycles = {cycles}"] if cycles else []
        for block in blocks:
            lines += ["", "[[runs]]", *(f"{toml_key(key)} = {toml_value(value)}" for key, value in block.items())]
        old = file.read_text() if file.exists() else None
        file.write_text("\n".join(lines) + "\n")
        try:
            longer = read_sweep(sweep.file)
        except SweepError:
            file.write_text(old) if old is not None else file.unlink()
            raise
    print(f"{len(longer.runs) - len(sweep.runs)} runs more, in {file}\n\n{status_text(longer)}", end="")
    return 0


def others(sweep: Sweep, method: str) -> dict:
    """Angles, rotations, deflections and meshes that a method has in the sweep: what [[runs]] of it must say. Raises SweepError when no
    lists multiply to them."""
    alike = [run for run in sweep.runs if run.method == method]
    if not alike:
        return {}
    distinct = lambda values: list(dict.fromkeys(values))
    out = {"alpha": distinct(run.alpha for run in alike)}
    out |= {"beta": distinct(run.beta for run in alike)} if any(run.beta for run in alike) else {}
    out |= {"mesh": distinct(run.mesh for run in alike)} if any(run.mesh for run in alike) else {}
    controls = distinct(name for run in alike for name in run.deflections)
    turned = {name: distinct(run.deflections.get(name, 0.0) for run in alike) for name in controls}
    rates = {name: distinct(run.rates.get(name, 0.0) for run in alike) for name in distinct(name for run in alike for name in run.rates)}
    out |= rates
    points = distinct((run.alpha, run.beta, run.mesh, *run.rates.values(), tuple(run.deflections.items())) for run in alike)
    product = prod(len(values) for values in (*out.values(), *turned.values()))
    if len(points) != product:
        raise SweepError(f"{sweep.file}: the runs of {method} are no product of lists: add the Mach numbers in the sweep file")
    return out | ({"deflection": turned} if turned else {})


def retry(sweep: Sweep, arguments: Namespace) -> int:
    """What has no end counts as interrupted, and `run` takes it up. One that is not converged would go on from its checkpoint to
    the same end: it starts again."""
    wanted = [sweep.find(arguments.only)] if arguments.only else sweep.runs
    with exclusive(sweep):
        found = [(run, read_state(run).phase) for run in wanted]
        failed = [run for run, phase in found if phase in (Phase.FAILED, Phase.SHORT)]
        for run in failed:
            for name in (END, RESULT):
                (run.folder / name).unlink(missing_ok=True)
        for run, phase in found:
            for file in checkpoints(run) if phase is Phase.SHORT else []:
                file.unlink()
    print(f"{len(failed)} to be run again{': ' if failed else ''}{', '.join(run.name for run in failed)}")
    return 0


def clean(sweep: Sweep, arguments: Namespace) -> int:
    """Removes folders of runs of this sweep, and nothing that it does not know."""
    with exclusive(sweep):
        found = states(sweep)
        running = [run.name for run, state in found if state.phase is Phase.RUNNING]
        if running:
            raise SweepError(f"still running: {', '.join(running)}")
        unwanted = (Phase.FAILED, Phase.INTERRUPTED)
        removed = [run for run, state in found if run.folder.exists() and (arguments.all or state.phase in unwanted)]
        for run in removed:
            shutil.rmtree(run.folder)
        if arguments.all:
            for name in ("report", cluster.FOLDER):
                shutil.rmtree(sweep.folder / name, ignore_errors=True)
            for name in ("report.html", EXTENSIONS):
                (sweep.folder / name).unlink(missing_ok=True)
    print(f"removed {len(removed)} run folders from {sweep.folder}")
    return 0


def slurm(sweep: Sweep, arguments: Namespace) -> int:
    program = find_program(arguments.program)
    wanted = [run for run, state in states(sweep) if state.phase in (Phase.WAITING, Phase.INTERRUPTED)]
    if not wanted:
        print("nothing to submit: every run is done, running, not converged, or failed (see sweep.py retry)")
        return 0
    for run in wanted:
        try:
            make_mesh(run)
        except SweepError as error:
            print(f"{run.name}: {error}", file=sys.stderr)  # its job will fail with this reason; the others go on
    scripts = cluster.write_scripts(sweep, wanted, program, arguments)
    print(f"scripts: {', '.join(map(str, scripts))}")
    return cluster.submit(scripts) if arguments.submit else 0
