"""Numbers and tables as text."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence


def duration(seconds: float) -> str:
    """ "1 h 02 min", "3 min 20 s", "12 s"."""
    whole = round(seconds)
    if whole >= 3600:
        return f"{whole // 3600} h {whole // 60 % 60:02} min"
    if whole >= 60:
        return f"{whole // 60} min {whole % 60:02} s"
    return f"{whole} s"


def size(bytes_: float) -> str:
    """ "12 kB", "3.4 MB", "120 GB"."""
    for unit in ("B", "kB", "MB"):
        if bytes_ < 999.5:
            return f"{bytes_:.3g} {unit}"
        bytes_ /= 1000.0
    return f"{bytes_:,.3g} GB" if bytes_ < 999.5 else f"{bytes_:,.0f} GB"


def aligned(rows: Sequence[Sequence[str]]) -> str:
    """Rows of text with their columns aligned to the left."""
    widths = [max(map(len, column)) for column in zip(*rows)]
    return "\n".join("  ".join(f"{cell:<{width}}" for cell, width in zip(row, widths)).rstrip() for row in rows)


def toml_value(value: object) -> str:
    """A value as TOML has it, tables inline."""
    if isinstance(value, list):
        return "[" + ", ".join(map(toml_value, value)) + "]"
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{toml_key(key)} = {toml_value(item)}" for key, item in value.items()) + " }"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    return str(value).lower() if isinstance(value, bool) else str(value)


def toml_key(key: str) -> str:
    return key if re.fullmatch(r"[A-Za-z0-9_-]+", key) else json.dumps(key, ensure_ascii=False)


def toml_document(content: dict) -> str:
    """A TOML file; lists of tables as [[tables]], after everything else."""
    is_array = lambda value: isinstance(value, list) and value and all(isinstance(item, dict) for item in value)
    lines = [f"{toml_key(key)} = {toml_value(value)}" for key, value in content.items() if not is_array(value)]
    for key, tables in content.items():
        for table in tables if is_array(tables) else []:
            lines += [f"\n[[{toml_key(key)}]]", *(f"{toml_key(name)} = {toml_value(value)}" for name, value in table.items())]
    return "\n".join(lines) + "\n"
