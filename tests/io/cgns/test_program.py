#!/usr/bin/python3
"""alphadot-cgns2su2 as a program: what it makes is the mesh that was written, and whatever is in a file, it ends with one message.

Set by CTest: ALPHADOT, CONVERTER (the programs), SAMPLES (a folder of CGNS files and the hashes of their meshes).
"""

from __future__ import annotations

import os
import random
import resource
import subprocess
import tempfile
import unittest
from pathlib import Path

SAMPLES = sorted(Path(os.environ["SAMPLES"]).glob("*.cgns"))
MUTANTS = 60  # of each sample


class Program(unittest.TestCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        self.mesh = self.folder / "mesh.su2"

    def convert(self, *arguments: object, **options: object) -> subprocess.CompletedProcess[str]:
        command = [os.environ["CONVERTER"], *map(str, arguments)]
        return subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=60, **options)

    def assert_one_error(self, done: subprocess.CompletedProcess[str]) -> None:
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertEqual(done.stderr.count("alphadot-cgns2su2: error: "), 1, done.stderr)
        self.assertFalse(self.mesh.exists())
        self.assertEqual(list(self.folder.glob("*.part")), [])

    def test_alphadot_reads_the_same_mesh(self) -> None:
        self.assertEqual(len(SAMPLES), 3)
        for sample in SAMPLES:
            done = self.convert(sample, self.mesh)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("x_min", done.stdout)
            info = subprocess.run([os.environ["ALPHADOT"], "info", str(self.mesh)], capture_output=True, text=True, timeout=60)
            self.assertIn(f"hash {Path(f'{sample}.hash').read_text()}", info.stdout)

    def test_alphadot_names_the_converter(self) -> None:
        done = subprocess.run([os.environ["ALPHADOT"], "info", str(SAMPLES[0])], capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 1)
        self.assertIn("alphadot-cgns2su2", done.stderr)

    def test_cut_files(self) -> None:
        content = SAMPLES[0].read_bytes()
        cut = self.folder / "cut.cgns"
        for part in range(20):
            cut.write_bytes(content[: len(content) * part // 20])
            self.assert_one_error(self.convert(cut, self.mesh))

    def test_damaged_files(self) -> None:
        """Mutants; refused with one message or, where the damage does not show, converted."""
        dice = random.Random(1)
        damaged = self.folder / "damaged.cgns"
        refused = 0
        for sample in SAMPLES:
            content = sample.read_bytes()
            for _ in range(MUTANTS):
                mutant = bytearray(content)
                for _ in range(dice.randint(1, 20)):
                    place = dice.randrange(len(mutant))
                    value = dice.choice([b"\0", b"\xff", b"\xff\xff\xff\xff", b"\xff\xff\xff\x7f", dice.randbytes(1)])
                    mutant[place : place + len(value)] = value
                damaged.write_bytes(mutant)
                done = self.convert(damaged, self.mesh)
                if done.returncode == 0:
                    self.mesh.unlink()
                else:
                    refused += 1
                    self.assert_one_error(done)
        self.assertGreater(refused, MUTANTS / 5)

    def test_full_disk(self) -> None:
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (500, 500))
        done = self.convert(SAMPLES[0], self.mesh, preexec_fn=limit)
        self.assert_one_error(done)
        self.assertIn("File too large", done.stderr)

    def test_the_file_itself_stays(self) -> None:
        copy = self.folder / "mesh.cgns"
        copy.write_bytes(SAMPLES[0].read_bytes())
        done = self.convert(copy, copy)
        self.assert_one_error(done)
        self.assertIn("would replace the CGNS file", done.stderr)
        self.assertEqual(copy.read_bytes(), SAMPLES[0].read_bytes())

    def test_command_line(self) -> None:
        self.assertEqual(self.convert().returncode, 2)
        self.assertEqual(self.convert("--help").returncode, 0)


if __name__ == "__main__":
    unittest.main()
