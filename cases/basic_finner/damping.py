#!/usr/bin/python3
"""Pitch damping of the Basic Finner over Mach number beside RANS and free flight (reference/).

  damping.py --out FOLDER [--cells 150000] [--program alphadot]

Families of meshes, each made for a part of the Mach numbers of the RANS tables (alphadot derivatives --tolerance --plain), at no
incidence: Cm_q + Cm_alphadot without spacing of cells, with its interval. Prints the table and draws damping.png. What is there is found
again; a family that fails is left out, and the exit code is then 1. Needs Debian's python3-gmsh, python3-numpy and python3-matplotlib
(hence /usr/bin/python3).
"""

from __future__ import annotations

import argparse
import json
import math
import re
import subprocess
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

HERE = Path(__file__).resolve().parent
ROOT, REFERENCE = HERE.parents[1], HERE / "reference"
sys.path.insert(0, str(ROOT / "scripts"))
from run_csv import rows_of
from sweep.figures import COLORS, STYLE
from sweep.text import aligned

# Mach numbers of one family of meshes.
FAMILIES = ((1.5, 2.0, 2.5), (3.0, 3.5, 4.0, 4.5), (1.29,), (1.08, 1.11), (0.93,), (0.5, 0.77))


def parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--cells", type=int, default=150_000, help="of the finest mesh of a family")
    parser.add_argument("--program", default=str(ROOT / "build" / "alphadot"))
    parser.add_argument("--picture", type=Path, help="default: damping.png in --out")
    return parser.parse_args()


def family(arguments: argparse.Namespace, machs: tuple[float, ...]) -> dict[float, dict]:
    """Derivatives by Mach number, each with value and uncertainty; none where it failed."""
    folder = arguments.out / f"mach_{machs[0]:g}_to_{machs[-1]:g}"
    folder.mkdir(parents=True, exist_ok=True)
    text, count = re.subn(r"mach = \[[^]]*\]", f"mach = [{machs[0]}, {machs[-1]}]", (HERE / "missile.toml").read_text())
    assert count == 1
    description = folder / "missile.toml"
    if not description.exists() or description.read_text() != text:
        description.write_text(text)  # and what was made of another is refused
    command = [arguments.program, "derivatives", description, "--tolerance", "0.1%", "--plain", "--cells", arguments.cells]
    command += ["--out", folder / "runs", "--set", "freestream.alpha=0", "--mach", *machs]
    if subprocess.run([str(word) for word in command], stdout=subprocess.DEVNULL).returncode not in (0, 5):
        print(f"damping.py: {folder} failed: see above", file=sys.stderr)
        return {}
    found = json.loads((folder / "runs" / "adaptation.json").read_text())
    return {mach: stream["derivatives"] for mach, stream in zip(machs, found["streams"], strict=True)}


def main() -> int:
    arguments = parse()
    published = rows_of(REFERENCE / "finner_rans_ARL_TR_6725.csv")
    rans = {method: {float(row["Mach"]): float(row["PDM"]) for row in published if row["method"] == method}
            for method in ("planar_pitching", "lunar_coning")}  # fmt: skip
    flights = [row for row in rows_of(REFERENCE / "finner_free_flight_DREV_TM_9703.csv") if row["flag"] == "ok" and row["table"] == "VIII"]
    rows = [("Mach", "Cm_q", "Cm_alphadot", "sum", "", "RANS, pitching", "off", "RANS, coning")]
    sums, widths = {}, {}
    found = {mach: values for machs in FAMILIES for mach, values in family(arguments, machs).items()}
    for mach, values in sorted(found.items()):
        q, alphadot = values["Cm_q"], values["Cm_alphadot"]
        sums[mach] = q["value"] + alphadot["value"]
        widths[mach] = math.hypot(q["uncertainty"], alphadot["uncertainty"])
        pitching = rans["planar_pitching"][mach]
        rows.append((f"{mach:.2f}", f"{q['value']:.1f}", f"{alphadot['value']:.1f}", f"{sums[mach]:.1f}", f"± {widths[mach]:.1f}",
                     f"{pitching:.1f}", f"{100 * (sums[mach] / pitching - 1):+.1f} %", f"{rans['lunar_coning'][mach]:.1f}"))  # fmt: skip
    print(aligned(rows))
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(figsize=(7.2, 4.6), layout="constrained")
        style = {"fmt": "o-", "color": COLORS[0], "capsize": 3, "label": "alphadot, inviscid"}
        axes.errorbar(list(sums), list(sums.values()), list(widths.values()), **style)
        for (method, values), marker, color in zip(rans.items(), "s^", COLORS[1:]):
            label = f"RANS, {method.replace('_', ' ')}"
            axes.plot(list(values), list(values.values()), f"{marker}--", color=color, ms=4, lw=1, label=label)
        axes.plot([float(row["Mach"]) for row in flights], [float(row["Cmq_plus_Cmad"]) for row in flights], "x", color="#606060",
                  label="free flight (DREV)")  # fmt: skip
        axes.set(xlabel="Mach number", ylabel="$C_{mq}+C_{m\\dot\\alpha}$ about 5.5 d, per radian")
        axes.invert_yaxis()
        axes.grid(alpha=0.25)
        axes.legend()
        figure.savefig(arguments.picture or arguments.out / "damping.png", dpi=110)
    return 0 if len(sums) == len(rans["planar_pitching"]) else 1


if __name__ == "__main__":
    sys.exit(main())
