#!/usr/bin/python3
"""Derivatives to an accuracy that is asked for, on meshes that are adapted to them.

  alphadot derivatives missile.toml --tolerance 1%                    within 1 % of each goal's value
  alphadot derivatives missile.toml --tolerance 1%,Cm_alphadot=0.4    one goal with a tolerance of its own
  alphadot derivatives missile.toml --tolerance 2%CN_alphadot --goals Cm_alphadot --mach 1.75 2.5

Meshes the description coarsely, finds where the errors of the goals are made (alphadot adjoint --indicator), makes a family of meshes of
one size field (alphadot mesh --sizes --factors), and from its values the derivatives without spacing, their scatter from mesh to mesh and
intervals that hold the truth in about 95 % of entries. Finer families follow until every goal's interval is within its tolerance or a
budget ends it. The folder holds adaptation.json, adaptation.csv, convergence.png, cells.png, and every mesh and run; what is there is
found again after an interruption.

Exit codes: 0 converged, 1 an error, 2 wrong command line, 3 interrupted, 5 a budget has ended it, or a run has not converged.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import signal
import sys
import tomllib
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from adaptation.loop import Adaptation, Budget, Stream
from adaptation.steps import Interrupted, StepError, Steps, tell
from adaptation.tolerance import ToleranceError, read_tolerances
from meshing.sources import digest_of, files_of
from sweep.state import write_json

GOALS = "Cm_alpha,Cm_q,Cm_alphadot"
ASKED = "asked.json"  # what a folder is for


def parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="alphadot derivatives", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )  # fmt: skip
    parser.add_argument("case", type=Path, help="a description that alphadot mesh knows, or a case file with [mesh] from = description")
    parser.add_argument("--tolerance", nargs="?", metavar="T", help="half width of intervals: 1%%, 2%%CN_alphadot, 0.4; NAME=T of a goal")
    parser.add_argument("--goals", default=GOALS, metavar="NAMES", help=f"derivatives that the meshes are adapted to (default: {GOALS})")
    parser.add_argument("--cells", type=number(15e3, 1e8), default=250_000, metavar="N", help="about so many on the finest mesh (default: 250,000)")
    parser.add_argument("--minutes", type=number(0.0, 1e6), metavar="M", help="of the clock: no family is begun that would take longer")
    parser.add_argument("--mach", nargs="+", type=number(0.01, 30.0), metavar="M", help="Mach numbers that one family of meshes is for")
    parser.add_argument("--ranks", type=int, default=1, metavar="N", help="of mpirun, for the solver; meshes are made on one core")
    parser.add_argument("--plain", action="store_true", help="the same with meshes that are not adapted")
    parser.add_argument("--out", type=Path, metavar="FOLDER", help="default: runs/<name of the case>-adapted")
    parser.add_argument("--overwrite", action="store_true", help="replace what was made in the folder for something else")
    parser.add_argument("--set", action="append", default=[], dest="settings", metavar="KEY=VALUE", help="replace a key of the case")
    arguments = parser.parse_args()
    if int(os.environ.get("OMPI_COMM_WORLD_SIZE", "1")) > 1:
        if os.environ.get("OMPI_COMM_WORLD_RANK") != "0":
            sys.exit(2)
        parser.error("a tolerance is asked for without mpirun: say --ranks N, and every run is started under it")
    if arguments.tolerance is None:
        parser.error("--tolerance: expected one argument, such as 1%")
    if arguments.ranks < 1:
        parser.error("--ranks: at least 1")
    arguments.goals = list(dict.fromkeys(name.strip() for name in arguments.goals.split(",")))
    return arguments


def number(least: float, most: float):
    """Of an option."""

    def read(text: str) -> float:
        try:
            value = float(text)
        except ValueError:
            value = float("nan")
        if not least <= value <= most:
            raise argparse.ArgumentTypeError(f"'{text}' is no number from {least:g} to {most:g}")
        return value

    return read


def description_of(case: Path) -> tuple[Path, Path | None, str | None]:
    """The description, the case file where that is another, and its model. Raises StepError."""
    if not case.is_file():
        raise StepError(f"{case}: there is no such file")
    if case.suffix.lower() != ".toml":
        return case, None, None
    try:
        content = tomllib.loads(case.read_text())
    except (UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise StepError(f"{case}: {error}") from None
    if "body" in content or "surface" in content:
        return case, None, None
    described = content.get("mesh", {}).get("from")
    if not described:
        raise StepError(
            f"{case}: a tolerance needs a description of the body to make meshes of: set [mesh] from; for a mesh of your own, "
            "alphadot adjoint --indicator tells your mesher where cells pay"
        )
    return case.parent / described, case, content.get("reference", {}).get("model")


def prepare(folder: Path, arguments: argparse.Namespace, description: Path) -> None:
    """Makes the folder, or makes sure that what is in it was made for the same. Raises StepError, OSError."""
    files = dict.fromkeys((arguments.case, *files_of(description)))
    asked = {
        "case": str(arguments.case.resolve()), "content": digest_of(files),
        "goals": arguments.goals, "mach": arguments.mach, "settings": arguments.settings, "plain": arguments.plain,
    }  # fmt: skip
    file = folder / ASKED
    if file.exists() and json.loads(file.read_text()) != asked:
        if not arguments.overwrite:
            raise StepError(f"{folder} holds an adaptation of something else: give --overwrite, or another --out")
        for name in ("first", *(path.name for path in folder.glob("family_*"))):
            shutil.rmtree(folder / name, ignore_errors=True)
    folder.mkdir(parents=True, exist_ok=True)
    write_json(file, asked)


def main() -> int:
    arguments = parse()
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        tolerances = read_tolerances(arguments.tolerance, arguments.goals)
        description, case, model = description_of(arguments.case)
        folder = arguments.out or Path("runs") / f"{arguments.case.stem}-adapted"
        prepare(folder, arguments, description)
        program = Path(os.environ.get("ALPHADOT") or Path(__file__).resolve().parents[1] / "build" / "alphadot")
        streams = [Stream(f"mach={mach:g}", (f"freestream.mach={mach!r}",)) for mach in arguments.mach or []] or [Stream("")]
        steps = Steps(description, case, model, program, arguments.settings, arguments.ranks)
        budget = Budget(int(arguments.cells), arguments.minutes)
        adaptation = Adaptation(steps, folder, streams, tolerances, budget, adapts=not arguments.plain)
        outcome = adaptation.run()
        from adaptation import report  # matplotlib takes a while to come

        report.write_report(outcome, adaptation)
        print(report.table(outcome, adaptation))
        print(f"written to {folder}: adaptation.json, adaptation.csv, convergence.png, cells.png")
        return 0 if outcome.status == "converged" else 5
    except OSError as error:
        tell(f"alphadot: error: {error.filename}: {error.strerror}")
        return 1
    except (ToleranceError, StepError) as error:
        for line in str(error).splitlines():
            tell(line if line.startswith("alphadot") else f"alphadot: error: {line}")
        return 1
    except (Interrupted, KeyboardInterrupt):
        tell("interrupted: the same command goes on from here")
        return 3


if __name__ == "__main__":
    sys.exit(main())
