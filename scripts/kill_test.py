#!/usr/bin/python3
"""Kills a run on two ranks with SIGKILL at random moments, restarts it each time, and compares its end with that of a run in peace.

    kill_test.py --program build/alphadot --kills 50 --seed 1

The run writes a checkpoint after every time step, and half of the kills wait until one is being written. Half of them hit one rank
(mpirun ends the others), half mpirun and all ranks at once. Checked: no checkpoint that was announced is ever lost, and the final
history, pictures, derivatives and last checkpoint are equal, bit for bit. Exit code 0 when all of it holds.
"""

from __future__ import annotations

import argparse
import os
import random
import re
import shutil
import signal
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default=os.environ.get("ALPHADOT", str(ROOT / "build" / "alphadot")))
    parser.add_argument("--mpiexec", default=os.environ.get("MPIEXEC", "mpirun"))
    parser.add_argument("--kills", type=int, default=50)
    parser.add_argument("--ranks", type=int, default=2)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()

    os.environ |= {"ALPHADOT": str(Path(arguments.program).resolve()), "MPIEXEC": arguments.mpiexec}
    sys.path.insert(0, str(ROOT / "tests" / "fault"))
    from runs import LiveRun, checkpoints, differences, make_case, run, settings

    dice = random.Random(arguments.seed)
    ranks = arguments.ranks
    # Enough work for several kills on a fast machine; a run that ends before them all is compared and begun anew.
    case = settings(unsteady_steps_per_cycle=100, checkpoint_steps=1, checkpoint_keep=3)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        make_case(folder)
        full, part = folder / "full", folder / "part"
        done = run(folder, full, *case, ranks=ranks)
        if done.returncode:
            print(done.stderr)
            return 1

        kills, inside, ends, lost, announced = 0, 0, 1, [], 0
        while kills < arguments.kills:
            live = LiveRun(folder, part, *case, "--restart", ranks=ranks)
            live.wait_for("cells, ")  # the ranks have come up
            delay = dice.uniform(0, 0.4)
            end = time.monotonic() + delay
            while time.monotonic() < end and live.process.poll() is None:
                time.sleep(0.001)
            if dice.random() < 0.5:
                while live.process.poll() is None and not any(part.glob("checkpoint_*.part")):
                    pass
            if live.process.poll() is not None:  # it reached the end before
                lost += [f"after {kills} kills: {change}" for change in differences(full, part)]
                shutil.rmtree(part)
                announced = 0
                ends += 1
                continue
            if dice.random() < 0.5 and live.rank_pids():
                try:
                    os.kill(dice.choice(live.rank_pids()), signal.SIGKILL)
                except ProcessLookupError:
                    pass
                live.wait()
            else:
                live.kill()
            kills += 1
            inside += any(part.glob("checkpoint_*.part"))
            announced = max(announced, live.announced())
            begun = re.search(r"goes on from .*checkpoint_(\d+)", live.text())
            if "not taken" in live.text():
                lost.append(f"kill {kills}: {live.text()}")
            newest = int(checkpoints(part)[-1].stem.split("_")[1]) if checkpoints(part) else 0
            if newest < announced or (begun is None and announced > live.announced() > 0):
                lost.append(f"kill {kills}: checkpoint {announced} was announced, {newest} is the newest")
            shutil.copy(live.log, folder / "last.log")

        done = run(folder, part, *case, "--restart", ranks=ranks)
        changed = differences(full, part) if done.returncode == 0 else [done.stderr]
        print(f"{kills} kills, {inside} of them inside the writing of a checkpoint; {ends} ends compared")
        for trouble in [*lost, *changed]:
            print("differs or lost:", trouble)
        print("FAILED" if lost or changed else "the end is the same, and nothing was lost")
        return 1 if lost or changed or kills < arguments.kills else 0


if __name__ == "__main__":
    sys.exit(main())
