"""Bodies for tests of surfaces: triangulations by numbers, and solids by OpenCASCADE."""

from __future__ import annotations

import math
from pathlib import Path

import gmsh
import numpy as np

Triangles = tuple[np.ndarray, np.ndarray]  # points (n, 3), triangles (m, 3), normals outwards


def revolved(profile: list[tuple[float, float]], around: int = 24) -> Triangles:
    """A body of revolution through points (x, r), on the axis at both ends."""
    angle = 2.0 * math.pi * np.arange(around) / around
    rings = [np.column_stack([np.full(around, x), r * np.cos(angle), r * np.sin(angle)]) for x, r in profile[1:-1]]
    points = np.concatenate([[[profile[0][0], 0.0, 0.0]], *rings, [[profile[-1][0], 0.0, 0.0]]])
    ring = lambda i: 1 + i * around + np.arange(around)
    turned = lambda row: np.roll(row, -1)
    first, last = ring(0), ring(len(rings) - 1)
    rows = [np.column_stack([np.zeros(around, dtype=int), turned(first), first])]
    for i in range(len(rings) - 1):
        a, b = ring(i), ring(i + 1)
        rows += [np.column_stack([a, turned(a), b]), np.column_stack([turned(a), turned(b), b])]
    rows.append(np.column_stack([np.full(around, len(points) - 1), last, turned(last)]))
    return points, np.concatenate(rows)


def cone_cylinder(around: int = 24) -> Triangles:
    """Three diameters of cone, four of cylinder, and a flat base."""
    along = [(3.0 * t, 0.5 * t) for t in np.linspace(0.0, 1.0, 9)] + [(x, 0.5) for x in np.linspace(3.0, 7.0, 11)[1:]]
    return revolved([*along, (7.0, 0.25), (7.0, 0.0)], around)


def ellipsoid() -> Triangles:
    """Four times as long as wide."""
    t = np.linspace(0.0, math.pi, 25)
    return revolved([(2.0 - 2.0 * math.cos(a), 0.5 * math.sin(a)) for a in t], 24)


def delta_wing() -> Triangles:
    """A thin wing of root chord 1 and half span 0.6, sharp all around, of eight triangles."""
    points = np.array([[0, 0, 0], [1, 0.6, 0], [1, -0.6, 0], [0.6, 0, 0.05], [0.6, 0, -0.05], [1, 0, 0]], dtype=float)
    upper = [[0, 1, 3], [0, 3, 2], [3, 1, 5], [3, 5, 2]]
    return points, np.array([*upper, *([a, c, b] for a, b, c in ([4 if p == 3 else p for p in row] for row in upper))])


def write_stl(path: Path, parts: dict[str, Triangles], binary: bool = False) -> Path:
    """One solid a part; binary files hold one."""
    if binary:
        corners = np.concatenate([points[triangles] for points, triangles in parts.values()])
        rows = np.zeros(len(corners), dtype=[("f", "<f4", 12), ("attribute", "<u2")])
        rows["f"][:, 3:] = corners.reshape(-1, 9)
        path.write_bytes(b" " * 80 + len(corners).to_bytes(4, "little") + rows.tobytes())
        return path
    lines = []
    for name, (points, triangles) in parts.items():
        lines.append(f"solid {name}")
        for corners in points[triangles]:
            lines += ["facet normal 0 0 0", "outer loop", *("vertex {:.9g} {:.9g} {:.9g}".format(*p) for p in corners), "endloop", "endfacet"]
        lines.append(f"endsolid {name}")
    path.write_text("\n".join(lines) + "\n")
    return path


def write_cad(path: Path, make: str) -> Path:
    """One of the solids below in OpenCASCADE's hands, millimetres."""
    gmsh.initialize(readConfigFiles=False)
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.model.add(make)
    SOLIDS[make]()
    gmsh.model.occ.synchronize()
    gmsh.write(str(path))
    gmsh.finalize()
    return path


def write_iges(path: Path, profile: list[tuple[float, float]]) -> Path:
    """A body of revolution through points (x, r), in millimetres, as loose faces: a surface of revolution (entity 120 of the Initial
    Graphics Exchange Specification 5.3) for each line of the profile."""
    axis = "110,0.,0.,0.,1.,0.,0.;"
    entities = [(110, axis)]
    for (x, r), (x_next, r_next) in zip(profile, profile[1:]):
        entities.append((110, f"110,{x:.4f},{r:.4f},0.,{x_next:.4f},{r_next:.4f},0.;"))
        entities.append((120, f"120,1,{2 * len(entities) - 1},0.,6.283185307179586;"))
    start = ["A body for a test"]
    units = "1H,,1H;,4Hbody,9Hbody.iges,5Htests,5Htests,32,38,6,308,15,4Hbody,1.,2,2HMM,1,1.,15H20000101.000000,1.E-4,1000.,,,11,0,;"
    header = [units[i : i + 72] for i in range(0, len(units), 72)]
    directory, parameters = [], []
    for number, (kind, text) in enumerate(entities):
        hidden = 0 if kind == 120 else 1  # lines serve the surfaces only
        place = len(parameters) + 1
        lines = [text[i : i + 64] for i in range(0, len(text), 64)]
        parameters += [f"{line:<64s} {2 * number + 1:7d}" for line in lines]
        directory.append("".join(f"{value:>8}" for value in (kind, place, 0, 0, 0, 0, 0, 0, f"00{hidden:02d}0000")))
        directory.append("".join(f"{value:>8}" for value in (kind, 0, 0, len(lines), 0, "", "", "", 0)))
    sections = {"S": start, "G": header, "D": directory, "P": parameters}
    sections["T"] = ["".join(f"{letter}{len(rows):7d}" for letter, rows in sections.items())]
    rows = [f"{row:<72s}{letter}{number:7d}" for letter, section in sections.items() for number, row in enumerate(section, start=1)]
    path.write_text("\n".join(rows) + "\n")
    return path


def _body(length: float = 700.0) -> list[tuple[int, int]]:
    occ = gmsh.model.occ
    cone, tube = (3, occ.addCone(0, 0, 0, 300, 0, 0, 0, 50)), (3, occ.addCylinder(300, 0, 0, length - 300, 0, 0, 50))
    return occ.fuse([cone], [tube])[0]


def _fin(roll: float) -> tuple[int, int]:
    """A double wedge of 100 by 80 on the body's end, 8 thick; `roll` in degrees from starboard."""
    occ = gmsh.model.occ
    points = [occ.addPoint(x, 0, z) for x, z in ((590, 0), (640, 4), (690, 0), (640, -4))]
    face = occ.addPlaneSurface([occ.addCurveLoop([occ.addLine(a, b) for a, b in zip(points, points[1:] + points[:1])])])
    fin = next(entity for entity in occ.extrude([(2, face)], 0, 130, 0) if entity[0] == 3)
    occ.rotate([fin], 0, 0, 0, 1, 0, 0, math.radians(roll))
    return fin


def finned() -> None:
    gmsh.model.occ.fuse(_body(), [_fin(45.0 + 90.0 * i) for i in range(4)])


def one_fin() -> None:
    gmsh.model.occ.fuse(_body(), [_fin(20.0)])


def apart() -> None:
    """Body and fins as solids of their own."""
    _body()
    _fin(0.0)
    _fin(180.0)


def blunt() -> None:
    occ = gmsh.model.occ
    ball, tube = (3, occ.addSphere(50, 0, 0, 50)), (3, occ.addCylinder(50, 0, 0, 350, 0, 0, 50))
    occ.fuse([ball], [tube])


def boattailed() -> None:
    occ = gmsh.model.occ
    occ.fuse(_body(), [(3, occ.addCone(700, 0, 0, 80, 0, 0, 50, 35))])


SOLIDS = {make.__name__: make for make in (finned, one_fin, apart, blunt, boattailed)}
