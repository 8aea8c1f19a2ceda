"""Numbers and tables as text."""

from __future__ import annotations

from collections.abc import Sequence


def duration(seconds: float) -> str:
    """ "1 h 02 min", "3 min 20 s", "12 s"."""
    whole = round(seconds)
    if whole >= 3600:
        return f"{whole // 3600} h {whole // 60 % 60:02} min"
    if whole >= 60:
        return f"{whole // 60} min {whole % 60:02} s"
    return f"{whole} s"


def aligned(rows: Sequence[Sequence[str]]) -> str:
    """Rows of text with their columns aligned to the left."""
    widths = [max(map(len, column)) for column in zip(*rows)]
    return "\n".join("  ".join(f"{cell:<{width}}" for cell, width in zip(row, widths)).rstrip() for row in rows)
