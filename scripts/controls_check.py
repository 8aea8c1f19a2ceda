#!/usr/bin/python3
"""Controls from several sides: linear solves, flows with panels turned, the half and the full model; and what they cost.

  scripts/controls_check.py [DESCRIPTION] [--level coarse] [--degrees 0.5] [--angles 2 5 10] [--mach 2] [--alpha 0] [--out FOLDER]

Meshes a description whose fins all turn about the middles of their roots, half and full, and compares, in per cent of the largest number
of a kind: derivatives by each control, the mesh deforming and by transpiration, with central differences of flows on deformed meshes (nine
decades all), and the roll of the full model; one panel at finite angles, by either, with meshes of the turned geometry; loads of the panels
of the half model with those of the full one, which differ as cells beside the plane of symmetry do. Then what a control costs beside a
solve for a flight variable, and what adjoints cost, which have all controls. Exit code 1 when solves with the mesh deforming are off by
more than --tolerance per cent. Minutes.
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
DEEP = [word for key in ("steady.orders=9", "derivatives.orders=9", "derivatives.max_iterations=300") for word in ("--set", key)]
TRANSPIRATION = ("--set", "space.deflection=transpiration")
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
        self.content = with_hinges(arguments.description)
        self.description.write_text(toml_document(self.content))
        self.level = arguments.level

    def call(self, *words: object) -> None:
        done = subprocess.run(list(map(str, words)), capture_output=True, text=True)
        if done.returncode not in (0, 5) and "folds" not in done.stderr:
            sys.exit(f"controls_check.py: {' '.join(map(str, words))}\n{done.stderr[-2000:]}")

    def mesh(self, model: str, turned: float = 0, panel: int = 0) -> Path:
        """With a panel of the last fins, and its mirror image, turned by so many degrees."""
        folder = self.out / (f"mesh_{turned:g}" if turned else f"mesh_{model}")
        description = self.description
        if turned:
            content = tomllib.loads(description.read_text())
            fins = content["fins"][-1]
            number, roll = fins["number"], fins.get("roll", 0.0)
            fins["deflection"] = [0.0] * number
            fins["deflection"][panel - 1] = turned
            fins["deflection"][round(-2 * roll * number / 360 - (panel - 1)) % number] = -turned
            description = self.out / f"description_{turned:g}.toml"
            description.write_text(toml_document(content))
        words = ("-o", folder, "--level", self.level, "--model", model, "--no-picture")
        self.call("/usr/bin/python3", "-B", ROOT / "scripts/mesh.py", description, *words)
        return folder / "case.toml"

    def run(self, verb: str, case: Path, name: str, *words: str) -> dict:
        launcher = [os.environ.get("MPIEXEC", "mpirun"), "-n", self.ranks] if self.ranks != "1" else []
        quiet = [word for key in ("output.flow", "output.surface") for word in ("--set", f"{key}=false")]
        self.call(*launcher, self.program, verb, case, "--out", self.out / name, "--overwrite", *self.flow, *quiet, *words)
        result = self.out / name / "result.json"
        return json.loads(result.read_text()) if result.exists() else {}

    def panels(self, name: str) -> dict[tuple[str, str], float]:
        return {(row["panel"], row["name"]): float(row["value"]) for row in rows_of(self.out / name / "panels.csv")}


def differences(check: Check, case: Path, degrees: float) -> float:
    """Solves beside flows; the largest difference, the mesh deforming, in per cent of the largest of its kind."""

    def solves(name: str, *words: str) -> dict[str, float]:
        by_name = check.run("derivatives", case, name, *DEEP, *words)["derivatives"]
        of_panels = {f"{name} of itself": value for (panel, name), value in check.panels(name).items() if name.endswith(f"_{panel}")}
        return {name: each["value"] for name, each in by_name.items()} | of_panels

    deforming, passing = solves("solves"), solves("solves_by_transpiration", *TRANSPIRATION)
    flows: dict[str, tuple[str, float]] = {}  # kind and slope
    for control in dict.fromkeys(panel for panel, _ in check.panels("solves")):
        turned = lambda sign: (*DEEP, "--set", f"deflections.{control}={sign * degrees}")
        low, high = (check.run("run", case, f"{control}_{sign:+d}", *turned(sign))["forces"] for sign in (-1, 1))
        slope = lambda low, high: (high - low) / math.radians(2 * degrees)
        flows |= {f"{name}_{control}": (KIND.get(name, name), slope(low[name], high[name])) for name in LOADS}
        of_itself = {name: slope(low["panels"][control][name], high["panels"][control][name]) for name in PANEL}
        flows |= {f"{name}_{control} of itself": (name, value) for name, value in of_itself.items()}
    lines = lambda solved: [(name, kind, solved[name], value) for name, (kind, value) in flows.items()]
    title = f"beside flows on deformed meshes at ±{degrees:g} degrees"
    compared(f"solves by transpiration {title}", ("solve", "flows"), lines(passing))
    return compared(f"solves, the mesh deforming, {title}", ("solve", "flows"), lines(deforming))


def rolls(check: Check, full: Path, degrees: float) -> float:
    """The rolling moment by each set of panels that rolls the full model; the largest difference in per cent of the largest."""
    sets = {name: shares for name, shares in tomllib.loads(full.read_text())["control_sets"].items() if name.endswith("roll")}
    solved = check.run("derivatives", full, "solves_full", *DEEP)["derivatives"]
    lines: list[Line] = []
    for name, shares in sets.items():
        angles = {f"deflections.{panel}": share * degrees for panel, share in shares.items()}
        turned = lambda sign: [word for key, angle in angles.items() for word in ("--set", f"{key}={sign * angle}")]
        low, high = (check.run("run", full, f"{name}_{sign:+d}", *DEEP, *turned(sign))["forces"]["Cl"] for sign in (-1, 1))
        lines.append((f"Cl_{name}", "Cl", solved[f"Cl_{name}"]["value"], (high - low) / math.radians(2 * degrees)))
    return compared(f"roll of the full model, solves beside flows at ±{degrees:g} degrees", ("solve", "flows"), lines)


def finite(check: Check, case: Path, angles: list[float]) -> None:
    """The first of the last panels that may turn, by finite angles, beside meshes of the turned geometry, which know no limit."""
    names = [control["name"] for control in tomllib.loads(case.read_text())["controls"]]
    panel = next(name for name in names if name.rpartition("_")[0] == names[-1].rpartition("_")[0])
    number_and_error = lambda x, true: ("folds", "") if math.isnan(x) else (f"{x:.5g}", f"{100 * (x / true - 1):+.2g}")
    lines = []
    for angle in angles:
        turned = ("--set", f"deflections.{panel}={angle}")
        geometry = check.mesh("half", angle, int(panel.rpartition("_")[2]))
        runs = {"geometry": (geometry,), "mesh": (case, *turned), "transpiration": (case, *turned, *TRANSPIRATION)}
        loads = []
        for way, (of_case, *words) in runs.items():
            result = check.run("run", of_case, f"{way}_{angle:g}", *words)
            forces = result.get("forces") if result.get("status") == "converged" else None
            loads.append({name: forces[name] for name in ("CN", "Cm")} | forces["panels"][panel] if forces else {})
        for name in ("CN", "Cm", *PANEL):
            true, *others = (load.get(name, math.nan) for load in loads)
            lines.append((f"{angle:g}", name, f"{true:.5g}", *(word for x in others for word in number_and_error(x, true))))
    heads = ("degrees", "name", "turned geometry", "mesh deforming", "%", "transpiration", "%")
    print(f"{panel} at finite angles\n{aligned([heads, *lines])}\n", flush=True)


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


def costs(check: Check, half: Path, full: Path) -> None:
    """Processor seconds of linear solves on the half model, and of adjoints of CN, Cm and Cl on the full one, with and without controls."""
    cost = lambda verb, case, name, *words: check.run(verb, case, name, *words)["performance"]["linear_cpu_s"]
    count = lambda case: len(tomllib.loads(case.read_text())["controls"])

    def plain(case: Path) -> Path:
        content = tomllib.loads(case.read_text())
        out = case.with_name("plain.toml")
        out.write_text(toml_document({key: value for key, value in content.items() if key not in ("controls", "control_sets")}))
        return out

    none, every = cost("derivatives", plain(half), "without_controls"), cost("derivatives", half, "with_controls")
    of = ("--of", "CN,Cm,Cl")
    three, with_all = cost("adjoint", plain(full), "plain_adjoint", *of), cost("adjoint", full, "adjoint", *of)
    each = (every - none) / count(half)
    print(
        f"half model: solves for alpha, q and alphadot {none:.1f} s of processor, with {count(half)} controls {every:.1f} s:"
        f" a control {each:.2f} s, {3 * each / none:.2f} of one solve\n"
        f"full model: adjoints of CN, Cm and Cl {three:.1f} s, with all {count(full)} controls {with_all:.1f} s:"
        f" together {3 * (with_all - three) / three:.2f} of one solve"
    )


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("description", nargs="?", type=Path, default=ROOT / "cases/canard_tail/missile.toml")
    parser.add_argument("--level", default="coarse")
    parser.add_argument("--degrees", type=float, default=0.5)
    parser.add_argument("--angles", type=float, nargs="*", default=[2, 5, 10], help="finite ones; none leaves them out")
    parser.add_argument("--mach", type=float, default=2.0)
    parser.add_argument("--alpha", type=float, default=0.0)
    parser.add_argument("--tolerance", type=float, default=1.0, metavar="PERCENT")
    parser.add_argument("--ranks", type=int, default=2)
    parser.add_argument("--program", default=str(ROOT / "build" / "alphadot"))
    parser.add_argument("--out", type=Path, default=ROOT / "runs" / "controls_check")
    arguments = parser.parse_args()
    check = Check(arguments)
    half, full = check.mesh("half"), check.mesh("full")
    worst = max(differences(check, half, arguments.degrees), rolls(check, full, arguments.degrees))
    if arguments.angles:
        finite(check, half, arguments.angles)
    half_and_full(check, half, full)
    costs(check, half, full)
    return 0 if worst <= arguments.tolerance else 1


if __name__ == "__main__":
    sys.exit(main())
