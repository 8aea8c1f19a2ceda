"""Runs on this machine, one after the other, each under mpirun."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path

from sweep.lock import Locked, locked
from sweep.meshes import make_mesh, mesh_settings
from sweep.plan import Run, SweepError
from sweep.state import END, LOCK, LOG, PROGRESS, RECORD, RESULT, Phase, State
from sweep.state import checkpoints, progress, read_json, reason, remove_checkpoints, state_at_rest, write_json
from sweep.text import duration, toml_value

ROOT = Path(__file__).resolve().parents[2]
ENDLESS = 1e9  # seconds


def find_program(given: str | None) -> Path:
    """The program: as given, from ALPHADOT, of the build folder, or on the PATH. Raises SweepError."""
    wanted = given or os.environ.get("ALPHADOT")
    candidates = [wanted] if wanted else [ROOT / "build" / "alphadot", shutil.which("alphadot")]
    for candidate in candidates:
        if candidate and os.access(candidate, os.X_OK) and Path(candidate).is_file():
            return Path(candidate).resolve()
    where = wanted or f"{ROOT / 'build' / 'alphadot'} or on the PATH"
    raise SweepError(f"there is no program {where}; build it with scripts/build.sh, or name it with --program")


def toml_text(value: object) -> str:
    """A value as --set takes it."""
    return value if isinstance(value, str) else toml_value(value)


class Runner:
    """Runs what it is given; on SIGINT, SIGTERM or SIGUSR2 the program is told to write a checkpoint and end, on a second one to
    end at once, and the rest is left for another time."""

    def __init__(self, program: Path) -> None:
        self.program = program
        self.stopping = False
        self.child: subprocess.Popen | None = None

    def listen(self) -> None:
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGUSR2):
            signal.signal(number, lambda *_: self.stop())

    def stop(self) -> None:
        second, self.stopping = self.stopping, True
        if self.child and self.child.poll() is None:
            self.child.send_signal(signal.SIGTERM if second else signal.SIGUSR2)  # mpirun passes both on

    def run_all(self, runs: Sequence[Run]) -> None:
        for number, run in enumerate(runs, 1):
            if self.stopping:
                return
            self.run(run, f"[{number}/{len(runs)}] {run.name}")

    def run(self, run: Run, label: str) -> State:
        """Brings one run to its end, if it is not there; waits for whoever works on it."""
        try:
            with self.lock_of(run, label) as lock:
                state = state_at_rest(run)
                if state.phase in (Phase.WAITING, Phase.INTERRUPTED):
                    print(f"{label}: {state.detail or 'starts'}", flush=True)
                    self.attempt(run, state.phase is Phase.INTERRUPTED, lock)
                    state = state_at_rest(run)
                    if state.phase is Phase.DONE and not run.is_motion:  # only a motion can be extended
                        remove_checkpoints(run)
        except OSError as error:
            state = State(Phase.FAILED, str(error))
        shown = state.detail + (f", {duration(state.seconds)}" if state.seconds is not None else "")
        print(f"{label}: {state.phase.value}: {shown}", flush=True)
        return state

    def lock_of(self, run: Run, label: str):
        """The lock on the folder of a run. Only the program of a sweep that was killed can hold it: it is left to finish."""
        try:
            with locked(run.folder / LOCK):
                pass
        except Locked as error:
            print(f"{label}: waits for {error}", flush=True)
        return locked(run.folder / LOCK, ENDLESS)

    def attempt(self, run: Run, goes_on: bool, lock: int) -> None:
        record = read_json(run.folder / RECORD)
        if not goes_on:
            for file in checkpoints(run):
                file.unlink()
        for name in (END, RESULT, PROGRESS):
            (run.folder / name).unlink(missing_ok=True)
        attempt = record.get("attempt", 0) + 1
        write_json(run.folder / RECORD, {"identity": run.identity(), "attempt": attempt, "started": time.strftime("%F %T")})
        try:
            code = self.launch(run, make_mesh(run), attempt, lock)
        except (SweepError, OSError) as error:
            write_json(run.folder / END, {"reason": str(error)})
            return
        end = {"code": code, "stopped": self.stopping and read_json(run.folder / RESULT).get("status") is None}
        if code != 0 and not end["stopped"]:
            end["reason"] = reason(run.folder) or f"the program ended with code {code}; see {run.folder / LOG}"
        write_json(run.folder / END, end)

    def command(self, run: Run, case: Path) -> list[str]:
        settings = run.settings | mesh_settings(run)
        if run.volume is None:  # a flow.vtkhdf of every run fills a disk
            settings |= {"output.flow": False}
        command = [str(self.program), run.verb, str(case), "--out", str(run.folder), "--overwrite"]
        command += [word for key, value in settings.items() for word in ("--set", f"{key}={toml_text(value)}")]
        if checkpoints(run):
            command.append("--restart")
        return [os.environ.get("MPIEXEC", "mpirun"), "-n", str(run.ranks), *command]

    def launch(self, run: Run, case: Path, attempt: int, lock: int) -> int:
        """Runs the program and gives its exit code. It is in a session of its own: a Ctrl-C at the terminal reaches it through
        stop() alone. It inherits the lock: a program that outlives this one keeps its folder."""
        environment = os.environ | {"OMPI_MCA_rmaps_base_oversubscribe": "1"}
        if os.geteuid() == 0:
            environment |= {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
        command = self.command(run, case)
        with open(run.folder / LOG, "a") as log:
            log.write(f"\n== attempt {attempt}, {time.strftime('%F %T')}: {' '.join(command)}\n")
            log.flush()
            self.child = subprocess.Popen(
                command,
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=log,
                env=environment,
                start_new_session=True,
                pass_fds=(lock,),
            )
        if self.stopping:  # the signal came before there was a child to pass it to
            self.child.send_signal(signal.SIGTERM)
        return self.wait(run)

    def wait(self, run: Run) -> int:
        show = sys.stdout.isatty()
        while True:
            try:
                code = self.child.wait(2.0)
                break
            except subprocess.TimeoutExpired:
                if show:
                    print(f"\r  {progress(run.folder):<60}", end="", flush=True)
        if show:
            print("\r" + " " * 62 + "\r", end="")
        return code
