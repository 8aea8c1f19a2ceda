#!/usr/bin/python3
"""Flies the aerodynamics.xml beside this file in JSBSim: a coast, without thrust, from a Mach number and an incidence.

  fly.py --mass 20 --inertia 0.05 6 --center 0.9 --mach 2 --alpha 2 [--altitude 1000] [--seconds 2] [--step 1e-4] [--keep FOLDER]

mass in kg, inertia about the axis and across it in kg m2, center of gravity in m behind the nose. Prints time, Mach number, incidence and
rate of pitch, a hundred lines. --keep leaves what was flown: aircraft/missile/missile.xml, to make a vehicle of your own from, the start,
the run and its flight.csv. JSBSim is found in PATH, in /usr/games (Debian's package flightgear) or where --program says.
"""

from __future__ import annotations

import argparse
import csv
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
OUTPUT = 1000  # times a second, JSBSim's most
SHOWN = {"simulation/sim-time-sec": "t, s", "velocities/mach": "Mach", "aero/alpha-deg": "alpha, deg", "aero/beta-deg": "beta, deg",
         "velocities/q-rad_sec": "q, rad/s"}  # fmt: skip

VEHICLE = """<?xml version="1.0"?>
<fdm_config name="missile" version="2.0" release="BETA">
  <metrics>
    <wingarea unit="M2">{area}</wingarea>
    <wingspan unit="M">{length}</wingspan>
    <chord unit="M">{length}</chord>
    <location name="AERORP" unit="M"><x>{moment_center}</x><y>0</y><z>0</z></location>
    <location name="VRP" unit="M"><x>0</x><y>0</y><z>0</z></location>
  </metrics>
  <mass_balance>
    <ixx unit="KG*M2">{axis}</ixx><iyy unit="KG*M2">{across}</iyy><izz unit="KG*M2">{across}</izz>
    <emptywt unit="KG">{mass}</emptywt>
    <location name="CG" unit="M"><x>{center}</x><y>0</y><z>0</z></location>
  </mass_balance>
  <ground_reactions/>
  <propulsion/>
  <flight_control name="none"/>
  {aerodynamics}
  <output name="flight.csv" type="CSV" rate="{rate}">
    {properties}
  </output>
</fdm_config>
"""
START = """<?xml version="1.0"?>
<initialize name="start">
  <altitude unit="M">{altitude}</altitude>
  <latitude unit="DEG">0</latitude><longitude unit="DEG">0</longitude><psi unit="DEG">90</psi>
  <mach>{mach}</mach><gamma unit="DEG">0</gamma><alpha unit="DEG">{alpha}</alpha>
</initialize>
"""
RUN = """<?xml version="1.0"?>
<runscript name="coast">
  <use aircraft="missile" initialize="start"/>
  <run start="0" end="{seconds}" dt="{step}"/>
</runscript>
"""


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--mass", type=float, required=True)
    parser.add_argument("--inertia", type=float, nargs=2, required=True, metavar=("AXIS", "ACROSS"))
    parser.add_argument("--center", type=float, required=True)
    parser.add_argument("--mach", type=float, required=True)
    parser.add_argument("--alpha", type=float, default=1.0)
    parser.add_argument("--altitude", type=float, default=1000.0)
    parser.add_argument("--seconds", type=float, default=2.0)
    parser.add_argument("--step", type=float, default=1e-4, help="JSBSim's own integration takes half of step omega^2 from the damping")
    parser.add_argument("--keep", type=Path)
    parser.add_argument("--program", default=shutil.which("JSBSim") or shutil.which("JSBSim", path="/usr/games"))
    given = parser.parse_args()
    if not given.program:
        print("fly.py: JSBSim is neither in PATH nor in /usr/games; name it by --program: nothing is flown")
        return 77
    with tempfile.TemporaryDirectory() as temporary:
        flight = fly(given, given.keep or Path(temporary))
    print("".join(f"{name:>12}" for name in SHOWN.values()))
    for row in flight[:: max(1, len(flight) // 100)]:
        print("".join(f"{value:12.4f}" for value in row))
    return 0


def fly(given: argparse.Namespace, folder: Path) -> list[list[float]]:
    """Rows of the properties SHOWN; ends the script where JSBSim fails."""
    with open(HERE / "reference.csv") as file:
        reference = {name.removesuffix("_m2").removesuffix("_m"): value for name, value in next(csv.DictReader(file)).items()}
    aircraft = folder / "aircraft" / "missile"
    aircraft.mkdir(parents=True, exist_ok=True)
    (aircraft / "missile.xml").write_text(VEHICLE.format(
        **reference, axis=given.inertia[0], across=given.inertia[1], mass=given.mass, center=given.center, rate=OUTPUT,
        aerodynamics=(HERE / "aerodynamics.xml").read_text().strip(),
        properties="\n    ".join(f"<property>{name}</property>" for name in list(SHOWN)[1:]),
    ))  # fmt: skip
    (aircraft / "start.xml").write_text(START.format(altitude=given.altitude, mach=given.mach, alpha=given.alpha))
    (folder / "coast.xml").write_text(RUN.format(seconds=given.seconds, step=given.step))
    command = [given.program, f"--root={folder.resolve()}/", f"--script={folder.resolve()}/coast.xml", "--nohighlight"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    written = folder / "flight.csv"
    if done.returncode != 0 or not written.exists():
        sys.exit(f"fly.py: {' '.join(map(str, command))} ended with {done.returncode}:\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    with open(written) as file:
        names, *rows = csv.reader(file)
    return [list(map(float, row[: len(SHOWN)])) for row in rows]


if __name__ == "__main__":
    sys.exit(main())
