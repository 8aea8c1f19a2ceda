"""Slurm: an array job, each task some runs, checkpointed before its wall-clock limit and queued again until they are done."""

from __future__ import annotations

import math
import shlex
import subprocess
import sys
from argparse import Namespace
from collections.abc import Sequence
from pathlib import Path

from sweep.plan import Run, Sweep, SweepError

FOLDER = "slurm"
SCRIPT = Path(__file__).resolve().parents[1] / "sweep.py"
MOST_TASKS = 1000  # of an array: Slurm's default limit
RESTARTS = 100  # a job that gets nowhere is not queued for ever

ARRAY = """\
#!/bin/bash
# Written by sweep.py slurm: the runs of {title}, {each} a task.
#SBATCH --job-name={name}
#SBATCH --array=0-{last}
#SBATCH --nodes=1-{ranks}
#SBATCH --ntasks={ranks}
#SBATCH --time={time}
#SBATCH --signal=B:USR2@{margin}
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output={log}
{more}
runs=({runs})
own=("${{runs[@]:SLURM_ARRAY_TASK_ID * {each}:{each}}}")
echo "$(date +'%F %T') ${{own[*]}} on $SLURMD_NODENAME, started ${{SLURM_RESTART_COUNT:-0}} times before"

# sweep.py passes the signal on to the program, which writes a checkpoint and ends.
{python} {script} run {sweep} --only "${{own[@]}}" --program {program} &
child=$!
trap 'echo "$(date +%F\\ %T) the wall-clock limit is near: checkpoint and end"; kill -USR2 $child' USR2
wait $child
code=$?
while kill -0 $child 2>/dev/null; do  # a signal ends a wait early
  wait $child
  code=$?
done
echo "$(date +'%F %T') ended with code $code"

# 3: interrupted, with work left.
if ((code == 3 && ${{SLURM_RESTART_COUNT:-0}} < {restarts})); then
  echo "$(date +'%F %T') back into the queue"
  scontrol requeue "${{SLURM_ARRAY_JOB_ID}}_$SLURM_ARRAY_TASK_ID"
  sleep 60  # Slurm ends the job meanwhile
fi
exit $code
"""

REPORT = """\
#!/bin/bash
# Written by sweep.py slurm: the report, when every run has come to its end.
#SBATCH --job-name={name}-report
#SBATCH --ntasks=1
#SBATCH --time=00:10:00
#SBATCH --output={log}
{more}
{python} {script} status {sweep}
{python} {script} report {sweep}
"""


def write_scripts(sweep: Sweep, runs: Sequence[Run], program: Path, arguments: Namespace) -> list[Path]:
    """The scripts of the array job and of the report job, in the sweep's folder."""
    ranks = {run.ranks for run in runs}
    if len(ranks) > 1:
        raise SweepError(f"an array job has one number of ranks, this sweep {sorted(ranks)}: make a sweep file of each")
    folder = sweep.folder / FOLDER
    folder.mkdir(parents=True, exist_ok=True)
    common = {
        "title": sweep.title,
        "name": sweep.name,
        "python": shlex.quote(sys.executable),
        "script": shlex.quote(str(SCRIPT)),
        "sweep": shlex.quote(str(sweep.file)),
        "more": f"#SBATCH --partition={arguments.partition}\n" if arguments.partition else "",
    }
    each = arguments.each or math.ceil(len(runs) / MOST_TASKS)
    array = ARRAY.format(
        **common,
        each=each,
        last=math.ceil(len(runs) / each) - 1,
        ranks=ranks.pop(),
        time=arguments.time,
        margin=arguments.margin,
        log=folder / "%a.log",
        runs=" ".join(run.name for run in runs),
        program=shlex.quote(str(program)),
        restarts=RESTARTS,
    )
    texts = {"array.sbatch": array, "report.sbatch": REPORT.format(**common, log=folder / "report.log")}
    for name, text in texts.items():
        (folder / name).write_text(text)
    return [folder / name for name in texts]


def submit(scripts: Sequence[Path]) -> int:
    """Submits the array, and the report after it."""
    job = ""
    for script in scripts:
        after = [f"--dependency=afterany:{job}"] if job else []
        try:
            done = subprocess.run(["sbatch", "--parsable", *after, str(script)], capture_output=True, text=True)
        except FileNotFoundError:
            raise SweepError("there is no sbatch here; submit the scripts where there is Slurm") from None
        if done.returncode != 0:
            raise SweepError(f"sbatch {script}: {done.stderr.strip()}")
        job = done.stdout.strip().split(";")[0]
        print(f"job {job}: {script.name}")
    return 0
