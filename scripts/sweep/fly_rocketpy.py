#!/usr/bin/python3
"""Flies the tables beside this file in RocketPy: a coast, without thrust, from a Mach number and an incidence.

  fly.py --mass 20 --inertia 0.05 6 --center 0.9 --mach 2 --alpha 2 [--altitude 1000] [--alone]

mass in kg, inertia about the axis and across it in kg m2, center of gravity in m behind the nose. Prints incidence, rates and Mach number
over the first seconds. `surfaces(rocketpy)` gives the two surfaces for a rocket of your own, to be added at the moment centre of
reference.csv: the static coefficients as a GenericSurface, rates as a LinearGenericSurface; --alone takes the linear set for all. The
rates' coefficients are those of q and alphadot together, r and betadot: in a flight along a straight path they are the same rate. Outside
the tables their edge values hold, and the script says how often that was.
"""

from __future__ import annotations

import argparse
import csv
import math
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
ORDER = ("alpha", "beta", "mach", "reynolds", "pitch_rate", "yaw_rate", "roll_rate")
outside = {"calls": 0, "held": 0}


def read(path: Path):
    """A function of RocketPy's seven variables: linear between the nodes of a CSV file, held at its edges."""
    with open(path) as file:
        names, *rows = csv.reader(file)
    data = np.array(rows, dtype=float)
    axes = [np.unique(data[:, i]) for i in range(len(names) - 1)]
    values = data[:, -1].reshape([len(axis) for axis in axes])
    places = [ORDER.index(name) for name in names[:-1]]

    def value(alpha, beta, mach, reynolds, pitch_rate, yaw_rate, roll_rate):
        given = (alpha, beta, mach, reynolds, pitch_rate, yaw_rate, roll_rate)
        out = values
        held = False
        for place, axis in zip(places, axes):
            at = min(max(given[place], axis[0]), axis[-1])
            held = held or at != given[place]
            i = min(int(np.searchsorted(axis, at, side="right")) - 1, len(axis) - 2)
            share = (at - axis[i]) / (axis[i + 1] - axis[i])
            out = (1.0 - share) * out[i] + share * out[i + 1]
        outside["calls"] += 1
        outside["held"] += held
        return float(out)

    return value


def with_documented_frame(rocketpy) -> None:
    """The lift and drag in these files are for the matrix in RocketPy's documentation; ends when another is in force."""
    zero, one = (lambda a, b, m, re, q, r, p: 0.0), (lambda a, b, m, re, q, r, p: 1.0)
    surface = rocketpy.GenericSurface(1.0, 1.0, {"cD": one, "cL": zero})
    stream = rocketpy.mathutils.vector_matrix.Vector([0.0, -math.sin(0.1), -math.cos(0.1)])
    force = surface.compute_forces_and_moments(stream, 1.0, 1.0, 2.0, rocketpy.mathutils.vector_matrix.Vector([0, 0, 0]), (0, 0, 0), 1.0)
    if abs(force[1] - math.sin(0.1)) > 1e-9:
        sys.exit("fly.py: this RocketPy turns lift and drag otherwise than its documentation had it when these files were written")


def surfaces(rocketpy, alone: bool = False) -> list:
    with_documented_frame(rocketpy)
    with open(HERE / "reference.csv") as file:
        reference = next(csv.DictReader(file))
    area, length = float(reference["area_m2"]), float(reference["length_m"])
    generic = {path.stem: read(path) for path in sorted((HERE / "generic").glob("*.csv"))}
    linear = {path.stem: path for path in sorted((HERE / "linear").glob("*.csv"))}
    together = {name.rsplit("_", 1)[0]: path for name, path in linear.items() if name.endswith("dot")}
    wanted = {name: together.get(name, path) for name, path in linear.items() if not name.endswith("dot")}
    if not alone:
        has_beta = any("beta" in path.read_text().split("\n", 1)[0] for path in (HERE / "generic").glob("*.csv"))
        wanted = {name: path for name, path in wanted.items() if name[-1] in "pqr" or (name.endswith("_beta") and not has_beta)}
    out = [] if alone else [rocketpy.GenericSurface(area, length, generic, name="static")]
    rates = {name: read(path) for name, path in wanted.items()}
    return out + ([rocketpy.LinearGenericSurface(area, length, rates, name="linear")] if rates else [])


def main() -> int:
    form = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=form)
    parser.add_argument("--mass", type=float, required=True)
    parser.add_argument("--inertia", type=float, nargs=2, required=True, metavar=("AXIS", "ACROSS"))
    parser.add_argument("--center", type=float, required=True)
    parser.add_argument("--mach", type=float, required=True)
    parser.add_argument("--alpha", type=float, default=1.0)
    parser.add_argument("--altitude", type=float, default=1000.0)
    parser.add_argument("--seconds", type=float, default=2.0)
    parser.add_argument("--alone", action="store_true")
    given = parser.parse_args()
    try:
        import rocketpy
    except ImportError:
        print("fly.py: RocketPy is not installed (pip install rocketpy): nothing is flown")
        return 77
    with open(HERE / "reference.csv") as file:
        reference = next(csv.DictReader(file))
    air = rocketpy.Environment(elevation=0.0)
    rocket = rocketpy.Rocket(
        radius=0.5 * float(reference["length_m"]), mass=given.mass, inertia=(given.inertia[1], given.inertia[1], given.inertia[0]),
        power_off_drag=0.0, power_on_drag=0.0, center_of_mass_without_motor=given.center, coordinate_system_orientation="nose_to_tail",
    )  # fmt: skip
    for surface in surfaces(rocketpy, given.alone):
        rocket.add_surfaces(surface, float(reference["moment_center_m"]))
    speed = given.mach * float(air.speed_of_sound(given.altitude))
    tilt = math.radians(given.alpha)  # the body leans, the velocity is level
    angle = math.radians(-90.0) + tilt
    start = [0.0, 0.0, 0.0, given.altitude, 0.0, speed, 0.0, math.cos(angle / 2), math.sin(angle / 2), 0.0, 0.0, 0.0, 0.0, 0.0]
    flight = rocketpy.Flight(
        rocket, air, rail_length=1.0, inclination=45, heading=0, initial_solution=start, max_time=given.seconds, verbose=False,
        terminate_on_apogee=False,
    )  # fmt: skip
    print(f"{'t, s':>8}{'Mach':>9}{'alpha, deg':>12}{'beta, deg':>12}{'q, rad/s':>11}")
    for t in np.linspace(0.0, given.seconds, 41):
        alpha, beta = flight.partial_angle_of_attack(t), flight.angle_of_sideslip(t)
        print(f"{t:8.3f}{flight.mach_number(t):9.4f}{alpha:12.4f}{beta:12.4f}{flight.w1(t):11.4f}")
    print(f"outside the tables, where their edge values hold: {outside['held']:,} of {outside['calls']:,} look-ups")
    return 0


if __name__ == "__main__":
    sys.exit(main())
