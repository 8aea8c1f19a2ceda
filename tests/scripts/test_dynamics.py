#!/usr/bin/python3
"""Modes of motion, against the same body flown in time: test_table.py's tail, its loads from the wind that it meets, integrated."""

from __future__ import annotations

import csv
import math
import unittest

import numpy as np
from scipy.integrate import solve_ivp
from stub_runs import finish_all
from test_table import AREA, CA, EPS, HEAD, LENGTH, R, X, model, slope
from workspace import Workspace

from sweep.atmosphere import air_at
from sweep.plan import read_sweep

MASS, ROLL, ACROSS = 20.0, 0.05, 6.0
SPEED, DENSITY = 2 * 340.294, 1.225  # Mach 2 at sea level
BODY = f'[[mass]]\nlabel = "burnout"\nmass = {MASS}\ninertia = [{ROLL}, {ACROSS}, {ACROSS}]\ncenter = 0.5\n'


def flown(q_scale: float = 1.0) -> tuple[float, float]:
    """Frequency without damping (rad/s) and damping ratio of a free oscillation in pitch: from the times and heights of its peaks."""
    force = 0.5 * DENSITY * SPEED**2 * AREA * slope(2)
    axial = 0.5 * DENSITY * SPEED**2 * AREA * CA

    def tail(alpha: float, q: float, rate: float) -> float:
        """Normal force at the distance X behind the centre, upwards, in the wind that it meets."""
        return force * (alpha + q_scale * q * X / SPEED - EPS * (alpha - rate * X / SPEED))

    def change(_: float, state: np.ndarray) -> tuple[float, float]:
        alpha, q = state
        rate = q
        for _ in range(20):  # the downwash depends on the rate itself, weakly
            rate = q - (tail(alpha, q, rate) * math.cos(alpha) - axial * math.sin(alpha)) / (MASS * SPEED)
        return rate, -X * tail(alpha, q, rate) / ACROSS

    peak = lambda _, state: state[1]
    found = solve_ivp(change, (0, 3), (1e-3, 0), events=peak, rtol=1e-10, atol=1e-14).t_events[0]
    run = solve_ivp(change, (0, 3), (1e-3, 0), t_eval=found[1:9], rtol=1e-10, atol=1e-14)
    times, heights = run.t, np.abs(run.y[0])
    decay = math.log(heights[0] / heights[-1]) / (times[-1] - times[0])
    swing = math.pi * (len(times) - 1) / (times[-1] - times[0])
    omega = math.hypot(decay, swing)
    return omega, decay / omega


class Dynamics(Workspace):
    def rows(self, blocks: str = "[[runs]]\nmach = 2\n", of=model, head: str = "") -> tuple[list[dict[str, str]], str]:
        self.write(BODY + blocks, HEAD + head)
        finish_all(read_sweep(self.file), of)
        said = self.sweep("dynamics")
        with open(self.folder / "runs/table/dynamics.csv") as file:
            return list(csv.DictReader(line for line in file if not line.startswith("#"))), said

    def test_modes_are_those_of_the_flight(self) -> None:
        (row,), said = self.rows()
        omega, zeta = flown()
        self.assertAlmostEqual(float(row["pitch_omega_rad_s"]), omega, delta=1e-4 * omega)
        self.assertAlmostEqual(float(row["pitch_zeta"]), zeta, delta=2e-3 * zeta)
        # The tail is the same in yaw.
        self.assertAlmostEqual(float(row["yaw_omega_rad_s"]), omega, delta=1e-4 * omega)
        self.assertAlmostEqual(float(row["yaw_zeta"]), zeta, delta=2e-3 * zeta)
        # Four fins at R give the moment -q S A (p R / V) R.
        roll = -0.5 * DENSITY * SPEED * AREA * slope(2) * R**2 / ROLL
        self.assertAlmostEqual(float(row["roll_root_1_s"]), roll, delta=1e-4 * abs(roll))
        self.assertAlmostEqual(float(row["static_margin"]), X / LENGTH)
        self.assertNotIn("warning", said)

    def test_negative_damping_is_warned_of(self) -> None:
        """Rotation that drives, as strongly as it damped. A body whose Cm_alphadot takes away part of it has a note."""

        def driven(mach: float, alpha: float, beta: float) -> tuple[dict, dict]:
            steady, known = model(mach, alpha, beta)
            return steady, known | {name: -3 * known[name] for name in ("CN_q", "Cm_q")}

        (row,), said = self.rows(of=driven)
        omega, zeta = flown(-3.0)
        self.assertLess(zeta, 0)
        self.assertAlmostEqual(float(row["pitch_zeta"]), zeta, delta=2e-3 * abs(zeta))
        self.assertRegex(said, r"warning: burnout, derivatives_m2_a0 at 0 m: the short period grows, damping ratio -0\.")
        self.assertIn("pitching is not damped by moments", said)
        self.assertGreater(float(row["Cm_q_plus_Cm_alphadot"]), float(row["limit"]))
        lagging = lambda *at: (model(*at)[0], model(*at)[1] | {"Cm_alphadot": 50.0})
        said = self.rows(of=lagging)[1]
        self.assertRegex(said, r"note: .*Cm_alphadot = \+50.0 takes 20 % of the damping by Cm_q away")  # of 2 A / M (X/l)^2 = 252

    def test_altitudes_and_travel_of_the_centre(self) -> None:
        launch = BODY.replace("burnout", "launch").replace("center = 0.5", "center = [0.6, 0, 0]")
        rows, _ = self.rows(launch + "[[runs]]\nmach = [2, 3]\n", head="altitude = [0, 10000]\n")
        self.assertEqual(len(rows), 8)
        at = [float(row["pitch_omega_rad_s"]) for row in rows[:2]]
        # With the same Mach number omega^2 goes with the dynamic pressure, and that with the pressure of the air: 101,325 and 26,500 Pa.
        self.assertAlmostEqual(at[1] / at[0], math.sqrt(26499.9 / 101325), places=3)
        calls = (self.folder / "runs/derive.txt").read_text().splitlines()
        self.assertEqual(calls, ["2 0.5", "2 0.6"])

    def test_standard_atmosphere(self) -> None:
        """U.S. Standard Atmosphere 1976, table I (the same as ICAO's up to 80 km), by geometric altitude: K, Pa, kg/m3, m/s, Pa s."""
        for altitude, *wanted in (
            (0, 288.150, 1.01325e5, 1.2250, 340.29, 1.7894e-5),
            (5000, 255.676, 5.4048e4, 0.73643, 320.55, 1.6282e-5),
            (15000, 216.650, 1.2111e4, 0.19476, 295.07, 1.4216e-5),
            (30000, 226.509, 1.1970e3, 1.8410e-2, 301.71, 1.4753e-5),
            (60000, 247.021, 2.1958e1, 3.0968e-4, 315.07, 1.5837e-5),
        ):
            air = air_at(altitude)
            found = (air.temperature, air.pressure, air.density, air.sound_speed, air.viscosity)
            np.testing.assert_allclose(found, wanted, rtol=1e-4)

    def test_mistakes_are_named(self) -> None:
        self.write("[[runs]]\nmach = 2\n", HEAD)
        self.assertIn("[[mass]]", self.sweep("dynamics", code=1))
        self.write(BODY.replace("center = 0.5", "") + "[[runs]]\nmach = 2\n", HEAD)
        self.assertIn("center", self.sweep("status", code=1))


if __name__ == "__main__":
    unittest.main()
