#!/usr/bin/python3
"""Every derivative from two sides: forward solves by flight variables, and adjoints of loads; and what each side costs.

Runs `alphadot derivatives` and `alphadot adjoint` on the wedge, the sharp cone (full model: rolls too) and the Basic Finner, linear solves
to ten decades. Both sides see one discrete problem, so that the entries agree to the solves' tolerance, scaled by the largest entry of the
variable's column. The surface sensitivities of those with a `shape` are held against central differences of steady flows solved anew, twelve
decades, on meshes whose walls have moved: smoothly, and every point its own way. At no incidence, too, where the limiter's neighbours tie.
Then the price: adjoints of CA, CN and Cm against forward solves for alpha, q and alphadot, to six decades, in processor seconds of the
linear solves and in peak bytes a cell. Exit code 0 when all agree within --tolerance and --shape-tolerance and no ratio is above --ratio.
Meshes are made in --out; minutes, or seconds with --quick: the small cases, no price.
"""

from __future__ import annotations

import argparse
import csv
import json
import math
import os
import random
import statistics
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import gmsh

ROOT = Path(__file__).resolve().parents[1]
CASES = ROOT / "cases"


@dataclass(frozen=True)
class Subject:
    case: str  # below cases/
    mesh: tuple[str, ...]  # its generator and arguments in the root, without the output
    loads: tuple[str, ...]
    variables: tuple[str, ...]
    incidences: tuple[float, ...] = ()  # degrees, at which surface sensitivities are looked at
    is_quick: bool = True


LONGITUDINAL = (("CA", "CN", "Cm"), ("alpha", "q", "alphadot"))
SUBJECTS = {
    "wedge": Subject("wedge/derivatives.toml", ("cases/wedge/mesh.py", "--level", "tiny"), *LONGITUDINAL),
    "cone": Subject("sharp_cone/derivatives.toml", ("cases/sharp_cone/mesh.py", "--size", "0.1"), *LONGITUDINAL, (0, 3)),
    "full cone": Subject("sharp_cone/full.toml", ("cases/sharp_cone/mesh.py", "--model", "full", "--size", "0.11"),
                         ("CA", "CN", "Cm", "CY", "Cn", "Cl"), ("alpha", "q", "alphadot", "beta", "p", "r", "betadot"), is_quick=False),
    "finner": Subject("basic_finner/derivatives.toml", ("scripts/mesh.py", "cases/basic_finner/missile.toml", "--level", "coarse"),
                      *LONGITUDINAL, (2,), is_quick=False),
}


def run(program: str, verb: str, subject: Subject, mesh: Path, out: Path, *words: str) -> dict:
    settings = [f"mesh.file={mesh}", "derivatives.limiter_uncertainty=false", "derivatives.coarser_meshes=[]"]
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


def smoothly(_: random.Random, x: float, y: float, z: float) -> tuple[float, float, float]:
    """A motion of walls that has no symmetry about z = 0 and keeps y = 0."""
    return 0.2 * math.sin(3 * x), 0.3 * y * math.cos(5 * x), z * math.sin(4 * x) + 0.05 * x


def at_random(drawn: random.Random, _x: float, y: float, _z: float) -> tuple[float, float, float]:
    """Each point its own way, those of the plane of symmetry in it."""
    way = [drawn.uniform(-1, 1) for _ in range(3)]
    return way[0], way[1] if abs(y) > 1e-9 else 0.0, way[2]


def shape(name: str, program: str, mesh: Path, out: Path, alpha: float) -> float:
    """The largest difference of the surface sensitivity of a load and of steady flows on moved meshes, as a share of the largest load's."""
    subject = SUBJECTS[name]
    at = ("--set", "steady.orders=12", "--set", f"freestream.alpha={alpha}", "--set", "output.flow=false", "--set", "output.stations=0")
    deep = ("--of", ",".join(subject.loads), "--set", "derivatives.orders=10", "--set", "derivatives.max_iterations=400")
    run(program, "adjoint", subject, mesh, out / "adjoint", *at, *deep)
    with (out / "adjoint" / "surface_sensitivity.csv").open() as file:
        rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(line for line in file if line[0] != "#")]

    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.open(str(mesh))
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    node = {tuple(round(c, 9) for c in coordinates[3 * k : 3 * k + 3]): int(tag) for k, tag in enumerate(tags)}
    walls = [(node[tuple(round(row[axis], 9) for axis in "xyz")], row) for row in rows]

    def loads_of(moved: dict[int, tuple[float, float, float]], step: float) -> dict[str, float]:
        for tag, row in walls:
            gmsh.model.mesh.setNode(tag, [row[axis] + step * way for axis, way in zip("xyz", moved[tag])], [])
        file = out / "moved.msh"
        gmsh.option.setNumber("Mesh.Binary", 1)
        gmsh.write(str(file))
        return run(program, "run", subject, file, out / "moved", *at)["forces"]

    worst, step = 0.0, 3e-9  # where walls move at random, a kink of the limiter may be as near as 1e-8
    for motion in (smoothly, at_random):
        drawn = random.Random(1)
        moved = {tag: motion(drawn, row["x"], row["y"], row["z"]) for tag, row in walls}
        ahead, behind = loads_of(moved, step), loads_of(moved, -step)
        found = {load: sum(row[f"{load}_by_{axis}"] * way for tag, row in walls for axis, way in zip("xyz", moved[tag]))
                 for load in subject.loads}  # fmt: skip
        largest = max(abs(value) for value in found.values())
        for load in subject.loads:
            by_flows = (ahead[load] - behind[load]) / (2 * step)
            difference = abs(by_flows - found[load]) / largest
            worst = max(worst, difference)
            print(f"{name:10} {alpha:g} deg, {load} by walls moved {motion.__name__:9} {by_flows:+.8e} {found[load]:+.8e}  {difference:.1e}")
    gmsh.finalize()
    return worst


def price(name: str, program: str, mesh: Path, out: Path, repeats: int) -> tuple[float, float]:
    """Adjoints over forward solves: processor time of the linear solves (median of pairs), and peak bytes a cell."""
    subject, times, bytes_ = SUBJECTS[name], [], []
    plain = ("--set", "derivatives.orders=6", "--set", "output.surface=false", "--set", "output.flow=false")
    verbs = (("derivatives", ()), ("adjoint", ("--of", "CA,CN,Cm")))
    for _ in range(repeats):
        found = [run(program, verb, subject, mesh, out / verb, *words, *plain)["performance"] for verb, words in verbs]
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
    parser.add_argument("--shape-tolerance", type=float, default=1e-5, help="of the surface sensitivities' difference")
    parser.add_argument("--quick", action="store_true", help="only the small cases, no price")
    parser.add_argument("--ratio", type=float, default=1.3, help="of the price")
    parser.add_argument("--repeats", type=int, default=3)
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    worst = worst_shape = 0.0
    for name, subject in SUBJECTS.items():
        if arguments.quick and not subject.is_quick:
            continue
        mesh = (arguments.out / f"{name.replace(' ', '_')}.msh").resolve()
        if not mesh.exists():
            subprocess.run(["/usr/bin/python3", *subject.mesh, "-o", str(mesh)], check=True, cwd=ROOT,
                           stdout=subprocess.DEVNULL)
        worst = max(worst, compare(name, arguments.program, mesh, arguments.out))
        for alpha in subject.incidences:
            worst_shape = max(worst_shape, shape(name, arguments.program, mesh, arguments.out, alpha))
    ratios = (0.0,)
    if not arguments.quick:
        ratios = price("finner", arguments.program, (arguments.out / "finner.msh").resolve(), arguments.out, arguments.repeats)
    print(f"largest difference {worst:.1e}, tolerance {arguments.tolerance:.0e}; of surface sensitivities {worst_shape:.1e}, tolerance "
          f"{arguments.shape_tolerance:.0e}")
    return 0 if worst <= arguments.tolerance and worst_shape <= arguments.shape_tolerance and max(ratios) <= arguments.ratio else 1


if __name__ == "__main__":
    sys.exit(main())
