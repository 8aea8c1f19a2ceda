#!/usr/bin/python3
"""What adaptation is worth: errors against processor time, meshing included, of adapted meshes and of those from the description alone.

  adaptation_gain.py DESCRIPTION --mach 1.75 --truth Cm_alphadot=-6.0,Cm_q=-387.9 --out FOLDER [--cells 250000]

Runs `alphadot derivatives DESCRIPTION --tolerance` twice, with --plain and without, until the budget of cells ends both. Prints, and draws
into gain.png, the error of every member of every family and of the families' own values; `truth`: estimates from elsewhere.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

from sweep.figures import COLORS, STYLE
from sweep.text import aligned

ROOT = Path(__file__).resolve().parents[1]


def parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("description", type=Path)
    parser.add_argument("--mach", type=float, required=True)
    parser.add_argument("--alpha", type=float, default=0.0, help="degrees")
    parser.add_argument("--truth", required=True, metavar="NAME=VALUE,...")
    parser.add_argument("--goals", default="Cm_alpha,Cm_q,Cm_alphadot")
    parser.add_argument("--cells", type=int, default=250_000)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--program", default=str(ROOT / "build" / "alphadot"))
    arguments = parser.parse_args()
    arguments.truth = {name: float(value) for name, value in (part.split("=") for part in arguments.truth.split(","))}
    return arguments


def adaptation(arguments: argparse.Namespace, name: str, *options: str) -> dict:
    """What one leaves; found again where it is there."""
    folder = arguments.out / name
    command = [arguments.program, "derivatives", arguments.description, "--tolerance", "0.0001%", "--goals", arguments.goals]
    command += ["--cells", arguments.cells, "--out", folder, "--set", f"freestream.mach={arguments.mach}"]
    command += ["--set", f"freestream.alpha={arguments.alpha}", *options]
    if subprocess.run([str(word) for word in command], stdout=subprocess.DEVNULL).returncode != 5:
        sys.exit(f"adaptation_gain.py: {folder}: see above")
    return json.loads((folder / "adaptation.json").read_text())


def main() -> int:
    arguments = parse()
    arguments.out.mkdir(parents=True, exist_ok=True)
    found = {"plain": adaptation(arguments, "plain", "--plain"), "adapted": adaptation(arguments, "adapted")}
    rows = [("meshes", "finest", "s of processor", *(word for name in arguments.truth for word in (name, "", "scatter", "finest mesh")))]
    with plt.rc_context(STYLE):
        width = len(arguments.truth)
        figure, panels = plt.subplots(1, width, figsize=(4.2 * width, 3.6), layout="constrained", squeeze=False)
        for (kind, one), color in zip(found.items(), COLORS):
            for family in one["families"]:
                members, derivatives = (family["streams"][0][key] for key in ("members", "derivatives"))
                finest = max(member["cells"] for member in members)
                row = [kind, f"{finest:,}", f"{family['cpu_s']:.0f}"]
                for axes, (name, truth) in zip(panels[0], arguments.truth.items()):
                    entry = derivatives[name]
                    value, *others = entry["value"], entry["uncertainty"], entry["scatter"], entry["levels"][0]
                    row += [f"{value:.5g}", f"± {others[0]:.2g}", f"{others[1]:.2g}", f"{others[2]:.5g}"]
                    label = kind if family is one["families"][0] else None
                    axes.loglog(family["cpu_s"], max(abs(entry["value"] - truth), 1e-9), "s", color=color, label=label)
                    alone = label and f"{kind}, finest mesh alone"
                    axes.loglog(family["cpu_s"], abs(entry["levels"][0] - truth), "o", mfc="none", color=color, label=alone)
                rows.append(tuple(row))
        for axes, (name, truth) in zip(panels[0], arguments.truth.items()):
            axes.set(title=f"{name}, {truth:g} at Mach {arguments.mach:g}", xlabel="s of processor, meshing included", ylabel="error")
        panels[0][0].legend()
        figure.savefig(arguments.out / "gain.png", dpi=120)
    print(aligned(rows))
    return 0


if __name__ == "__main__":
    sys.exit(main())
