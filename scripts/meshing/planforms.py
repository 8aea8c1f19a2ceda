"""Planforms of fins and wings: leading and trailing edge and thickness at stations along the span."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from meshing.tetrahedra import MeshError

POINTED = 1e-9  # share of the root chord below which a chord is none


@dataclass(frozen=True)
class Planform:
    """Stations from the root outwards: `s` along the span from the root, x of leading and trailing edge behind the root's leading
    edge, and thickness; each (k,)."""

    s: np.ndarray
    lead: np.ndarray
    trail: np.ndarray
    thickness: np.ndarray

    @property
    def chord(self) -> np.ndarray:
        return self.trail - self.lead

    @property
    def span(self) -> float:
        return float(self.s[-1])

    @property
    def area(self) -> float:
        """Of one side."""
        return float(np.sum(0.5 * (self.chord[1:] + self.chord[:-1]) * np.diff(self.s)))

    @property
    def pointed(self) -> bool:
        return bool(self.chord[-1] <= POINTED * self.chord[0])

    def scaled(self, factor: float) -> Planform:
        return Planform(self.s * factor, self.lead * factor, self.trail * factor, self.thickness * factor)

    def with_thickness(self, root: float, tip: float | None, of_chord: bool) -> Planform:
        """With thickness at root and tip, linear in between; as shares of the local chord where `of_chord`."""
        values = np.interp(self.s, [0.0, self.span], [root, root if tip is None else tip])
        return Planform(self.s, self.lead, self.trail, values * self.chord if of_chord else values)


def trapezoid(root: float, tip: float, span: float, shift: float) -> Planform:
    """`shift`: of the tip's leading edge behind the root's."""
    s = np.array([0.0, span])
    lead = np.array([0.0, shift])
    return Planform(s, lead, lead + [root, tip], np.zeros(2))


def ellipse(root: float, span: float, stations: int = 9) -> Planform:
    """Half an ellipse on the root chord; its tip is cut where the chord is a tenth of the root's."""
    angle = np.linspace(0.0, math.acos(0.1), stations)
    half = 0.5 * root * np.cos(angle)
    return Planform(span * np.sin(angle), 0.5 * root - half, 0.5 * root + half, np.zeros(stations))


def polygon(points: list[tuple[float, float]]) -> Planform:
    """A polygon of (x, s) from the leading to the trailing end of the root, both at s = 0.

    Raises MeshError where it cannot be lofted: every line s = constant must cross it twice. Stretches along the root outside of its
    ends, and steps of an edge at one s, are drawn as very steep ones.
    """
    p = np.asarray(points, dtype=float)
    if np.any(np.abs(p[[0, -1], 1]) > 1e-9 * np.abs(p).max()):
        raise MeshError("the first and the last point must be at the root, where the second number is 0")
    p[[0, -1], 1] = 0.0
    p[:, 0] -= p[0, 0]
    top = p[:, 1].max()
    if not top > 0.0 or not p[-1, 0] > 0.0:
        raise MeshError("the points go from the leading end of the root outwards and back to its trailing end")
    if np.any(p[1:-1, 1] < 0.0):
        raise MeshError("a point lies inside the body: its second number must not be below 0")
    highest = np.flatnonzero(p[:, 1] >= top * (1.0 - 1e-3))
    first, last = int(highest[0]), int(highest[-1])
    lead, trail = p[: first + 1], p[last:][::-1]
    sides = []
    for side, name in ((lead, "leading"), (trail, "trailing")):
        s = side[:, 1].copy()
        if np.any(np.diff(s) < -1e-3 * top):
            raise MeshError(f"the {name} edge turns back towards the root: a line along the chord must cross the edges only twice")
        step = 2e-3 * top
        for i in range(1, len(s)):
            s[i] = max(s[i], s[i - 1] + step)
        s *= top / s[-1]
        sides.append((s, side[:, 0]))
    stations = merged(np.concatenate([sides[0][0], sides[1][0]]), 0.015 * top)
    ends = [np.interp(stations, s, x) for s, x in sides]
    if np.any(ends[1][:-1] - ends[0][:-1] <= 0.0) or ends[1][-1] < ends[0][-1]:
        raise MeshError("the edges cross: the trailing edge must be behind the leading edge everywhere")
    return Planform(stations, ends[0], ends[1], np.zeros(len(stations)))


def merged(values: np.ndarray, tolerance: float) -> np.ndarray:
    """Sorted values without those that are nearer to their neighbour than the tolerance; both ends stay."""
    values = np.unique(values)
    kept = [values[0]]
    for value in values[1:-1]:
        if value - kept[-1] >= tolerance and values[-1] - value >= tolerance:
            kept.append(value)
    return np.array([*kept, values[-1]])
