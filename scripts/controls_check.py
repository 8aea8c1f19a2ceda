#!/usr/bin/python3
"""Controls from several sides: linear solves, flows with panels turned, the half and the full model; and what they cost.

  scripts/controls_check.py [DESCRIPTION] [--level coarse] [--degrees 0.5] [--mach 2] [--alpha 0] [--out runs/controls_check]

Meshes a description whose fins all turn about the middles of their roots, half and full, and compares, in per cent of the largest number
of a kind: derivatives by each control with central differences of flows with it deflected (nine decades both); loads of the panels of the
half model with those of the full one, which differ as the meshes do. Then what a control costs beside a solve for a flight variable, and
what adjoints cost, which have all controls. Exit code 1 when differences of flows are off by more than --tolerance per cent. Minutes.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import subprocess
import sys
import tomllib
from pathlib import Path

from run_csv import rows_of
from sweep.text import aligned, toml_document

ROOT = Path(__file__).resolve().parents[1]
LOADS, PANEL = ("CA", "CN", "Cm"), ("CNp", "Ch", "Cb")
VARIABLES = ("alpha", "q", "alphadot")
KIND = {"CA": "CN"}  # forces count alike: CA by a control may be nothing but round-off
Line = tuple[str, str, float, float]  # name, kind, and a number from either side


def with_hinges(description: Path) -> dict:
    content = tomllib.loads(description.read_text())
    for fins in content.get("fins", []):
        fins.setdefault("hinge", 0.5 * fins["root_chord"])
    return content


class Check:
    def __init__(self, arguments: argparse.Namespace) -> None:
        self.program, self.ranks, self.out = arguments.program, str(arguments.ranks), arguments.out
        self.flow = ["--set", f"freestream.mach={arguments.mach}", "--set", f"freestream.alpha={arguments.alpha}"]
        self.out.mkdir(parents=True, exist_ok=True)
        self.description = self.out / "description.toml"
        self.description.write_text(toml_document(with_hinges(arguments.description)))
        self.level = arguments.level

    def call(self, *words: object) -> None:
        done = subprocess.run(list(map(str, words)), capture_output=True, text=True)
        if done.returncode not in (0, 5):
            sys.exit(f"controls_check.py: {' '.join(map(str, words))}\n{done.stderr[-2000:]}")

    def mesh(self, model: str) -> Path:
        folder = self.out / f"mesh_{model}"
        words = ("-o", folder, "--level", self.level, "--model", model, "--no-picture")
        self.call("/usr/bin/python3", "-B", ROOT / "scripts/mesh.py", self.description, *words)
        return folder / "case.toml"

    def run(self, verb: str, case: Path, name: str, *words: str) -> dict:
        launcher = [os.environ.get("MPIEXEC", "mpirun"), "-n", self.ranks] if self.ranks != "1" else []
        quiet = [word for key in ("output.flow", "output.surface") for word in ("--set", f"{key}=false")]
        self.call(*launcher, self.program, verb, case, "--out", self.out / name, "--overwrite", *self.flow, *quiet, *words)
        return json.loads((self.out / name / "result.json").read_text())

    def panels(self, name: str) -> dict[tuple[str, str], float]:
        return {(row["panel"], row["name"]): float(row["value"]) for row in rows_of(self.out / name / "panels.csv")}


def differences(check: Check, case: Path, degrees: float) -> float:
    """Solves beside flows; the largest difference in per cent of the largest of its kind."""
    deep = ("--set", "steady.orders=9", "--set", "derivatives.orders=9", "--set", "derivatives.max_iterations=300")
    solved, panels = check.run("derivatives", case, "solves", *deep)["derivatives"], check.panels("solves")
    controls = list(dict.fromkeys(panel for panel, _ in panels))
    lines: list[Line] = []
    for control in controls:
        turned = lambda sign: (*deep, "--set", f"deflections.{control}={sign * degrees}")
        low, high = (check.run("run", case, f"{control}_{sign:+d}", *turned(sign))["forces"] for sign in (-1, 1))
        slope = lambda low, high: (high - low) / math.radians(2 * degrees)
        lines += [(f"{name}_{control}", KIND.get(name, name), solved[f"{name}_{control}"]["value"], slope(low[name], high[name])) for name in LOADS]
        for name in PANEL:
            by_flows = slope(low["panels"][control][name], high["panels"][control][name])
            lines.append((f"{name}_{control} of itself", name, panels[control, f"{name}_{control}"], by_flows))
    return compared(f"solves beside flows at ±{degrees:g} degrees", ("solve", "flows"), lines)


def half_and_full(check: Check, half: Path, full: Path) -> None:
    """Panels' loads by the flight variables."""
    check.run("derivatives", half, "half")
    check.run("derivatives", full, "full")
    one, other = check.panels("half"), check.panels("full")
    names = [f"{name}_{variable}" for variable in VARIABLES for name in PANEL]
    panels = dict.fromkeys(panel for panel, _ in one)
    lines = [(f"{name} of {panel}", name, one[panel, name], other[panel, name]) for panel in panels for name in names]
    compared("panels of the half and of the full model", ("half", "full"), lines)


def compared(title: str, heads: tuple[str, str], lines: list[Line]) -> float:
    largest: dict[str, float] = {}
    for _, kind, a, b in lines:
        largest[kind] = max(largest.get(kind, 0.0), abs(a), abs(b))
    off = [100 * abs(a - b) / largest[kind] for _, kind, a, b in lines]
    rows = [(name, f"{a:.6g}", f"{b:.6g}", f"{error:.3g}") for (name, _, a, b), error in zip(lines, off)]
    print(f"{title}\n{aligned([('name', *heads, '% of its kind'), *rows])}\nlargest: {max(off):.3g} %\n", flush=True)
    return max(off)


def costs(check: Check, case: Path) -> None:
    """Processor seconds of the linear solves with and without controls, and of adjoints of CA, CN and Cm, which have any number."""
    cost = lambda result: result["performance"]["linear_cpu_s"]
    count = len(dict.fromkeys(panel for panel, _ in check.panels("solves")))
    every = cost(check.run("derivatives", case, "with_controls"))
    content = tomllib.loads(case.read_text())
    plain = case.with_name("plain.toml")
    plain.write_text(toml_document({key: value for key, value in content.items() if key not in ("controls", "control_sets")}))
    none = cost(check.run("derivatives", plain, "without_controls"))
    adjoint = cost(check.run("adjoint", case, "adjoint", "--of", "CA,CN,Cm"))
    print(
        f"solves for alpha, q and alphadot {none:.1f} s of processor, with {count} controls {every:.1f} s: a control"
        f" {(every - none) / count:.2f} s,"
        f" {3 * (every - none) / count / none:.2f} of one solve; adjoints of three loads, which have all of them, {adjoint:.1f} s"
    )


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("description", nargs="?", type=Path, default=ROOT / "cases/canard_tail/missile.toml")
    parser.add_argument("--level", default="coarse")
    parser.add_argument("--degrees", type=float, default=0.5)
    parser.add_argument("--mach", type=float, default=2.0)
    parser.add_argument("--alpha", type=float, default=0.0)
    parser.add_argument("--tolerance", type=float, default=1.0, metavar="PERCENT")
    parser.add_argument("--ranks", type=int, default=2)
    parser.add_argument("--program", default=str(ROOT / "build" / "alphadot"))
    parser.add_argument("--out", type=Path, default=ROOT / "runs" / "controls_check")
    arguments = parser.parse_args()
    check = Check(arguments)
    half, full = check.mesh("half"), check.mesh("full")
    worst = differences(check, half, arguments.degrees)
    half_and_full(check, half, full)
    costs(check, half)
    return 0 if worst <= arguments.tolerance else 1


if __name__ == "__main__":
    sys.exit(main())
