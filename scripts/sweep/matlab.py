"""A grid as a MATLAB file (version 5) for lookup tables, by scipy."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from sweep.database import COEFFICIENTS
from sweep.errors import SweepError
from sweep.grid import Grid
from sweep.jsbsim import Control


def write(path: Path, grid: Grid, controls: Sequence[Control], title: str) -> None:
    """A struct `aero`: mach, alpha, beta (degrees), coefficients and derivatives as arrays (Mach, alpha, beta), their uncertainties
    under NAME_pm, the reference, and changes by controls (degrees, Mach, alpha). Raises SweepError without scipy."""
    try:
        from scipy.io import savemat
    except ImportError:
        raise SweepError("a .mat file needs the Debian package python3-scipy") from None
    reference = grid.reference
    aero: dict[str, object] = {
        "title": title, "mach": np.array(grid.mach), "alpha": np.array(grid.alpha), "beta": np.array(grid.beta),
        "length": reference["length"], "area": reference["area"], "moment_center": np.array(reference["moment_center"], dtype=float),
        "units": "angles deg; derivatives per rad, rates times length/2V; arrays (mach, alpha, beta)",
    }  # fmt: skip
    known = {name: grid.values(name) for name in COEFFICIENTS}
    aero |= {name: values for name, values in known.items() if values is not None}
    for name in grid.derivatives:
        aero[name] = grid.values(name)
        aero[f"{name}_pm"] = grid.uncertainties(name)
    for control in controls:
        aero[control.name] = {
            "degrees": np.array(control.degrees), "mach": np.array(control.mach), "alpha": np.array(control.alpha),
            **{f"d{name}": values for name, values in control.changes.items()},
        }  # fmt: skip
    savemat(path, {"aero": aero}, long_field_names=True, oned_as="row")
