#!/usr/bin/python3
"""Steady flows over a grid of Mach numbers and incidences by default settings: which reach their decades, and what they cost.

A description of a missile gets one mesh for the whole grid, of --cells cells, and the case that `alphadot mesh` writes beside it; a case
file keeps its mesh. Runs `alphadot run` on every case at every Mach number and incidence, nothing else changed, and appends each to envelope.csv as it ends;
what stands there already is not run again. envelope.md and the standard output have one table a case, in Markdown: iterations and
processor seconds of the flows that reached their decades, status and decades of the others. Exit code 1 if the share of flows that
reached them is below --least. Descriptions need Debian's python3-gmsh.
"""

from __future__ import annotations

import argparse
import csv
import json
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import asdict, dataclass, fields
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
MACHS = [0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 1.05, 1.1, 1.2, 1.4, 1.58, 2.0, 2.5, 3.5, 5.0, 6.0]
ALPHAS = [0.0, 2.0, 5.0, 10.0, 15.0, 20.0]
ENDED = {0, 4, 5}  # exit codes of a run that came to an end: converged or completed, diverged, not converged


@dataclass(frozen=True)
class Flow:
    """One steady flow and how its march ended. `iterations` and `cpu_s` include attempts in vain."""

    case: str
    mach: float
    alpha: float
    status: str
    decades: float
    iterations: int
    cpu_s: float
    CN: float
    Cm: float

    @property
    def reached(self) -> bool:
        return self.status in ("converged", "completed")

    @property
    def text(self) -> str:
        return f"{self.iterations}, {self.cpu_s:.0f} s" if self.reached else f"{self.status} ({self.decades:.1f})"


def last_decades(folder: Path) -> float:
    """Decades in the last row of the table of iterations; 0 without one."""
    try:
        rows = [line for line in (folder / "steady.csv").read_text().splitlines() if line and line[0].isdigit()]
        return float(rows[-1].split(",")[1])
    except (OSError, IndexError):
        return 0.0


def march(program: Path, case: Path, mach: float, alpha: float, arguments: argparse.Namespace) -> Flow:
    folder = arguments.out / case_name(case) / f"mach_{mach:g}_alpha_{alpha:g}"
    settings = [f"freestream.mach={mach:g}", f"freestream.alpha={alpha:g}", f"steady.orders={arguments.orders:g}",
                f"steady.max_iterations={arguments.iterations}", "motion.kind=none", "output.flow=false", "output.surface=false",
                *arguments.set]  # fmt: skip
    overrides = [part for setting in settings for part in ("--set", setting)]
    done = subprocess.run([program, "run", case, "--out", folder, "--overwrite", "--quiet", *overrides], text=True, capture_output=True)
    if done.returncode not in ENDED:
        raise RuntimeError(f"{case} at Mach {mach:g}, {alpha:g} deg: exit code {done.returncode}\n{done.stderr}")
    result = json.loads((folder / "result.json").read_text())
    for checkpoint in folder.glob("checkpoint_*"):
        checkpoint.unlink()
    cost, forces = result["performance"], result["forces"]
    return Flow(case_name(case), mach, alpha, result["status"], last_decades(folder), cost["iterations"], cost["cpu_s"], forces["CN"], forces["Cm"])


def case_name(case: Path) -> str:
    return case.resolve().parent.name


def is_description(path: Path) -> bool:
    return "[[body]]" in path.read_text()


def meshed(description: Path, arguments: argparse.Namespace) -> Path:
    """The case of a description, with a mesh for all Mach numbers and incidences; made once."""
    folder = arguments.out / "cases" / case_name(description)
    case = folder / "case.toml"
    if not case.exists():
        # The range of incidences stands in the description alone.
        text = re.sub(r"(?m)^flight *= *\{.*?\}", "", description.read_text())
        folder.mkdir(parents=True, exist_ok=True)
        flight = f"flight = {{mach = [{min(arguments.mach):g}, {max(arguments.mach):g}], alpha = {max(1.0, *map(abs, arguments.alpha)):g}}}\n"
        (folder / "missile.toml").write_text(flight + text)
        line = ["/usr/bin/python3", ROOT / "scripts" / "mesh.py", folder / "missile.toml", "--cells", str(arguments.cells), "-o", folder]
        subprocess.run(line, check=True, stdout=subprocess.DEVNULL)
    return case


def read(path: Path) -> list[Flow]:
    if not path.exists():
        return []
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    kinds = {"str": str, "float": float, "int": int}
    return [Flow(**{field.name: kinds[str(field.type)](row[field.name]) for field in fields(Flow)}) for row in rows]


def tables(flows: list[Flow]) -> str:
    parts = []
    for case in dict.fromkeys(flow.case for flow in flows):
        mine = {(flow.mach, flow.alpha): flow for flow in flows if flow.case == case}
        machs, alphas = sorted({mach for mach, _ in mine}), sorted({alpha for _, alpha in mine})
        lines = [f"{case}: {sum(flow.reached for flow in mine.values())} of {len(mine)} reached", ""]
        lines.append("| Mach | " + " | ".join(f"{alpha:g}°" for alpha in alphas) + " |")
        lines.append("|---" * (len(alphas) + 1) + "|")
        for mach in machs:
            lines.append(f"| {mach:g} | " + " | ".join(mine[mach, a].text if (mach, a) in mine else "" for a in alphas) + " |")
        parts.append("\n".join(lines))
    return "\n\n".join(parts) + "\n"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("cases", type=Path, nargs="+", help="descriptions, or case files whose meshes suit the Mach numbers")
    parser.add_argument("--cells", type=int, default=40_000, help="of the meshes of descriptions (default: 40000)")
    parser.add_argument("--mach", type=float, nargs="+", default=MACHS)
    parser.add_argument("--alpha", type=float, nargs="+", default=ALPHAS, help="degrees")
    parser.add_argument("--orders", type=float, default=6.0, help="decades to reach (default: 6)")
    parser.add_argument("--iterations", type=int, default=500, help="limit of iterations (default: 500)")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="replace a key of the cases")
    parser.add_argument("--least", type=float, default=0.95, help="share that must reach them (default: 0.95)")
    parser.add_argument("--jobs", type=int, default=1, help="flows at once")
    parser.add_argument("--out", type=Path, default=Path("runs/envelope"), help="folder (default: runs/envelope)")
    parser.add_argument("--program", type=Path, default=ROOT / "build" / "alphadot")
    arguments = parser.parse_args()
    arguments.program = arguments.program.absolute()
    for file in (*arguments.cases, arguments.program):
        if not file.exists():
            parser.error(f"there is no {file}")

    arguments.out.mkdir(parents=True, exist_ok=True)
    cases = [meshed(file, arguments) if is_description(file) else file for file in arguments.cases]
    path = arguments.out / "envelope.csv"
    flows = read(path)
    known = {(flow.case, flow.mach, flow.alpha) for flow in flows}
    wanted = [(case, mach, alpha) for case in cases for mach in arguments.mach for alpha in arguments.alpha]
    missing = [one for one in wanted if (case_name(one[0]), *one[1:]) not in known]
    with ThreadPoolExecutor(arguments.jobs) as pool, open(path, "a", newline="") as file:
        writer = csv.DictWriter(file, [field.name for field in fields(Flow)])
        if file.tell() == 0:
            writer.writeheader()
        for done in as_completed(pool.submit(march, arguments.program, *one, arguments) for one in missing):
            flow = done.result()
            flows.append(flow)
            writer.writerow(asdict(flow))
            file.flush()
            print(f"{flow.case} Mach {flow.mach:g} {flow.alpha:g} deg: {flow.text}", file=sys.stderr)

    text = tables(flows)
    (arguments.out / "envelope.md").write_text(text)
    print(text)
    share = sum(flow.reached for flow in flows) / len(flows)
    sys.exit(0 if share >= arguments.least else f"envelope.py: {100 * share:.0f} % reached {arguments.orders:g} decades")


if __name__ == "__main__":
    main()
