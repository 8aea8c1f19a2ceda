"""Sharp symmetric wedge: its exact first-order response to alpha, q and alphadot.

G. F. Carrier, J. Aeronaut. Sci. 16, 1949, 150, and M. D. Van Dyke, NACA Report 1183, 1954: between the wedge and its attached
shock the flow is uniform, and slow motions of first order disturb it by polynomials. Written here as those of first degree: with s
along the upper surface, n outwards from it, and time t, relative to the body,

    u, v, p, rho = q_s s + q_n n + q_t t;     the shock stands at n = s tan(sigma - delta) + f_ss s^2 + f_st s t.

Euler's equations about the uniform state (W, 0, P, R) behind the shock,

    u_t + W u_s + p_s / R = F_s,   v_t + W v_s + p_n / R = F_n,
    rho_t + W rho_s + R (u_s + v_n) = 0,   (p - a^2 rho)_t + W (p - a^2 rho)_s = 0,

the surface, v_s = v_t = 0, and the four jump conditions at the moved shock, for s and for t, are fourteen equations for the
fourteen coefficients. With the wind M t z (alpha = t) and F = M z, the coefficients of t are the response to alpha, those of s that to
alphadot. With the wind -Omega x r (q = 1, about the apex) and F = -M z + 2 W n (frame turning about y), those of s are that to q.
Lengths are in chords, velocities in units of the free stream's speed of sound, densities in its own, pressures in gamma times its
own. The pressure on the base is left out.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from exact.derivatives import GAMMA, Longitudinal
from exact.shock import behind_shock, oblique_angle

U, V, PRESSURE, DENSITY = range(4)
S, N, T = range(3)
F_SS, F_ST = 12, 13  # among the unknowns; q_s, q_n, q_t of u, v, p, rho are 0 to 11


@dataclass(frozen=True)
class Front:
    """The flow between the upper surface and its shock, to first order."""

    state: tuple[float, float, float]  # W, P, R
    shock: float  # its angle sigma, radians
    growing: np.ndarray  # alpha = t: coefficients of (u, v, p, rho) by (s, n, t)
    turning: np.ndarray  # q = 1 about the apex: the same


def front(half_angle: float, mach: float) -> Front:
    """Half-angle in degrees; raises NoExactFlow if the shock is detached."""
    delta = math.radians(half_angle)
    sigma = oblique_angle(delta, mach)
    inside = sigma - delta
    along = np.array([math.cos(delta), math.sin(delta)])  # unit vectors of s and n in (x, z)
    outwards = np.array([-along[1], along[0]])

    def behind(turned: complex, speed: complex, wind: np.ndarray) -> np.ndarray:
        """u, v, p, rho behind the shock when it is turned outwards, moves, and meets more wind (components x, z)."""
        angle = sigma + turned
        normal = np.array([-np.sin(angle), np.cos(angle)])
        x, z, pressure, density = behind_shock(normal, speed, np.array([mach, 0.0]) + wind)
        velocity = np.array([x, z])
        return np.array([velocity @ along, velocity @ outwards, pressure, density])

    still = np.zeros(2)
    w, _, p, r = behind(0.0, 0.0, still).real
    sound2 = GAMMA * p / r
    step = 1e-30j
    by_turn = behind(step, 0.0, still).imag / step.imag
    by_speed = behind(0.0, step, still).imag / step.imag
    by_wind = np.array([behind(0.0, 0.0, step * unit).imag / step.imag for unit in np.eye(2)]).T

    matrix, right = np.zeros((14, 14)), np.zeros((14, 2))  # right sides: growing alpha, q
    at = lambda field, coefficient: 3 * field + coefficient
    up = np.array([0.0, 1.0])
    for row, field, slope in ((0, U, S), (1, V, N)):
        matrix[row, at(field, T)], matrix[row, at(field, S)], matrix[row, at(PRESSURE, slope)] = 1.0, w, 1.0 / r
    for column, force in enumerate((mach * up, -mach * up + 2.0 * w * outwards)):
        right[0:2, column] = force @ along, force @ outwards
    matrix[2, [at(DENSITY, T), at(DENSITY, S), at(U, S), at(V, N)]] = 1.0, w, r, r
    matrix[3, [at(PRESSURE, T), at(PRESSURE, S), at(DENSITY, T), at(DENSITY, S)]] = 1.0, w, -sound2, -sound2 * w
    matrix[4, at(V, S)] = matrix[5, at(V, T)] = 1.0
    # On the shock n = s tan(inside): q_s + tan(inside) q_n is what disturbances of s, q_t what those of t leave behind it.
    turn, speed = math.cos(inside) ** 2, math.cos(inside)
    where = along + math.tan(inside) * outwards  # for s = 1
    for field in range(4):
        of_s, of_t = 6 + field, 10 + field
        matrix[of_s, [at(field, S), at(field, N)]] = 1.0, math.tan(inside)
        matrix[of_s, [F_SS, F_ST]] = -2.0 * turn * by_turn[field], -speed * by_speed[field]
        matrix[of_t, [at(field, T), F_ST]] = 1.0, -turn * by_turn[field]
        right[of_t, 0] = by_wind[field] @ (mach * up)
        right[of_s, 1] = by_wind[field] @ np.array([-where[1], where[0]])
    growing, turning = np.linalg.solve(matrix, right).T[:, :12].reshape(2, 4, 3)
    return Front((w, p, r), sigma, growing, turning)


def derivatives(half_angle: float, mach: float) -> Longitudinal:
    """About the apex, chord as length, per unit span. Half-angle in degrees; raises NoExactFlow if the shock is detached."""
    flow = front(half_angle, mach)
    # Both sides: CN = -2 cos(delta) of the integral of p ds / q, Cm = 2 of that of s p ds / q, up to s = 1 / cos(delta).
    unit = 2.0 / (0.5 * mach**2)
    cosine = math.cos(math.radians(half_angle))
    force = lambda value, degree: -unit * value * cosine**-degree / (degree + 1)
    moment = lambda value, degree: unit * value * cosine ** (-degree - 2) / (degree + 2)
    by_alpha = flow.growing[PRESSURE, T]
    by_q, by_rate = (2.0 * mach * found[PRESSURE, S] for found in (flow.turning, flow.growing))
    return Longitudinal(
        force(by_alpha, 0), moment(by_alpha, 0), force(by_q, 1), moment(by_q, 1), force(by_rate, 1), moment(by_rate, 1)
    )
