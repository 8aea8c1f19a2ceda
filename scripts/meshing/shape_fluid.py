"""The fluid around a body that is known by its surface alone, for the mesher.

A body from CAD is cut out of the far field by OpenCASCADE. A triangulation is divided along its sharp edges, given parameters patch by
patch and meshed anew by gmsh; the far field around it, and the plane of symmetry of a half, are made of gmsh's own curves.
"""

from __future__ import annotations

import gmsh
import numpy as np

from meshing.cad import ASKEW, Nearest, import_solids, turned_and_moved, united
from meshing.charts import charted, half_of
from meshing.domain import Domain, domain_of
from meshing.geometry import is_far, outer_solids
from meshing.sector import ALL, QUARTER, STARBOARD, UPPER, Sector
from meshing.shape import Shape
from meshing.shape_sizes import ShapeSizes
from meshing.sizes import SizeField, size_field
from meshing.surface import Surface
from meshing.tetrahedra import MeshError, TetMesh

WHOLE = 0.9  # share of a face's triangles on one component for which all of them are


class ShapeFluid:
    """What the mesher wants to know of it; lengths in diameters. See mesher.Fluid."""

    def __init__(self, shape: Shape) -> None:
        self.unit = shape.diameter
        symmetric = shape.is_symmetric(1), shape.is_symmetric(2) and shape.cad is not None
        self.sector = {(True, True): QUARTER, (True, False): STARBOARD, (False, True): UPPER, (False, False): ALL}[symmetric]
        self.shape, self.origin = shape.in_diameters()
        self.domain = domain_of(self.shape.envelope())
        self._nearest = Nearest(self.shape.surface)

    def sizes(self, cells: float) -> SizeField:
        first = ShapeSizes(self.shape, self.domain)
        return size_field(first.with_stretch, self.sector, cells)

    def build(self) -> None:
        if self.shape.cad is None:
            _build_around_triangles(self.shape.surface, self.shape.sharp, self.domain, self.sector)
        else:
            self._build_around_cad()

    def _build_around_cad(self) -> None:
        occ, axes = gmsh.model.occ, self.shape.to_axes
        body = united(import_solids(self.shape.cad, float(np.cbrt(np.linalg.det(axes[:, :3])))))
        turned_and_moved(body, axes)
        # Piece by piece, which divides the body's faces too: gmsh needs that where one goes all around a pointed tip.
        fluids = []
        for piece in outer_solids(self.domain, self.sector, ASKEW):
            left, _ = occ.cut([piece], body, removeTool=False)
            fluids += [entity for entity in left if entity[0] == 3]
        occ.remove(body, recursive=True)
        gmsh.option.setNumber("Geometry.OCCUnionUnify", 0)
        if len(fluids) > 1:
            fluids, _ = occ.fuse(fluids[:1], fluids[1:])
        occ.synchronize()
        if not self._walls():
            raise MeshError("OpenCASCADE cannot cut the body out of the fluid; export it anew as one solid, or as STL")
        if len([entity for entity in fluids if entity[0] == 3]) != 1:
            raise MeshError(f"the fluid falls into {len(fluids)} parts: is the body hollow, or in several pieces?")

    def _walls(self) -> bool:
        """Has the current model faces between the body's ends, off the planes of symmetry?"""
        reach = np.abs(self.shape.surface.points).max() + 0.1
        boxes = (gmsh.model.getBoundingBox(*face) for face in gmsh.model.getEntities(2))
        return any(max(map(abs, box)) < reach for box in boxes)

    def align(self, sizes: SizeField, h: float) -> None:
        """Nothing is known of its meridians."""

    def box(self) -> np.ndarray:
        points = self.shape.surface.points
        return np.array([points.min(axis=0), points.max(axis=0)])

    def patches(self, points: np.ndarray, faces: list[np.ndarray]) -> dict[str, np.ndarray]:
        names = self.shape.surface.names
        parts: dict[str, list[np.ndarray]] = {}
        for triangles in faces:
            own = points[triangles.ravel()]
            plane = next((axis for axis in self.sector.planes if np.all(np.abs(own[:, axis]) < 1e-7)), None)
            if plane is not None:
                parts.setdefault({1: "symmetry_y", 2: "symmetry_z"}[plane], []).append(triangles)
            elif is_far(self.domain, own):
                parts.setdefault("farfield", []).append(triangles)
            else:
                on = self._components(points[triangles])
                for number in np.unique(on):
                    parts.setdefault(names[number], []).append(triangles[on == number])
        return {name: np.concatenate(patch) for name, patch in parts.items()}

    def _components(self, corners: np.ndarray) -> np.ndarray:
        """Of a face's triangles, which all point out of the body or all into it."""
        inward = corners[:, [0, 2, 1]]
        on = self._nearest(corners if self._nearest.misfit(corners[:50]) < self._nearest.misfit(inward[:50]) else inward)
        number, count = np.unique(on, return_counts=True)
        return np.full(len(on), number[np.argmax(count)]) if count.max() > WHOLE * len(on) else on

    def components(self, mesh: TetMesh) -> TetMesh:
        """The patches in the order of the file."""
        order = [name for name in self.shape.surface.names if name != "base"] + ["base", "symmetry", "farfield"]
        return TetMesh(mesh.points, mesh.tets, {name: mesh.patches[name] for name in order if name in mesh.patches})


def _build_around_triangles(surface: Surface, sharp: float, domain: Domain, sector: Sector) -> None:
    """Make the fluid the current gmsh model."""
    half = sector is STARBOARD
    part, patch = charted(half_of(surface) if half else surface, sharp, ASKEW)
    for number in range(int(patch.max()) + 1):
        gmsh.model.addDiscreteEntity(2, number + 1)
        if number == 0:
            gmsh.model.mesh.addNodes(2, 1, np.arange(1, len(part.points) + 1), part.points.ravel())
        own = np.flatnonzero(patch == number)
        gmsh.model.mesh.addElementsByType(number + 1, 2, own + 1, (part.triangles[own] + 1).ravel())
    gmsh.model.mesh.createTopology()
    gmsh.model.mesh.createGeometry()
    body = [face for _, face in gmsh.model.getEntities(2)]
    rim = [curve for _, curve in gmsh.model.getEntities(1) if half and _on_plane(curve)]
    outer, outline = _far_field(domain, half)
    geo = gmsh.model.geo
    if half:
        plane = geo.addPlaneSurface([geo.addCurveLoop(outline), *(geo.addCurveLoop(loop, reorient=True) for loop in _loops(rim))])
        bounds = [geo.addSurfaceLoop([*outer, plane, *body])]
    else:
        bounds = [geo.addSurfaceLoop(outer), geo.addSurfaceLoop(body)]
    geo.addVolume(bounds)
    geo.synchronize()


def _on_plane(curve: int) -> bool:
    _, coordinates, _ = gmsh.model.mesh.getNodes(1, curve, includeBoundary=True)
    return bool(np.all(np.abs(coordinates.reshape(-1, 3)[:, 1]) < 1e-12))


def _loops(curves: list[int]) -> list[list[int]]:
    """The curves in closed rows that hang together."""
    ends = {curve: {point for _, point in gmsh.model.getBoundary([(1, curve)], oriented=False)} for curve in curves}
    loops: list[list[int]] = []
    left = list(curves)
    while left:
        loop = [left.pop(0)]
        reached = set(ends[loop[0]])
        while following := [curve for curve in left if ends[curve] & reached]:
            for curve in following:
                left.remove(curve)
                loop.append(curve)
                reached |= ends[curve]
        loops.append(loop)
    return loops


def _far_field(domain: Domain, half: bool) -> tuple[list[int], list[int]]:
    """The far field's faces, and the closed outline that a half has on y = 0."""
    geo = gmsh.model.geo
    quarters = 2 if half else 4
    # From straight down through starboard upwards.
    angle = np.radians(-90.0 + 90.0 * np.arange(quarters + (1 if half else 0)))

    def ring(x: float, radius: float) -> tuple[int, list[int], list[int]]:
        centre = geo.addPoint(x, 0.0, 0.0)
        points = [geo.addPoint(x, 0.0 if abs(np.cos(a)) < 1e-9 else radius * np.cos(a), radius * np.sin(a)) for a in angle]
        following = points[1:] if half else points[1:] + points[:1]
        return centre, points, [geo.addCircleArc(a, centre, b) for a, b in zip(points, following)]

    if domain.arc:
        middle, radius = 0.5 * float(domain.profile[:, 0].sum()), 0.5 * float(np.ptp(domain.profile[:, 0]))
        centre, points, arcs = ring(middle, radius)
        front, back = geo.addPoint(middle - radius, 0.0, 0.0), geo.addPoint(middle + radius, 0.0, 0.0)
        to_front = [geo.addCircleArc(point, centre, front) for point in points]
        to_back = [geo.addCircleArc(point, centre, back) for point in points]
        faces = []
        for i, arc in enumerate(arcs):
            j = (i + 1) % len(points)
            for meridians in (to_front, to_back):
                faces.append(geo.addSurfaceFilling([geo.addCurveLoop([arc, meridians[j], -meridians[i]])], sphereCenterTag=centre))
        return faces, [to_front[0], -to_front[-1], to_back[-1], -to_back[0]] if half else []
    (end, last), (start, first) = domain.profile[1], domain.profile[2]
    _, far, far_arcs = ring(float(end), float(last))
    _, near, near_arcs = ring(float(start), float(first))
    sides = [geo.addLine(a, b) for a, b in zip(near, far)]
    faces = []
    for i, (arc, other) in enumerate(zip(near_arcs, far_arcs)):
        j = (i + 1) % len(near)
        faces.append(geo.addSurfaceFilling([geo.addCurveLoop([arc, sides[j], -other, -sides[i]])]))
    if not half:
        faces += [geo.addPlaneSurface([geo.addCurveLoop(arcs)]) for arcs in (near_arcs, far_arcs)]
        return faces, []
    closing = [geo.addLine(points[-1], points[0]) for points in (near, far)]
    faces += [geo.addPlaneSurface([geo.addCurveLoop([*arcs, line])]) for arcs, line in zip((near_arcs, far_arcs), closing)]
    return faces, [closing[0], sides[0], -closing[1], -sides[-1]]
