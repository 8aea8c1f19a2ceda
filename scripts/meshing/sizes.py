"""The size of cells wanted at a point, in units of the wall's size h: small at noses, edges and fins, capped where waves come from.

Lengths in diameters of the body. Everything is proportional to h, so that meshes of different h are one family. In supersonic flow
cells matter only inside the domain of dependence of the body: inside the bow shock, and ahead of the Mach lines that reach its tail.
Coarse cells there scatter the loads, above all Cm_alphadot, from mesh to mesh: `CAP` bounds them. The domain of the highest Mach number
is the smallest and lies in all others: `INNER` bounds the cells there. Ahead of the nose and behind the tail nothing comes back, and
cells grow two and four times as fast.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from meshing.domain import Domain, Shock, bow_shock
from meshing.missile import Missile, Panel
from meshing.profiles import fine
from meshing.sector import Sector

CAP = 2.2  # wall sizes, inside the domain of dependence at the lowest Mach number
INNER = 1.5  # wall sizes, inside that at the highest one
LOOSER = 0.4  # wall sizes a diameter, from the one to the other
AHEAD, BEHIND = 2.0, 4.0  # times as fast do cells grow ahead of the nose and behind the tail in supersonic flow
BEYOND = 1.06  # of the tangent of the shock's angle
TAIL = 0.8  # diameters around the tail
FARTHEST = 14.0  # in frusta, wall sizes
PER_VOLUME = 5.0  # tetrahedra in the cube of the size, as gmsh makes them where sizes grow
REACH = 2.0  # diameters around a panel beyond which it does not matter
USUAL = 0.08  # h for which the growth is made, in diameters
THINNEST = 12.0  # thicknesses of a blunt edge that a cell beside it may be long, at h = 0.08 d


@dataclass(frozen=True)
class Dependence:
    """What reaches the body at a Mach number: inside the bow shock and ahead of the Mach lines to its tail; beta = sqrt(M^2 - 1)."""

    shock: Shock
    beta: float
    tail: float

    def outside(self, x: np.ndarray, r: np.ndarray) -> np.ndarray:
        """How far outside of it points are; 0 inside."""
        beyond_shock = (r - BEYOND * self.shock.radius(x)) * math.cos(math.radians(self.shock.angle))
        too_late = (r - TAIL - (self.tail - x) / self.beta) * self.beta / math.hypot(1.0, self.beta)
        return np.maximum(np.maximum(beyond_shock, too_late), 0.0)


class SizeField:
    """The function itself: `__call__` takes points (n, 3), and gives the sizes (n,) in units of h.

    `stretch`: distances over which cells grow are so many times as long, that cells of a larger h do not grow too fast.
    """

    def __init__(self, missile: Missile, domain: Domain, stretch: float = 1.0) -> None:
        self.missile, self.domain, self.stretch = missile, domain, stretch
        body = missile.body
        outline = body.outline()
        step = np.linspace(0.0, body.length, 2001)
        self._x, self._r = step, np.interp(step, outline[:, 0], outline[:, 1])
        self._largest = float(self._r.max())
        self._tail = max([body.length, *(float(p.x + p.planform.trail.max()) for p in missile.panels)])
        self._breaks = self._find_breaks()
        self._ahead, self._behind = (1.0, 1.0) if domain.arc else (AHEAD, BEHIND)
        self._reaches: list[Dependence] = []  # at the lowest and at the highest Mach number
        if domain.shock is not None:
            fastest = missile.flight.mach[1]
            self._reaches = [
                Dependence(domain.shock, domain.beta, self._tail),
                Dependence(bow_shock(missile, fastest), math.sqrt(fastest**2 - 1.0), self._tail),
            ]

    def _find_breaks(self) -> list[tuple[float, float, float]]:
        """Corners of the profile where the flow turns by more than 3 degrees: x, r and the size there."""
        pieces = [fine(piece.points) for segment in self.missile.body.segments for piece in segment.pieces]
        breaks = []
        for one, other in zip(pieces, pieces[1:]):
            turns = [math.atan2(*(line[1] - line[0])[::-1]) for line in (one[-2:], other[:2])]
            if np.any(np.abs(one[-1] - other[0]) > 1e-9):  # a step
                breaks += [(*one[-1], 0.4), (*other[0], 0.4)]
            elif abs(turns[1] - turns[0]) > math.radians(3.0):
                breaks.append((*one[-1], 0.6))
        return [(float(x), float(r), size) for x, r, size in breaks]

    def _grown(self, start: np.ndarray | float, distance: np.ndarray) -> np.ndarray:
        distance = distance / self.stretch
        if self.domain.arc:
            return start + 2.0 * distance + 0.25 * np.minimum(distance, 5.0) * distance
        return start + 2.0 * distance + distance**2

    def __call__(self, points: np.ndarray) -> np.ndarray:
        x = points[:, 0]
        r = np.hypot(points[:, 1], points[:, 2])
        ahead, behind = self._ahead * np.maximum(-x, 0.0), self._behind * np.maximum(x - self._tail, 0.0)
        radius = np.interp(x, self._x, self._r)
        # The nose: smaller with the local circumference.
        surface = 0.2 + 0.8 * np.minimum(radius / (0.7 * self._largest), 1.0)
        distance = np.sqrt(ahead**2 + behind**2 + np.maximum(r - radius, 0.0) ** 2)
        wanted = self._grown(surface, distance)
        for at, corner, size in self._breaks:
            wanted = np.minimum(wanted, size + 2.0 * np.hypot(x - at, r - corner))
        wanted = self._capped(wanted, x, r, behind)
        for panel in self.missile.panels:
            near = self._around(panel, x, r)
            wanted[near] = np.minimum(wanted[near], self._near_panel(panel, points[near], behind[near]))
        return np.minimum(wanted, FARTHEST / self.stretch) if not self.domain.arc else wanted

    def _capped(self, wanted: np.ndarray, x: np.ndarray, r: np.ndarray, behind: np.ndarray) -> np.ndarray:
        """The caps in the domains of dependence, and growth from their edge."""
        if not self._reaches:
            return wanted
        slowest, fastest = (reach.outside(x, r) for reach in self._reaches)
        cap = np.minimum(np.maximum(INNER + LOOSER * fastest, behind), CAP)
        return np.minimum(wanted, cap + 5.0 / self.stretch * np.maximum(slowest, behind))

    def without_caps(self) -> SizeField:
        """The same with nothing but growth away from the body."""
        other = copy.copy(self)
        other._reaches = []
        return other

    def _around(self, panel: Panel, x: np.ndarray, r: np.ndarray) -> np.ndarray:
        """The points at which a panel may matter: a few diameters around it."""
        plan, wide = panel.planform, REACH * self.stretch
        return np.flatnonzero(
            (x > panel.x + plan.lead.min() - wide) & (x < panel.x + plan.trail.max() + wide)
            & (r < panel.tip + math.hypot(*panel.origin) + wide)
        )  # fmt: skip

    def _near_panel(self, panel: Panel, points: np.ndarray, behind: np.ndarray) -> np.ndarray:
        plan = panel.planform
        local = panel.to_local(points)
        x, s, n = local[:, 0], local[:, 1] - panel.root, np.abs(local[:, 2])
        inside = np.clip(s, 0.0, plan.span)
        lead, trail = np.interp(inside, plan.s, plan.lead), np.interp(inside, plan.s, plan.trail)
        beyond = np.maximum(s - plan.span, 0.0) + np.maximum(-s - panel.root, 0.0)
        along = np.maximum(np.maximum(lead - x, x - trail), 0.0)
        distance = np.sqrt(along**2 + beyond**2 + n**2 + behind**2)
        scale = min(1.0, 1.1 * min(float(plan.area / plan.span), 1.3 * plan.span)) ** 0.75
        size = 0.75 * scale
        wanted = self._grown(size, distance)
        edge = 0.45 * size
        across = np.sqrt(n**2 + beyond**2)
        leading = np.hypot(x - lead, across)
        tip = np.sqrt((s - plan.span) ** 2 + n**2 + np.maximum(np.maximum(plan.lead[-1] - x, x - plan.trail[-1]), behind) ** 2)
        wanted = np.minimum(wanted, np.minimum(edge + 1.5 * leading, edge + 1.5 * tip))
        trailing = np.hypot(np.maximum(np.abs(x - trail), behind), across)
        end = edge
        if panel.section.blunt:
            end = min(edge, max(THINNEST * float(plan.thickness.min()), 0.25 * edge))
        return np.minimum(wanted, end + 1.5 * trailing)

    def cells(self, sector: Sector) -> float:
        """Number of tetrahedra in a sector for h = 1, by the integral of the inverse cube of the size."""
        points, volumes = self._sampling(sector)
        return PER_VOLUME * float(np.sum(volumes / self(points) ** 3))

    def _sampling(self, sector: Sector, finer: float = 1.0) -> tuple[np.ndarray, np.ndarray]:
        """Points in a sector of the fluid, and the volume that each stands for; closer together near the wall. `finer`: how many times as
        close as usual, in each direction."""
        length, profile = self.missile.body.length, self.domain.profile
        first, last = float(profile[:, 0].min()), float(profile[:, 0].max())
        out = lambda end, start: start + (end - start) * np.linspace(0.0, 1.0, round(19 * finer) + 1)[1:] ** 2
        x = np.unique(np.concatenate([np.linspace(0.0, self._tail, round(90 * finer) + 1), out(first, 0.0), out(last, self._tail)]))
        middle, width = 0.5 * (x[1:] + x[:-1]), np.diff(x)
        if self.domain.arc:
            top = np.sqrt(np.maximum((0.5 * (last - first)) ** 2 - (middle - 0.5 * length) ** 2, 0.0))
        else:
            top = np.interp(middle, profile[1:3][::-1, 0], profile[1:3][::-1, 1])
        bottom = np.where((middle > 0.0) & (middle < length), np.interp(middle, self._x, self._r), 0.0)
        t = np.linspace(0.0, 1.0, round(32 * finer) + 1) ** (4.0 if self.domain.arc else 2.0)
        radii = bottom[:, None] + (top - bottom)[:, None] * t
        ring = 0.5 * (radii[:, 1:] ** 2 - radii[:, :-1] ** 2) * width[:, None]
        mean = 0.5 * (radii[:, 1:] + radii[:, :-1])
        begin, end = sector.angles
        count = max(int(round((end - begin) * finer / 7.5)), 1)
        step = math.radians(end - begin) / count
        angle = math.radians(begin) + step * (np.arange(count) + 0.5)
        shape = (*mean.shape, count)
        xs = np.broadcast_to(middle[:, None, None], shape)
        points = np.stack([xs, mean[:, :, None] * np.cos(angle), mean[:, :, None] * np.sin(angle)], axis=-1)
        return points.reshape(-1, 3), np.broadcast_to((ring * step)[:, :, None], shape).reshape(-1)


def size_field(make: Callable[[float], SizeField], sector: Sector, cells: float) -> SizeField:
    """One of the size fields that `make` gives for a stretch, stretched for meshes of about `cells` tetrahedra in the sector."""
    stretch = 1.0
    for _ in range(2):
        h = (make(stretch).cells(sector) / cells) ** (1.0 / 3.0)
        stretch = max(h / USUAL, 1.0)
    return make(stretch)
