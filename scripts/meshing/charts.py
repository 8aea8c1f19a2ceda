"""Divides a triangulated surface into patches that gmsh can give parameters to: along sharp edges and at planes, which cut triangles."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from meshing.shape import regions, turns
from meshing.soundness import edges_of
from meshing.surface import Surface

ON_PLANE = 1e-4  # diameters: nearer points lie on the plane
HIGH = 0.012  # diameters of a turn over its chord, from which on it is an edge however small its angle
SAME = 2.0  # degrees between planes that are one
MOST_PLANES = 8


def half_of(surface: Surface) -> Surface:
    """The part at y >= 0 of a surface that is symmetric about y = 0, cut there; points near the plane are moved onto it."""
    off = surface.points[:, 1].copy()
    off[np.abs(off) < ON_PLANE] = 0.0
    points = surface.points.copy()
    points[:, 1] = off
    both, off = divided(replace(surface, points=points), off)
    both.points[off == 0.0, 1] = 0.0
    side = off[both.triangles]
    kept = (side.min(axis=1) >= 0.0) & (side.max(axis=1) > 0.0)
    used, triangles = np.unique(both.triangles[kept], return_inverse=True)
    return replace(both, points=both.points[used], triangles=triangles.reshape(-1, 3), component=both.component[kept])


def divided(surface: Surface, off: np.ndarray) -> tuple[Surface, np.ndarray]:
    """The surface with its triangles cut where `off` (n,), the points' distances from a plane, changes sign; the distances of all points
    that it then has, 0 of the new ones."""
    triangles, points = surface.triangles, surface.points
    side = np.sign(off).astype(int)
    of = side[triangles]
    cut = (of.min(axis=1) < 0) & (of.max(axis=1) > 0)
    edges, of_side, _ = edges_of(triangles)
    crossing = side[edges[:, 0]] * side[edges[:, 1]] < 0
    a, b = edges[crossing].T
    share = (off[a] / (off[a] - off[b]))[:, None]
    number = np.full(len(edges), -1)
    number[crossing] = len(points) + np.arange(len(a))
    of_side = of_side.reshape(-1, 3)
    new, owner = [], []
    for row in np.flatnonzero(cut):
        ring = []
        for i in range(3):
            ring.append((int(triangles[row, i]), of[row, i]))
            if number[of_side[row, i]] >= 0:
                ring.append((int(number[of_side[row, i]]), 0))
        for sign in (-1, 1):
            polygon = [point for point, where in ring if where * sign >= 0]
            for second, third in zip(polygon[1:], polygon[2:]):
                new.append((polygon[0], second, third))
                owner.append(surface.component[row])
    made = replace(
        surface, points=np.concatenate([points, points[a] + share * (points[b] - points[a])]),
        triangles=np.concatenate([triangles[~cut], np.array(new, dtype=np.int64).reshape(-1, 3)]),
        component=np.concatenate([surface.component[~cut], np.array(owner, dtype=np.int64)]),
    )  # fmt: skip
    return made, np.concatenate([off, np.zeros(len(a))])


def charted(surface: Surface, sharp: float, askew: float) -> tuple[Surface, np.ndarray]:
    """The surface, cut by some planes through the x axis, and the patch (m,) of each triangle.

    Planes go through the points at which a patch would touch itself, such as the trailing ends of fins on the rim of a base; where there
    are none, one at `askew` degrees from y towards z.
    """
    angles: list[float] = []
    for point in surface.points[_pinched(surface, regions(surface, sharp, HIGH))]:
        angle = float(np.degrees(np.arctan2(point[2], point[1]))) % 180.0
        if all(abs((angle - other + 90.0) % 180.0 - 90.0) > SAME for other in angles):
            angles.append(angle)
    sides = []
    for angle in angles[:MOST_PLANES] or [askew]:
        normal = np.array([0.0, -np.sin(np.radians(angle)), np.cos(np.radians(angle))])
        off = surface.points @ normal
        off[np.abs(off) < ON_PLANE] = 0.0
        surface, _ = divided(surface, off)
        sides.append(normal)
    middle = surface.corners.mean(axis=1)
    return surface, regions(surface, sharp, HIGH, np.sign(middle @ np.array(sides).T))


def _pinched(surface: Surface, region: np.ndarray) -> np.ndarray:
    """Points around which a region comes more than once."""
    edges, pairs, _ = turns(surface)
    between = region[pairs[:, 0]] != region[pairs[:, 1]]
    count = np.bincount(edges[between].ravel(), minlength=len(surface.points))
    around = np.unique(np.column_stack([surface.triangles.ravel(), np.repeat(region, 3)]), axis=0)
    distinct = np.bincount(around[:, 0], minlength=len(surface.points))
    return np.flatnonzero((count >= 2) & (distinct < count))
