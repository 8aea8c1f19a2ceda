"""The meshes that a sweep needs: of a description, of a level of the description that the case names, or made by the mesh.py beside it."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from sweep.descriptions import kept, meshed
from sweep.plan import Run, SweepError, case_content


def mesh_file(run: Run) -> Path | None:
    """Where the mesh of the run is or will be; None: where the case or a description says."""
    if not run.mesh or run.is_described or _described_level(run):
        return None
    if Path(run.mesh).suffix:
        return (run.case.parent / run.mesh).resolve()
    return run.case.parent / f"{run.mesh}.msh"


def mesh_settings(run: Run) -> dict[str, str]:
    """The keys that give the case its mesh; none: it keeps its own."""
    if _described_level(run):
        return {"mesh.level": run.mesh}
    file = mesh_file(run)
    return {"mesh.file": str(file)} if file else {}


def make_mesh(run: Run) -> Path:
    """Makes the mesh if it is a level and not there yet; the case file to be run. Raises SweepError.

    Under a name of its own first: two sweeps may make the same mesh at the same time.
    """
    if run.is_described:
        return meshed(run)
    if description := _described_level(run):
        model = run.settings.get("reference.model") or _table(run, "reference").get("model", "full")
        try:
            kept(description, description.stat().st_mtime_ns, run.mesh, run.mach, None, str(model))
        except OSError as error:
            raise SweepError(f"{description}: {error.strerror}") from None
        return run.case
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


def _described_level(run: Run) -> Path | None:
    """The description from which the case takes its mesh, where the run asks for a level of it."""
    name = _table(run, "mesh").get("from")
    return run.case.parent / name if run.mesh and not Path(run.mesh).suffix and isinstance(name, str) else None


def _table(run: Run, name: str) -> dict:
    """Of the case file; nothing where that is wrong: the program will say so."""
    content = case_content(run.case)
    table = content.get(name) if isinstance(content, dict) else None
    return table if isinstance(table, dict) else {}
