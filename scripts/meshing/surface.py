"""Triangulated surfaces of bodies and their files: STL, OBJ and Cart3D's .tri with component names."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from meshing.toml_file import DescriptionError

CLOSE = 1e-6  # of the largest extent: points that are one
SUFFIXES = (".stl", ".obj", ".tri")


@dataclass(frozen=True)
class Surface:
    """points (n, 3), triangles (m, 3), and for each triangle the index (m,) of its component among the names."""

    points: np.ndarray
    triangles: np.ndarray
    component: np.ndarray
    names: tuple[str, ...]

    @property
    def corners(self) -> np.ndarray:
        """(m, 3 corners, 3)."""
        return self.points[self.triangles]

    @property
    def area_vectors(self) -> np.ndarray:
        """Of the triangles (m, 3), by the right-hand rule."""
        p = self.corners
        return 0.5 * np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])

    @property
    def volume(self) -> float:
        """Enclosed, positive where the triangles' normals point outwards."""
        return float(np.einsum("ij,ij->", self.area_vectors, self.corners.mean(axis=1)) / 3.0)


def read_surface(path: Path) -> Surface:
    """A surface from a file, told by the end of its name, equal points made one. Raises DescriptionError."""
    reader = {".stl": _stl, ".obj": _obj, ".tri": _tri}[path.suffix.lower()]
    try:
        points, triangles, component, names = reader(path)
    except OSError as error:
        raise DescriptionError([f"{path}: {error.strerror or error}"]) from None
    except (ValueError, IndexError, UnicodeDecodeError) as error:
        raise DescriptionError([f"{path}: is damaged, or not {path.suffix.upper()[1:]}: {error}"]) from None
    if len(triangles) == 0:
        raise DescriptionError([f"{path}: holds no triangles"])
    if not np.all(np.isfinite(points)):
        raise DescriptionError([f"{path}: point {int(np.flatnonzero(~np.isfinite(points).all(axis=1))[0]) + 1} is not finite"])
    if triangles.min() < 0 or triangles.max() >= len(points):
        raise DescriptionError([f"{path}: a triangle names point {int(triangles.max()) + 1}, of {len(points)}"])
    return merged(Surface(points, triangles, component, names))


def merged(surface: Surface) -> Surface:
    """The surface with points that are nearly in one place made one, and without triangles that then have no area."""
    extent = float(np.ptp(surface.points, axis=0).max())
    # Cells of a grid; points in neighbouring cells may still be one, so it is done again with the grid moved by half.
    number = np.arange(len(surface.points))
    for shift in (0.0, 0.5):
        cells = np.floor((surface.points - surface.points.min(axis=0)) / (CLOSE * extent) + shift).astype(np.int64)
        _, first, same = np.unique(cells[number], axis=0, return_index=True, return_inverse=True)
        number = number[first[same.ravel()]]
    used, renumbered = np.unique(number, return_inverse=True)
    triangles = renumbered[surface.triangles]
    a, b, c = triangles.T
    real = (a != b) & (b != c) & (c != a)
    return Surface(surface.points[used], triangles[real], surface.component[real], surface.names)


def named(names: list[str]) -> tuple[str, ...]:
    """Names fit for patches, each once; nameless ones are numbered."""
    out: list[str] = []
    for number, name in enumerate(names, start=1):
        name = re.sub(r"[^A-Za-z0-9_-]+", "_", name.strip()).strip("_") or (f"part_{number}" if len(names) > 1 else "body")
        if name in ("symmetry", "farfield", "fluid", "base"):
            name += "_part"
        while name in out:
            name += "_2"
        out.append(name)
    return tuple(out)


def _stl(path: Path) -> tuple[np.ndarray, np.ndarray, np.ndarray, tuple[str, ...]]:
    data = path.read_bytes()
    count = int.from_bytes(data[80:84], "little") if len(data) >= 84 else -1
    if len(data) == 84 + 50 * count:
        rows = np.frombuffer(data, dtype=np.dtype([("f", "<f4", 12), ("attribute", "<u2")]), offset=84)
        points = rows["f"][:, 3:].astype(float).reshape(-1, 3)
        return points, np.arange(len(points)).reshape(-1, 3), np.zeros(count, dtype=np.int64), named([""])
    if not data.lstrip().startswith(b"solid"):
        raise ValueError(f"{len(data)} bytes for {max(count, 0)} triangles" if count >= 0 else "the file is too short")
    points, component, names = [], [], []
    for line_number, line in enumerate(data.decode(errors="replace").splitlines(), start=1):
        words = line.split()
        if not words:
            continue
        if words[0] == "solid":
            names.append(" ".join(words[1:]))
        elif words[0] == "vertex":
            if len(words) != 4:
                raise ValueError(f"line {line_number}: a vertex has three coordinates")
            points.append([float(word) for word in words[1:]])
        elif words[0] == "endfacet":
            component.append(len(names) - 1)
    if len(points) != 3 * len(component):
        raise ValueError(f"{len(points)} vertices for {len(component)} facets")
    triangles = np.arange(len(points)).reshape(-1, 3)
    return np.array(points).reshape(-1, 3), triangles, np.array(component, dtype=np.int64), named(names)


def _obj(path: Path) -> tuple[np.ndarray, np.ndarray, np.ndarray, tuple[str, ...]]:
    points, triangles, component, names, current = [], [], [], [""], 0
    for line in path.read_text().splitlines():
        words = line.split()
        if not words:
            continue
        if words[0] == "v":
            points.append([float(word) for word in words[1:4]])
        elif words[0] in ("o", "g"):
            name = " ".join(words[1:])
            if name not in names:
                names.append(name)
            current = names.index(name)
        elif words[0] == "f":
            corners = [int(word.split("/")[0]) for word in words[1:]]
            corners = [corner - 1 if corner > 0 else len(points) + corner for corner in corners]
            triangles += [[corners[0], b, c] for b, c in zip(corners[1:], corners[2:])]
            component += [current] * (len(corners) - 2)
    used, of_triangle = np.unique(component, return_inverse=True)
    kept = named([names[i] for i in used])
    return np.array(points).reshape(-1, 3), np.array(triangles).reshape(-1, 3), of_triangle.reshape(-1), kept


def _tri(path: Path) -> tuple[np.ndarray, np.ndarray, np.ndarray, tuple[str, ...]]:
    """Cart3D: the numbers of points and triangles, the points, the triangles from 1 and, if there are, components' numbers."""
    words = path.read_text().split()
    n, m = int(words[0]), int(words[1])
    after = 2 + 3 * n + 3 * m
    if n < 4 or m < 4 or len(words) < after:
        raise ValueError(f"{len(words)} numbers, of {after} for {n} points and {m} triangles")
    points = np.array(words[2 : 2 + 3 * n], dtype=float).reshape(-1, 3)
    triangles = np.array(words[2 + 3 * n : after], dtype=float).astype(np.int64).reshape(-1, 3) - 1
    labels = np.array(words[after : after + m], dtype=float).astype(np.int64) if len(words) >= after + m else np.ones(m, dtype=np.int64)
    known = _configuration(path)
    used, component = np.unique(labels, return_inverse=True)
    return points, triangles, component.reshape(-1), named([known.get(int(label), f"part_{label}") for label in used])


def _configuration(path: Path) -> dict[int, str]:
    """Names of components by their number, from the Config.xml beside the file."""
    file = path.with_name("Config.xml")
    if not file.exists():
        return {}
    try:
        root = ElementTree.parse(file).getroot()
    except ElementTree.ParseError as error:
        raise DescriptionError([f"{file}:{error.position[0]}: is not XML: {error}"]) from None
    names = {}
    for component in root.iter("Component"):
        for number in re.findall(r"Face\s+Label\s*=\s*([0-9, ]+)", "".join(component.itertext())):
            names |= {int(one): component.get("Name", "") for one in number.replace(",", " ").split()}
    return names


def finely(surface: Surface, longest: float) -> tuple[np.ndarray, np.ndarray]:
    """Centres (k, 3) of the triangles, cut until no edge is longer than `longest`, and which triangle (k,) each is of."""
    corners, owner = surface.corners, np.arange(len(surface.triangles))
    done, owners = [], []
    for _ in range(40):
        sides = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2)
        long = sides.max(axis=1) > longest
        done.append(corners[~long].mean(axis=1))
        owners.append(owner[~long])
        if not np.any(long):
            break
        corners, owner, at = corners[long], owner[long], np.argmax(sides[long], axis=1)
        rows = np.arange(len(corners))
        a, b, c = (corners[rows, (at + i) % 3] for i in range(3))
        middle = 0.5 * (a + b)
        corners = np.concatenate([np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)])
        owner = np.concatenate([owner, owner])
    return np.concatenate(done), np.concatenate(owners)
