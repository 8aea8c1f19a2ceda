"""Pictures of surface.vtkhdf and symmetry.vtkhdf: the pressure on a body, and its mesh."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.tri import Triangulation

from sweep.picture import Picture
from sweep.results import Entry, Results

FILE, PLANE = "surface.vtkhdf", "symmetry.vtkhdf"
WIDTH = 9.0
COLORS = "RdBu_r"
MOST = 8  # pictures of the pressure: each is some 100 kB of the page


@dataclass(frozen=True)
class Surface:
    """Boundary triangles: points (n, 3), corners (m, 3) into them, patch (m) into names, values at the points (n) by name."""

    points: np.ndarray
    corners: np.ndarray
    patch: np.ndarray
    names: list[str]
    values: dict[str, np.ndarray]

    @staticmethod
    def read(path: Path, length: float = 1.0) -> Surface:
        """With points in a length. Raises OSError, and KeyError for a file of another kind."""
        with h5py.File(path) as file:
            data = file["VTKHDF"]
            names = data["CellData/patch"].attrs["names"]
            text = names.decode() if isinstance(names, bytes) else str(names)
            return Surface(
                data["Points"][()] / length, data["Connectivity"][()].reshape(-1, 3), data["CellData/patch"][()], text.split("\n")[:-1],
                {name: values[()] for name, values in data["PointData"].items()},
            )  # fmt: skip

    @property
    def triangles(self) -> np.ndarray:
        """(m, 3, 3)"""
        return self.points[self.corners]


def has_surface(entry: Entry) -> bool:
    """A file that is there and of this version."""
    path = entry.run.folder / FILE
    if not path.exists():
        return False
    with h5py.File(path) as file:
        return "PointData" in file["VTKHDF"]


def seen_from_port(surface: Surface) -> np.ndarray:
    """The triangles that face an observer on the port side of the mirror image, the far ones first.

    x runs to the right and z up. The half model is starboard; its mirror image looks the same from the other side. Normals point into the
    body.
    """
    points = surface.triangles
    across = np.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0])[:, 1]
    order = np.argsort(points[:, :, 1].mean(axis=1))
    return order[across[order] < -1e-12]


def draw(axes: plt.Axes, triangles: np.ndarray, **style: object) -> None:
    axes.add_collection(PolyCollection(triangles[:, :, [0, 2]], **style))
    frame(axes, triangles.reshape(-1, 3))


def frame(axes: plt.Axes, points: np.ndarray) -> None:
    low, high = points[:, [0, 2]].min(axis=0), points[:, [0, 2]].max(axis=0)
    margin = 0.02 * (high - low).max()
    axes.set(xlim=(low[0] - margin, high[0] + margin), ylim=(low[1] - margin, high[1] + margin), aspect="equal")


def flows(results: Results, plain: bool = False) -> list[Entry]:
    """One a case, of some: the method does not matter to a steady flow, so the first of each
    condition and mesh."""
    cases: dict[tuple, Entry] = {}
    for entry in sorted(results.entries, key=lambda entry: entry.run.is_motion):
        run = entry.run
        cases.setdefault((entry.mach, run.alpha, run.beta, tuple(run.rates.values()), tuple(run.deflections.values()), run.mesh), entry)
    found = [cases[key] for key in sorted(cases) if has_surface(cases[key]) and (cases[key].run.is_plain or not plain)]
    return found if len(found) <= MOST else [found[round(i * (len(found) - 1) / (MOST - 1))] for i in range(MOST)]


def pressure_pictures(results: Results, folder: Path) -> tuple[Path | None, list[Picture]]:
    """The bar of colours of them all, and one a flow."""
    shown = [(entry, Surface.read(entry.run.folder / FILE, entry.result["reference"]["length"])) for entry in flows(results)]
    shown = [(entry, surface) for entry, surface in shown if len(seen_from_port(surface))]  # of a section there is nothing to see
    if not shown:
        return None, []
    limits = np.percentile(np.concatenate([surface.values["cp"] for _, surface in shown]), (0.5, 99.5))
    norm = matplotlib.colors.TwoSlopeNorm(0.0, min(limits[0], -1e-6), max(limits[1], 1e-6))
    return draw_scale(norm, folder), [draw_pressure(entry, surface, norm, folder) for entry, surface in shown]


def draw_scale(norm: matplotlib.colors.Normalize, folder: Path) -> Path:
    figure, axes = plt.subplots(figsize=(WIDTH, 0.7), layout="constrained")
    bar = figure.colorbar(matplotlib.cm.ScalarMappable(norm, COLORS), cax=axes, orientation="horizontal", extend="both")
    bar.set_label("Cp", labelpad=1)
    file = folder / "pressure_scale.svg"
    figure.savefig(file, metadata={"Date": None})
    plt.close(figure)
    return file


def draw_pressure(entry: Entry, surface: Surface, norm: matplotlib.colors.Normalize, folder: Path) -> Picture:
    """Side view coloured by Cp."""
    chosen = seen_from_port(surface)
    extent = np.ptp(surface.points, axis=0)
    height = np.clip(WIDTH * extent[2] / extent[0], 1.2, 8.0)
    figure, axes = plt.subplots(figsize=(WIDTH, height), layout="constrained")
    grid = Triangulation(surface.points[:, 0], surface.points[:, 2], surface.corners[chosen])
    axes.tripcolor(grid, surface.values["cp"], shading="gouraud", cmap=COLORS, norm=norm, rasterized=True)
    frame(axes, surface.points)
    axes.set_axis_off()
    name = f"pressure_{entry.run.name}"
    figure.savefig(folder / f"{name}.png", dpi=120)
    plt.close(figure)
    return Picture(folder / f"{name}.png", title_of(entry), f"{entry.result['mesh']['cells']:,} cells; from {entry.run.name}")


def title_of(entry: Entry) -> str:
    """The condition."""
    run = entry.run
    angles = [f"α = {run.alpha:.4g}°"] + [f"β = {run.beta:.4g}°"] * bool(run.beta)
    turned = [f"{name} = {value:g}" for name, value in run.rates.items() if value]
    turned += [f"{name} {value:g}°" for name, value in run.deflections.items() if value]
    return ", ".join([f"Mach {entry.mach:.4g}", *angles, *turned])


def mesh_pictures(results: Results, folder: Path) -> list[Picture]:
    """The surface and the plane of symmetry of every mesh, of the first MOST / 2."""
    meshes: dict[str, Entry] = {}
    for entry in results.entries:
        if has_surface(entry):
            meshes.setdefault(entry.result["mesh"]["hash"], entry)
    pictures = []
    for entry in list(meshes.values())[: MOST // 2]:
        length = entry.result["reference"]["length"]
        surface = Surface.read(entry.run.folder / FILE, length)
        mesh = entry.result["mesh"]
        label = f"{Path(mesh['file']).stem}: {mesh['cells']:,} tetrahedra, {mesh['points']:,} points"
        low, high = surface.points.min(axis=0), surface.points.max(axis=0)
        reach = 0.15 * (high[0] - low[0])
        seen = surface.triangles[seen_from_port(surface)]
        aft = seen[seen[:, :, 0].max(axis=1) > high[0] - 0.25 * (high[0] - low[0])]
        if len(aft):
            pictures.append(draw_mesh(aft, f"mesh_surface_{mesh['hash']}", f"{label}; surface, aft quarter", folder, "#d8e2ec"))
        if (entry.run.folder / PLANE).exists():
            plane = Surface.read(entry.run.folder / PLANE, length).triangles
            across = plane[:, :, [0, 2]]
            near = (across.max(axis=1) > low[[0, 2]] - reach) & (across.min(axis=1) < high[[0, 2]] + reach)
            name, title = f"mesh_plane_{mesh['hash']}", f"{label}; plane of symmetry near the body"
            pictures.append(draw_mesh(plane[near.all(axis=1)], name, title, folder, "white"))
    return pictures


def draw_mesh(triangles: np.ndarray, name: str, caption: str, folder: Path, color: str) -> Picture:
    figure, axes = plt.subplots(figsize=(6.0, 5.0), layout="constrained")
    draw(axes, triangles, facecolor=color, edgecolor="#203040", linewidth=0.25)
    axes.set_xlabel("x / length")
    axes.set_ylabel("z / length")
    figure.savefig(folder / f"{name}.png", dpi=130)
    plt.close(figure)
    return Picture(folder / f"{name}.png", caption.rsplit("; ", 1)[-1].capitalize(), caption)
