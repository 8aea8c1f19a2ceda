#!/usr/bin/python3
"""Holds the printed derivatives of many small cases against differences of steady flows.

Draws cases over body, Mach number, incidence, flux, limiter, gradient and scheme (seeded), and compares the derivatives by alpha
and by q, loads CA, CN and Cm, with central differences of steady flows at a little more and less incidence or rate, which another
scheme converges and which never freeze the limiter (a flow with frozen factors is another one each time). An entry of a run that
says "converged" must agree within its printed uncertainty and what the difference itself may be off; a case whose steady flows do
not come to rest has no reference and is counted as such. A discrete flow may bend within 1e-7 of a rate (a face that hardly any gas
crosses): where the difference does not agree, one of flows thirteen decades down with steps a thousand times smaller decides. Then
the same bodies with a defect planted: a march cut short, a linear solve cut short, a cell nearly without volume. Those must not say
"converged", or be right; of a march cut short it is counted how often the uncertainty, of which the steady residual is a part,
holds the end of the whole march.

Exit code 0 when no promise is broken. Appends each case's rows to consistency.csv in --out as it ends; the same command again goes on
where it was stopped (another --seed or --program needs another --out). --jobs cases at a time, some ten seconds each.
"""

from __future__ import annotations

import argparse
import csv
import json
import math
import os
import random
import subprocess
import sys
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
CASES = ROOT / "cases"
LOADS = ("CA", "CN", "Cm")
ALPHA_STEP, Q_STEP = 2e-3, 2e-5  # degrees; reduced rate
# Steady flows are ten decades down, so that what they leave in a difference is 1e-10 over a step; curvature and kinks of limiter and flux
# leave more, which the difference with twice the step tells.
SOLVER_NOISE = 1e-9
FINER = 1e-3  # steps and noise of the second reference


@dataclass(frozen=True)
class Body:
    case: str  # below cases/
    make: tuple[str, ...]  # command of its mesh in the root, without the output
    machs: tuple[float, ...]


BODIES = {
    "wedge": Body("wedge/derivatives.toml", ("cases/wedge/mesh.py", "--level", "tiny"), (1.5, 1.8, 2.0, 2.5, 3.5)),
    "cone": Body("sharp_cone/derivatives.toml", ("cases/sharp_cone/mesh.py", "--size", "0.11"), (1.58, 2.0, 2.5, 3.5, 5.0)),
    "finner": Body("basic_finner/derivatives.toml", ("scripts/mesh.py", "cases/basic_finner/missile.toml", "--cells", "12000"),
                   (1.58, 1.75, 2.1, 2.5, 3.5)),
    "wing": Body("delta_wing/wing.toml", ("gmsh",), (1.5, 2.0, 2.5, 3.0)),
}
SCHEMES = ({}, {"steady.scheme": "lu_sgs"}, {"steady.krylov_directions": 0}, {"steady.sweeps": 2}, {"derivatives.method": "march"})
COLUMNS = ("number", "defect", "body", "freestream.mach", "freestream.alpha", "space.flux", "space.limiter", "space.gradient",
           "steady.scheme", "steady.krylov_directions", "steady.sweeps", "derivatives.method", "entry", "value", "eight_decades", "difference",
           "error", "printed", "doubt", "verdict")  # fmt: skip
OTHER = {"space.freeze_orders": 0, "steady.sweeps": 3, "steady.cfl_max": 200, "steady.cfl_start": 10, "steady.orders": 10}


def mesh_of(name: str, folder: Path) -> Path:
    body, path = BODIES[name], folder / f"{name}.msh"
    if not path.exists():
        if body.make[0] == "gmsh":
            line = ["gmsh", "-3", "-clscale", "2.4", "-format", "msh22", str(CASES / "delta_wing" / "wing.geo"), "-o", str(path.resolve())]
        else:
            line = ["/usr/bin/python3", *body.make, "-o", str(path.resolve())]
        subprocess.run(line, check=True, capture_output=True, cwd=ROOT)
    return path


def run(program: str, verb: str, case: str, settings: dict[str, object], out: Path) -> dict | None:
    """Its result, or nothing when it refused the input."""
    words = []
    for key, value in {"output.flow": "false", "output.surface": "false", **settings}.items():
        words += ["--set", f"{key}={value}"]
    done = subprocess.run([program, verb, str(CASES / case), "--out", str(out), "--overwrite", "--quiet", *words], capture_output=True, text=True)
    if done.returncode == 1:
        return None
    return json.loads((out / "result.json").read_text())


def slope(
    program: str, case: str, settings: dict[str, object], variable: str, out: Path, finer: float = 1.0
) -> dict[str, tuple[float, float]] | None:
    """Central difference of each load and how far it may be off; nothing when a flow did not come to rest."""
    loads = {}
    for k in (-2, -1, 1, 2):
        here = settings | {"steady.orders": settings["steady.orders"] - math.log10(finer)}
        if variable == "alpha":
            here["freestream.alpha"] = settings["freestream.alpha"] + k * ALPHA_STEP * finer
        else:
            here["motion.rotation"] = f"[0,{k * Q_STEP * finer},0]"
        found = run(program, "run", case, here, out / f"{variable}{k}_{finer:g}")
        if not found or found["status"] != "converged" or found.get("message"):
            return None
        loads[k] = found["forces"]
    step = finer * (math.radians(ALPHA_STEP) if variable == "alpha" else Q_STEP)
    result = {}
    for load in LOADS:
        near, far = ((loads[k][load] - loads[-k][load]) / (2 * k * step) for k in (1, 2))
        result[load] = (near, abs(far - near) + finer * SOLVER_NOISE / step)
    return result


def draw(rng: random.Random) -> tuple[str, dict[str, object]]:
    name = rng.choice(list(BODIES))
    settings: dict[str, object] = {
        "freestream.mach": rng.choice(BODIES[name].machs),
        "freestream.alpha": rng.choice((0.0, 1.0, 3.0, 5.0)),
        "space.flux": rng.choice(("roe", "hllc", "van_leer")),
        "space.limiter": rng.choice(("venkatakrishnan", "venkatakrishnan", "mlp_u2", "barth_jespersen", "none")),
        "space.gradient": rng.choice(("least_squares", "least_squares", "green_gauss")),
        **rng.choice(SCHEMES),
    }
    return name, settings


def squashed(mesh: Path, rng: random.Random) -> Path:
    """A copy whose inner point has been moved most of the way into the opposite face of one of its cells."""
    text = mesh.with_name(f"{mesh.stem}_text.msh")
    if not text.exists():
        part = mesh.with_name(f"{mesh.stem}_text_{rng.random()}.msh")
        subprocess.run(["gmsh", str(mesh), "-save", "-format", "msh22", "-o", str(part)], check=True, capture_output=True)
        part.rename(text)
    lines = text.read_text().splitlines()
    at = lines.index("$Nodes") + 2
    points = {int(words[0]): (i, [float(x) for x in words[1:4]])
              for i, words in ((i, lines[i].split()) for i in range(at, at + int(lines[at - 1])))}  # fmt: skip
    at = lines.index("$Elements") + 2
    elements = [[int(word) for word in line.split()] for line in lines[at : at + int(lines[at - 1])]]
    corners = [element[3 + element[2] :] for element in elements if element[1] == 4]
    surface = {point for element in elements if element[1] == 2 for point in element[3 + element[2] :]}
    inner = [(point, [other for other in c if other != point]) for c in corners for point in c if point not in surface]
    point, others = rng.choice(inner)
    index, old = points[point]
    middle = [sum(points[other][1][k] for other in others) / 3 for k in range(3)]
    moved = [old[k] + 0.97 * (middle[k] - old[k]) for k in range(3)]
    lines[index] = f"{point} {moved[0]:.17g} {moved[1]:.17g} {moved[2]:.17g}"
    path = mesh.with_name(f"{mesh.stem}_squashed_{point}.msh")
    path.write_text("\n".join(lines) + "\n")
    return path


def check(number: int, program: str, folder: Path, seed: int, defect: str) -> list[dict[str, object]]:
    """One row a promise."""
    rng = random.Random(1000 * seed + number)
    name, settings = draw(rng)
    mesh = mesh_of(name, folder)
    if defect == "cell":
        mesh = squashed(mesh, rng)
    settings["mesh.file"] = mesh
    out = folder / f"run_{defect}_{number}"
    planted = {"march": {"steady.max_iterations": rng.choice((3, 6, 10))}, "solve": {"derivatives.max_iterations": rng.choice((1, 2, 3))}}
    base = {"number": number, "defect": defect, "body": name} | {key: str(value) for key, value in settings.items() if key != "mesh.file"}
    found = run(program, "derivatives", BODIES[name].case, settings | planted.get(defect, {}), out / "derivatives")
    if found is None:
        return [base | {"verdict": "refused"}]
    if found["status"] != "converged":
        if defect != "march":
            return [base | {"verdict": f"says {found['status']}"}]
        return [base | {"verdict": f"says {found['status']}, {word}"} for word in stopped_early(program, name, settings, found, out)]
    if defect in planted:
        return [base | {"verdict": "BROKEN: says converged"}]
    reference = {key: value for key, value in settings.items() if not key.startswith(("steady.", "derivatives."))} | OTHER
    rows = []
    exact = run(program, "derivatives", BODIES[name].case, settings | {"derivatives.orders": 8, "derivatives.max_iterations": 3000}, out / "exact")
    for entry, found_here in found["derivatives"].items() if exact["status"] == "converged" else ():
        error = abs(found_here["value"] - exact["derivatives"][entry]["value"])
        holds = error <= found_here["uncertainty"] + exact["derivatives"][entry]["uncertainty"]
        rows.append(base | {"entry": entry, "value": found_here["value"], "eight_decades": exact["derivatives"][entry]["value"],
                            "error": error, "printed": found_here["uncertainty"],
                            "verdict": "holds beside eight decades" if holds else "BROKEN: beside eight decades"})  # fmt: skip
    for variable in ("alpha", "q"):
        slopes = slope(program, BODIES[name].case, reference, variable, out)
        if slopes is None:
            rows.append(base | {"entry": variable, "verdict": "no reference"})
            continue
        entries = {load: found["derivatives"][f"{load}_{variable}"] for load in LOADS}
        agrees = lambda load: abs(entries[load]["value"] - slopes[load][0]) <= entries[load]["uncertainty"] + slopes[load][1]
        word = "holds"
        if not all(map(agrees, LOADS)) and (finer := slope(program, BODIES[name].case, reference, variable, out, FINER)):
            slopes, word = finer, "holds beside finer steps"
        for load, (value, doubt) in slopes.items():
            entry, holds = entries[load], agrees(load)
            error = abs(entry["value"] - value)
            rows.append(base | {"entry": f"{load}_{variable}", "value": entry["value"], "difference": value, "error": error,
                                "printed": entry["uncertainty"], "doubt": doubt,
                                "verdict": word if holds else "BROKEN: error beyond the uncertainty"})  # fmt: skip
    return rows


def stopped_early(program: str, name: str, settings: dict[str, object], found: dict, out: Path) -> list[str]:
    """Of each entry whether the march that goes on ends within its uncertainty."""
    whole = run(program, "derivatives", BODIES[name].case, settings, out / "whole")
    if not whole or whole["status"] != "converged" or "derivatives" not in found:
        return ["no reference"]
    words = []
    for entry, cut in found["derivatives"].items():
        end, width = whole["derivatives"][entry], cut["uncertainty"]
        if width is None:
            words.append("not known")
        else:
            holds = abs(cut["value"] - end["value"]) <= width + end["uncertainty"]
            words.append("its end within the uncertainty" if holds else "its end outside")
    return words


def described(row: dict[str, object]) -> str:
    return ", ".join(f"{key} {value}" for key, value in row.items() if value not in ("", None))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default=str(ROOT / "build" / "alphadot"))
    parser.add_argument("--cases", type=int, default=200, help="drawn without a defect; a quarter as many with each defect")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--out", type=Path, default=ROOT / "runs" / "consistency")
    arguments = parser.parse_args()
    os.environ |= {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_ess_singleton_isolated": "1"}
    arguments.out.mkdir(parents=True, exist_ok=True)
    for name in BODIES:
        mesh_of(name, arguments.out)
    work = [(number, "none") for number in range(arguments.cases)]
    work += [(number, defect) for defect in ("march", "solve", "cell") for number in range(arguments.cases // 4)]
    table = arguments.out / "consistency.csv"
    rows: list[dict[str, object]] = []
    if table.exists():
        with open(table, newline="") as file:
            rows = list(csv.DictReader(file))
        ended = {(int(row["number"]), row["defect"]) for row in rows}
        work = [item for item in work if item not in ended]
        print(f"{table}: {len(ended)} cases have ended, {len(work)} are left", file=sys.stderr)
    started = time.monotonic()
    with ThreadPoolExecutor(arguments.jobs) as pool, open(table, "a", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS)
        if not rows:
            writer.writeheader()
        jobs = [pool.submit(check, number, arguments.program, arguments.out, arguments.seed, defect) for number, defect in work]
        for done, job in enumerate(as_completed(jobs), 1):
            found = job.result()
            writer.writerows(found)
            file.flush()
            rows += found
            for row in found:
                if row["verdict"].startswith("BROKEN"):
                    print(described(row), file=sys.stderr)
            if sys.stderr.isatty() or done % 10 == 0:
                left = (time.monotonic() - started) / done * (len(jobs) - done) / 60
                print(f"{done} of {len(jobs)} cases, {len(rows)} promises, {left:.0f} min left", file=sys.stderr)
    for (defect, verdict), count in sorted(Counter((row["defect"], row["verdict"]) for row in rows).items()):
        print(f"defect {defect:6} {verdict:40} {count}")
    broken = [row for row in rows if row["verdict"].startswith("BROKEN")]
    for row in broken[:20]:
        print(described(row))
    sys.exit(1 if broken else 0)


if __name__ == "__main__":
    main()
