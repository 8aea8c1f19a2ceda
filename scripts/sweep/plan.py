"""The sweep file: what is to be run, each run with its name, folder and settings."""

from __future__ import annotations

import itertools
import json
import tomllib
from dataclasses import dataclass
from pathlib import Path

Value = bool | int | float | str | list
DERIVATIVES, STEADY = "derivatives", "steady"  # methods; any other is a kind of motion
BLOCK_KEYS = {"label", "case", "mesh", "method", "mach", "alpha", "ranks", "set"}
SWEEP_KEYS = BLOCK_KEYS - {"label"} | {"title", "folder", "runs"}
WITHOUT_EFFECT = ("checkpoint", "output")  # tables of the case that change no number
EXTENSIONS = "extensions.toml"  # in the folder of the sweep: what `extend` has added


class SweepError(Exception):
    """A mistake of the user: what is wrong, where, and what to do."""


@dataclass(frozen=True)
class Run:
    """One call of the program."""

    name: str
    folder: Path
    case: Path
    label: str  # first word of the name: the method, unless the sweep file gives another
    method: str
    mach: float
    alpha: float
    mesh: str  # a level such as "medium", a file, or "" for the mesh that the case names
    ranks: int
    settings: dict[str, Value]  # keys of the case that are replaced; the mesh file is not among them

    @property
    def verb(self) -> str:
        return "derivatives" if self.method == DERIVATIVES else "run"

    @property
    def is_motion(self) -> bool:
        """Does it march in time?"""
        return self.method not in (DERIVATIVES, STEADY)

    def identity(self) -> dict:
        """What decides the numbers that come out: a result counts only for the identity it was computed with."""
        case = case_content(self.case)
        if isinstance(case, dict):
            case = {table: keys for table, keys in case.items() if table not in WITHOUT_EFFECT}
        settings = {key: value for key, value in self.settings.items() if key.split(".")[0] not in WITHOUT_EFFECT}
        return {"verb": self.verb, "case": case, "mesh": self.mesh, "settings": settings}


@dataclass(frozen=True)
class Sweep:
    """A sweep file, expanded."""

    file: Path
    title: str
    folder: Path
    runs: list[Run]

    @property
    def name(self) -> str:
        return self.file.stem

    def find(self, name: str) -> Run:
        for run in self.runs:
            if run.name == name:
                return run
        raise SweepError(f"{self.file}: has no run '{name}'; it has {', '.join(run.name for run in self.runs)}")


def case_content(path: Path) -> Value | dict | None:
    """The case as data, so that comments and layout do not count; as text when it is not TOML, None when it cannot be read."""
    try:
        return json.loads(json.dumps(tomllib.loads(path.read_text()), default=str))
    except tomllib.TOMLDecodeError:
        return path.read_text()
    except (OSError, UnicodeDecodeError):
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
    folder = path.parent / content.get("folder", f"runs/{path.stem}")
    blocks = list(content.get("runs", []))
    extensions = folder / EXTENSIONS
    extra = read_toml(extensions) if extensions.exists() else {}
    blocks += extra.get("runs", [])
    if not blocks:
        raise SweepError(f"{path}: names no runs; add a [[runs]] block, for example with mach = [1.5, 2.0]")
    defaults = {key: value for key, value in content.items() if key in BLOCK_KEYS}
    runs = [run for block in blocks for run in expand(path, folder.resolve(), defaults, block, extra.get("cycles"))]
    seen: set[str] = set()
    for run in runs:
        if run.name in seen:
            raise SweepError(f"{path}: two runs are called '{run.name}'; give one of their [[runs]] blocks a label")
        seen.add(run.name)
    return Sweep(path, content.get("title", path.stem), folder.resolve(), runs)


def expand(path: Path, folder: Path, defaults: dict, block: dict, cycles: float | None) -> list[Run]:
    """The runs of one block: every combination of its lists, in the order mesh, method, alpha, Mach."""
    refuse_unknown(path, block, BLOCK_KEYS)
    merged = defaults | block
    settings = defaults.get("set", {}) | block.get("set", {})
    axes = [as_list(path, merged, key) for key in ("mesh", "method", "alpha", "mach")]
    runs = []
    for mesh, method, alpha, mach in itertools.product(*axes):
        own = {"freestream.mach": mach, "freestream.alpha": alpha} | settings
        if method != DERIVATIVES:
            own["motion.kind"] = "none" if method == STEADY else method
        if cycles is not None and method not in (DERIVATIVES, STEADY):
            own["unsteady.cycles"] = cycles
        label = merged.get("label", method)
        words = [label, Path(mesh).stem, f"m{mach:g}", f"a{alpha:g}"]
        name = "_".join(word for word in words if word)
        if not all(character.isalnum() or character in "._-+" for character in name):
            raise SweepError(f"{path}: '{name}' cannot name a folder; use letters, digits, and . _ - + in label and method")
        case, ranks = path.parent / merged.get("case", ""), merged.get("ranks", 2)
        if not merged.get("case"):
            raise SweepError(f'{path}: names no case; add case = "FILE.toml"')
        if not isinstance(ranks, int) or ranks < 1:
            raise SweepError(f"{path}: ranks must be a whole number of at least 1, not {ranks!r}")
        runs.append(Run(name, folder / name, case.resolve(), label, method, mach, alpha, mesh, ranks, own))
    return runs


def as_list(path: Path, block: dict, key: str) -> list:
    """The values of an axis of the sweep, checked."""
    default = {"mesh": "", "method": DERIVATIVES, "alpha": 0.0}
    if key not in block and key not in default:
        raise SweepError(f"{path}: a [[runs]] block has no {key}; for example {key} = [1.5, 2.0]")
    value = block.get(key, default.get(key))
    values = value if isinstance(value, list) else [value]
    wanted = str if key in ("mesh", "method") else (int, float)
    if not values or not all(isinstance(item, wanted) and not isinstance(item, bool) for item in values):
        raise SweepError(f"{path}: {key} must be {'text' if wanted is str else 'a number'} or a list of it, not {value!r}")
    return values if wanted is str else [float(item) for item in values]


def refuse_unknown(path: Path, content: dict, known: set[str]) -> None:
    unknown = sorted(content.keys() - known)
    if unknown:
        raise SweepError(f"{path}: unknown key {', '.join(unknown)}; known are {', '.join(sorted(known))}")
