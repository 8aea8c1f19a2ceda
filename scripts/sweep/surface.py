"""Pictures of surface.vtkhdf: the pressure on a body, and its mesh."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection

from sweep.picture import Picture
from sweep.results import Entry, Results

FILE = "surface.vtkhdf"
WIDTH = 9.0
COLORS = "RdBu_r"
MOST = 8  # pictures of the pressure: each is some 100 kB of the page


@dataclass(frozen=True)
class Surface:
    """Boundary triangles: points (n, 3, 3) in the reference length, cp (n), patch (n) into names."""

    triangles: np.ndarray
    cp: np.ndarray
    patch: np.ndarray
    names: list[str]

    @staticmethod
    def read(path: Path, length: float) -> Surface:
        with h5py.File(path) as file:
            data = file["VTKHDF"]
            points = data["Points"][()] / length
            connectivity = data["Connectivity"][()].reshape(-1, 3)
            cells = data["CellData"]
            names = cells["patch"].attrs["names"]
            text = names.decode() if isinstance(names, bytes) else str(names)
            return Surface(points[connectivity], cells["cp"][()], cells["patch"][()], text.split())

    def part(self, names: list[str]) -> np.ndarray:
        """Indices of the triangles of some patches."""
        return np.flatnonzero(np.isin(self.patch, [self.names.index(name) for name in names if name in self.names]))


def body_patches(entry: Entry) -> list[str]:
    forces = entry.result["forces"]
    return [*forces["components"], *forces["excluded"]]


def seen_from_port(surface: Surface, chosen: np.ndarray) -> np.ndarray:
    """The triangles that face an observer on the port side of the mirror image, the far ones first.

    x runs to the right and z up. The half model is starboard; its mirror image looks the same from the other side.
    """
    points = surface.triangles[chosen]
    a, b = points[:, 1] - points[:, 0], points[:, 2] - points[:, 0]
    edge_on = np.abs(np.cross(a, b)[:, 1]) < 1e-12
    depth = points[:, :, 1].mean(axis=1)
    order = np.argsort(depth)
    return chosen[order[~edge_on[order]]]


def draw(axes: plt.Axes, triangles: np.ndarray, **style: object) -> PolyCollection:
    collection = PolyCollection(triangles[:, :, [0, 2]], **style)
    axes.add_collection(collection)
    low, high = triangles[:, :, [0, 2]].min(axis=(0, 1)), triangles[:, :, [0, 2]].max(axis=(0, 1))
    margin = 0.02 * (high - low).max()
    axes.set(xlim=(low[0] - margin, high[0] + margin), ylim=(low[1] - margin, high[1] + margin), aspect="equal")
    return collection


def pressure_pictures(results: Results, folder: Path) -> tuple[Path | None, list[Picture]]:
    """The bar of colours of them all, and one a case, of some: the method does not matter to a steady flow, so the first of each Mach
    number, angles, deflections and mesh."""
    cases: dict[tuple, Entry] = {}
    for entry in sorted(results.entries, key=lambda entry: entry.run.is_motion):
        if (entry.run.folder / FILE).exists():
            run = entry.run
            cases.setdefault((entry.mach, run.alpha, run.beta, tuple(run.deflections.values()), run.mesh), entry)
    chosen = sorted(cases)
    if len(chosen) > MOST:
        chosen = [chosen[round(i * (len(chosen) - 1) / (MOST - 1))] for i in range(MOST)]
    cases = {key: cases[key] for key in chosen}
    read = lambda entry: Surface.read(entry.run.folder / FILE, entry.result["reference"]["length"])
    values = {}
    for key, entry in cases.items():
        surface = read(entry)
        values[key] = surface.cp[surface.part(body_patches(entry))]
    if not values:
        return None, []
    joined = np.concatenate(list(values.values()))
    limits = np.percentile(joined, 0.5), np.percentile(joined, 99.5)
    norm = matplotlib.colors.TwoSlopeNorm(0.0, min(limits[0], -1e-6), max(limits[1], 1e-6))
    return draw_scale(norm, folder), [draw_pressure(entry, read(entry), norm, folder) for entry in cases.values()]


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
    chosen = seen_from_port(surface, surface.part(body_patches(entry)))
    triangles = surface.triangles[chosen]
    extent = np.ptp(triangles.reshape(-1, 3), axis=0)
    height = np.clip(WIDTH * extent[2] / extent[0], 1.2, 8.0)
    figure, axes = plt.subplots(figsize=(WIDTH, height), layout="constrained")
    # Edges in the colour of the face hide the hairlines between the faces.
    draw(axes, triangles, array=surface.cp[chosen], cmap=COLORS, norm=norm, edgecolor="face", linewidth=0.3, rasterized=True)
    axes.set_axis_off()
    name = f"pressure_{entry.run.name}"
    figure.savefig(folder / f"{name}.png", dpi=120)
    plt.close(figure)
    run = entry.run
    angles = [f"α = {run.alpha:.4g}°"] + [f"β = {run.beta:.4g}°"] * bool(run.beta)
    title = ", ".join([f"Mach {entry.mach:.4g}", *angles, *(f"{name} {value:g}°" for name, value in run.deflections.items() if value)])
    return Picture(folder / f"{name}.png", title, f"{entry.result['mesh']['cells']:,} cells; from {entry.run.name}")


def mesh_pictures(results: Results, folder: Path) -> list[Picture]:
    """The surface and the plane of symmetry of every mesh, of the first MOST / 2."""
    meshes: dict[str, Entry] = {}
    for entry in results.entries:
        if (entry.run.folder / FILE).exists():
            meshes.setdefault(entry.result["mesh"]["hash"], entry)
    pictures = []
    for entry in list(meshes.values())[: MOST // 2]:
        surface = Surface.read(entry.run.folder / FILE, entry.result["reference"]["length"])
        mesh = entry.result["mesh"]
        label = f"{Path(mesh['file']).stem}: {mesh['cells']:,} tetrahedra, {mesh['points']:,} points"
        body = surface.part(body_patches(entry))
        length = np.ptp(surface.triangles[body][:, :, 0])
        tail = surface.triangles[body][:, :, 0].max() - 0.25 * length
        chosen = seen_from_port(surface, body)
        aft = chosen[surface.triangles[chosen][:, :, 0].min(axis=1) > tail]
        pictures.append(
            draw_mesh(surface.triangles[aft], f"mesh_surface_{mesh['hash']}", f"{label}; surface, aft quarter", folder, "#d8e2ec")
        )
        plane = surface.part([name for name in surface.names if "symmetry" in name])
        if len(plane):
            near = surface.triangles[plane]
            limits = surface.triangles[body].reshape(-1, 3)[:, [0, 2]]
            reach = 0.15 * length
            inside = (near[:, :, [0, 2]].max(axis=1) > limits.min(axis=0) - reach) & (
                near[:, :, [0, 2]].min(axis=1) < limits.max(axis=0) + reach
            )
            shown = near[inside.all(axis=1)]
            pictures.append(
                draw_mesh(shown, f"mesh_plane_{mesh['hash']}", f"{label}; plane of symmetry near the body", folder, "white")
            )
    return pictures


def draw_mesh(triangles: np.ndarray, name: str, caption: str, folder: Path, color: str) -> Picture:
    figure, axes = plt.subplots(figsize=(6.0, 5.0), layout="constrained")
    draw(axes, triangles, facecolor=color, edgecolor="#203040", linewidth=0.25)
    axes.set_xlabel("x / length")
    axes.set_ylabel("z / length")
    figure.savefig(folder / f"{name}.png", dpi=130)
    plt.close(figure)
    return Picture(folder / f"{name}.png", caption.rsplit("; ", 1)[-1].capitalize(), caption)
