"""Normal force slope and neutral point of a slender finned body by J. S. Barrowman's method, as the designers' programs compute them.

J. S. and J. A. Barrowman, The Theoretical Prediction of the Center of Pressure, NARAM-8, 1966; J. S. Barrowman, The Practical Calculation
of the Aerodynamic Characteristics of Slender Finned Vehicles, Catholic University of America, 1967. Each part of the body has the normal
force of slender-body theory, each fin that of Diederich's wing at the Mach number, increased by the interference of the body, at a quarter
of its mean aerodynamic chord. Subsonic; independent of solver and mesh. Needs numpy only.
"""

from __future__ import annotations

import math

import numpy as np

from meshing.missile import Missile, Panel
from meshing.profiles import Body, Segment, fine


def neutral_point(missile: Missile, mach: float = 0.0) -> tuple[float, float]:
    """CN_alpha per radian with the missile's reference area, and x of the neutral point; Mach number below 1."""
    parts = [segment_part(segment) for segment in missile.body.segments] + [step_part(*pair) for pair in _steps(missile.body)]
    parts += [fin_part(panel, mach) for panel in missile.panels]
    slope, moment = np.sum(parts, axis=0)
    return slope / missile.reference.area, moment / slope


def segment_part(segment: Segment) -> tuple[float, float]:
    """CN_alpha times the reference area, 2 (A(end) - A(start)), and its moment about x = 0: L A(end) - V from the segment's start."""
    x, r = np.concatenate([fine(piece.points) for piece in segment.pieces]).T
    area = math.pi * r**2
    # The volume exactly, as a row of frusta of cones.
    volume = math.pi / 3.0 * np.sum((r[1:] ** 2 + r[1:] * r[:-1] + r[:-1] ** 2) * np.diff(x))
    slope = 2.0 * (area[-1] - area[0])
    return slope, slope * x[0] + 2.0 * ((x[-1] - x[0]) * area[-1] - volume)


def _steps(body: Body) -> list[tuple[float, float, float]]:
    """x and the radii ahead of and behind each step of the profile."""
    return [(float(a.end[0]), float(a.end[1]), float(b.start[1])) for a, b in zip(body.segments, body.segments[1:]) if a.end[1] != b.start[1]]


def step_part(x: float, ahead: float, behind: float) -> tuple[float, float]:
    """As `segment_part`, of a step: a part without length."""
    slope = 2.0 * math.pi * (behind**2 - ahead**2)
    return slope, slope * x


def fin_part(panel: Panel, mach: float) -> tuple[float, float]:
    """As `segment_part`, of one panel with the body beside it: Diederich's slope with the interference 1 + r / (r + span); a panel that points
    sideways by its sine gets that share of the incidence, and gives that share of its force to the normal one."""
    plan = panel.planform
    s = np.linspace(0.0, plan.span, 2001)
    lead, trail = np.interp(s, plan.s, plan.lead), np.interp(s, plan.s, plan.trail)
    chord = trail - lead
    area = _integral(chord, s)
    middle = 0.5 * (lead + trail)
    slant = math.atan2(abs(middle[-1] - middle[0]), plan.span)
    aspect = 2.0 * plan.span**2 / area
    planform = math.sqrt(1.0 - mach**2) * aspect / math.cos(slant)
    slope = 2.0 * math.pi * aspect * area / (2.0 + math.sqrt(4.0 + planform**2))
    slope *= 1.0 + panel.root / (panel.root + plan.span)
    slope *= panel.span_direction[1] ** 2
    quarter = _integral((lead + 0.25 * chord) * chord, s) / area
    return slope, slope * (panel.x + quarter)


def _integral(values: np.ndarray, s: np.ndarray) -> float:
    return float(np.sum(0.5 * (values[1:] + values[:-1]) * np.diff(s)))
