"""A body given by its surface, from a triangulation or from CAD: regions between sharp edges, bases, symmetry, envelope, scale."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from meshing.missile import Flight, Missile, Reference
from meshing.profiles import Body, through
from meshing.soundness import edges_of
from meshing.surface import Surface, finely

AFT = 0.98  # of the normal, along x: a region that faces so much backwards is a base
MIRRORED = 2e-4  # diameters between a triangulation and its mirror image that are none
ROUGHLY = 0.02  # the same of a first look at CAD, whose faces have been asked themselves
SLENDER = 0.6  # of the circle of the largest cross section: how wide a circle inside of it must be to count as a body's


@dataclass(frozen=True)
class Shape:
    """A body that has been read and checked. Lengths in `unit`, x aft, y to starboard, z up; normals of `surface` outwards.

    `cad`: the file that its faces come from, and `to_axes` (3, 4), which takes the file's coordinates to these; None: the surface itself
    is meshed anew.
    """

    title: str
    unit: str
    surface: Surface
    flight: Flight
    reference: Reference
    notes: tuple[str, ...] = field(default=())
    cad: Path | None = None
    to_axes: np.ndarray = field(default_factory=lambda: np.eye(3, 4))
    sharp: float = 30.0  # degrees: where neighbouring triangles turn by more, there is an edge
    may_be_symmetric: tuple[bool, bool] = (True, True)  # about y = 0 and z = 0, by what CAD says of its faces

    panels = ()  # as of a missile: it has no fins that it knows of

    @property
    def length(self) -> float:
        return float(np.ptp(self.surface.points[:, 0]))

    @functools.cached_property
    def diameter(self) -> float:
        """That of the body without its fins: of the largest circle inside of a cross section; of flat bodies, of a circle as large as
        the largest one."""
        _, areas, inner = cross_sections(self.surface, 60)
        whole = 2.0 * math.sqrt(areas.max() / math.pi)
        return 2.0 * float(inner.max()) if 2.0 * inner.max() > SLENDER * whole else whole

    @property
    def tip(self) -> np.ndarray:
        """The foremost point."""
        return self.surface.points[np.argmin(self.surface.points[:, 0])]

    def is_symmetric(self, axis: int) -> bool:
        """Is it its own mirror image about y = 0 (axis 1) or z = 0 (axis 2)?"""
        return self._symmetric[axis]

    @functools.cached_property
    def _symmetric(self) -> dict[int, bool]:
        return {axis: self.may_be_symmetric[axis - 1] and self._is_mirrored(axis) for axis in (1, 2)}

    def _is_mirrored(self, axis: int) -> bool:
        """Within what the triangles, chords of curved faces, are off these; flat faces must be mirror images."""
        points, triangles = self.surface.points, self.surface.triangles
        _, sides, angle = turns(self.surface)
        smooth = np.abs(angle) < 2.0 * self.sharp  # around a pointed tip triangles turn by much
        area = np.linalg.norm(self.surface.area_vectors, axis=1)
        long = np.linalg.norm(self.surface.corners - np.roll(self.surface.corners, -1, axis=1), axis=2).max(axis=1)
        # The height of an arc over its chord is an eighth of the chord times the turn.
        chord = np.zeros(len(triangles))
        np.maximum.at(chord, sides[smooth].ravel(), np.repeat(np.radians(np.abs(angle[smooth])), 2) / 8.0)
        chord *= 2.0 * area / np.maximum(long, 1e-300)
        allowed = np.zeros(len(points))
        np.maximum.at(allowed, triangles.ravel(), np.repeat(4.0 * chord, 3))
        some = np.linspace(0, len(points) - 1, min(len(points), 300)).astype(int)
        image = points[some].copy()
        image[:, axis] *= -1.0
        least = (MIRRORED if self.cad is None else ROUGHLY) * self.diameter
        return bool(np.all(distances(image, self.surface) < np.maximum(allowed[some], least)))

    def in_diameters(self) -> tuple[Shape, np.ndarray]:
        """The same from x = 0 and with the diameter as the unit, about an axis through the tip; and where its origin was."""
        origin = self.tip.copy()
        for axis in (1, 2):
            if self.is_symmetric(axis):
                origin[axis] = 0.0
        factor = 1.0 / self.diameter
        surface = replace(self.surface, points=(self.surface.points - origin) * factor)
        moved = self.to_axes.copy()
        moved[:, 3] -= origin
        return replace(self, surface=surface, to_axes=moved * factor), origin

    def envelope(self, stations: int = 120) -> Missile:
        """The body of revolution around it, from x = 0: the largest radius at each x."""
        points = finely(self.surface, 0.02 * self.length)[0]
        x, r = points[:, 0], np.hypot(points[:, 1], points[:, 2])
        # Closer together at the tip, whose angle counts.
        at = self.length * np.linspace(0.0, 1.0, stations) ** 1.5
        place = np.clip(np.searchsorted(at, x), 1, stations - 1)
        largest = np.zeros(stations)
        np.maximum.at(largest, place, r)
        np.maximum.at(largest, place - 1, np.where(place > 1, r, 0.0))
        largest[0] = r[x < 1e-6 * self.length].max(initial=0.0)
        known = largest > 0.0
        known[0] = True
        radius = np.interp(at, at[known], largest[known])
        radius[1:] = np.maximum(radius[1:], 1e-4)
        body = Body((through("body", 0.0, np.column_stack([at, radius]), smooth=False),))
        return Missile(self.title, self.unit, body, (), self.flight, self.reference)


def cross_sections(surface: Surface, stations: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """x of some stations, the area that the surface encloses there, and the radius of a circle inside around its centre."""
    p = surface.corners
    low, high = p[:, :, 0].min(axis=1), p[:, :, 0].max(axis=1)
    x = low.min() + (high.max() - low.min()) * (np.arange(stations) + 0.5) / stations
    areas, inner = np.zeros(stations), np.zeros(stations)
    for i, at in enumerate(x):
        cut = p[(low < at) & (high > at)]
        above = cut[:, :, 0] > at
        # The corner that is alone on its side comes first; the cut runs between its two edges.
        alone = np.where(above.sum(axis=1) == 1, np.argmax(above, axis=1), np.argmin(above, axis=1))
        rows = np.arange(len(cut))
        turned = cut[rows[:, None], (alone[:, None] + np.arange(3)) % 3]
        first, second, third = turned[:, 0], turned[:, 1], turned[:, 2]
        ends = []
        for other in (second, third):
            share = ((at - first[:, 0]) / (other[:, 0] - first[:, 0]))[:, None]
            ends.append((first + share * (other - first))[:, 1:])
        a, b = ends
        parts = 0.5 * np.where(above[rows, alone], 1.0, -1.0) * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
        areas[i] = abs(parts.sum())
        if areas[i] > 0.0:
            centre = (parts[:, None] * (a + b)).sum(axis=0) / (3.0 * parts.sum())
            along, off = b - a, centre - a
            share = np.clip((off * along).sum(axis=1) / np.maximum((along**2).sum(axis=1), 1e-300), 0.0, 1.0)[:, None]
            inner[i] = np.linalg.norm(off - share * along, axis=1).min()
    return x, areas, inner


def distances(points: np.ndarray, surface: Surface) -> np.ndarray:
    """From points (n, 3) to the nearest point of the surface."""
    corners = surface.corners
    middle = corners.mean(axis=1)
    reach = np.linalg.norm(corners - middle[:, None], axis=2).max(axis=1)
    nearest = np.empty(len(points))
    for i, p in enumerate(points):
        away = np.linalg.norm(middle - p, axis=1)
        near = away - reach <= away.min()
        nearest[i] = math.sqrt(_squared_distance(p, *np.moveaxis(corners[near], 1, 0)).min())
    return nearest


def _squared_distance(p: np.ndarray, a: np.ndarray, b: np.ndarray, c: np.ndarray) -> np.ndarray:
    """From a point to each of some triangles."""
    normal = np.cross(b - a, c - a)
    square = np.maximum(np.einsum("ij,ij->i", normal, normal), 1e-300)
    height = np.einsum("ij,ij->i", p - a, normal)
    inside = np.ones(len(a), dtype=bool)
    least = np.full(len(a), np.inf)
    for start, end in ((a, b), (b, c), (c, a)):
        along, off = end - start, p - start
        inside &= np.einsum("ij,ij->i", np.cross(along, off), normal) >= 0.0
        share = np.clip(np.einsum("ij,ij->i", off, along) / np.maximum(np.einsum("ij,ij->i", along, along), 1e-300), 0.0, 1.0)
        least = np.minimum(least, ((off - share[:, None] * along) ** 2).sum(axis=1))
    return np.where(inside, height**2 / square, least)


def turns(surface: Surface) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Edges (e, 2) between two triangles, which (e, 2) those are, and by how many degrees the surface turns there; above 0 where it is
    convex."""
    edges, of_side, _ = edges_of(surface.triangles)
    inner = np.bincount(of_side) == 2
    order = np.argsort(of_side, kind="stable")
    sides = order[inner[of_side[order]]].reshape(-1, 2) // 3
    edges = edges[inner]
    normals = surface.area_vectors
    normals = normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    one, other = normals[sides[:, 0]], normals[sides[:, 1]]
    angle = np.degrees(np.arctan2(np.linalg.norm(np.cross(one, other), axis=1), np.einsum("ij,ij->i", one, other)))
    middle = surface.corners.mean(axis=1)
    concave = np.einsum("ij,ij->i", one, middle[sides[:, 1]] - middle[sides[:, 0]]) > 0.0
    return edges, sides, np.where(concave, -angle, angle)


def regions(surface: Surface, sharp: float, height: float = math.inf, side: np.ndarray | None = None) -> np.ndarray:
    """The number (m,) of the region of each triangle: what hangs together without a turn of more than `sharp` degrees or, between large flat
    triangles, one that is as high as `height` over its chord, and, if given, with the same row of `side` (m, k)."""
    edges, pairs, angle = turns(surface)
    long = np.linalg.norm(surface.points[edges[:, 1]] - surface.points[edges[:, 0]], axis=1)
    area = np.linalg.norm(surface.area_vectors, axis=1)
    width = 2.0 * area[pairs].min(axis=1) / np.maximum(long, 1e-300)
    joined = pairs[(np.abs(angle) < sharp) & (width * np.radians(np.abs(angle)) / 8.0 < height)]
    if side is not None:
        joined = joined[np.all(side[joined[:, 0]] == side[joined[:, 1]], axis=1)]
    label = np.arange(len(surface.triangles))
    while True:  # the smallest number goes from neighbour to neighbour
        least = np.minimum(label[joined[:, 0]], label[joined[:, 1]])
        new = label.copy()
        np.minimum.at(new, joined.ravel(), np.repeat(least, 2))
        new = new[new]
        if np.array_equal(new, label):
            return np.unique(label, return_inverse=True)[1].reshape(-1)
        label = new


def with_bases(surface: Surface, sharp: float) -> Surface:
    """The regions between sharp edges that face straight backwards become the component `base`."""
    region = regions(surface, sharp)
    vectors = surface.area_vectors
    area = np.linalg.norm(vectors, axis=1)
    aft = vectors[:, 0] > AFT * area
    share = np.bincount(region, area * aft) / np.maximum(np.bincount(region, area), 1e-300)
    is_base = share[region] > 0.999
    if not np.any(is_base):
        return surface
    names = [*surface.names, "base"]
    component = np.where(is_base, len(names) - 1, surface.component)
    used = np.unique(component)
    return replace(surface, component=np.searchsorted(used, component), names=tuple(names[i] for i in used))
