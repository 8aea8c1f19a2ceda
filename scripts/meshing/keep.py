"""Meshes that are made once: kept beside the description under a hash of all that they come from."""

from __future__ import annotations

import argparse
import os
import re
import shutil
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import gmsh

from meshing.limits import LEVELS
from meshing.sources import digest_of, files_of
from meshing.toml_file import DescriptionError

FOLDER = "meshes"


def keep(arguments: argparse.Namespace, make: Callable[[argparse.Namespace, Path], None]) -> None:
    """Prints the case file of a kept mesh, as the only line of the standard output; `make` makes what is missing into a folder.

    The level asked for and the one below it, for the uncertainty. Raises DescriptionError.
    """
    output = os.dup(1)
    os.dup2(2, 1)  # what else is told, also by libraries, goes where errors go
    path = arguments.description
    if arguments.mach is None and arguments.at_mach is not None and path.suffix.lower() != ".toml":
        arguments.mach = (arguments.at_mach, arguments.at_mach)  # nothing else says what the mesh is for
    names = list(LEVELS)
    finest = max(arguments.level, key=lambda name: LEVELS[name])
    arguments.level = names[max(names.index(finest) - 1, 0) : names.index(finest) + 1]
    folder = path.resolve().parent / FOLDER / f"{path.stem}-{_digest(arguments)}"
    case = folder / f"{path.stem}.toml"
    if not case.exists():
        folder.parent.mkdir(exist_ok=True)
        partial = Path(tempfile.mkdtemp(prefix=f".{folder.name}.", dir=folder.parent))
        try:
            make(arguments, partial)
            os.rename(partial / "case.toml", partial / case.name)
            if not folder.exists():
                os.rename(partial, folder)
        finally:
            shutil.rmtree(partial, ignore_errors=True)
    _check_mach(case, arguments)
    os.write(output, f"{case}\n".encode())
    os.close(output)


def _digest(arguments: argparse.Namespace) -> str:
    """Of the description, the surface that it names, what is asked for, and the programs that make the mesh."""
    path = arguments.description
    asked = (sorted(arguments.level), arguments.cells, arguments.mach, arguments.model, arguments.stages, path.suffix.lower())
    scripts = Path(__file__).resolve().parents[1]
    programs = [*sorted(scripts.glob("meshing/*.py")), *sorted(scripts.glob("exact/*.py"))]
    try:
        return digest_of([*files_of(path), *programs], (gmsh.__version__, asked))
    except OSError as error:
        raise DescriptionError([f"{error.filename}: {error.strerror}"]) from None


def _check_mach(case: Path, arguments: argparse.Namespace) -> None:
    """Is the mesh for the Mach number of the run?"""
    low, high = map(float, re.search(r"the mesh is for Mach ([0-9.e+-]+) to ([0-9.e+-]+) and", case.read_text()).groups())
    mach = arguments.at_mach
    if mach is not None and not low - 1e-6 <= mach <= high + 1e-6:
        raise DescriptionError([
            f"{arguments.description}: the mesh is for Mach {low:g} to {high:g}, not for freestream.mach = {mach:g}: widen mach under [flight]"
        ])  # fmt: skip
