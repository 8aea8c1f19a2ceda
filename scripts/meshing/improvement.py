"""Better tetrahedra: corners split, interior points moved."""

from __future__ import annotations

import numpy as np

from meshing.quality import radius_ratios
from meshing.tetrahedra import EDGES, TetMesh, boundary, edge_keys


def split_corners(mesh: TetMesh) -> TetMesh:
    """Split the tetrahedra that have two boundary faces, where an interior edge joins those faces.

    Such a tetrahedron has two neighbours only, so that its gradient is poor. The edge that is in neither boundary face is cut at
    its middle together with every tetrahedron around it; each half then keeps one boundary face. Edges that share a tetrahedron
    are cut in successive rounds. The boundary does not change.
    """
    points, tets = mesh.points, mesh.tets
    while True:
        current = TetMesh(points, tets, mesh.patches)
        triangles, where = boundary(current)
        n = len(points)
        on_boundary = np.zeros((len(tets), 4), dtype=bool)
        on_boundary.reshape(-1)[where] = True
        pair = np.flatnonzero(on_boundary.sum(axis=1) == 2)
        # Vertices i and j opposite the two boundary faces are the ends of the edge that is in neither.
        edges = tets[pair][on_boundary[pair]].reshape(-1, 2)
        skin = np.unique(edge_keys(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), n))
        candidates = np.unique(edge_keys(edges, n))
        candidates = candidates[~np.isin(candidates, skin)]

        all_keys = edge_keys(tets[:, EDGES].reshape(-1, 2), n).reshape(-1, 6)
        hit = np.isin(all_keys, candidates)
        # A tetrahedron takes the first of its candidates; an edge is cut when every tetrahedron around it took it.
        touched = np.flatnonzero(hit.any(axis=1))
        taken = np.where(hit[touched], all_keys[touched], np.iinfo(np.int64).max).min(axis=1)
        refused = np.unique(all_keys[touched][hit[touched] & (all_keys[touched] != taken[:, None])])
        chosen = np.setdiff1d(candidates, refused)
        if len(chosen) == 0:
            return current
        a, b = chosen // n, chosen % n
        rows = touched[np.isin(taken, chosen)]
        new = n + np.searchsorted(chosen, taken[np.isin(taken, chosen)])
        old = tets[rows]
        first = np.where(old == a[new - n, None], new[:, None], old)
        second = np.where(old == b[new - n, None], new[:, None], old)
        tets = np.concatenate([np.delete(tets, rows, axis=0), first, second])
        points = np.concatenate([points, 0.5 * (points[a] + points[b])])


def relaxed(mesh: TetMesh, below: float = 0.4, sweeps: int = 3) -> TetMesh:
    """Move the interior points of tetrahedra whose radius ratio is under `below`, so that their worst one improves.

    A pattern search point by point, with the same pseudo-random directions at every run: gmsh's own relocation misses the thin
    cells beside sharp edges. About a millisecond a point.
    """
    points = mesh.points.copy()
    fixed = np.unique(np.concatenate(list(mesh.patches.values())))
    order = np.argsort(mesh.tets, axis=None, kind="stable")
    start = np.searchsorted(mesh.tets.ravel()[order], np.arange(len(points) + 1))
    random = np.random.default_rng(1)
    for _ in range(sweeps):
        bad = radius_ratios(points[mesh.tets]) < below
        for vertex in np.setdiff1d(mesh.tets[bad], fixed):
            around = order[start[vertex] : start[vertex + 1]]
            corners = points[mesh.tets[around // 4]]
            place = (np.arange(len(around)), around % 4)
            worst = radius_ratios(corners).min()
            step = 0.5 * np.abs(corners - points[vertex]).max()
            for _ in range(8):
                directions = random.normal(size=(16, 3))
                trials = points[vertex] + step * directions / np.linalg.norm(directions, axis=1, keepdims=True)
                moved = np.repeat(corners[None], len(trials), axis=0)
                moved[:, place[0], place[1]] = trials[:, None]
                quality = radius_ratios(moved).min(axis=1)
                best = quality.argmax()
                if quality[best] > worst:
                    worst, points[vertex], corners = quality[best], trials[best], moved[best]
                else:
                    step *= 0.5
    return TetMesh(points, mesh.tets, mesh.patches)
