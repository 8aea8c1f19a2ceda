#!/usr/bin/python3
"""Steady flow over the cone beside Taylor and Maccoll's: mean pressure coefficient of the surface, and angle of the shock.

Reads result.json, surface.vtkhdf and flow.vtkhdf of runs at zero incidence. Needs Debian's python3-numpy and python3-h5py.
"""

from __future__ import annotations

import argparse
import csv
import json
import math
import sys
from dataclasses import dataclass
from pathlib import Path

try:
    import h5py
    import numpy as np
except ImportError as error:
    sys.exit(f"compare.py: {error}; install the Debian packages python3-h5py and python3-numpy and run with /usr/bin/python3")

REFERENCE = Path(__file__).resolve().parent / "reference" / "exact_cone_steady.csv"
CONE = 10.0  # degrees, half-angle
GAMMA = 1.4
# The shock is measured where the flow is conical, with neither the apex nor the coarse cells near that mesh.py makes where no wave
# comes back to the body from.
FROM, TO = 0.3, 0.6  # cone lengths
RING = 0.5  # degrees


@dataclass(frozen=True)
class Steady:
    """Mean Cp of the surface and shock angle in degrees at a Mach number."""

    mach: float
    cp: float
    shock: float


def exact(mach: float) -> Steady:
    """From the reference file; raises KeyError for a Mach number that it does not have."""
    with open(REFERENCE) as file:
        rows = csv.DictReader(line for line in file if not line.startswith("#"))
        return {
            float(row["Mach"]): Steady(float(row["Mach"]), float(row["Cp_surface"]), float(row["shock_angle_deg"])) for row in rows
        }[mach]


def surface_cp(path: Path) -> float:
    """Mean over the area of the body, tip included."""
    with h5py.File(path) as file:
        root = file["VTKHDF"]
        faces = root["Points"][:].astype(float)[root["Connectivity"][:].reshape(-1, 3)]
        cp, patch = root["CellData/cp"][:], root["CellData/patch"]
        body = patch[:] == patch.attrs["names"].decode().split("\n").index("body")
    area = np.linalg.norm(np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0]), axis=1)
    return float(np.average(cp[body], weights=area[body]))


def pressure_profile(path: Path, mach: float) -> tuple[np.ndarray, np.ndarray]:
    """Mean p / p_inf over rings of rays from the apex, and the angles of the rings in degrees, from the surface outwards."""
    with h5py.File(path) as file:
        root = file["VTKHDF"]
        corners = root["Points"][:].astype(float)[root["Connectivity"][:].reshape(-1, 4)]
        pressure = 1.0 + 0.5 * GAMMA * mach**2 * root["CellData/cp"][:]
    edges = corners[:, 1:] - corners[:, :1]
    volume = np.abs(np.einsum("ij,ij->i", np.cross(edges[:, 0], edges[:, 1]), edges[:, 2]))
    x, y, z = corners.mean(axis=1).T
    ray = np.degrees(np.arctan2(np.hypot(y, z), x))
    near = (x > FROM) & (x < TO)
    ring = (ray[near] / RING).astype(int)
    total = np.bincount(ring, volume[near])
    filled = total > 0.0
    mean = lambda values: np.bincount(ring, volume[near] * values[near])[filled] / total[filled]
    return mean(ray), mean(pressure)


def continued(mach: float, cp: float, rays: np.ndarray) -> np.ndarray:
    """p / p_inf at the angles `rays` (increasing, degrees) of the isentropic conical flow that has this Cp on the surface.

    Taylor and Maccoll's equation, integrated outwards; constant beyond the ray that the flow crosses at the speed of sound, where
    it ends. The shock's loss of total pressure is left out: 4e-4 at Mach 2.5.
    """
    total = (1.0 + 0.5 * (GAMMA - 1.0) * mach**2) ** (GAMMA / (GAMMA - 1.0))
    surface_mach2 = 2.0 / (GAMMA - 1.0) * ((total / (1.0 + 0.5 * GAMMA * mach**2 * cp)) ** ((GAMMA - 1.0) / GAMMA) - 1.0)

    def slope(angle: float, velocity: np.ndarray) -> np.ndarray:
        along, across = velocity  # in units of the largest speed
        sound2 = 0.5 * (GAMMA - 1.0) * (1.0 - velocity @ velocity)
        return np.array(
            [across, (across**2 * along - sound2 * (2.0 * along + across / math.tan(angle))) / (sound2 - across**2)]
        )

    angles = np.radians(np.concatenate([[CONE], rays]))
    velocity = np.array([math.sqrt(1.0 / (1.0 + 2.0 / ((GAMMA - 1.0) * surface_mach2))), 0.0])
    pressure: list[float] = []
    for angle, h in zip(angles, np.diff(angles)):
        speed2 = velocity @ velocity
        if velocity[1] ** 2 < 0.99 * 0.5 * (GAMMA - 1.0) * (1.0 - speed2):  # Runge-Kutta
            k1 = slope(angle, velocity)
            k2 = slope(angle + 0.5 * h, velocity + 0.5 * h * k1)
            k3 = slope(angle + 0.5 * h, velocity + 0.5 * h * k2)
            k4 = slope(angle + h, velocity + h * k3)
            velocity = velocity + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        pressure.append(total * (1.0 - velocity @ velocity) ** (GAMMA / (GAMMA - 1.0)))
    return np.array(pressure)


def shock_angle(mach: float, cp: float, ray: np.ndarray, pressure: np.ndarray) -> float:
    """Where a sharp shock would stand that holds as much excess pressure as the smeared one, in degrees.

    Behind the shock of a cone the pressure goes on to rise, within few of the cells that the shock is smeared over, so that neither
    the steepest place nor the middle of the rise is the shock. The flow behind is that of `continued`.
    """
    edges = np.linspace(ray[0], ray[-1], 4001)
    middle = 0.5 * (edges[1:] + edges[:-1])
    sharp = np.cumsum(continued(mach, cp, middle) - 1.0)
    return float(middle[np.searchsorted(sharp, np.sum(np.interp(middle, ray, pressure) - 1.0))])


def computed(folder: Path) -> tuple[Steady, int]:
    """What a run found, and its number of cells."""
    result = json.loads((folder / "result.json").read_text())
    mach = result["freestream"]["mach"]
    if result["freestream"]["alpha"] != 0.0:
        sys.exit(f"compare.py: {folder}: not at zero incidence")
    cp = surface_cp(folder / "surface.vtkhdf")
    shock = shock_angle(mach, cp, *pressure_profile(folder / "flow.vtkhdf", mach))
    return Steady(mach, cp, shock), result["mesh"]["cells"]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folders", type=Path, nargs="+", metavar="RUN", help="folder of a run")
    print(" Mach   cells      Cp   exact    error   shock   exact   error")
    for folder in parser.parse_args().folders:
        found, cells = computed(folder)
        true = exact(found.mach)
        print(
            f"{found.mach:5.2f} {cells:7d} {found.cp:.5f} {true.cp:.5f} {100 * (found.cp / true.cp - 1):+6.2f} %"
            f" {found.shock:7.2f} {true.shock:7.2f} {found.shock - true.shock:+7.2f} deg"
        )


if __name__ == "__main__":
    main()
