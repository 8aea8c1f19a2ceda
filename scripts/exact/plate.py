#!/usr/bin/python3
"""A flat plate in supersonic flow that oscillates, or flies into a gust: exact linear theory.

The potential above the plate is -(1/beta) times the integral over the downwash ahead, with the kernel exp(-i w s) J0(w s / M),
w = omega c M^2 / (V beta^2) (I. E. Garrick & S. I. Rubinow, NACA Report 846, 1946); the pressure follows from it by Bernoulli's
equation. Per radian, chord 1, reference length the chord: CN and Cm (nose up) for alpha, for q = theta_dot c / 2V and for a gust w / V =
exp(i omega (t - (x - x0) / V)), each about the axis x0.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np


def bessel_j0(z: np.ndarray) -> np.ndarray:
    """By the trapezoidal rule on its integral over half a turn, exact to round-off for the arguments here."""
    angles = (np.arange(64) + 0.5) * math.pi / 64
    return np.cos(z[..., None] * np.sin(angles)).mean(-1)


@dataclass(frozen=True)
class Response:
    """Complex amplitudes; real: in phase."""

    CN: complex
    Cm: complex


def oscillating_plate(mach: float, k: float, x0: float) -> dict[str, Response]:
    """By Gauss's rule in x and in the integral of the potential; `k` = omega c / 2V."""
    beta = math.sqrt(mach * mach - 1)
    omega = 2 * k
    w = omega * mach**2 / beta**2
    nodes, weights = np.polynomial.legendre.leggauss(60)
    nodes, weights = 0.5 * (nodes + 1), 0.5 * weights  # on 0 to 1

    def potential(x: np.ndarray, angle: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
        """Above the plate, for a local incidence `angle(x)`."""
        s = x[:, None] * nodes
        kernel = np.exp(-1j * w * s) * bessel_j0(w * s / mach)
        return x * ((angle(x[:, None] - s) * kernel) @ weights) / beta

    out = {}
    incidences = {"alpha": np.ones_like, "q": lambda x: 2 * (x - x0), "gust": lambda x: np.exp(-1j * omega * (x - x0))}
    for name, angle in incidences.items():
        phi, at_end = potential(nodes, angle), potential(np.array([1.0]), angle)[0]
        # Cp below less above: 4 (i omega phi + dphi/dx); the latter by parts.
        force = 4 * (1j * omega * (phi @ weights) + at_end)
        moment = 4 * (1j * omega * ((phi * (nodes - x0)) @ weights) + at_end * (1 - x0) - phi @ weights)
        out[name] = Response(complex(force), complex(-moment))
    return out


def sharp_gust(mach: float, way: float) -> tuple[float, float]:
    """CN and Cm about the leading edge, per radian w / V, of a plate that has flown `way` chords into a gust with a sharp edge.

    In the frame of the air the leading edge starts normal velocity w at X' when it comes by, at -X' / V, but only in the gust, X' < 0.
    The pressure of a plane whose normal velocity starts so is rho a w / pi times the integral of dX' / sqrt(a^2 (t + X' / V)^2 - (X -
    X')^2) (acoustics of a half space; without an edge it is Ackeret's rho V w / sqrt(M^2 - 1)), here cut off at X' = 0 (M. A. Biot,
    J. Aeronaut. Sci. 16, 1949, 296).
    """
    nodes, weights = np.polynomial.legendre.leggauss(200)
    sound = way / mach
    # The pressure has corners where waves from the edge begin and end; Gauss's rule between them, dense at their square roots.
    corners = sorted({0.0, 1.0, *(min(max(x, 0.0), 1.0) for x in (way - sound, way, way + sound))})
    force = moment = 0.0
    for a, b in zip(corners, corners[1:]):
        x = a + (b - a) * 0.5 * (1 - np.cos(0.5 * math.pi * (nodes + 1)))
        dx = (b - a) * 0.25 * math.pi * np.sin(0.5 * math.pi * (nodes + 1)) * weights
        first, last = (x - way - sound) / (1 + 1 / mach), (x - way + sound) / (1 - 1 / mach)
        middle = np.clip((2 * np.minimum(last, 0.0) - first - last) / np.maximum(last - first, 1e-300), -1.0, 1.0)
        load = np.where(first >= 0, 0.0, 0.5 + np.arcsin(middle) / math.pi) * 4 / math.sqrt(mach**2 - 1)
        force += float(load @ dx)
        moment -= float((load * x) @ dx)
    return force, moment


if __name__ == "__main__":
    print("# Flat plate that oscillates or meets a sinusoidal gust, exact linear theory (Garrick & Rubinow 1946); chord 1, per rad; "
          "written by scripts/exact/plate.py")
    print("Mach,k,x0,variable,CN_in_phase,CN_out_of_phase,Cm_in_phase,Cm_out_of_phase")
    for mach in (1.58, 2.0, 2.5):
        for k in (0.01, 0.1, 0.5, 1.0):
            for name, found in oscillating_plate(mach, k, 0.0).items():
                parts = (found.CN.real, found.CN.imag / k, found.Cm.real, found.Cm.imag / k)
                print(f"{mach},{k},0,{name}," + ",".join(f"{part:.9f}" for part in parts))
