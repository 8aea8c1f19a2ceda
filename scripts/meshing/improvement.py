"""Better tetrahedra: corners split, interior points moved."""

from __future__ import annotations

import numpy as np

from meshing.quality import radius_ratios
from meshing.tetrahedra import EDGES, TetMesh, boundary, edge_keys


def split_corners(mesh: TetMesh) -> TetMesh:
    """Split the tetrahedra that have two boundary faces, where an interior edge joins those faces.

    Such a tetrahedron has two neighbours only, so that its gradient is poor. The edge that is in neither boundary face is cut at
    its middle together with every tetrahedron around it; each half then keeps one boundary face. Edges that share a tetrahedron
    are cut in successive rounds. The boundary does not change. Where that edge is on the boundary itself, as in narrow places, the
    tetrahedron is split at its centre.
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
            return split_at_centres(current, np.flatnonzero(on_boundary.sum(axis=1) >= 2))
        a, b = chosen // n, chosen % n
        rows = touched[np.isin(taken, chosen)]
        new = n + np.searchsorted(chosen, taken[np.isin(taken, chosen)])
        old = tets[rows]
        first = np.where(old == a[new - n, None], new[:, None], old)
        second = np.where(old == b[new - n, None], new[:, None], old)
        tets = np.concatenate([np.delete(tets, rows, axis=0), first, second])
        points = np.concatenate([points, 0.5 * (points[a] + points[b])])


def split_at_centres(mesh: TetMesh, cells: np.ndarray) -> TetMesh:
    """Each of some tetrahedra in four, around its centre: every one then has one of its faces."""
    if len(cells) == 0:
        return mesh
    old = mesh.tets[cells]
    new = len(mesh.points) + np.arange(len(cells))
    parts = []
    for corner in range(4):
        part = old.copy()
        part[:, corner] = new
        parts.append(part)
    tets = np.concatenate([np.delete(mesh.tets, cells, axis=0), *parts])
    return TetMesh(np.concatenate([mesh.points, mesh.points[old].mean(axis=1)]), tets, mesh.patches)


def relaxed(mesh: TetMesh, below: float = 0.4, sweeps: int = 3) -> TetMesh:
    """Move the interior points of tetrahedra whose radius ratio is under `below`, so that their worst one improves.

    A pattern search with the same pseudo-random directions at every run: gmsh's own relocation misses the thin cells beside sharp
    edges. Points that share no tetrahedron move at the same time.
    """
    points = mesh.points.copy()
    fixed = np.zeros(len(points), dtype=bool)
    fixed[np.concatenate([patch.ravel() for patch in mesh.patches.values()])] = True
    order = np.argsort(mesh.tets, axis=None, kind="stable")
    start = np.searchsorted(mesh.tets.ravel()[order], np.arange(len(points) + 1))
    random = np.random.default_rng(1)
    for _ in range(sweeps):
        bad = radius_ratios(points[mesh.tets]) < below
        movable = np.unique(mesh.tets[bad])
        for vertices in independent(movable[~fixed[movable]], mesh.tets, order, start):
            _search(points, mesh.tets, vertices, order, start, random)
    return TetMesh(points, mesh.tets, mesh.patches)


def independent(vertices: np.ndarray, tets: np.ndarray, order: np.ndarray, start: np.ndarray) -> list[np.ndarray]:
    """The vertices in groups, in each of which no two share a tetrahedron: every vertex takes the first group that is free."""
    group = {}
    among = set(vertices.tolist())
    for vertex in vertices.tolist():
        around = tets[order[start[vertex] : start[vertex + 1]] // 4]
        taken = {group.get(other) for other in around.ravel().tolist() if other in among}
        group[vertex] = next(i for i in range(len(taken) + 1) if i not in taken)
    groups: list[list[int]] = [[] for _ in range(max(group.values(), default=-1) + 1)]
    for vertex, number in group.items():
        groups[number].append(vertex)
    return [np.array(members) for members in groups]


def _search(
    points: np.ndarray, tets: np.ndarray, vertices: np.ndarray, order: np.ndarray, start: np.ndarray, random: np.random.Generator
) -> None:
    """Move each vertex, all at once, to where the worst tetrahedron around it is best; `points` change."""
    counts = start[vertices + 1] - start[vertices]
    most = int(counts.max())
    # Rows of all the same length: a vertex with fewer tetrahedra around it has its first one several times.
    slot = start[vertices][:, None] + np.where(np.arange(most) < counts[:, None], np.arange(most), 0)
    around, place = order[slot] // 4, order[slot] % 4
    corners = points[tets[around]]  # (vertex, tetrahedron, corner, 3)
    rows, columns = np.arange(len(vertices))[:, None], np.arange(most)
    here = points[vertices]
    worst = radius_ratios(corners).min(axis=1)
    step = 0.5 * np.abs(corners - here[:, None, None]).max(axis=(1, 2, 3))
    for _ in range(8):
        directions = random.normal(size=(12, 3))
        directions /= np.linalg.norm(directions, axis=1, keepdims=True)
        best, better = here.copy(), worst.copy()
        for direction in directions:
            trial = here + step[:, None] * direction
            corners[rows, columns, place] = trial[:, None]
            quality = radius_ratios(corners).min(axis=1)
            wins = quality > better
            best[wins], better[wins] = trial[wins], quality[wins]
        step = np.where(better > worst, step, 0.5 * step)
        here, worst = best, better
    points[vertices] = here
