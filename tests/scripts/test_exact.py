#!/usr/bin/python3
"""scripts/exact beside the exact values that the cases keep (cases/*/reference), closed forms, and limits."""

from __future__ import annotations

import csv
import math
import sys
import unittest
from dataclasses import replace
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
from exact import Longitudinal, NoExactFlow, cone, diamond, shock, wedge, wing

NAMES = list(Longitudinal.__dataclass_fields__)


def rows(path: str) -> list[dict[str, str]]:
    with open(ROOT / "cases" / path) as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


class Exact(unittest.TestCase):
    def assert_same(self, found: Longitudinal, known: dict[str, float], share: float) -> None:
        for name in NAMES:
            with self.subTest(name):
                self.assertAlmostEqual(getattr(found, name), known[name], delta=share * abs(known[name]))

    def assert_row(self, found: Longitudinal, row: dict[str, str]) -> None:
        """To the eight digits after the point that the files have, and what fourth order leaves."""
        for name in NAMES:
            with self.subTest(name):
                self.assertAlmostEqual(getattr(found, name), float(row[name]), delta=2e-8 + 2e-8 * abs(float(row[name])))


class Cone(Exact):
    def test_steady_flow(self) -> None:
        for row in rows("sharp_cone/reference/exact_cone_steady.csv"):
            flow = cone.steady(float(row["cone_half_angle_deg"]), float(row["Mach"]))
            self.assertAlmostEqual(flow.shock_angle, float(row["shock_angle_deg"]), delta=1e-7)
            self.assertAlmostEqual(flow.surface_cp, float(row["Cp_surface"]), delta=5e-8)
            self.assertAlmostEqual(1.4 * flow.pressure[-1], float(row["p_behind_shock_over_pinf"]), delta=2e-8)

    def test_derivatives(self) -> None:
        for row in rows("sharp_cone/reference/exact_cone_derivatives.csv"):
            angle = float(row["half_angle_deg"])
            found = cone.derivatives(angle, float(row["Mach"])).about(round(3 * float(row["x_ref_over_l"])) / 3)
            if row["ref_length"] == "d":
                found = found.per(2.0 * math.tan(math.radians(angle)))
            self.assert_row(found, row)
        self.assertAlmostEqual(cone.response(10.0, 2.5).shock_by_alpha, float(row["dshock_dalpha"]), delta=1e-6)

    def test_slender_body(self) -> None:
        """M. M. Munk, NACA Report 184, and H. J. Allen: 2 by alpha, 4 by q and 4/3 (of the volume) by alphadot about the apex."""
        slender = {"CN_alpha": 2.0, "Cm_alpha": -4 / 3, "CN_q": 4.0, "Cm_q": -3.0, "CN_alphadot": 4 / 3, "Cm_alphadot": -1.0}
        errors = []
        for angle in (4.0, 2.0):
            found = cone.derivatives(angle, 1.5).as_dict()
            errors.append(max(abs(found[name] / slender[name] - 1.0) for name in NAMES))
        self.assertLess(errors[1], 0.075)  # of the order of the angle squared times its logarithm
        self.assertLess(errors[1], 0.6 * errors[0])

    def test_detached(self) -> None:
        for angle, mach in ((50.0, 1.5), (10.0, 0.9), (0.0, 2.0)):
            with self.assertRaises(NoExactFlow):
                cone.derivatives(angle, mach)


class Sections(Exact):
    def test_wedge(self) -> None:
        for row in rows("wedge/reference/exact_wedge_derivatives.csv"):
            angle, mach = float(row["half_angle_deg"]), float(row["Mach"])
            self.assert_row(wedge.derivatives(angle, mach).about(float(row["axis_x_over_c"])), row)
            sigma = shock.oblique_angle(math.radians(angle), mach)
            self.assertAlmostEqual(math.degrees(sigma), float(row["shock_angle_deg"]), delta=1e-8)

    def test_diamond_slopes(self) -> None:
        """CN and Cm of shock-expansion theory at 0.5, 1 and 1.5 degrees: odd in alpha, so that three give the slope to alpha^6."""
        table = {float(row["alpha_deg"]): row for row in rows("diamond/reference/exact_diamond.csv")}
        found = diamond.derivatives(5.0, 2.0)
        step = math.radians(0.5)
        for column, name in (("CN", "CN_alpha"), ("Cm_LE", "Cm_alpha")):
            one, two, three = (float(table[0.5 * i][column]) / step for i in (1, 2, 3))
            self.assertAlmostEqual(getattr(found, name), 1.5 * one - 0.3 * two + three / 30.0, delta=1e-6)

    def test_no_thickness(self) -> None:
        """C. E. Brown, NACA Report 839, W. H. Dorrance, J. Aeronaut. Sci. 18, 1951: the plate at Mach 2."""
        b = math.sqrt(3.0)
        plate = {"CN_alpha": 4 / b, "Cm_alpha": -2 / b, "CN_q": 4 / b, "Cm_q": -8 / 3 / b, "CN_alphadot": -4 / b**3}
        plate["Cm_alphadot"] = 8 / 3 / b**3
        self.assert_same(wing.plate(2.0), plate, 1e-14)
        for section in (wedge, diamond):
            self.assert_same(section.derivatives(1e-4, 2.0), plate, 1e-5)
        # Busemann's second order: twice the half-angle times C2 / C1 (C2 = 1.4667 at Mach 2) off Cm about the leading edge.
        c1, c2 = 2 / b, (1.4 * 16 + (2 - 4) ** 2) / (2 * 9)
        thin = diamond.derivatives(0.1, 2.0)
        lost = 1.0 - thin.Cm_alpha / plate["Cm_alpha"]
        self.assertAlmostEqual(lost / math.radians(0.1), c2 / c1, delta=0.01)

    def test_no_exact_flow(self) -> None:
        for section, angle, mach in ((wedge, 20.0, 1.5), (wedge, 5.0, 0.8), (diamond, 20.0, 1.5)):
            with self.assertRaises(NoExactFlow):
                section.derivatives(angle, mach)


class Wings(Exact):
    def test_delta(self) -> None:
        b = math.sqrt(3.0)
        known = {"CN_alpha": 4 / b, "Cm_alpha": -8 / 3 / b, "CN_q": 16 / 3 / b, "Cm_q": -4 / b, "CN_alphadot": -8 / 3 / b**3}
        self.assert_same(wing.delta(2.0, 45.0), known | {"Cm_alphadot": 2 / b**3}, 1e-14)
        with self.assertRaises(NoExactFlow):
            wing.delta(1.3, 45.0)

    def test_rectangular(self) -> None:
        """CN_alpha and Cm_alpha of NACA Report 925, and the rest by quadrature of the load itself over the tip's cone."""
        mach, aspect = 1.8, 2.0
        b = math.sqrt(mach**2 - 1.0)
        found = wing.rectangular(mach, aspect)
        self.assertAlmostEqual(found.CN_alpha, 4 / b * (1 - 1 / (2 * aspect * b)), delta=1e-14)
        self.assertAlmostEqual(found.Cm_alpha, -2 / b * (1 - 2 / (3 * aspect * b)), delta=1e-14)
        n = 400  # midpoints of x, and of y over the root's part of the tip's cone, squared: the load has a root there
        total = dict.fromkeys(("q", "alphadot"), 0.0)
        for i in range(n):
            x = (i + 0.5) / n
            slope_sum = aspect / b  # of chi_1x over the span, without tips
            for k in range(n):
                s = ((k + 0.5) / n) ** 2
                slope_sum -= 2 / b * (1 - 2 / math.pi * math.asin(math.sqrt(s))) * (x / b) * 2 * (k + 0.5) / n / n
            total["q"] += slope_sum * (1 - x) / n  # chi_2x = chi_1 = the integral of chi_1x: order of integration changed
            by_rate = mach**2 * ((1 - x) - x) * slope_sum - (1 - x) * slope_sum
            total["alphadot"] += by_rate / (b * b) / n
        self.assertAlmostEqual(found.CN_q, 8 * total["q"] / aspect, delta=1e-4)
        self.assertAlmostEqual(found.CN_alphadot, 8 * total["alphadot"] / aspect, delta=1e-4)
        with self.assertRaises(NoExactFlow):
            wing.rectangular(1.1, 1.0)


class Centre(Exact):
    def test_there_and_back(self) -> None:
        start = cone.derivatives(10.0, 2.5)
        self.assert_same(start.about(0.7).about(-0.7), start.as_dict(), 1e-12)
        self.assert_same(start.per(0.35).per(1 / 0.35), start.as_dict(), 1e-12)
        # A defect of one part in a million is seen by the comparisons above.
        row = rows("wedge/reference/exact_wedge_derivatives.csv")[0]
        wrong = replace(wedge.derivatives(5.0, 2.0), Cm_q=-1.86061113 * (1 + 1e-6))
        self.assertGreater(abs(wrong.Cm_q - float(row["Cm_q"])), 2e-8 + 2e-8 * abs(wrong.Cm_q))


if __name__ == "__main__":
    unittest.main()
