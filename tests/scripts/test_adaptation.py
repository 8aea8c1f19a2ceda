#!/usr/bin/python3
"""Derivatives to a tolerance: intervals of families whose truth is made up, sizes from indicators that are made up, and the loop with
steps that compute nothing. The expected numbers are the ones that the made-up values were made from."""

from __future__ import annotations

import argparse
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))

import adapt
from adaptation.family import Member, family_factors, intervals
from adaptation import loop
from adaptation.loop import Adaptation, Budget, Stream
from adaptation.steps import Cost, Mesh, Solved, StepError
from adaptation.tolerance import Tolerance, ToleranceError, read_tolerance, read_tolerances
from meshing.adapted_sizes import AdaptedSizes, read_errors
from meshing.sector import ALL, STARBOARD
from meshing.sizes import PER_VOLUME
from meshing.tetrahedra import MeshError

NAMES = [f"{load}_{by}" for load in ("CN", "Cm") for by in ("alpha", "q", "alphadot")]


def family(truth: dict[str, float], slope: dict[str, float], power: float, noise: float, random: np.random.Generator) -> list[Member]:
    """Members whose values are truth + slope h^power, and noise h^2 at random by the size of the truth."""
    members = []
    for factor in family_factors():
        count = round(1e5 / factor**3)
        h = (1e6 / count) ** (1.0 / 3.0)
        values = {name: truth[name] + slope[name] * h**power + noise * abs(truth[name]) * h * h * random.normal() for name in truth}
        members.append(Member(factor, count, values, dict.fromkeys(truth, 0.0)))
    return members


class FamilyTest(unittest.TestCase):
    truth = dict(zip(NAMES, (12.0, 90.0, 26.0, -30.0, -390.0, -6.0)))

    def test_second_order_is_extrapolated_exactly(self) -> None:
        slope = {name: 0.1 * value for name, value in self.truth.items()}
        for name, found in intervals(family(self.truth, slope, 2.0, 0.0, np.random.default_rng(1)), 2.0).items():
            self.assertTrue(found.is_extrapolated)
            self.assertAlmostEqual(found.value, self.truth[name], delta=1e-9 * abs(self.truth[name]))
            self.assertAlmostEqual(found.order, 2.0, delta=0.05)  # the coarsest level is a mean of three
            self.assertLess(found.scatter, 1e-9 * abs(self.truth[name]))
            self.assertGreater(found.uncertainty, 0.0)

    def test_scatter_is_measured(self) -> None:
        """Over many families its mean square is that of the noise, at the finest mesh."""
        random = np.random.default_rng(2)
        slope = {name: 0.3 * value for name, value in self.truth.items()}
        squares = []
        for _ in range(200):
            members = family(self.truth, slope, 2.0, 0.02, random)
            h2 = min(member.spacing for member in members) ** 2
            squares += [(found.scatter / (0.02 * abs(self.truth[name]) * h2)) ** 2 for name, found in intervals(members, 2.0).items()]
        self.assertAlmostEqual(float(np.mean(squares)), 1.0, delta=0.1)

    def test_nothing_is_extrapolated_from_scatter(self) -> None:
        """Where only chance tells the levels apart, four of five times it is seen; the finest mesh's value then stands."""
        random, resolved = np.random.default_rng(3), []
        for _ in range(100):
            members = family(self.truth, dict.fromkeys(NAMES, 0.0), 2.0, 0.05, random)
            finest = min(members, key=lambda member: member.spacing)
            for name, found in intervals(members, 2.0).items():
                resolved.append(found.is_extrapolated)
                if not found.is_extrapolated:
                    self.assertEqual(found.value, finest.values[name])
                    self.assertIsNone(found.order)
        self.assertLess(np.mean(resolved), 0.3)

    def test_intervals_hold_the_truth(self) -> None:
        """Errors of the orders 1 to 2 with scatter: what is wrong with the line is in the interval."""
        for power in (1.0, 1.5, 2.0):
            random, inside, entries = np.random.default_rng(4), 0, 0
            for _ in range(200):
                slope = {name: 0.1 * abs(value) * random.normal() for name, value in self.truth.items()}
                for name, found in intervals(family(self.truth, slope, power, 0.01, random), 2.0).items():
                    inside += abs(found.value - self.truth[name]) <= found.uncertainty
                    entries += 1
            self.assertGreater(inside / entries, 0.9, power)

    def test_a_solver_that_has_not_finished_widens_them(self) -> None:
        members = family(self.truth, self.truth, 2.0, 0.0, np.random.default_rng(5))
        rough = [Member(m.factor, m.cells, m.values, dict.fromkeys(NAMES, 7.0)) for m in members]
        for name, found in intervals(rough, 2.0).items():
            self.assertAlmostEqual(found.uncertainty, intervals(members, 2.0)[name].uncertainty + 7.0)


class ToleranceTest(unittest.TestCase):
    def test_reads_what_is_written(self) -> None:
        values = {"Cm_q": -400.0, "CN_alphadot": 26.0, "Cm_alphadot": -6.0}
        for text, expected in (("1%", 4.0), ("0.4", 0.4), ("2%CN_alphadot", 0.52), ("1e-1%", 0.4)):
            self.assertAlmostEqual(read_tolerance(text).half_width("Cm_q", values), expected)
        found = read_tolerances("1%,Cm_alphadot=0.4", ["Cm_q", "Cm_alphadot"])
        self.assertEqual(found, {"Cm_q": Tolerance(0.01, ""), "Cm_alphadot": Tolerance(0.4)})

    def test_says_what_is_wrong(self) -> None:
        goals = ["Cm_q", "Cm_alphadot"]
        for text in ("", "%", "-1", "0", "1 %", "1%%", "1.2.3", "nan", "1%,2%", "Cm_r=1%", "Cm_q=1%", "Cm_q=x,1%"):
            with self.assertRaises(ToleranceError, msg=text):
                read_tolerances(text, goals)


class Plain:
    """Sizes of a description that wants cells of 1 everywhere."""

    def __init__(self, volume: float) -> None:
        self.volume = volume

    def __call__(self, points: np.ndarray) -> np.ndarray:
        return np.ones(len(points))

    def cells(self, sector: object) -> float:
        return PER_VOLUME * self.volume

    def without_caps(self) -> Plain:
        return self


def write_indicator(path: Path, indicator, low: float = 0.0) -> np.ndarray:
    """A file of small tetrahedra about random points in a box of 2 x 2 x 2 from `low` on; `indicator` of centres (n, 3) and volumes."""
    random = np.random.default_rng(6)
    centres = random.uniform(0.0, 2.0, (20_000, 3)) + [0.0, low, 0.0]
    edges = 0.05 * random.uniform(0.7, 1.3, len(centres))
    corners = centres[:, None] + edges[:, None, None] * np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]) / 4.0
    volumes = np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1])) / 6.0
    with h5py.File(path, "w") as file:
        file["VTKHDF/Points"] = corners.reshape(-1, 3)
        file["VTKHDF/Connectivity"] = np.arange(4 * len(centres))
        file["VTKHDF/CellData/indicator"] = indicator(centres, volumes)
    return volumes


class SizesTest(unittest.TestCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.file = Path(temporary.name) / "indicator.vtkhdf"

    def test_a_density_and_no_mesh(self) -> None:
        """Cells of many sizes whose indicator is e V h^2: sizes go with the power -1/5 of e."""
        density = lambda x: np.exp(1.5 * x[:, 0])
        volumes = write_indicator(self.file, lambda x, v: density(x) * v ** (5.0 / 3.0))
        errors = read_errors(self.file, 1.0, np.zeros(3), ALL)
        self.assertAlmostEqual(errors.volumes.sum(), volumes.sum(), delta=1e-5 * volumes.sum())
        cells = 1000.0 * PER_VOLUME * volumes.sum()
        sizes = AdaptedSizes([errors], Plain(volumes.sum()), ALL, cells)
        x = np.linspace(0.3, 1.7, 8)
        found = sizes(np.column_stack([x, np.ones(8), np.ones(8)]))
        self.assertAlmostEqual(float(np.polyfit(x, np.log(found), 1)[0]), -0.3, delta=0.03)
        self.assertAlmostEqual(1000.0 * sizes.cells(ALL), cells, delta=0.06 * cells)

    def test_mirror_images_are_one(self) -> None:
        """What is on the port side alone counts on the starboard side, for a mesh that is its own mirror image."""
        volumes = write_indicator(self.file, lambda x, v: np.where(np.abs(x[:, 1] + 0.5) < 0.2, 1e4, 1.0) * v ** (5.0 / 3.0), low=-1.0)
        errors = read_errors(self.file, 1.0, np.zeros(3), STARBOARD)
        self.assertAlmostEqual(errors.volumes.sum(), 0.5 * volumes.sum(), delta=1e-5 * volumes.sum())
        sizes = AdaptedSizes([errors], Plain(errors.volumes.sum()), STARBOARD, 1000.0 * PER_VOLUME * errors.volumes.sum())
        near, far = sizes(np.array([[1.0, 0.5, 1.0], [1.0, 0.95, 1.0]]))
        self.assertLess(near, 0.6 * far)

    def test_several_files_give_the_smallest(self) -> None:
        write_indicator(self.file, lambda x, v: np.where(x[:, 0] < 0.5, 1e4, 1.0) * v ** (5.0 / 3.0))
        other = self.file.with_name("other.vtkhdf")
        volumes = write_indicator(other, lambda x, v: np.where(x[:, 0] > 1.5, 1e4, 1.0) * v ** (5.0 / 3.0))
        errors = [read_errors(file, 1.0, np.zeros(3), ALL) for file in (self.file, other)]
        cells = 1000.0 * PER_VOLUME * volumes.sum()
        points = np.random.default_rng(7).uniform(0.0, 2.0, (100, 3))
        both = AdaptedSizes(errors, Plain(volumes.sum()), ALL, cells)
        each = [AdaptedSizes([one], Plain(volumes.sum()), ALL, cells) for one in errors]
        np.testing.assert_allclose(both(points), np.minimum(each[0](points), each[1](points)), rtol=1e-12)

    def test_says_what_is_wrong(self) -> None:
        for indicator in (lambda x, v: np.zeros(len(v)), lambda x, v: np.full(len(v), np.nan), lambda x, v: v[:5]):
            write_indicator(self.file, indicator)
            with self.assertRaisesRegex(MeshError, "give indicator.vtkhdf"):
                read_errors(self.file, 1.0, np.zeros(3), ALL)
        self.file.write_text("no HDF5")
        with self.assertRaisesRegex(MeshError, "give indicator.vtkhdf"):
            read_errors(self.file, 1.0, np.zeros(3), ALL)


class StubSteps:
    """Steps that compute nothing: Cm_q = -400 (1 + h^2), of meshes that have the cells asked for."""

    def __init__(self, status: str = "converged") -> None:
        self.status, self.calls = status, []

    def mesh(self, folder: Path, cells: int, indicators: list[Path], factor: float | None) -> Mesh:
        self.calls.append((folder.name, cells, [str(path) for path in indicators]))
        self.cells = round(cells / (factor or 1.0) ** 3)
        return Mesh(folder / "case.toml", folder / "mesh.msh", Cost(1.0, 1.0, 1))

    def solve(self, mesh: Mesh, folder: Path, verb: str, settings: list[str], *options: str):
        self.calls.append((verb, *options))
        h2 = (1e6 / self.cells) ** (2.0 / 3.0)
        result = {
            "status": self.status, "message": "it stalled", "configuration": {"body_length": 10.0}, "reference": {"length": 1.0},
            "mesh": {"cells": self.cells}, "derivatives": {"Cm_q": {"value": -400.0 * (1.0 + 0.01 * h2), "uncertainty": 0.0}},
        }  # fmt: skip
        return Solved(folder, result, Cost(1.0, 60.0, 1))


class LoopTest(unittest.TestCase):
    def setUp(self) -> None:
        loop.tell = lambda text: None  # no lines of progress

    def run_to(self, tolerance: float, budget: Budget, steps: StubSteps, goals: tuple[str, ...] = ("Cm_q",), adapts: bool = True):
        tolerances = dict.fromkeys(goals, Tolerance(tolerance, ""))
        return Adaptation(steps, Path("/nowhere"), [Stream("")], tolerances, budget, adapts).run()

    def test_refines_until_the_interval_is_small_enough(self) -> None:
        steps = StubSteps()
        outcome = self.run_to(0.01, Budget(10_000_000), steps)
        self.assertEqual(outcome.status, "converged")
        self.assertGreater(len(outcome.families), 1)
        found = outcome.families[-1].intervals[""]["Cm_q"]
        self.assertLessEqual(found.uncertainty, 0.01 * 400.0)
        self.assertLessEqual(abs(found.value + 400.0), found.uncertainty)
        self.assertGreater(outcome.families[0].intervals[""]["Cm_q"].uncertainty, 0.01 * 400.0)
        # The second family's meshes are made from the indicator on the first one's middle mesh.
        self.assertIn(("adjoint", "--indicator", "Cm_q"), steps.calls)
        self.assertEqual(steps.calls[-2][2], [f"/nowhere/family_{len(outcome.families) - 1}/indicator/indicator.vtkhdf"])

    def test_a_budget_ends_it(self) -> None:
        self.assertEqual(self.run_to(1e-6, Budget(200_000), StubSteps()).status, "out_of_budget")
        outcome = self.run_to(1e-6, Budget(10_000_000, minutes=20.0), StubSteps())
        self.assertEqual((outcome.status, len(outcome.families)), ("out_of_budget", 1))
        self.assertIn("more minutes", outcome.message)

    def test_what_has_not_converged_is_said(self) -> None:
        outcome = self.run_to(0.5, Budget(200_000), StubSteps("not_converged"))
        self.assertEqual(outcome.status, "not_converged")
        self.assertIn("it stalled", outcome.message)

    def test_a_goal_that_no_run_gives(self) -> None:
        with self.assertRaisesRegex(StepError, "Cl_p"):
            self.run_to(0.01, Budget(200_000), StubSteps(), ("Cl_p",))

    def test_without_adaptation_no_indicator(self) -> None:
        steps = StubSteps()
        self.run_to(0.5, Budget(200_000), steps, adapts=False)
        self.assertFalse([call for call in steps.calls if call[0] == "adjoint"])
        self.assertTrue(all(call[2] == [] for call in steps.calls if call[0].startswith("mesh_")))


class WhatAFolderIsFor(unittest.TestCase):
    """An adaptation goes on in a folder only where all that its meshes and runs come from is what it was."""

    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        for name, text in (("case.toml", '[mesh]\nfrom = "missile.toml"\n'), ("missile.toml", '[surface]\nfile = "body.tri"\n'),
                           ("body.tri", "a"), ("Config.xml", "a"), ("rocket.ork", "a")):  # fmt: skip
            (self.folder / name).write_text(text)

    def prepare(self, case: str, overwrite: bool = False) -> None:
        arguments = argparse.Namespace(
            case=self.folder / case, goals=["Cm_q"], mach=None, settings=[], plain=False, overwrite=overwrite
        )  # fmt: skip
        adapt.prepare(self.folder / f"{case}-adapted", arguments, adapt.description_of(arguments.case)[0])

    def test_every_file_counts(self) -> None:
        for case, files in (("case.toml", ("case.toml", "missile.toml", "body.tri", "Config.xml")), ("rocket.ork", ("rocket.ork",))):
            for name in files:
                with self.subTest(case=case, file=name):
                    self.prepare(case, overwrite=True)
                    self.prepare(case)
                    file = self.folder / name
                    before = file.read_text()
                    file.write_text(before + "\n")
                    with self.assertRaisesRegex(StepError, "something else"):
                        self.prepare(case)
                    file.write_text(before)
                    self.prepare(case)


if __name__ == "__main__":
    unittest.main()
