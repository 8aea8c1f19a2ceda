#!/usr/bin/python3
"""Sweeps: many runs of alphadot over Mach number, angle of attack, method and mesh, and a report on them.

  sweep.py run SWEEP.toml      runs what is not done, here, and ends with the report; resumes what was interrupted
  sweep.py status SWEEP.toml   shows which runs wait, run, are done, not converged, interrupted, or failed and why
  sweep.py report SWEEP.toml   writes report.html, and its tables and figures as files, of what is done
  sweep.py table SWEEP.toml    writes what is done as one table, CSV and HDF5, and for JSBSim, RocketPy, MATLAB and as text
  sweep.py dynamics SWEEP.toml short period, weathercock and roll mode, static margin and damping, with the masses of the sweep file
  sweep.py trim SWEEP.toml     deflection and incidence without pitching moment; stability, damping and hinge moments there
  sweep.py extend SWEEP.toml   adds Mach numbers, or cycles to the motions; `run` then does what is new
  sweep.py retry SWEEP.toml    takes the failed runs up again, and begins those anew that are not converged
  sweep.py clean SWEEP.toml    removes the folders of failed and interrupted runs, or of all
  sweep.py slurm SWEEP.toml    writes the scripts of a Slurm array job, and submits it

A sweep file:

  title = "Basic Finner"
  case = "derivatives.toml"             # relative to this file, like `folder`
  folder = "../../runs/finner"          # default: runs/<name of this file>
  mesh = "coarse"                       # a level, made by the mesh.py beside the case, or a file beside it
  alpha = 1.5
  ranks = 2

  [[runs]]                              # lists multiply
  method = "derivatives"                # or "steady", or a kind of motion
  mach = [1.58, 2.5]

  [[runs]]
  label = "long"                        # first word of the names; default: the method
  method = "plunge"
  mach = 2.5
  set."unsteady.cycles" = 2.5           # any key of the case

Axes: mach, alpha, beta, or alpha_t and phi (total incidence, and the roll angle of the cross-flow from below towards starboard), p, q, r
(of a steady turn, times length / 2V), mesh, method. A number, a list, or a range, both ends in it: {from = 0, to = 10, step = 2.5} or
{from = 0, to = 10, count = 5}. Rows of a CSV file whose first line names axes: matrix = "points.csv". symmetry = ["y", "z"] leaves out
what is the mirror image of another run; ["axial"], for a body with three or more equal fins at small incidence, lets the tables take
the side's derivatives from those in pitch.
altitude (m) and unit ("m", "mm", "in", ...: of the mesh) are for dimensional loads.
A state of mass for the dynamics, as many as there are: [[mass]] with label, mass (kg), inertia = [Ixx, Iyy, Izz] (kg m2), center (of
gravity, x in the mesh's unit).
Where the report cuts the surface for lines of the pressure and its derivatives: cuts = {x = [0.5], y = [0], fins = {fin_1 = [0.5]}}, x and
y in the mesh's unit, shares of the spans of patches.
The case may be a description or a design that `alphadot mesh` takes; mesh_mach = [0.5, 2] makes one mesh for that range, and
model = "full" one of both halves, as a block with sideslip has by itself: the side's derivatives need it. Panels of a description
turn, each combination in a mesh of its own:

  [controls]
  pitch = {canard = [1, 1, -1, -1]}     # degrees of each panel of the set, or of all, per degree of the control
  [[runs]]
  mach = {from = 1.5, to = 3, step = 0.5}
  deflection.pitch = [0, 5]

Those of a case file turn its [[controls]], on its mesh: pitch = {fin_1 = 1, fin_3 = -1}.
A run leaves its volume, flow.vtkhdf, only where the case or the sweep file sets "output.flow"; checkpoints of linear solves go when these
are done.

Exit codes: 0 every run is done, 1 some failed or an error, 2 wrong command line, 3 interrupted with work left, 5 every run came to
its end, but some are not converged.
Needs Debian's python3-numpy, python3-h5py and python3-matplotlib (hence /usr/bin/python3).
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from sweep import commands
from sweep.lock import Locked
from sweep.plan import SweepError, read_sweep

FORMATS = ("jsbsim", "rocketpy", "datcom", "mat")


def parse() -> argparse.Namespace:
    form = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=form, usage="sweep.py VERB SWEEP.toml [options]")
    verbs = parser.add_subparsers(dest="verb", required=True, metavar="VERB", prog="sweep.py")

    def add(name: str, text: str) -> argparse.ArgumentParser:
        verb = verbs.add_parser(name, help=text, description=text)
        verb.add_argument("sweep", type=Path, metavar="SWEEP.toml")
        return verb

    run = add("run", "run what is not done, and report")
    run.add_argument("--program", metavar="FILE", help="the program (default: $ALPHADOT, build/alphadot, or on the PATH)")
    run.add_argument("--only", nargs="+", metavar="RUN", help="these runs alone, and no report")
    run.add_argument("--no-report", action="store_true")
    add("status", "show how far every run is")
    write = add("report", "write report.html")
    write.add_argument("--program", metavar="FILE", help="the program (default: $ALPHADOT, build/alphadot, or on the PATH)")
    table = add("table", "write tables of what is done")
    table.add_argument("--series", metavar="NAME", help="label and mesh of the runs that other programs' tables are of (default: most)")
    table.add_argument(
        "--formats", nargs="*", choices=FORMATS, default=FORMATS, metavar="FORMAT",
        help=f"besides CSV and HDF5, of {', '.join(FORMATS)} (default: all)",
    )  # fmt: skip
    dynamics = add("dynamics", "short period, weathercock and roll of what is done, with the masses of the sweep file")
    dynamics.add_argument("--program", metavar="FILE", help="the program (default: $ALPHADOT, build/alphadot, or on the PATH)")
    trim = add("trim", "where controls leave no pitching moment about each centre of gravity, within what was computed")
    trim.add_argument("--program", metavar="FILE", help="the program (default: $ALPHADOT, build/alphadot, or on the PATH)")
    trim.add_argument("--series", metavar="NAME", help="label and mesh of the runs (default: most)")
    trim.add_argument("--control", nargs="+", default=[], metavar="NAME", help="controls (default: those that were deflected)")
    trim.add_argument("--CN", nargs="+", type=float, default=[], metavar="CN", help="normal forces at which it is wanted")
    trim.add_argument(
        "--center", nargs="+", type=center, default=[], metavar="X[,Y,Z]",
        help="of gravity, in the mesh's unit (default: those of [[mass]])",
    )  # fmt: skip
    trim.add_argument(
        "--linear", type=float, default=5.0, metavar="DEG",
        help="how far a control is turned by its derivatives alone (default: %(default)s)",
    )  # fmt: skip
    extend = add("extend", "add Mach numbers or cycles")
    extend.add_argument("--mach", type=float, nargs="+", metavar="M", help="Mach numbers to add, for the methods of the sweep")
    extend.add_argument("--method", nargs="+", help="for these methods only")
    extend.add_argument("--cycles", type=float, help="cycles of every motion, in all")
    retry = add("retry", "take failed runs up again, and those that are not converged")
    retry.add_argument("--only", metavar="RUN", help="this one alone")
    clean = add("clean", "remove folders of failed and interrupted runs")
    clean.add_argument("--all", action="store_true", help="remove those of all runs, and the report")
    slurm = add("slurm", "write the scripts of a Slurm array job")
    slurm.add_argument("--program", metavar="FILE", help="the program, on the nodes")
    slurm.add_argument(
        "--time", default="01:00:00", help="wall clock of one job; longer runs go on in the next (default: %(default)s)"
    )
    slurm.add_argument(
        "--margin", type=int, default=60, metavar="S", help="seconds before that for a checkpoint (default: %(default)s)"
    )
    slurm.add_argument("--each", type=int, metavar="N", help="runs a task, one after the other (default: as few as make 1000 tasks)")
    slurm.add_argument("--partition", help="where to run (default: the cluster's)")
    slurm.add_argument("--submit", action="store_true", help="submit them as well")
    return parser.parse_args()


def center(text: str) -> float | list[float]:
    """x or x,y,z."""
    numbers = [float(word) for word in text.split(",")]
    if len(numbers) not in (1, 3):
        raise argparse.ArgumentTypeError(f"'{text}' is neither X nor X,Y,Z")
    return numbers if len(numbers) == 3 else numbers[0]


def main() -> int:
    arguments = parse()
    try:
        return getattr(commands, arguments.verb)(read_sweep(arguments.sweep), arguments)
    except (SweepError, Locked, OSError) as error:
        print(f"sweep.py: {error}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main())
