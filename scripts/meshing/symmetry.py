"""Symmetric bodies: the quarter y, z >= 0 that gmsh meshes, and its exact mirror images."""

from __future__ import annotations

from collections.abc import Callable

import gmsh
import numpy as np

from meshing.generator import SizeField, generate
from meshing.improvement import relaxed, split_corners
from meshing.tetrahedra import MeshError, TetMesh, oriented

MODELS = {"quarter": 0.25, "half": 0.5, "full": 1.0}  # shares of the whole; half is y >= 0


def mirrored(mesh: TetMesh, axis: int, plane_patch: str) -> TetMesh:
    """The mesh and its mirror image about the plane where coordinate `axis` is exactly 0, merged; `plane_patch` disappears.

    The image of a point has the same bits but for one sign, so that the result is exactly symmetric.
    """
    n = len(mesh.points)
    on_plane = mesh.points[:, axis] == 0.0
    if not np.all(on_plane[mesh.patches[plane_patch]]):
        raise MeshError(f"patch '{plane_patch}' is not exactly on its symmetry plane")
    image = np.where(on_plane, np.arange(n), n + np.cumsum(~on_plane) - 1)
    reflected = mesh.points[~on_plane].copy()
    reflected[:, axis] *= -1.0
    patches = {
        name: np.concatenate([patch, image[patch][:, [0, 2, 1]]]) for name, patch in mesh.patches.items() if name != plane_patch
    }
    tets = np.concatenate([mesh.tets, image[mesh.tets][:, [0, 2, 1, 3]]])
    return TetMesh(np.concatenate([mesh.points, reflected]), tets, patches)


def is_symmetric(mesh: TetMesh, axis: int) -> bool:
    """True when the points and the tetrahedra, as sets, are bit for bit their own mirror image about coordinate `axis` = 0."""
    points = mesh.points + 0.0  # turns -0.0 into 0.0
    reflected = points.copy()
    reflected[:, axis] = 0.0 - reflected[:, axis]
    order, image_order = np.lexsort(points.T), np.lexsort(reflected.T)
    if not np.array_equal(points[order], reflected[image_order]):
        return False
    image = np.empty(len(points), dtype=np.int64)
    image[image_order] = order
    cells, image_cells = np.sort(mesh.tets, axis=1), np.sort(image[mesh.tets], axis=1)
    return np.array_equal(cells[np.lexsort(cells.T)], image_cells[np.lexsort(image_cells.T)])


def mesh_quarter(size: SizeField, patch_name: Callable[[np.ndarray], str]) -> TetMesh:
    """Mesh the current gmsh model, which must be one volume, and remove it.

    `patch_name` tells the patch of a CAD face from all its mesh points (n, 3). Among the patches are `symmetry_y` and
    `symmetry_z`, whose points are moved exactly onto y = 0 and z = 0.
    """
    if len(gmsh.model.getEntities(3)) != 1:
        raise MeshError("the fluid is not one volume")
    points, row = generate(size, 3)
    parts: dict[str, list[np.ndarray]] = {}
    for _, face in gmsh.model.getEntities(2):
        triangles = row[gmsh.model.mesh.getElementsByType(2, face)[1].astype(np.int64)].reshape(-1, 3)
        parts.setdefault(patch_name(points[triangles.ravel()]), []).append(triangles)
    tets = row[gmsh.model.mesh.getElementsByType(4)[1].astype(np.int64)].reshape(-1, 4)
    gmsh.model.remove()
    mesh = TetMesh(points, tets, {name: np.concatenate(patch) for name, patch in parts.items()})
    for name, axis in (("symmetry_y", 1), ("symmetry_z", 2)):
        points[mesh.patches[name], axis] = 0.0
    return relaxed(split_corners(oriented(mesh)))


def unfolded(quarter: TetMesh, model: str) -> tuple[TetMesh, list[str]]:
    """One of `MODELS` from the quarter, with what symmetry planes are left in the one patch `symmetry`, and a report on it."""
    axes = {"quarter": {}, "half": {"z": 2}, "full": {"z": 2, "y": 1}}[model]
    mesh = quarter
    for name, axis in axes.items():
        mesh = mirrored(mesh, axis, f"symmetry_{name}")
    patches = {name: patch for name, patch in mesh.patches.items() if name not in ("symmetry_y", "symmetry_z", "farfield")}
    planes = [mesh.patches[name] for name in ("symmetry_y", "symmetry_z") if name in mesh.patches]
    if planes:
        patches["symmetry"] = np.concatenate(planes)
    patches["farfield"] = mesh.patches["farfield"]
    mesh = TetMesh(mesh.points, mesh.tets, patches)
    for name, axis in axes.items():
        if not is_symmetric(mesh, axis):
            raise MeshError(f"the mesh is not its own mirror image about {name} = 0")
    return mesh, [f"mirror image about {name} = 0: identical bit for bit" for name in axes]
