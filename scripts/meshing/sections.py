"""Sections of fins and wings: the outline of one at a given chord and thickness."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

CURVED = ("biconvex", "naca")
KINDS = ("single_wedge", "double_wedge", "hexagonal", "flat", *CURVED)
CURVE_POINTS = 25  # on each side of a curved section


@dataclass(frozen=True)
class Section:
    """A section; x from its leading edge backwards, n upwards, both in lengths.

    kind: one of KINDS. `ridge`: where a double wedge is thickest, share of the chord. `bevels`: lengths of the slopes at the leading
    and the trailing edge: of a hexagonal section shares of the chord, of a flat one lengths, where 0 leaves the edge blunt.
    `camber`, `camber_place`: of a NACA section, shares of the chord.
    """

    kind: str
    ridge: float = 0.5
    bevels: tuple[float, float] = (0.3, 0.3)
    camber: float = 0.0
    camber_place: float = 0.4

    @property
    def curved(self) -> bool:
        return self.kind in CURVED

    @property
    def blunt(self) -> bool:
        """Does it end in a face at the trailing edge?"""
        return self.kind == "single_wedge" or (self.kind == "flat" and self.bevels[1] == 0.0)

    def scaled(self, factor: float) -> Section:
        return replace(self, bevels=tuple(b * factor for b in self.bevels)) if self.kind == "flat" else self

    def outline(self, chord: float, thickness: float) -> tuple[np.ndarray, np.ndarray]:
        """Upper and lower side, each (k, 2) of x and n from the leading to the trailing edge; k depends on the kind alone."""
        half = 0.5 * thickness
        if self.kind == "naca":
            return self._naca(chord, thickness)
        if self.kind == "biconvex":
            t = 0.5 * (1.0 - np.cos(np.linspace(0.0, math.pi, CURVE_POINTS)))
            upper = np.column_stack([chord * t, 4.0 * half * t * (1.0 - t)])
        elif self.kind == "single_wedge":
            upper = np.array([[0.0, 0.0], [chord, half]])
        elif self.kind == "double_wedge":
            upper = np.array([[0.0, 0.0], [self.ridge * chord, half], [chord, 0.0]])
        elif self.kind == "hexagonal":
            upper = np.array([[0.0, 0.0], [self.bevels[0] * chord, half], [(1.0 - self.bevels[1]) * chord, half], [chord, 0.0]])
        else:
            # Where the chord is too short for both slopes they keep their angles, and the section becomes thinner.
            front, back = self.bevels
            share = min(1.0, 0.98 * chord / max(front + back, 1e-300))
            front, back, half = front * share, back * share, half * share
            rows = [[0.0, 0.0], [front, half]] if front > 0.0 else [[0.0, half]]
            rows += [[chord - back, half], [chord, 0.0]] if back > 0.0 else [[chord, half]]
            upper = np.array(rows)
        return upper, upper * [1.0, -1.0]

    def _naca(self, chord: float, thickness: float) -> tuple[np.ndarray, np.ndarray]:
        """NACA's four-digit section (NACA Report 460, 1933), its last coefficient such that the trailing edge is sharp."""
        x = 0.5 * (1.0 - np.cos(np.linspace(0.0, math.pi, CURVE_POINTS)))
        half = 5.0 * thickness / chord * (0.2969 * np.sqrt(x) - 0.1260 * x - 0.3516 * x**2 + 0.2843 * x**3 - 0.1036 * x**4)
        m, p = self.camber, self.camber_place
        ahead = x < p
        line = np.where(ahead, m / p**2 * (2.0 * p * x - x**2), m / (1.0 - p) ** 2 * (1.0 - 2.0 * p + 2.0 * p * x - x**2))
        slope = np.arctan(np.where(ahead, 2.0 * m / p**2 * (p - x), 2.0 * m / (1.0 - p) ** 2 * (p - x)))
        half[-1] = 0.0
        across = np.column_stack([-np.sin(slope), np.cos(slope)]) * half[:, None]
        middle = np.column_stack([x, line])
        return chord * (middle + across), chord * (middle - across)
