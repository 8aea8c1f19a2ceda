"""Mesh files: Gmsh and SU2."""

from __future__ import annotations

import os
from pathlib import Path

import gmsh
import numpy as np

from meshing.tetrahedra import MeshError, TetMesh


def write(mesh: TetMesh, path: Path, version: str = "4.1", ascii: bool = False) -> None:
    """Write a Gmsh file of the given version, or an SU2 file when `version` is "su2". gmsh must be initialised.

    The file appears under its name only when it is complete.
    """
    partial = path.with_name(f"{path.stem}.part{path.suffix}")
    try:
        if version == "su2":
            write_su2(mesh, partial)
        else:
            write_gmsh(mesh, partial, version, ascii)
        os.replace(partial, path)
    finally:
        partial.unlink(missing_ok=True)


def write_su2(mesh: TetMesh, path: Path) -> None:
    """Write an SU2 native file (text), with a marker for each patch."""
    with open(path, "w") as file:

        def section(keyword: str, kind: int, nodes: np.ndarray) -> None:
            file.write(f"{keyword}= {len(nodes)}\n")
            np.savetxt(file, np.insert(nodes, 0, kind, axis=1), fmt="%d")

        file.write("NDIME= 3\n")
        section("NELEM", 10, mesh.tets)  # VTK's types: 10 tetrahedron, 5 triangle
        file.write(f"NPOIN= {len(mesh.points)}\n")
        np.savetxt(file, mesh.points, fmt="%.17g")
        file.write(f"NMARK= {len(mesh.patches)}\n")
        for name, patch in mesh.patches.items():
            file.write(f"MARKER_TAG= {name}\n")
            section("MARKER_ELEMS", 5, patch)


def write_gmsh(mesh: TetMesh, path: Path, version: str, ascii: bool) -> None:
    """Write a Gmsh file with a physical surface for each patch and the physical volume `fluid`, and read it back."""
    gmsh.model.add("mesh")
    names = list(mesh.patches)
    for tag in range(1, len(names) + 1):
        gmsh.model.addDiscreteEntity(2, tag)
    gmsh.model.addDiscreteEntity(3, 1, list(range(1, len(names) + 1)))
    gmsh.model.mesh.addNodes(3, 1, np.arange(1, len(mesh.points) + 1), mesh.points.ravel())
    first = 1
    for tag, name in enumerate(names, start=1):
        patch = mesh.patches[name]
        gmsh.model.mesh.addElementsByType(tag, 2, np.arange(first, first + len(patch)), (patch + 1).ravel())
        gmsh.model.setPhysicalName(2, gmsh.model.addPhysicalGroup(2, [tag], tag), name)
        first += len(patch)
    gmsh.model.mesh.addElementsByType(1, 4, np.arange(first, first + len(mesh.tets)), (mesh.tets + 1).ravel())
    gmsh.model.setPhysicalName(3, gmsh.model.addPhysicalGroup(3, [1], len(names) + 1), "fluid")
    gmsh.option.setNumber("Mesh.MshFileVersion", float(version))
    gmsh.option.setNumber("Mesh.Binary", 0 if ascii else 1)
    gmsh.write(str(path))
    gmsh.model.remove()
    copy = read(path)
    same_points = np.allclose(copy.points, mesh.points, rtol=1e-14, atol=0.0)  # text has 16 digits
    same_patches = all(np.array_equal(copy.patches.get(name), mesh.patches[name]) for name in names)
    if not (same_points and same_patches and len(copy.patches) == len(names) and np.array_equal(copy.tets, mesh.tets)):
        raise MeshError(f"{path}: the mesh read back is not the one written")


def read(path: Path) -> TetMesh:
    """Read a .msh file of `write`. gmsh must be initialised."""
    gmsh.open(str(path))
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    mesh = TetMesh(np.empty((len(tags), 3)), np.empty((0, 4), dtype=np.int64), {})
    mesh.points[tags.astype(np.int64) - 1] = coordinates.reshape(-1, 3)
    for dimension, group in gmsh.model.getPhysicalGroups():
        kind, width = {2: (2, 3), 3: (4, 4)}[dimension]
        (entity,) = gmsh.model.getEntitiesForPhysicalGroup(dimension, group)
        nodes = gmsh.model.mesh.getElementsByType(kind, entity)[1].astype(np.int64).reshape(-1, width) - 1
        if dimension == 3:
            mesh.tets = nodes
        else:
            mesh.patches[gmsh.model.getPhysicalName(dimension, group)] = nodes
    gmsh.model.remove()
    return mesh
