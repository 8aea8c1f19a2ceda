#!/usr/bin/python3
"""A run that was stopped goes on as if it had not: the same bits on the same ranks, the same derivatives on others."""

from __future__ import annotations

import shutil
import subprocess
import unittest
from pathlib import Path

from runs import CaseInFolder, STEPS, checkpoints, derivatives, differences, make_case, result, run, settings

SHORT = dict(unsteady_duration=4, unsteady_steps=12)  # the least that derivatives can be taken from
INDICIAL = settings(motion_kind="step_alpha", **SHORT)
ROTATION = dict(motion_kind="step_q", motion_amplitude=0.01, **SHORT)


class Restart(CaseInFolder):
    def run_ok(self, out: Path, *arguments: object, code: int = 0, ranks: int = 1) -> subprocess.CompletedProcess[str]:
        done = run(self.folder, out, *arguments, ranks=ranks)
        self.assertEqual(done.returncode, code, done.stderr)
        return done

    def run_until_stopped_everywhere(self, *arguments: object, ranks: int = 1) -> int:
        """Stops the run wherever it can be stopped; returns how often that was."""
        self.part.mkdir()
        for stops in range(100):
            (self.part / "stop").touch()
            done = run(self.folder, self.part, "--restart", *arguments, ranks=ranks)
            if done.returncode == 0:
                return stops
            self.assertEqual(done.returncode, 3, done.stderr)
            self.assertEqual(result(self.part)["status"], "interrupted")
            self.assertFalse((self.part / "stop").exists())
        raise AssertionError("the run never ends")

    def test_stopped_at_every_step(self) -> None:
        for ranks, arguments in (
            (1, []),
            (1, [*INDICIAL, *settings(space_freeze_orders=2)]),
            (1, [*INDICIAL, *settings(steady_scheme="lu_sgs")]),
            (1, settings(**ROTATION, motion_treatment="rigid_grid")),
            (1, settings(**ROTATION, motion_treatment="deforming_grid")),
            (1, INDICIAL),
            (2, INDICIAL),
        ):
            with self.subTest(ranks=ranks, arguments=arguments):
                for out in (self.full, self.part):
                    shutil.rmtree(out, ignore_errors=True)
                self.run_ok(self.full, *arguments, ranks=ranks)
                stops = self.run_until_stopped_everywhere(*arguments, ranks=ranks)
                self.assertGreaterEqual(stops, 5)
                self.assertEqual(differences(self.full, self.part), [])

    def test_other_numbers_of_ranks(self) -> None:
        tight = settings(unsteady_inner_tolerance=1e-8, unsteady_max_inner=400, steady_orders=11)
        longer = settings(unsteady_cycles=2)
        self.run_ok(self.full, *tight, *longer)
        expected = derivatives(self.full)
        for first, then in ((1, 2), (2, 3), (4, 1)):
            with self.subTest(first=first, then=then):
                shutil.rmtree(self.part, ignore_errors=True)
                self.run_ok(self.part, *tight, ranks=first)
                self.run_ok(self.part, *tight, *longer, "--restart", ranks=then)
                for name, value in derivatives(self.part).items():
                    self.assertAlmostEqual(value, expected[name], delta=1e-6 * abs(expected[name]), msg=name)

    def test_a_finished_run_is_extended(self) -> None:
        longer = settings(unsteady_cycles=2.5)
        self.run_ok(self.full, *longer)
        self.run_ok(self.part)
        self.run_ok(self.part, "--restart", *longer)
        self.assertEqual(differences(self.full, self.part), [])
        self.assertGreater(result(self.part)["performance"]["restart_wall_s"], 0)

    def test_a_finished_run_stays_finished(self) -> None:
        self.run_ok(self.full)
        shutil.copytree(self.full, self.part)
        self.run_ok(self.part, "--restart")
        self.assertEqual(differences(self.full, self.part), [])

    def test_a_steady_run_goes_on_to_more_decades_and_to_a_motion(self) -> None:
        self.run_ok(self.part, *settings(motion_kind="none", steady_orders=4))
        steady = self.run_ok(self.part, "--restart", *settings(motion_kind="none"))
        self.assertNotIn("e-00", steady.stderr)
        self.assertEqual(result(self.part)["status"], "converged")
        self.run_ok(self.part, "--restart")
        self.assertEqual(result(self.part)["status"], "completed")

    def test_without_a_checkpoint_it_begins_at_the_beginning(self) -> None:
        done = self.run_ok(self.part, "--restart")
        self.assertIn("starts from the beginning", done.stderr)

    def test_a_named_file(self) -> None:
        self.run_ok(self.full, *settings(checkpoint_steps=5, checkpoint_keep=10))
        files = checkpoints(self.full)
        self.assertEqual(len(files), 2 + STEPS // 5)  # the steady state and the end always
        done = self.run_ok(self.part, "--restart", files[1])
        self.assertIn(f"goes on from {files[1]}", done.stderr)
        self.assertEqual((self.full / "history.csv").read_bytes(), (self.part / "history.csv").read_bytes())

    def refused(self, *says: str, arguments: list[object]) -> None:
        done = run(self.folder, self.part, "--restart", *arguments)
        self.assertEqual(done.returncode, 1, done.stderr)
        for part in says:
            self.assertIn(part, done.stderr)
        self.assertNotIn("internal error", done.stderr)

    def test_contradictions_are_refused_by_key(self) -> None:
        self.run_ok(self.part)
        for arguments, says in (
            (settings(freestream_mach=3), ("freestream.mach is 3", "made with 2")),
            (settings(unsteady_steps_per_cycle=17), ("unsteady.steps_per_cycle",)),
            (settings(motion_kind="pitch", motion_amplitude=2), ("motion.kind", "motion.amplitude")),
        ):
            self.refused("the folder holds other results", arguments=arguments)
            self.refused(*says, arguments=[*arguments, "--overwrite"])

    def test_what_made_the_steps_stays(self) -> None:
        """A motion that has begun goes on under the tolerances of its steps and of the flow before them."""
        self.run_ok(self.part)
        before = (self.part / "result.json").read_bytes()
        self.refused("unsteady.inner_tolerance is 1e-06", "made with 0.001", arguments=settings(unsteady_inner_tolerance=1e-6))
        self.refused("unsteady.max_inner is 400", arguments=settings(unsteady_max_inner=400))
        self.refused("steady.orders is 12", arguments=settings(steady_orders=12))
        self.assertEqual((self.part / "result.json").read_bytes(), before)
        self.run_ok(self.part, "--restart", *settings(unsteady_cycles=2))
        self.refused("unsteady.cycles", "step 32", "has 24 steps", arguments=[])

    def test_another_table_is_refused(self) -> None:
        table = self.folder / "motion.txt"
        table.write_text("t_star alpha\n0 1\n1 1.5\n2 2\n")
        arguments = settings(motion_kind="table", motion_table_file="motion.txt", unsteady_duration=2, unsteady_steps=8)
        self.run_ok(self.part, *arguments)
        moved = self.folder / "moved.txt"
        moved.write_bytes(table.read_bytes())
        self.run_ok(self.part, "--restart", *arguments, *settings(motion_table_file="moved.txt"))
        table.write_text("t_star alpha\n0 1\n1 1.5\n2 3\n")
        self.refused("motion.txt", "the table has other content", arguments=[*arguments, "--overwrite"])
        self.refused("the table of its motion has other content", arguments=arguments)

    def test_another_mesh_is_refused(self) -> None:
        self.run_ok(self.part)
        make_case(self.folder, cells=2)
        self.refused("it is of another mesh", arguments=[])
        self.refused("belongs to another mesh", arguments=["--overwrite"])

    def test_damaged_checkpoints_are_named_and_passed_over(self) -> None:
        arguments = settings(checkpoint_steps=1, checkpoint_keep=5)
        self.run_ok(self.full, *arguments)
        shutil.copytree(self.full, self.part)
        *_, third, second, first = checkpoints(self.part)
        first.write_bytes(first.read_bytes()[:1000])
        content = bytearray(second.read_bytes())
        content[len(content) // 2] ^= 1
        second.write_bytes(content)
        done = self.run_ok(self.part, "--restart", *arguments)
        for part in (f"{first.name}: is cut short", f"{second.name}: is damaged", f"goes on from {third}"):
            self.assertIn(part, done.stderr)
        self.assertEqual(differences(self.full, self.part), [])

    def test_all_damaged_is_an_error(self) -> None:
        self.run_ok(self.part)
        for file in checkpoints(self.part):
            file.write_bytes(b"")
        self.refused("no checkpoint in the folder can be read", "in another folder", *(file.name for file in checkpoints(self.part)), arguments=[])


if __name__ == "__main__":
    unittest.main()
