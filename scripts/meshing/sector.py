"""The part of the space that is meshed: a quarter, a half or all of it, by the symmetries that are there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from meshing.missile import Missile, Panel


@dataclass(frozen=True)
class Sector:
    """Angles in degrees from starboard (y) towards up (z); `planes`: axes whose coordinate is 0 on a plane of symmetry."""

    name: str
    angles: tuple[float, float]
    planes: tuple[int, ...]

    @property
    def share(self) -> float:
        return (self.angles[1] - self.angles[0]) / 360.0

    def holds(self, panel: Panel) -> bool:
        """Does any of the panel lie in the sector?"""
        middle = np.array([[0.5 * (panel.planform.lead[0] + panel.planform.trail[0]), panel.tip, 0.0]])
        _, y, z = panel.to_space(middle)[0]
        return all((y, z)[axis - 1] >= -1e-6 for axis in self.planes)


QUARTER = Sector("quarter", (0.0, 90.0), (1, 2))
STARBOARD = Sector("starboard half", (-90.0, 90.0), (1,))
UPPER = Sector("upper half", (0.0, 180.0), (2,))
ALL = Sector("whole", (0.0, 360.0), ())


def sector_of(missile: Missile) -> Sector:
    """The smallest sector that the missile's symmetries allow."""
    symmetric = (missile.is_symmetric(1), missile.is_symmetric(2))
    return {(True, True): QUARTER, (True, False): STARBOARD, (False, True): UPPER, (False, False): ALL}[symmetric]
