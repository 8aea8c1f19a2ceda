#!/usr/bin/python3
"""Axes of a sweep: ranges, total incidence and roll angle, matrices from CSV, deflected controls, and mirror images left out."""

from __future__ import annotations

import math
import unittest

import numpy as np
from workspace import HEAD, Workspace

from sweep.axes import from_total, to_total
from sweep.descriptions import deflected
from sweep.plan import SweepError, read_sweep

MISSILE = """flight = {mach = 2}
[[body]]
shape = "cone"
length = 0.3
diameter = 0.1
[[body]]
shape = "cylinder"
length = 1.0
[[fins]]
name = "canard"
number = 4
roll = 45
x = 0.4
root_chord = 0.1
span = 0.1
thickness_ratio = 0.05
deflection = 1
"""


def along(axis: int, degrees: float) -> np.ndarray:
    """Rotation about an axis, right-handed."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    i, j = (axis + 1) % 3, (axis + 2) % 3
    out = np.eye(3)
    out[i, i], out[j, j], out[i, j], out[j, i] = c, c, -s, s
    return out


class Axes(Workspace):
    def runs(self, blocks: str, head: str = HEAD):
        self.write(blocks, head)
        return read_sweep(self.file).runs

    def refused(self, blocks: str, *words: str, head: str = HEAD) -> None:
        with self.assertRaises(SweepError) as caught:
            self.runs(blocks, head)
        for word in words:
            self.assertIn(word, str(caught.exception))

    def test_ranges_have_both_ends(self) -> None:
        runs = self.runs("[[runs]]\nmach = {from = 1.1, to = 1.4, step = 0.1}\nalpha = {from = -4, to = 4, count = 3}\n")
        self.assertEqual([run.mach for run in runs][:4], [1.1, 1.2, 1.3, 1.4])
        self.assertEqual(sorted({run.alpha for run in runs}), [-4.0, 0.0, 4.0])
        self.refused("[[runs]]\nmach = {from = 1, to = 2, step = 0.3}\n", str(self.file), "0.3")
        self.refused("[[runs]]\nmach = {from = 1, to = 2}\n", "step or count")
        self.refused("[[runs]]\nmach = {from = 1, to = 2, count = 1}\n", "two values")

    def test_total_incidence_is_a_rotation(self) -> None:
        """The wind's direction in the body: once by turning the body to alpha and beta, once by rolling a body pitched to alpha_t."""
        for alpha_t, phi in ((10, 0), (10, 90), (20, 45), (35, -120), (0, 30), (8, 180)):
            alpha, beta = from_total(alpha_t, phi)
            wind = np.array([1.0, 0.0, 0.0])  # velocity of the body, forward
            rolled = along(0, phi).T @ along(1, alpha_t).T @ wind
            turned = along(1, alpha).T @ along(2, -beta).T @ wind
            # Forward, starboard, down: pitching up by alpha_t leaves w > 0; rolled to the right by phi, starboard meets it.
            np.testing.assert_allclose(turned, rolled, atol=1e-12)
            back = to_total(alpha, beta)
            self.assertAlmostEqual(back[0], alpha_t, places=10)
            if alpha_t:
                self.assertAlmostEqual(math.cos(math.radians(back[1] - phi)), 1.0, places=10)

    def test_total_incidence_in_a_sweep(self) -> None:
        runs = self.runs("[[runs]]\nmach = 2\nalpha_t = [0, 10]\nphi = [0, 45, 90]\n")
        self.assertEqual([run.name for run in runs][3:], [f"derivatives_m2_at10_phi{phi}" for phi in (0, 45, 90)])
        self.assertEqual((runs[3].alpha, runs[3].beta, runs[5].alpha, runs[5].beta), (10, 0, 0, 10))
        # tan(alpha) = tan(alpha_t) cos(phi), sin(beta) = sin(alpha_t) sin(phi)
        self.assertAlmostEqual(runs[4].settings["freestream.beta"], math.degrees(math.asin(math.sin(math.radians(10)) * math.sqrt(0.5))))
        self.refused("[[runs]]\nmach = 2\nalpha_t = 1\nbeta = 1\n", "either alpha and beta")

    def test_matrix(self) -> None:
        (self.folder / "points.csv").write_text("# flown\nmach, alpha, beta\n0.8, 0, 0\n\n2.0, 4, -1\n")
        runs = self.runs('[[runs]]\nmatrix = "points.csv"\nmethod = ["steady", "derivatives"]\n')
        self.assertEqual(len(runs), 4)
        self.assertEqual((runs[3].mach, runs[3].alpha, runs[3].beta, runs[3].name), (2.0, 4.0, -1.0, "derivatives_m2_a4_b-1"))
        (self.folder / "points.csv").write_text("mach,speed\n1,2\n")
        self.refused('[[runs]]\nmatrix = "points.csv"\n', "points.csv", "speed")
        (self.folder / "points.csv").write_text("mach,alpha\n1,x\n")
        self.refused('[[runs]]\nmatrix = "points.csv"\n', "row 1", "alpha is 'x'")

    def test_mirror_images_are_left_out(self) -> None:
        block = "[[runs]]\nmach = 2\nalpha = [-5, 0, 5]\nbeta = [-3, 3, 7]\n"
        wind = lambda head: [(run.alpha, run.beta) for run in self.runs(block, head)]
        self.assertEqual(len(wind(HEAD)), 9)
        self.assertEqual(len(wind(HEAD + 'symmetry = ["y"]\n')), 6)
        self.assertEqual(sorted(wind(HEAD + 'symmetry = ["y", "z"]\n')), [(0, 3), (0, 7), (5, 3), (5, 7)])
        alone = self.runs("[[runs]]\nmach = 2\nbeta = [-3, 5]\n", HEAD + 'symmetry = ["y"]\n')
        self.assertEqual([run.beta for run in alone], [-3, 5])  # nothing else would have them
        self.refused(block, "planes", head=HEAD + 'symmetry = "x"\n')

    def test_deflections_turn_panels(self) -> None:
        """What `alphadot mesh` reads in the file that is written for a combination."""
        from meshing.description import read_description

        (self.folder / "missile.toml").write_text(MISSILE)
        head = 'case = "missile.toml"\nfolder = "runs"\n[controls]\npitch = {canard = [1, 1, -1, -1]}\nroll = {canard = 1}\n'
        runs = self.runs("[[runs]]\nmach = 2\ndeflection = {pitch = [0, 5], roll = [0, 2]}\n", head)
        self.assertEqual([run.name for run in runs][-1], "derivatives_m2_a0_pitch5_roll2")
        angles = [[panel.deflection for panel in read_description(deflected(run)).panels] for run in runs]
        # Of a set of four at 45 degrees the first is up and to starboard, the last up and to port; a panel's sign is that of its roll.
        base = [panel.deflection for panel in read_description(self.folder / "missile.toml").panels]
        self.assertEqual(base, [1.0] * 4)
        self.assertEqual(angles, [base, [3.0] * 4, [6.0, 6.0, -4.0, -4.0], [8.0, 8.0, -2.0, -2.0]])
        self.assertEqual(deflected(runs[0]), self.folder / "missile.toml")
        self.assertEqual(len({str(run.identity()) for run in runs}), 4)
        self.assertTrue(all(run.is_described for run in runs))

    def test_sideslip_needs_both_halves(self) -> None:
        (self.folder / "missile.toml").write_text(MISSILE)
        head = 'case = "missile.toml"\nfolder = "runs"\n'
        models = lambda block: [run.model for run in self.runs("[[runs]]\nmach = 2\n" + block, head)]
        self.assertEqual(models(""), [""])
        self.assertEqual(models('model = "full"\n'), ["full"])
        self.assertEqual(models("beta = [0, 2]\n"), ["full", "full"])
        self.assertEqual(models("alpha_t = [0, 2]\nphi = 45\n"), ["full", "full"])
        self.refused('[[runs]]\nmach = 2\nmodel = "quarter"\n', "quarter", head=head)

    def test_controls_of_a_case_file(self) -> None:
        """They are its own keys, on its mesh; sums of what several controls of the sweep turn."""
        names = "".join(f'[[controls]]\nname = "{name}"\n' for name in ("flap_1", "flap_2"))
        (self.folder / "good.toml").write_text(names)
        head = HEAD + "[controls]\npitch = {flap_1 = 1, flap_2 = 1}\nroll = {flap_1 = 1, flap_2 = -1}\n"
        *_, run = self.runs("[[runs]]\nmach = 2\ndeflection = {pitch = [0, 2], roll = [0, 2]}\n", head)
        self.assertEqual((run.settings["deflections.flap_1"], run.settings.get("deflections.flap_2"), run.panels), (4.0, None, {}))
        block = "[[runs]]\nmach = 2\ndeflection.pitch = 1\n"
        self.refused(block, "flap_3", "flap_1, flap_2", head=HEAD + "[controls]\npitch = {flap_3 = 1}\n")
        self.refused(block, "one by one", head=HEAD + "[controls]\npitch = {flap_1 = [1, 1]}\n")

    def test_steady_turns(self) -> None:
        runs = self.runs("[[runs]]\nmach = 2\nq = [0, 0.01]\nr = 0.002\n")
        self.assertEqual([run.settings["motion.rotation"] for run in runs], [[0.0, 0.0, 0.002], [0.0, 0.01, 0.002]])
        self.assertEqual([run.is_plain for run in runs], [False, False])
        self.assertIn("_q0.01_r0.002", runs[1].name)
        runs = self.runs("[[runs]]\nmach = 2\nq = 0\n")
        self.assertTrue(runs[0].is_plain and "motion.rotation" not in runs[0].settings)
        self.refused('[[runs]]\nmach = 2\nmethod = "plunge"\nq = 0.01\n', "not of the method plunge")

    def test_controls_need_a_description(self) -> None:
        block = "[[runs]]\nmach = 2\ndeflection.pitch = 5\n"
        self.refused(block, "is not a description", head=HEAD + "[controls]\npitch = {canard = 1}\n")
        self.refused(block, "[controls]")
        self.refused(block, "alpha", head=HEAD + "[controls]\nalpha = {canard = 1}\n")
        (self.folder / "missile.toml").write_text(MISSILE)
        runs = self.runs(block, 'case = "missile.toml"\nfolder = "runs"\n[controls]\npitch = {tail = 1}\n')
        with self.assertRaisesRegex(SweepError, "no \\[\\[fins\\]\\] called 'tail'"):
            deflected(runs[0])


if __name__ == "__main__":
    unittest.main()
