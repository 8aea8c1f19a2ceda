"""Bodies from CAD files: STEP, IGES and OpenCASCADE's BREP, as solids; their faces triangulated for a first look.

Components are the solids, named by their labels or colours, or else numbered. Several solids become one body.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import gmsh
import numpy as np

from meshing.surface import Surface, finely, merged, named
from meshing.tetrahedra import MeshError
from meshing.toml_file import DescriptionError

SUFFIXES = (".step", ".stp", ".iges", ".igs", ".brep")
AROUND = 30  # triangles' edges around a full circle of the first look
SHORTEST, LONGEST = 0.004, 0.04  # of its edges, shares of the body's extent
ASKEW = 27.0  # degrees: planes at which bodies are divided, which have seldom a face there
MIRRORED = 1e-6  # of the extent: nearer to a face, a point is on it
SEWN = 1e-6  # of the extent: gaps between faces that make no solid by themselves


def read_cad(path: Path, turn: np.ndarray) -> tuple[Surface, tuple[bool, bool]]:
    """The body's faces as triangles, in metres (BREP: as in the file), turned by the rotation (3, 3); and whether their points, mirrored
    about y = 0 or z = 0, are on its faces again. Raises DescriptionError. gmsh must not be initialised."""
    if not path.is_file():
        raise DescriptionError([f"{path}: No such file or directory"])
    with _quiet_gmsh():
        try:
            solids = import_solids(path)
            turned_and_moved(solids, np.column_stack([turn, np.zeros(3)]))
            labels = _labels(solids)
            looks = [_first_look(solid) for solid in solids]
            apart = _joined(looks, labels)
            if len(solids) == 1:
                return apart, _mirrored(solids[0], apart.points)
            whole = united(solids)
            if len(whole) > 1:
                raise MeshError(f"its {len(solids)} solids make {len(whole)} bodies that do not touch; move them together, or leave some out")
            look = _first_look(whole[0])
            symmetric = _mirrored(whole[0], look.reshape(-1, 3))
        except MeshError as error:
            raise DescriptionError([f"{path}: {error}"]) from None
        except Exception as error:  # gmsh raises bare ones
            raise DescriptionError([f"{path}: OpenCASCADE cannot read it as a body: {error}"]) from None
    triangles = np.arange(3 * len(look)).reshape(-1, 3)
    return merged(Surface(look.reshape(-1, 3), triangles, Nearest(apart)(look), apart.names)), symmetric


def _mirrored(solid: tuple[int, int], points: np.ndarray) -> tuple[bool, bool]:
    """Are points (n, 3) of the solid's faces, mirrored about y = 0 or z = 0, on the surfaces of its faces again?"""
    gmsh.model.occ.synchronize()
    some = points[np.linspace(0, len(points) - 1, min(len(points), 400)).astype(int)]
    faces = gmsh.model.getBoundary([solid], oriented=False)
    found = []
    for axis in (1, 2):
        image = some.copy()
        image[:, axis] *= -1.0
        off = np.full(len(some), np.inf)
        for _, face in faces:
            closest, _ = gmsh.model.getClosestPoint(2, face, image.ravel())
            off = np.minimum(off, np.linalg.norm(np.reshape(closest, (-1, 3)) - image, axis=1))
        found.append(bool(off.max() < MIRRORED * np.ptp(points, axis=0).max()))
    return found[0], found[1]


@contextmanager
def _quiet_gmsh() -> Iterator[None]:
    gmsh.initialize(readConfigFiles=False)
    gmsh.option.setNumber("General.Terminal", 0)
    try:
        yield
    finally:
        gmsh.finalize()


def import_solids(path: Path, factor: float = 1.0) -> list[tuple[int, int]]:
    """The solids of a file into the current gmsh model, lengths times `factor`; loose faces are sewn to solids. Raises MeshError."""
    occ = gmsh.model.occ
    suffix = path.suffix.lower()
    # Read as millimetres, OpenCASCADE's own unit, in which its tolerances fit. IGES is so by default, and gmsh fails when told.
    gmsh.option.setString("Geometry.OCCTargetUnit", "" if suffix in (".iges", ".igs") else "MM")
    gmsh.option.setNumber("Geometry.OCCScaling", factor if suffix == ".brep" else 1e-3 * factor)
    try:
        shapes = occ.importShapes(str(path))
    finally:
        gmsh.option.setNumber("Geometry.OCCScaling", 1.0)
    solids = [shape for shape in shapes if shape[0] == 3]
    if not solids:
        solids = _sewn([shape for shape in shapes if shape[0] == 2])
    if not solids:
        raise MeshError("it holds no solid, and its faces do not close one: export the body as a solid, without gaps")
    return solids


def _sewn(faces: list[tuple[int, int]]) -> list[tuple[int, int]]:
    """The solids that loose faces close, if they do."""
    if not faces:
        return []
    occ = gmsh.model.occ
    extent = np.ptp([occ.getBoundingBox(*face) for face in faces])
    healed = occ.healShapes(faces, SEWN * extent, True, False, False, True, True)
    solids = [shape for shape in healed if shape[0] == 3]
    if not solids:  # gmsh makes none of a shell with points for edges, such as that at the tip of a surface of revolution
        solids = [(3, occ.addVolume([occ.addSurfaceLoop([tag for dimension, tag in healed if dimension == 2], sewing=True)]))]
        occ.synchronize()
        own = gmsh.model.getBoundary(solids, oriented=False)
        rim = [curve for curve in gmsh.model.getBoundary(own, oriented=False) if occ.getMass(*curve) > SEWN * extent]
        if rim:
            return []
        occ.remove([face for face in occ.getEntities(2) if face not in own], recursive=True)
    return solids


def united(solids: list[tuple[int, int]]) -> list[tuple[int, int]]:
    """The solids as one, where there are several. Raises MeshError where they do not touch."""
    if len(solids) > 1:
        gmsh.option.setNumber("Geometry.OCCUnionUnify", 0)
        solids, _ = gmsh.model.occ.fuse(solids[:1], solids[1:])
    return solids


def _first_look(solid: tuple[int, int]) -> np.ndarray:
    """Triangles (n, 3, 3) on all faces of a solid, normals outwards.

    Its faces are divided at two planes through the foremost point: gmsh finds no triangles where one goes all around a pointed tip.
    """
    occ = gmsh.model.occ
    occ.synchronize()
    low, high = np.reshape(occ.getBoundingBox(*solid), (2, 3))
    size = float((high - low).max())
    tips = [np.array(gmsh.model.getValue(*point, [])) for point in gmsh.model.getBoundary([solid], recursive=True)]
    tip = min(tips, key=lambda point: point[0]) if tips else np.array([low[0], 0.0, 0.0])
    planes = []
    for turn in (0.0, 90.0):
        plane = (2, occ.addRectangle(low[0] - size, tip[1] - 2.0 * size, tip[2], high[0] - low[0] + 2.0 * size, 4.0 * size))
        occ.rotate([plane], 0.0, tip[1], tip[2], 1, 0, 0, math.radians(ASKEW + turn))
        planes.append(plane)
    made, _ = occ.fragment(occ.copy([solid]), planes)
    occ.synchronize()
    parts = [entity for entity in made if entity[0] == 3]
    faces = gmsh.model.getBoundary(parts)  # what two parts share cancels out
    try:
        return _triangles(faces, size)
    finally:
        gmsh.model.mesh.clear()
        occ.remove(made, recursive=True)


def _triangles(faces: list[tuple[int, int]], extent: float) -> np.ndarray:
    """Triangles (n, 3, 3) on faces; one with a negative number is turned about."""
    options = {
        "General.NumThreads": 1, "Mesh.MeshSizeFromCurvature": AROUND, "Mesh.MeshSizeExtendFromBoundary": 0, "Mesh.MeshSizeFromPoints": 0,
        "Mesh.MeshSizeMin": SHORTEST * extent, "Mesh.MeshSizeMax": LONGEST * extent, "Mesh.Algorithm": 6, "Mesh.MeshOnlyVisible": 1,
    }  # fmt: skip
    for name, value in options.items():
        gmsh.option.setNumber(name, value)
    gmsh.model.setVisibility(gmsh.model.getEntities(), 0)
    gmsh.model.setVisibility([(2, abs(face)) for _, face in faces], 1, recursive=True)
    gmsh.model.mesh.generate(2)
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    row = np.zeros(int(tags.max()) + 1, dtype=np.int64)
    row[tags.astype(np.int64)] = np.arange(len(tags))
    points = coordinates.reshape(-1, 3)
    found = []
    for _, face in faces:
        part = row[gmsh.model.mesh.getElementsByType(2, abs(face))[1].astype(np.int64)].reshape(-1, 3)
        found.append(points[part if face > 0 else part[:, [0, 2, 1]]])
    return np.concatenate(found)


def _joined(looks: list[np.ndarray], labels: list[str]) -> Surface:
    """The triangles of several solids as one surface, a component each."""
    names = list(dict.fromkeys(labels))
    points = np.concatenate(looks).reshape(-1, 3)
    component = np.repeat([names.index(label) for label in labels], [len(look) for look in looks])
    return merged(Surface(points, np.arange(len(points)).reshape(-1, 3), component, named(names)))


def _labels(solids: list[tuple[int, int]]) -> list[str]:
    """A name for each solid: its own in the file, or its colour, or none."""
    gmsh.model.occ.synchronize()
    labels = []
    for number, solid in enumerate(solids, start=1):
        own = gmsh.model.getEntityName(*solid).split("/")[-1]
        own = "" if own.startswith("Open CASCADE") else own  # its own signature
        *colour, opacity = gmsh.model.getColor(*solid)
        coloured = "" if opacity == 0 or colour == [0, 0, 255] else "colour_" + "".join(f"{value:02x}" for value in colour)
        labels.append(own or coloured or (f"part_{number}" if len(solids) > 1 else "body"))
    return labels


class Nearest:
    """Which component of a surface other triangles lie on: that of the nearest triangle which faces the same way."""

    def __init__(self, surface: Surface) -> None:
        self.scale = float(np.ptp(surface.points, axis=0).max())
        centres, owner = finely(surface, 0.015 * self.scale)
        self._tree = self._key(centres, surface.area_vectors[owner])
        self._square = (self._tree**2).sum(axis=1)
        self._component = surface.component[owner]

    def _key(self, centres: np.ndarray, vectors: np.ndarray) -> np.ndarray:
        """Place and direction as one point of six coordinates; opposite sides of a fin are a tenth of the body apart."""
        normals = vectors / np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), 1e-300)
        return np.concatenate([centres, 0.05 * self.scale * normals], axis=1)

    def __call__(self, corners: np.ndarray) -> np.ndarray:
        """Components (n,) of triangles (n, 3, 3), normals out of the body."""
        return self._component[self._found(corners)[0]]

    def misfit(self, corners: np.ndarray) -> float:
        """How far triangles are, in place and direction, from the nearest ones, in the mean."""
        return float(self._found(corners)[1].mean())

    def _found(self, corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        keys = self._key(corners.mean(axis=1), np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
        found, off = np.empty(len(keys), dtype=np.int64), np.empty(len(keys))
        for first in range(0, len(keys), 500):
            part = slice(first, first + 500)
            square = self._square - 2.0 * keys[part] @ self._tree.T
            found[part] = np.argmin(square, axis=1)
            off[part] = square[np.arange(len(square)), found[part]] + (keys[part] ** 2).sum(axis=1)
        return found, off


def turned_and_moved(solids: list[tuple[int, int]], axes: np.ndarray) -> None:
    """Turn solids as the rotation in axes (3, 4) says, and move them by its last column, in the current model's lengths."""
    occ = gmsh.model.occ
    rotation = axes[:, :3] / np.cbrt(np.linalg.det(axes[:, :3]))
    if np.abs(rotation - np.eye(3)).max() > 1e-12:  # a turn by the last bit would spoil what lies exactly on planes of symmetry
        angle = math.acos(min(max(0.5 * (np.trace(rotation) - 1.0), -1.0), 1.0))
        # The axis is what the rotation leaves in place.
        values, vectors = np.linalg.eig(rotation)
        axis = np.real(vectors[:, np.argmin(np.abs(values - 1.0))])
        skew = np.array([rotation[2, 1] - rotation[1, 2], rotation[0, 2] - rotation[2, 0], rotation[1, 0] - rotation[0, 1]])
        if axis @ skew < 0.0:
            axis = -axis
        occ.rotate(solids, 0, 0, 0, *axis, angle)
    occ.translate(solids, *axes[:, 3])
