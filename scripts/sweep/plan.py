"""The sweep file: what is to be run, each run with its name, folder and settings."""

from __future__ import annotations

import hashlib
import json
import os
import tomllib
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path

from sweep.axes import BODY_ANGLES, RATES, TOTAL_ANGLES, is_number, matrix, numbers, points
from sweep.errors import SweepError

Value = bool | int | float | str | list
DERIVATIVES, STEADY = "derivatives", "steady"  # methods; any other is a kind of motion
BLOCK_KEYS = {
    "label", "case", "mesh", "mesh_mach", "model", "method", "mach", "alpha", "beta", "alpha_t", "phi", "p", "q", "r",
    "deflection", "matrix", "ranks", "set"
}  # fmt: skip
SWEEP_KEYS = BLOCK_KEYS - {"label"} | {"title", "folder", "runs", "controls", "symmetry", "altitude", "unit", "mass", "cuts"}
WITHOUT_EFFECT = ("checkpoint", "output")  # tables of the case that change no number
EXTENSIONS = "extensions.toml"  # in the folder of the sweep: what `extend` has added
DESIGNS = {".ork", ".cdx1", ".step", ".stp", ".iges", ".igs", ".brep", ".stl", ".obj", ".tri"}  # that `alphadot mesh` meshes
UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "in": 0.0254, "ft": 0.3048}  # in metres


@dataclass(frozen=True)
class Run:
    """One call of the program."""

    name: str
    folder: Path
    case: Path  # a case file, or a description or design that is meshed first
    label: str  # first word of the name: the method, unless the sweep file gives another
    method: str
    mach: float
    alpha: float
    beta: float
    mesh: str  # a level such as "medium", a file, or "" for the mesh that the case names
    ranks: int
    settings: dict[str, Value]  # keys of the case that are replaced; the mesh file is not among them
    mesh_mach: tuple[float, float] | None = None  # what a description is meshed for; None: what it says itself
    model: str = ""  # "half" or "full" mesh of a description; "": half where it is symmetric
    deflections: dict[str, float] = field(default_factory=dict)  # of controls, degrees
    panels: dict[str, Value] = field(default_factory=dict)  # the same of a description's sets of fins: a number, or one a panel
    rates: dict[str, float] = field(default_factory=dict)  # p, q, r of a steady turn, times length / 2V, where the sweep speaks of them

    @property
    def verb(self) -> str:
        return "derivatives" if self.method == DERIVATIVES else "run"

    @property
    def is_motion(self) -> bool:
        """Does it march in time?"""
        return self.method not in (DERIVATIVES, STEADY)

    @property
    def is_plain(self) -> bool:
        """With all controls at rest, and no rotation."""
        return not any(self.deflections.values()) and not any(self.rates.values())

    @property
    def is_described(self) -> bool:
        return is_described(self.case)

    @property
    def volume(self) -> bool | None:
        """Is flow.vtkhdf to be written? None where neither the case nor the sweep file speaks of it."""
        case = case_content(self.case)
        own = case.get("output", {}).get("flow") if isinstance(case, dict) else None
        return self.settings.get("output.flow", own)

    def identity(self) -> dict:
        """What decides the numbers that come out: a result counts only for the identity it was computed with."""
        case = case_content(self.case)
        if isinstance(case, dict):
            case = {table: keys for table, keys in case.items() if table not in WITHOUT_EFFECT}
        settings = {key: value for key, value in self.settings.items() if key.split(".")[0] not in WITHOUT_EFFECT}
        more = {"mesh_mach": list(self.mesh_mach)} if self.mesh_mach else {}
        more |= {"model": self.model} if self.model else {}
        more |= {"panels": self.panels} if self.panels else {}
        return {"verb": self.verb, "case": case, "mesh": self.mesh, "settings": settings} | more


@dataclass(frozen=True)
class Sweep:
    """A sweep file, expanded."""

    file: Path
    title: str
    folder: Path
    runs: list[Run]
    content: dict = field(default_factory=dict)  # the file's own, for what is asked of finished runs

    @property
    def name(self) -> str:
        return self.file.stem

    @property
    def symmetry(self) -> set[str]:
        """Planes of symmetry of the configuration: "y" for y = 0, "z" for z = 0."""
        return {"y", "z"} if self.is_axial else set(self.content.get("symmetry", []))

    @property
    def is_axial(self) -> bool:
        """Does the configuration look the same from all sides, as far as its loads go: three or more equal fins, small incidence?"""
        return "axial" in self.content.get("symmetry", [])

    @property
    def unit(self) -> float:
        """Of the mesh, in metres."""
        return UNITS[self.content.get("unit", "m")]

    @property
    def altitudes(self) -> list[float]:
        """Metres above the sea at which loads are wanted."""
        return numbers(str(self.file), "altitude", self.content["altitude"]) if "altitude" in self.content else []

    def find(self, name: str) -> Run:
        for run in self.runs:
            if run.name == name:
                return run
        some = ", ".join(run.name for run in self.runs[:20]) + (", ..." if len(self.runs) > 20 else "")
        raise SweepError(f"{self.file}: has no run '{name}'; it has {some}")


def is_described(case: Path) -> bool:
    """Is there no mesh before `alphadot mesh` makes it?"""
    content = case_content(case)
    return case.suffix.lower() in DESIGNS or (isinstance(content, dict) and ("body" in content or "surface" in content))


def case_content(path: Path) -> Value | dict | None:
    """The case as data, so that comments and layout do not count; as text when it is not TOML, as a hash when it is no text, None
    when it cannot be read."""
    try:
        status = os.stat(path)
    except OSError:
        return None
    return content_at(path, status.st_mtime_ns, status.st_size)


@lru_cache(maxsize=64)
def content_at(path: Path, time: int, size: int) -> Value | dict | None:
    """Thousands of runs share a case."""
    try:
        raw = path.read_bytes()
        text = raw.decode()
        return json.loads(json.dumps(tomllib.loads(text), default=str))
    except tomllib.TOMLDecodeError:
        return text
    except UnicodeDecodeError:
        return "sha256 " + hashlib.sha256(raw).hexdigest()
    except OSError:
        return None


def read_toml(path: Path) -> dict:
    try:
        return tomllib.loads(path.read_text())
    except OSError as error:
        raise SweepError(f"{path}: {error.strerror}") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise SweepError(f"{path}: is not TOML: {error}") from None


def read_sweep(path: Path) -> Sweep:
    """Reads and expands a sweep file together with the extensions in its folder. Raises SweepError."""
    path = path.resolve()
    content = read_toml(path)
    refuse_unknown(path, content, SWEEP_KEYS)
    check_head(path, content)
    folder = (path.parent / content.get("folder", f"runs/{path.stem}")).resolve()
    blocks = list(content.get("runs", []))
    extensions = folder / EXTENSIONS
    extra = read_toml(extensions) if extensions.exists() else {}
    blocks += extra.get("runs", [])
    if not blocks:
        raise SweepError(f"{path}: names no runs; add a [[runs]] block, for example with mach = [1.5, 2.0]")
    defaults = {key: value for key, value in content.items() if key in BLOCK_KEYS}
    controls = content.get("controls", {})
    runs = [run for block in blocks for run in expand(path, folder, defaults, block, controls, extra.get("cycles"))]
    seen: set[str] = set()
    for run in runs:
        if run.name in seen:
            raise SweepError(f"{path}: two runs are called '{run.name}'; give one of their [[runs]] blocks a label")
        seen.add(run.name)
    sweep = Sweep(path, content.get("title", path.stem), folder, runs, content)
    return Sweep(path, sweep.title, folder, without_images(runs, sweep.symmetry), content)


def check_head(path: Path, content: dict) -> None:
    """What the file says about all runs. Raises SweepError."""
    planes = content.get("symmetry", [])
    if not isinstance(planes, list) or set(map(str, planes)) - {"y", "z", "axial"}:
        raise SweepError(
            f'{path}: symmetry lists planes, "y" for y = 0 and "z" for z = 0, or "axial" for what looks alike from all sides, not {planes!r}'
        )
    if content.get("unit", "m") not in UNITS:
        raise SweepError(f"{path}: unit, of the mesh, is one of {', '.join(UNITS)}, not {content['unit']!r}")
    check_mass(path, content.get("mass", []))
    check_cuts(path, content.get("cuts", {}))
    controls = content.get("controls", {})
    for name, sets in controls.items() if isinstance(controls, dict) else [("controls", controls)]:
        good = lambda value: is_number(value) or (isinstance(value, list) and value and all(map(is_number, value)))
        if name in BLOCK_KEYS or not isinstance(sets, dict) or not sets or not all(map(good, sets.values())):
            raise SweepError(
                f"{path}: [controls] {name} must say what a degree of it turns, such as pitch = {{canard = [1, 1, -1, -1]}}: sets of fins"
                " of the description with degrees of all panels, or of each; its name must not be an axis"
            )


def check_cuts(path: Path, places: object) -> None:
    """Where the report cuts the surface. Raises SweepError."""
    numbers = lambda value: isinstance(value, list) and all(map(is_number, value))
    fins = places.get("fins", {}) if isinstance(places, dict) else None
    good = isinstance(fins, dict) and places.keys() <= {"x", "y", "fins"}
    if not good or not all(map(numbers, [*fins.values(), *(places.get(key, []) for key in "xy")])):
        example = "{x = [0.5], y = [0], fins = {fin_1 = [0.5]}}"
        raise SweepError(f"{path}: cuts is like {example}: places in the mesh's unit, and shares of spans")


def check_mass(path: Path, states: object) -> None:
    """States of mass, for the dynamics. Raises SweepError."""
    example = '[[mass]] label = "burnout", mass = 20.0 (kg), inertia = [0.05, 6.0, 6.0] (Ixx, Iyy, Izz about the centre of gravity, kg m2),'
    example += " center = 0.9 (of gravity, x in the mesh's unit)"
    three = lambda value: isinstance(value, list) and len(value) == 3 and all(map(is_number, value))
    for state in states if isinstance(states, list) else [states]:
        good = isinstance(state, dict) and state.keys() - {"label"} == {"mass", "inertia", "center"} and is_number(state["mass"])
        good = good and three(state["inertia"]) and (is_number(state["center"]) or three(state["center"]))
        if not good or min(state["mass"], *state["inertia"]) <= 0.0:
            raise SweepError(f"{path}: mass: each state is like {example}")


def without_images(runs: list[Run], planes: set[str]) -> list[Run]:
    """Runs but for those that are the mirror image of another: tables have them from there. With controls deflected or in a turn there is
    none."""
    if not planes:
        return runs

    def key(run: Run, alpha: float, beta: float) -> tuple:
        rest = {name: value for name, value in run.settings.items() if name not in ("freestream.alpha", "freestream.beta")}
        same = (run.case, run.label, run.method, run.mesh, run.mesh_mach, run.mach, repr(sorted(rest.items())))
        return (*same, round(alpha, 9), round(beta, 9))

    present = {key(run, run.alpha, run.beta) for run in runs if run.is_plain}

    def is_image(run: Run) -> bool:
        alpha = abs(run.alpha) if "z" in planes else run.alpha
        beta = abs(run.beta) if "y" in planes else run.beta
        turned = (alpha, beta) != (run.alpha, run.beta)
        return turned and run.is_plain and key(run, alpha, beta) in present

    return [run for run in runs if not is_image(run)]


def by_path(settings: dict) -> dict:
    """Keys of the case by their whole names: set.output.flow = false is set."output.flow" = false."""
    out: dict = {}
    for name, value in settings.items():
        inner = isinstance(value, dict) and "." not in name
        out |= {f"{name}.{key}": item for key, item in value.items()} if inner and value else {name: value}
    return out


def expand(path: Path, folder: Path, defaults: dict, block: dict, controls: dict, cycles: float | None) -> list[Run]:
    """The runs of one block: every combination of its lists, in the order mesh, controls, method, alpha, beta, Mach."""
    refuse_unknown(path, block, BLOCK_KEYS)
    if any(key in block for key in TOTAL_ANGLES):
        defaults = {key: value for key, value in defaults.items() if key not in BODY_ANGLES}
    elif any(key in block for key in BODY_ANGLES):
        defaults = {key: value for key, value in defaults.items() if key not in TOTAL_ANGLES}
    merged = defaults | block
    rows = matrix(path.parent / merged["matrix"], controls) if "matrix" in merged else [{}]
    given = merged.keys() | (rows[0].keys() if rows else set())
    if given & set(BODY_ANGLES) and given & set(TOTAL_ANGLES):
        raise SweepError(f"{path}: give either alpha and beta, or alpha_t and phi")
    settings = by_path(defaults.get("set", {})) | by_path(block.get("set", {}))
    if not merged.get("case"):
        raise SweepError(f'{path}: names no case; add case = "FILE.toml"')
    case, ranks = (path.parent / merged["case"]).resolve(), merged.get("ranks", 2)
    if not isinstance(ranks, int) or ranks < 1:
        raise SweepError(f"{path}: ranks must be a whole number of at least 1, not {ranks!r}")
    mesh_mach = merged.get("mesh_mach")
    if mesh_mach is not None and (not isinstance(mesh_mach, list) or len(mesh_mach) != 2 or not all(map(is_number, mesh_mach))):
        raise SweepError(f"{path}: mesh_mach is the lowest and the highest Mach number of a mesh, such as [1.5, 2.5], not {mesh_mach!r}")
    model = merged.get("model", "")
    if model not in ("", "half", "full"):
        raise SweepError(f'{path}: model, of the mesh of a description, is "half" or "full", not {model!r}')
    runs = []
    every = points(str(path), merged, rows, controls)
    if not model and any(point.get(key) for point in every for key in ("beta", "p", "r")) and is_described(case):
        model = "full"  # for all of the block: meshes of two kinds would differ by more than the sideslip does
    for point in every:
        method, mesh, mach, alpha, beta = (point[key] for key in ("method", "mesh", "mach", "alpha", "beta"))
        own = {"freestream.mach": mach, "freestream.alpha": alpha}
        own |= {"freestream.beta": beta} if beta or "beta" in given else {}
        rates = {key: point[key] for key in RATES if key in point}
        if any(rates.values()):
            if method not in (DERIVATIVES, STEADY):
                raise SweepError(f"{path}: p, q and r are of steady turns, not of the method {method}")
            own["motion.rotation"] = [rates.get(key, 0.0) for key in RATES]
        panels = panels_of(path, controls, point["deflection"])
        if panels and not is_described(case):
            own |= deflections_of(path, case, panels)
            panels = {}
        own |= settings
        if method != DERIVATIVES:
            own["motion.kind"] = "none" if method == STEADY else method
        if cycles is not None and method not in (DERIVATIVES, STEADY):
            own["unsteady.cycles"] = cycles
        label = merged.get("label", method)
        angles = [f"at{point['alpha_t']:g}", f"phi{point['phi']:g}"] if "alpha_t" in point else [f"a{alpha:g}"]
        angles += [f"b{beta:g}"] if "beta" in given else []
        words = [label, Path(mesh).stem, f"m{mach:g}", *angles, *(f"{key}{value:g}" for key, value in rates.items())]
        words += [f"{name}{value:g}" for name, value in point["deflection"].items()]
        name = "_".join(word for word in words if word)
        if not all(character.isalnum() or character in "._-+" for character in name):
            raise SweepError(f"{path}: '{name}' cannot name a folder; use letters, digits, and . _ - + in label and method")
        runs.append(Run(
            name, folder / name, case, label, method, mach, alpha, beta, mesh, ranks, own,
            tuple(map(float, mesh_mach)) if mesh_mach else None, model, point["deflection"],
            panels, rates,
        ))  # fmt: skip
    if any(run.panels for run in runs) and case.suffix.lower() != ".toml":
        raise SweepError(f"{path}: {case.name} is not a description with [[fins]]: there is nothing that a control can turn")
    return runs


def deflections_of(path: Path, case: Path, panels: dict[str, Value]) -> dict[str, Value]:
    """What turns the [[controls]] of a case file. Raises SweepError."""
    content = case_content(case)
    content = content if isinstance(content, dict) else {}
    known = [control.get("name") for control in content.get("controls", [])]
    for name, degrees in panels.items():
        if name not in known and not content.get("mesh", {}).get("from"):
            own = ", ".join(map(str, known)) or "none"
            what = f"is not a description with [[fins]] '{name}', nor has it such [[controls]]"
            raise SweepError(f"{path}: {case.name} {what}; there are {own}")
        if isinstance(degrees, list):
            what = "is a case file: [controls] gives degrees of its [[controls]] one by one"
            raise SweepError(f"{path}: {case.name} {what}, not {name} = {degrees}")
    return {f"deflections.{name}": degrees for name, degrees in panels.items()}


def panels_of(path: Path, controls: dict, deflection: dict[str, float]) -> dict[str, Value]:
    """Degrees by set of fins, of all panels or of each, that the deflected controls make together; nothing for those that stay. Raises
    SweepError."""
    out: dict[str, Value] = {}
    for control, degrees in deflection.items():
        for name, shares in controls[control].items():
            parts = [degrees * share for share in shares] if isinstance(shares, list) else degrees * shares
            known = out.get(name, 0.0)
            if isinstance(known, list) and isinstance(parts, list) and len(known) != len(parts):
                raise SweepError(f"{path}: [controls] speak of {len(known)} and of {len(parts)} panels of '{name}'")
            if isinstance(known, list) or isinstance(parts, list):
                count = len(known if isinstance(known, list) else parts)
                both = (value if isinstance(value, list) else [value] * count for value in (known, parts))
                out[name] = [a + b for a, b in zip(*both)]
            else:
                out[name] = known + parts
    return {name: turn for name, turn in out.items() if any(turn if isinstance(turn, list) else [turn])}


def refuse_unknown(path: Path, content: dict, known: set[str]) -> None:
    unknown = sorted(content.keys() - known)
    if unknown:
        raise SweepError(f"{path}: unknown key {', '.join(unknown)}; known are {', '.join(sorted(known))}")
