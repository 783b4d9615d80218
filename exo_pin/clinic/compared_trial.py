"""A trial among others: its cycles, scores and numbers, and how two trials differ against their spread."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from exo_pin.clinic.clinical_cycles import ClinicalCycles
from exo_pin.clinic.gait_profile import GaitProfile
from exo_pin.gait import Number
from exo_pin.kinematics import WalkNumbers

_ROUNDING = 1e-6
"""A spread below this part of the difference is that of cycles that repeat, not of a person."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Trial:
    """One walk of a person.

    Attributes:
        name: What it is called.
        sides: Its clinical cycles.
        profile: Its scores; None without a normal band.
        numbers: Its spatiotemporal numbers.
        session: Who, where and when, by its file.
    """

    name: str
    sides: tuple[ClinicalCycles, ...]
    profile: GaitProfile | None
    numbers: WalkNumbers
    session: Mapping[str, str]


@dataclass(frozen=True)
class Change:
    """A number of a trial less that of an earlier one.

    Attributes:
        value: The difference, in the number's unit.
        spread: Mean standard deviation from cycle to cycle of both (root mean square); NaN where one of them
            has a single value.
    """

    value: float
    spread: float

    @property
    def in_spreads(self) -> float:
        """The difference as a multiple of the spread; NaN where that is unknown, or zero but for rounding."""
        return self.value / self.spread if self.spread > _ROUNDING * abs(self.value) else math.nan


def change(before: Number, after: Number) -> Change:
    """How a number changed.

    Args:
        before: Of the first trial.
        after: Of the later one, in the same unit.
    """
    return Change(after.mean - before.mean, math.sqrt((before.sd**2 + after.sd**2) / 2))
