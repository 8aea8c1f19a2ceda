#!/usr/bin/python3
"""The report: one file that refers to nothing outside, with the numbers beside what they refer to."""

from __future__ import annotations

import csv
import re
import unittest
from html.parser import HTMLParser

from stub_runs import finish
from test_surface_loads import write_surface
from test_table import model
from workspace import HEAD, SCRIPTS, Workspace

from sweep.plan import read_sweep


HEAD_ALONE = HEAD.replace("alpha = 1.5\n", "")


class References(HTMLParser):
    """Collects what a page would fetch, and checks that its elements are closed."""

    VOID = {"meta", "img", "br", "hr", "link", "input"}

    def __init__(self) -> None:
        super().__init__()
        self.outside: list[str] = []
        self.open: list[str] = []

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        if tag not in self.VOID:
            self.open.append(tag)
        for name, value in attributes:
            if name in ("src", "href", "srcset", "data") and not (value or "").startswith(("data:", "#")):
                self.outside.append(f"{tag} {name}={value}")

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag, tag


class Report(Workspace):
    def report(self, case: str = "good.toml") -> str:
        self.write(
            '[[runs]]\nmach = [1.58, 1.75, 1.89, 2.10, 2.50]\n\n[[runs]]\nlabel = "bad"\ncase = "bad.toml"\nmach = 3\n',
            f'title = "Try <1>"\ncase = "{case}"\nfolder = "{self.folder}/runs"\nalpha = 1.5\n',
        )
        self.sweep("run", code=1)
        return (self.folder / "runs" / "report.html").read_text()

    def test_page_and_files(self) -> None:
        """One test, since it takes seconds to make a report."""
        text = self.report()
        self.refers_to_nothing_outside(text)
        self.assertNotIn("Beside the paper", text)  # other configurations have none
        for words in ("Try &lt;1&gt;", "(5.5, 0, 0)", "length / (2 V)", "5 of 6 runs done", "no such mesh", "width=device-width"):
            self.assertIn(words, text)
        self.assertTrue((self.folder / "runs" / "report" / "convergence_steady.svg").exists())
        with open(self.folder / "runs" / "report" / "derivatives.csv") as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        self.assertEqual([float(row["Mach"]) for row in rows], [1.58, 1.75, 1.89, 2.10, 2.50])
        self.assertAlmostEqual(float(rows[0]["Cm_alpha"]), -60 / 1.58)

    def test_not_converged_stands_first(self) -> None:
        self.write('[[runs]]\nmach = 2\n\n[[runs]]\nlabel = "short"\ncase = "short.toml"\nmach = 3\n')
        self.sweep("run", code=5)
        text = (self.folder / "runs" / "report.html").read_text()
        top = text[: text.index("<h2")]
        self.assertIn("short_m3_a1.5: the linear residual for alpha dropped 1.3 of 3 decades", top)
        self.assertIn("solver only; mesh not assessed", text)
        with open(self.folder / "runs" / "report" / "derivatives.csv") as file:
            caption, *lines = file
        self.assertIn("±: solver only; mesh not assessed", caption)
        names = [row["run"] for row in csv.DictReader(lines)]
        self.assertEqual(names, ["short_m3_a1.5 (not converged)", "derivatives_m2_a1.5"])

    def test_many_conditions_of_a_full_model(self) -> None:
        """Lines over both variables with one legend, the side, motion; what failed and what is not converged before everything."""
        mass = "[[mass]]\nmass = 20\ninertia = [0.05, 6, 6]\ncenter = 0.5\n"
        self.write(mass + "[[runs]]\nmach = {from = 1.2, to = 3, count = 10}\nalpha = [0, 4]\n[[runs]]\nmach = 2\nbeta = [2, 4]\n", HEAD_ALONE)
        runs = read_sweep(self.file).runs
        ends = {runs[3].name: "failed", runs[5].name: "not_converged"}
        finish(runs, model, lambda run: ends.get(run.name, "converged"))
        self.sweep("report")
        text = (self.folder / "runs" / "report.html").read_text()
        self.refers_to_nothing_outside(text)
        first = (f"{runs[3].name}: no such mesh", f"{runs[5].name}: the steady march", "static margin", "<h2")
        places = [text.index(words) for words in first]
        self.assertEqual(places, sorted(places))
        for name in ("alpha_CN", "alpha_x_cp", "mach_margin", "mach_damping", "mach_Cn_beta", "mach_Cl_p", "beta_CY"):
            self.assertTrue((self.folder / "runs" / "report" / f"{name}.svg").exists(), name)
        self.assertTrue((self.folder / "runs" / "report" / "convergence_steady.svg").exists())
        self.assertFalse((self.folder / "runs" / "report" / "alpha_CY.svg").exists())  # there is no sideslip
        # A colour for each of eight Mach numbers of ten, over both angles, and for each angle over Mach number; and the mark, in all.
        self.assertEqual(text.count('class="legend"'), 3)
        self.assertEqual(len(re.findall(r"Mach [\d.]+</span>", text)), 16)
        self.assertEqual(len(re.findall(r"α = \d°</span>", text)), 2)
        self.assertEqual(text.count("not converged</span>"), 3)
        self.assertIn("a half width: solver and mesh", text)
        # Value and half width in one cell: CN_alpha = 7 (1 - 0.3) / 1.2 and 1 % of it.
        self.assertIn("<td>4.083 ± 0.04</td>", text)
        self.assertIn("damped below", text)

    def test_groups_of_derivatives(self) -> None:
        """In the plane of symmetry, out of it, one by the other, by controls; what is zero within its ± is named once."""

        def coupled(mach: float, alpha: float, beta: float) -> tuple[dict, dict]:
            steady, derivatives = model(mach, alpha, beta)
            return steady, derivatives | {"Cl_alpha": 0.5, "CN_beta": 0.0, "CN_tail_pitch": 3.0, "CY_tail_pitch": 0.0}

        self.write('[cuts]\nx = [0.5]\nfins = {"fin 1" = [0.5], none = [0.1]}\n[[runs]]\nmach = [1.5, 2]\nalpha = 2\n', HEAD_ALONE)
        runs = read_sweep(self.file).runs
        finish(runs, coupled)
        for run in runs:
            write_surface(run.folder / "surface.vtkhdf")
        self.sweep("report")
        text = (self.folder / "runs" / "report.html").read_text()
        self.assertIn("Zero within their ± in every run: CN_beta.", text)
        read = lambda name: list(csv.DictReader((self.folder / "runs" / "report" / name).read_text().splitlines()[1:]))
        self.assertEqual([row["Cl_alpha"] for row in read("cross.csv")], ["0.5", "0.5"])
        controls = [row for row in read("by_controls.csv") if row["control"] == "tail_pitch"]
        self.assertEqual([(row["Mach"], row["CN"]) for row in controls], [("1.5", "3.0"), ("2.0", "3.0")])
        part = text[text.index("Derivatives by deflections") :]
        self.assertIn("<td>3 ± 0.03</td>", part)
        # Pictures of the surface, and where it is cut.
        self.assertIn("2 of these flows have no patch none", text)
        lines = (self.folder / "runs/report/pressure_cuts.csv").read_text().splitlines()
        self.assertEqual({row["cut"] for row in csv.DictReader(lines[2:])}, {"x = 0.5", "fin 1 = 0.5"})
        for name in ("cut1_cp.png", "cut2_cp_alpha.png", f"pressure_{runs[0].name}.png"):
            self.assertTrue((self.folder / "runs/report" / name).exists(), name)
        self.assertNotIn("<th>CY</th>", part[: part.index("</table>")])

    def refers_to_nothing_outside(self, text: str) -> None:
        references = References()
        references.feed(text)
        self.assertEqual(references.outside, [])
        self.assertEqual(references.open, [])
        self.assertNotRegex(re.sub(r"data:[^\"]*", "", text), r"https?:|url\(|@import|<script")
        self.assertIn("data:image/svg+xml;base64,", text)

    def test_basic_finner_stands_beside_the_paper(self) -> None:
        text = self.report(str(SCRIPTS.parent / "cases" / "basic_finner" / "derivatives.toml"))
        self.assertIn("Beside the paper", text)
        with open(self.folder / "runs" / "report" / "table1_static.csv") as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        self.assertEqual(float(rows[0]["paper, field velocity"]), -41.0254)
        here, error = float(rows[0]["here, 5.5 d"]), float(rows[0]["5.5 d / field, %"])
        self.assertAlmostEqual(error, 100 * (here / -41.0254 - 1))
        self.moved_by_the_program(rows)

    def moved_by_the_program(self, rows: list[dict[str, str]]) -> None:
        """The stub moves Cm_alpha, -60 / Mach about 5.5 d, by 10 a diameter: least squares on the relative misfit to the paper's
        static values, by hand. Each centre is asked for once, for all runs together."""
        wanted = [float(row["paper, field velocity"]) for row in rows]
        slopes = [10 / paper for paper in wanted]
        misfits = [1 + 60 / float(row["Mach"]) / paper for row, paper in zip(rows, wanted)]
        dx = sum(slope * misfit for slope, misfit in zip(slopes, misfits)) / sum(slope**2 for slope in slopes)
        for row in rows:
            self.assertAlmostEqual(float(row[f"here, {5.5 + dx:.2f} d"]), -60 / float(row["Mach"]) + 10 * dx)
        calls = (self.folder / "runs" / "derive.txt").read_text().splitlines()
        self.assertEqual({call.split()[0] for call in calls}, {"5"})
        centers = [call.split()[1] for call in calls]
        self.assertEqual(len(centers), len(set(centers)), calls)
        self.assertLessEqual({"None", "5.5", "6.1"}, set(centers))

    def test_program_that_cannot_move(self) -> None:
        self.write("[[runs]]\nmach = 2\n")
        self.sweep("run", "--no-report")
        program = self.folder / "old"
        program.write_text("#!/bin/sh\necho 'alphadot: error: no such option' >&2; exit 2\n")
        program.chmod(0o755)
        self.assertIn("no such option", self.sweep("report", "--program", program, code=1))

    def test_nothing_done(self) -> None:
        self.write("[[runs]]\nmach = 2\n")
        self.assertIn("nothing to report", self.sweep("report", code=1))


if __name__ == "__main__":
    unittest.main()
