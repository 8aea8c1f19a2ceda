#!/usr/bin/python3
"""Every derivative from two sides: forward solves by flight variables, and adjoints of loads; and what each side costs.

Runs `alphadot derivatives` and `alphadot adjoint` on the wedge, the sharp cone (full model: rolls too) and the Basic Finner, linear solves
to ten decades. Both sides see one discrete problem, so that the entries agree to the solves' tolerance, scaled by the largest entry of the
variable's column. Then the price: adjoints of CA, CN and Cm against forward solves for alpha, q and alphadot, to six decades, in
processor seconds of the linear solves and in peak bytes a cell. Exit code 0 when all agree within --tolerance and no ratio is above --ratio.
Meshes are made in --out; minutes.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
CASES = ROOT / "cases"


@dataclass(frozen=True)
class Subject:
    case: str  # below cases/
    mesh: tuple[str, ...]  # its generator and arguments in the root, without the output
    loads: tuple[str, ...]
    variables: tuple[str, ...]
    settings: tuple[str, ...] = ()


LONGITUDINAL = (("CA", "CN", "Cm"), ("alpha", "q", "alphadot"))
SUBJECTS = {
    "wedge": Subject("wedge/derivatives.toml", ("cases/wedge/mesh.py", "--level", "tiny"), *LONGITUDINAL),
    "cone": Subject("sharp_cone/derivatives.toml", ("cases/sharp_cone/mesh.py", "--size", "0.07"), *LONGITUDINAL),
    "full cone": Subject("sharp_cone/full.toml", ("cases/sharp_cone/mesh.py", "--model", "full", "--size", "0.11"),
                         ("CA", "CN", "Cm", "CY", "Cn", "Cl"), ("alpha", "q", "alphadot", "beta", "p", "r", "betadot")),
    "finner": Subject("basic_finner/derivatives.toml", ("scripts/mesh.py", "cases/basic_finner/missile.toml", "--level", "coarse"),
                      *LONGITUDINAL),
}


def run(program: str, verb: str, subject: Subject, mesh: Path, out: Path, *words: str) -> dict:
    settings = [f"mesh.file={mesh}", "derivatives.limiter_uncertainty=false", "derivatives.coarser_meshes=[]", *subject.settings]
    line = [program, verb, str(CASES / subject.case), "--out", str(out), "--overwrite", *words]
    for setting in settings:
        line += ["--set", setting]
    done = subprocess.run(line, capture_output=True, text=True, env=os.environ | {"OMP_NUM_THREADS": "1"})
    if done.returncode:
        sys.exit(f"adjoint_check.py: {' '.join(line)}\n{done.stderr[-2000:]}")
    return json.loads((out / "result.json").read_text())


def compare(name: str, program: str, mesh: Path, out: Path) -> float:
    """The largest difference of the two sides, as a share of the largest entry of the variable's column."""
    subject = SUBJECTS[name]
    deep = ("--set", "derivatives.orders=10", "--set", "derivatives.max_iterations=400", "--set", "steady.orders=10")
    forward = run(program, "derivatives", subject, mesh, out / "forward", *deep)["derivatives"]
    of = ",".join([*subject.loads, *(f"{load}_alphadot" for load in subject.loads)])
    adjoint = run(program, "adjoint", subject, mesh, out / "adjoint", "--of", of, *deep)["derivatives"]
    worst = 0.0
    for variable in subject.variables:
        keys = [f"{load}_{variable}" for load in subject.loads]
        largest = max(abs(forward[key]["value"]) for key in keys)
        for key in keys:
            difference = abs(forward[key]["value"] - adjoint[key]["value"]) / largest
            worst = max(worst, difference)
            print(f"{name:10} {key:14} {forward[key]['value']:+.10e} {adjoint[key]['value']:+.10e}  {difference:.1e}")
    return worst


def price(name: str, program: str, mesh: Path, out: Path, repeats: int) -> tuple[float, float]:
    """Adjoints over forward solves: processor time of the linear solves (median of pairs), and peak bytes a cell."""
    subject, times, bytes_ = SUBJECTS[name], [], []
    for _ in range(repeats):
        found = [run(program, verb, subject, mesh, out / verb, *words)["performance"] for verb, words in
                 (("derivatives", ()), ("adjoint", ("--of", "CA,CN,Cm", "--set", "output.surface=false", "--set", "output.flow=false")))]
        times.append(found[1]["linear_cpu_s"] / found[0]["linear_cpu_s"])
        bytes_.append(found[1]["peak_bytes_per_cell"] / found[0]["peak_bytes_per_cell"])
    print(f"{name}: adjoints of CA, CN, Cm over forward solves for alpha, q, alphadot: "
          f"{statistics.median(times):.2f} of the processor time ({', '.join(f'{t:.2f}' for t in times)}), "
          f"{statistics.median(bytes_):.2f} of the peak memory")
    return statistics.median(times), statistics.median(bytes_)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=str(ROOT / "build" / "alphadot"))
    parser.add_argument("--out", type=Path, default=ROOT / "runs" / "adjoint_check")
    parser.add_argument("--tolerance", type=float, default=1e-8, help="of the difference, by ten decades")
    parser.add_argument("--ratio", type=float, default=1.3, help="of the price")
    parser.add_argument("--repeats", type=int, default=3)
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    worst = 0.0
    for name, subject in SUBJECTS.items():
        mesh = (arguments.out / f"{name.replace(' ', '_')}.msh").resolve()
        if not mesh.exists():
            subprocess.run(["/usr/bin/python3", *subject.mesh, "-o", str(mesh)], check=True, cwd=ROOT,
                           stdout=subprocess.DEVNULL)
        worst = max(worst, compare(name, arguments.program, mesh, arguments.out))
    ratios = price("finner", arguments.program, (arguments.out / "finner.msh").resolve(), arguments.out, arguments.repeats)
    print(f"largest difference {worst:.1e}, tolerance {arguments.tolerance:.0e}")
    return 0 if worst <= arguments.tolerance and max(ratios) <= arguments.ratio else 1


if __name__ == "__main__":
    sys.exit(main())
