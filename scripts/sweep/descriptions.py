"""Descriptions with their controls deflected, and the meshes that `alphadot mesh` keeps of descriptions and designs."""

from __future__ import annotations

import os
import subprocess
import sys
from functools import lru_cache
from pathlib import Path

from sweep.errors import SweepError
from sweep.plan import Run, read_toml
from sweep.text import toml_document

FOLDER = "descriptions"  # in the folder of the sweep
MESH = Path(__file__).resolve().parents[1] / "mesh.py"


def deflected(run: Run) -> Path:
    """The run's description, or one in the sweep's folder with its panels turned further by what the controls say. Raises
    SweepError."""
    if not run.panels:
        return run.case
    content = read_toml(run.case)
    sets = {of.get("name", "fin" if not index else f"fin{index + 1}"): of for index, of in enumerate(content.get("fins", []))}
    for name, turn in run.panels.items():
        if name not in sets:
            raise SweepError(f"{run.case}: has no [[fins]] called '{name}' to be deflected; it has {', '.join(sets) or 'none'}")
        sets[name]["deflection"] = turned(run, name, sets[name], turn)
    words = [run.case.stem, *(f"{control}{degrees:g}" for control, degrees in run.deflections.items())]
    file = run.folder.parent / FOLDER / f"{'_'.join(words)}.toml"
    text = f"# {run.case.name} with {', '.join(f'{name} at {value:g} degrees' for name, value in run.deflections.items())}\n"
    text += toml_document(content)
    if not file.exists() or file.read_text() != text:
        file.parent.mkdir(parents=True, exist_ok=True)
        temporary = file.with_name(f"{file.name}.{os.getpid()}")
        temporary.write_text(text)
        os.replace(temporary, file)
    return file


def turned(run: Run, name: str, fins: dict, turn: float | list[float]) -> list[float]:
    """Deflection of each panel of a set: the description's own and the controls'."""
    number = fins.get("number", 0)
    own = fins.get("deflection", 0.0)
    each = [values if isinstance(values, list) else [values] for values in (own, turn)]
    spread = [values * number if len(values) == 1 else values for values in each]
    if any(len(values) != number for values in spread):
        raise SweepError(f"{run.case}: '{name}' has {number} panels, and its control speaks of {len(each[1])}: one a panel, or one for all")
    return [a + b for a, b in zip(*spread)]


def meshed(run: Run) -> Path:
    """The case file of the kept mesh of a description, made now unless it is there. Raises SweepError."""
    description = deflected(run)
    inside = run.mesh_mach and run.mesh_mach[0] <= run.mach <= run.mesh_mach[1]
    return kept(description, description.stat().st_mtime_ns, run.mesh or "coarse", None if inside else run.mach, run.mesh_mach, run.model)


@lru_cache(maxsize=1024)
def kept(description: Path, time: int, level: str, mach: float | None, mesh_mach: tuple[float, float] | None, model: str = "") -> Path:
    """Asked once for all runs that share a mesh; `mach`: that of a run, where its mesh is not known to be for it; `model`: half or full,
    if not what the description's symmetry says."""
    words = [sys.executable, "-B", str(MESH), str(description), "--kept", "--level", level]
    if model:
        words += ["--model", model]
    if mach is not None:
        words += ["--at-mach", repr(mach)]
    if mesh_mach:
        words += ["--mach", ":".join(f"{end:g}" for end in mesh_mach)]
    done = subprocess.run(words, capture_output=True, text=True)
    if done.returncode != 0:
        said = [line for line in done.stderr.splitlines() if "error:" in line] or done.stderr.strip().splitlines() or ["no reason given"]
        raise SweepError(said[-1].removeprefix("alphadot mesh: error: "))
    return Path(done.stdout.strip())
