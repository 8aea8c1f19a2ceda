"""The standard atmosphere of ICAO Doc 7488 (to 80 km the same as U.S. Standard Atmosphere 1976)."""

from __future__ import annotations

import math
from dataclasses import dataclass

from sweep.errors import SweepError

GRAVITY, GAS_CONSTANT, EARTH_RADIUS = 9.80665, 287.05287, 6_356_766.0  # m/s2, J/(kg K), m
BASES = (0.0, 11e3, 20e3, 32e3, 47e3, 51e3, 71e3)  # of the layers, geopotential metres
LAPSES = (-6.5e-3, 0.0, 1e-3, 2.8e-3, 0.0, -2.8e-3, -2e-3)  # K/m
LOWEST, HIGHEST = -5e3, 80e3


@dataclass(frozen=True)
class Air:
    temperature: float  # K
    pressure: float  # Pa
    density: float  # kg/m3
    sound_speed: float  # m/s
    viscosity: float  # Pa s, Sutherland's law


def air_at(altitude: float) -> Air:
    """At a geometric altitude in metres above the sea. Raises SweepError outside -5 to 80 km."""
    if not LOWEST <= altitude <= HIGHEST:
        raise SweepError(f"altitude {altitude:g} m: the standard atmosphere goes from {LOWEST:g} to {HIGHEST:g} m")
    height = EARTH_RADIUS * altitude / (EARTH_RADIUS + altitude)
    temperature, pressure = 288.15, 101_325.0
    for base, top, lapse in zip(BASES, (*BASES[1:], math.inf), LAPSES):
        thick = min(height, top) - base
        warm = temperature + lapse * thick
        if lapse:
            pressure *= (warm / temperature) ** (-GRAVITY / (GAS_CONSTANT * lapse))
        else:
            pressure *= math.exp(-GRAVITY * thick / (GAS_CONSTANT * temperature))
        temperature = warm
        if height <= top:
            break
    return Air(
        temperature,
        pressure,
        pressure / (GAS_CONSTANT * temperature),
        math.sqrt(1.4 * GAS_CONSTANT * temperature),
        1.458e-6 * temperature**1.5 / (temperature + 110.4),
    )
