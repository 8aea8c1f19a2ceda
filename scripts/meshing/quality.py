"""What is wrong with a mesh: its invariants, and the shapes of its tetrahedra."""

from __future__ import annotations

import numpy as np

from meshing.tetrahedra import EDGES, FACES, MeshError, TetMesh, area_vectors, boundary, face_keys, volumes


def dihedral_angles(mesh: TetMesh) -> np.ndarray:
    """The six dihedral angles of every tetrahedron, (m, 6), in degrees."""
    p = mesh.points[mesh.tets]
    normals = np.stack([np.cross(p[:, f[1]] - p[:, f[0]], p[:, f[2]] - p[:, f[0]]) for f in FACES], axis=1)
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    cosines = [-np.einsum("ij,ij->i", normals[:, i], normals[:, j]) for i, j in EDGES]
    return np.degrees(np.arccos(np.clip(np.stack(cosines, axis=1), -1.0, 1.0)))


def radius_ratios(corners: np.ndarray) -> np.ndarray:
    """3 * (inscribed radius) / (circumscribed radius) of tetrahedra given by their corners (..., 4, 3).

    1 when regular, 0 when flat, negative when inverted.
    """
    # Component by component: numpy's own cross product takes many times as long.
    a, b, c = (tuple(corners[..., i, k] - corners[..., 0, k] for k in range(3)) for i in (1, 2, 3))
    cross = lambda u, v: (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
    dot = lambda u, v: u[0] * v[0] + u[1] * v[1] + u[2] * v[2]
    length = lambda v: np.sqrt(dot(v, v))
    ab, bc, ca = cross(a, b), cross(b, c), cross(c, a)
    volume6 = dot(a, bc)
    area2 = length(ab) + length(bc) + length(ca) + length([p + q + r for p, q, r in zip(ab, bc, ca)])
    aa, bb, cc = dot(a, a), dot(b, b), dot(c, c)
    circum = length([aa * p + bb * q + cc * r for p, q, r in zip(bc, ca, ab)])
    return 6.0 * volume6 * np.abs(volume6) / (area2 * circum)  # r = 6V / (2A), R = |...| / (12V)


def check(mesh: TetMesh) -> list[str]:
    """Check the invariants and return the lines of a report; raises MeshError when one of them is broken."""
    volume = volumes(mesh)
    if volume.min() <= 0.0:
        raise MeshError(f"{np.count_nonzero(volume <= 0.0)} tetrahedra are not positive (smallest {volume.min():.3e})")
    skin = np.concatenate(list(mesh.patches.values()))
    triangles, where = boundary(mesh)
    keys = face_keys(triangles, len(mesh.points))
    if not np.array_equal(np.sort(face_keys(skin, len(mesh.points))), keys):
        raise MeshError("the patches do not cover the boundary of the tetrahedra exactly once")
    open_faces = np.isin(keys, face_keys(mesh.patches["farfield"], len(mesh.points)))
    most = np.bincount(where[~open_faces] // 4).max()
    if most > 1:
        raise MeshError(f"a tetrahedron has {most} faces on walls or symmetry planes, which spoils its gradient")
    vectors = area_vectors(mesh.points, skin)
    closure = np.abs(vectors.sum(axis=0)).max() / np.linalg.norm(vectors, axis=1).sum()
    enclosed = np.einsum("ij,ij->", vectors, mesh.points[skin].mean(axis=1)) / 3.0
    mismatch = abs(enclosed / volume.sum() - 1.0)
    if closure > 1e-12 or mismatch > 1e-11:
        raise MeshError(f"the boundary is not closed: area sum {closure:.1e}, volume mismatch {mismatch:.1e}")

    dihedral, ratio = dihedral_angles(mesh), radius_ratios(mesh.points[mesh.tets])
    smallest = dihedral.min(axis=1)
    histogram = np.histogram(ratio, bins=np.linspace(0.0, 1.0 + 1e-12, 11))[0]
    return [
        f"tetrahedra {len(mesh.tets)}, points {len(mesh.points)}, boundary triangles {len(skin)}",
        f"volume {volume.sum():.6f}, cells from {volume.min():.3e} to {volume.max():.3e}",
        f"closure: sum of areas {closure:.1e}, volume by the divergence theorem {mismatch:.1e} (relative)",
        f"dihedral angles {dihedral.min():.2f} to {dihedral.max():.2f} deg; "
        + ", ".join(f"{np.count_nonzero(smallest < limit)} cells below {limit}" for limit in (2, 5, 10)),
        f"radius ratio: smallest {ratio.min():.4f}, median {np.median(ratio):.3f}, in tenths {histogram.tolist()}",
        "no cell has more than one face on walls or symmetry planes",
    ]


def patch_report(mesh: TetMesh, exact: dict[str, float]) -> list[str]:
    """One line a patch, with its area beside the exact one (in the units of the points, squared) where that is given."""
    lines = []
    for name, patch in mesh.patches.items():
        area = np.linalg.norm(area_vectors(mesh.points, patch), axis=1).sum()
        known = f", exact {exact[name]:.6f} ({100 * (area / exact[name] - 1):+.3f} %)" if name in exact else ""
        lines.append(f"{name}: {len(patch)} triangles, area {area:.6f}{known}")
    return lines
