"""Is a triangulated surface the closed boundary of a body? Holes and places where it meets itself are told with their coordinates."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from meshing.surface import Surface
from meshing.toml_file import DescriptionError

MOST_TOLD = 5


def sound(surface: Surface, where: str) -> Surface:
    """The surface with all its normals outwards. Raises DescriptionError where it is not closed or meets itself; `where`: its file."""
    problems = _open_edges(surface)
    if not problems:
        surface = _oriented(surface)
        problems = _crossings(surface)
    if problems:
        told = problems[:MOST_TOLD]
        if len(problems) > MOST_TOLD:
            told.append(f"and {len(problems) - MOST_TOLD} more places")
        raise DescriptionError([f"{where}: {problem}" for problem in told])
    return surface


def edges_of(triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Edges (e, 2), the smaller point first; for each of the 3 m sides, in rows of a triangle, its edge and whether it runs that way."""
    sides = triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    edges, inverse = np.unique(np.sort(sides, axis=1), axis=0, return_inverse=True)
    return edges, inverse.reshape(-1), sides[:, 0] < sides[:, 1]


def _place(point: np.ndarray) -> str:
    return "(" + ", ".join(f"{value:.6g}" for value in point) + ")"


def _open_edges(surface: Surface) -> list[str]:
    edges, of_side, _ = edges_of(surface.triangles)
    count = np.bincount(of_side)
    problems = []
    for loop in _connected(edges[count == 1]):
        points = surface.points[np.unique(loop)]
        size = float(np.linalg.norm(np.ptp(points, axis=0)))
        problems.append(f"a hole around {_place(points.mean(axis=0))}, {size:.4g} wide, with {len(loop)} open edges; close the surface there")
    for loop in _connected(edges[count > 2]):
        middle = surface.points[np.unique(loop)].mean(axis=0)
        problems.append(f"{len(loop)} edges around {_place(middle)} belong to more than two triangles; remove what is inside of the body")
    return problems


def _connected(edges: np.ndarray) -> list[np.ndarray]:
    """The edges (e, 2) in groups that hang together."""
    groups: list[list[np.ndarray]] = []
    owner: dict[int, int] = {}
    for edge in edges:
        found = sorted({owner[p] for p in edge.tolist() if p in owner})
        into = found[0] if found else len(groups)
        if not found:
            groups.append([])
        for other in found[1:]:
            for moved in groups[other]:
                owner |= dict.fromkeys(moved.tolist(), into)
            groups[into] += groups[other]
            groups[other] = []
        groups[into].append(edge)
        owner |= dict.fromkeys(edge.tolist(), into)
    return [np.array(group) for group in groups if group]


def parts(surface: Surface) -> np.ndarray:
    """For each triangle the number of the closed surface that it belongs to."""
    label = np.arange(len(surface.points))
    while True:  # the smallest label goes from corner to corner
        least = label[surface.triangles].min(axis=1)
        new = label.copy()
        np.minimum.at(new, surface.triangles.ravel(), np.repeat(least, 3))
        new = new[new]
        if np.array_equal(new, label):
            return np.unique(label[surface.triangles[:, 0]], return_inverse=True)[1].reshape(-1)
        label = new


def _oriented(surface: Surface) -> Surface:
    """Neighbours turned the same way, and every closed part outwards."""
    edges, of_side, forward = edges_of(surface.triangles)
    order = np.argsort(of_side, kind="stable").reshape(-1, 2)
    triangles = surface.triangles.copy()
    wrong = forward[order[:, 0]] == forward[order[:, 1]]
    if np.any(wrong):
        around: list[list[tuple[int, bool]]] = [[] for _ in triangles]
        for (a, b), differs in zip((order // 3).tolist(), wrong.tolist()):
            around[a].append((b, differs))
            around[b].append((a, differs))
        turned = np.full(len(triangles), -1)
        for seed in range(len(triangles)):
            if turned[seed] >= 0:
                continue
            turned[seed], stack = 0, [seed]
            while stack:
                one = stack.pop()
                for other, differs in around[one]:
                    if turned[other] < 0:
                        turned[other] = turned[one] ^ int(differs)
                        stack.append(other)
        triangles[turned == 1] = triangles[turned == 1][:, [0, 2, 1]]
    surface = replace(surface, triangles=triangles)
    part = parts(surface)
    moment = np.einsum("ij,ij->i", surface.area_vectors, surface.corners.mean(axis=1) - surface.points.mean(axis=0))
    inward = np.bincount(part, moment) < 0.0
    triangles[inward[part]] = triangles[inward[part]][:, [0, 2, 1]]
    return replace(surface, triangles=triangles)


def _crossings(surface: Surface) -> list[str]:
    """Triangles that cross others: of one part itself, or of two."""
    pairs = _near_pairs(surface)
    points, triangles = surface.points, surface.triangles
    shared = (triangles[pairs[:, 0]][:, :, None] == triangles[pairs[:, 1]][:, None, :]).any(axis=(1, 2))
    pairs = pairs[~shared]
    found = []
    for one, other in ((0, 1), (1, 0)):
        corners, target = points[triangles[pairs[:, one]]], points[triangles[pairs[:, other]]]
        for i in range(3):
            hit, place = _pierced(corners[:, i], corners[:, (i + 1) % 3], target)
            found += [(tuple(pair), at) for pair, at in zip(pairs[hit].tolist(), place[hit])]
    if not found:
        return []
    part = parts(surface)
    problems, told = [], []
    extent = float(np.ptp(points, axis=0).max())
    for (a, b), at in found:
        if any(np.linalg.norm(at - other) < 0.05 * extent for other in told):
            continue
        told.append(at)
        if part[a] == part[b]:
            problems.append(f"the surface crosses itself near {_place(at)}; repair it there")
        else:
            names = f"'{surface.names[surface.component[a]]}' and '{surface.names[surface.component[b]]}'"
            problems.append(f"the closed parts {names} cross each other near {_place(at)}; unite them into one surface first")
    return problems


def _near_pairs(surface: Surface) -> np.ndarray:
    """Pairs (k, 2) of triangles whose boxes overlap, found through the cells of a grid."""
    corners = surface.corners
    low, high = corners.min(axis=1), corners.max(axis=1)
    extent = np.ptp(surface.points, axis=0)
    # About as wide as a triangle in the mean, and no more cells than can be numbered.
    width = max(float(np.median(np.linalg.norm(high - low, axis=1))), float(extent.max()) / 500.0)
    origin = surface.points.min(axis=0)
    first, last = np.floor((low - origin) / width).astype(np.int64), np.floor((high - origin) / width).astype(np.int64)
    counts = last - first + 1
    total = counts.prod(axis=1)
    owner = np.repeat(np.arange(len(total)), total)
    rank = np.arange(len(owner)) - np.repeat(np.cumsum(total) - total, total)
    span = counts[owner]
    cell = first[owner] + np.column_stack([rank // (span[:, 1] * span[:, 2]), rank // span[:, 2] % span[:, 1], rank % span[:, 2]])
    size = np.floor(extent / width).astype(np.int64) + 2
    key = (cell[:, 0] * size[1] + cell[:, 1]) * size[2] + cell[:, 2]
    order = np.argsort(key, kind="stable")
    key, owner = key[order], owner[order]
    pairs = []
    for step in range(1, int(np.bincount(np.unique(key, return_inverse=True)[1].reshape(-1)).max())):
        same = np.flatnonzero(key[step:] == key[:-step])
        if len(same) == 0:
            break
        a, b = owner[same], owner[same + step]
        overlap = np.all((low[a] <= high[b]) & (low[b] <= high[a]), axis=1)
        pairs.append(np.sort(np.column_stack([a[overlap], b[overlap]]), axis=1))
    return np.unique(np.concatenate(pairs), axis=0) if pairs else np.empty((0, 2), dtype=np.int64)


def _pierced(start: np.ndarray, end: np.ndarray, target: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Which lines from start to end (k, 3) go through the inside of the triangles (k, 3, 3), and where (Moeller and Trumbore)."""
    direction, one, two = end - start, target[:, 1] - target[:, 0], target[:, 2] - target[:, 0]
    across = np.cross(direction, two)
    volume = np.einsum("ij,ij->i", one, across)
    scale = np.linalg.norm(np.cross(one, two), axis=1) * np.linalg.norm(direction, axis=1)
    flat = np.abs(volume) < 1e-9 * scale
    volume = np.where(flat, 1.0, volume)
    off = start - target[:, 0]
    u = np.einsum("ij,ij->i", off, across) / volume
    normal = np.cross(off, one)
    v = np.einsum("ij,ij->i", direction, normal) / volume
    t = np.einsum("ij,ij->i", two, normal) / volume
    margin = 1e-6
    hit = ~flat & (u > margin) & (v > margin) & (u + v < 1.0 - margin) & (t > margin) & (t < 1.0 - margin)
    return hit, start + t[:, None] * direction
