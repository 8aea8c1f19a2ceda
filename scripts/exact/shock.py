"""The jump conditions at a shock in the free stream, and the angle of an oblique one (NACA Report 1135, 1953)."""

from __future__ import annotations

import math

import numpy as np

from exact.derivatives import GAMMA, NoExactFlow


def behind_shock(normal: np.ndarray, speed: complex, velocity: np.ndarray) -> np.ndarray:
    """The components of the velocity, the pressure and the density behind a shock that moves with `speed` along its unit `normal`.

    The wind `velocity` blows against the normal, in units of its speed of sound; densities are in its own, pressures in gamma times
    its own. Analytic, so that complex steps differentiate it.
    """
    across = normal @ velocity - speed
    mach2 = across * across
    ratio = (GAMMA + 1.0) * mach2 / ((GAMMA - 1.0) * mach2 + 2.0)
    pressure = (1.0 + 2.0 * GAMMA / (GAMMA + 1.0) * (mach2 - 1.0)) / GAMMA
    return np.array([*(velocity - across * (1.0 - 1.0 / ratio) * normal), pressure, ratio])


def deflection(shock: float, mach: float) -> float:
    """By which an oblique shock turns the flow; angles in radians."""
    across2 = (mach * math.sin(shock)) ** 2
    return math.atan(2.0 / math.tan(shock) * (across2 - 1.0) / (mach**2 * (GAMMA + math.cos(2.0 * shock)) + 2.0))


def oblique_angle(turned: float, mach: float) -> float:
    """Of the weak shock that turns the flow so; radians. Raises NoExactFlow where none is attached."""
    angles = np.linspace(math.asin(min(1.0 / mach, 1.0)), 0.5 * math.pi, 2001)
    beyond = [i for i, angle in enumerate(angles) if deflection(angle, mach) > turned]
    if turned <= 0.0 or not beyond:
        raise NoExactFlow(f"no attached shock turns Mach {mach} by {math.degrees(turned):g} degrees")
    low, high = angles[beyond[0] - 1], angles[beyond[0]]
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if deflection(middle, mach) < turned else (low, middle)
    return middle
