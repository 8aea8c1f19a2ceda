"""TOML files whose tables and keys know their lines, so that an error can name them."""

from __future__ import annotations

import re
import tomllib
from dataclasses import dataclass
from pathlib import Path

from meshing.tetrahedra import MeshError

HEADER = re.compile(r"\s*(\[\[|\[)\s*([^\[\]]+?)\s*\]")
KEY = re.compile(r"\s*([A-Za-z0-9_-]+|\"[^\"]*\")(\s*\.\s*[A-Za-z0-9_-]+)*\s*=")


class DescriptionError(MeshError):
    """Mistakes of a description: one line each, with file, line, what is wrong and what to do."""

    def __init__(self, problems: list[str]) -> None:
        super().__init__("\n".join(problems))
        self.problems = problems


@dataclass(frozen=True)
class Place:
    """A table of a TOML file: ("fins", 1) is the second [[fins]], ("flight", None) is [flight], ("", None) the top."""

    table: str
    index: int | None = None


class TomlFile:
    """A TOML file that has been read: `content`, and the line of everything in it. Raises DescriptionError."""

    def __init__(self, path: Path) -> None:
        self.path = path
        try:
            text = path.read_text()
            self.content = tomllib.loads(text)
        except OSError as error:
            raise DescriptionError([f"{path}: {error.strerror}"]) from None
        except UnicodeDecodeError:
            raise DescriptionError([f"{path}: is not a text file"]) from None
        except tomllib.TOMLDecodeError as error:
            place = re.search(r"\(at line (\d+), column \d+\)", str(error))
            what = re.sub(r" \(at .*\)", "", str(error))
            raise DescriptionError([f"{path}:{place[1] if place else 1}: is not TOML: {what}"]) from None
        self._lines: dict[tuple[Place, str], int] = {}
        self._find_lines(text)

    def _find_lines(self, text: str) -> None:
        place, counts = Place(""), {}
        for number, line in enumerate(text.splitlines(), start=1):
            if header := HEADER.match(line):
                name, index = header[2], None
                if header[1] == "[[":
                    index = counts[name] = counts.get(name, -1) + 1
                place = Place(name, index)
                self._lines.setdefault((place, ""), number)
            elif key := KEY.match(line):
                self._lines.setdefault((place, key[1].strip('"')), number)

    def where(self, place: Place, key: str = "") -> str:
        """"FILE:LINE" of a key, or of its table where the key is missing."""
        table = self._lines.get((place, ""), self._lines.get((Place(""), place.table), 1))  # the latter: an inline table
        line = self._lines.get((place, key), table)
        return f"{self.path}:{line}"
