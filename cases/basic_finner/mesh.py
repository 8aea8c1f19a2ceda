#!/usr/bin/python3
"""Mesh of the Army-Navy Basic Finner: cone, cylinder and four single-wedge fins in a conical supersonic far field.

Lengths are in body diameters; x aft from the nose tip, y starboard, z up; fins in the planes y = 0 and z = 0. gmsh meshes the
quarter y, z >= 0; the half and full models are its exact mirror images. One size h scales every cell, so that the levels are a
family for convergence studies. Needs the Debian packages python3-gmsh and python3-numpy (hence /usr/bin/python3).
"""

from __future__ import annotations

import argparse
import csv
import math
import sys
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "scripts"))

try:
    import gmsh
    import numpy as np

    from meshing import toolbox as meshing
except ImportError as error:
    sys.exit(f"mesh.py: {error}; install the Debian packages python3-gmsh and python3-numpy and run with /usr/bin/python3")

# Body surface cell size h in d. The half model has about 100, 250 and 700 thousand tetrahedra.
LEVELS = {"coarse": 0.08, "medium": 0.057, "fine": 0.0395}

# Far field: a frustum outside the bow shock for M >= 1.5 and |alpha| <= 2.5 deg, whose waves therefore never come back.
FAR_START, FAR_RADIUS, FAR_ANGLE, FAR_END = -0.6, 0.35, 47.0, 11.5


@dataclass(frozen=True)
class Finner:
    """Dimensions in d, and the nose half-angle in degrees."""

    radius: float
    length: float
    nose_angle: float
    chord: float
    tip: float
    half_thickness: float

    @staticmethod
    def read(path: Path) -> Finner:
        with open(path) as file:
            rows = {row["item"]: row["value"] for row in csv.DictReader(line for line in file if not line.startswith("#"))}

        def value(item: str) -> float:
            try:
                return float(rows[item])
            except (KeyError, ValueError):
                raise meshing.MeshError(f"{path}: needs a line '{item},<number>,...'") from None

        radius = 0.5 * value("body_diameter")
        return Finner(
            radius, value("total_length"), value("nose_half_angle"), value("fin_chord"),
            radius + value("fin_exposed_span"), 0.5 * value("fin_trailing_thickness"),
        )  # fmt: skip

    @property
    def nose_length(self) -> float:
        return self.radius / math.tan(math.radians(self.nose_angle))

    @property
    def leading_edge(self) -> float:
        return self.length - self.chord

    def exact_areas(self, sting: bool) -> dict[str, float]:
        """Areas of the whole configuration in d^2; the fins stand on the cylinder, so their roots are curved."""
        nodes, weights = np.polynomial.legendre.leggauss(20)
        s, w = 0.5 * (nodes + 1.0), 0.5 * weights
        half = self.half_thickness * s  # half thickness of the fin along its chord, or distance from its midplane at the base
        root = np.sqrt(self.radius**2 - half**2)
        footprints = 4 * self.chord * (w @ (2.0 * self.radius * np.arcsin(half / self.radius)))
        cone = math.pi * self.radius * math.hypot(self.radius, self.nose_length)
        cylinder = 2.0 * math.pi * self.radius * (self.length - self.nose_length)
        sides = 8 * math.hypot(self.chord, self.half_thickness) * (w @ (self.tip - root))
        tips = 4 * self.chord * self.half_thickness
        blunt = 8 * self.half_thickness * (w @ (self.tip - root))
        base = blunt if sting else math.pi * self.radius**2 + blunt
        return {"body": cone + cylinder - footprints, "fins": sides + tips, "base": base}


def build_quarter(finner: Finner, sting: bool) -> None:
    """Make the fluid of the quarter y, z >= 0 the current gmsh model (OpenCASCADE)."""
    occ = gmsh.model.occ
    far_radius = FAR_RADIUS + (FAR_END - FAR_START) * math.tan(math.radians(FAR_ANGLE))
    wake = [(FAR_END, finner.radius)] if sting else [(finner.length, 0.0), (FAR_END, 0.0)]
    profile = [(0.0, 0.0), (finner.nose_length, finner.radius), (finner.length, finner.radius), *wake,
               (FAR_END, far_radius), (FAR_START, FAR_RADIUS), (FAR_START, 0.0)]  # fmt: skip
    points = [occ.addPoint(x, r, 0.0) for x, r in profile]
    lines = [occ.addLine(a, b) for a, b in zip(points, points[1:] + points[:1])]
    face = occ.addPlaneSurface([occ.addCurveLoop(lines)])
    fluid = [entity for entity in occ.revolve([(2, face)], 0, 0, 0, 1, 0, 0, math.pi / 2) if entity[0] == 3]

    fins = []
    for angle in (0.0, math.pi / 2):
        half = finner.half_thickness
        section = [(finner.leading_edge, 0.0), (finner.length, -half), (finner.length, half)]
        points = [occ.addPoint(x, 0.5 * finner.radius, z) for x, z in section]
        lines = [occ.addLine(a, b) for a, b in zip(points, points[1:] + points[:1])]
        face = occ.addPlaneSurface([occ.addCurveLoop(lines)])
        extruded = occ.extrude([(2, face)], 0, finner.tip - 0.5 * finner.radius, 0)
        # Cut at a cylinder longer than the body: the fin then shares no plane face with the base disc.
        inner = occ.addCylinder(finner.leading_edge - 1.0, 0, 0, finner.chord + 2.0, 0, 0, finner.radius)
        fin, _ = occ.cut([entity for entity in extruded if entity[0] == 3], [(3, inner)])
        occ.rotate(fin, 0, 0, 0, 1, 0, 0, angle)
        fins += fin
    occ.cut(fluid, fins)
    occ.synchronize()


def size_field(finner: Finner, h: float, sting: bool) -> meshing.SizeField:
    """The size of cells wanted at a point, in d, proportional to h."""
    radius, nose, lead, tail, tip = finner.radius, finner.nose_length, finner.leading_edge, finner.length, finner.tip
    slope = radius / nose

    def grown(start: float, distance: float) -> float:
        return start + 2.2 * distance + distance * distance

    def size(_dimension: int, _tag: int, x: float, y: float, z: float) -> float:
        r = math.hypot(y, z)
        # Nothing matters ahead of the nose and behind the base in supersonic flow: cells grow there twice as fast.
        ahead, behind = 2.0 * max(-x, 0.0), 2.0 * max(x - tail, 0.0)
        # Body: h, and on the nose smaller with the local circumference; the expansion starts at the end of the nose.
        surface = 1.0 - 0.85 * max(0.0, 1.0 - max(x, 0.0) / 2.0)
        distance = math.hypot(ahead, behind, max(r - min(slope * max(x, 0.0), radius), 0.0))
        wanted = min(grown(surface, distance), 0.6 + 2.0 * math.hypot(x - nose, r - radius), 14.0)
        # Fins: smaller still at the leading edge and the tip.
        along = max(lead - x, behind, 0.0)
        for span, across in ((y, z), (z, y)):
            beyond = max(radius - span, span - tip, 0.0)
            distance = math.hypot(along, beyond, across)
            edge = min(math.hypot(x - lead, beyond, across), math.hypot(along, span - tip, across))
            wanted = min(wanted, grown(0.75, distance), 0.4 + 1.5 * edge + 2.0 * distance)
        if sting and x > tail:  # enough for a round sting
            wanted = min(wanted, grown(2.5, max(r - radius, 0.0)))
        return h * wanted

    return size


def patch_name(finner: Finner, points: np.ndarray, sting: bool) -> str:
    """The patch of a CAD face, from all its mesh points (n, 3)."""
    tolerance = 1e-7
    x, y, z = points.T
    r = np.hypot(y, z)
    everywhere = lambda residual: bool(np.all(np.abs(residual) < tolerance))
    wedge = finner.half_thickness * (x - finner.leading_edge) / finner.chord
    if everywhere(y):
        return "symmetry_y"
    if everywhere(z):
        return "symmetry_z"
    if everywhere(x - finner.length):
        return "base"
    if everywhere(r - np.minimum(x / finner.nose_length, 1.0) * finner.radius):
        return "sting" if sting and x.min() > finner.length - tolerance else "body"
    if any(everywhere(residual) for residual in (y - finner.tip, z - finner.tip, z - wedge, y - wedge)):
        return "fins"
    return "farfield"


def build(h: float, arguments: argparse.Namespace) -> tuple[meshing.TetMesh, list[str]]:
    """The mesh, and lines that compare it with the exact geometry."""
    finner, sting = Finner.read(HERE / "geometry.csv"), arguments.base == "sting"
    gmsh.model.add("quarter")
    build_quarter(finner, sting)
    quarter = meshing.mesh_quarter(size_field(finner, h, sting), lambda points: patch_name(finner, points, sting))
    order = ["body", "fins", "base", "sting", "symmetry_y", "symmetry_z", "farfield"]
    quarter.patches = {name: quarter.patches[name] for name in order if name in quarter.patches}
    mesh, symmetry = meshing.unfolded(quarter, arguments.model)
    share = meshing.MODELS[arguments.model]
    exact = {name: share * area for name, area in finner.exact_areas(sting).items()}
    x, y, z = mesh.points[np.unique(mesh.patches["body"])].T
    deviation = np.abs(np.hypot(y, z) - np.minimum(x / finner.nose_length, 1.0) * finner.radius).max()
    true = f"body points at most {deviation:.1e} d off the true cone and cylinder"
    return mesh, [*meshing.patch_report(mesh, exact), true, *symmetry]


def main() -> None:
    parser = meshing.command_line(__doc__, LEVELS, "body diameter d")
    parser.add_argument("--model", choices=meshing.MODELS, default="half", help="half is y >= 0 (default)")
    parser.add_argument("--base", choices=("jet", "sting"), default="jet", help="sting: the cylinder goes on to the outflow")
    meshing.run(parser, LEVELS, build)


if __name__ == "__main__":
    main()
