#!/usr/bin/python3
"""Draw a mesh of `mesh.py` (half model, Gmsh .msh): the surface with its fins, and the symmetry plane y = 0.

Needs the Debian packages python3-gmsh, python3-numpy and python3-matplotlib (hence /usr/bin/python3).
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))

try:
    import gmsh
    import matplotlib
    import numpy as np

    from meshing import toolbox as meshing
except ImportError as error:
    sys.exit(f"picture.py: {error}; install the Debian packages python3-gmsh and python3-matplotlib and use /usr/bin/python3")
matplotlib.use("Agg")
import matplotlib.pyplot as plt
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

COLOURS = {"body": "#b8c9d9", "fins": "#e3b778", "base": "#c98a8a"}


def surface(axes, mesh: meshing.TetMesh) -> None:
    """Draw the aft body and the fins in perspective; the mirror image of the half model is added."""
    triangles, colours = [], []
    for name, colour in COLOURS.items():
        part = mesh.points[mesh.patches[name]]
        part = part[part[:, :, 0].min(axis=1) > 7.4]
        triangles += [part, part * [1.0, -1.0, 1.0]]
        colours += [colour] * (2 * len(part))
    # One collection, because matplotlib sorts by depth inside a collection only.
    axes.add_collection3d(Poly3DCollection(np.concatenate(triangles), facecolor=colours, edgecolor="#303030", linewidth=0.15))
    axes.set(xlim=(7.4, 10.0), ylim=(-1.3, 1.3), zlim=(-1.3, 1.3))
    axes.set_box_aspect((1, 1, 1))
    axes.view_init(elev=24, azim=-130)
    axes.set_axis_off()


def plane(axes, mesh: meshing.TetMesh, limits: tuple[float, float, float, float]) -> None:
    """Draw the symmetry plane within limits (x0, x1, z0, z1), in d."""
    axes.triplot(mesh.points[:, 0], mesh.points[:, 2], mesh.patches["symmetry"], linewidth=0.25, color="#203040")
    axes.set(xlim=limits[:2], ylim=limits[2:], xlabel="x / d", ylabel="z / d", aspect="equal")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("mesh", type=Path, help="half model written by mesh.py")
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="FILE.png")
    arguments = parser.parse_args()
    gmsh.initialize(readConfigFiles=False)
    gmsh.option.setNumber("General.Terminal", 0)
    try:
        mesh = meshing.read(arguments.mesh)
        missing = {"symmetry", *COLOURS} - mesh.patches.keys()
        if missing:
            raise meshing.MeshError(f"{arguments.mesh} has no patch {', '.join(sorted(missing))}: give a half model")
        figure = plt.figure(figsize=(11, 7.5))
        surface(figure.add_axes([0.0, 0.36, 0.42, 0.66], projection="3d"), mesh)
        plane(figure.add_axes([0.47, 0.45, 0.51, 0.52]), mesh, (-1.0, 11.6, -7.0, 7.0))
        plane(figure.add_axes([0.06, 0.07, 0.92, 0.31]), mesh, (-0.3, 10.6, 0.0, 2.4))
        figure.savefig(arguments.output, dpi=80)
    except Exception as error:  # gmsh raises bare Exception
        sys.exit(f"picture.py: {error}")
    finally:
        gmsh.finalize()


if __name__ == "__main__":
    main()
