"""The picture of a mesh: the surface from the side, from above and from behind, with dimensions."""

from __future__ import annotations

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection

from meshing.case_file import KINDS, fin_sets
from meshing.mesher import Made
from meshing.missile import Missile
from meshing.shape import Shape

BODY, BASE = "#b8c9d9", "#c98a8a"
FINS = ("#e3b778", "#9cc49a", "#c3a6d4", "#d9c37e", "#8fbcc4")
# Of each view: axes across and up, and the direction from which it is seen.
VIEWS = {"from starboard": (0, 2, np.array([0.0, 1.0, 0.0])), "from above": (0, 1, np.array([0.0, 0.0, 1.0])),
         "from behind": (1, 2, np.array([1.0, 0.0, 0.0]))}  # fmt: skip


def draw(missile: Missile | Shape, made: Made, path: Path) -> None:
    """Write the picture, as PNG."""
    triangles, colours = _surface(missile, made)
    low, high = triangles.min(axis=(0, 1)), triangles.max(axis=(0, 1))
    length, wide, tall = high - low
    margin = 0.35 * max(wide, tall)  # for dimensions
    scale = 11.5 / (length + wide + 2.0 * margin)  # inches for a unit
    figure = plt.figure(figsize=(13.0, max(scale * (wide + tall + 2.0 * margin) + 1.8, 4.5)), layout="constrained")
    grid = figure.add_gridspec(2, 2, width_ratios=(length + margin, wide + margin), height_ratios=(tall + margin, wide + margin))
    places = {"from starboard": grid[0, 0], "from above": grid[1, 0], "from behind": grid[:, 1]}
    for title, place in places.items():
        axes = figure.add_subplot(place)
        _view(axes, triangles, colours, *VIEWS[title])
        axes.set_title(title, fontsize=8)
        axes.tick_params(labelsize=7)
    _dimensions(figure.axes, missile, low, high)
    sizes = "adapted" if made.h is None else f"wall cells {made.h * missile.diameter:.3g} {missile.unit}"
    title = f"{missile.title}: {len(made.mesh.tets):,} tetrahedra ({made.model} model), {sizes}; lengths in {missile.unit}"
    figure.suptitle(title, fontsize=9)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def _surface(missile: Missile | Shape, made: Made) -> tuple[np.ndarray, np.ndarray]:
    """Triangles (n, 3, 3) of the whole surface, mirrored where the mesh is a half, and a colour for each."""
    sets = fin_sets(missile)
    of_panel = {panel.name: FINS[sets.index(panel.set_name) % len(FINS)] for panel in missile.panels}
    triangles, colours = [], []
    for name, patch in made.mesh.patches.items():
        if name in ("symmetry", "farfield"):
            continue
        colour = matplotlib.colors.to_rgb(BASE if name in KINDS else of_panel.get(name, BODY))
        part = made.mesh.points[patch][:, ::-1]  # the mesh's outside is the body's inside
        triangles.append(part)
        if made.model == "half":
            triangles.append((part * [1.0, -1.0, 1.0])[:, ::-1])
        colours += [colour] * (len(part) * (2 if made.model == "half" else 1))
    return np.concatenate(triangles), np.array(colours)


def _view(axes: Axes, triangles: np.ndarray, colours: np.ndarray, across: int, up: int, eye: np.ndarray) -> None:
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    facing = normals @ eye
    seen = np.flatnonzero(facing > 1e-3)
    order = seen[np.argsort((triangles[seen] @ eye).mean(axis=1))]
    light = 0.55 + 0.45 * facing[order]
    axes.add_collection(
        PolyCollection(triangles[order][:, :, [across, up]], facecolor=colours[order] * light[:, None], edgecolor="#303030", linewidth=0.12)
    )
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.set_xlabel("xyz"[across], fontsize=8)
    axes.set_ylabel("xyz"[up], fontsize=8)


def _dimensions(axes: list[Axes], missile: Missile | Shape, low: np.ndarray, high: np.ndarray) -> None:
    """Length, diameter, span and moment centre."""
    side, above, behind = axes
    arrow = {"arrowstyle": "<->", "linewidth": 0.7}
    gap = 0.08 * (high[2] - low[2])
    center = missile.reference.moment_center

    def measure(on: Axes, start: tuple[float, float], end: tuple[float, float], text: str) -> None:
        on.annotate("", start, end, arrowprops=arrow)
        on.annotate(text, (0.5 * (start[0] + end[0]), 0.5 * (start[1] + end[1])), fontsize=7, ha="center", va="center",
                    bbox={"boxstyle": "square,pad=0.1", "facecolor": "white", "edgecolor": "none"})  # fmt: skip

    measure(side, (low[0], high[2] + gap), (low[0] + missile.length, high[2] + gap), f"length {missile.length:.4g}")
    side.set_ylim(low[2] - gap, high[2] + 2.0 * gap)
    side.plot(center[0], center[2], marker="P", color="#b02020", markersize=5)
    middle = low[0] + 0.45 * missile.length
    measure(above, (middle, -0.5 * missile.diameter), (middle, 0.5 * missile.diameter), f"d {missile.diameter:.4g}")
    for name in fin_sets(missile):
        panel = next(p for p in missile.panels if p.set_name == name)
        above.annotate(f"{name}: root {panel.planform.chord[0]:.4g}, tip {panel.planform.chord[-1]:.4g}, span {panel.planform.span:.4g}",
                       (panel.x + 0.5 * panel.planform.chord[0], low[1] - 0.5 * gap), fontsize=7, ha="center", va="top")  # fmt: skip
    above.set_ylim(low[1] - 3.0 * gap, high[1] + gap)
    measure(behind, (low[1], low[2] - gap), (high[1], low[2] - gap), f"{high[1] - low[1]:.4g}")
    behind.set_ylim(low[2] - 2.0 * gap, high[2] + gap)
