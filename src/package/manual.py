#!/usr/bin/python3
"""Writes the man pages alphadot.1.gz and alphadot-sweep.1.gz, as the programs themselves tell of their options and keys.

usage: manual.py ALPHADOT SWEEP.PY FOLDER
"""

from __future__ import annotations

import gzip
import re
import subprocess
import sys
from pathlib import Path

DESCRIPTION = """\
alphadot computes the dynamic stability derivatives of missiles and aircraft, above all the acceleration derivative Cm_alphadot.
It solves the Euler equations on tetrahedral meshes.
A case is described by a TOML file; its mesh is a Gmsh (2.2, 4.1), SU2 or UGRID file.
Started by
.BR mpirun (1)
or srun it runs on any number of ranks, with the same result.
"""

COLUMN = 30  # where the help's meanings begin

AFTER = r"""
.SH FILES
In the folder of a run:
.TP
.I result.json
status, forces, derivatives with their uncertainty, reference, cost and provenance
.TP
.I history.h5, history.csv
angles, rates and loads of every component at every step of a motion; the latter grows while the run works
.TP
.I steady.csv
residual and loads at every iteration of the steady march, likewise
.TP
.I progress.json
the latest state, while the run works
.TP
.I flow.vtkhdf, surface.vtkhdf, symmetry.vtkhdf
the flow, for ParaView 5.11 or later: in the whole, on the body (with cp_alpha and so on, derivatives of Cp, of the verb derivatives), on
planes of symmetry
.TP
.I derivatives.csv, derivatives.st, derivatives.jsbsim.xml
of the verb derivatives: for spreadsheets, readers of AVL's files and JSBSim
.TP
.I components.csv, along_body.csv
what each wall and set of walls contributes to every derivative; where along x they sit
.TP
.I panels.csv, along_panels.csv
loads of the panels of controls in their own frames; where along their spans they sit
.TP
.I adjoint.csv, adjoint.vtkhdf, surface_sensitivity.csv, surface_sensitivity.vtkhdf
of the verb adjoint: derivatives; which cells, and which places of the walls, each load listens to
.TP
.I indicator.vtkhdf
of the verb adjoint with \-\-indicator: where on the mesh the errors of derivatives are made, for alphadot mesh \-\-sizes
.TP
.I adaptation.json, adaptation.csv, convergence.png, cells.png
of the verb derivatives with \-\-tolerance: values and intervals of every family of meshes, and where its cells are
.TP
.I frequency.csv
of the verb frequency: responses to oscillating variables, of the whole and of every wall; from four frequencies on
.I rational_fit.csv
: a few states that answer so in time
.TP
.I checkpoint_NNNNNN.vtkhdf
what \-\-restart goes on from
.TP
.I mesh_2, mesh_3
the same files of the coarser meshes that derivatives.coarser_meshes lists
.TP
.I resolved_case.toml
the case with every default filled in
.TP
.I stop
made by the user, this file ends the run with a checkpoint
.PP
A folder holds the results of one flow and one verb, and works for one run at a time. What stands there finished is replaced when the
result of a new run stands; results of another flow or verb only with \-\-overwrite.
.SH MOMENT CENTRES
.B alphadot derive
moves finished derivatives, no flow is computed again. A centre is x, or x,y,z in the unit of the mesh; x alone keeps the run's y and
z. The file of
.B \-\-centers
has one a line and # for remarks. The rates are about the new centre, too: it and the old one differ by a wind, so that derivatives by
q about a centre above or below the run's own, and by r beside it, would need derivatives by speed, which are not known. They are left
out. In a stream at incidence the same surge is neglected to first order. Several centres of one file stand side by side in a last
table: x_cg, Cm_alpha, Cm_q, Cm_alphadot, their sum, static margin. A run that is not converged has its status above each table.
.B \-\-json
prints a list with an entry a file and centre: file, status, message, center, reference, freestream, loads (of the steady flow, of a
history at every step), uncertainty, left_out, derivatives (value, uncertainty, method, converged, parts).
.SH SIGNALS
.TP
.B USR1
write a checkpoint and go on
.TP
.B USR2
write a checkpoint and end
.TP
.BR TERM ", " INT ", " HUP
end as safely as the second that mpirun leaves allows; HUP not under
.BR nohup (1)
.PP
Before the flow is computed there is nothing to save, and signals to end do so at once.
.SH EXIT STATUS
.nf
0  converged, or completed: everything that was asked for was reached
1  error in the input or the environment; the message has file, line and remedy
2  wrong command line
3  interrupted
4  diverged
5  not converged: something that was asked for was not reached; the last line says what
.fi
.SH EXAMPLES
.nf
mpirun \-n 8 alphadot run missile.toml \-\-out runs/first
alphadot watch runs/first
mpirun \-n 8 alphadot derivatives missile.toml \-\-set freestream.mach=2 \-\-out runs/linear
alphadot derive runs/linear/result.json \-\-center 0.7 \-\-center 0.8,0,0.1
alphadot derive runs/*/result.json \-\-centers centers.txt \-\-json
.fi
.SH SEE ALSO
.BR mpirun (1),
.BR gmsh (1);
.BR alphadot\-sweep (1)
"""


def told(program: str, *arguments: str) -> str:
    return subprocess.run([program, *arguments], check=True, capture_output=True, text=True).stdout


def roff(text: str) -> str:
    """Text with what roff would take for its own escaped."""
    return re.sub(r"^([.'])", r"\\&\1", text.replace("\\", r"\e").replace("-", r"\-"), flags=re.MULTILINE)


def entries(text: str, heading: str) -> list[tuple[str, str]]:
    """Names and meanings below a heading of the help: the meaning is from COLUMN on, of the next line when the name is too long."""
    block = re.search(rf"^{heading}:\n((?:  .*\n?)+)", text, re.MULTILINE)
    lines = block[1].splitlines() if block else []
    out: list[tuple[str, str]] = []
    for line, before in zip(lines, ["", *lines]):
        if not line[:COLUMN].strip():
            out[-1] = (before.strip(), line.strip())
        else:
            out.append((line[:COLUMN].strip(), line[COLUMN:].strip()))
    return out


def listed(items: list[tuple[str, str]]) -> str:
    return "".join(f".TP\n.B {roff(name)}\n{roff(meaning)}\n" for name, meaning in items)


def title(name: str, version: str) -> str:
    return f'.TH {roff(name.upper())} 1 "" "alphadot {version}" "User Commands"\n'


def version_of(program: str) -> str:
    return told(program, "--version").split()[1]


def sweep_manual(program: str, script: str) -> str:
    """The page of sweep.py: its help as it is, then that of each verb."""
    help_text = told(sys.executable, "-B", script, "--help").replace("sweep.py", "alphadot-sweep")
    page = title("alphadot-sweep", version_of(program))
    page += ".SH NAME\nalphadot\\-sweep \\- many runs of alphadot, and a report on them\n.SH DESCRIPTION\n"
    page += f".nf\n{roff(help_text)}.fi\n.SH VERBS\n"
    for verb in re.findall(r"^  alphadot-sweep ([a-z]+) ", help_text, re.MULTILINE):
        text = told(sys.executable, "-B", script, verb, "--help").replace("sweep.py", "alphadot-sweep")
        page += f".SS {verb}\n.nf\n{roff(text)}.fi\n"
    return page + ".SH SEE ALSO\n.BR alphadot (1)\n"


def manual(program: str) -> str:
    head = told(program, "--help")
    version = version_of(program)
    verbs = entries(head, "Subcommands")
    summary = head.splitlines()[0].rstrip(".")
    page = title("alphadot", version)
    page += f".SH NAME\nalphadot \\- {roff(summary[0].lower() + summary[1:])}\n"
    page += ".SH SYNOPSIS\n.B alphadot\n.I VERB\n[\\fIoptions\\fR] [\\fIfile\\fR]\n"
    page += f".SH DESCRIPTION\n{DESCRIPTION}.SH OPTIONS\n{listed(entries(head, 'Options'))}.SH VERBS\n"
    for verb, meaning in verbs:
        text = told(program, verb, "--help")
        if verb == "mesh":  # a program of its own, whose help is as it is
            page += f".SS mesh\n.nf\n{roff(text)}.fi\n"
            continue
        own = entries(text, "Positionals") + [entry for entry in entries(text, "Options") if "--help" not in entry[0]]
        page += f".SS {verb}\n{roff(meaning)}.\n{listed(own)}"
    keys = roff(told(program, "keys").strip("\n"))
    return f"{page}.SH CASE FILE\nEvery key, with its meaning, kind and default:\n.PP\n.nf\n{keys}\n.fi{AFTER}"


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    alphadot, sweep, folder = sys.argv[1:]
    for name, text in (("alphadot", manual(alphadot)), ("alphadot-sweep", sweep_manual(alphadot, sweep))):
        Path(folder, f"{name}.1.gz").write_bytes(gzip.compress(text.encode(), 9, mtime=0))
