#!/usr/bin/python3
"""From the description of a missile to its mesh, its case file and a picture.

  mesh.py DESCRIPTION -o FOLDER     writes FOLDER/LEVEL.msh for each level, FOLDER/case.toml, FOLDER/picture.png, FOLDER/report.txt
  mesh.py --keys                    every key of a description with its meaning and default

A description is a TOML file:

  unit = "m"
  [flight]
  mach = [1.5, 2.5]                 # the lowest and the highest Mach number that the mesh is for
  [[body]]
  shape = "tangent_ogive"
  length = 0.3
  diameter = 0.1
  [[body]]
  shape = "cylinder"
  length = 1.0
  [[fins]]
  number = 4
  roll = 45
  x_end = 1.3
  root_chord = 0.15
  tip_chord = 0.1
  span = 0.1
  thickness_ratio = 0.05

or names the file with the body's surface, from CAD or a triangulation without holes; its lengths, axes and components are as in the file
unless keys of [surface] say otherwise. Such a file may also stand in place of the description.

  flight = {mach = 2}
  [surface]
  file = "missile.step"

Exit codes: 0 everything is written, 1 an error, 2 wrong command line. Needs Debian's python3-gmsh, python3-numpy and
python3-matplotlib (hence /usr/bin/python3).
"""

from __future__ import annotations

import argparse
import os
import re
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # its products are small: more threads only wait for each other

from meshing.limits import FEWEST, LEVELS, MODELS, MOST


def mach_range(text: str) -> tuple[float, float]:
    """LOW:HIGH, or one number."""
    if not re.fullmatch(r"[0-9.]+(:[0-9.]+)?", text):
        raise argparse.ArgumentTypeError(f"'{text}' is not LOW:HIGH, such as 1.5:2.5")
    values = [float(part) for part in text.split(":")]
    if not 0.0 < values[0] <= values[-1] <= 30.0:
        raise argparse.ArgumentTypeError(f"'{text}': the lowest Mach number, above 0, comes first, and 30 is the highest possible")
    return values[0], values[-1]


def cell_count(text: str) -> int:
    """A number of cells; 2e5 will do."""
    try:
        value = int(float(text))
    except (ValueError, OverflowError):
        raise argparse.ArgumentTypeError(f"'{text}' is not a number of cells") from None
    if not FEWEST <= value <= MOST:
        raise argparse.ArgumentTypeError(f"{text} cells: it makes {FEWEST:,} to {MOST:,}")
    return value


def factor(text: str) -> float:
    """Of all sizes."""
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0.3 <= value <= 3.0:
        raise argparse.ArgumentTypeError(f"'{text}' is not a number from 0.3 to 3")
    return value


def parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="alphadot mesh", description=__doc__.replace("mesh.py", "alphadot mesh"),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )  # fmt: skip
    parser.add_argument("description", type=Path, nargs="?", metavar="DESCRIPTION", help="missile.toml, a design of OpenRocket (.ork) or RASAero II (.CDX1), or a surface: STEP, IGES, BREP, STL, OBJ, .tri")
    parser.add_argument("-o", "--output", type=Path, metavar="FOLDER", help="default: the description's name, here; FILE.msh or FILE.su2: the mesh alone")
    sizes = parser.add_mutually_exclusive_group()
    levels = ", ".join(f"{name} {cells:,}" for name, cells in LEVELS.items())
    sizes.add_argument(
        "--level", nargs="+", choices=LEVELS, default=["coarse"], metavar="LEVEL",
        help=f"one, or up to three for the uncertainty of the mesh; cells of a half model: {levels} (default: coarse)",
    )  # fmt: skip
    sizes.add_argument("--cells", type=cell_count, metavar="N", help="tetrahedra of the mesh instead of a level's")
    parser.add_argument(
        "--sizes", nargs="+", type=Path, metavar="FILE",
        help="adapted to derivatives: indicator.vtkhdf of alphadot adjoint --indicator on earlier meshes; of several the smallest sizes",
    )  # fmt: skip
    parser.add_argument(
        "--factors", nargs="+", type=factor, metavar="F",
        help="a family of one size field: meshes mesh_F.msh whose sizes are F times as large (0.3 to 3)",
    )  # fmt: skip
    parser.add_argument("--mach", type=mach_range, metavar="LOW:HIGH", help="in place of the description's range")
    parser.add_argument("--model", choices=MODELS, help="default: half where the missile is symmetric about y = 0")
    parser.add_argument("--stages", type=int, nargs="+", metavar="N", help="of an .ork file, 1 at the nose (default: all)")
    parser.add_argument("--kept", action="store_true", help="into meshes/NAME-HASH beside the description, unless that is there; prints its case file")
    parser.add_argument("--at-mach", type=float, metavar="M", help="with --kept: a Mach number that the mesh must be for")
    parser.add_argument("--no-picture", action="store_true", help="leave out the picture")
    parser.add_argument("--keys", action="store_true", help="print every key of a description, and end")
    arguments = parser.parse_args()
    if arguments.description is None and not arguments.keys:
        parser.error("give a description, or --keys")
    if len(arguments.level) > 3:
        parser.error("at most three levels: the mesh of the case and one or two coarser ones")
    if arguments.kept and (arguments.sizes or arguments.factors):
        parser.error("--kept finds meshes of levels alone: leave --sizes and --factors out")
    if arguments.output and arguments.output.suffix in (".msh", ".su2") and max(len(arguments.level), len(arguments.factors or [])) > 1:
        parser.error(f"{arguments.output} holds one mesh: give one level or factor, or a folder")
    return arguments


def main() -> int:
    arguments = parse()
    try:
        from meshing import program  # after the command line, whose help needs none of the packages
    except ImportError as error:
        sys.exit(f"alphadot mesh: {error}; install the Debian packages python3-gmsh, python3-numpy and python3-matplotlib")
    return program.main(arguments)


if __name__ == "__main__":
    sys.exit(main())
