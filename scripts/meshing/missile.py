"""What a description describes: body, fin sets, flight and reference, with the symmetries that are really there."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np

from meshing.planforms import Planform
from meshing.profiles import Body
from meshing.sections import Section


@dataclass(frozen=True)
class Panel:
    """One fin or half wing, in a frame of its own: x aft, s outwards along the span, n = x cross s.

    `roll`: direction of the span, degrees from up (z) towards starboard (y). `root`: s where its planform begins; `x` of the leading
    edge there; `origin`: (y, z) of s = 0. `deflection`: degrees about the line x = `hinge`, n = 0; positive raises the leading edge
    towards n. `name` of its patch; `set_name` of the set it belongs to; `where`: its place in the description, for messages.
    `turns`: its description says where the hinge is.
    """

    name: str
    set_name: str
    where: str
    roll: float
    x: float
    root: float
    planform: Planform
    section: Section
    deflection: float = 0.0
    hinge: float = 0.0
    origin: tuple[float, float] = (0.0, 0.0)
    turned_over: bool = False  # n of the section points to -n of the panel: the mirror image of a cambered one
    turns: bool = False

    @property
    def span_direction(self) -> np.ndarray:
        """s in space."""
        roll = math.radians(self.roll)
        return np.array([0.0, exactly(math.sin(roll)), exactly(math.cos(roll))])

    @property
    def normal(self) -> np.ndarray:
        """n in space."""
        _, y, z = self.span_direction
        return np.array([0.0, -z, y])

    @property
    def hinge_point(self) -> np.ndarray:
        """Where the hinge line meets the root, in space."""
        return np.array([self.x + self.hinge, *self.origin]) + self.root * self.span_direction

    @property
    def tip(self) -> float:
        """s of the tip."""
        return self.root + self.planform.span

    def to_space(self, local: np.ndarray) -> np.ndarray:
        """Points (k, 3) of (x behind the root's leading edge, s, n), deflected, in space."""
        x, s, n = local[:, 0] - self.hinge, local[:, 1], local[:, 2] * (-1.0 if self.turned_over else 1.0)
        angle = math.radians(self.deflection)
        c, d = math.cos(angle), math.sin(angle)
        ahead, above = c * x + d * n, -d * x + c * n
        centre = np.array([self.x + self.hinge, *self.origin])
        return centre + ahead[:, None] * [1.0, 0.0, 0.0] + s[:, None] * self.span_direction + above[:, None] * self.normal

    def to_local(self, points: np.ndarray) -> np.ndarray:
        """The inverse of `to_space`."""
        moved = points - [self.x + self.hinge, *self.origin]
        ahead, s, above = moved[:, 0], moved @ self.span_direction, moved @ self.normal
        angle = math.radians(self.deflection)
        c, d = math.cos(angle), math.sin(angle)
        n = (d * ahead + c * above) * (-1.0 if self.turned_over else 1.0)
        return np.column_stack([c * ahead - d * above + self.hinge, s, n])

    def image(self, axis: int) -> tuple:
        """What tells it apart from others after reflection about y = 0 (axis 1) or z = 0 (axis 2); `image(0)`: before."""
        roll, origin = self.roll, np.array(self.origin)
        if axis == 1:
            roll, origin = -roll, origin * [-1.0, 1.0]
        elif axis == 2:
            roll, origin = 180.0 - roll, origin * [1.0, -1.0]
        sign = -1.0 if axis else 1.0
        side = sign * (-1.0 if self.turned_over else 1.0) if self.section.camber else 0.0
        numbers = (roll % 360.0 if abs(roll % 360.0 - 360.0) > 1e-6 else 0.0, *origin, sign * self.deflection, side, self.x, self.root)
        shape = np.concatenate([self.planform.s, self.planform.lead, self.planform.trail, self.planform.thickness])
        return (*(round(float(number), 7) + 0.0 for number in (*numbers, *shape)), repr(self.section))

    def scaled(self, factor: float) -> Panel:
        return replace(
            self, x=self.x * factor, root=self.root * factor, planform=self.planform.scaled(factor),
            section=self.section.scaled(factor), hinge=self.hinge * factor,
            origin=(self.origin[0] * factor, self.origin[1] * factor),
        )  # fmt: skip


def ring(
    name: str, where: str, roll: float, x: float, body: Body, planform: Planform, section: Section, deflections: list[float],
    hinge: float | None = None,
) -> list[Panel]:
    """Equal panels at equal angles, one for each deflection; the first at `roll`. They turn about a hinge that is given; else deflections
    are about half of the root chord."""
    root = float(body.radius(np.array([min(x, body.length)]))[0])
    at = hinge_of(planform, hinge)
    return [
        Panel(
            f"{name}_{i + 1}", name, where, roll + 360.0 * i / len(deflections), x, root, planform, section, deflection, at,
            turns=hinge is not None,
        )
        for i, deflection in enumerate(deflections)
    ]  # fmt: skip


def hinge_of(planform: Planform, given: float | None) -> float:
    return 0.5 * float(planform.chord[0]) if given is None else given


def exactly(value: float) -> float:
    """0, 1 and -1 without the last bit's error of sine and cosine."""
    nearest = round(value)
    return float(nearest) if abs(value - nearest) < 1e-12 else value


@dataclass(frozen=True)
class Flight:
    """The conditions that a mesh is made for: Mach numbers from the lowest to the highest, and the largest incidence in degrees."""

    mach: tuple[float, float] = (1.5, 2.5)
    alpha: float = 3.0


@dataclass(frozen=True)
class Reference:
    """For the case file, in the description's unit."""

    length: float
    area: float
    moment_center: tuple[float, float, float]


@dataclass(frozen=True)
class Missile:
    """A description that has been read and checked. Lengths in `unit`, x aft from the nose, y to starboard, z up."""

    title: str
    unit: str
    body: Body
    panels: tuple[Panel, ...]
    flight: Flight
    reference: Reference
    notes: tuple[str, ...] = field(default=())  # what was left out, assumed or missing

    @property
    def length(self) -> float:
        """Of the body."""
        return self.body.length

    @property
    def diameter(self) -> float:
        """The body's largest one."""
        return self.body.diameter

    def is_symmetric(self, axis: int) -> bool:
        """Is it its own mirror image about y = 0 (axis 1) or z = 0 (axis 2)?"""
        return sorted(panel.image(0) for panel in self.panels) == sorted(panel.image(axis) for panel in self.panels)

    def in_diameters(self) -> Missile:
        """The same with the body's largest diameter as the unit; only body and panels change."""
        factor = 1.0 / self.body.diameter
        return replace(self, body=self.body.scaled(factor), panels=tuple(panel.scaled(factor) for panel in self.panels))
