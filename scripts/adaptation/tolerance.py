"""What is asked for: derivatives, and how small their intervals shall be."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass

NUMBER = r"[0-9.]+(?:[eE][+-]?[0-9]+)?"


class ToleranceError(Exception):
    """What is wrong, and what to write instead."""


@dataclass(frozen=True)
class Tolerance:
    """Half width of an interval: a number, or a share of a derivative: of its own (""), or of another."""

    size: float
    of: str | None = None

    def half_width(self, name: str, values: Mapping[str, float]) -> float:
        """That is asked for of the derivative `name`."""
        return self.size if self.of is None else self.size * abs(values[self.of or name])

    def text(self) -> str:
        return f"{self.size:g}" if self.of is None else f"{100.0 * self.size:g}%{self.of}"


def read_tolerance(text: str) -> Tolerance:
    """ "1%" of the derivative itself, "2%CN_alphadot" of another, "0.4". Raises ToleranceError."""
    match = re.fullmatch(rf"({NUMBER})(%(\w*))?", text.strip())
    size = float(match[1]) if match and match[1].count(".") <= 1 and match[1] != "." else math.nan
    if not size > 0.0:
        raise ToleranceError(f"'{text}' is no tolerance: write 1% of the derivative itself, 2%CN_alphadot of another, or a number")
    return Tolerance(size / 100.0, match[3]) if match[2] else Tolerance(size)


def read_tolerances(text: str, goals: list[str]) -> dict[str, Tolerance]:
    """Of each goal: "1%", or with some of their own, "1%,Cm_alphadot=0.4". Raises ToleranceError."""
    common, own = None, {}
    for part in text.split(","):
        name, equals, value = part.rpartition("=")
        if not equals:
            if common is not None:
                raise ToleranceError(f"'{text}' has two tolerances for all goals: write 1%,Cm_alphadot=0.4 for one of its own")
            common = read_tolerance(value)
        elif name.strip() not in goals:
            raise ToleranceError(f"'{name.strip()}' is none of the goals {', '.join(goals)}: name it with --goals, too")
        else:
            own[name.strip()] = read_tolerance(value)
    missing = [goal for goal in goals if goal not in own]
    if missing and common is None:
        raise ToleranceError(f"'{text}' says nothing of {', '.join(missing)}: write 1%,{text}")
    return {goal: own.get(goal, common) for goal in goals}
