#!/usr/bin/python3
"""Mesh of a sharp circular cone with a blunt base, in a conical supersonic far field.

Lengths are in cone lengths; x aft from the apex, y starboard, z up. gmsh meshes the quarter y, z >= 0; the half and full models
are its exact mirror images. The flow is conical, and so is the mesh: cells grow in proportion to the distance from the apex.
"""

from __future__ import annotations

import argparse
import functools
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "scripts"))

try:
    import gmsh
    import numpy as np

    from meshing import toolbox as meshing
    from exact import NoExactFlow, cone
except ImportError as error:
    sys.exit(f"mesh.py: {error}; install the Debian packages python3-gmsh and python3-numpy and run with /usr/bin/python3")

# Cell size h on the surface, relative to the distance from the apex. The half model has about 10, 50, 100, 250 and 700 thousand
# tetrahedra.
LEVELS = {"tiny": 0.0705, "small": 0.036, "coarse": 0.029, "medium": 0.0206, "fine": 0.0147}
GROWTH = 4.0  # of the cell size with the distance from the surface, in h
TIP = 0.06  # nearer to the apex than this, cells do not become smaller

# Far field: a frustum outside the bow shock for |alpha| <= 3 deg, whose waves therefore never come back.
FAR_START, FAR_RADIUS, FAR_END = -0.05, 0.03, 1.12
MARGIN = 6.0  # degrees between the shock at zero incidence and the far field


def shock_angle(half_angle: float, mach: float) -> float:
    """Exact, at zero incidence; degrees."""
    if not 2.0 <= half_angle <= 30.0:
        raise meshing.MeshError(f"--half-angle {half_angle} is outside 2 to 30")
    try:
        return cone.steady(half_angle, mach).shock_angle
    except NoExactFlow as error:
        raise meshing.MeshError(str(error)) from None


def build_quarter(slope: float, far_angle: float, h: float) -> None:
    """Make the fluid of the quarter y, z >= 0 the current gmsh model (OpenCASCADE); `slope` of the cone, the angle in degrees."""
    occ = gmsh.model.occ
    far_radius = FAR_RADIUS + (FAR_END - FAR_START) * math.tan(math.radians(far_angle))
    profile = [(0.0, 0.0), (TIP, TIP * slope), (1.0, slope), (1.0, 0.0), (FAR_END, 0.0), (FAR_END, far_radius),
               (FAR_START, FAR_RADIUS), (FAR_START, 0.0)]  # fmt: skip
    points = [occ.addPoint(x, r, 0.0) for x, r in profile]
    lines = [occ.addLine(a, b) for a, b in zip(points, points[1:] + points[:1])]
    face = occ.addPlaneSurface([occ.addCurveLoop(lines)])
    _, tip, body, *_ = (tag for dimension, tag in occ.revolve([(2, face)], 0, 0, 0, 1, 0, 0, math.pi / 2) if dimension == 2)
    occ.synchronize()
    gmsh.model.mesh.setAlgorithm(2, tip, 1)  # MeshAdapt: the others leave needles at the apex
    align(body, slope, h)


def align(body: int, slope: float, h: float) -> None:
    """Make gmsh lay a structured mesh, with rows of points along the generators, on the face of the cone behind the tip.

    Triangles with an edge on a generator are facets of a pyramid, which is conical too. Others are tilted up and down along the
    stream in turn, and the pressure on them scatters.
    """
    rows, columns = math.ceil(-math.log(TIP) / h), math.ceil(0.5 * math.pi * slope / h)
    for _, curve in gmsh.model.getBoundary([(2, body)], oriented=False):
        if gmsh.model.getType(1, curve) == "Line":
            (_, first), (_, last) = gmsh.model.getBoundary([(1, curve)])
            backward = gmsh.model.getValue(0, first, [])[0] > gmsh.model.getValue(0, last, [])[0]
            gmsh.model.mesh.setTransfiniteCurve(curve, rows + 1, "Progression", TIP ** ((1.0 if backward else -1.0) / rows))
        else:
            gmsh.model.mesh.setTransfiniteCurve(curve, columns + 1)
    gmsh.model.mesh.setTransfiniteSurface(body, "Alternate")


def size_field(slope: float, h: float, shock: float) -> meshing.SizeField:
    """The cell size wanted at a point, in cone lengths; proportional to h. `shock`: its angle in degrees."""
    last = math.tan(math.radians(shock))

    def size(_dimension: int, _tag: int, x: float, y: float, z: float) -> float:
        r = math.hypot(y, z)
        across = r - slope * x if x > 0.0 else r
        # The last wave that still reaches the base comes in less steep than the shock: nothing matters beyond.
        late = max(x - 1.0 + max(r - slope, 0.0) / last, 0.0)
        return h * min(max(math.hypot(x, r), TIP) + GROWTH * max(across, 0.0) + 12.0 * late, 6.0)

    return size


def patch_name(slope: float, points: np.ndarray) -> str:
    """The patch of a CAD face, from all its mesh points (n, 3)."""
    x, y, z = points.T
    residuals = {"symmetry_y": y, "symmetry_z": z, "body": np.hypot(y, z) - slope * x, "base": x - 1.0}
    return next((name for name, residual in residuals.items() if np.all(np.abs(residual) < 1e-7)), "farfield")


def compensate_chords(mesh: meshing.TetMesh) -> None:
    """Move the points of the body outward until its flat triangles enclose, to leading order, the volume of the true cone.

    Over a triangle whose corners are u apart along the circumference, the chords run sum(u^2) / (24 r) inside the circle of
    radius r in the mean. Left alone, the triangles make a slimmer cone, and a steeper one wherever they become smaller.
    """
    radius = np.hypot(mesh.points[:, 1], mesh.points[:, 2])
    circle = mesh.points[:, 1:] / np.where(radius > 0.0, radius, 1.0)[:, None]
    body = mesh.patches["body"]
    edges = circle[body] - circle[np.roll(body, 1, axis=1)]
    at_apex = radius[body] == 0.0
    edges[at_apex | np.roll(at_apex, 1, axis=1)] = 0.0  # along a generator
    area = np.linalg.norm(meshing.area_vectors(mesh.points, body), axis=1)
    inside = area * (edges**2).sum(axis=(1, 2)) / 24.0
    gather = lambda values: np.bincount(body.ravel(), np.repeat(values, 3), len(radius))
    mesh.points[:, 1:] *= 1.0 + (gather(inside) / np.maximum(gather(area), 1e-300))[:, None]


def build(h: float, arguments: argparse.Namespace) -> tuple[meshing.TetMesh, list[str]]:
    """The mesh, and lines that compare its patches with the exact cone."""
    shock = shock_angle(arguments.half_angle, arguments.mach)
    slope = math.tan(math.radians(arguments.half_angle))  # also the radius of the base
    gmsh.model.add("quarter")
    build_quarter(slope, shock + MARGIN, h)
    quarter = meshing.mesh_quarter(size_field(slope, h, shock), functools.partial(patch_name, slope))
    compensate_chords(quarter)
    mesh, symmetry = meshing.unfolded(quarter, arguments.model)
    share = meshing.MODELS[arguments.model]
    exact = {"body": share * math.pi * slope * math.hypot(1.0, slope), "base": share * math.pi * slope**2}
    return mesh, meshing.patch_report(mesh, exact) + symmetry


def main() -> None:
    parser = meshing.command_line(__doc__, LEVELS, "cone length")
    parser.add_argument("--model", choices=meshing.MODELS, default="half", help="half is y >= 0 (default)")
    parser.add_argument("--half-angle", type=float, default=10.0, metavar="DEG", help="of the cone, 2 to 30; 10 by default")
    parser.add_argument("--mach", type=float, default=1.58, help="the lowest Mach number for this mesh; 1.58 by default")
    meshing.run(parser, LEVELS, build)


if __name__ == "__main__":
    main()
