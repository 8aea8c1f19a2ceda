#!/usr/bin/python3
"""Meshes that are not what their case says, made by Gmsh's own command from data/*.geo: refused or told of by every verb.

Expectations: what the .geo files say. A cone of length 1 and base radius 0.2 lies on the x axis in a box of 3 x 1 x 2, of which the
half y >= 0 is meshed; its circles have ten sides, so that they reach to 0.2 sin(72 degrees) = 0.190211 along y.
"""

from __future__ import annotations

import json
import math
import re
import tempfile
import unittest
from pathlib import Path
from subprocess import run as call

from program import RANKS, Outcome, run

DATA = Path(__file__).resolve().parent / "data"
CASE = """\
[mesh]
file = "MESH"
[reference]
length = 1.0
area = 0.12566
moment_center = [0.5, 0, 0]
model = "half"
[freestream]
mach = 2.0
[boundary]
body = "wall"
symmetry = "symmetry"
farfield = "farfield"
"""


def set_keys(*settings: str) -> list[str]:
    return [word for setting in settings for word in ("--set", setting)]


class Configurations(unittest.TestCase):
    folder: Path

    @classmethod
    def setUpClass(cls) -> None:
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = Path(temporary.name)
        for name in ("cone.su2", "tool_left.su2", "two.msh", "baffle.msh"):
            cls.make(name, (DATA / Path(name).with_suffix(".geo")).read_text())
        cone = (cls.folder / "cone.su2").read_text()
        cls.case("y_up.su2").with_suffix(".su2").write_text(re.sub(r"(?m)^(\S+) (\S+) (\S+) (\d+)$", cls.turned, cone))

    @classmethod
    def make(cls, mesh: str, geometry: str) -> None:
        """A mesh and the case beside it."""
        source = cls.folder / Path(mesh).with_suffix(".geo")
        source.write_text(geometry)
        call(["gmsh", "-3", source, "-o", cls.folder / mesh], check=True, capture_output=True)
        cls.case(mesh)

    @classmethod
    def case(cls, mesh: str) -> Path:
        path = (cls.folder / mesh).with_suffix(".toml")
        path.write_text(CASE.replace("MESH", mesh))
        return path

    @staticmethod
    def turned(point: re.Match) -> str:
        """By a right angle about the x axis: the plane y = 0 becomes z = 0."""
        x, y, z, number = point.groups()
        return f"{x} {-float(z)!r} {y} {number}"

    def refused(self, name: str, *says: str, settings: tuple[str, ...] = (), errors: int = 1) -> Outcome:
        outcome = run(self.folder, "check", f"{name}.toml", *set_keys(*settings))
        self.assertEqual(outcome.codes, [1] * RANKS, outcome.out)
        self.assertEqual(len(outcome.errors), errors, outcome.err)
        self.assertNotIn("internal error", outcome.err)
        for part in says:
            self.assertIn(part, outcome.err)
        return outcome

    def checked(self, *settings: str) -> str:
        outcome = run(self.folder, "check", "cone.toml", *set_keys(*settings))
        self.assertEqual(outcome.codes, [0] * RANKS, outcome.err)
        return outcome.out

    def warned(self, *says: str, settings: tuple[str, ...] = ()) -> None:
        """The warnings come first, and the first of them has all of `says`."""
        first = self.checked(*settings).splitlines()[0]
        for part in ("warning: ", *says):
            self.assertIn(part, first)

    def test_a_tool_left_in_the_mesh(self) -> None:
        outcome = self.refused("tool_left", "2 regions that share no face", 'inside "body", "symmetry" without a far field',
                               "(0, 0, -0.2) to (1, 0.19021, 0.2)", "BooleanDifference")  # fmt: skip
        cells = sum(int(n) for n in re.findall(r"(\d+) cells from", outcome.err))
        self.assertIn(f"NELEM= {cells}\n", (self.folder / "tool_left.su2").read_text())
        for verb in ("run", "derivatives"):
            started = run(self.folder, verb, "tool_left.toml", "--out", verb)
            self.assertEqual(started.codes, [1] * RANKS)
            self.assertEqual(started.errors, outcome.errors)
            self.assertFalse((self.folder / verb / "result.json").exists())

    def test_a_tool_left_in_a_prepared_mesh(self) -> None:
        done = run(self.folder, "partition", "tool_left.su2", "-n", "5")
        self.assertEqual(done.codes, [0] * RANKS, done.err)
        self.refused("tool_left", "2 regions that share no face", settings=("mesh.file=tool_left.h5",))

    def test_a_body_that_is_meshed_inside(self) -> None:
        outcome = self.refused("two", 'a wall between volume "air" (', 'and volume "solid" (', "(0, 0, -0.1) to (1, 0.2, 0.1)",
                               'leave out of the mesh what is the inside of a body: volume "solid"')  # fmt: skip
        self.assertNotIn("mesh.thin", outcome.err)
        self.assertNotIn("neither a second cell", outcome.err)

    def test_a_body_without_thickness(self) -> None:
        self.refused("baffle", "lies between two cells", "no thickness", "mesh.thin")
        self.refused("baffle", 'mesh.thin names "fin", which the mesh does not have', settings=('mesh.thin=["fin"]',))
        self.refused("baffle", 'mesh.thin names "symmetry", which has nothing inside', settings=('mesh.thin=["body", "symmetry"]',))
        # A rectangle of 1 x 0.5 and its mirror image, both sides of each.
        walls = f"walls: {4 * 1.0 * 0.5 / 0.12566:.5g} reference areas"
        thin = run(self.folder, "check", "baffle.toml", "--set", 'mesh.thin=["body"]')
        self.assertEqual(thin.codes, [0] * RANKS, thin.err)
        self.assertIn("triangles inside the mesh are a wall with two sides", thin.err)
        self.assertIn(walls, thin.out)
        self.assertIn("out of balance by (0, 0, 0)", thin.out)
        prepared = run(self.folder, "partition", "baffle.msh", "--thin", "body", "-n", "3")
        self.assertEqual(prepared.codes, [0] * RANKS, prepared.err)
        for settings in ((), ('mesh.thin=["body"]',)):
            again = run(self.folder, "check", "baffle.toml", *set_keys("mesh.file=baffle.h5", *settings))
            self.assertEqual(again.codes, [0] * RANKS, again.err)
            self.assertIn(walls, again.out)

    def test_a_body_that_is_meshed_inside_is_no_thin_wall(self) -> None:
        self.refused("two", 'and volume "solid" (', settings=('mesh.thin=["body"]',))

    def test_half_mesh_as_a_full_model(self) -> None:
        says = ('"symmetry" in the plane y = 0', 'set reference.model = "half"')
        self.refused("cone", *says, settings=("reference.model=full",))
        missing = CASE.replace("MESH", "cone.su2").replace('model = "half"\n', "")
        (self.folder / "missing.toml").write_text(missing)
        self.refused("missing", *says)
        as_full = "reference.model=full"
        self.refused("cone", 'the body ends in the "jet" "symmetry" in the plane y = 0', "the loads of its other half are missing",
                     settings=(as_full, "boundary.symmetry=jet"))  # fmt: skip
        for kind in ("sting", "farfield"):
            seen = self.checked(as_full, f"boundary.symmetry={kind}")
            self.assertIn(f'the body ends in the "{kind}" "symmetry" in the plane y = 0', seen)
            self.assertIn("the loads of the other half are missing", seen)

    def test_plane_of_symmetry_elsewhere(self) -> None:
        self.refused("y_up", '"symmetry" in the plane z = 0', "turn the mesh about the x axis")

    def test_patch_called_symmetry_that_is_not_plane(self) -> None:
        self.refused("cone", 'symmetry patch "body" is not plane', '"sting"', 'no patch is a "wall"', settings=("boundary.body=symmetry",), errors=2)

    def test_wrong_units(self) -> None:
        self.warned("1000 reference lengths long", "mesh.scale = 1000", settings=("mesh.scale=1000",))
        self.warned("reference.area is", "largest projected area", settings=("reference.area=1e6", "freestream.mach=1.1"))

    def test_blunt_base_of_a_wall(self) -> None:
        # The base is all that the cone shows to the stream.
        self.warned('the wall "body" face aft', '"jet"')
        area, share = map(float, re.search(r"warning: (\S+) reference areas .* aft, (\S+) %", self.checked()).groups())
        self.assertAlmostEqual(area, 5 * math.sin(math.radians(36)) / math.pi, delta=0.001)  # ten sides over the circle
        self.assertAlmostEqual(share, 100, delta=1)
        self.assertNotIn("aft", self.checked("freestream.mach=0.8"))

    def test_far_field_too_near(self) -> None:
        self.warned("0.8 body lengths from the body", "needs 11.5", settings=("freestream.mach=0.5",))

    def test_check_tells_what_matters_first_and_the_whole_case_on_demand(self) -> None:
        short = self.checked()
        self.assertNotIn("[freestream]", short)
        for part in ("body: from (0, -0.19021, -0.2) to (1, 0.19021, 0.2)", "far field: at least 0.8 body lengths away", "degrees"):
            self.assertIn(part, short)
        whole = run(self.folder, "check", "cone.toml", "-v").out
        self.assertTrue(whole.startswith(short))
        self.assertIn("[freestream]", whole)

    def test_result_has_the_facts_in_any_unit(self) -> None:
        found = {}
        for name, scale in (("metres", 1.0), ("millimetres", 1000.0)):
            settings = (f"mesh.scale={scale}", f"reference.length={scale}", f"reference.area={0.12566 * scale**2}",
                        f"reference.moment_center=[{scale / 2}, 0, 0]", "steady.max_iterations=1")  # fmt: skip
            outcome = run(self.folder, "run", "cone.toml", "--out", name, *set_keys(*settings))
            self.assertIn("face aft", outcome.err)
            found[name] = json.loads((self.folder / name / "result.json").read_text())["configuration"]
        metres, millimetres = found.values()
        self.assertEqual(metres["regions"], 1)
        self.assertEqual(len(metres["warnings"]), 1)
        for found_side, side in zip(metres["body_upper"], (1.0, 0.2 * math.sin(math.radians(72)), 0.2)):
            self.assertAlmostEqual(found_side, side, delta=1e-12)
        self.assertEqual(metres.keys(), millimetres.keys())
        for name in metres.keys() - {"warnings"}:
            a, b = ((value if isinstance(value, list) else [value]) for value in (metres[name], millimetres[name]))
            for one, other in zip(a, b):
                self.assertTrue(math.isclose(one, other, rel_tol=1e-9, abs_tol=1e-9), name)


if __name__ == "__main__":
    unittest.main()
