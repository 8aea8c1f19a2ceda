#!/usr/bin/python3
"""Mesh of a thin delta wing with sharp leading edges and a blunt base, in a conical supersonic far field.

Lengths are in root chords; x aft from the apex, y starboard, z up. The wing is a flat pyramid: its section across the stream is
a rhombus that grows in proportion to x. gmsh meshes the quarter y, z >= 0; the half and full models are its exact mirror images.
"""

from __future__ import annotations

import argparse
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "scripts"))

try:
    import gmsh
    import numpy as np

    import meshing
except ImportError as error:
    sys.exit(f"mesh.py: {error}; install the Debian packages python3-gmsh and python3-numpy and run with /usr/bin/python3")

SWEEP, RIDGE_ANGLE = 65.0, 3.0  # degrees: of the leading edge, and between the ridge and the plane of the wing
SPAN = 1.0 / math.tan(math.radians(SWEEP))  # half span at the base
HEIGHT = math.tan(math.radians(RIDGE_ANGLE))  # half thickness at the base
LEVELS = {"tiny": 0.12, "coarse": 0.05}  # cell size on the wing at the base, in root chords
FLOOR = 0.08  # nearer to the apex than this, cells do not become smaller

# Far field: a frustum outside the bow shock for M >= 1.8 and |alpha| <= 3 deg, whose waves therefore never come back.
FAR_START, FAR_RADIUS, FAR_ANGLE, FAR_END = -0.08, 0.05, 42.0, 1.2
LAST_ANGLE = 37.0  # the last wave that still reaches the base comes in less steep than this


def build_quarter() -> None:
    """Make the fluid of the quarter y, z >= 0 the current gmsh model (OpenCASCADE)."""
    occ = gmsh.model.occ
    far_radius = FAR_RADIUS + (FAR_END - FAR_START) * math.tan(math.radians(FAR_ANGLE))
    frustum = occ.addCone(FAR_START, 0, 0, FAR_END - FAR_START, 0, 0, FAR_RADIUS, far_radius, angle=math.pi / 2)
    occ.rotate([(3, frustum)], 0, 0, 0, 1, 0, 0, -math.pi / 2)  # gmsh begins a cone about x at z > 0 > y
    corners = [occ.addPoint(*p) for p in ((0, 0, 0), (1, 0, 0), (1, SPAN, 0), (1, 0, HEIGHT))]
    line = {(i, j): occ.addLine(corners[i], corners[j]) for i in range(4) for j in range(i + 1, 4)}
    sides = [(0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3)]
    faces = [occ.addPlaneSurface([occ.addCurveLoop([line[i, j], line[j, k], -line[i, k]])]) for i, j, k in sides]
    wing = occ.addVolume([occ.addSurfaceLoop(faces)])
    occ.cut([(3, frustum)], [(3, wing)])
    occ.synchronize()


def size_field(h: float) -> meshing.SizeField:
    """The cell size wanted at a point, in root chords; proportional to h and to the distance from the apex."""
    last = math.tan(math.radians(LAST_ANGLE))

    def size(_dimension: int, _tag: int, x: float, y: float, z: float) -> float:
        apex = max(math.hypot(x, y, z), FLOOR)
        edge = math.hypot(y - SPAN * max(x, 0.0), z)
        away = edge if y > SPAN * x else max(z - HEIGHT * x, 0.0)
        # Smaller at the leading edge, and at the base, so that the fan there stays out of the last cells of the wing.
        factor = min(1.0, 0.35 + 2.5 * edge / apex, 0.5 + 4.0 * math.hypot(x - 1.0, away))
        late = max(x - 1.0 + away / last, 0.0)
        return h * min((apex + 2.0 * away) * factor + 6.0 * late, 4.0)

    return size


def patch_name(points: np.ndarray) -> str:
    """The patch of a CAD face, from all its mesh points (n, 3)."""
    x, y, z = points.T
    residuals = {"symmetry_y": y, "symmetry_z": z, "wing": y / SPAN + z / HEIGHT - x, "base": x - 1.0}
    return next((name for name, residual in residuals.items() if np.all(np.abs(residual) < 1e-7)), "farfield")


def build(h: float, arguments: argparse.Namespace) -> tuple[meshing.TetMesh, list[str]]:
    """The mesh, and lines that compare its patches with the exact wing."""
    gmsh.model.add("quarter")
    build_quarter()
    quarter = meshing.mesh_quarter(size_field(h), patch_name)
    mesh, symmetry = meshing.unfolded(quarter, arguments.model)
    share = meshing.MODELS[arguments.model]
    side = 0.5 * math.hypot(SPAN, HEIGHT, SPAN * HEIGHT)  # of the triangle with its corners at the apex, a tip and the ridge
    exact = {"wing": share * 4.0 * side, "base": share * 2.0 * SPAN * HEIGHT}
    return mesh, meshing.patch_report(mesh, exact) + symmetry


def main() -> None:
    parser = meshing.command_line(__doc__, LEVELS, "root chord")
    parser.add_argument("--model", choices=meshing.MODELS, default="half", help="half is y >= 0 (default)")
    meshing.run(parser, LEVELS, build)


if __name__ == "__main__":
    main()
