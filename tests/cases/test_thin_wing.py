#!/usr/bin/python3
"""A rectangular wing without thickness, a surface inside the mesh that mesh.thin makes a wall with two sides, beside its thick twin.

Both have an aspect ratio of 2 in a stream of Mach 2, the twin a double wedge of 2 %. Linear theory (scripts/exact/wing.py) is exact in
the limit of no thickness.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import gmsh

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))
from exact import wing

MACH, ASPECT_RATIO, CENTER, THICKNESS = 2.0, 2.0, 0.5, 0.02
SPAN = 0.5 * ASPECT_RATIO  # of the half, in chords
LOW, HIGH = (-0.2, 0.0, -0.9), (1.3, 1.7, 0.9)  # of the flow
SIZES = 0.06, 0.2  # on the wing and far away
CASE = f"""
[mesh]
file = "wing.msh"
[reference]
length = 1.0
area = {ASPECT_RATIO}
moment_center = [{CENTER}, 0, 0]
model = "half"
[freestream]
mach = {MACH}
[boundary]
wing = "wall"
symmetry = "symmetry"
farfield = "farfield"
[[controls]]
name = "turned"
patches = ["wing"]
hinge = {{point = [0.25, 0, 0], axis = [0, 1, 0]}}
"""


def make_mesh(is_thin: bool, path: Path) -> None:
    """The flow about the half y >= 0 of the wing."""
    occ = gmsh.model.occ
    flow = (3, occ.addBox(*LOW, *(b - a for a, b in zip(LOW, HIGH))))
    if is_thin:
        (volume, *_), _ = occ.fragment([flow], [(2, occ.addRectangle(0, 0, 0, 1, SPAN))])
    else:
        corners = [occ.addPoint(x, 0, z) for x, z in ((0, 0), (0.5, 0.5 * THICKNESS), (1, 0), (0.5, -0.5 * THICKNESS))]
        loop = occ.addCurveLoop([occ.addLine(corners[i], corners[(i + 1) % 4]) for i in range(4)])
        body = occ.extrude([(2, occ.addPlaneSurface([loop]))], 0, SPAN, 0)
        (volume, *_), _ = occ.cut([flow], [entity for entity in body if entity[0] == 3])
    occ.synchronize()
    near = 1e-3
    within = lambda low, high: [tag for _, tag in gmsh.model.getEntitiesInBoundingBox(*(v - near for v in low), *(v + near for v in high), 2)]
    surfaces = {tag for _, tag in gmsh.model.getEntities(2)}
    half = 0.5 * THICKNESS
    groups = {"wing": set(within((0, 0, -half), (1, SPAN, half)))}
    groups["symmetry"] = set(within(LOW, (HIGH[0], 0, HIGH[2])))
    groups["farfield"] = surfaces - groups["wing"] - groups["symmetry"]
    for name, tags in groups.items():
        gmsh.model.setPhysicalName(2, gmsh.model.addPhysicalGroup(2, sorted(tags)), name)
    gmsh.model.setPhysicalName(3, gmsh.model.addPhysicalGroup(3, [volume[1]]), "air")
    field = gmsh.model.mesh.field
    field.add("Distance", 1)
    field.setNumbers(1, "SurfacesList", sorted(groups["wing"]))
    field.add("Threshold", 2)
    for option, value in {"InField": 1, "SizeMin": SIZES[0], "SizeMax": SIZES[1], "DistMin": 0.06, "DistMax": 0.8}.items():
        field.setNumber(2, option, value)
    field.setAsBackgroundMesh(2)
    for option in ("ExtendFromBoundary", "FromPoints"):
        gmsh.option.setNumber(f"Mesh.MeshSize{option}", 0)
    gmsh.model.mesh.generate(3)
    gmsh.write(str(path))


def derivatives(is_thin: bool) -> dict[str, float]:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        gmsh.initialize()
        try:
            gmsh.option.setNumber("General.Terminal", 0)
            make_mesh(is_thin, folder / "wing.msh")
        finally:
            gmsh.finalize()
        (folder / "wing.toml").write_text(CASE)
        command = [os.environ["ALPHADOT"], "derivatives", folder / "wing.toml", "--out", folder / "out", "--quiet"]
        subprocess.run(command + (["--set", 'mesh.thin=["wing"]'] if is_thin else []), check=True)
        result = json.loads((folder / "out" / "result.json").read_text())
        print("thin" if is_thin else "thick", result["mesh"]["cells"], "cells")
        return {key: entry["value"] for key, entry in result["derivatives"].items()} | {"CA": result["forces"]["CA"]}


class ThinWing(unittest.TestCase):
    def test_beside_linear_theory_and_the_thick_twin(self) -> None:
        thin, thick = derivatives(True), derivatives(False)
        exact = wing.rectangular(MACH, ASPECT_RATIO).about(CENTER).as_dict()
        for name, value in exact.items():
            print(f"{name:12} exact {value:8.4f}  thin {thin[name]:8.4f}  thick {thick[name]:8.4f}")
        # The coarse mesh costs both the same few per cent. About the middle of the chord the neutral point, and with it CN_q, is a small
        # difference, which thickness changes: there the wing that has none is nearer to the theory.
        for name, of_theory, of_twin in (("CN_alpha", 0.05, 0.01), ("Cm_q", 0.02, 0.01), ("CN_alphadot", 0.2, 0.05)):
            with self.subTest(name):
                self.assertAlmostEqual(thin[name], exact[name], delta=of_theory * abs(exact[name]))
                self.assertAlmostEqual(thin[name], thick[name], delta=of_twin * abs(thick[name]))
        for name in ("Cm_alpha", "CN_q"):
            with self.subTest(name):
                self.assertAlmostEqual(thin[name], exact[name], delta=0.02 * exact["CN_alpha"])
                self.assertLess(abs(thin[name] - exact[name]), 0.5 * abs(thick[name] - exact[name]))
        # All of the wing turns on the plane that it stands on: to linear theory no other thing than incidence; the thick one keeps its
        # axial force along itself.
        for found in (thin, thick):
            print(f"turned: CN {found['CN_turned']:.4f}, Cm {found['Cm_turned']:.4f}; CN_alpha {found['CN_alpha']:.4f}")
            self.assertAlmostEqual(found["CN_turned"] + found["CA"], found["CN_alpha"], delta=0.01 * exact["CN_alpha"])
            self.assertAlmostEqual(found["Cm_turned"], found["Cm_alpha"], delta=0.01 * exact["CN_alpha"])
            self.assertAlmostEqual(found["CN_turned"], exact["CN_alpha"], delta=0.05 * exact["CN_alpha"])


if __name__ == "__main__":
    unittest.main()
