#!/usr/bin/python3
"""Pressure on a body where planes cut it, and its derivatives, as a table and as pictures, from surface.vtkhdf of runs.

    scripts/pressure_cuts.py RUN [RUN ...] [--x 0.5 ...] [--y 0 ...] [--fin fin_1=0.5 ...] [--of cp,cp_alpha] [-o pressure_cuts]

A cut across the body at x, along it at y (default: 0), or across a panel at a share of its span, x and y in the mesh's unit. The table has
all quantities of the file: cp of any run, cp_alpha, cp_q, cp_alphadot, ... of `alphadot derivatives`, per radian and rates times length /
2V. Needs Debian's python3-numpy, python3-h5py and python3-matplotlib.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

try:
    import matplotlib.pyplot as plt

    from drawing import finish
    from sweep import cuts
    from sweep.errors import SweepError
    from sweep.surface import FILE, Surface
except ImportError as error:
    sys.exit(f"pressure_cuts.py: {error}; run scripts/install.sh, and then this with /usr/bin/python3")


def share_of(text: str) -> tuple[str, float]:
    patch, _, share = text.rpartition("=")
    if not patch or not 0.0 <= float(share) <= 1.0:
        raise argparse.ArgumentTypeError(f"'{text}' is not PATCH=SHARE, a share of its span from 0 to 1")
    return patch, float(share)


def cuts_of(run: Path, places: dict) -> list[cuts.Cut]:
    try:
        return cuts.wanted(Surface.read(run / FILE), places)
    except (OSError, KeyError) as error:
        sys.exit(f"pressure_cuts.py: {run / FILE}: {error}; give the folder of a run of this version, with output.surface")
    except SweepError as error:
        sys.exit(f"pressure_cuts.py: {run}: {error}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("runs", nargs="+", type=Path, metavar="RUN", help="folder of a run")
    parser.add_argument("--x", nargs="+", type=float, default=[], help="across the body at these x")
    parser.add_argument("--y", nargs="+", type=float, default=[], help="along it at these y")
    parser.add_argument("--fin", nargs="+", type=share_of, default=[], metavar="PATCH=SHARE", help="across a panel")
    parser.add_argument("--of", default="cp", help="what is drawn (default: cp)")
    parser.add_argument("-o", "--output", type=Path, default=Path("pressure_cuts"), help="files without a suffix")
    arguments = parser.parse_args()
    fins: dict[str, list[float]] = {}
    for patch, share in arguments.fin:
        fins.setdefault(patch, []).append(share)
    places = {"x": arguments.x, "y": arguments.y or ([] if arguments.x or fins else [0.0]), "fins": fins}
    found = {run.name: cuts_of(run, places) for run in arguments.runs}
    names, flows = arguments.of.split(","), list(found.values())
    size = (5.2 * len(flows[0]), 3.8 * len(names))
    figure, axes = plt.subplots(len(names), len(flows[0]), figsize=size, squeeze=False, layout="constrained")
    for i, name in enumerate(names):
        for j, same in enumerate(zip(*flows)):
            for number, (run, one) in enumerate(zip(found, same)):
                if name not in one.values:
                    sys.exit(f"pressure_cuts.py: {run} has no {name}; it has {', '.join(one.values)}")
                cuts.draw(axes[i, j], one, name, color=f"C{number}", label=run, linewidth=1.1)
            axes[i, j].set(title=same[0].label, **cuts.labels(same[0], name))
    cuts.write_csv(arguments.output.with_suffix(".csv"), f"Cuts of {', '.join(map(str, arguments.runs))}", found)
    finish(figure, arguments.output)
    print(", ".join(str(arguments.output.with_suffix(suffix)) for suffix in (".csv", ".png", ".svg")))


if __name__ == "__main__":
    main()
