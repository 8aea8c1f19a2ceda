"""Diamond (symmetric double wedge): its exact first-order response to alpha, q and alphadot.

In front of the ridge the flow is the wedge's (`wedge`). At the ridge, half-way along the chord, a centred expansion turns it by
twice the half-angle (Prandtl and Meyer; NACA Report 1135, 1953), and behind its last ray it is uniform again. In polar coordinates
(r, theta) about the ridge a disturbance is a sum of parts r^n (a, b, p, rho)(theta), n = 0 (what arrives at the ridge) and n = 1;
those of alpha = t also grow with time. With the steady flow (U, V)(theta), P, R, U' = V, Euler's equations are

    V a' + n U a - V b + n p / R                                     = F_r
    V b' + (n + 1) U b + V' b + V a + p' / R - P' rho / R^2          = F_theta
    V rho' + n U rho + (U + V') rho + R [(n + 1) a + b'] + R' b      = F_rho
    V s' + n U s                                                     = F_s,       s = p / P - gamma rho / R

(those of the cone, without its third direction). In the fan V = -c: the rays are characteristics, and one combination of the
equations has no derivatives. The first and last rays move, where the slopes of the steady flow jump by multiples of (b, p, rho) =
(1, c R, R / c); a, s and p - c R b are continuous across them. That and the collocation of all four equations in Chebyshev's points
determine the disturbance of the fan. Behind it, it is again a polynomial, of degree n along and across the surface, determined by
the same three numbers, the surface, and the equations. Sources F and frame are those of the wedge.

Exact as long as the waves that the bow shock reflects pass behind the trailing edge, which is checked.
"""

from __future__ import annotations

import math

import numpy as np

from exact import wedge
from exact.derivatives import GAMMA, Longitudinal, NoExactFlow
from exact.wedge import DENSITY, PRESSURE, N, S, T, U, V

ORDER = 16  # of the polynomials in theta over the fan
A, B = U, V  # velocities along r and theta


def _turned(mach: float) -> float:
    """Prandtl and Meyer's angle, radians."""
    k = math.sqrt((GAMMA + 1.0) / (GAMMA - 1.0))
    m = math.sqrt(mach**2 - 1.0)
    return k * math.atan(m / k) - math.atan(m)


def _expanded(mach: float, angle: float) -> float:
    """Mach number behind an expansion by `angle`, radians."""
    low, high, aim = mach, 50.0, _turned(mach) + angle
    if _turned(high) < aim:
        raise NoExactFlow("the flow leaves the ridge")
    for _ in range(80):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if _turned(middle) < aim else (low, middle)
    return middle


def _polar(theta: np.ndarray) -> np.ndarray:
    """From components (x, z) to those along r and theta: (..., 2, 2)."""
    return np.moveaxis(np.array([[np.cos(theta), np.sin(theta)], [-np.sin(theta), np.cos(theta)]]), (0, 1), (-2, -1))


class _Fan:
    """The steady fan at Chebyshev's points, and its linear operators. Angles from x upwards, in radians; the flow goes downwards."""

    def __init__(self, state: tuple[float, float, float], first: float, last: float) -> None:
        w, p, r = state
        sound2 = GAMMA * p / r
        point = np.cos(np.pi * np.arange(ORDER + 1) / ORDER)  # 1 is the first ray
        self.theta = 0.5 * (first + last) + 0.5 * (first - last) * point
        # U = U_1 cos(k x) + c_1 / k sin(k x) with x the angle from the first ray: U' = V = -c and c' = k^2 U.
        k = math.sqrt((GAMMA - 1.0) / (GAMMA + 1.0))
        x = first - self.theta
        along = math.sqrt(w * w - sound2)
        self.u = along * np.cos(k * x) + math.sqrt(sound2) / k * np.sin(k * x)
        self.c = -k * along * np.sin(k * x) + math.sqrt(sound2) * np.cos(k * x)
        warmth = self.c**2 / sound2
        self.p, self.r = p * warmth ** (GAMMA / (GAMMA - 1.0)), r * warmth ** (1.0 / (GAMMA - 1.0))
        weight = np.where((point == point[0]) | (point == point[-1]), 2.0, 1.0) * (-1.0) ** np.arange(ORDER + 1)
        apart = point[:, None] - point[None, :] + np.eye(ORDER + 1)
        slope = weight[:, None] / weight[None, :] / apart
        slope -= np.diag(slope.sum(axis=1))
        self.slope = slope * 2.0 / (first - last)

    def operators(self, n: int) -> tuple[np.ndarray, np.ndarray]:
        """E and K of E y' + K y = F at every point, y = (a, b, p, rho)."""
        u, c, p, r = self.u, self.c, self.p, self.r
        v, v_slope = -c, -(GAMMA - 1.0) / (GAMMA + 1.0) * u
        p_slope = c * r * (u + v_slope)
        r_slope = p_slope / c**2
        e, k = np.zeros((2, ORDER + 1, 4, 4))
        e[:, 0, A] = e[:, 1, B] = e[:, 2, DENSITY] = v
        e[:, 1, PRESSURE], e[:, 2, B] = 1.0 / r, r
        e[:, 3, PRESSURE], e[:, 3, DENSITY] = v / p, -GAMMA * v / r
        k[:, 0, A], k[:, 0, B], k[:, 0, PRESSURE] = n * u, -v, n / r
        k[:, 1, B], k[:, 1, A], k[:, 1, DENSITY] = (n + 1) * u + v_slope, v, -p_slope / r**2
        k[:, 2, DENSITY], k[:, 2, A], k[:, 2, B] = n * u + u + v_slope, (n + 1) * r, r_slope
        k[:, 3, PRESSURE], k[:, 3, DENSITY] = n * u / p - v * p_slope / p**2, -GAMMA * (n * u / r - v * r_slope / r**2)
        return e, k

    def continuous(self, i: int) -> np.ndarray:
        """a, s and p - c R b at point i, from (a, b, p, rho)."""
        p, r = self.p[i], self.r[i]
        return np.array([[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0 / p, -GAMMA / r], [0.0, -self.c[i] * r, 1.0, 0.0]])

    def solve(self, n: int, arriving: np.ndarray, source: np.ndarray) -> np.ndarray:
        """y at every point (points, 4), for what arrives at the first ray (4) and the sources (points, 4)."""
        e, k = self.operators(n)
        size = 4 * (ORDER + 1)
        matrix = np.einsum("ij,iab->iajb", self.slope, e) + np.einsum("ij,iab->iajb", np.eye(ORDER + 1), k)
        first = np.zeros((3, ORDER + 1, 4))
        first[:, 0] = self.continuous(0)
        matrix = np.concatenate([matrix.reshape(size, size), first.reshape(3, size)])
        right = np.concatenate([source.ravel(), self.continuous(0) @ arriving])
        return np.linalg.lstsq(matrix, right, rcond=None)[0].reshape(-1, 4)

    def growth(self, y: np.ndarray) -> np.ndarray:
        """-dF of a disturbance that grows: the derivatives with time in the four equations (points, 4)."""
        return np.column_stack([y[:, A], y[:, B], y[:, DENSITY], y[:, PRESSURE] / self.p - GAMMA * y[:, DENSITY] / self.r])


def _behind(
    fan: _Fan, delta: float, leaving: list[np.ndarray], growing: np.ndarray, force: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Behind the fan: the constants (u, v, p, rho) and their slopes (4, 2) along and across the rear surface.

    `leaving`: y of degrees 0 and 1 on the last ray; `growing`: the rate of the constants; `force` (x, z) on a unit of mass.
    """
    theta, p, r = fan.theta[-1], fan.p[-1], fan.r[-1]
    w, sound2 = math.hypot(fan.u[-1], fan.c[-1]), GAMMA * p / r
    surface = _polar(-delta)  # (x, z) to along and across
    to_polar = np.eye(4)
    to_polar[:2, :2] = _polar(theta) @ surface.T
    taken = fan.continuous(-1) @ to_polar
    constants = np.linalg.solve(np.concatenate([taken, [[0.0, 1.0, 0.0, 0.0]]]), [*(fan.continuous(-1) @ leaving[0]), 0.0])

    matrix, right = np.zeros((8, 8)), np.zeros(8)
    at = lambda field, coefficient: 2 * field + coefficient
    for row, field, slope in ((0, U, S), (1, V, N)):
        matrix[row, at(field, S)], matrix[row, at(PRESSURE, slope)] = w, 1.0 / r
    right[:2] = surface @ force - growing[:2]
    matrix[2, [at(DENSITY, S), at(U, S), at(V, N)]] = w, r, r
    right[2] = -growing[DENSITY]
    matrix[3, [at(PRESSURE, S), at(DENSITY, S)]] = w, -sound2 * w
    right[3] = sound2 * growing[DENSITY] - growing[PRESSURE]
    matrix[4, at(V, S)] = 1.0
    for field in range(4):  # at r = 1 on the last ray
        matrix[5:, at(field, S)] = taken[:, field] * math.cos(theta + delta)
        matrix[5:, at(field, N)] = taken[:, field] * math.sin(theta + delta)
    right[5:] = fan.continuous(-1) @ leaving[1]
    return constants, np.linalg.solve(matrix, right).reshape(4, 2)


def _check_reflections(delta: float, shock: float, first: float, fan_end_mach: float) -> None:
    """Raises NoExactFlow when the first ray meets the shock so early that its reflection comes back to the body."""
    ridge = 0.5 * math.tan(delta)
    meets = (ridge - 0.5 * math.tan(first)) / (math.tan(shock) - math.tan(first)) if first > shock else math.inf
    steepest = delta + math.asin(1.0 / fan_end_mach)
    if meets * math.tan(shock) / math.tan(steepest) + meets < 1.0:
        raise NoExactFlow("waves from the bow shock come back to the diamond")


def derivatives(half_angle: float, mach: float) -> Longitudinal:
    """About the leading edge, chord as length, per unit span. Half-angle in degrees. Raises NoExactFlow."""
    delta = math.radians(half_angle)
    flow = wedge.front(half_angle, mach)
    w, p, r = flow.state
    mach_1 = w / math.sqrt(GAMMA * p / r)
    mach_2 = _expanded(mach_1, 2.0 * delta)
    fan = _Fan(flow.state, delta + math.asin(1.0 / mach_1), -delta + math.asin(1.0 / mach_2))
    _check_reflections(delta, flow.shock, fan.theta[0], mach_2)

    first = fan.theta[0]
    to_polar = np.eye(4)
    to_polar[:2, :2] = _polar(first) @ _polar(delta).T
    ray = np.array([math.cos(first - delta), math.sin(first - delta)])  # s and n of r = 1 on the first ray
    edge = 0.5 / math.cos(delta)  # s of the ridge
    calm = np.zeros((ORDER + 1, 4))
    up = np.array([0.0, 1.0])

    def with_force(force: np.ndarray) -> np.ndarray:
        """Sources (points, 4) from the force (points, 2) along r and theta."""
        return np.column_stack([force, calm[:, :2]])

    # alpha = t: what grows, what is constant at the ridge, and what varies from there.
    met = flow.growing
    grows = fan.solve(0, to_polar @ met[:, T], calm)
    constant = fan.solve(0, to_polar @ (met[:, S] * edge), calm)
    lift = mach * _polar(fan.theta) @ up
    varies = fan.solve(1, to_polar @ (met[:, [S, N]] @ ray), with_force(lift) - fan.growth(grows))
    nothing = np.zeros(4)
    rate = _behind(fan, delta, [grows[-1], nothing], nothing, np.zeros(2))[0]
    by_rate = _behind(fan, delta, [constant[-1], varies[-1]], rate, mach * up)
    # q about the leading edge.
    met = flow.turning
    constant = fan.solve(0, to_polar @ (met[:, S] * edge), calm)
    coriolis = np.column_stack([-fan.c, -fan.u])  # y x (U, V)
    varies = fan.solve(1, to_polar @ (met[:, [S, N]] @ ray), with_force(-lift - 2.0 * coriolis))
    last = math.hypot(fan.u[-1], fan.c[-1]) * np.array([-math.sin(delta), -math.cos(delta)])  # y x velocity behind the fan
    by_q = _behind(fan, delta, [constant[-1], varies[-1]], nothing, -mach * up - 2.0 * last)

    unit = 2.0 / (0.5 * mach**2)
    x, z = 0.5, 0.5 * math.tan(delta)

    def loads(front: tuple[float, float], rear: tuple[float, float]) -> tuple[float, float]:
        """CN and Cm of pressures (constant, slope along the surface) from the leading edge and from the ridge."""
        total = lambda f: f[0] * edge + f[1] * edge**2 / 2.0
        first_moment = lambda f: f[0] * edge**2 / 2.0 + f[1] * edge**3 / 3.0
        force = total(front) + total(rear)
        arm = x * math.cos(delta) - z * math.sin(delta)  # of the ridge, along the rear surface
        return -unit * math.cos(delta) * force, unit * (first_moment(front) + arm * total(rear) + first_moment(rear))

    alpha = loads((flow.growing[PRESSURE, T], 0.0), (rate[PRESSURE], 0.0))
    q = loads((0.0, flow.turning[PRESSURE, S]), (by_q[0][PRESSURE], by_q[1][PRESSURE, S]))
    alphadot = loads((0.0, flow.growing[PRESSURE, S]), (by_rate[0][PRESSURE], by_rate[1][PRESSURE, S]))
    scale = 2.0 * mach
    return Longitudinal(*alpha, scale * q[0], scale * q[1], scale * alphadot[0], scale * alphadot[1])
