"""Pressure where a plane cuts a body: the steady coefficient and its derivatives, from surface.vtkhdf of a run."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection

from sweep.errors import SweepError
from sweep.surface import Surface


@dataclass(frozen=True)
class Cut:
    """Pieces of the line: their ends (k, 2, 3), the patch of each (k) and the values at the ends (k, 2) by name."""

    label: str  # "x = 0.5", "y = 0", "fin_1 = 0.5"
    ends: np.ndarray
    patch: list[str]
    values: dict[str, np.ndarray]

    @property
    def is_across_x(self) -> bool:
        return self.label.startswith("x =")


def cut(surface: Surface, label: str, origin: np.ndarray, normal: np.ndarray, patches: set[str] | None = None) -> Cut:
    """By the plane through a point across a direction, of some patches or all; values linear along the edges of triangles."""
    chosen = [index for index, name in enumerate(surface.names) if patches is None or name in patches]
    corners = surface.corners[np.isin(surface.patch, chosen)]
    patch = surface.patch[np.isin(surface.patch, chosen)]
    height = (surface.points - origin) @ normal
    height[height == 0.0] = 1e-300  # a point in the plane is above it: each line is found once
    above = height[corners] > 0.0
    crossed = np.flatnonzero(above.any(axis=1) & ~above.all(axis=1))
    corners, above, patch = corners[crossed], above[crossed], patch[crossed]
    # The corner that is alone on its side, and its edges to the two others.
    alone = np.where(above.sum(axis=1) == 1, above.argmax(axis=1), (~above).argmax(axis=1))
    tip = np.take_along_axis(corners, alone[:, None], axis=1)
    others = np.take_along_axis(corners, (alone[:, None] + [1, 2]) % 3, axis=1)
    share = height[tip] / (height[tip] - height[others])  # (k, 2)
    between = lambda of: of[tip] + (share if of.ndim == 1 else share[..., None]) * (of[others] - of[tip])
    values = {name: between(of) for name, of in surface.values.items() if name.startswith("cp")}
    return Cut(label, between(surface.points), [surface.names[index] for index in patch], values)


def across_x(surface: Surface, x: float) -> Cut:
    return cut(surface, f"x = {x:g}", np.array([x, 0.0, 0.0]), np.array([1.0, 0.0, 0.0]))


def along_y(surface: Surface, y: float) -> Cut:
    """The plane y = 0 of a half model a hair to starboard, where there are triangles."""
    hair = 1e-6 * np.ptp(surface.points, axis=0).max()
    return cut(surface, f"y = {y:g}", np.array([0.0, y if y else hair, 0.0]), np.array([0.0, 1.0, 0.0]))


def across_fin(surface: Surface, patch: str, share: float) -> Cut:
    """Across a panel, at a share of its span from where it is nearest to the axis to where it is farthest. Raises SweepError."""
    if patch not in surface.names:
        raise SweepError(f"there is no patch '{patch}'; there are {', '.join(surface.names)}")
    points = surface.points[np.unique(surface.corners[surface.patch == surface.names.index(patch)])]
    if not len(points):
        raise SweepError(f"patch '{patch}' is no wall")
    away = np.hypot(points[:, 1], points[:, 2])
    root, tip = points[away.argmin()], points[away.argmax()]
    outboard = (tip - root) * [0.0, 1.0, 1.0]
    outboard /= np.linalg.norm(outboard)
    reach = points @ outboard
    at = reach.min() + share * np.ptp(reach)
    return cut(surface, f"{patch} = {share:g}", at * outboard, outboard, {patch})


def wanted(surface: Surface, places: dict) -> list[Cut]:
    """As {x = [0.5], y = [0], fins = {fin_1 = [0.5]}} says. Raises SweepError."""
    out = [across_x(surface, x) for x in places.get("x", [])] + [along_y(surface, y) for y in places.get("y", [])]
    return out + [across_fin(surface, patch, share) for patch, shares in places.get("fins", {}).items() for share in shares]


def write_csv(path: Path, head: str, cuts: dict[str, list[Cut]]) -> None:
    """By the name of a flow: a row an end of a piece, both ends of a piece one after the other."""
    names = list(dict.fromkeys(name for own in cuts.values() for one in own for name in one.values))
    lines = [f"# {head}", "# Ends of pieces of straight lines, two by two; cp by area from the faces around each point, linear between.",
             ",".join(("run", "cut", "patch", "x", "y", "z", *names))]  # fmt: skip
    for run, own in cuts.items():
        for one in own:
            columns = [one.values.get(name, np.full(one.ends.shape[:2], np.nan)).reshape(-1) for name in names]
            table = np.column_stack([one.ends.reshape(-1, 3), *columns])
            patches = np.repeat(one.patch, 2)
            lines += [f"{run},{one.label},{patch}," + ",".join(f"{value:.7g}" for value in row) for patch, row in zip(patches, table)]
    path.write_text("\n".join(lines) + "\n")


def draw(axes: plt.Axes, one: Cut, name: str, **style: object) -> None:
    """A quantity against x, or of a section across x against the angle from up towards starboard, degrees."""
    at = one.ends[..., 0]
    if one.is_across_x:
        at = np.degrees(np.arctan2(one.ends[..., 1], one.ends[..., 2]))
        whole = np.abs(np.diff(at)) < 180.0  # but for the piece where the angle begins anew
        at = np.where(whole, at, np.nan)
    pieces = np.stack([at, one.values[name]], axis=-1)
    axes.add_collection(LineCollection(pieces, **style))
    axes.autoscale_view()


def labels(one: Cut, name: str) -> dict[str, str]:
    """Of the axes."""
    by = name.removeprefix("cp").removeprefix("_")
    return {"xlabel": "angle from up to starboard, deg" if one.is_across_x else "x", "ylabel": f"dCp / d {by}" if by else "Cp"}
