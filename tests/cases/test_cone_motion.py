#!/usr/bin/python3
"""The sharp cone's acceleration derivatives from motions in time beside their exact values (cases/sharp_cone/reference)."""

from __future__ import annotations

import tempfile
import unittest
from pathlib import Path

from exact import ExactCase, cone_derivatives, run


class Motion(ExactCase):
    def check(self, case: str) -> None:
        with tempfile.TemporaryDirectory() as folder:
            found = run(Path(folder), "run", f"sharp_cone/{case}", "cone_coarse.msh", {})["derivatives"]
        exact = cone_derivatives()
        for name in ("CN_alphadot", "Cm_alphadot"):
            self.assert_close(name, found[name]["value"], exact[name], 0.015)

    def test_step(self) -> None:
        self.check("step.toml")

    def test_plunge(self) -> None:
        self.check("plunge.toml")


if __name__ == "__main__":
    unittest.main()
