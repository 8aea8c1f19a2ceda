#!/usr/bin/python3
"""Wedge and cone on hexahedra and prisms made by Gmsh: derivatives within the errors that as many tetrahedra have.

A plane section of the flow is meshed by quadrilaterals or triangles and swept aside (the wedge) or round the axis (the cone), which
makes hexahedra or prisms, and at the axis prisms, pyramids and tetrahedra; alphadot cuts them. The tetrahedra beside them are Gmsh's
own in the same space. The stream is supersonic, and the mesh ends at the base. Exact values: cases/*/reference.
"""

from __future__ import annotations

import math
import tempfile
import unittest
from dataclasses import dataclass
from pathlib import Path

import gmsh

from exact_case import ExactCase, cone_derivatives, run, table

from exact import Longitudinal

NAMES = ("CN_alpha", "CN_q", "Cm_q", "CN_alphadot", "Cm_alphadot")
KINDS = ("hexahedra", "prisms", "tetrahedra")
SIZE = 0.06  # of the cells
FRONT, APEX, BASE = -0.12, 0.0, 1.0  # along x


@dataclass(frozen=True)
class Body:
    mach: float
    half_angle: float  # degrees
    height: float  # of the far field
    center: float  # of moments
    exact: dict[str, float]

    @property
    def slope(self) -> float:
        return math.tan(math.radians(self.half_angle))


CASE = """
[mesh]
file = "mesh.msh"
[reference]
length = 1.0
area = 1.0
moment_center = [0.0, 0, 0]
model = "half"
[freestream]
mach = 2.0
[boundary]
body = "wall"
symmetry = "symmetry"
farfield = "farfield"
"""
WEDGE = Body(
    2.0, 5.0, 0.8, 0.5,
    next(row for row in table("wedge/reference/exact_wedge_derivatives.csv") if row["axis_x_over_c"] == 0.5),
)  # fmt: skip
CONE = Body(2.5, 10.0, 0.6, 2.0 / 3.0, cone_derivatives())


def plane_section(body: Body, side: int, kind: str) -> list[int]:
    """Surfaces of the flow above (side = 1) or below the body in the plane y = 0: ahead of it and beside it."""
    geo = gmsh.model.geo
    z = side * body.height
    at = {
        "front": (FRONT, 0.0), "apex": (APEX, 0.0), "base": (BASE, side * body.slope),
        "far base": (BASE, z), "far apex": (APEX, z), "far front": (FRONT, z),
    }  # fmt: skip
    points = {name: geo.addPoint(x, 0.0, height, SIZE) for name, (x, height) in at.items()}

    def line(a: str, b: str, length: float) -> int:
        curve = geo.addLine(points[a], points[b])
        if kind != "tetrahedra":
            geo.mesh.setTransfiniteCurve(curve, max(2, round(length / SIZE)) + 1)
        return curve

    middle = line("apex", "far apex", body.height)
    loops = [
        [line("front", "apex", -FRONT), middle, line("far apex", "far front", -FRONT), line("far front", "front", body.height)],
        [line("apex", "base", BASE), line("base", "far base", body.height), line("far base", "far apex", BASE), -middle],
    ]
    surfaces = [geo.addPlaneSurface([geo.addCurveLoop(loop)]) for loop in loops]
    if kind == "hexahedra":
        for surface in surfaces:
            geo.mesh.setTransfiniteSurface(surface)
            geo.mesh.setRecombine(2, surface)
    return surfaces


def make_mesh(body: Body, kind: str, path: Path) -> float:
    """Writes the half model; returns its width, that of the slab of a wedge."""
    geo = gmsh.model.geo
    recombined = kind != "tetrahedra"
    width = 2.0 * SIZE
    sides = (1,) if body is CONE else (1, -1)
    section = [(2, surface) for side in sides for surface in plane_section(body, side, kind)]
    if body is WEDGE:
        geo.removeAllDuplicates()
        geo.extrude(section, 0, width, 0, [2] if recombined else [], [], recombined)
    else:
        for _ in range(2):  # two quarters of a turn, from z up by way of y
            layers = [round(0.25 * math.pi / 2.0 / SIZE)] if recombined else []
            swept = geo.revolve(section, 0, 0, 0, 1, 0, 0, -math.pi / 2.0, layers, [], recombined)
            section = [swept[i - 1] for i, (dimension, _) in enumerate(swept) if dimension == 3]
    geo.synchronize()
    volumes = gmsh.model.getEntities(3)
    groups: dict[str, list[int]] = {"body": [], "symmetry": [], "farfield": []}
    near = 1e-4
    for _, surface in gmsh.model.getBoundary(volumes, combined=True, oriented=False):
        low, high = (gmsh.model.getBoundingBox(2, surface)[i : i + 3] for i in (0, 3))
        if high[1] < near or (body is WEDGE and low[1] > width - near):
            groups["symmetry"].append(surface)
        elif low[0] > APEX - near and max(-low[2], high[2]) < body.slope + near:
            groups["body"].append(surface)
        else:
            groups["farfield"].append(surface)
    for name, surfaces in groups.items():
        gmsh.model.setPhysicalName(2, gmsh.model.addPhysicalGroup(2, surfaces), name)
    gmsh.model.setPhysicalName(3, gmsh.model.addPhysicalGroup(3, [tag for _, tag in volumes]), "air")
    gmsh.model.mesh.generate(3)
    gmsh.write(str(path))
    return width


class Elements(ExactCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def errors(self, body: Body, kind: str) -> tuple[dict[str, float], int]:
        """Relative, about the apex, and the number of cells."""
        mesh, case = self.folder / f"{kind}.msh", self.folder / "case.toml"
        gmsh.initialize()
        try:
            gmsh.option.setNumber("General.Terminal", 0)
            width = make_mesh(body, kind, mesh)
        finally:
            gmsh.finalize()
        case.write_text(CASE)
        settings = {
            "freestream.mach": body.mach,
            "reference.area": 2.0 * width if body is WEDGE else math.pi * body.slope**2,
            "reference.moment_center": f"[{body.center}, 0, 0]",
        }
        result = run(self.folder / kind, "derivatives", str(case), str(mesh), settings)
        values = {name: entry["value"] for name, entry in result["derivatives"].items()}
        found, exact = (Longitudinal.of(d).about(-body.center).as_dict() for d in (values, body.exact))
        return {name: found[name] / exact[name] - 1.0 for name in NAMES}, result["mesh"]["cells"]

    def compare(self, body: Body, limit: float) -> None:
        """Errors count together, since some change sign with the size of the cells: within those of tetrahedra, and below `limit`."""
        together, cells = {}, {}
        for kind in KINDS:
            errors, cells[kind] = self.errors(body, kind)
            together[kind] = math.hypot(*errors.values()) / math.sqrt(len(errors))
            print(f"{cells[kind]} cells of {kind}: {together[kind]:.2%};", ", ".join(f"{k} {v:+.2%}" for k, v in errors.items()))
        for kind in KINDS[:2]:
            with self.subTest(kind):
                self.assertLess(cells[kind], 1.25 * cells["tetrahedra"])
                self.assertLess(together[kind], 1.1 * together["tetrahedra"])
                self.assertLess(together[kind], limit)

    def test_wedge(self) -> None:
        self.compare(WEDGE, 0.02)

    def test_cone(self) -> None:
        self.compare(CONE, 0.05)


if __name__ == "__main__":
    unittest.main()
