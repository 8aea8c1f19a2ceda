"""Rows of points along the meridians of straight pieces of the body, where no fin is near.

Triangles with an edge on a meridian are facets of a pyramid or a prism. Others are tilted up and down along the stream in turn: the
pressure on them scatters, and so do derivatives from mesh to mesh. Lengths in diameters of the body.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import gmsh
import numpy as np

from meshing.generator import MESH_ADAPT
from meshing.missile import Missile
from meshing.profiles import Body, Piece, Segment

CLEAR = 0.35  # diameters that a row keeps off fins
SHORTEST = 0.5  # diameters of a piece with rows
SLENDER = 0.2  # diameters: the least radius, where columns are too close together for the sizes along them
NARROWER = 0.5  # columns on the largest circumference, as a share of the size there
ON_BODY = 1e-6


def divided(missile: Missile) -> Missile:
    """The same, straight pieces of its body cut where they become clear of fins and of slender tips."""
    fins = [
        (float(panel.x + panel.planform.lead.min()) - CLEAR, float(panel.x + panel.planform.trail.max()) + CLEAR)
        for panel in missile.panels
    ]  # fmt: skip
    segments = (Segment(one.name, tuple(part for piece in one.pieces for part in _parts(piece, fins))) for one in missile.body.segments)
    return replace(missile, body=Body(tuple(segments)))


def _parts(piece: Piece, fins: list[tuple[float, float]]) -> list[Piece]:
    (x, r), (x_end, r_end) = piece.points[[0, -1]]
    if len(piece.points) > 2 or x_end - x < SHORTEST:
        return [piece]
    at = lambda station: r + (r_end - r) * (station - x) / (x_end - x)
    taken = list(fins)
    if min(r, r_end) < SLENDER < max(r, r_end):
        slim = x + (x_end - x) * (SLENDER - r) / (r_end - r)
        taken.append((x, slim) if r < r_end else (slim, x_end))
    cuts, reached = {x, x_end}, x
    for low, high in [*sorted(taken), (x_end, x_end)]:
        if min(low, x_end) - reached > SHORTEST:
            cuts |= {reached, min(low, x_end)}
        reached = max(reached, high)
    stations = sorted(cuts)
    return [Piece(np.array([[a, at(a)], [b, at(b)]])) for a, b in zip(stations, stations[1:])]


def align(missile: Missile, sizes: Callable[[np.ndarray], np.ndarray], h: float) -> None:
    """Has gmsh lay rows and columns of points, of about the sizes times h, on the faces of the current model that are straight pieces of the
    body between two circles."""
    rows: dict[tuple[float, float], tuple[int, float]] = {}  # number and growth, the same on all faces side by side
    largest = 0.5 * missile.body.diameter
    for _, face in gmsh.model.getEntities(2):
        curves = [curve for _, curve in gmsh.model.getBoundary([(2, face)], oriented=False)]
        ends = {curve: _ends(curve) for curve in curves}
        if len(curves) == 3 and set(map(_kind, curves)) <= {"Circle", "Line"}:  # tips of cones and fins, where others leave needles
            gmsh.model.mesh.setAlgorithm(2, face, MESH_ADAPT)
        if not _is_between_circles(missile.body, ends):
            continue
        for curve, end in ends.items():
            if _kind(curve) == "Circle":
                angle = gmsh.model.occ.getMass(1, curve) / math.hypot(*end[0, 1:])
                gmsh.model.mesh.setTransfiniteCurve(curve, max(round(angle * largest / (NARROWER * h)), 2) + 1)
            else:
                along = end[np.argsort(end[:, 0])]
                count, growth = rows.setdefault(tuple(along[:, 0].round(7)), _row(along, h * sizes(along)))
                backward = end[0, 0] > end[1, 0]
                gmsh.model.mesh.setTransfiniteCurve(curve, count + 1, "Progression", 1.0 / growth if backward else growth)
        gmsh.model.mesh.setTransfiniteSurface(face, "Alternate")


def _kind(curve: int) -> str:
    return gmsh.model.getType(1, curve)


def _ends(curve: int) -> np.ndarray:
    """The points (2, 3) from which a curve comes and to which it goes."""
    return np.array([gmsh.model.getValue(0, point, []) for _, point in gmsh.model.getBoundary([(1, curve)])]).reshape(-1, 3)


def _is_between_circles(body: Body, ends: dict[int, np.ndarray]) -> bool:
    """Are the curves with these ends two circles about the body and two lines along it, of the same length?"""
    if sorted(map(_kind, ends)) != ["Circle", "Circle", "Line", "Line"]:
        return False
    points = np.concatenate(list(ends.values()))
    x, r = np.clip(points[:, 0], 0.0, body.length), np.hypot(points[:, 1], points[:, 2])
    along = [np.sort(end[:, 0]) for curve, end in ends.items() if _kind(curve) == "Line"]
    same = np.allclose(along[0], along[1], atol=ON_BODY) and np.ptp(along[0]) > SHORTEST - ON_BODY
    return bool(same and np.all(np.abs(body.radius(x) - r) < ON_BODY))


def _row(ends: np.ndarray, sizes: np.ndarray) -> tuple[int, float]:
    """How many steps lead from one point to another, and their growth from each to the next, for sizes wanted at the two points."""
    first, last = sizes
    mean = (last - first) / math.log(last / first) if abs(last / first - 1.0) > 1e-6 else first
    count = max(round(float(np.linalg.norm(ends[1] - ends[0])) / mean), 2)
    return count, float((last / first) ** (1.0 / (count - 1)))
