"""Two-dimensional sections as thin slabs of tetrahedra between two symmetry planes.

The fluid above a symmetric section is triangulated by gmsh in the plane (x, z), extruded along y into prisms that are cut into
three tetrahedra each, and mirrored about z = 0 and about the middle of the slab. A section is the corners (x, z) of its upper
half, from the leading edge at the origin to x = 1; it has a blunt base when the last corner is above z = 0.
"""

from __future__ import annotations

import argparse
import math

import gmsh
import numpy as np

from meshing import toolbox as meshing

Section = list[tuple[float, float]]

LAYERS = 2  # of prisms across a slab as thin as h allows; even
LAYER_HEIGHT = 0.9  # in h; gives the best tetrahedra from prisms over triangles of side h

# Far field: the wedge z <= FAR_HEIGHT + tan(FAR_ANGLE) (x - FAR_START), outside the shocks of a 5-degree section for M >= 2 and
# |alpha| <= 3 deg, whose waves therefore never come back; the cells are fine up to BOW_ANGLE, which is outside them too.
FAR_START, FAR_HEIGHT, FAR_ANGLE, FAR_END = -0.1, 0.06, 42.0, 1.25
BOW_ANGLE = 37.5
# Nothing beyond the last wave that still reaches the trailing edge matters to the forces, and cells grow there; those waves come
# in less steep than this.
LAST_ANGLE = 34.0


def outline(section: Section) -> list[tuple[float, float, str]]:
    """The boundary of the fluid above the section, counter-clockwise: x, z and the patch of the side that starts there."""
    top = FAR_HEIGHT + (FAR_END - FAR_START) * math.tan(math.radians(FAR_ANGLE))
    end = section[-1]
    aft = [(*end, "base"), (end[0], 0.0, "plane")] if end[1] > 0.0 else [(*end, "plane")]
    return [(FAR_START, 0.0, "plane"), *((x, z, "body") for x, z in section[:-1]), *aft, (FAR_END, 0.0, "farfield"),
            (FAR_END, top, "farfield"), (FAR_START, FAR_HEIGHT, "farfield")]  # fmt: skip


def size_field(section: Section, h: float) -> meshing.SizeField:
    """The cell size wanted at a point of gmsh's plane (x, z), in chords: h over the section, proportional to h everywhere."""
    bow, last = math.tan(math.radians(BOW_ANGLE)), math.tan(math.radians(LAST_ANGLE))

    def size(_dimension: int, _tag: int, x: float, z: float, _y: float) -> float:
        # Half of h at the corners, where shocks and fans begin inside the first cells.
        corner = min(math.hypot(x - cx, z - cz) for cx, cz in section)
        early = max(z - bow * max(x + 0.02, 0.0), -x - 0.02, 0.0)
        late = max(x - 1.02 + max(z - section[-1][1], 0.0) / last, 0.0)
        return h * min(0.5 + 4.0 * corner, 1.0 + 8.0 * early + 4.0 * late, 4.0)

    return size


def triangulate(section: Section, h: float) -> tuple[np.ndarray, np.ndarray, dict[str, np.ndarray]]:
    """Points (n, 2), triangles (m, 3), and edges (k, 2) of each patch; `plane` is the boundary on z = 0."""
    gmsh.model.add("section")
    around = outline(section)
    corners = [gmsh.model.geo.addPoint(x, z, 0.0) for x, z, _ in around]
    sides = [gmsh.model.geo.addLine(a, b) for a, b in zip(corners, corners[1:] + corners[:1])]
    face = gmsh.model.geo.addPlaneSurface([gmsh.model.geo.addCurveLoop(sides)])
    gmsh.model.geo.synchronize()
    points, row = meshing.generate(size_field(section, h), 2)
    parts: dict[str, list[np.ndarray]] = {}
    for side, (_, _, name) in zip(sides, around):
        parts.setdefault(name, []).append(row[gmsh.model.mesh.getElementsByType(1, side)[1].astype(np.int64)].reshape(-1, 2))
    triangles = row[gmsh.model.mesh.getElementsByType(2, face)[1].astype(np.int64)].reshape(-1, 3)
    gmsh.model.remove()
    edges = {name: np.concatenate(part) for name, part in parts.items()}
    points[edges["plane"], 1] = 0.0
    return points[:, :2], triangles, edges


def extrude(flat: np.ndarray, triangles: np.ndarray, edges: dict[str, np.ndarray], heights: np.ndarray) -> meshing.TetMesh:
    """Prisms over a triangulation of the plane (x, z), between the given heights y, cut into tetrahedra.

    The patches of the edges keep their names; `symmetry` is at the first height and `middle` at the last. In a prism with lower
    points a < b < c and upper points A, B, C the tetrahedra are abcC, abBC and aABC: every rectangle is then cut from the lower
    smaller to the upper larger number, whichever side one looks from. Points on walls have the smallest numbers, so that a wall
    stands on ab and the tetrahedron on the symmetry plane, abcC, has no face on it.
    """
    n = len(flat)
    free = np.ones(n, dtype=bool)
    for name in edges.keys() & {"body", "base"}:
        free[edges[name]] = False
    order = np.argsort(free, kind="stable")
    number = np.argsort(order)
    ordered = flat[order]
    points = np.concatenate([np.column_stack([ordered[:, 0], np.full(n, y), ordered[:, 1]]) for y in heights])

    lower = n * np.arange(len(heights) - 1)[:, None, None]
    a, b, c = np.moveaxis(np.sort(number[triangles], axis=1) + lower, 2, 0)
    tets = np.stack([a, b, c, c + n, a, b, b + n, c + n, a, a + n, b + n, c + n], axis=-1).reshape(-1, 4)
    patches = {"symmetry": number[triangles], "middle": number[triangles] + n * (len(heights) - 1)}
    for name, pairs in edges.items():
        a, b = np.moveaxis(np.sort(number[pairs], axis=1) + lower, 2, 0)
        patches[name] = np.stack([a, b, b + n, a, b + n, a + n], axis=-1).reshape(-1, 3)
    return meshing.oriented(meshing.TetMesh(points, tets, patches))


def command_line(doc: str, levels: dict[str, float]) -> argparse.ArgumentParser:
    """The options of the generators of sections."""
    parser = meshing.command_line(doc, levels, "chord")
    parser.add_argument(
        "--width", type=float, metavar="W", help=f"of the slab, {LAYERS * LAYER_HEIGHT:g} h by default; one for meshes to compare"
    )
    return parser


def mesh_slab(section: Section, h: float, width: float | None = None) -> tuple[meshing.TetMesh, list[str]]:
    """The whole section between the symmetry planes y = 0 and y = width, and lines for the report.

    As many layers as come nearest to the best tetrahedra.
    """
    width = width or LAYERS * LAYER_HEIGHT * h
    layers = 2 * max(round(0.5 * width / (LAYER_HEIGHT * h)), 1)
    heights = np.linspace(-0.5 * width, 0.0, layers // 2 + 1)
    mesh = extrude(*triangulate(section, h), heights)
    mesh = meshing.mirrored(meshing.mirrored(mesh, 1, "middle"), 2, "plane")
    if not (meshing.is_symmetric(mesh, 1) and meshing.is_symmetric(mesh, 2)):
        raise meshing.MeshError("the slab is not its own mirror image")
    mesh.points[:, 1] += 0.5 * width
    order = ["body", "base", "symmetry", "farfield"]
    mesh = meshing.TetMesh(mesh.points, mesh.tets, {name: mesh.patches[name] for name in order if name in mesh.patches})

    length = sum(math.dist(p, q) for p, q in zip(section, section[1:]))
    lines = [f"slab from y = 0 to {width:.6g} c: reference area (chord x width) {width:.6g} c^2"]
    lines += meshing.patch_report(mesh, {"body": 2.0 * length * width, "base": 2.0 * section[-1][1] * width})
    return mesh, lines + ["mirror image about z = 0 and about the middle: identical bit for bit"]
