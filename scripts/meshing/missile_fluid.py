"""The fluid around a missile that is described part by part, for the mesher."""

from __future__ import annotations

import numpy as np

from meshing.alignment import align, divided
from meshing.domain import domain_of
from meshing.geometry import Classifier, build_fluid
from meshing.missile import Missile
from meshing.sector import sector_of
from meshing.sizes import SizeField, size_field
from meshing.tetrahedra import MeshError, TetMesh


class MissileFluid:
    """What the mesher wants to know of it; lengths in diameters. See mesher.Fluid."""

    def __init__(self, missile: Missile) -> None:
        self.missile = divided(missile.in_diameters())
        self.unit, self.origin = missile.diameter, np.zeros(3)
        self.domain, self.sector = domain_of(self.missile), sector_of(self.missile)

    def sizes(self, cells: float) -> SizeField:
        return size_field(lambda stretch: SizeField(self.missile, self.domain, stretch), self.sector, cells)

    def build(self) -> None:
        build_fluid(self.missile, self.domain, self.sector)

    def align(self, sizes: SizeField, h: float) -> None:
        align(self.missile, sizes, h)

    def box(self) -> np.ndarray:
        """Corners (2, 3) of a box around body and fins."""
        reach, last = 0.5, self.missile.body.length
        for panel in self.missile.panels:
            reach = max(reach, float(panel.tip) + float(np.hypot(*panel.origin)))
            last = max(last, float(panel.x + panel.planform.trail.max()))
        return np.array([[0.0, -reach, -reach], [last, reach, reach]])

    def patches(self, points: np.ndarray, faces: list[np.ndarray]) -> dict[str, np.ndarray]:
        classify = Classifier(self.missile, self.domain, self.sector)
        parts: dict[str, list[np.ndarray]] = {}
        for triangles in faces:
            parts.setdefault(classify(points[triangles.ravel()]), []).append(triangles)
        return {name: np.concatenate(patch) for name, patch in parts.items()}

    def components(self, mesh: TetMesh) -> TetMesh:
        """Each set of fins as a patch a panel, and the patches in the order of the description."""
        missile = self.missile
        patches: dict[str, np.ndarray] = {}
        order = [segment.name for segment in missile.body.segments]
        sets = dict.fromkeys(panel.set_name for panel in missile.panels)
        for name in order:
            if name in mesh.patches:
                patches[name] = mesh.patches[name]
        for name in sets:
            panels = [panel for panel in missile.panels if panel.set_name == name]
            triangles = mesh.patches[name]
            middle = mesh.points[triangles].mean(axis=1)
            # The panel whose middle plane is nearest, on the side where its span points to.
            off = []
            for panel in panels:
                local = panel.to_local(middle)
                off.append(np.where(local[:, 1] > 0.0, np.abs(local[:, 2]), np.inf))
            nearest = np.argmin(off, axis=0)
            for number, panel in enumerate(panels):
                if np.any(nearest == number):
                    patches[panel.name] = triangles[nearest == number]
        for name in ("base", "symmetry", "farfield"):
            if name in mesh.patches:
                patches[name] = mesh.patches[name]
        lost = set(mesh.patches) - set(patches) - set(sets)
        if lost:
            raise MeshError(f"patches {', '.join(sorted(lost))} have no place among the components")
        return TetMesh(mesh.points, mesh.tets, patches)
