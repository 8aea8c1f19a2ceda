"""Sharp circular cone: Taylor and Maccoll's steady flow, and its exact first-order response to alpha, q and alphadot.

G. I. Taylor and J. W. Maccoll, Proc. R. Soc. Lond. A 139, 1933, 278 (steady flow); A. H. Stone, J. Math. Phys. 27, 1948, 67, and
J. L. Sims, NASA SP-3007, 1964 (small incidence). Rotation and a plunge that grows with time are the same perturbation one power of
the distance r from the apex higher.

Frame: fixed in the body, r and theta from the apex and the axis (x, aft), phi from z (up) to y (starboard). Velocities are relative
to the body and in units of the speed of sound of the free stream, densities in its own, pressures in gamma times its own. The steady
flow (U, V, 0)(theta), P, R is conical and irrotational, U' = V, with uniform entropy. A disturbance is

    (a, b, p, rho) r^n cos(phi) along r and theta, and of pressure and density;   c r^n sin(phi) along phi;

the shock moves outwards by the angle g r^n cos(phi). Linearised, times r^(1 - n):

    V a' + n U a - V b + n p / R                                                 = F_r
    V b' + (n + 1) U b + V' b + V a + p' / R - P' rho / R^2                      = F_theta
    V c' + (n + 1) U c + V cot(theta) c - p / (R sin(theta))                     = F_phi
    V rho' + n U rho + D rho + R [(n + 2) a + b' + cot(theta) b + c / sin(theta)] + R' b = F_rho,  D = 2 U + V' + V cot(theta)
    V s' + n U s                                                                 = F_s,            s = p / P - gamma rho / R

- alpha: n = 0, F = 0; ahead of the shock the wind has the further velocity M z per unit of alpha.
- q about the apex: n = 1; the frame turns with Omega = y, so that F = M Omega x x - 2 Omega x (U, V, 0), and ahead of the shock
  the air moves with -Omega x r. (x: here the unit vector of the axis.)
- alpha = t: the response is t A + B, where A is that to alpha, and B has n = 1, F = M z - A for the velocities (the frame falls
  with the acceleration -M z, and A grows), -rho_A and -s_A; the shock of A moves outwards with the speed r g_A.

At the shock the jump conditions hold for the velocity relative to the moving, inclined surface; b = 0 on the cone gives g. Towards
the cone, x = theta - theta_cone -> 0, a, c and s behave like x^(n/2), x^((n+1)/2), x^(n/2) (layers of vorticity and entropy), so
that a variable like ln x makes all that smooth: V ~ -2 U x. Behind a weak shock, a little outside the Mach angle mu, V is nearly
that of sound, and all changes within a layer of about sigma - mu, sigma the angle of the shock. Hence the variable

    zeta = ln(x / (e - x)),   e = sigma - theta_cone + (sigma - mu) / 4.

The solution is good to about eight digits; the pressure on the base is left out.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass

import numpy as np

from exact.derivatives import GAMMA, Longitudinal, NoExactFlow
from exact.shock import behind_shock

STEPS = 700  # of Runge and Kutta's fourth-order method between shock and cone, in zeta
NEAREST = 1e-9  # x where they end
LEAST = 1e-5  # radians between the shock and the Mach angle to begin the search with
R, THETA, PHI, PRESSURE, DENSITY = range(5)  # rows of a disturbance


def _axis(theta: complex) -> np.ndarray:
    """The axis in the directions of r, theta, phi."""
    return np.array([np.cos(theta), -np.sin(theta), 0.0])


@dataclass(frozen=True)
class ConicalFlow:
    """Steady flow at angles theta from cone to shock, even in zeta."""

    mach: float
    theta: np.ndarray
    x_slope: np.ndarray  # d theta / d zeta
    step: float  # between every other angle, in zeta
    u: np.ndarray
    v: np.ndarray
    pressure: np.ndarray
    density: np.ndarray

    @property
    def surface_cp(self) -> float:
        """Pressure coefficient on the cone."""
        return 2.0 * (self.pressure[0] - 1.0 / GAMMA) / self.mach**2

    @property
    def shock_angle(self) -> float:
        """In degrees."""
        return math.degrees(self.theta[-1])


def _steady_path(half_angle: float, velocity: float, shock: float, mu: float) -> tuple[float, tuple[np.ndarray, ...]]:
    """Taylor and Maccoll's equation from the cone, where the speed is `velocity` (of the largest one), outwards to `shock`.

    The step in zeta; x, dx / dzeta, U and V at 2 `STEPS` + 1 points. Angles in radians.
    """
    end = shock - half_angle + 0.25 * (shock - mu)
    zeta = np.linspace(math.log(NEAREST / end), math.log((shock - half_angle) / (end + half_angle - shock)), 2 * STEPS + 1)
    h = zeta[1] - zeta[0]

    def slope(at: float, u: float, v: float) -> tuple[float, float]:
        growth = math.exp(at)
        x = end * growth / (1.0 + growth)
        sound2 = 0.5 * (GAMMA - 1.0) * (1.0 - u * u - v * v)
        v_slope = (v * v * u - sound2 * (2.0 * u + v / math.tan(half_angle + x))) / (sound2 - v * v)
        return x * v / (1.0 + growth), x * v_slope / (1.0 + growth)

    u, v = velocity, -2.0 * velocity * NEAREST
    out = [(u, v)]
    for at in zeta[:-1]:
        k1 = slope(at, u, v)
        k2 = slope(at + 0.5 * h, u + 0.5 * h * k1[0], v + 0.5 * h * k1[1])
        k3 = slope(at + 0.5 * h, u + 0.5 * h * k2[0], v + 0.5 * h * k2[1])
        k4 = slope(at + h, u + h * k3[0], v + h * k3[1])
        u += h / 6.0 * (k1[0] + 2.0 * k2[0] + 2.0 * k3[0] + k4[0])
        v += h / 6.0 * (k1[1] + 2.0 * k2[1] + 2.0 * k3[1] + k4[1])
        out.append((u, v))
    growth = np.exp(zeta)
    x = end * growth / (1.0 + growth)
    return h, (x, x / (1.0 + growth), *np.array(out).T)


def _cone_of(shock: float, mach: float) -> tuple[float, float]:
    """Half-angle of the cone whose shock is at `shock`, and the speed on it, of the largest one; to about 1e-5. Radians.

    V is the variable, from its value behind the shock to none on the cone.
    """
    u, v = _behind(shock, mach)
    theta, h = shock, -v / 100

    def slope(v: float, theta: float, u: float) -> tuple[float, float]:
        sound2 = 0.5 * (GAMMA - 1.0) * (1.0 - u * u - v * v)
        by_theta = (v * v * u - sound2 * (2.0 * u + v / math.tan(theta))) / (sound2 - v * v)
        return 1.0 / by_theta, v / by_theta

    for i in range(100):
        at = v + i * h
        k1 = slope(at, theta, u)
        k2 = slope(at + 0.5 * h, theta + 0.5 * h * k1[0], u + 0.5 * h * k1[1])
        theta, u = theta + h * k2[0], u + h * k2[1]
    return theta, u


def _behind(shock: float, mach: float) -> np.ndarray:
    """U and V behind the shock at this angle, of the largest speed."""
    return behind_shock(np.array([0.0, 1.0, 0.0]), 0.0, mach * _axis(shock))[:2] / math.sqrt(mach**2 + 2.0 / (GAMMA - 1.0))


def shock_angle(half_angle: float, mach: float) -> float:
    """Of a cone, to some thousandths of a degree; degrees. Raises NoExactFlow where the shock is detached."""
    if not (0.0 < half_angle < 57.0 and mach > 1.0):
        raise NoExactFlow(f"cone of {half_angle} degrees at Mach {mach}")
    cone, mu = math.radians(half_angle), math.asin(1.0 / mach)
    # On the weak branch the cone's angle grows with the shock's, from none at the Mach angle.
    low, high = mu * (1.0 + 1e-12), None
    for shock in np.linspace(mu, 0.5 * math.pi, 80)[1:-1]:
        if _cone_of(shock, mach)[0] > cone:
            high = shock
            break
        low = shock
    if high is None:
        raise NoExactFlow(f"the shock of a cone of {half_angle} degrees is detached at Mach {mach}")
    for _ in range(40):
        shock = 0.5 * (low + high)
        low, high = (low, shock) if _cone_of(shock, mach)[0] > cone else (shock, high)
    return math.degrees(shock)


@functools.lru_cache
def steady(half_angle: float, mach: float) -> ConicalFlow:
    """Half-angle in degrees. Raises NoExactFlow where the shock is detached, or too weak to be told from a Mach wave."""
    cone, mu = math.radians(half_angle), math.asin(1.0 / max(mach, 1.0))
    shock = math.radians(shock_angle(half_angle, mach))
    # Newton's method on the two velocities at the shock, from there.
    unknown = np.array([_cone_of(shock, mach)[1], math.log(max(shock - mu, LEAST))])

    def misfit(unknown: np.ndarray) -> np.ndarray:
        shock = mu + math.exp(unknown[1])
        u, v = _steady_path(cone, unknown[0], shock, mu)[1][2:]
        return np.array([u[-1], v[-1]]) - _behind(shock, mach)

    for _ in range(20):
        wrong = misfit(unknown)
        slopes = np.column_stack([(misfit(unknown + step) - wrong) / 1e-6 for step in 1e-6 * np.eye(2)])
        change = np.linalg.solve(slopes, wrong)
        unknown -= np.clip(change, -0.5, 0.5)
        if np.abs(change).max() < 1e-9:
            break
    else:
        raise NoExactFlow(f"the shock of a cone of {half_angle} degrees is too weak at Mach {mach}")
    shock = mu + math.exp(unknown[1])
    largest = math.sqrt(mach**2 + 2.0 / (GAMMA - 1.0))
    h, (x, x_slope, u, v) = _steady_path(cone, unknown[0], shock, mu)
    state = behind_shock(np.array([0.0, 1.0, 0.0]), 0.0, mach * _axis(shock))
    # Isentropic from the shock inwards: 1 - speed^2 / largest^2 is the temperature.
    warmth = (1.0 - u * u - v * v) / (1.0 - u[-1] ** 2 - v[-1] ** 2)
    pressure = state[PRESSURE] * warmth ** (GAMMA / (GAMMA - 1.0))
    density = state[DENSITY] * warmth ** (1.0 / (GAMMA - 1.0))
    return ConicalFlow(mach, cone + x, x_slope, 2.0 * h, largest * u, largest * v, pressure, density)


def _slopes_of_base(flow: ConicalFlow) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """V', P' and R' with theta."""
    sound2 = GAMMA * flow.pressure / flow.density
    v_slope = (flow.v**2 * flow.u - sound2 * (2.0 * flow.u + flow.v / np.tan(flow.theta))) / (sound2 - flow.v**2)
    pressure_slope = -flow.density * flow.v * (flow.u + v_slope)
    return v_slope, pressure_slope, pressure_slope / sound2


def _operators(flow: ConicalFlow, n: int) -> tuple[np.ndarray, np.ndarray]:
    """E and K of the equations E y' + K y = F at every angle, y = (a, b, c, p, rho): (points, 5, 5)."""
    u, v, p, r = flow.u, flow.v, flow.pressure, flow.density
    v_slope, p_slope, r_slope = _slopes_of_base(flow)
    sine, cotangent = np.sin(flow.theta), 1.0 / np.tan(flow.theta)
    e, k = np.zeros((2, len(u), 5, 5))
    for row in range(3):
        e[:, row, row] = v
    e[:, THETA, PRESSURE] = 1.0 / r
    e[:, 3, DENSITY], e[:, 3, THETA] = v, r
    e[:, 4, PRESSURE], e[:, 4, DENSITY] = v / p, -GAMMA * v / r
    k[:, R, R], k[:, R, THETA], k[:, R, PRESSURE] = n * u, -v, n / r
    k[:, THETA, THETA], k[:, THETA, R], k[:, THETA, DENSITY] = (n + 1) * u + v_slope, v, -p_slope / r**2
    k[:, PHI, PHI], k[:, PHI, PRESSURE] = (n + 1) * u + v * cotangent, -1.0 / (r * sine)
    k[:, 3, DENSITY] = n * u + 2.0 * u + v_slope + v * cotangent
    k[:, 3, R], k[:, 3, THETA], k[:, 3, PHI] = (n + 2) * r, r * cotangent + r_slope, r / sine
    # s' = (p / P)' - gamma (rho / R)'; P' / P = gamma R' / R.
    k[:, 4, PRESSURE] = n * u / p - v * p_slope / p**2
    k[:, 4, DENSITY] = -GAMMA * (n * u / r - v * r_slope / r**2)
    return e, k


def _at_shock(flow: ConicalFlow, n: int, shift: float, wind: tuple[float, float, float], speed: float) -> np.ndarray:
    """Disturbance behind the shock for its `shift` g, that of the wind ahead of it, and its `speed` outwards. Linear in all three.

    By a complex step, exact to rounding: the products of cos(phi) and sin(phi) are of second order.
    """
    step = 1e-30j
    shock = flow.theta[-1]
    normal = np.array([-n * step * shift, 1.0, step * shift / math.sin(shock)])
    velocity = flow.mach * _axis(shock + step * shift) + step * np.array(wind)
    moved = behind_shock(normal, step * speed, velocity).imag / step.imag
    v_slope, p_slope, r_slope = (values[-1] for values in _slopes_of_base(flow))
    return moved - shift * np.array([flow.v[-1], v_slope, 0.0, p_slope, r_slope])


def _marched(flow: ConicalFlow, start: np.ndarray, sources: np.ndarray) -> np.ndarray:
    """On the cone: pairs (A, B) of a disturbance with n = 0 and one with n = 1 that it drives by growing, (10, columns).

    `start` (10, columns) behind the shock; `sources` F (points, 10, columns) at every angle.
    """
    count = len(flow.theta)
    matrix, vector = np.zeros((count, 10, 10)), np.empty_like(sources)
    for n, rows in ((0, slice(0, 5)), (1, slice(5, 10))):
        e, k = _operators(flow, n)
        matrix[:, rows, rows] = -np.linalg.solve(e, k)
        vector[:, rows] = np.linalg.solve(e, sources[:, rows])
    growth = np.zeros((count, 5, 5))
    growth[:, [R, THETA, PHI, 3], [R, THETA, PHI, DENSITY]] = 1.0
    growth[:, 4, PRESSURE], growth[:, 4, DENSITY] = 1.0 / flow.pressure, -GAMMA / flow.density
    matrix[:, 5:, :5] = -np.linalg.solve(e, growth)
    matrix *= flow.x_slope[:, None, None]  # derivatives with respect to zeta
    vector *= flow.x_slope[:, None, None]
    h = -flow.step  # inwards
    y = start
    for i in range(count - 1, 0, -2):
        k1 = matrix[i] @ y + vector[i]
        k2 = matrix[i - 1] @ (y + 0.5 * h * k1) + vector[i - 1]
        k3 = matrix[i - 1] @ (y + 0.5 * h * k2) + vector[i - 1]
        k4 = matrix[i - 2] @ (y + h * k3) + vector[i - 2]
        y = y + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
    return y


@dataclass(frozen=True)
class ConeResponse:
    """Pressure disturbances on the cone (times r^n cos(phi)) and what follows from them."""

    derivatives: Longitudinal  # about the apex; area of the base, length of the cone
    shock_by_alpha: float  # angle of the shock by alpha, in the plane of incidence


@functools.lru_cache
def response(half_angle: float, mach: float) -> ConeResponse:
    """To alpha, q and alphadot, each per unit. Half-angle in degrees; raises NoExactFlow where the shock is detached."""
    flow = steady(half_angle, mach)
    sine, cosine = np.sin(flow.theta), np.cos(flow.theta)
    up = np.array([sine, cosine, -np.ones_like(sine)]).T  # the unit vector z
    sources, start = np.zeros((len(flow.theta), 10, 4)), np.zeros((10, 4))
    shift_a, wind, shift_b, rotation = range(4)
    start[:5, shift_a] = _at_shock(flow, 0, 1.0, (0.0, 0.0, 0.0), 0.0)
    start[5:, shift_a] = _at_shock(flow, 1, 0.0, (0.0, 0.0, 0.0), 1.0)
    start[:5, wind] = _at_shock(flow, 0, 0.0, tuple(mach * up[-1]), 0.0)
    sources[:, 5:8, wind] = mach * up
    start[5:, shift_b] = _at_shock(flow, 1, 1.0, (0.0, 0.0, 0.0), 0.0)
    start[5:, rotation] = _at_shock(flow, 1, 0.0, (0.0, 1.0, -cosine[-1]), 0.0)
    coriolis = np.array([flow.v, -flow.u, flow.u * cosine - flow.v * sine]).T
    sources[:, 5:8, rotation] = -mach * up - 2.0 * coriolis

    wall = _marched(flow, start, sources)
    a, b = wall[:5], wall[5:]
    shift = -a[THETA, wind] / a[THETA, shift_a]
    driven = b[:, wind] + shift * b[:, shift_a]
    reflected = lambda column: column[PRESSURE] - b[PRESSURE, shift_b] * column[THETA] / b[THETA, shift_b]
    to_alpha = a[PRESSURE, wind] + shift * a[PRESSURE, shift_a]
    # Over the cone, r to 1 / cos: CN = -pi sin cos p r^(n + 2) / (n + 2) / (q S), Cm = pi sin p r^(n + 3) / (n + 3) / (q S).
    angle = math.radians(half_angle)
    unit = -math.pi * math.sin(angle) / (0.5 * mach**2 * math.pi * math.tan(angle) ** 2)
    force = lambda p, n: unit * p * math.cos(angle) ** (-n - 1) / (n + 2)
    moment = lambda p, n: -unit * p * math.cos(angle) ** (-n - 3) / (n + 3)
    by_q, by_rate = (2.0 * mach * reflected(column) for column in (b[:, rotation], driven))
    found = Longitudinal(
        force(to_alpha, 0), moment(to_alpha, 0), force(by_q, 1), moment(by_q, 1), force(by_rate, 1), moment(by_rate, 1)
    )
    return ConeResponse(found, float(shift))


def derivatives(half_angle: float, mach: float) -> Longitudinal:
    """About the apex, with the area of the base and the length of the cone. Half-angle in degrees."""
    return response(half_angle, mach).derivatives
