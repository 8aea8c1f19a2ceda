"""The program of a mesh generator: its command line, gmsh's part, check, report and file."""

from __future__ import annotations

import argparse
import os
import sys
import time
from collections.abc import Callable
from pathlib import Path

import gmsh
import numpy as np

from meshing.files import write
from meshing.quality import check
from meshing.tetrahedra import TetMesh


MESH_ADAPT, FRONTAL = 1, 6  # of gmsh's algorithms for surfaces; the second is the usual one

# What gmsh calls for the cell size wanted at a point: (dimension, tag, x, y, z) -> size.
SizeField = Callable[[int, int, float, float, float], float]
# A generator: (cell size h, command line) -> the mesh, and the case's own lines of the report.
Builder = Callable[[float, argparse.Namespace], tuple[TetMesh, list[str]]]


def generate(size: SizeField | None, dimension: int) -> tuple[np.ndarray, np.ndarray]:
    """Mesh the current gmsh model in 2 or 3 dimensions: its points (n, 3), and the row of each of gmsh's node tags.

    `size`: what gmsh calls for the cell size; None: the background field that is set decides.
    """
    options = {
        "General.NumThreads": 1, "Mesh.RandomSeed": 1,  # the same input gives the same mesh
        "Mesh.MeshSizeExtendFromBoundary": 0, "Mesh.MeshSizeFromPoints": 0, "Mesh.MeshSizeFromCurvature": 0,
        "Mesh.Algorithm": FRONTAL, "Mesh.Algorithm3D": 1, "Mesh.OptimizeThreshold": 0.6,
    }  # fmt: skip
    for name, value in options.items():
        gmsh.option.setNumber(name, value)
    if size is not None:
        gmsh.model.mesh.setSizeCallback(size)
    gmsh.model.mesh.generate(dimension)
    if size is not None:
        gmsh.model.mesh.removeSizeCallback()
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    row = np.zeros(int(tags.max()) + 1, dtype=np.int64)
    row[tags.astype(np.int64)] = np.arange(len(tags))
    return coordinates.reshape(-1, 3).copy(), row


def command_line(doc: str, levels: dict[str, float], unit: str) -> argparse.ArgumentParser:
    """The options that every generator has; `levels`: name -> cell size h in `unit`."""
    parser = argparse.ArgumentParser(description=doc.splitlines()[0], epilog=f"Lengths are in units of the {unit}.")
    sizes = parser.add_mutually_exclusive_group()
    known = ", ".join(f"{name} {size:g}" for name, size in levels.items())
    sizes.add_argument("--level", choices=levels, default="coarse", help=f"h = {known} (default: coarse)")
    sizes.add_argument("--size", type=float, metavar="S", help="cell size h instead of a level's")
    parser.add_argument("--format", choices=("4.1", "2.2", "su2"), default="4.1", help="Gmsh version (default: 4.1), or SU2")
    parser.add_argument("--ascii", action="store_true", help="Gmsh text instead of binary")
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="FILE", help="FILE.msh, or FILE.su2")
    return parser


def run(parser: argparse.ArgumentParser, levels: dict[str, float], build: Builder) -> None:
    """The program of a generator with the options of `command_line`: build, check, write and report."""
    arguments = parser.parse_args()
    h = levels[arguments.level] if arguments.size is None else arguments.size
    smallest, largest = 0.5 * min(levels.values()), 2.5 * max(levels.values())
    suffix = ".su2" if arguments.format == "su2" else ".msh"
    if not smallest <= h <= largest:
        parser.error(f"--size {h} is outside {smallest:g} to {largest:g}")
    if arguments.output.suffix != suffix:
        parser.error(f"the output '{arguments.output}' must end in {suffix}")
    if not os.access(arguments.output.resolve().parent, os.W_OK):
        parser.error(f"cannot write in the folder '{arguments.output.resolve().parent}'")
    start = time.perf_counter()
    gmsh.initialize(readConfigFiles=False)  # a user's settings would change the mesh
    gmsh.option.setNumber("General.Terminal", 0)
    try:
        mesh, own = build(h, arguments)
        lines = check(mesh) + own
        write(mesh, arguments.output, arguments.format, arguments.ascii)
    except Exception as error:  # gmsh raises bare Exception
        sys.exit(f"{parser.prog}: {error}")
    finally:
        gmsh.finalize()
    print(f"{arguments.output}: h = {h}, {time.perf_counter() - start:.1f} s")
    print("\n".join(lines))
