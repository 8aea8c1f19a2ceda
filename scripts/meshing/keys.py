"""The keys of a description: kinds, defaults, meanings, and how a table is checked against them."""

from __future__ import annotations

import difflib
import math
from dataclasses import dataclass
from typing import Any

from meshing.toml_file import Place, TomlFile


class Refused(Exception):
    """A value is not what its key wants; the message says what that is."""


@dataclass(frozen=True)
class Number:
    """A finite number within bounds; `above` and `below` are not reached."""

    above: float = -math.inf
    below: float = math.inf
    least: float = -math.inf
    most: float = math.inf

    def check(self, value: Any) -> float:
        inside = (
            isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)
            and self.above < value < self.below and self.least <= value <= self.most
        )  # fmt: skip
        if not inside:
            raise Refused(f"must be {self.text()}")
        return float(value)

    def text(self) -> str:
        parts = [f"above {self.above:g}" if self.above > -math.inf else "", f"at least {self.least:g}" if self.least > -math.inf else ""]
        parts += [f"below {self.below:g}" if self.below < math.inf else "", f"at most {self.most:g}" if self.most < math.inf else ""]
        return " ".join(["a number", " and ".join(part for part in parts if part)]).strip()


@dataclass(frozen=True)
class Whole:
    """A whole number from `least` to `most`."""

    least: int
    most: int

    def check(self, value: Any) -> int:
        if not isinstance(value, int) or isinstance(value, bool) or not self.least <= value <= self.most:
            raise Refused(f"must be {self.text()}")
        return value

    def text(self) -> str:
        return f"a whole number from {self.least} to {self.most}"


@dataclass(frozen=True)
class Word:
    """One of some words."""

    words: tuple[str, ...]

    def check(self, value: Any) -> str:
        if value not in self.words:
            near = difflib.get_close_matches(str(value), self.words, 1)
            raise Refused(f"must be {self.text()}" + (f"; did you mean '{near[0]}'?" if near else ""))
        return value

    def text(self) -> str:
        return "one of " + ", ".join(self.words)


@dataclass(frozen=True)
class Name:
    """A name for a patch: letters, digits, _ and -."""

    def check(self, value: Any) -> str:
        if not isinstance(value, str) or not value or not all(c.isascii() and (c.isalnum() or c in "_-") for c in value):
            raise Refused(f"must be {self.text()}")
        return value

    def text(self) -> str:
        return "a name of letters, digits, _ and -"


@dataclass(frozen=True)
class Text:
    """Any text."""

    def check(self, value: Any) -> str:
        if not isinstance(value, str):
            raise Refused(f"must be {self.text()}")
        return value

    def text(self) -> str:
        return "text"


@dataclass(frozen=True)
class Switch:
    """true or false."""

    def check(self, value: Any) -> bool:
        if not isinstance(value, bool):
            raise Refused(f"must be {self.text()}")
        return value

    def text(self) -> str:
        return "true or false"


@dataclass(frozen=True)
class Numbers:
    """A list of numbers, or one number alone where `single`."""

    each: Number
    least: int
    most: int
    single: bool = False

    def check(self, value: Any) -> list[float]:
        values = [value] if self.single and not isinstance(value, list) else value
        if not isinstance(values, list) or not self.least <= len(values) <= self.most:
            raise Refused(f"must be {self.text()}")
        try:
            return [self.each.check(one) for one in values]
        except Refused:
            raise Refused(f"must be {self.text()}") from None

    def text(self) -> str:
        count = f"{self.least}" if self.least == self.most else f"{self.least} to {self.most}"
        return f"a list of {count} numbers, each {self.each.text()}" + (", or one alone" if self.single else "")


@dataclass(frozen=True)
class Points:
    """A list of pairs of numbers, such as [[0, 0], [1, 0.5]]."""

    least: int

    def check(self, value: Any) -> list[tuple[float, float]]:
        try:
            points = [(float(a), float(b)) for a, b in value]
        except (TypeError, ValueError):
            raise Refused(f"must be {self.text()}") from None
        if len(points) < self.least or not all(math.isfinite(c) for point in points for c in point):
            raise Refused(f"must be {self.text()}")
        return points

    def text(self) -> str:
        return f"a list of at least {self.least} pairs of numbers, such as [[0, 0], [1, 0.5]]"


@dataclass(frozen=True)
class Axes:
    """Three of x, y and z, each once and with a sign, such as ["-x", "y", "-z"], that a rotation makes of them."""

    def check(self, value: Any) -> list[str]:
        words = value if isinstance(value, list) and len(value) == 3 and all(isinstance(word, str) for word in value) else []
        if not words or sorted(word.removeprefix("-") for word in words) != ["x", "y", "z"]:
            raise Refused(f"must be {self.text()}")
        order = ["xyz".index(word[-1]) for word in words]
        turns = sum(order[i] > order[j] for i, j in ((0, 1), (0, 2), (1, 2))) + sum(word.startswith("-") for word in words)
        if turns % 2:
            raise Refused("is a mirror image, no rotation: turn one sign about, or swap two axes")
        return words

    def text(self) -> str:
        return 'three axes with their signs, such as ["-x", "y", "-z"]'


REQUIRED = object()  # the default of a key that must be there


@dataclass(frozen=True)
class Key:
    """A key of a table: what it takes, its default (None: see the meaning), and what it means."""

    kind: Any
    default: Any
    meaning: str


Schema = dict[str, Key]


def read_table(file: TomlFile, place: Place, raw: Any, schema: Schema, problems: list[str]) -> dict[str, Any]:
    """The values of a table, defaults filled in. What is wrong is added to `problems`; its keys are then None."""
    title = f"[[{place.table}]]" if place.index is not None else f"[{place.table}]" if place.table else "the file"
    if not isinstance(raw, dict):
        problems.append(f"{file.where(place)}: {title} must be a table")
        raw = {}
    for key in raw.keys() - schema.keys():
        near = difflib.get_close_matches(key, schema, 1)
        remedy = f"did you mean '{near[0]}'?" if near else f"it has {', '.join(schema)}"
        problems.append(f"{file.where(place, key)}: {title} has no key '{key}'; {remedy}")
    values = {}
    for key, entry in schema.items():
        values[key] = None if entry.default is REQUIRED else entry.default
        if key in raw:
            try:
                values[key] = entry.kind.check(raw[key])
            except Refused as error:
                problems.append(f"{file.where(place, key)}: {key} = {shown(raw[key])}: {error}")
                values[key] = None
        elif entry.default is REQUIRED:
            problems.append(f"{file.where(place)}: {title} needs the key '{key}', {entry.kind.text()}: {entry.meaning}")
    return values


def shown(value: Any) -> str:
    """A value as it stands in the file, cut when long."""
    text = str(value).lower() if isinstance(value, bool) else f'"{value}"' if isinstance(value, str) else str(value)
    return text if len(text) <= 60 else text[:57] + "..."


def described(title: str, schema: Schema) -> str:
    """The keys of one table, one a line: name, kind, default and meaning."""
    lines = [title]
    for key, entry in schema.items():
        if entry.default is REQUIRED:
            default = "required"
        elif entry.default is None:
            default = "no default"
        else:
            default = f"default {shown(entry.default)}"
        lines.append(f"  {key:16} {entry.meaning}; {entry.kind.text()}; {default}")
    return "\n".join(lines)
