#!/usr/bin/python3
"""A thin section that flies into gusts, beside exact linear theory of the flat plate (scripts/exact/plate.py).

Faces ahead of the middle bear a share more by Busemann's second-order theory, those behind it less (cases/diamond/README.md): a moment
about the nose loses half of that, 0.55 %.
"""

from __future__ import annotations

import cmath
import csv
import math
import tempfile
import unittest
from pathlib import Path

from exact_case import ExactCase, run

from exact.plate import sharp_gust  # exact_case says where it is

VELOCITY = math.radians(0.1)  # over V
SECTION = {"reference.area": 0.18}  # of the tiny mesh
STEP = 0.05  # t*, in which the front comes on by a fortieth of the chord


def history(folder: Path) -> list[dict[str, float]]:
    with open(folder / "history.csv") as file:
        return [{name: float(value) for name, value in row.items()} for row in csv.DictReader(line for line in file if line[0] != "#")]


class Gust(ExactCase):
    def histories(self, case: str, mesh: str, settings: dict[str, object]) -> list[dict[str, float]]:
        with tempfile.TemporaryDirectory() as folder:
            run(Path(folder), "run", case, mesh, {"motion.kind": "none", **settings})
            return history(Path(folder))

    def test_sharp_edge(self) -> None:
        """Within 2 % of the load in the gust."""
        for mach in (1.58, 2.0, 2.5):
            steps = math.ceil(2 / (1 - 1 / mach) / STEP) + 2  # until the last wave from the edge has passed
            settings = {"freestream.mach": mach, "unsteady.duration": STEP * steps, "unsteady.steps": steps}
            rows = self.histories("diamond/step.toml", "thin_tiny.msh", {
                **SECTION, **settings, "gust.kind": "sharp", "gust.velocity": VELOCITY,
            })  # fmt: skip
            self.assertEqual(len(rows), steps + 1)
            whole = 4 / math.sqrt(mach**2 - 1)
            for row in rows:
                force, moment = sharp_gust(mach, row["t_star"] / 2)
                self.assert_close(f"CN at Mach {mach}, t* = {row['t_star']}", row["total/CN"] / VELOCITY, force, 0.02, of=whole)
                moment *= 1 - 0.0055
                self.assert_close(f"Cm at Mach {mach}, t* = {row['t_star']}", row["total/Cm"] / VELOCITY, moment, 0.02, of=whole / 2)
            self.assert_close(f"CN in the gust at Mach {mach}", rows[-1]["total/CN"] / VELOCITY, whole, 0.005)

    def test_great_length(self) -> None:
        """A harmonic gust of great length is the plunge: on the cone, of length 1, to what its phase changes along it, k / 2 of a load."""
        k, steps = 0.002, 24
        plunge = {
            "motion.kind": "plunge", "motion.amplitude": 0.1, "motion.reduced_frequency": k, "unsteady.cycles": 1.5,
            "unsteady.steps_per_cycle": steps,
        }  # fmt: skip
        gust = {
            "gust.kind": "harmonic", "gust.velocity": math.tan(math.radians(0.1)), "gust.length": math.pi / k,
            "unsteady.duration": 1.5 * 2 * math.pi / k, "unsteady.steps": 3 * steps // 2,
        }  # fmt: skip
        by_plunge = self.histories("sharp_cone/derivatives.toml", "cone_tiny.msh", plunge)
        by_gust = self.histories("sharp_cone/derivatives.toml", "cone_tiny.msh", gust)[1:]
        self.assertEqual(len(by_plunge), len(by_gust))
        size = max(abs(row["total/CN"]) for row in by_plunge)
        for load in ("total/CN", "total/Cm"):
            for a, b in zip(by_plunge, by_gust, strict=True):
                self.assert_close(f"{load} at t* = {a['t_star']}", b[load], a[load], 2 * k, of=size)

    def test_in_time_and_by_frequency(self) -> None:
        """A harmonic gust at k = 0.5 on the cone: histories of 24 and 48 steps a cycle, extrapolated, beside the frequency response."""
        k, cycles, velocity = 0.5, 2, 0.001
        case = "sharp_cone/derivatives.toml"
        with tempfile.TemporaryDirectory() as folder:
            result = run(Path(folder), "frequency", case, "cone_tiny.msh", {}, options=["--k", str(k), "--gusts"])
        linear = {name: entry["value"] for name, entry in result["derivatives"].items()}
        amplitudes = []
        for steps in (24, 48):
            rows = self.histories(case, "cone_tiny.msh", {
                "gust.kind": "harmonic", "gust.velocity": velocity, "gust.length": math.pi / k,
                "gust.front": result["reference"]["moment_center"][0], "unsteady.duration": cycles * 2 * math.pi / k,
                "unsteady.steps": cycles * steps, "unsteady.inner_tolerance": 1e-4,
            })[-steps:]  # fmt: skip
            amplitudes.append({
                load: sum(row[load] * cmath.exp(-1j * k * row["t_star"]) for row in rows) * 2j / steps / velocity
                for load in ("total/CN", "total/Cm")
            })  # fmt: skip
        for name in ("CN", "Cm"):
            coarse, fine = (amplitude[f"total/{name}"] for amplitude in amplitudes)
            load = (4 * fine - coarse) / 3
            expected = complex(linear[f"{name}_gust, k = {k:g}"], k * linear[f"{name}_gustdot, k = {k:g}"])
            self.assert_close(name, abs(load), abs(expected), 0.002)
            self.assertLess(abs(math.degrees(cmath.phase(load / expected))), 0.2, name)

    def test_body_that_is_carried_along(self) -> None:
        """A cone of mass m over rho l^3, free in heave, takes up the gust's velocity: w' = c CN_alpha (1 - w) - c CN_alphadot w' over t*,
        c = S / (4 m), with the derivatives of linear solves."""
        with tempfile.TemporaryDirectory() as folder:
            linear = run(Path(folder), "derivatives", "sharp_cone/derivatives.toml", "cone_tiny.msh", {})["derivatives"]
        mass, velocity = 1.0, 0.002
        share = 0.0976759097 / (4 * mass)
        rate = share * linear["CN_alpha"]["value"] / (1 + share * linear["CN_alphadot"]["value"])
        rows = self.histories("sharp_cone/derivatives.toml", "cone_tiny.msh", {
            "motion.kind": "free", "body.free": '["heave"]', "body.mass": mass, "gust.kind": "sharp", "gust.velocity": velocity,
            "unsteady.duration": 60, "unsteady.steps": 60,
        })  # fmt: skip
        # Over the reference length and 2 V / l: twice the velocity over V.
        times, ways = [row["t_star"] for row in rows], [row["z"] for row in rows]
        left = [1 - 2 * (b - a) / (t - s) / velocity for a, b, s, t in zip(ways, ways[1:], times, times[1:], strict=False)]
        self.assert_close("rate", math.log(left[10] / left[50]) / (times[50] - times[10]), rate, 0.01)
        self.assertLess(left[-1], 0.1)


if __name__ == "__main__":
    unittest.main()
