"""Concessions of a walk to a device: the knee at its stop, a slower or a smaller walk."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from exo_pin.anatomy.names import ConcessionKind
from exo_pin.feasible.amplitude import with_amplitude
from exo_pin.feasible.feasibility import Feasibility
from exo_pin.feasible.knee_stop import HeldKnees
from exo_pin.gait import Gait

LEAST_SHARE = 0.5
"""Less than this share of the recorded cadence or amplitude is no concession but another walk (a choice)."""

_HUNDREDTHS = 100


@dataclass(frozen=True)
class Concession:
    """What the walk must give up so that the device can do it.

    Attributes:
        what: The kind.
        how_much: Largest distance of a foot [mm], or the factor on cadence or amplitude.
        unit: `"mm"` or `"times"`.
        note: Feet and frames, or the reason.
    """

    what: ConcessionKind
    how_much: float
    unit: str
    note: str

    @property
    def words(self) -> str:
        """The concession in words, with its reason."""
        if self.what == "knee held at its stop":
            return f"{self.what}: {self.note}"
        return f"{self.what} {self.how_much:.2f} ({self.note})"

    def facts(self) -> dict[str, Any]:
        """Plain values for JSON."""
        return {"what": self.what, "how_much": self.how_much, "unit": self.unit}


def knee_concession(held: HeldKnees) -> Concession:
    """The concession of knees that are held at their stop."""
    return Concession("knee held at its stop", 1e3 * float(held.moved.max()), "mm", held.words)


def other_walks(gait: Gait, found: Feasibility) -> list[tuple[Concession, Gait]]:
    """Slower and smaller walks that the limits allow, the one nearest to the walk first."""
    why = "; ".join(dict.fromkeys(f"{failure.what}: {failure.how}" for failure in found.failures))
    cadence = floored(found.cadence) if found.cadence_decides else 0.0
    amplitude = floored(found.amplitude) if found.amplitude_decides else 0.0
    slower = (Concession("cadence", cadence, "times", why), gait.slowed(1.0 / max(cadence, LEAST_SHARE)))
    smaller = (Concession("amplitude", amplitude, "times", why), with_amplitude(gait, amplitude))
    nearest_first = sorted((slower, smaller), key=lambda pair: -pair[0].how_much)
    return [pair for pair in nearest_first if LEAST_SHARE <= pair[0].how_much < 1.0]


def floored(factor: float) -> float:
    """The factor in whole hundredths, never larger."""
    return math.floor(_HUNDREDTHS * factor) / _HUNDREDTHS
