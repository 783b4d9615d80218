"""The numbers of a walk against published ranges, with the cycles that were counted and those left out."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.names import Side
from exo_pin.errors import GaitError
from exo_pin.gait import Gait, Norm, Number, Stride, against_normal, normal, strides
from exo_pin.gait.reference_values import CITATIONS
from exo_pin.kinematics.plate_contacts import spatiotemporal
from exo_pin.robot import Robot


@dataclass(frozen=True, eq=False, kw_only=True)
class WalkNumbers:
    """Spatiotemporal numbers of a walk, each with its usual range where a publication has one.

    Attributes:
        strides: Every span between two heel strikes of a foot, left foot first.
        numbers: By name; empty where the walk has no cycles.
        usual: The usual range of a number, by name.
        verdicts: `within`, `below` or `above` the usual range, by name.
        missing: Why there are no numbers; empty where there are.
    """

    strides: tuple[Stride, ...] = ()
    numbers: Mapping[str, Number] = field(default_factory=dict)
    usual: Mapping[str, Norm] = field(default_factory=dict)
    verdicts: Mapping[str, str] = field(default_factory=dict)
    missing: str = ""

    @property
    def cycles(self) -> dict[Side, int]:
        """How many cycles each foot has; empty where the walk has none."""
        if self.missing:
            return {}
        return {side: sum(x.side == side and not x.why for x in self.strides) for side in SIDES}

    @property
    def left_out(self) -> tuple[Stride, ...]:
        """Spans that are no strides of a walk: pauses, turns, missed events."""
        return tuple(x for x in self.strides if x.why)

    @property
    def citations(self) -> dict[str, str]:
        """The publications of the usual ranges, by the key that a range has as its source."""
        used = {x.source for x in self.usual.values()}
        return {key: text for key, text in CITATIONS.items() if key in used}


def walk_numbers(robot: Robot, gait: Gait) -> WalkNumbers:
    """The numbers of a walk; lengths are those of this robot's legs.

    Without a body the leg length is unknown: then only the speed has a usual range.
    """
    try:
        numbers = spatiotemporal(robot, gait)
    except GaitError as error:
        return WalkNumbers(missing=str(error))
    leg_length = robot.body.leg_length if robot.body else math.nan
    return WalkNumbers(
        strides=tuple(x for side in SIDES for x in strides(gait, side)),
        numbers=numbers,
        usual=normal(numbers, leg_length=leg_length),
        verdicts=against_normal(numbers, leg_length=leg_length),
    )
