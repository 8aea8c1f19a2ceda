"""The size of cells wanted around a body that is known by its surface alone, as sizes.py gives it for a description.

From samples of the surface, each with the size wanted there: small where it curves much, at sharp edges, above all acute ones, at thin
faces and at slender tips. Away from them cells grow, up to the cap inside the domain of dependence.
"""

from __future__ import annotations

import numpy as np

from meshing.domain import Domain
from meshing.sector import Sector
from meshing.shape import Shape, cross_sections, turns
from meshing.sizes import FARTHEST, THINNEST, SizeField
from meshing.surface import finely

SMALLEST = 0.15  # wall sizes
EDGE, ACUTE = 0.7, 0.34  # wall sizes at sharp edges, and where less than 80 degrees of the body are between the faces
FOLD = 20.0  # degrees at which an edge is a sharp one
CURVED = 0.35  # diameters: the radius of curvature at which cells are as large as on a cylinder
STEP = 0.2  # diameters between samples of the surface; half of the size between those of an edge
CLASSES = 10
CHUNK = 500


class ShapeSizes(SizeField):
    """As SizeField, in units of h: points (n, 3) -> sizes (n,)."""

    def __init__(self, shape: Shape, domain: Domain, stretch: float = 1.0) -> None:
        super().__init__(shape.envelope(), domain, stretch)
        self._behind = self._ahead  # faster growth would blur, over a step of the background's grid, into bases of any shape
        self.shape = shape
        x, areas, _ = cross_sections(shape.surface, 200)
        self._x, self._r = x, np.sqrt(areas / np.pi)
        self._samples = self._classed(*self._sampled())

    def with_stretch(self, stretch: float) -> ShapeSizes:
        """The same with other distances of growth."""
        other = object.__new__(ShapeSizes)
        other.__dict__ = self.__dict__ | {"stretch": stretch}
        return other

    def _sampling(self, sector: Sector, finer: float = 0.5) -> tuple[np.ndarray, np.ndarray]:
        return super()._sampling(sector, finer)

    def _sampled(self) -> tuple[np.ndarray, np.ndarray]:
        """Points of the surface and the size wanted at each."""
        surface = self.shape.surface
        edges, sides, angle = turns(surface)
        ends = surface.points[edges]
        length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
        area = np.linalg.norm(surface.area_vectors, axis=1)
        sharp = np.abs(angle) > FOLD
        # The radius of curvature across an edge: the distance between the middles of its triangles over the turn.
        width = 2.0 / 3.0 * area[sides].sum(axis=1) / np.maximum(length, 1e-300)
        radius = width / np.maximum(np.radians(np.abs(angle)), 1e-9)
        curved = np.clip(radius / CURVED, SMALLEST, 1.0)
        size = np.where(sharp, np.where(angle > 100.0, ACUTE, EDGE), curved)
        # Narrow faces between sharp edges, such as blunt trailing edges.
        height = 2.0 * area / np.maximum(self._longest_sides(), 1e-300)
        between = np.bincount(sides[sharp].ravel(), minlength=len(area)) >= 2
        narrow = np.where(between, np.maximum(THINNEST * height, 0.25 * ACUTE), np.inf)
        size = np.where(sharp, np.minimum(size, narrow[sides].min(axis=1)), size)
        points, sizes = [], []
        for a, b, wanted, long in zip(ends[:, 0], ends[:, 1], size, length):
            if wanted < 0.99:
                count = max(int(np.ceil(long / (0.15 * wanted))), 1)
                share = (np.arange(count) + 0.5)[:, None] / count
                points.append(a + share * (b - a))
                sizes.append(np.full(count, wanted))
        centres, _ = finely(surface, STEP)
        points.append(centres)
        sizes.append(np.ones(len(centres)))
        where, wanted = np.concatenate(points), np.concatenate(sizes)
        # Slender tips have fewer cells around them than a cylinder: smaller ones, as on the noses of descriptions.
        slender = SMALLEST + (1.0 - SMALLEST) * np.minimum(np.interp(where[:, 0], self._x, self._r, left=0.0, right=1.0) / CURVED, 1.0)
        return where, np.minimum(wanted, slender)

    def _longest_sides(self) -> np.ndarray:
        p = self.shape.surface.corners
        return np.linalg.norm(p - np.roll(p, -1, axis=1), axis=2).max(axis=1)

    def _classed(self, points: np.ndarray, sizes: np.ndarray) -> list[tuple[float, np.ndarray]]:
        """Samples by classes of size, one in each cell of a grid as wide as a part of that size."""
        bounds = np.geomspace(max(float(sizes.min()), 0.05), 1.0, CLASSES)
        number = np.clip(np.searchsorted(bounds, sizes * (1.0 + 1e-9), side="right") - 1, 0, CLASSES - 1)
        classes = []
        for i in np.unique(number):
            own = self._paced(points[number == i])
            _, first = np.unique(np.floor(own / (0.12 * bounds[i])).astype(np.int64), axis=0, return_index=True)
            classes.append((float(bounds[i]), own[first]))
        return classes

    def _paced(self, points: np.ndarray) -> np.ndarray:
        """Points with what is ahead of the nose and behind the tail drawn out, as cells grow there faster."""
        x = points[:, 0]
        x = np.clip(x, 0.0, self._tail) + self._behind * np.maximum(x - self._tail, 0.0) + self._ahead * np.minimum(x, 0.0)
        return np.column_stack([x, points[:, 1:]])

    def __call__(self, points: np.ndarray) -> np.ndarray:
        x, r = points[:, 0], np.hypot(points[:, 1], points[:, 2])
        moved = self._paced(points)
        wanted = np.full(len(points), np.inf)
        square = np.einsum("ij,ij->i", moved, moved)
        for size, samples in self._samples:
            own = np.einsum("ij,ij->i", samples, samples)
            for first in range(0, len(points), CHUNK):
                part = slice(first, first + CHUNK)
                nearest = (own - 2.0 * moved[part] @ samples.T).min(axis=1) + square[part]
                distance = np.sqrt(np.maximum(nearest, 0.0))
                wanted[part] = np.minimum(wanted[part], self._grown(size, distance))
        wanted = self._capped(wanted, x, r, self._behind * np.maximum(x - self._tail, 0.0))
        return np.minimum(wanted, FARTHEST / self.stretch) if not self.domain.arc else wanted
