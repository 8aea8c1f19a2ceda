#!/usr/bin/python3
"""`cmake --install` into a folder: the program, its page and its completion, the scripts, and the library for somebody else's
project. Set by CTest: ALPHADOT, CMAKE, BUILD (the build folder), CXX, GENERATOR."""

from __future__ import annotations

import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "app"))
from program import box, gmsh_text  # noqa: E402

CMAKE, BUILD = os.environ["CMAKE"], os.environ["BUILD"]


def ran(*command: object, **options: object) -> str:
    """What a command prints; it must succeed."""
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, **options)
    assert done.returncode == 0, f"{command}: {done.stdout}{done.stderr}"
    return done.stdout


class Install(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = Path(temporary.name)
        cls.prefix = cls.folder / "prefix"
        ran(CMAKE, "--install", BUILD, "--prefix", cls.prefix)
        cls.environment = os.environ | {"PATH": f"{cls.prefix}/bin:{os.environ['PATH']}"}

    def test_program(self) -> None:
        self.assertRegex(ran("alphadot", "--version", env=self.environment), r"^alphadot \d+\.\d+\.\d+")

    def test_man_page(self) -> None:
        """It renders without a complaint, and has every verb, option and key that the program tells of."""
        page = self.prefix / "share" / "man" / "man1" / "alphadot.1.gz"
        self.assertTrue(page.exists())
        if not shutil.which("man"):
            self.skipTest("there is no man here")
        environment = self.environment | {"MANWIDTH": "200", "LC_ALL": "C.UTF-8", "MAN_KEEP_FORMATTING": ""}
        done = subprocess.run(["man", "--warnings", "-l", str(page)], capture_output=True, text=True, env=environment)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        text = re.sub(r".\b", "", done.stdout) if "\b" in done.stdout else done.stdout
        help_text = ran("alphadot", "--help", env=self.environment)
        verbs = re.findall(r"^  ([a-z]+) ", help_text, re.MULTILINE)
        self.assertIn("watch", verbs)
        for verb in verbs:
            self.assertRegex(text, rf"\n   {verb}\n")
            for option in re.findall(r"--[a-z]+(?:-[a-z]+)*", ran("alphadot", verb, "--help", env=self.environment)):
                self.assertIn(option, text)
        for key in re.findall(r"^  ([a-z_]+) ", ran("alphadot", "keys", env=self.environment), re.MULTILINE):
            self.assertRegex(text, rf"\b{key}\b")

    def completions(self, *words: str, program: str = "alphadot") -> list[str]:
        """What bash offers for the last of the words."""
        file = self.prefix / "share" / "bash-completion" / "completions" / program
        function = "_" + program.replace("-", "_")
        script = f'compopt() {{ :; }}; source {file}; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); {function}; echo "${{COMPREPLY[@]}}"'
        return ran("bash", "-c", script, "bash", program, *words, env=self.environment).split()

    def test_completion(self) -> None:
        self.assertEqual(self.completions("de"), ["derivatives", "derive"])
        self.assertEqual(self.completions("run", "--re"), ["--restart"])
        self.assertEqual(self.completions("mesh", "--no"), ["--no-picture"])
        self.assertEqual(self.completions("run", "case.toml", "--set", "freestream.m"), ["freestream.mach="])
        self.assertEqual(self.completions("ta", program="alphadot-sweep"), ["table"])
        self.assertEqual(self.completions("slurm", "x.toml", "--e", program="alphadot-sweep"), ["--each"])

    def test_scripts(self) -> None:
        """alphadot-sweep finds its modules, the cases and the program."""
        cases = self.prefix / "share" / "alphadot" / "cases"
        status = ran("alphadot-sweep", "status", cases / "basic_finner" / "table1.toml", env=self.environment)
        self.assertIn("7 waiting", status)
        self.assertFalse(list(self.prefix.rglob("*.msh")))

    def test_somebody_elses_project(self) -> None:
        """Busemann's CN = c1 alpha - c2 alpha^2 of the upper side of a plate, as in test_commands.py, and its derivative, found
        through the library; the linear solves on both sides in three decades."""
        build, mesh = self.folder / "consumer", self.folder / "box.msh"
        ran(
            *(CMAKE, "-S", HERE / "consumer", "-B", build, "-G", os.environ["GENERATOR"]),
            *("-DCMAKE_BUILD_TYPE=Release", f"-DCMAKE_PREFIX_PATH={self.prefix}"),
        )
        ran(CMAKE, "--build", build)
        mesh.write_text(gmsh_text(*box(6)))
        status, _, normal_force, _, forward, name, adjoint = ran(build / "consumer", mesh).splitlines()[-1].split()  # below the library's log
        self.assertEqual((status, name), ("converged", "CN_alpha"))
        alpha, beta2 = math.radians(1.0), 3.0
        c1, c2 = 2.0 / math.sqrt(beta2), (2.4 * 16.0 - 4.0 * beta2) / (2.0 * beta2**2)
        self.assertAlmostEqual(float(normal_force), c1 * alpha - c2 * alpha**2, delta=0.01 * c1 * alpha)
        self.assertAlmostEqual(float(forward), c1 - 2 * c2 * alpha, delta=0.01 * c1)
        self.assertAlmostEqual(float(adjoint), float(forward), delta=1e-3 * c1)


if __name__ == "__main__":
    unittest.main()
