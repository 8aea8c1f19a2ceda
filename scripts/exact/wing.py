"""Thin wings without tips that influence each other: linear theory, to first order in the frequency.

C. E. Brown, NACA Report 839, 1946 (delta wing with supersonic leading edges, incidence); S. M. Harmon, NACA Report 925, 1949
(rectangular wing, rate derivatives). With B^2 = M^2 - 1 and the potential written as exp(-i omega M^2 x / (B^2 U)) times another, a
slow oscillation becomes a steady flow (J. W. Miles, The Potential Theory of Unsteady Supersonic Flow, 1959, ch. 1): to first order
only the steady potentials chi_1 and chi_2 of the downwashes 1 and x matter. Loads in units of the dynamic pressure, U = 1:

    by alpha     4 chi_1x
    by q         4 chi_2x                                            (about x = 0)
    by alphadot  4 [(M^2 / B^2) (chi_2x - x chi_1x) - chi_1 / B^2]

Summed over the span the potentials are polynomials in x:

- plate (no ends): chi_1x = 1 / B of the span;
- delta wing with supersonic leading edges: sources on the planform alone, hence the plate's with the downwash times the local span;
- rectangular wing of span b: inside the tip's Mach cone, y from the tip, chi_1x = (2 / pi B) arcsin sqrt(B y / x); both tips
  together take x / B of the span. Straight leading edges superpose: chi_2x = chi_1. Exact while the cones miss the other tip.

Rates times c / 2V with the (root) chord c, Cm about x = 0, area of the planform.
"""

from __future__ import annotations

import math

from numpy.polynomial import Polynomial

from exact.derivatives import Longitudinal, NoExactFlow

X = Polynomial([0.0, 1.0])  # in chords


def _beta(mach: float) -> float:
    if mach <= 1.0:
        raise NoExactFlow(f"linear theory of supersonic flow at Mach {mach}")
    return math.sqrt(mach**2 - 1.0)


def _derivatives(mach: float, area: float, chi_1x: Polynomial, chi_2x: Polynomial) -> Longitudinal:
    """From the potentials' slopes, summed over the span."""
    beta2 = mach**2 - 1.0
    by_rate = (mach**2 * (chi_2x - X * chi_1x) - chi_1x.integ()) / beta2
    force = lambda load: 4.0 / area * load.integ()(1.0)
    moment = lambda load: -force(X * load)
    return Longitudinal(
        force(chi_1x), moment(chi_1x), 2.0 * force(chi_2x), 2.0 * moment(chi_2x), 2.0 * force(by_rate), 2.0 * moment(by_rate)
    )


def plate(mach: float) -> Longitudinal:
    """Two-dimensional, about the leading edge."""
    one = Polynomial([1.0]) / _beta(mach)
    return _derivatives(mach, 1.0, one, X * one)


def delta(mach: float, sweep: float) -> Longitudinal:
    """About the apex; sweep of the leading edge in degrees. Raises NoExactFlow if it is subsonic."""
    beta, slope = _beta(mach), 1.0 / math.tan(math.radians(sweep))
    if beta * slope < 1.0:
        raise NoExactFlow(f"a leading edge swept by {sweep} degrees is subsonic at Mach {mach}")
    span = 2.0 * slope * X / beta
    return _derivatives(mach, slope, span, X * span)


def rectangular(mach: float, aspect_ratio: float) -> Longitudinal:
    """About the leading edge. Raises NoExactFlow where one tip's Mach cone meets the other tip."""
    beta = _beta(mach)
    if beta * aspect_ratio < 1.0:
        raise NoExactFlow(f"the tips of a rectangular wing of aspect ratio {aspect_ratio} meet at Mach {mach}")
    chi_1x = (aspect_ratio - X / beta) / beta
    return _derivatives(mach, aspect_ratio, chi_1x, chi_1x.integ())
