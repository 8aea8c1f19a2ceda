"""What `alphadot mesh` does: reads a description, makes the meshes, writes them with case file, report and picture."""

from __future__ import annotations

import argparse
import math
import os
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

import gmsh

from meshing.case_file import case_text
from meshing.description import describe_keys, read_description
from meshing.files import write
from meshing.keep import keep
from meshing.limits import LEVELS
from meshing.mesher import Made, make_mesh
from meshing.missile import Flight, Missile, Reference
from meshing.openrocket import read_openrocket
from meshing.rasaero import read_rasaero
from meshing.shape import Shape
from meshing.shape_file import SUFFIXES, read_shape
from meshing.tetrahedra import MeshError
from meshing.toml_file import DescriptionError

FORMATS = {".msh": "4.1", ".su2": "su2"}  # of a mesh alone


def main(arguments: argparse.Namespace) -> int:
    """The exit code; see mesh.py."""
    if arguments.keys:
        print(describe_keys(), end="")
        return 0
    try:
        if arguments.kept:
            keep(arguments, lambda asked, folder: write_all(read_for(asked), asked, folder))
        else:
            subject, output = read_for(arguments), arguments.output or Path(arguments.description.stem)
            (write_mesh if output.suffix in FORMATS else write_all)(subject, arguments, output)
    except (MeshError, OSError) as error:
        for line in str(error).splitlines():
            print(f"alphadot mesh: error: {line}", file=sys.stderr)
        return 1
    return 0


def read_for(arguments: argparse.Namespace) -> Missile | Shape:
    """The description with the Mach numbers that are asked for."""
    missile = read_missile(arguments.description, arguments.stages)
    return replace(missile, flight=Flight(arguments.mach, missile.flight.alpha)) if arguments.mach else missile


def read_missile(path: Path, stages: list[int] | None) -> Missile | Shape:
    """A description in any format, told by the end of its name. Raises DescriptionError."""
    suffix = path.suffix.lower()
    if suffix == ".ork":
        return read_openrocket(path, stages)
    if stages:
        raise DescriptionError([f"{path}: only designs of OpenRocket (.ork) have stages to choose; leave --stages out"])
    if suffix == ".toml":
        return read_description(path)
    if suffix == ".cdx1":
        return read_rasaero(path)
    if suffix in SUFFIXES:
        return bare_shape(path)
    raise DescriptionError([
        f"{path}: what is '{path.suffix}'? Descriptions are .toml, .ork of OpenRocket, .CDX1 of RASAero II, or a surface in one of "
        + ", ".join(SUFFIXES)
    ])  # fmt: skip


def bare_shape(path: Path) -> Shape:
    """A file with a surface and nothing beside it: everything else by default."""
    shape = read_shape(path)
    diameter, middle = shape.diameter, float(shape.surface.points[:, 0].min()) + 0.5 * shape.length
    reference = Reference(diameter, 0.25 * math.pi * diameter**2, (middle, 0.0, 0.0))
    note = f"reference: the circle of the largest cross section; moments about half of the length, x = {middle:.4g}: a [surface] in a .toml can say more"
    return replace(shape, reference=reference, notes=(*shape.notes, note))


def write_mesh(missile: Missile | Shape, arguments: argparse.Namespace, file: Path) -> None:
    """The mesh alone, in the format that the end of the file's name says."""
    with quiet_gmsh():
        made = made_or_refused(missile, arguments, wanted_meshes(missile, arguments)[0])
        write(made.mesh, file, FORMATS[file.suffix])
    print("\n".join([f"{file}: {missile.title}, {made.model} model", *("  " + line for line in made.report)]))


@contextmanager
def quiet_gmsh() -> Iterator[None]:
    gmsh.initialize(readConfigFiles=False)  # a user's settings would change the mesh
    gmsh.option.setNumber("General.Terminal", 0)
    try:
        yield
    finally:
        gmsh.finalize()


def write_all(missile: Missile | Shape, arguments: argparse.Namespace, folder: Path) -> None:
    """Makes and writes everything; each file appears under its name when it is complete."""
    folder.mkdir(parents=True, exist_ok=True)
    wanted = wanted_meshes(missile, arguments)
    lines = [missile.title, *missile.notes]
    first: Made | None = None
    with quiet_gmsh():
        for mesh in wanted:
            start = time.process_time()
            made = made_or_refused(missile, arguments, mesh)
            first = first or made
            write(made.mesh, folder / f"{mesh.name}.msh")
            lines += ["", f"{mesh.name}.msh: {made.model} model, {time.process_time() - start:.1f} s of processor"]
            lines += ["  " + line for line in made.report]
    files = [f"{mesh.name}.msh" for mesh in wanted]
    coarser = files[1:] if len(files) <= 3 else []  # more than a case takes
    put(folder / "case.toml", case_text(missile, first, files[0], coarser, arguments.description.name))
    put(folder / "report.txt", "\n".join(lines) + "\n")
    print("\n".join(lines))
    if not arguments.no_picture:
        from meshing.picture import draw  # matplotlib takes a while to come

        draw(missile, first, folder / "picture.part.png")
        os.replace(folder / "picture.part.png", folder / "picture.png")
    if arguments.kept:
        return
    print(f"\nwritten to {folder}: {', '.join(files)}, case.toml, report.txt" + ("" if arguments.no_picture else ", picture.png"))
    print(f"next: alphadot derivatives {folder / 'case.toml'} --set freestream.mach={missile.flight.mach[1]:g}")


@dataclass(frozen=True)
class Wanted:
    """A mesh by its name: about so many cells, or one of a family whose sizes are `factor` times those of a mesh of so many."""

    name: str
    cells: int
    factor: float | None = None


def wanted_meshes(missile: Missile | Shape, arguments: argparse.Namespace) -> list[Wanted]:
    """The finest first; levels have twice as many cells in a full model."""
    full = arguments.model == "full" or (arguments.model is None and not missile.is_symmetric(1))
    levels = [Wanted(name, LEVELS[name] * (2 if full else 1)) for name in set(arguments.level)]
    levels.sort(key=lambda level: -level.cells)
    if arguments.factors:
        cells = arguments.cells or levels[0].cells
        return [Wanted(f"mesh_{factor:g}", cells, factor) for factor in sorted(set(arguments.factors))]
    return [Wanted("mesh", arguments.cells)] if arguments.cells else levels


def made_or_refused(missile: Missile | Shape, arguments: argparse.Namespace, mesh: Wanted) -> Made:
    """The mesh, or a MeshError; gmsh raises bare exceptions."""
    try:
        return make_mesh(missile, arguments.model, mesh.cells, arguments.sizes or [], mesh.factor)
    except MeshError:
        raise
    except Exception as error:
        raise MeshError(f"gmsh could not mesh '{missile.title}': {error}; does a fin touch another, or a sharp corner of the body?") from error


def put(path: Path, text: str) -> None:
    """A text file that appears when it is complete."""
    partial = path.with_name(path.name + ".part")
    partial.write_text(text)
    os.replace(partial, path)
