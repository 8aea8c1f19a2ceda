#!/usr/bin/python3
"""The floors of the sources: an include never points up, and the list in the README has every folder, in that order."""

from __future__ import annotations

import re
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
# From the ground up. Those of one line do not include each other, but for what stands beside the derivatives.
FLOORS = (
    ("src/core",),
    ("src/euler", "src/motion"),
    ("partition",),
    ("io",),
    ("src/space",),
    ("src/linear",),
    ("src/march",),
    ("src/analysis",),
    ("src/derivatives",),
    ("src/case_file",),
    ("src/app",),
)
LEVEL = {Path(folder).name: level for level, folders in enumerate(FLOORS) for folder in folders}


def sources(folder: str) -> list[Path]:
    return sorted(path for path in (ROOT / folder).rglob("*") if path.suffix in (".cpp", ".hpp"))


class Floors(unittest.TestCase):
    def test_includes_point_down(self) -> None:
        seen = 0
        for folder in (folder for folders in FLOORS for folder in folders):
            here = Path(folder).name
            for path in sources(folder):
                for there in re.findall(r'^#include "(\w+)/', path.read_text(), re.MULTILINE):
                    seen += 1
                    self.assertIn(there, LEVEL, path)
                    self.assertTrue(there == here or LEVEL[there] < LEVEL[here], f"{path} includes {there}/")
        self.assertGreater(seen, 500)

    def test_every_folder_has_its_floor(self) -> None:
        folders = {path.name for path in (ROOT / "src").iterdir() if path.is_dir() and sources(f"src/{path.name}")}
        self.assertEqual(folders | {"partition", "io"}, set(LEVEL))

    def test_readme_shows_the_floors(self) -> None:
        rows = re.findall(r"^\| ((?:`[\w/]+`(?:, )?)+) \|", (ROOT / "README.md").read_text(), re.MULTILINE)
        shown = [name for row in rows for name in re.findall(r"`([\w/]+)`", row)]
        levels = [LEVEL[Path(name).name] for name in shown if name in {folder for folders in FLOORS for folder in folders}]
        self.assertEqual(sorted(levels), levels)
        self.assertEqual(len(levels), len(LEVEL))


if __name__ == "__main__":
    unittest.main()
