"""The size of cells wanted at a point, from where on earlier meshes the errors of derivatives were made.

`alphadot adjoint --indicator` writes eta of each cell into indicator.vtkhdf: what the dissipation on its faces may do to derivatives. It
falls as volume times spacing squared, so that the density e = eta / (V h^2) belongs to the flow, not to the mesh. Cells of size s make an
error of e s^2 a volume, and 1 / s^3 of them fill it: of all meshes with as many cells, s ~ e^(-1/5) has the least sum of errors. Sizes
are nowhere more than `COARSEST` times those of a mesh of as many cells that is made from the description alone and has no caps away from
the body, because facets of curved walls are errors that no indicator sees.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np
from scipy.spatial import cKDTree

from meshing.sector import Sector
from meshing.sizes import PER_VOLUME, SizeField
from meshing.tetrahedra import MeshError

POWER = 0.2
GROWTH = 0.25  # of sizes, by distance
COARSEST, FINEST = 1.4, 0.2  # times the sizes of the description alone
NEIGHBOURS = 16  # over which the density is averaged, and from which sizes grow
SWEEPS = 30
REMEDY = "give indicator.vtkhdf of alphadot adjoint --indicator"


@dataclass(frozen=True)
class Errors:
    """Cells of an earlier mesh: centres (n, 3) in diameters, folded into the sector; how much of the sector's volume each stands for;
    densities of the error."""

    centres: np.ndarray
    volumes: np.ndarray
    density: np.ndarray


def read_errors(path: Path, unit: float, origin: np.ndarray, sector: Sector) -> Errors:
    """From indicator.vtkhdf, lengths in `unit` from `origin`. Raises MeshError."""
    try:
        with h5py.File(path) as file:
            points, cells = file["VTKHDF/Points"][:].astype(float), file["VTKHDF/Connectivity"][:].reshape(-1, 4)
            eta = file["VTKHDF/CellData/indicator"][:].astype(float)
    except (OSError, KeyError, ValueError) as error:
        raise MeshError(f"{path}: {error}; {REMEDY}") from None
    if len(eta) != len(cells) or not (np.all(np.isfinite(eta)) and np.all(eta >= 0.0) and np.any(eta > 0.0)):
        raise MeshError(f"{path}: its indicator is not one positive number a cell; {REMEDY}")
    corners = (points[cells] - origin) / unit
    volumes = np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1])) / 6.0
    centres = corners.mean(axis=1)
    images = 1
    for axis in sector.planes:
        images *= 2 if np.any(centres[:, axis] < 0.0) else 1
        centres[:, axis] = np.abs(centres[:, axis])
    # From cell to cell an indicator jumps with their shapes; sums over neighbours do not.
    _, near = cKDTree(centres).query(centres, k=min(NEIGHBOURS, len(centres)))
    density = eta[near].sum(axis=1) / (volumes[near] ** (5.0 / 3.0)).sum(axis=1)
    return Errors(centres, volumes / images, np.maximum(density, 1e-12 * density.max()))


class AdaptedSizes:
    """The function itself: points (n, 3) in diameters -> sizes (n,) in units of h, as sizes.SizeField.

    `plain`: sizes from the description alone; meshes of about `cells` tetrahedra in the sector, of all `errors` the smallest sizes.
    """

    def __init__(self, errors: list[Errors], plain: SizeField, sector: Sector, cells: float) -> None:
        self._h = (plain.cells(sector) / cells) ** (1.0 / 3.0)  # of the mesh from the description alone
        self._bound = plain.without_caps()
        self._errors = errors
        self._trees = [cKDTree(one.centres) for one in errors]
        self._logs = [np.log(self._wanted(one, tree, plain, cells)) for one, tree in zip(errors, self._trees)]

    def _wanted(self, errors: Errors, tree: cKDTree, plain: SizeField, cells: float) -> np.ndarray:
        """Sizes in units of h at the cells' centres, of which there are about `cells`."""
        shape = errors.density**-POWER
        least, most = FINEST * plain(errors.centres), COARSEST * self._bound(errors.centres)
        most = np.maximum(most, least)
        count = lambda size: PER_VOLUME * float(np.sum(errors.volumes / (self._h * size) ** 3))
        low, high = np.log(np.min(least / shape)), np.log(np.max(most / shape))
        for _ in range(60):
            middle = 0.5 * (low + high)
            size = np.clip(np.exp(middle) * shape, least, most)
            low, high = (middle, high) if count(size) > cells else (low, middle)
        distance, near = tree.query(errors.centres, k=min(NEIGHBOURS, len(size)))
        for _ in range(SWEEPS):
            grown = np.min(size[near] + GROWTH / self._h * distance, axis=1)
            if np.all(grown > 0.999 * size):
                break
            size = np.minimum(size, grown)
        return size

    def __call__(self, points: np.ndarray) -> np.ndarray:
        wanted = COARSEST * self._bound(points)
        for tree, logs in zip(self._trees, self._logs):
            distance, near = tree.query(points, k=4)
            weight = 1.0 / (distance + 1e-9)
            wanted = np.minimum(wanted, np.exp((weight * logs[near]).sum(axis=1) / weight.sum(axis=1)))
        return wanted

    def cells(self, sector: Sector) -> float:
        """Number of tetrahedra in the sector for h = 1."""
        first = self._errors[0]
        return PER_VOLUME * float(np.sum(first.volumes / self(first.centres) ** 3))
