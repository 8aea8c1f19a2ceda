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
import os
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "scripts"))

try:
    import gmsh
    import numpy as np

    import meshing
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

    def exact_areas(self) -> dict[str, float]:
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
        disc = math.pi * self.radius**2
        return {"body": cone + cylinder - footprints, "fins": sides + tips, "base": disc + blunt, "blunt": blunt}


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
    if len(gmsh.model.getEntities(3)) != 1:
        raise meshing.MeshError("the quarter of the fluid is not one volume")


def size_field(finner: Finner, h: float, sting: bool) -> Callable[[int, int, float, float, float], float]:
    """The size of cells wanted at a point, in d, as gmsh's callback (dimension, tag, x, y, z) -> size; proportional to h."""
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


def mesh_quarter(finner: Finner, h: float, sting: bool) -> meshing.TetMesh:
    """Mesh the quarter; its points on the planes y = 0 and z = 0 are exactly there."""
    gmsh.model.add("quarter")
    build_quarter(finner, sting)
    options = {
        "General.NumThreads": 1, "Mesh.RandomSeed": 1,  # the same input gives the same mesh
        "Mesh.MeshSizeExtendFromBoundary": 0, "Mesh.MeshSizeFromPoints": 0, "Mesh.MeshSizeFromCurvature": 0,
        "Mesh.Algorithm": 6, "Mesh.Algorithm3D": 1, "Mesh.OptimizeThreshold": 0.6,
    }  # fmt: skip
    for name, value in options.items():
        gmsh.option.setNumber(name, value)
    gmsh.model.mesh.setSizeCallback(size_field(finner, h, sting))
    gmsh.model.mesh.generate(3)
    gmsh.model.mesh.removeSizeCallback()

    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    row = np.zeros(int(tags.max()) + 1, dtype=np.int64)
    row[tags.astype(np.int64)] = np.arange(len(tags))
    points = coordinates.reshape(-1, 3).copy()
    patches: dict[str, list[np.ndarray]] = {}
    for _, face in gmsh.model.getEntities(2):
        triangles = row[gmsh.model.mesh.getElementsByType(2, face)[1].astype(np.int64)].reshape(-1, 3)
        patches.setdefault(patch_name(finner, points[triangles.ravel()], sting), []).append(triangles)
    tets = row[gmsh.model.mesh.getElementsByType(4)[1].astype(np.int64)].reshape(-1, 4)
    gmsh.model.remove()
    mesh = meshing.TetMesh(points, tets, {name: np.concatenate(parts) for name, parts in patches.items()})
    for name, axis in (("symmetry_y", 1), ("symmetry_z", 2)):
        points[mesh.patches[name], axis] = 0.0
    return meshing.relaxed(meshing.split_corners(meshing.oriented(mesh)))


def assemble(quarter: meshing.TetMesh, model: str) -> meshing.TetMesh:
    """The quarter, half or full model, with its symmetry planes in the one patch `symmetry`."""
    mesh = quarter
    if model in ("half", "full"):
        mesh = meshing.mirrored(mesh, 2, "symmetry_z")
    if model == "full":
        mesh = meshing.mirrored(mesh, 1, "symmetry_y")
    planes = [mesh.patches.pop(name) for name in ("symmetry_y", "symmetry_z") if name in mesh.patches]
    if planes:
        mesh.patches["symmetry"] = np.concatenate(planes)
    order = ["body", "fins", "base", "sting", "symmetry", "farfield"]
    return meshing.TetMesh(mesh.points, mesh.tets, {name: mesh.patches[name] for name in order if name in mesh.patches})


def report(finner: Finner, mesh: meshing.TetMesh, model: str, sting: bool) -> list[str]:
    """Lines that compare the patches with the exact geometry, and check the symmetry."""
    share = {"quarter": 0.25, "half": 0.5, "full": 1.0}[model]
    exact = finner.exact_areas()
    exact["base"] = exact["blunt"] if sting else exact["base"]
    lines = []
    for name, patch in mesh.patches.items():
        area = np.linalg.norm(meshing.area_vectors(mesh.points, patch), axis=1).sum()
        line = f"{name}: {len(patch)} triangles, area {area:.6f} d^2"
        if name in exact:
            line += f", exact {share * exact[name]:.6f} ({100 * (area / (share * exact[name]) - 1):+.3f} %)"
        lines.append(line)
    x, y, z = mesh.points[np.unique(mesh.patches["body"])].T
    deviation = np.abs(np.hypot(y, z) - np.minimum(x / finner.nose_length, 1.0) * finner.radius).max()
    lines.append(f"body points at most {deviation:.1e} d off the true cone and cylinder")
    axes = {"quarter": {}, "half": {"z": 2}, "full": {"y": 1, "z": 2}}[model]
    for name, axis in axes.items():
        if not meshing.is_symmetric(mesh, axis):
            raise meshing.MeshError(f"the mesh is not its own mirror image about {name} = 0")
        lines.append(f"mirror image about {name} = 0: identical bit for bit")
    return lines


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], epilog="Lengths are in body diameters.")
    sizes = parser.add_mutually_exclusive_group()
    sizes.add_argument("--level", choices=LEVELS, default="coarse", help="named size (default: coarse)")
    known = ", ".join(f"{name} {size}" for name, size in LEVELS.items())
    sizes.add_argument("--size", type=float, metavar="S", help=f"cell size h on the body in d, instead of a level's: {known}")
    parser.add_argument("--model", choices=("quarter", "half", "full"), default="half", help="half is y >= 0 (default)")
    parser.add_argument("--base", choices=("jet", "sting"), default="jet", help="sting: the cylinder goes on to the outflow")
    parser.add_argument("--format", choices=("4.1", "2.2"), default="4.1", help="version of the .msh file (default: 4.1)")
    parser.add_argument("--ascii", action="store_true", help="text instead of binary")
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="FILE.msh")
    arguments = parser.parse_args()
    h = LEVELS[arguments.level] if arguments.size is None else arguments.size
    if not 0.02 <= h <= 0.2:
        parser.error(f"--size {h} is outside 0.02 to 0.2")
    if arguments.output.suffix != ".msh":
        parser.error(f"the output '{arguments.output}' must end in .msh")
    if not os.access(arguments.output.resolve().parent, os.W_OK):
        parser.error(f"cannot write in the folder '{arguments.output.resolve().parent}'")

    start = time.perf_counter()
    gmsh.initialize(readConfigFiles=False)  # a user's settings would change the mesh
    gmsh.option.setNumber("General.Terminal", 0)
    sting = arguments.base == "sting"
    try:
        finner = Finner.read(HERE / "geometry.csv")
        mesh = assemble(mesh_quarter(finner, h, sting), arguments.model)
        lines = meshing.check(mesh) + report(finner, mesh, arguments.model, sting)
        meshing.write(mesh, arguments.output, arguments.format, arguments.ascii)
    except Exception as error:  # gmsh raises bare Exception
        sys.exit(f"mesh.py: {error}")
    finally:
        gmsh.finalize()
    print(f"{arguments.output}: {arguments.model} model, base {arguments.base}, h = {h} d, {time.perf_counter() - start:.1f} s")
    print("\n".join(lines))


if __name__ == "__main__":
    main()
