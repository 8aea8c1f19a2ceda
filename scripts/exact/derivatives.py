"""The longitudinal derivatives of one body, and how they change with centre and reference length."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass

GAMMA = 1.4


class NoExactFlow(ValueError):
    """The theory does not cover this body at this Mach number."""


@dataclass(frozen=True)
class Longitudinal:
    """Per radian, rates times length / 2V, Cm nose up."""

    CN_alpha: float
    Cm_alpha: float
    CN_q: float
    Cm_q: float
    CN_alphadot: float
    Cm_alphadot: float

    @classmethod
    def of(cls, derivatives: Mapping[str, float]) -> Longitudinal:
        """Those among others."""
        return cls(**{name: derivatives[name] for name in cls.__dataclass_fields__})

    def about(self, dx: float) -> Longitudinal:
        """The same about a centre, which is also the axis of rotation, `dx` reference lengths further aft."""
        turned = self.CN_q - 2.0 * dx * self.CN_alpha, self.Cm_q - 2.0 * dx * self.Cm_alpha  # rotation also translates the body
        return Longitudinal(
            self.CN_alpha, self.Cm_alpha + dx * self.CN_alpha,
            turned[0], turned[1] + dx * turned[0],
            self.CN_alphadot, self.Cm_alphadot + dx * self.CN_alphadot,
        )  # fmt: skip

    def per(self, length: float) -> Longitudinal:
        """The same with another reference length, in units of the one before."""
        return Longitudinal(
            self.CN_alpha, self.Cm_alpha / length,
            self.CN_q / length, self.Cm_q / length**2,
            self.CN_alphadot / length, self.Cm_alphadot / length**2,
        )  # fmt: skip

    def as_dict(self) -> dict[str, float]:
        """Name -> value."""
        return asdict(self)
