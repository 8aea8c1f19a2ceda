"""The meshes that a sweep needs, made by the mesh.py beside the case, or of a description."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from sweep.descriptions import meshed
from sweep.plan import Run, SweepError


def mesh_file(run: Run) -> Path | None:
    """Where the mesh of the run is or will be; None: where the case says."""
    if not run.mesh or run.is_described:
        return None
    if Path(run.mesh).suffix:
        return (run.case.parent / run.mesh).resolve()
    return run.case.parent / f"{run.mesh}.msh"


def make_mesh(run: Run) -> Path:
    """Makes the mesh if it is a level and not there yet; the case file to be run. Raises SweepError.

    Under a name of its own first: two sweeps may make the same mesh at the same time.
    """
    if run.is_described:
        return meshed(run)
    file = mesh_file(run)
    if file is None or file.exists():
        return run.case
    generator = run.case.parent / "mesh.py"
    if Path(run.mesh).suffix or not generator.exists():
        raise SweepError(f"there is no mesh {file}, and no {generator} that makes level '{run.mesh}'")
    print(f"making the {run.mesh} mesh, {file}", flush=True)
    temporary = file.with_name(f"{file.stem}.{os.getpid()}.msh")
    try:
        command = [sys.executable, str(generator), "--level", run.mesh, "--output", str(temporary)]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode != 0:
            said = (done.stderr.strip().splitlines() or ["no reason given"])[-1]
            raise SweepError(f"{generator} failed on level '{run.mesh}': {said}")
        os.replace(temporary, file)
    finally:
        temporary.unlink(missing_ok=True)
    return run.case
