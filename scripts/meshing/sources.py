"""What a mesh comes from: the files of a description, and a hash that tells when one of them has changed."""

from __future__ import annotations

import hashlib
import tomllib
from collections.abc import Iterable
from pathlib import Path


def files_of(description: Path) -> list[Path]:
    """The description, and the files beside it that it takes its body and names from, where they are."""
    surface = description
    if description.suffix.lower() == ".toml":
        try:
            named = tomllib.loads(description.read_text()).get("surface", {}).get("file")
        except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError, AttributeError):
            return [description]  # the reader will say what is wrong
        if isinstance(named, str):
            surface = description.parent / named
    files = [description] if surface == description else [description, surface]
    if surface.suffix.lower() == ".tri":
        files.append(surface.with_name("Config.xml"))
    return [file for file in files if file == description or file.is_file()]


def digest_of(files: Iterable[Path], asked: object = None) -> str:
    """Of their contents, and of what else is asked for. Raises OSError."""
    hashed = hashlib.sha256(repr(asked).encode())
    for file in files:
        hashed.update(hashlib.sha256(file.read_bytes()).digest())
    return hashed.hexdigest()[:12]
