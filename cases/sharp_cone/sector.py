"""From the quarter y, z >= 0 of a body that gmsh meshes to its exactly symmetric half and full models."""

from __future__ import annotations

from collections.abc import Callable

import gmsh
import numpy as np

import meshing

MODELS = {"quarter": 0.25, "half": 0.5, "full": 1.0}  # shares of the whole; half is y >= 0


def mesh_quarter(size: meshing.SizeField, patch_name: Callable[[np.ndarray], str]) -> meshing.TetMesh:
    """Mesh the current gmsh model, which must be one volume, and remove it.

    `patch_name` tells the patch of a CAD face from all its mesh points (n, 3). Among the patches are `symmetry_y` and
    `symmetry_z`, whose points are moved exactly onto y = 0 and z = 0.
    """
    if len(gmsh.model.getEntities(3)) != 1:
        raise meshing.MeshError("the fluid is not one volume")
    points, row = meshing.generate(size, 3)
    parts: dict[str, list[np.ndarray]] = {}
    for _, face in gmsh.model.getEntities(2):
        triangles = row[gmsh.model.mesh.getElementsByType(2, face)[1].astype(np.int64)].reshape(-1, 3)
        parts.setdefault(patch_name(points[triangles.ravel()]), []).append(triangles)
    tets = row[gmsh.model.mesh.getElementsByType(4)[1].astype(np.int64)].reshape(-1, 4)
    gmsh.model.remove()
    mesh = meshing.TetMesh(points, tets, {name: np.concatenate(patch) for name, patch in parts.items()})
    for name, axis in (("symmetry_y", 1), ("symmetry_z", 2)):
        points[mesh.patches[name], axis] = 0.0
    return meshing.relaxed(meshing.split_corners(meshing.oriented(mesh)))


def unfolded(quarter: meshing.TetMesh, model: str) -> tuple[meshing.TetMesh, list[str]]:
    """One of `MODELS` from the quarter, with what symmetry planes are left in the one patch `symmetry`, and a report on it."""
    axes = {"quarter": {}, "half": {"z": 2}, "full": {"z": 2, "y": 1}}[model]
    mesh = quarter
    for name, axis in axes.items():
        mesh = meshing.mirrored(mesh, axis, f"symmetry_{name}")
    patches = {name: patch for name, patch in mesh.patches.items() if name not in ("symmetry_y", "symmetry_z", "farfield")}
    planes = [mesh.patches[name] for name in ("symmetry_y", "symmetry_z") if name in mesh.patches]
    if planes:
        patches["symmetry"] = np.concatenate(planes)
    patches["farfield"] = mesh.patches["farfield"]
    mesh = meshing.TetMesh(mesh.points, mesh.tets, patches)
    for name, axis in axes.items():
        if not meshing.is_symmetric(mesh, axis):
            raise meshing.MeshError(f"the mesh is not its own mirror image about {name} = 0")
    return mesh, [f"mirror image about {name} = 0: identical bit for bit" for name in axes]
