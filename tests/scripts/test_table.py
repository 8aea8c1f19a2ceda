#!/usr/bin/python3
"""Tables for other programs, read back by readers of the test's own, for a configuration whose loads are known: a tail of two crossed
flat fins of lift slope A at a distance X behind the moment centre, with four of them at a radius R against roll. Each meets the wind
that its own motion gives it, and behind a canard with downwash EPS alpha it meets the downwash of a moment X / V ago."""

from __future__ import annotations

import csv
import math
import shutil
import subprocess
import sys
import unittest

import h5py
import numpy as np
from readers import JSBSIM_AXES, csv_value, flown, jsbsim_loads, rocketpy_generic, rocketpy_linear
from scipy.io import loadmat
from stub_runs import finish, finish_all
from workspace import HEAD, Workspace

from sweep.atmosphere import air_at
from sweep.plan import read_sweep

A, X, R, EPS, CA = 7.0, 0.6, 0.05, 0.3, 0.35
LENGTH, AREA = 0.1, 0.008  # of the stub's reference
SPEED, PRESSURE = 650.0, 2.0e4
Q_S, Q_S_L = PRESSURE * AREA, PRESSURE * AREA * LENGTH


def slope(mach: float) -> float:
    return A / mach


def loads(mach: float, alpha: float, beta: float, p=0.0, q=0.0, r=0.0, alphadot=0.0, betadot=0.0) -> dict[str, float]:
    """Newtons and newton metres on JSBSim's axes, linear in everything; angles in rad, rates in rad/s. The tail is at (-X, 0, 0) on axes
    forward, starboard, down: its velocity there is (V, V beta, V alpha) + (p, q, r) x (-X, 0, 0), less the downwash."""
    tail = np.array([SPEED, SPEED * beta, SPEED * alpha]) + np.cross([p, q, r], [-X, 0, 0])
    wash = EPS * SPEED * np.array([0, beta - betadot * X / SPEED, alpha - alphadot * X / SPEED])
    met = tail - wash
    force = np.array([-CA * Q_S, -Q_S * slope(mach) * met[1] / SPEED, -Q_S * slope(mach) * met[2] / SPEED])
    moment = np.cross([-X, 0, 0], force)
    moment[0] -= Q_S * slope(mach) * R * (p * R / SPEED)  # the tips go up and down at p R
    return dict(zip(JSBSIM_AXES, (*force, *moment)))


def model(mach: float, alpha: float, beta: float) -> tuple[dict, dict]:
    """The coefficients of it, by hand: per rad, rates times LENGTH / 2V."""
    a, x, static = slope(mach), X / LENGTH, 1 - EPS
    angle, slip = math.radians(alpha), math.radians(beta)
    derivatives = {
        "CA_alpha": 0.0, "CN_alpha": a * static, "Cm_alpha": -a * static * x, "CY_beta": -a * static, "Cn_beta": a * static * x,
        "CN_q": 2 * a * x, "Cm_q": -2 * a * x**2, "CY_r": 2 * a * x, "Cn_r": -2 * a * x**2,
        "CN_alphadot": 2 * a * EPS * x, "Cm_alphadot": -2 * a * EPS * x**2,
        "CY_betadot": -2 * a * EPS * x, "Cn_betadot": 2 * a * EPS * x**2, "Cl_p": -2 * a * (R / LENGTH) ** 2,
    }  # fmt: skip
    steady = {
        "CA": CA, "CN": derivatives["CN_alpha"] * angle, "Cm": derivatives["Cm_alpha"] * angle,
        "CY": derivatives["CY_beta"] * slip, "Cn": derivatives["Cn_beta"] * slip,
    }  # fmt: skip
    return steady, derivatives


def in_pitch(mach: float, alpha: float, beta: float) -> tuple[dict, dict]:
    """What a half model gives of it."""
    steady, derivatives = model(mach, alpha, beta)
    kept = lambda name: name[:2] in ("CA", "CN", "Cm") and name[3:] not in ("beta", "p", "r")
    keep = lambda found: {name: value for name, value in found.items() if kept(name)}
    return keep(steady), keep(derivatives)


MOTIONS = ({}, {"q": 2.0}, {"alphadot": 1.5}, {"p": 30.0}, {"r": -1.0}, {"betadot": 2.0}, {"p": 5.0, "q": 1.0, "r": 0.5, "alphadot": -1.0})
GRID = "[[runs]]\nmach = [1.5, 2, 3]\nalpha = [-4, 0, 4]\nbeta = [-3, 0, 3]\n"
IN_PITCH = "[[runs]]\nmach = [1.5, 2, 3]\nalpha = [0, 2, 4, 6, 8]\n"
HEAD = HEAD.replace("alpha = 1.5\n", "")


class Tables(Workspace):
    def made(self, blocks: str, of=model, head: str = HEAD, **options) -> str:
        self.write(blocks, head)
        finish(read_sweep(self.file).runs, of, **options)
        self.table = self.folder / "runs" / "table"
        return self.sweep("table")

    def check_jsbsim(self, points: list[tuple[float, float, float]]) -> None:
        flight = {"speed": SPEED, "pressure": PRESSURE, "area": AREA, "length": LENGTH}
        for mach, alpha, beta in points:
            for motion in MOTIONS:
                found = jsbsim_loads(self.table / "jsbsim/aerodynamics.xml", flown(mach, alpha, beta, **flight, **motion))
                wanted = loads(mach, math.radians(alpha), math.radians(beta), **motion)
                for axis, value in wanted.items():
                    self.assertAlmostEqual(found[axis], value, delta=1e-6 * (1 + abs(value)), msg=(axis, mach, alpha, beta, motion))

    def test_jsbsim_has_the_tail(self) -> None:
        self.made(GRID)
        self.check_jsbsim([(1.5, 0, 0), (2, 4, 3), (3, -4, -3), (2, 1, -1)])
        # Linear between Mach numbers, and the edge's value outside.
        flight = {"speed": SPEED, "pressure": PRESSURE, "area": AREA, "length": LENGTH}
        normal = lambda mach, alpha: jsbsim_loads(self.table / "jsbsim/aerodynamics.xml", flown(mach, alpha, **flight))["Z"]
        self.assertAlmostEqual(normal(2.5, 4), 0.5 * (normal(2, 4) + normal(3, 4)), places=6)
        self.assertAlmostEqual(normal(5, 9), normal(3, 4), places=9)

    def test_jsbsim_of_one_sideslip_and_of_one_incidence(self) -> None:
        """Where an angle has one value its derivative takes the place of the table."""
        self.made("[[runs]]\nmach = [1.5, 3]\nalpha = [0, 4]\n")
        self.check_jsbsim([(1.5, 4, 2), (3, 1, -5)])
        self.made("[[runs]]\nmach = [1.5, 3]\nalpha = 1\n")
        self.check_jsbsim([(1.5, 4, 2), (3, 1, -5)])

    def test_the_side_from_pitch(self) -> None:
        """Of a half model that looks the same from all sides; its CN over alpha is linear here, so that CN / sin(alpha) is off by
        alpha^2 / 6."""
        self.made(IN_PITCH, in_pitch, HEAD + 'symmetry = ["axial"]\n')
        flight = {"speed": SPEED, "pressure": PRESSURE, "area": AREA, "length": LENGTH}
        for alpha, beta in ((0, 2), (0, -3)):
            for motion in ({}, {"r": 1.0}, {"betadot": -2.0}):
                found = jsbsim_loads(self.table / "jsbsim/aerodynamics.xml", flown(2, alpha, beta, **flight, **motion))
                wanted = loads(2, math.radians(alpha), math.radians(beta), **motion)
                for axis in ("Y", "YAW"):
                    self.assertAlmostEqual(found[axis], wanted[axis], delta=1e-9 * abs(wanted[axis]))
        # Mirrored below, too.
        self.assertAlmostEqual(csv_value(self.table / "rocketpy/generic/cm.csv", mach=2, alpha=-math.radians(4), beta=0.0), -csv_value(
            self.table / "rocketpy/generic/cm.csv", mach=2, alpha=math.radians(4), beta=0.0
        ))  # fmt: skip
        # In the plane of the wind the loads are those in pitch at the total incidence.
        alpha, beta = math.radians(2), math.radians(4)
        total = math.atan(math.hypot(math.tan(alpha), math.tan(beta)))
        force, moment = rocketpy_generic(self.table / "rocketpy/generic", 2, alpha, beta)
        self.assertAlmostEqual(math.hypot(force[0], force[1]), slope(2) * (1 - EPS) * total)
        self.assertAlmostEqual(force[0] / force[1], math.tan(beta) / math.tan(alpha))
        self.assertAlmostEqual(moment[0] / moment[1], force[1] / -force[0])
        self.assertAlmostEqual(force[2], -CA)

    def test_rocketpy_surfaces(self) -> None:
        self.made(GRID)
        generic, line = self.table / "rocketpy/generic", self.table / "rocketpy/linear"
        for mach, alpha, beta in ((1.5, 0, 0), (2, 4, 0), (3, -4, 0), (2, 0, 3), (2, 0, -3)):
            force, moment = rocketpy_generic(generic, mach, math.radians(alpha), math.radians(beta))
            wanted = loads(mach, math.radians(alpha), math.radians(beta))
            np.testing.assert_allclose(Q_S * force, (wanted["Y"], wanted["Z"], wanted["X"]), atol=1e-9)
            np.testing.assert_allclose(Q_S_L * moment, (wanted["PITCH"], wanted["YAW"], wanted["ROLL"]), atol=1e-9)
        for motion in ({"q": 2.0}, {"r": -1.0}, {"p": 30.0}):
            force, moment = rocketpy_linear(line, 2, 0, 0, LENGTH / (2 * SPEED), motion)
            wanted = loads(2, 0, 0, **motion)
            np.testing.assert_allclose(Q_S * force, (wanted["Y"], wanted["Z"], wanted["X"]), atol=1e-9)
            np.testing.assert_allclose(Q_S_L * moment, (wanted["PITCH"], wanted["YAW"], wanted["ROLL"]), atol=1e-9)
        # Along a straight path alphadot is q and betadot is -r.
        for motion, sums in (({"q": 2.0}, {"q": 2.0, "alphadot": 2.0}), ({"r": -1.0}, {"r": -1.0, "betadot": 1.0})):
            _, moment = rocketpy_linear(line, 2, 0, 0, LENGTH / (2 * SPEED), motion, sums=True)
            wanted = loads(2, 0, 0, **sums)
            np.testing.assert_allclose(Q_S_L * moment, (wanted["PITCH"], wanted["YAW"], wanted["ROLL"]), atol=1e-9)
        # To first order in the angles, against the matrix that turns lift and drag.
        small = 1e-5
        for alpha, beta in ((small, 0), (0, small)):
            force, _ = rocketpy_linear(line, 2, alpha, beta, 0.0, {})
            wanted = loads(2, alpha, beta)
            np.testing.assert_allclose(Q_S * force, (wanted["Y"], wanted["Z"], wanted["X"]), atol=1e-6)

    def test_jsbsim_flies_as_small_disturbances_do(self) -> None:
        """A coast in JSBSim itself: root of the short period, the two ways of moving that the equations of motion give by hand. With the
        tail's loads per rad, k = q S / m V and m = q S l / I, w = V alpha on axes that turn with q, and the drag that slows the flight."""
        program = shutil.which("JSBSim") or shutil.which("JSBSim", path="/usr/games")
        if not program:
            self.skipTest("JSBSim is not installed")
        self.made(GRID)
        mass, inertia, mach = 400.0, 6.0, 2.0
        command = [sys.executable, "-B", str(self.table / "jsbsim/fly.py"), "--program", program, "--keep", str(self.folder / "kept")]
        command += f"--mass {mass} --inertia 0.05 {inertia} --center 0.5 --mach {mach} --alpha 2 --altitude 1000 --seconds 1".split()
        command += ["--step", "2e-5"]
        done = subprocess.run(command, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual(len(done.stdout.splitlines()), 102)
        with open(self.folder / "kept/flight.csv") as file:
            time, _, alpha = np.array([row[:3] for row in list(csv.reader(file))[1:]], dtype=float).T
        air = air_at(1000.0)
        speed = mach * air.sound_speed
        q_s = 0.5 * air.density * speed**2 * AREA
        k, m, t = q_s / (mass * speed), q_s * LENGTH / inertia, LENGTH / (2 * speed)
        c = model(mach, 0, 0)[1]
        lag = 1 + k * t * c["CN_alphadot"]
        own, turning = -k * (c["CN_alpha"] - CA) / lag, (1 - k * t * c["CN_q"]) / lag
        matrix = [[own, turning], [
            m * (c["Cm_alpha"] + t * c["Cm_alphadot"] * own), m * t * (c["Cm_q"] + c["Cm_alphadot"] * turning)
        ]]  # fmt: skip
        exact = max(np.linalg.eigvals(matrix), key=lambda root: root.imag)
        # A sample is a sum of the two before it and a constant.
        every, step = alpha[::10], time[10] - time[0]
        rows = np.column_stack([every[1:-1], every[:-2], np.ones(len(every) - 2)])
        first, second, _ = np.linalg.lstsq(rows, every[2:], rcond=None)[0]
        found = np.log(0.5 * first + np.sqrt(complex(0.25 * first**2 + second))) / step
        self.assertAlmostEqual(found.imag / exact.imag, 1.0, delta=0.002)
        self.assertAlmostEqual(found.real / exact.real, 1.0, delta=0.02)
        without = 0.5 * (own + m * t * c["Cm_q"])
        self.assertGreater(abs(without / exact.real - 1), 0.1, "alphadot matters here")

    def test_fly_without_jsbsim_says_so(self) -> None:
        self.made(GRID)
        command = [sys.executable, "-B", str(self.table / "jsbsim/fly.py"), "--program", ""]
        done = subprocess.run([*command, *"--mass 20 --inertia 0.05 6 --center 0.5 --mach 2".split()], capture_output=True, text=True)
        self.assertEqual(done.returncode, 77)
        self.assertIn("name it by --program", done.stdout)

    def test_fly_without_rocketpy_says_so(self) -> None:
        self.made(GRID)
        command = [sys.executable, "-B", str(self.table / "rocketpy/fly.py")]
        command += "--mass 20 --inertia 0.05 6 --center 0.5 --mach 2".split()
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode == 77:
            self.assertIn("RocketPy is not installed", done.stdout)
        else:
            self.assertEqual(done.returncode, 0, done.stderr)

    def test_controls(self) -> None:
        """A control that adds 0.01 CN and -0.05 Cm a degree, and twice that at Mach 1.5."""
        (self.folder / "missile.toml").write_text('[[body]]\nshape = "cone"\n')
        head = 'case = "missile.toml"\nfolder = "runs"\n[controls]\npitch = {canard = [1, 1, -1, -1]}\n'
        self.write("[[runs]]\nmach = [1.5, 2]\nalpha = [0, 4]\ndeflection.pitch = [-5, 0, 10]\n", head)
        gain = lambda mach: 2 if mach == 1.5 else 1
        for run in read_sweep(self.file).runs:
            steady, derivatives = model(run.mach, run.alpha, run.beta)
            turned = gain(run.mach) * run.deflections["pitch"]
            finish([run], lambda *_: (steady | {"CN": steady["CN"] + 0.01 * turned, "Cm": steady["Cm"] - 0.05 * turned}, derivatives))
        self.sweep("table")
        self.table = self.folder / "runs/table"
        flight = {"speed": SPEED, "pressure": PRESSURE, "area": AREA, "length": LENGTH}
        for mach, alpha, degrees in ((1.5, 0, -5), (2, 4, 10), (2, 2, 5), (2, 0, 0)):
            found = jsbsim_loads(self.table / "jsbsim/aerodynamics.xml", flown(mach, alpha, **flight, **{"fcs/pitch-deg": degrees}))
            wanted = loads(mach, math.radians(alpha), 0.0)
            self.assertAlmostEqual(found["Z"], wanted["Z"] - Q_S * 0.01 * gain(mach) * degrees)
            self.assertAlmostEqual(found["PITCH"], wanted["PITCH"] - Q_S_L * 0.05 * gain(mach) * degrees)
        self.sweep("report")
        with open(self.folder / "runs/report/trim.csv") as file:
            trim = {(row["deflection, deg"], row["Mach"]): float(row["alpha, deg"]) for row in csv.DictReader(list(file)[1:])}
        # Cm = Cm_alpha alpha - 0.05 d at Mach 2; -5 degrees hold it where that is zero, 10 degrees below what was computed.
        held = math.degrees(-0.05 * 5 / model(2, 0, 0)[1]["Cm_alpha"])
        self.assertAlmostEqual(trim["-5.0", "2.0"], held)
        self.assertNotIn(("10.0", "2.0"), trim)
        mat = loadmat(self.table / "aero.mat", simplify_cells=True)["aero"]
        self.assertEqual(mat["pitch"]["degrees"].tolist(), [-5, 0, 10])
        self.assertAlmostEqual(mat["pitch"]["dCN"][2, 0, 1], 0.2)

    def test_controls_that_there_are_derivatives_by(self) -> None:
        """They are linear terms; images below the plane have none, whose panels have other names."""
        gain = lambda mach: {"CN_tail_pitch": 3 / mach, "Cm_tail_pitch": -12 / mach, "Cl_roll": -0.5}

        def with_controls(*at: float) -> tuple[dict, dict]:
            steady, derivatives = model(*at)
            return steady, derivatives | gain(at[0])

        self.made("[[runs]]\nmach = [1.5, 2]\nalpha = [0, 4]\n", with_controls)
        flight = {"speed": SPEED, "pressure": PRESSURE, "area": AREA, "length": LENGTH}
        for mach, alpha, pitch, roll in ((1.5, 0, 0.1, 0), (2, 4, -0.05, 0.02), (2, 2, 0, 0)):
            turned = {"fcs/tail_pitch-rad": pitch, "fcs/roll-rad": roll}
            found = jsbsim_loads(self.table / "jsbsim/aerodynamics.xml", flown(mach, alpha, **flight, **turned))
            wanted, by = loads(mach, math.radians(alpha), 0.0), gain(mach)
            self.assertAlmostEqual(found["Z"], wanted["Z"] - Q_S * by["CN_tail_pitch"] * pitch)
            self.assertAlmostEqual(found["PITCH"], wanted["PITCH"] + Q_S_L * by["Cm_tail_pitch"] * pitch)
            self.assertAlmostEqual(found["ROLL"], wanted["ROLL"] + Q_S_L * by["Cl_roll"] * roll)
        mat = loadmat(self.table / "aero.mat", simplify_cells=True)["aero"]
        self.assertEqual(mat["Cm_tail_pitch"].tolist(), [[-8, -8], [-6, -6]])
        self.assertEqual({float(row["CN_tail_pitch"]) for row in self.rows()}, {2.0, 1.5})
        with h5py.File(self.table / "database.h5") as file:
            self.assertEqual(file["Cl_roll/value"][:].tolist(), [-0.5] * 4)

    def test_what_is_not_converged_is_left_out_and_said(self) -> None:
        ends = {"derivatives_m2_a0": "not_converged", "derivatives_m3_a4": "failed"}
        said = self.made("[[runs]]\nmach = [1.5, 2, 3]\nalpha = [0, 2, 4]\n", status=lambda run: ends.get(run.name, "converged"))
        self.assertIn("left out: derivatives_m2_a0: not converged: the steady march dropped 2.1 of 6 decades", said)
        self.assertIn("left out: derivatives_m3_a4: failed: no such mesh", said)
        mat = loadmat(self.table / "aero.mat", simplify_cells=True)["aero"]
        # Two of three by two of three are full: without Mach 2 and alpha 4, or the like.
        self.assertEqual(mat["CN"].shape[0] * mat["CN"].shape[1], 4)
        self.assertNotIn((2.0, 0.0), {(m, a) for m in mat["mach"] for a in mat["alpha"]})
        self.assertNotIn((3.0, 4.0), {(m, a) for m in mat["mach"] for a in mat["alpha"]})
        rows = {row["run"]: row for row in self.rows()}
        self.assertEqual((rows["derivatives_m2_a0"]["converged"], rows["derivatives_m3_a4"]["CN"]), ("no", ""))
        self.assertNotEqual(rows["derivatives_m2_a0"]["CN"], "")

    def rows(self) -> list[dict[str, str]]:
        with open(self.table / "database.csv") as file:
            return list(csv.DictReader(line for line in file if not line.startswith("#")))

    def test_one_table_of_everything(self) -> None:
        head = HEAD + 'symmetry = ["y"]\naltitude = [0, 11000]\nunit = "m"\n'
        self.made("[[runs]]\nmach = 2\nalpha = [0, 4]\nbeta = [0, 3]\n", head=head)
        rows = self.rows()
        self.assertEqual(len(rows), 6)  # and two images
        steady, derivatives = model(2, 4, 3)
        row = next(row for row in rows if row["alpha"] == "4.0" and row["beta"] == "3.0")
        image = next(row for row in rows if row["alpha"] == "4.0" and row["beta"] == "-3.0")
        self.assertEqual((row["image"], image["image"], row["status"], row["converged"]), ("", "y", "done", "yes"))
        for name, value in (steady | derivatives).items():
            self.assertEqual(float(row[name]), value)
            odd = (name[:2] in ("CY", "Cl", "Cn")) != (name[3:] in ("beta", "p", "r", "betadot"))
            self.assertEqual(float(image[name]), -value if odd else value, name)
        self.assertAlmostEqual(float(row["Cm_q.uncertainty"]), float(row["Cm_q.linear"]) + float(row["Cm_q.mesh"]))
        self.assertAlmostEqual(float(row["x_cp"]), 0.5 + X)  # the tail's place behind the moment centre, at x = 0.5
        self.assertAlmostEqual(float(row["CN@tail_1"]), 0.5 * steady["CN"])
        with h5py.File(self.table / "database.h5") as file:
            self.assertEqual(file["run"].asstr()[:].tolist(), [row["run"] for row in rows])
            self.assertEqual(file["Cm_q/value"][:].tolist(), [float(row["Cm_q"]) for row in rows])
            self.assertEqual(file["Cm_q/mesh"][:].tolist(), [float(row["Cm_q.mesh"]) for row in rows])
            self.assertTrue(np.isnan(file["components/body/CN"][-1]))
        with open(self.table / "loads.csv") as file:
            every = list(csv.DictReader(line for line in file if not line.startswith("#")))
        at = [row for row in every if row["run"] == "derivatives_m2_a4_b3" and not row["image"]]
        # ICAO Doc 7488: 11 km geopotential is 11,019 m; at 11,000 m T = 216.774 K, p = 22,700 Pa, rho = 0.3648 kg/m3, a = 295.15 m/s.
        self.assertAlmostEqual(float(at[0]["q_Pa"]), 0.5 * 1.225 * (2 * 340.294) ** 2, delta=1)
        self.assertAlmostEqual(float(at[1]["V_m_s"]), 2 * 295.154, delta=0.01)
        self.assertAlmostEqual(float(at[1]["FN_N"]), steady["CN"] * AREA * 0.5 * 0.36480 * (2 * 295.154) ** 2, delta=0.02)
        self.assertAlmostEqual(float(at[0]["reynolds"]), 1.225 * 2 * 340.294 * LENGTH / 1.7894e-5, delta=1e3)

    def test_turns_are_rows_and_on_no_grid(self) -> None:
        said = self.made("[[runs]]\nmach = [1.5, 2]\nq = [0, 0.01]\n")
        self.assertEqual([row["q"] for row in self.rows()], ["0.0", "0.0", "0.01", "0.01"])
        self.assertIn("2 Mach numbers x 1 alpha", said)

    def test_text_table(self) -> None:
        self.made("[[runs]]\nmach = [1.5, 2]\nalpha = [0, 4]\n")
        text = (self.table / "coefficients.txt").read_text()
        block = text[text.index("MACH NO = 2 ") :].splitlines()
        names, first = block[2].split(), dict(zip(block[2].split(), map(float, block[4].split())))
        self.assertEqual(names[:4], ["ALPHA", "CN", "CM", "CA"])
        self.assertAlmostEqual(first["CN"], model(2, 4, 0)[0]["CN"], places=4)
        self.assertAlmostEqual(first["X-C.P."], X / LENGTH, places=3)
        self.assertIn("CMAD", text)

    def test_nothing_to_make_tables_of(self) -> None:
        self.write("[[runs]]\nmach = 2\n")
        self.assertIn("nothing to make tables of", self.sweep("table"))
        finish_all(read_sweep(self.file), model)
        self.assertIn("there are derivatives", self.sweep("table", "--series", "steady", code=1))


if __name__ == "__main__":
    unittest.main()
