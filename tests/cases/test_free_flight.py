#!/usr/bin/python3
"""A cone that flies freely, beside what its derivatives by linear solves on the same mesh predict; restarts; wrong cases.

In pitch alone J theta'' = S / 8 (Cm_alpha (alpha - 0) + (Cm_q + Cm_alphadot) theta') over t* = 2 V t / l, J the moment of inertia over
rho l^5 and S the area over l^2.
"""

from __future__ import annotations

import csv
import math
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

from exact_case import CASES, MESHES, ROOT, ExactCase, run

K = 0.02  # about


def history(folder: Path) -> list[dict[str, float]]:
    with open(folder / "history.csv") as file:
        return [{name: float(value) for name, value in row.items()} for row in csv.DictReader(line for line in file if line[0] != "#")]


class FreeFlight(ExactCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def check_pitch(self, case: str, mesh: str, about: dict[str, object], area: float, alpha: float) -> dict:
        """Frequency within 0.5 %, damping within 3 %, and half widths that are no wider."""
        linear = run(self.folder / "linear", "derivatives", case, mesh, {**about, "motion.kind": "none"})["derivatives"]
        by_angle = linear["Cm_alpha"]["value"]
        by_rate = linear["Cm_q"]["value"] + linear["Cm_alphadot"]["value"]
        inertia = round(area * abs(by_angle) / (8 * K**2), 6)
        share = area / (8 * inertia)
        damping = -share * by_rate / 2
        k = math.sqrt(-share * by_angle - damping**2)
        duration = round(2 * math.pi * 2 / k, 6)
        free = {
            **about, "freestream.alpha": alpha, "motion.kind": "free", "body.free": '["pitch"]',
            "body.inertia": f"[1, {inertia}, {inertia}]", "unsteady.duration": duration, "unsteady.steps": 72,
        }  # fmt: skip
        result = run(self.folder / "free", "run", case, mesh, free)
        found = result["decay"]
        self.assertEqual(result["status"], "completed")
        self.assert_close("k", found["k"], k, 0.005)
        self.assert_close("damping", found["damping"], damping, 0.03)
        self.assertLess(found["k_uncertainty"], 0.005 * k)
        self.assertLess(found["damping_uncertainty"], 0.03 * abs(damping))
        for name, expected in (("Cm_alpha", by_angle), ("Cm_q_plus_alphadot", by_rate)):
            self.assert_close(name, result["derivatives"][name]["value"], expected, 0.02)
        rows = history(self.folder / "free")
        # The balance of energy, from the loads and the motion that the history tells.
        work = sum(
            (b["theta"] - a["theta"]) * (a["total/Cm"] + b["total/Cm"]) / 2 for a, b in zip(rows, rows[1:], strict=False)
        )
        energy = 4 * inertia / area * rows[-1]["q"] ** 2  # over q S l
        self.assertAlmostEqual(work / energy, 1, delta=1e-9)
        self.assertAlmostEqual(rows[-1]["energy"] / energy, 1, delta=1e-9)
        return found

    def test_damped_cone(self) -> None:
        about = {"reference.moment_center": "[0.5, 0, 0]"}
        found = self.check_pitch("sharp_cone/derivatives.toml", "cone_tiny.msh", about, 0.0976759097, 1)
        self.assertGreater(found["damping"], 0)

    def test_wedge_that_swings_up(self) -> None:
        """A section about its quarter chord at Mach 1.5: theory of sections has negative damping at low supersonic speeds."""
        settings = [f"mesh.file={MESHES / 'wedge_tiny.msh'}", "reference.area=0.18"]
        command = [
            ROOT / "scripts" / "free_pitch.py", CASES / "wedge" / "derivatives.toml", "--mach", "1.5", "--center", "0.25", "--k", str(K),
            "--release", "0.02", "--out", self.folder, "--program", os.environ["ALPHADOT"],
            *(part for setting in settings for part in ("--set", setting)),
        ]  # fmt: skip
        done = subprocess.run(["/usr/bin/python3", "-B", *command], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("Mach", done.stdout)
        with open(self.folder / "free_pitch.csv") as file:
            (row,) = ({name: float(value) for name, value in row.items()} for row in csv.DictReader(file))
        self.assertLess(row["damping"], 0)
        self.assert_close("k", row["k"], row["k_predicted"], 0.005)
        self.assert_close("damping", row["damping"], row["damping_predicted"], 0.03)
        self.assertLess(row["damping_half_width"], 0.03 * abs(row["damping"]))

    def test_restart_to_the_bit(self) -> None:
        free = {
            "freestream.alpha": 1, "motion.kind": "free", "body.free": '["surge", "heave", "pitch"]', "body.mass": 40,
            "body.inertia": "[1, 2, 2]", "body.gravity": "[0, 0, -1e-3]", "motion.rotation": "[0, 0.002, 0]",
            "unsteady.duration": 60, "unsteady.steps": 12, "checkpoint.steps": 5, "checkpoint.keep": 9,
        }  # fmt: skip
        # Too short a record for a frequency, which is said and nothing else.
        whole = run(self.folder / "whole", "run", "sharp_cone/derivatives.toml", "cone_tiny.msh", free)
        self.assertEqual(whole["status"], "completed")
        self.assertIn("no frequency and damping", whole["message"])
        checkpoints = sorted((self.folder / "whole").glob("checkpoint_*.vtkhdf"))
        (self.folder / "half").mkdir()
        chosen = next(c for c in checkpoints if self.is_after_step(c, 5))
        chosen.rename(self.folder / "half" / chosen.name)
        run(self.folder / "rest", "run", "sharp_cone/derivatives.toml", "cone_tiny.msh", free, self.folder / "half")
        self.assertEqual(history(self.folder / "whole"), history(self.folder / "rest"))
        last = history(self.folder / "rest")[-1]
        self.assertNotEqual(last["z"], 0)
        self.assertLess(abs(last["energy"] - history(self.folder / "rest")[0]["energy"] - last["work"]), 1e-10)

    @staticmethod
    def is_after_step(checkpoint: Path, step: int) -> bool:
        done = subprocess.run([os.environ["ALPHADOT"], "info", checkpoint], capture_output=True, text=True, check=True)
        return f"motion (free), step {step}," in done.stdout

    def test_wrong_cases(self) -> None:
        free = {"motion.kind": "free", "body.free": '["pitch"]', "body.inertia": "[1, 1, 1]", "unsteady.duration": 9, "unsteady.steps": 9}
        for settings, words in (
            ({"body.free": "[]"}, "needs body.free"),
            ({"body.free": '["pitch", "flutter"]'}, "body.free"),
            ({"body.free": '["pitch", "pitch"]'}, "twice"),
            ({"body.free": '["yaw"]'}, "a half model has no yaw"),
            ({"body.free": '["heave"]'}, "needs body.mass > 0"),
            ({"body.inertia": "[1, 0, 1]"}, "body.inertia"),
            ({"motion.rotation": "[0, 0.1, 0]", "body.free": '["heave"]', "body.mass": 1}, "axis that is held"),
            ({"motion.treatment": "rigid_grid"}, "field velocity only"),
            ({"unsteady.duration": 0}, "unsteady.duration > 0"),
            ({"gust.kind": "sharp", "motion.kind": "plunge"}, "held or flies freely"),
            ({"gust.kind": "table"}, "needs gust.table_file"),
            ({"gust.kind": "sharp", "gust.direction": "starboard"}, "no gust from the side"),
        ):
            overrides = [f for key, value in {**free, **settings}.items() for f in ("--set", f"{key}={value}")]
            command = [os.environ["ALPHADOT"], "run", CASES / "sharp_cone/derivatives.toml", "--out", self.folder / "wrong", *overrides]
            done = subprocess.run([*command, "--set", f"mesh.file={MESHES / 'cone_tiny.msh'}"], capture_output=True, text=True)
            with self.subTest(words):
                self.assertEqual(done.returncode, 1, done.stderr)
                self.assertIn(words, done.stderr)


if __name__ == "__main__":
    unittest.main()
