#!/usr/bin/python3
"""Mesh of a diamond (double-wedge) section, as a thin slab in a supersonic far field.

Lengths are in chords; x aft from the leading edge, y along the span, z up.
"""

from __future__ import annotations

import argparse
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parents[1] / "scripts"), str(HERE.parent / "wedge")]

try:
    from meshing import toolbox as meshing
    import slab
except ImportError as error:
    sys.exit(f"mesh.py: {error}; install the Debian packages python3-gmsh and python3-numpy and run with /usr/bin/python3")

LEVELS = {"tiny": 1 / 20, "small": 1 / 40, "coarse": 1 / 80, "medium": 1 / 160}  # cell size over the section, in chords


def build(h: float, arguments: argparse.Namespace) -> tuple[meshing.TetMesh, list[str]]:
    """The mesh and the lines of its report."""
    if not 0.1 <= arguments.half_angle <= 5.0:
        raise meshing.MeshError(f"--half-angle {arguments.half_angle} is outside 0.1 to 5")
    height = 0.5 * math.tan(math.radians(arguments.half_angle))
    return slab.mesh_slab([(0.0, 0.0), (0.5, height), (1.0, 0.0)], h, arguments.width)


def main() -> None:
    parser = slab.command_line(__doc__, LEVELS)
    parser.add_argument("--half-angle", type=float, default=5.0, metavar="DEG", help="at both ends, 0.1 to 5 (default)")

    meshing.run(parser, LEVELS, build)


if __name__ == "__main__":
    main()
