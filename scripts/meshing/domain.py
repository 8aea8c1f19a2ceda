"""The outer boundary of the fluid, from the flight condition: a frustum outside the bow shock, or a sphere far away.

Lengths in diameters of the body. The frustum lies outside of the bow shock at the lowest Mach number and incidence, so that no wave
comes back from it, and ends behind the base in supersonic outflow. Below `SPHERE_BELOW` the body's pressure reaches everywhere: a
sphere, of a radius at which it no longer matters.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from exact import NoExactFlow, cone
from meshing.missile import Flight, Missile

SPHERE_BELOW = 1.2  # Mach number
SPHERE = 50.0  # its radius, in lengths of the body
MARGIN = 3.0  # degrees between the bow shock and the far field, beyond the incidence


@dataclass(frozen=True)
class Shock:
    """The bow shock in a half plane through the axis: r = (x - start) tan(angle), never ahead of it; degrees."""

    start: float
    angle: float

    def radius(self, x: np.ndarray) -> np.ndarray:
        return np.maximum(x - self.start, 0.0) * math.tan(math.radians(self.angle))


def bow_shock(missile: Missile, mach: float) -> Shock:
    """Where the bow shock is at most, at zero incidence; mach > 1.

    Pointed noses: that of the cone of the same angle at the tip (Taylor and Maccoll). Blunt and detached ones: Billig's hyperbola
    for a sphere-cone (J. Spacecraft Rockets 4, 1967, 822), as the cone that encloses it beside the body.
    """
    body = missile.body
    nose = body.segments[0]
    angle = math.degrees(math.atan2(*(nose.pieces[0].points[1] - nose.pieces[0].points[0])[::-1]))  # at the very tip
    mean = body.nose_angle()
    if mean >= angle - 8.0:
        try:
            return Shock(0.0, cone.shock_angle(max(angle, 1.0), mach))
        except NoExactFlow:
            pass
    mach_angle = math.degrees(math.asin(1.0 / mach))
    try:
        far = cone.shock_angle(min(max(mean, 1.0), 30.0), mach)
    except NoExactFlow:
        far = 0.5 * (mach_angle + 90.0)
    nose_radius = min(_tip_radius(missile), 0.5)
    stand_off = 0.143 * nose_radius * math.exp(3.24 / mach**2)
    curvature = 1.143 * nose_radius * math.exp(0.54 / (mach - 1.0) ** 1.2)
    # The hyperbola, measured at twice the body's radius, and its cone from there on.
    slope = math.tan(math.radians(far))
    reach = 1.0
    x = -stand_off + curvature / slope**2 * (math.sqrt(1.0 + (reach * slope / curvature) ** 2) - 1.0)
    return Shock(min(x - reach / slope, -stand_off), far)


def _tip_radius(missile: Missile) -> float:
    """Radius of a sphere that is as blunt as the nose over its first hundredth of a diameter."""
    x = 0.01
    r = float(missile.body.radius(np.array([x]))[0])
    return 0.5 * (r**2 / x + x)


@dataclass(frozen=True)
class Domain:
    """The fluid's outer boundary as a profile (n, 2) from the axis behind the body to the axis ahead of it.

    `shock` at the lowest Mach number and `beta` there where the flow is supersonic, else None; `arc`: the profile is half a circle.
    """

    profile: np.ndarray
    arc: bool
    shock: Shock | None
    beta: float

    def facts(self, length: float, flight: Flight, unit: float) -> list[str]:
        """What a user should know of it: lengths times `unit`, `length` of the body in the unit."""
        length, low = length / unit, flight.mach[0]
        if self.arc:
            radius = self.profile[0, 0] - 0.5 * length
            return [f"far field: sphere of {radius / length:g} body lengths, radius {radius * unit:.4g}"]
        (end, radius), (start, first) = self.profile[1], self.profile[2]
        angle = math.degrees(math.atan2(radius - first, end - start))
        return [
            f"far field: frustum of {angle:.1f} deg from x = {start * unit:.4g} to {end * unit:.4g}, outside the bow shock of "
            f"{self.shock.angle:.1f} deg at Mach {low:g}; supersonic outflow {(end - length) * unit:.4g} behind the base"
        ]


def domain_of(missile: Missile) -> Domain:
    """The far field for a missile in diameters."""
    length, (low, high) = missile.body.length, missile.flight.mach
    shock = bow_shock(missile, max(low, SPHERE_BELOW)) if high >= SPHERE_BELOW else None
    beta = math.sqrt(max(low, SPHERE_BELOW) ** 2 - 1.0)
    if low < SPHERE_BELOW:
        radius = SPHERE * length
        return Domain(np.array([[0.5 * length + radius, 0.0], [0.5 * length - radius, 0.0]]), True, shock, beta)
    angle = min(shock.angle + missile.flight.alpha + MARGIN, 80.0)
    slope = math.tan(math.radians(angle))
    # Fins may end behind the base.
    last = max([length, *(float(panel.x + panel.planform.trail.max()) for panel in missile.panels)])
    end = last + 1.5
    first = 0.35
    start = min(shock.start, 0.0) - max(0.6, first / slope)
    radius = first + (end - start) * slope
    # The fins' own shocks start at their tips, which the bow shock may not enclose; nor a body that is wide behind a slender nose.
    tips = [(panel.x + panel.planform.lead.min(), panel.tip + math.hypot(*panel.origin)) for panel in missile.panels]
    for x, r in (*tips, *missile.body.outline()):
        reach = float(r + 0.3 - slope * (x - start))
        if reach > first:
            radius += reach - first
            first = reach
    return Domain(np.array([[end, 0.0], [end, radius], [start, first], [start, 0.0]]), False, shock, beta)
