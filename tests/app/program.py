"""What the tests of the program share: a way to run it, and tiny meshes and cases made on the fly.

Set by CTest: ALPHADOT (the program), MPIEXEC, RANKS (number of ranks, default 1). Needs the standard library only.
"""

from __future__ import annotations

import os
import subprocess
import tempfile
from dataclasses import dataclass
from itertools import permutations, product
from pathlib import Path

# A program on one rank needs no daemon, which takes longer to start than all the rest. Without one, programs that run at the
# same time must not share Open MPI's folder.
MPI_FOLDER = tempfile.TemporaryDirectory()
os.environ |= {"OMPI_MCA_ess_singleton_isolated": "1", "OMPI_MCA_orte_tmpdir_base": MPI_FOLDER.name}

PROGRAM = os.environ["ALPHADOT"]
RANKS = int(os.environ.get("RANKS", "1"))
SECONDS = 60  # before a run counts as hanging

# Writes the exit code of its rank and succeeds itself: mpiexec then ends no rank early, and a rank that hangs is seen.
RECORDER = 'alphadot=$1 codes=$2; shift 2; "$alphadot" "$@"; echo $? > "$codes/rank.${OMPI_COMM_WORLD_RANK:-0}"'


@dataclass(frozen=True)
class Outcome:
    """How a run ended: exit code of each rank (None: the rank was ended from outside), and what it printed."""

    codes: list[int | None]
    out: str
    err: str

    @property
    def errors(self) -> list[str]:
        """The lines of the standard error that report an error."""
        return [line for line in self.err.splitlines() if "error" in line.lower()]


def run(folder: Path, *arguments: object, ranks: int = RANKS) -> Outcome:
    """Run the program in `folder`; raises subprocess.TimeoutExpired when it hangs."""
    for rank in range(ranks):
        (folder / f"rank.{rank}").unlink(missing_ok=True)
    launcher = [os.environ["MPIEXEC"], "-n", str(ranks)] if ranks > 1 else []
    command = [*launcher, "/bin/sh", "-c", RECORDER, "sh", PROGRAM, str(folder), *map(str, arguments)]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=SECONDS)
    files = [folder / f"rank.{rank}" for rank in range(ranks)]
    return Outcome([int(file.read_text()) if file.exists() else None for file in files], done.stdout, done.stderr)


Points = list[tuple[float, float, float]]
Cells = list[tuple[int, ...]]


def box(n: int) -> tuple[Points, Cells, dict[str, Cells]]:
    """The unit cube in 6 n^3 tetrahedra (Kuhn): points, cells, and the patches "wall" (z = 0), "sides" (y = 0, 1), "farfield"."""
    points = [(i / n, j / n, k / n) for i, j, k in product(range(n + 1), repeat=3)]
    number = {point: index for index, point in enumerate(points)}
    cells: Cells = []
    for corner in product(range(n), repeat=3):
        for axes in permutations(range(3)):
            path, at = [corner], list(corner)
            for axis in axes:
                at[axis] += 1
                path.append(tuple(at))
            a, b, c, d = (number[tuple(x / n for x in vertex)] for vertex in path)
            even = axes in ((0, 1, 2), (1, 2, 0), (2, 0, 1))
            cells.append((a, b, c, d) if even else (a, c, b, d))
    patches: dict[str, Cells] = {"wall": [], "sides": [], "farfield": []}
    for cell in cells:
        for face in (cell[:i] + cell[i + 1 :] for i in range(4)):
            for axis, side in product(range(3), (0.0, 1.0)):
                if all(points[p][axis] == side for p in face):
                    patches["sides" if axis == 1 else "wall" if (axis, side) == (2, 0.0) else "farfield"].append(face)
    return points, cells, patches


def gmsh_text(points: Points, cells: Cells, patches: dict[str, Cells]) -> str:
    """A Gmsh 2.2 text file."""
    names = [f'2 {tag} "{name}"' for tag, name in enumerate(patches, 1)] + [f'3 {len(patches) + 1} "fluid"']
    elements = [(2, tag, face) for tag, faces in enumerate(patches.values(), 1) for face in faces]
    elements += [(4, len(patches) + 1, cell) for cell in cells]
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(names)), *names, "$EndPhysicalNames"]
    lines += ["$Nodes", str(len(points)), *(f"{i} {x} {y} {z}" for i, (x, y, z) in enumerate(points, 1)), "$EndNodes"]
    lines += ["$Elements", str(len(elements))]
    for i, (kind, tag, nodes) in enumerate(elements, 1):
        lines.append(f"{i} {kind} 2 {tag} {tag} " + " ".join(str(node + 1) for node in nodes))
    return "\n".join([*lines, "$EndElements", ""])


CASE = """\
[mesh]
file = "box.msh"

[freestream]
mach = 2.0
alpha = 1.0

[boundary]
wall = "wall"
sides = "symmetry"
farfield = "farfield"
"""


def write_case(folder: Path, case: str = CASE, mesh: str | None = None) -> Path:
    """Write case.toml, and box.msh beside it (the cube of 48 cells unless `mesh` is given)."""
    (folder / "box.msh").write_text(gmsh_text(*box(2)) if mesh is None else mesh)
    (folder / "case.toml").write_text(case)
    return folder / "case.toml"
