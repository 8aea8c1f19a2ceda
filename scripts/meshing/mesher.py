"""From a missile or a shape to its mesh: geometry, sizes and gmsh on one sector, then the mirror images, components, units."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol

import gmsh
import numpy as np

from meshing.background import set_background
from meshing.domain import Domain
from meshing.generator import MESH_ADAPT, generate
from meshing.improvement import relaxed, split_corners
from meshing.limits import LEVELS
from meshing.missile import Missile
from meshing.missile_fluid import MissileFluid
from meshing.quality import check
from meshing.sector import Sector
from meshing.shape import Shape
from meshing.shape_fluid import ShapeFluid
from meshing.sizes import SizeField
from meshing.symmetry import is_symmetric, mirrored
from meshing.tetrahedra import MeshError, TetMesh, oriented

TOLERANCE = 0.12  # of the number of cells; beyond, the mesh is made again
PLANES = {1: "symmetry_y", 2: "symmetry_z"}


class Fluid(Protocol):
    """The fluid of one sector, lengths in diameters: what the mesher wants to know. `unit`: the diameter; `origin`: of the sector's
    coordinates in those of the description."""

    unit: float
    origin: np.ndarray
    domain: Domain
    sector: Sector

    def sizes(self, cells: float) -> SizeField:
        """For meshes of about so many cells in the sector."""

    def build(self) -> None:
        """Make it the current gmsh model."""

    def align(self, sizes: SizeField, h: float) -> None:
        """Say where points of the current model lie in rows; wall cells of h."""

    def box(self) -> np.ndarray:
        """Corners (2, 3) of a box around the body."""

    def patches(self, points: np.ndarray, faces: list[np.ndarray]) -> dict[str, np.ndarray]:
        """The triangles of the model's faces by name, planes of symmetry as in `PLANES`."""

    def components(self, mesh: TetMesh) -> TetMesh:
        """The finished mesh with its patches told apart and in order."""


@dataclass
class Made:
    """A mesh that has been made: in the description's unit, with what is worth telling of it."""

    mesh: TetMesh
    model: str
    h: float | None  # size of cells on the wall, in diameters; None: adapted
    report: list[str] = field(default_factory=list)


def make_mesh(
    subject: Missile | Shape, model: str | None, cells: int, indicators: Sequence[Path] = (), factor: float | None = None
) -> Made:
    """The mesh of about `cells` tetrahedra, as a half or a full model; None: half where the body is symmetric about y = 0.

    `indicators`: files that tell where earlier meshes made errors. `factor`: of all sizes, as one of a family of meshes of one size field;
    they have `cells` over its cube, as far as the field tells. gmsh must be initialised. Raises MeshError.
    """
    fluid: Fluid = ShapeFluid(subject) if isinstance(subject, Shape) else MissileFluid(subject)
    sector, unit = fluid.sector, fluid.unit
    model = model or ("half" if 1 in sector.planes else "full")
    if model == "half" and 1 not in sector.planes:
        raise MeshError("the missile is not symmetric about y = 0, so that it has no half model; use the full one")
    share = 0.5 if model == "half" else 1.0
    sizes = fluid.sizes(LEVELS["coarse"] * 2.0 * sector.share)
    if indicators:
        from meshing.adapted_sizes import AdaptedSizes, read_errors  # what it needs takes a while to come

        errors = [read_errors(path, unit, fluid.origin, sector) for path in indicators]
        sizes = AdaptedSizes(errors, sizes, sector, cells * sector.share / share)
    h = (factor or 1.0) * (sizes.cells(sector) * share / sector.share / cells) ** (1.0 / 3.0)
    for attempt in range(3):
        part = mesh_sector(fluid, sizes, h)
        got = len(part.tets) * share / sector.share
        if factor or abs(got / cells - 1.0) <= TOLERANCE:
            break
        h *= (got / cells) ** (1.0 / 3.0)
    mesh, symmetry = unfolded(part, sector, model)
    mesh = fluid.components(mesh)
    mesh.points = mesh.points * unit + fluid.origin
    report = check(mesh) + symmetry
    if indicators:
        report += [f"sizes adapted to {', '.join(map(str, indicators))}"]
    else:
        report += [f"wall cells of {h * unit:.4g} {subject.unit} = {h:.4f} d, d = {unit:g} {subject.unit}"]
    report += fluid.domain.facts(subject.length, subject.flight, unit)
    return Made(mesh, model, None if indicators else h, report)


def mesh_sector(fluid: Fluid, sizes: SizeField, h: float) -> TetMesh:
    """The mesh of a sector, lengths in diameters."""
    gmsh.model.add("sector")
    try:
        with tempfile.TemporaryDirectory() as folder:
            fluid.build()
            set_background(sizes, h, *boxes(fluid), Path(folder))
            fluid.align(sizes, h)
            if fluid.domain.arc:
                adapt_planes(fluid.sector)
            points, row = generate(None, 3)
        triangles_of = lambda face: row[gmsh.model.mesh.getElementsByType(2, face)[1].astype(np.int64)].reshape(-1, 3)
        faces = [triangles_of(face) for _, face in gmsh.model.getEntities(2)]
        tets = row[gmsh.model.mesh.getElementsByType(4)[1].astype(np.int64)].reshape(-1, 4)
    finally:
        gmsh.model.remove()
    mesh = TetMesh(points, tets, fluid.patches(points, [face for face in faces if len(face)]))
    for axis in fluid.sector.planes:
        points[mesh.patches[PLANES[axis]], axis] = 0.0
    return relaxed(split_corners(oriented(mesh)), below=0.3)


def adapt_planes(sector: Sector) -> None:
    """Another algorithm for the faces on planes of symmetry: where sizes grow a thousandfold to a sphere, the usual one stops while triangles
    beside the body are still many times too long."""
    for _, face in gmsh.model.getEntities(2):
        low, high = np.reshape(gmsh.model.getBoundingBox(2, face), (2, 3))
        if any(max(abs(low[axis]), abs(high[axis])) < 1e-6 for axis in sector.planes):
            gmsh.model.mesh.setAlgorithm(2, face, MESH_ADAPT)


def boxes(fluid: Fluid) -> tuple[np.ndarray, np.ndarray]:
    """Corners (2, 3) of a box around the body, and of one around the fluid, within the sector's planes of symmetry."""
    near = fluid.box() + 0.3 * np.array([[-1.0], [1.0]])
    profile = fluid.domain.profile
    wide = 0.5 * float(np.ptp(profile[:, 0])) if fluid.domain.arc else float(profile[:, 1].max())
    far = np.array([[profile[:, 0].min(), -wide, -wide], [profile[:, 0].max(), wide, wide]])
    far += 0.01 * np.ptp(far, axis=0) * [[-1.0], [1.0]]
    for box in (near, far):
        for axis in fluid.sector.planes:
            box[0, axis] = -1e-3
    return near, far


def unfolded(part: TetMesh, sector: Sector, model: str) -> tuple[TetMesh, list[str]]:
    """The half y >= 0 or all of it, from a sector and its mirror images, and what was found of their symmetry."""
    mesh, lines = part, []
    for axis in sector.planes[::-1]:
        if axis == 1 and model == "half":
            continue
        mesh = mirrored(mesh, axis, PLANES[axis])
    patches = {name: patch for name, patch in mesh.patches.items() if name not in PLANES.values()}
    if PLANES[1] in mesh.patches:
        patches["symmetry"] = mesh.patches[PLANES[1]]
    mesh = TetMesh(mesh.points, mesh.tets, patches)
    for axis in sector.planes:
        if axis == 1 and model == "half":
            continue
        if not is_symmetric(mesh, axis):
            raise MeshError(f"the mesh is not its own mirror image about {'xyz'[axis]} = 0")
        lines.append(f"mirror image about {'xyz'[axis]} = 0: identical bit for bit")
    return mesh, lines
