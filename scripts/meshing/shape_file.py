"""From a file with a body's surface to a shape: axes, unit, soundness, components and bases."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from meshing import cad, surface
from meshing.missile import Flight, Reference
from meshing.shape import Shape, with_bases
from meshing.soundness import sound
from meshing.surface import Surface

SUFFIXES = (*cad.SUFFIXES, *surface.SUFFIXES)
METRES = {"m": 1.0, "mm": 1e-3, "cm": 1e-2, "in": 0.0254, "ft": 0.3048}
CARRY_UNITS = (".step", ".stp", ".iges", ".igs")  # their files say what their lengths are


@dataclass(frozen=True)
class Box:
    """What of a surface has its middle between the corners `low` and `high` is called `name`."""

    name: str
    low: np.ndarray
    high: np.ndarray


def read_shape(
    path: Path, title: str = "", unit: str = "m", axes: tuple[str, ...] = ("x", "y", "z"), base: bool = True, boxes: tuple[Box, ...] = (),
    sharp: float = 30.0,
) -> Shape:
    """The body in a file, lengths in `unit`; its flight and reference are the defaults. Raises DescriptionError.

    `axes`: of the file, that point aft, to starboard and up. `sharp`: degrees that an edge turns by.
    """
    suffix = path.suffix.lower()
    is_cad = suffix in cad.SUFFIXES
    turn = np.array([[(-1.0 if word.startswith("-") else 1.0) * (word[-1] == axis) for axis in "xyz"] for word in axes])
    factor = 1.0 / METRES[unit] if suffix in CARRY_UNITS else 1.0
    if is_cad:
        found, symmetric = cad.read_cad(path, turn)
        found = replace(found, points=factor * found.points)
    else:
        found, symmetric = surface.read_surface(path), (True, True)
        found = replace(found, points=found.points @ turn.T)
    body = sound(found, str(path))
    body = _boxed(body, boxes)
    if base:
        body = with_bases(body, sharp)
    to_axes = np.column_stack([factor * turn, np.zeros(3)])
    notes = [f"lengths are in {unit}, and so is the mesh" + ("" if suffix in CARRY_UNITS else "; the file itself does not say")]
    shape = Shape(title or path.stem, unit, body, Flight(), Reference(1.0, 1.0, (0.0, 0.0, 0.0)), (), path if is_cad else None, to_axes, sharp, symmetric)
    low, high = body.points.min(axis=0), body.points.max(axis=0)
    extent = ", ".join(f"{axis} from {a:.4g} to {b:.4g}" for axis, a, b in zip("xyz", low, high))
    notes.append(f"the body: {extent} {unit}; {len(body.names)} components: {', '.join(body.names)}")
    if "base" in body.names:
        notes.append("what points straight aft between edges is the base: the free stream flows out of it, and it bears no load")
    return replace(shape, notes=tuple(notes))


def _boxed(body: Surface, boxes: tuple[Box, ...]) -> Surface:
    """With the components of the boxes, the last one where they overlap."""
    if not boxes:
        return body
    names = list(body.names)
    component = body.component.copy()
    middle = body.corners.mean(axis=1)
    for box in boxes:
        if box.name not in names:
            names.append(box.name)
        component[np.all((middle >= box.low) & (middle <= box.high), axis=1)] = names.index(box.name)
    used = np.unique(component)
    return replace(body, component=np.searchsorted(used, component), names=tuple(names[i] for i in used))
