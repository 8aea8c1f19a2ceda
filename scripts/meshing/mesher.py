"""From a missile to its mesh: geometry, sizes and gmsh on one sector, then the mirror images, panels told apart, units."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass, field
from pathlib import Path

import gmsh
import numpy as np

from meshing.background import set_background
from meshing.domain import Domain, domain_of
from meshing.generator import generate
from meshing.geometry import Classifier, build_fluid
from meshing.improvement import relaxed, split_corners
from meshing.limits import LEVELS
from meshing.missile import Missile
from meshing.quality import check
from meshing.sector import Sector, sector_of
from meshing.sizes import SizeField, size_field
from meshing.symmetry import is_symmetric, mirrored
from meshing.tetrahedra import MeshError, TetMesh, oriented

TOLERANCE = 0.12  # of the number of cells; beyond, the mesh is made again
PLANES = {1: "symmetry_y", 2: "symmetry_z"}


@dataclass
class Made:
    """A mesh that has been made: in the description's unit, with what is worth telling of it."""

    mesh: TetMesh
    model: str
    h: float  # size of cells on the wall, in diameters
    report: list[str] = field(default_factory=list)


def make_mesh(missile: Missile, model: str | None, cells: int) -> Made:
    """The mesh of about `cells` tetrahedra, as a half or a full model; None: half where the missile is symmetric about y = 0.

    gmsh must be initialised. Raises MeshError.
    """
    unit = missile.body.diameter
    small = missile.in_diameters()
    domain, sector = domain_of(small), sector_of(small)
    model = model or ("half" if 1 in sector.planes else "full")
    if model == "half" and 1 not in sector.planes:
        raise MeshError("the missile is not symmetric about y = 0, so that it has no half model; use the full one")
    share = 0.5 if model == "half" else 1.0
    sizes = size_field(small, domain, sector, LEVELS["coarse"] * 2.0 * sector.share)
    h = (sizes.cells(sector) * share / sector.share / cells) ** (1.0 / 3.0)
    for attempt in range(3):
        part = mesh_sector(small, domain, sector, sizes, h)
        got = len(part.tets) * share / sector.share
        if abs(got / cells - 1.0) <= TOLERANCE:
            break
        h *= (got / cells) ** (1.0 / 3.0)
    mesh, symmetry = unfolded(part, small, sector, model)
    mesh = with_panels(mesh, small)
    mesh.points *= unit
    report = check(mesh) + symmetry
    report += [f"wall cells of {h * unit:.4g} {missile.unit} = {h:.4f} d, d = {unit:g} {missile.unit}", *domain.facts(small, unit)]
    return Made(mesh, model, h, report)


def mesh_sector(missile: Missile, domain: Domain, sector: Sector, sizes: SizeField, h: float) -> TetMesh:
    """The mesh of a sector, patches by component; lengths in diameters."""
    gmsh.model.add("sector")
    with tempfile.TemporaryDirectory() as folder:
        build_fluid(missile, domain, sector)
        near, far = boxes(missile, domain, sector)
        set_background(sizes, h, near, far, Path(folder))
        points, row = generate(None, 3)
    classify = Classifier(missile, domain, sector)
    parts: dict[str, list[np.ndarray]] = {}
    for _, face in gmsh.model.getEntities(2):
        triangles = row[gmsh.model.mesh.getElementsByType(2, face)[1].astype(np.int64)].reshape(-1, 3)
        parts.setdefault(classify(points[triangles.ravel()]), []).append(triangles)
    tets = row[gmsh.model.mesh.getElementsByType(4)[1].astype(np.int64)].reshape(-1, 4)
    gmsh.model.remove()
    mesh = TetMesh(points, tets, {name: np.concatenate(patch) for name, patch in parts.items()})
    for axis in sector.planes:
        points[mesh.patches[PLANES[axis]], axis] = 0.0
    return relaxed(split_corners(oriented(mesh)), below=0.3)


def boxes(missile: Missile, domain: Domain, sector: Sector) -> tuple[np.ndarray, np.ndarray]:
    """Corners (2, 3) of a box around body and fins, and of one around the fluid, within the sector's planes of symmetry."""
    reach = 0.5
    last = missile.body.length
    for panel in missile.panels:
        reach = max(reach, float(panel.tip) + float(np.hypot(*panel.origin)))
        last = max(last, float(panel.x + panel.planform.trail.max()))
    reach += 0.3
    profile = domain.profile
    wide = 0.5 * float(np.ptp(profile[:, 0])) if domain.arc else float(profile[:, 1].max())
    near = np.array([[-0.3, -reach, -reach], [last + 0.3, reach, reach]])
    far = np.array([[profile[:, 0].min(), -wide, -wide], [profile[:, 0].max(), wide, wide]])
    far += 0.01 * np.ptp(far, axis=0) * [[-1.0], [1.0]]
    for box in (near, far):
        for axis in sector.planes:
            box[0, axis] = -1e-3
    return near, far


def unfolded(part: TetMesh, missile: Missile, sector: Sector, model: str) -> tuple[TetMesh, list[str]]:
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


def with_panels(mesh: TetMesh, missile: Missile) -> TetMesh:
    """Each set of fins as a patch a panel, and the patches in the order of the description."""
    patches: dict[str, np.ndarray] = {}
    order = [segment.name for segment in missile.body.segments]
    sets = dict.fromkeys(panel.set_name for panel in missile.panels)
    for name in order:
        if name in mesh.patches:
            patches[name] = mesh.patches[name]
    for name in sets:
        panels = [panel for panel in missile.panels if panel.set_name == name]
        triangles = mesh.patches[name]
        middle = mesh.points[triangles].mean(axis=1)
        # The panel whose middle plane is nearest, on the side where its span points to.
        off = []
        for panel in panels:
            local = panel.to_local(middle)
            off.append(np.where(local[:, 1] > 0.0, np.abs(local[:, 2]), np.inf))
        nearest = np.argmin(off, axis=0)
        for number, panel in enumerate(panels):
            if np.any(nearest == number):
                patches[panel.name] = triangles[nearest == number]
    for name in ("base", "symmetry", "farfield"):
        if name in mesh.patches:
            patches[name] = mesh.patches[name]
    lost = set(mesh.patches) - set(patches) - set(sets)
    if lost:
        raise MeshError(f"patches {', '.join(sorted(lost))} have no place among the components")
    return TetMesh(mesh.points, mesh.tets, patches)
