"""Tools shared by the mesh generators of the cases: from the tetrahedra of one sector to a checked .msh file.

A generator meshes one sector with gmsh, names its boundary triangles, and then uses `oriented`, `split_corners`,
`relaxed` and `mirrored`; `run` is its program, which checks and writes the mesh. Needs Debian's python3-numpy, and python3-gmsh.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import gmsh
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


# What gmsh calls for the cell size wanted at a point: (dimension, tag, x, y, z) -> size.
SizeField = Callable[[int, int, float, float, float], float]
# A generator: (cell size h, command line) -> the mesh, and the case's own lines of the report.
Builder = Callable[[float, argparse.Namespace], tuple[TetMesh, list[str]]]


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
    a, b, c = (corners[..., i, :] - corners[..., 0, :] for i in (1, 2, 3))
    ab, bc, ca = np.cross(a, b), np.cross(b, c), np.cross(c, a)
    length = lambda v: np.sqrt((v * v).sum(axis=-1))
    square = lambda v: (v * v).sum(axis=-1, keepdims=True)
    volume6 = (a * bc).sum(axis=-1)
    area2 = length(ab) + length(bc) + length(ca) + length(ab + bc + ca)
    circum = length(square(a) * bc + square(b) * ca + square(c) * ab)
    return 6.0 * volume6 * np.abs(volume6) / (area2 * circum)  # r = 6V / (2A), R = |...| / (12V)


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


def generate(size: SizeField, dimension: int) -> tuple[np.ndarray, np.ndarray]:
    """Mesh the current gmsh model in 2 or 3 dimensions: its points (n, 3), and the row of each of gmsh's node tags."""
    options = {
        "General.NumThreads": 1, "Mesh.RandomSeed": 1,  # the same input gives the same mesh
        "Mesh.MeshSizeExtendFromBoundary": 0, "Mesh.MeshSizeFromPoints": 0, "Mesh.MeshSizeFromCurvature": 0,
        "Mesh.Algorithm": 6, "Mesh.Algorithm3D": 1, "Mesh.OptimizeThreshold": 0.6,
    }  # fmt: skip
    for name, value in options.items():
        gmsh.option.setNumber(name, value)
    gmsh.model.mesh.setSizeCallback(size)
    gmsh.model.mesh.generate(dimension)
    gmsh.model.mesh.removeSizeCallback()
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    row = np.zeros(int(tags.max()) + 1, dtype=np.int64)
    row[tags.astype(np.int64)] = np.arange(len(tags))
    return coordinates.reshape(-1, 3).copy(), row


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


def command_line(doc: str, levels: dict[str, float], unit: str) -> argparse.ArgumentParser:
    """The options that every generator has; `levels`: name -> cell size h in `unit`."""
    parser = argparse.ArgumentParser(description=doc.splitlines()[0], epilog=f"Lengths are in units of the {unit}.")
    sizes = parser.add_mutually_exclusive_group()
    known = ", ".join(f"{name} {size:g}" for name, size in levels.items())
    sizes.add_argument("--level", choices=levels, default="coarse", help=f"h = {known} (default: coarse)")
    sizes.add_argument("--size", type=float, metavar="S", help="cell size h instead of a level's")
    parser.add_argument("--format", choices=("4.1", "2.2", "su2"), default="4.1", help="Gmsh version (default: 4.1), or SU2")
    parser.add_argument("--ascii", action="store_true", help="Gmsh text instead of binary")
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="FILE", help="FILE.msh, or FILE.su2")
    return parser


def run(parser: argparse.ArgumentParser, levels: dict[str, float], build: Builder) -> None:
    """The program of a generator with the options of `command_line`: build, check, write and report."""
    arguments = parser.parse_args()
    h = levels[arguments.level] if arguments.size is None else arguments.size
    smallest, largest = 0.5 * min(levels.values()), 2.0 * max(levels.values())
    suffix = ".su2" if arguments.format == "su2" else ".msh"
    if not smallest <= h <= largest:
        parser.error(f"--size {h} is outside {smallest:g} to {largest:g}")
    if arguments.output.suffix != suffix:
        parser.error(f"the output '{arguments.output}' must end in {suffix}")
    if not os.access(arguments.output.resolve().parent, os.W_OK):
        parser.error(f"cannot write in the folder '{arguments.output.resolve().parent}'")
    start = time.perf_counter()
    gmsh.initialize(readConfigFiles=False)  # a user's settings would change the mesh
    gmsh.option.setNumber("General.Terminal", 0)
    try:
        mesh, own = build(h, arguments)
        lines = check(mesh) + own
        write(mesh, arguments.output, arguments.format, arguments.ascii)
    except Exception as error:  # gmsh raises bare Exception
        sys.exit(f"{parser.prog}: {error}")
    finally:
        gmsh.finalize()
    print(f"{arguments.output}: h = {h}, {time.perf_counter() - start:.1f} s")
    print("\n".join(lines))
