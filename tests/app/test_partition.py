#!/usr/bin/python3
"""The verb partition: a mesh prepared once gives the same derivatives on any number of ranks, and bad input one clear error."""

from __future__ import annotations

import json
import tempfile
import unittest
from pathlib import Path

from program import CASE, Outcome, box, gmsh_text, run, write_case

CUBES = 4  # along each edge of the box
CELLS = 8 * 6 * CUBES**3  # once refined
PREPARED = CASE.replace("box.msh", "box.h5")


class Partition(unittest.TestCase):
    folder: Path

    @classmethod
    def setUpClass(cls) -> None:
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = Path(temporary.name)
        write_case(cls.folder, PREPARED, gmsh_text(*box(CUBES)))

    def prepare(self, *arguments: str, ranks: int = 1) -> None:
        outcome = run(self.folder, "partition", *arguments, "--quiet", ranks=ranks)
        self.assertEqual((outcome.codes, outcome.err), ([0] * ranks, ""))

    def derivatives(self, mesh: str, ranks: int) -> dict[str, float]:
        settings = (f"mesh.file={mesh}", "derivatives.orders=9", "output.flow=false", "output.surface=false")
        overrides = [part for setting in settings for part in ("--set", setting)]
        outcome = run(self.folder, "derivatives", "case.toml", "--out", "run", "--overwrite", "--quiet", *overrides, ranks=ranks)
        self.assertEqual(outcome.codes, [0] * ranks, outcome.err)
        result = json.loads((self.folder / "run" / "result.json").read_text())
        self.assertEqual(result["mesh"]["cells"], CELLS)
        self.assertGreater(result["performance"]["reading_bytes_per_cell"], 0)
        return {name: entry["value"] for name, entry in result["derivatives"].items()}

    def test_same_derivatives_on_any_number_of_ranks(self) -> None:
        self.prepare("box.msh", "-n", "4", "-o", "four.h5", "--refine", "1", ranks=2)
        alone = self.derivatives("four.h5", 1)
        scale = max(abs(value) for value in alone.values())
        for ranks in (2, 7, 16):
            together = self.derivatives("four.h5", ranks)
            self.assertEqual(together.keys(), alone.keys())
            for name, value in alone.items():
                with self.subTest(ranks=ranks, name=name):  # by symmetry some are zero but for round-off
                    self.assertAlmostEqual(together[name], value, delta=1e-6 * abs(value) + 1e-10 * scale)

    def test_either_library_gives_the_same_derivatives(self) -> None:
        self.prepare("box.msh", "-n", "2", "-o", "metis.h5", "--refine", "1")
        self.prepare("metis.h5", "-n", "3", "-o", "ptscotch.h5", "--method", "ptscotch", ranks=2)
        together = self.derivatives("ptscotch.h5", 3)
        for name, value in self.derivatives("metis.h5", 2).items():
            self.assertAlmostEqual(together[name], value, delta=1e-6 * max(1, abs(value)))

    def test_info(self) -> None:
        self.prepare("box.msh", "-n", "2")
        outcome = run(self.folder, "info", "box.h5")
        self.assertIn(f"{CELLS // 8} tetrahedra", outcome.out)
        self.assertIn("2 pieces", outcome.out)
        self.assertIn("wall", outcome.out)

    def assert_refused(self, outcome: Outcome, *says: str) -> None:
        self.assertEqual(outcome.codes, [1] * len(outcome.codes), outcome.err)
        self.assertEqual(len(outcome.errors), 1, outcome.err)
        for part in says:
            self.assertIn(part, outcome.errors[0])
        self.assertNotIn("internal error", outcome.err)

    def test_refuses_what_cannot_be(self) -> None:
        self.assert_refused(run(self.folder, "partition", "none.msh", "-n", "2", ranks=2), "none.msh")
        self.assert_refused(run(self.folder, "partition", "box.msh", "-n", "1000", ranks=2), "box.msh", "384 cells")
        same = run(self.folder, "partition", "box.msh", "-n", "2", "-o", "box.msh", ranks=2)
        self.assert_refused(same, "box.msh", "replace the mesh")
        (self.folder / "other.h5").write_text("mine")
        other = run(self.folder, "partition", "box.msh", "-n", "2", "-o", "other.h5", ranks=2)
        self.assert_refused(other, "other.h5: this file is no prepared mesh")
        nowhere = run(self.folder, "partition", "box.msh", "-n", "2", "-o", "none/box.h5", ranks=2)
        self.assert_refused(nowhere, "none/box.h5")
        self.assertEqual(run(self.folder, "partition", "box.msh", "-n", "0").codes, [2])

    def test_damage_is_noticed(self) -> None:
        self.prepare("box.msh", "-n", "2", "-o", "bad.h5")
        whole = (self.folder / "bad.h5").read_bytes()
        bad = bytearray(whole)
        bad[len(bad) // 2] ^= 1
        for content in (bytes(bad), whole[: len(whole) // 2]):
            (self.folder / "bad.h5").write_bytes(content)
            self.assert_refused(run(self.folder, "check", "case.toml", "--set", "mesh.file=bad.h5", ranks=2), "bad.h5")

    def test_another_hdf5_file_is_no_mesh(self) -> None:
        self.prepare("box.msh", "-n", "1", "-o", "whole.h5")
        run(self.folder, "run", "case.toml", "--set", "mesh.file=whole.h5", "--out", "run", "--quiet")
        self.assert_refused(run(self.folder, "partition", "box.msh", "-n", "2", "-o", "run/flow.vtkhdf"), "is no prepared mesh")
        picture = run(self.folder, "check", "case.toml", "--set", "mesh.file=run/flow.vtkhdf", ranks=2)
        self.assert_refused(picture, "flow.vtkhdf", "a picture of a flow or a checkpoint, not a mesh")


if __name__ == "__main__":
    unittest.main()
