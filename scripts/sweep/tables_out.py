"""What `table` writes: everything as CSV and HDF5, and from one series the tables of other programs."""

from __future__ import annotations

from pathlib import Path

from sweep import datcom, fly_folder, jsbsim, matlab, rocketpy_surface, tidy
from sweep.controls import read_controls
from sweep.database import Point, read_points
from sweep.errors import SweepError
from sweep.grid import choose_series, completed_by_roll, make_grid
from sweep.plan import Sweep

FOLDER = "table"


def write_all(sweep: Sweep, wanted: str | None, formats: set[str]) -> list[str]:
    """Writes the files into FOLDER/table of the sweep; lines that tell what they are and what is not in them. Raises SweepError."""
    points = read_points(sweep)
    folder = sweep.folder / FOLDER
    folder.mkdir(parents=True, exist_ok=True)
    columns = tidy.columns_of(points)
    tidy.write_csv(folder / "database.csv", columns, sweep.title)
    tidy.write_hdf5(folder / "database.h5", columns, sweep.title)
    images = sum(bool(point.image) for point in points)
    rows = f"{len(points) - images} runs" + (f" and {images} mirror images" if images else "")
    lines = [f"database.csv, database.h5: {rows}, {len(columns)} columns"]
    loads = tidy.loads_of(points, sweep) if sweep.altitudes else {}
    if loads:
        tidy.write_csv(folder / "loads.csv", loads, f"{sweep.title}: loads in SI units in the standard atmosphere, sea level and up")
        lines.append(f"loads.csv: at {len(sweep.altitudes)} altitudes")
    return lines + write_series(sweep, points, folder, wanted, formats)


def write_series(sweep: Sweep, points: list[Point], folder: Path, wanted: str | None, formats: set[str]) -> list[str]:
    """The files of one series, and what was left out of them."""
    try:
        series = choose_series(points, wanted)
        grid = make_grid(points, series)
    except SweepError as error:
        if wanted is not None:
            raise
        return [f"no other tables: {error}"]
    if sweep.is_axial:
        grid = completed_by_roll(grid)
    controls, notes = read_controls(points, grid)
    span = lambda name, values: f"{len(values)} {name}"
    lines = [f"from series '{series}', {span('Mach numbers', grid.mach)} x {span('alpha', grid.alpha)} x {span('beta', grid.beta)}:"]
    if "jsbsim" in formats:
        (folder / "jsbsim").mkdir(exist_ok=True)
        (folder / "jsbsim" / "aerodynamics.xml").write_text(jsbsim.aerodynamics(grid, controls, sweep.title))
        fly_folder.complete(folder / "jsbsim", grid, sweep.unit, "fly_jsbsim.py")
        lines.append("jsbsim/: aerodynamics.xml, fly.py")
    if "datcom" in formats:
        (folder / "coefficients.txt").write_text(datcom.text(grid, sweep.title))
        lines.append("coefficients.txt")
    if "rocketpy" in formats:
        notes += rocketpy_surface.write(folder / "rocketpy", grid, sweep.unit, sweep.is_axial)
        lines.append("rocketpy/: generic, linear, fly.py")
    if "mat" in formats:
        try:
            matlab.write(folder / "aero.mat", grid, controls, sweep.title)
            lines.append("aero.mat")
        except SweepError as error:
            notes.append(str(error))
    others = sorted({point.series for point in points} - {series})
    notes += [f"series {', '.join(others)}: --series NAME makes these tables of another"] if others else []
    return lines + [f"left out: {line}" for line in (*grid.left_out, *notes)]
