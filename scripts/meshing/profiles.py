"""Bodies of revolution: the profiles of noses, tubes, flares and boattails, one after the other from the tip."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from meshing.tetrahedra import MeshError

SPLINE_POINTS = 41  # on a curved piece, closer together at both ends

# r / R as a function of x / L, both from 0 to 1. Haack: E. Haack, Geschossformen kleinsten Wellenwiderstandes, 1941; c = 0 is
# von Karman's (least drag for length and diameter), 1/3 that for length and volume.
Shape = Callable[[np.ndarray], np.ndarray]


def haack(c: float) -> Shape:
    def shape(x: np.ndarray) -> np.ndarray:
        theta = np.arccos(np.clip(1.0 - 2.0 * x, -1.0, 1.0))
        return np.sqrt(np.maximum(theta - 0.5 * np.sin(2.0 * theta) + c * np.sin(theta) ** 3, 0.0) / math.pi)

    return shape


def power(exponent: float) -> Shape:
    return lambda x: x**exponent


def elliptic() -> Shape:
    return lambda x: np.sqrt(np.maximum(1.0 - (1.0 - x) ** 2, 0.0))


def parabolic(k: float) -> Shape:
    """The parabolic series: k = 0 a cone, 1 a parabola that is tangent to what follows."""
    return lambda x: x * (2.0 - k * x) / (2.0 - k)


def ogive(fineness: float, bluntness: float = 1.0) -> Shape:
    """An arc of a circle from tip to shoulder, whose highest point is at x / L = 1 / bluntness.

    1: tangent to what follows; less: secant, flatter the less it is; 0: a cone. `fineness`: length over the rise of the radius,
    at least 1 for the tangent one.
    """
    if bluntness <= 0.0:
        return lambda x: x
    top = fineness / bluntness
    below = top * fineness - 0.5 * (fineness**2 + 1.0)  # of the axis, the centre of the arc; the rise is 1
    radius = math.hypot(top, below)
    return lambda x: np.sqrt(np.maximum(radius**2 - (fineness * x - top) ** 2, 0.0)) - below


@dataclass(frozen=True)
class Piece:
    """A smooth piece of a profile: points (n, 2) of x and r; a straight line between two, a spline through more."""

    points: np.ndarray

    def scaled(self, factor: float) -> Piece:
        return Piece(self.points * factor)


@dataclass(frozen=True)
class Segment:
    """A component of the body, from the front to the back."""

    name: str
    pieces: tuple[Piece, ...]

    @property
    def start(self) -> np.ndarray:
        """x and r where it begins."""
        return self.pieces[0].points[0]

    @property
    def end(self) -> np.ndarray:
        return self.pieces[-1].points[-1]

    def scaled(self, factor: float) -> Segment:
        return Segment(self.name, tuple(piece.scaled(factor) for piece in self.pieces))


def shaped(name: str, shape: Shape, start: float, length: float, first: float, last: float, straight: bool = False) -> Segment:
    """A segment from radius `first` to `last`; where the radius falls, the shape runs backwards."""
    if straight or first == last:
        return Segment(name, (Piece(np.array([[start, first], [start + length, last]])),))
    t = 0.5 * (1.0 - np.cos(np.linspace(0.0, math.pi, SPLINE_POINTS)))
    r = first + (last - first) * shape(t) if last > first else last + (first - last) * shape(1.0 - t)
    r[0], r[-1] = first, last
    return Segment(name, (Piece(np.column_stack([start + length * t, r])),))


def through(name: str, start: float, points: np.ndarray, smooth: bool) -> Segment:
    """A segment through given points (n, 2), x from its front."""
    moved = points + [start, 0.0]
    if smooth and len(moved) > 2:
        return Segment(name, (Piece(moved),))
    return Segment(name, tuple(Piece(moved[i : i + 2]) for i in range(len(moved) - 1)))


def blunted(name: str, kind: str, length: float, radius: float, tip: float) -> Segment:
    """A cone or a tangent ogive with a sphere of radius `tip` at its front; `length` is the true one, from the foremost point."""
    if kind == "cone":
        low, high = 0.0, 0.5 * math.pi
        reach = lambda angle: tip * math.cos(angle) + (length - tip * (1.0 - math.sin(angle))) * math.tan(angle) - radius
        for _ in range(200):
            middle = 0.5 * (low + high)
            low, high = (low, middle) if reach(middle) > 0.0 else (middle, high)
        join = np.array([tip * (1.0 - math.sin(low)), tip * math.cos(low)])
        rest = Piece(np.array([join, [length, radius]]))
        last = 0.5 * math.pi - low
    else:  # tangent ogive: the sphere touches the arc from inside
        def cut(sharp: float) -> tuple[float, float, float]:
            arc_radius = 0.5 * (sharp**2 + radius**2) / radius
            behind = math.sqrt(max((arc_radius - tip) ** 2 - (arc_radius - radius) ** 2, 0.0))  # sphere's centre ahead of the shoulder
            return behind + tip, arc_radius, behind

        low, high = length, 100.0 * length
        for _ in range(200):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if cut(middle)[0] < length else (low, middle)
        _, arc_radius, behind = cut(low)
        direction = np.array([-behind, arc_radius - radius]) / (arc_radius - tip)  # from the arc's centre to the sphere's
        join = np.array([length, radius - arc_radius]) + arc_radius * direction
        first, final = math.atan2(direction[1], direction[0]), 0.5 * math.pi
        angles = np.linspace(first, final, SPLINE_POINTS)
        points = np.column_stack([length + arc_radius * np.cos(angles), radius - arc_radius + arc_radius * np.sin(angles)])
        points[0], points[-1] = join, (length, radius)
        rest = Piece(points)
        last = math.atan2(join[1], tip - join[0])
    angles = np.linspace(0.0, last, 15)
    cap = np.column_stack([tip * (1.0 - np.cos(angles)), tip * np.sin(angles)])
    cap[-1] = join
    return Segment(name, (Piece(cap), rest))


@dataclass(frozen=True)
class Body:
    """A body of revolution about the x axis, its tip in the origin; segments that follow each other, steps between them."""

    segments: tuple[Segment, ...]

    @property
    def length(self) -> float:
        return float(self.segments[-1].end[0])

    @property
    def base_radius(self) -> float:
        return float(self.segments[-1].end[1])

    def outline(self) -> np.ndarray:
        """The profile as a fine polygon (n, 2), steps included."""
        rows = []
        for piece in (piece for segment in self.segments for piece in segment.pieces):
            rows.append(fine(piece.points))
        return np.concatenate(rows)

    @property
    def diameter(self) -> float:
        """The largest one."""
        return 2.0 * float(self.outline()[:, 1].max())

    def radius(self, x: np.ndarray) -> np.ndarray:
        """The radius at x; 0 ahead of the body and behind it; the larger one at a step."""
        outline = self.outline()
        return np.interp(x, outline[:, 0], outline[:, 1], left=0.0, right=0.0)

    def scaled(self, factor: float) -> Body:
        return Body(tuple(segment.scaled(factor) for segment in self.segments))

    def nose_angle(self) -> float:
        """Half angle, in degrees, of the cone that starts at the tip and is as steep as the nose over its first fifth."""
        end = self.segments[0].end
        x = 0.2 * end[0]
        return math.degrees(math.atan2(float(self.radius(np.array([x]))[0]), x))


def fine(points: np.ndarray, per_interval: int = 12) -> np.ndarray:
    """Points on the curve that OpenCASCADE draws through `points`: a line, or a cubic spline."""
    if len(points) == 2:
        return points
    t = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])  # by the chords, as OpenCASCADE does
    s = np.unique(np.concatenate([t] + [t[:-1] + np.diff(t) * k / per_interval for k in range(1, per_interval)]))
    return np.column_stack([_natural_spline(t, points[:, i], s) for i in (0, 1)])


def _natural_spline(t: np.ndarray, values: np.ndarray, s: np.ndarray) -> np.ndarray:
    """The natural cubic spline through values at t, at s."""
    n = len(t)
    step = np.diff(t)
    matrix, right = np.eye(n), np.zeros(n)
    for i in range(1, n - 1):
        matrix[i, i - 1 : i + 2] = step[i - 1], 2.0 * (step[i - 1] + step[i]), step[i]
        right[i] = 6.0 * ((values[i + 1] - values[i]) / step[i] - (values[i] - values[i - 1]) / step[i - 1])
    moment = np.linalg.solve(matrix, right)
    k = np.clip(np.searchsorted(t, s, side="right") - 1, 0, n - 2)
    a, b = (t[k + 1] - s) / step[k], (s - t[k]) / step[k]
    bend = ((a**3 - a) * moment[k] + (b**3 - b) * moment[k + 1]) * step[k] ** 2 / 6.0
    return a * values[k] + b * values[k + 1] + bend


def check_body(body: Body) -> None:
    """Raises MeshError unless the profile goes backwards everywhere and stays off the axis between its ends."""
    for segment in body.segments:
        points = np.concatenate([fine(piece.points) for piece in segment.pieces])
        if np.any(np.diff(points[:, 0]) < -1e-12):
            raise MeshError(f"body segment '{segment.name}' turns back: its x must grow from point to point")
        if np.any(points[1:-1, 1] <= 0.0):
            raise MeshError(f"body segment '{segment.name}' reaches the axis between its ends: keep its radius above 0")
