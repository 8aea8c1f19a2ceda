"""A picture of a report."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Picture:
    """A figure as files, FOLDER/NAME.svg or .png or both; the page shows `file`."""

    file: Path
    title: str
    caption: str = ""
