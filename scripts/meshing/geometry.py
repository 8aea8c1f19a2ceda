"""The fluid around a missile as OpenCASCADE's solid, in gmsh's current model. Lengths in diameters of the body.

Fins are lofted through their sections, lengthened into the body, and cut at the body's own surface (lengthened behind the base, so
that a fin which ends there shares no plane face with it); then the fluid is cut at the fins. Which component a face of the result
belongs to is found from where its points lie.
"""

from __future__ import annotations

import math

import gmsh
import numpy as np

from meshing.domain import Domain
from meshing.missile import Missile, Panel
from meshing.profiles import Body, fine
from meshing.sector import Sector
from meshing.tetrahedra import MeshError

FLAT = 1e-9  # diameters off its plane
ON_BODY = 2e-3  # diameters off the profile: OpenCASCADE's splines differ from ours at blunt tips


def build_fluid(missile: Missile, domain: Domain, sector: Sector) -> None:
    """Make the fluid in the sector the current gmsh model. Raises MeshError where a fin cannot be made."""
    occ = gmsh.model.occ
    fluids = _revolved(_profile_face(_fluid_curves(missile.body, domain)), _divisions(sector, missile.panels))
    panels = [panel for panel in missile.panels if sector.holds(panel)]
    if panels:
        tools = []
        for panel in panels:
            raw = _panel_solid(panel, missile.body)
            outside, _ = occ.cut([(3, raw)], _body_half(missile.body, panel))
            tools += [entity for entity in outside if entity[0] == 3]
        fluids, _ = occ.cut(fluids, tools)
        fluids = [entity for entity in fluids if entity[0] == 3]
    occ.synchronize()
    if len(gmsh.model.getEntities(3)) != 1:
        raise MeshError(f"the fluid falls into {len(gmsh.model.getEntities(3))} parts: do fins touch each other or the far field?")


def _curve(points: np.ndarray, tags: tuple[int, int]) -> int:
    occ = gmsh.model.occ
    if len(points) == 2:
        return occ.addLine(*tags)
    return occ.addSpline([tags[0], *(occ.addPoint(x, r, 0.0) for x, r in points[1:-1]), tags[1]])


def _body_curves(body: Body) -> tuple[list[int], int, int]:
    """Curves along the profile, steps included, and the points at its ends."""
    occ = gmsh.model.occ
    first = last = occ.addPoint(0.0, float(body.segments[0].start[1]), 0.0)
    end = body.segments[0].start
    curves = []
    for piece in (piece for segment in body.segments for piece in segment.pieces):
        if np.abs(piece.points[0] - end).max() > FLAT:  # a step
            corner = occ.addPoint(*piece.points[0], 0.0)
            curves.append(occ.addLine(last, corner))
            last = corner
        following = occ.addPoint(*piece.points[-1], 0.0)
        curves.append(_curve(piece.points, (last, following)))
        last, end = following, piece.points[-1]
    return curves, first, last


def _fluid_curves(body: Body, domain: Domain) -> list[int]:
    """The closed profile of the fluid in the half plane z = 0, y >= 0."""
    occ = gmsh.model.occ
    curves, first, last = _body_curves(body)
    behind = last
    if body.base_radius > 0.0:
        behind = occ.addPoint(body.length, 0.0, 0.0)
        curves.append(occ.addLine(last, behind))
    outer = [occ.addPoint(x, r, 0.0) for x, r in domain.profile]
    curves.append(occ.addLine(behind, outer[0]))
    if domain.arc:
        middle = occ.addPoint(0.5 * float(domain.profile[:, 0].sum()), 0.0, 0.0)
        top = occ.addPoint(0.5 * float(domain.profile[:, 0].sum()), 0.5 * float(np.ptp(domain.profile[:, 0])), 0.0)
        curves += [occ.addCircleArc(outer[0], middle, top), occ.addCircleArc(top, middle, outer[1])]
    else:
        curves += [occ.addLine(a, b) for a, b in zip(outer, outer[1:])]
    curves.append(occ.addLine(outer[-1], first))
    return curves


def outer_solids(domain: Domain, sector: Sector, first: float) -> list[tuple[int, int]]:
    """All that the far field encloses in the sector, without a body, in pieces side by side; the divisions of a whole one from the angle
    `first`, degrees."""
    occ = gmsh.model.occ
    first, last = (occ.addPoint(*domain.profile[i], 0.0) for i in (0, -1))
    curves = [occ.addLine(last, first)]
    if domain.arc:
        middle = 0.5 * float(domain.profile[:, 0].sum())
        centre, top = occ.addPoint(middle, 0.0, 0.0), occ.addPoint(middle, 0.5 * float(np.ptp(domain.profile[:, 0])), 0.0)
        curves += [occ.addCircleArc(first, centre, top), occ.addCircleArc(top, centre, last)]
    else:
        inner = [occ.addPoint(x, r, 0.0) for x, r in domain.profile[1:-1]]
        row = [first, *inner, last]
        curves += [occ.addLine(a, b) for a, b in zip(row, row[1:])]
    begin, end = sector.angles
    count = max(round((end - begin) / 90.0), 1)
    if end - begin == 360.0:
        begin, end = begin + first, end + first
    return _swept(_profile_face(curves), [float(angle) for angle in np.linspace(begin, end, count + 1)])


def _profile_face(curves: list[int]) -> int:
    occ = gmsh.model.occ
    return occ.addPlaneSurface([occ.addCurveLoop(curves)])


def _revolved(face: int, angles: list[float]) -> list[tuple[int, int]]:
    """The solid that the face sweeps about the axis from the first of some angles to the last, its surfaces divided at the others;
    degrees from starboard (y) towards up (z)."""
    solids = _swept(face, angles)
    gmsh.option.setNumber("Geometry.OCCUnionUnify", 0)  # keeps the divisions
    if len(solids) > 1:
        solids, _ = gmsh.model.occ.fuse(solids[:1], solids[1:])
    return solids


def _swept(face: int, angles: list[float]) -> list[tuple[int, int]]:
    """The solids that the face sweeps from each of some angles to the next."""
    occ = gmsh.model.occ
    solids = []
    for begin, end in zip(angles, angles[1:]):
        one = occ.copy([(2, face)])[0]
        occ.rotate([one], 0, 0, 0, 1, 0, 0, math.radians(begin))
        swept = occ.revolve([one], 0, 0, 0, 1, 0, 0, math.radians(end - begin))
        solids += [entity for entity in swept if entity[0] == 3]
    occ.remove([(2, face)], recursive=False)
    return solids


def _divisions(sector: Sector, panels: tuple[Panel, ...]) -> list[float]:
    """Angles at which the surfaces in a sector are divided, its ends among them: as far as possible from all panels.

    An undivided half around the tip of the nose may be closed by one flat triangle, which lies in the plane of symmetry.
    """
    begin, end = sector.angles
    taken = np.array([90.0 - panel.roll for panel in panels])

    def apart(angle: float, period: float) -> float:
        return float(np.min(np.abs((angle - taken + 0.5 * period) % period - 0.5 * period), initial=period))

    if end - begin <= 90.0:
        return [begin, end]
    if end - begin <= 180.0:
        middle = max(np.arange(begin + 60.0, end - 59.0, 3.0), key=lambda angle: apart(angle, 360.0))
        return [begin, float(middle), end]
    first = float(max(np.arange(0.0, 90.0, 3.0), key=lambda angle: apart(angle, 90.0)))
    return [first + 90.0 * i for i in range(5)]


def _body_half(body: Body, panel: Panel) -> list[tuple[int, int]]:
    """The half of the body on the panel's side, lengthened behind its base."""
    occ = gmsh.model.occ
    curves, first, last = _body_curves(body)
    end = 2.0 * body.length
    if body.base_radius > 0.0:
        corner, axis = occ.addPoint(end, body.base_radius, 0.0), occ.addPoint(end, 0.0, 0.0)
        curves += [occ.addLine(last, corner), occ.addLine(corner, axis), occ.addLine(axis, first)]
    else:
        curves.append(occ.addLine(last, first))
    direction = 90.0 - panel.roll
    return _revolved(_profile_face(curves), [direction - 90.0, direction + 90.0])


def _inner_end(panel: Panel, body: Body) -> float:
    """s inside of the body to which the panel is lengthened: as near to the surface as it goes."""
    outline = body.outline()
    for share in (0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1):
        s = share * panel.root
        x, n = _section_at(panel, s)
        local = np.column_stack([x, np.full(len(x), s), n])
        points = panel.to_space(local)
        radius = np.interp(points[:, 0], outline[:, 0], outline[:, 1], left=0.0)  # behind the base goes on
        if np.all(np.hypot(points[:, 1], points[:, 2]) < radius - 1e-3):
            return s
    # Too thick for that: down to the axis, where its middle plane is inside.
    x, _ = _section_at(panel, 0.0)
    ends = panel.to_space(np.array([[x.min(), 0.0, 0.0], [x.max(), 0.0, 0.0]]))[:, 0]
    if ends.min() > 0.0 and not panel.deflection:
        return 0.0
    raise MeshError(
        f"{panel.where}: the root of '{panel.name}' reaches out of the body at its ends; make it thinner, move it off the tip, "
        "or turn it by a smaller angle"
    )


def _section_at(panel: Panel, s: float) -> tuple[np.ndarray, np.ndarray]:
    """Outline of the section at s inside of the root, the edges going on straight; x and n of both sides."""
    plan = panel.planform
    share = (s - panel.root - plan.s[0]) / (plan.s[1] - plan.s[0])
    on = lambda values: float(values[0] + share * (values[1] - values[0]))
    lead, chord, thickness = on(plan.lead), on(plan.chord), on(plan.thickness)
    upper, lower = panel.section.outline(chord, thickness)
    both = np.concatenate([upper, lower])
    return both[:, 0] + lead, both[:, 1]


def _panel_solid(panel: Panel, body: Body) -> int:
    """The panel from inside of the body to its tip."""
    plan = panel.planform
    inner = _inner_end(panel, body)
    share = (inner - panel.root) / (plan.s[1] - plan.s[0])
    on = lambda values: float(values[0] + share * (values[1] - values[0]))
    stations = [(inner, on(plan.lead), on(plan.chord), on(plan.thickness))]
    stations += [(panel.root + float(s), *map(float, row)) for s, *row in zip(plan.s[1:], plan.lead[1:], plan.chord[1:], plan.thickness[1:])]
    sections = []
    for s, lead, chord, thickness in stations:
        if chord <= 1e-9:
            sections.append(panel.to_space(np.array([[lead, s, 0.0]])))
            continue
        upper, lower = panel.section.outline(chord, thickness)
        place = lambda side: panel.to_space(np.column_stack([side[:, 0] + lead, np.full(len(side), s), side[:, 1]]))
        sections.append((place(upper), place(lower)))
    return _curved_loft(panel, sections) if panel.section.curved else _faceted_loft(panel, sections)


def _curved_loft(panel: Panel, sections: list) -> int:
    """A ruled loft through sections of two splines each."""
    occ = gmsh.model.occ
    if not isinstance(sections[-1], tuple):
        raise MeshError(f"{panel.where}: a curved section cannot run into a pointed tip; give a small tip_chord")
    wires = []
    for upper, lower in sections:
        front, back = occ.addPoint(*upper[0]), occ.addPoint(*upper[-1])
        side = lambda points, a, b: occ.addSpline([a, *(occ.addPoint(*p) for p in points[1:-1]), b])
        wires.append(occ.addWire([side(upper, front, back), side(lower[::-1], back, front)]))
    made = occ.addThruSections(wires, makeSolid=True, makeRuled=True)
    return next(tag for dimension, tag in made if dimension == 3)


def _faceted_loft(panel: Panel, sections: list) -> int:
    """A solid of plane faces where they are plane, else a ruled loft."""
    outlines = [_polygon(*section) if isinstance(section, tuple) else section for section in sections]
    if _all_plane(outlines):
        return _polyhedron(outlines)
    if len(outlines[-1]) == 1:
        raise MeshError(f"{panel.where}: the faces of '{panel.name}' are twisted and cannot run into a pointed tip; give a small tip_chord")
    occ = gmsh.model.occ
    wires = []
    for outline in outlines:
        tags = [occ.addPoint(*point) for point in outline]
        wires.append(occ.addWire([occ.addLine(a, b) for a, b in zip(tags, tags[1:] + tags[:1])]))
    made = occ.addThruSections(wires, makeSolid=True, makeRuled=True)
    return next(tag for dimension, tag in made if dimension == 3)


def _polygon(upper: np.ndarray, lower: np.ndarray) -> np.ndarray:
    """The closed outline of a section, every corner once."""
    ring = np.concatenate([upper, lower[::-1]])
    keep = np.linalg.norm(ring - np.roll(ring, 1, axis=0), axis=1) > FLAT
    return ring[keep]


def _facets(outlines: list[np.ndarray]) -> list[np.ndarray]:
    """The faces between following outlines, corners in order; triangles at a pointed tip."""
    faces = []
    for one, other in zip(outlines, outlines[1:]):
        for i in range(len(one)):
            j = (i + 1) % len(one)
            corners = [one[i], one[j], other[j], other[i]] if len(other) > 1 else [one[i], one[j], other[0]]
            faces.append(np.array(corners))
    return faces


def _all_plane(outlines: list[np.ndarray]) -> bool:
    for face in _facets(outlines):
        if len(face) == 4:
            normal = np.cross(face[2] - face[0], face[3] - face[1])
            off = abs((face[1] - face[0]) @ normal) / max(np.linalg.norm(normal), 1e-300)
            if off > FLAT:
                return False
    return True


def _polyhedron(outlines: list[np.ndarray]) -> int:
    """A solid of plane faces through the outlines, closed at both ends."""
    occ = gmsh.model.occ
    tags = [[occ.addPoint(*point) for point in outline] for outline in outlines]
    lines: dict[tuple[int, int], int] = {}

    def line(a: int, b: int) -> int:
        if (b, a) in lines:
            return -lines[b, a]
        if (a, b) not in lines:
            lines[a, b] = occ.addLine(a, b)
        return lines[a, b]

    def face(ring: list[int]) -> int:
        return occ.addPlaneSurface([occ.addCurveLoop([line(a, b) for a, b in zip(ring, ring[1:] + ring[:1])])])

    faces = [face(tags[0])]
    for one, other in zip(tags, tags[1:]):
        for i in range(len(one)):
            j = (i + 1) % len(one)
            faces.append(face([one[i], one[j], other[j], other[i]] if len(other) > 1 else [one[i], one[j], other[0]]))
    if len(tags[-1]) > 1:
        faces.append(face(tags[-1]))
    return occ.addVolume([occ.addSurfaceLoop(faces)])


def is_far(domain: Domain, points: np.ndarray) -> bool:
    """Do all of the points (n, 3) lie on the far field?"""
    x, r = points[:, 0], np.hypot(points[:, 1], points[:, 2])
    profile = domain.profile
    if domain.arc:
        middle, radius = 0.5 * profile[:, 0].sum(), 0.5 * np.ptp(profile[:, 0])
        return bool(np.all(np.abs(np.hypot(x - middle, r) - radius) < 1e-3 * radius))
    (end, last), (start, first) = profile[1], profile[2]
    side = np.abs(r - (first + (x - start) * (last - first) / (end - start)))
    return bool(np.all(np.abs(x - end) < 1e-6) or np.all(np.abs(x - start) < 1e-6) or np.all(side < 1e-5 * max(last, 1.0)))


class Classifier:
    """Tells which component the points of a face of the fluid belong to."""

    def __init__(self, missile: Missile, domain: Domain, sector: Sector) -> None:
        self.missile, self.domain, self.sector = missile, domain, sector
        self._outlines = {
            segment.name: np.concatenate([fine(piece.points) for piece in segment.pieces]) for segment in missile.body.segments
        }

    def __call__(self, points: np.ndarray) -> str:
        """The patch of a face, from all its mesh points (n, 3): "symmetry_y", "symmetry_z", "farfield", "base", a
        segment's name, or that of a set of fins."""
        x, y, z = points.T
        r = np.hypot(y, z)
        body = self.missile.body
        for axis, name in ((1, "symmetry_y"), (2, "symmetry_z")):
            if axis in self.sector.planes and np.all(np.abs(points[:, axis]) < 1e-7):
                return name
        if is_far(self.domain, points):
            return "farfield"
        if np.ptp(x) < 1e-7:
            if abs(x[0] - body.length) < 1e-6 and r.max() < body.base_radius + 1e-6:
                return "base"
            step = self._step_at(float(x[0]))
            if step and r.min() > step[0] - 1e-6 and r.max() < step[1] + 1e-6:
                return step[2]
        for name, outline in self._outlines.items():
            within = x.min() > outline[0, 0] - 1e-6 and x.max() < outline[-1, 0] + 1e-6
            if within and np.all(np.abs(r - np.interp(x, outline[:, 0], outline[:, 1])) < ON_BODY):
                return name
        return self._fin(points)

    def _step_at(self, x: float) -> tuple[float, float, str] | None:
        """Radii of a step at x, and its patch: a forward-facing one is a wall, one that faces backwards a base."""
        for one, other in zip(self.missile.body.segments, self.missile.body.segments[1:]):
            low, high = float(one.end[1]), float(other.start[1])
            if abs(x - one.end[0]) < 1e-6 and abs(low - high) > 1e-9:
                return min(low, high), max(low, high), "base" if high < low else other.name
        return None

    def _fin(self, points: np.ndarray) -> str:
        """The set of the panel that the points are nearest to, or "base" for the face of a blunt trailing edge."""
        best, nearest = None, math.inf
        for panel in self.missile.panels:
            local = panel.to_local(points)
            plan = panel.planform
            s = local[:, 1] - panel.root
            off = np.maximum(np.abs(local[:, 2]) - 0.55 * plan.thickness.max() - abs(panel.section.camber) * plan.chord.max(), 0.0)
            off += np.maximum(s - plan.span, 0.0) + np.maximum(-s - panel.root, 0.0)
            lead, trail = (np.interp(np.clip(s, 0.0, plan.span), plan.s, edge) for edge in (plan.lead, plan.trail))
            off += np.maximum(lead - local[:, 0], 0.0) + np.maximum(local[:, 0] - trail, 0.0)
            if off.max() < nearest:
                best, nearest = panel, float(off.max())
                is_end = panel.section.blunt and bool(np.all(np.abs(local[:, 0] - trail) < 1e-5)) and np.ptp(local[:, 1]) > 1e-3 * plan.span
        if best is None or nearest > 0.2:
            raise MeshError(f"a face of the fluid around x = {points[:, 0].mean():.3f} d belongs to no component")
        return "base" if is_end else best.set_name
