"""A tetrahedral mesh with named patches, its faces and its boundary."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


# Local faces of a tetrahedron (face i is opposite vertex i), normals pointing out of a positive tetrahedron, and its edges.
FACES = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])
EDGES = np.array([[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]])


class MeshError(Exception):
    """The mesh, or the request for one, is wrong; the message says what and what to do."""


@dataclass
class TetMesh:
    """A tetrahedral mesh with named boundary patches.

    points (n, 3) float64, in the units of the case; tets (m, 4) int64; patches: name -> (k, 3) int64 triangles.
    """

    points: np.ndarray
    tets: np.ndarray
    patches: dict[str, np.ndarray]


def face_keys(faces: np.ndarray, n_points: int) -> np.ndarray:
    """One integer for each triangle (k, 3), whatever the order of its vertices."""
    if n_points >= 2**21:
        raise MeshError(f"{n_points} points are too many for 64-bit face keys (limit {2**21}); use a larger size")
    a, b, c = np.sort(faces, axis=1).T.astype(np.int64)
    return (a * n_points + b) * n_points + c


def edge_keys(edges: np.ndarray, n_points: int) -> np.ndarray:
    """One integer for each edge (k, 2), whatever its direction."""
    a, b = np.sort(edges, axis=1).T.astype(np.int64)
    return a * n_points + b


def volumes(mesh: TetMesh) -> np.ndarray:
    """Signed volume of every tetrahedron, (m,): ((p1-p0) x (p2-p0)) . (p3-p0) / 6."""
    p = mesh.points[mesh.tets]
    return np.einsum("ij,ij->i", np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), p[:, 3] - p[:, 0]) / 6.0


def area_vectors(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Area vector of each triangle, (k, 3), by the right-hand rule."""
    p = points[triangles]
    return 0.5 * np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])


def boundary(mesh: TetMesh) -> tuple[np.ndarray, np.ndarray]:
    """Faces that belong to one tetrahedron only, outward, sorted by key: (triangles (k, 3), 4 * tet + local face (k,))."""
    faces = mesh.tets[:, FACES].reshape(-1, 3)
    keys = face_keys(faces, len(mesh.points))
    order = np.argsort(keys, kind="stable")
    sorted_keys = keys[order]
    differs = sorted_keys[1:] != sorted_keys[:-1]
    single = np.concatenate(([True], differs)) & np.concatenate((differs, [True]))
    return faces[order[single]], order[single]


def oriented(mesh: TetMesh) -> TetMesh:
    """The same mesh with positive tetrahedra, outward patch triangles and no unused points.

    Raises MeshError unless the patches cover the boundary of the tetrahedra exactly once.
    """
    used, inverse = np.unique(mesh.tets, return_inverse=True)
    tets = inverse.reshape(-1, 4)
    renumber = np.full(len(mesh.points), -1, dtype=np.int64)
    renumber[used] = np.arange(len(used))
    result = TetMesh(mesh.points[used], tets, {})
    negative = volumes(result) < 0.0
    result.tets[negative] = result.tets[negative][:, [0, 2, 1, 3]]

    triangles, _ = boundary(result)
    keys = face_keys(triangles, len(used))
    covered = np.zeros(len(keys), dtype=np.int64)
    for name, patch in mesh.patches.items():
        wanted = face_keys(renumber[patch], len(used))
        at = np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)
        if np.any(keys[at] != wanted):
            raise MeshError(f"patch '{name}' has triangles that are not on the boundary of the tetrahedra")
        covered[at] += 1
        result.patches[name] = triangles[at]
    if np.any(covered != 1):
        raise MeshError(f"{np.count_nonzero(covered != 1)} boundary faces are not in exactly one patch")
    return result
