#!/usr/bin/python3
"""Mesh of a sharp symmetric wedge with a blunt base, as a thin slab in a supersonic far field.

Lengths are in chords; x aft from the apex, y along the span, z up.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "scripts"))

try:
    from meshing import toolbox as meshing
    import slab
except ImportError as error:
    sys.exit(f"mesh.py: {error}; install the Debian packages python3-gmsh and python3-numpy and run with /usr/bin/python3")

HALF_ANGLE = 5.0  # degrees
LEVELS = {"tiny": 1 / 20, "small": 1 / 40, "coarse": 1 / 80, "medium": 1 / 160}  # cell size over the section, in chords


def main() -> None:
    section = [(0.0, 0.0), (1.0, math.tan(math.radians(HALF_ANGLE)))]
    meshing.run(slab.command_line(__doc__, LEVELS), LEVELS, lambda h, arguments: slab.mesh_slab(section, h, arguments.width))


if __name__ == "__main__":
    main()
