"""A size field as gmsh's background field: two grids of values, a fine one around the body inside a coarse one.

gmsh interpolates in them itself, which takes a twentieth of the time of calling Python for every point.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import gmsh
import numpy as np

LARGE = 1e22  # what gmsh takes for no wish
FINE_MOST, COARSE_MOST = 600_000, 60_000  # nodes


def grid(
    sizes: Callable[[np.ndarray], np.ndarray], low: np.ndarray, high: np.ndarray, spacing: float, most: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Origin, spacing and sizes (i, j, k) of a grid from `low` to `high`, of about `spacing` but at most `most` nodes."""
    extent = np.maximum(high - low, 1e-9)
    while np.prod(np.ceil(extent / spacing) + 1.0) > most:
        spacing *= 1.05
    counts = np.ceil(extent / spacing).astype(int) + 1
    steps = extent / (counts - 1)
    axes = [low[i] + steps[i] * np.arange(counts[i]) for i in range(3)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    return low, steps, sizes(points).reshape(counts)


def set_background(sizes: Callable[[np.ndarray], np.ndarray], h: float, near: np.ndarray, far: np.ndarray, folder: Path) -> None:
    """Make h * sizes the background field of the current model.

    near, far: boxes (2, 3), corners of the fine grid and of the coarse one. Files of the grids are put in `folder`, which must
    stay until the mesh is there.
    """
    fields = []
    origin, steps, values = grid(sizes, near[0], near[1], 0.75 * h, FINE_MOST)
    fields.append(_structured(folder / "near.bin", origin, steps, h * values))
    origin, steps, values = grid(sizes, far[0], far[1], 4.0 * h, COARSE_MOST)
    # Where the fine grid knows, the coarse one is silent, also in the cells that reach out of the fine one's box.
    inside = []
    for i in range(3):
        axis = origin[i] + steps[i] * np.arange(values.shape[i])
        margin = steps[i] * (near[:, i] != far[:, i])
        inside.append((axis >= near[0, i] + margin[0]) & (axis <= near[1, i] - margin[1]))
    values[np.ix_(*inside)] = LARGE
    fields.append(_structured(folder / "far.bin", origin, steps, h * values))
    least = gmsh.model.mesh.field.add("Min")
    gmsh.model.mesh.field.setNumbers(least, "FieldsList", fields)
    gmsh.model.mesh.field.setAsBackgroundMesh(least)


def _structured(path: Path, origin: np.ndarray, steps: np.ndarray, values: np.ndarray) -> int:
    """A field "Structured" of gmsh through a file in its binary layout."""
    with open(path, "wb") as file:
        file.write(np.asarray(origin, dtype="<f8").tobytes() + np.asarray(steps, dtype="<f8").tobytes())
        file.write(np.asarray(values.shape, dtype="<i4").tobytes() + np.ascontiguousarray(values, dtype="<f8").tobytes())
    field = gmsh.model.mesh.field.add("Structured")
    gmsh.model.mesh.field.setString(field, "FileName", str(path))
    gmsh.model.mesh.field.setNumber(field, "TextFormat", 0)
    gmsh.model.mesh.field.setNumber(field, "SetOutsideValue", 1)
    gmsh.model.mesh.field.setNumber(field, "OutsideValue", LARGE)
    return field
