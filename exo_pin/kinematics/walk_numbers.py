"""Spatiotemporal numbers of a walk by the paths of its feet, and against published ranges."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.names import Manner, Side
from exo_pin.arrays import Array
from exo_pin.errors import GaitError
from exo_pin.gait import (
    Gait,
    Norm,
    Number,
    Stride,
    StrideEstimate,
    against_normal,
    manner,
    normal,
    walk_estimate,
)
from exo_pin.gait.estimated_numbers import estimated_numbers
from exo_pin.gait.manner import contacts_are_measured
from exo_pin.gait.marked_feet import FootMarkers
from exo_pin.gait.published_ranges import CITATIONS
from exo_pin.gait.spatiotemporal import spatiotemporal as numbers_of
from exo_pin.gait.strides import counted_strides, strides_of_both, unrolled
from exo_pin.gait.toe_clearance import toe_clearances
from exo_pin.kinematics.sole_contact import recorded_height, with_events
from exo_pin.kinematics.sole_points import sole_points
from exo_pin.robot import Robot
from exo_pin.short_repr import short_repr

ON_THE_MODEL = "model's feet"
"""Where lengths are measured without markers: at the heel of the sole, the ball for clearance."""


@dataclass(frozen=True, eq=False, kw_only=True)
class WalkNumbers:
    """Spatiotemporal numbers of a walk, each with its usual range where a publication has one.

    Attributes:
        strides: Every span between two heel strikes of a foot, left foot first.
        numbers: By name; empty where the walk has no cycles.
        usual: The usual range of a number, by name.
        verdicts: `within`, `below` or `above` the usual range, by name.
        measured: Where each length, speed and width was measured, by name.
        missing: Why there are no numbers; empty where there are.
        estimate: The stride that the numbers stand for where no foot has a whole cycle; None where one has.
        manner: Walk or run.
        unknown: Which numbers are left out, and why; empty where none is.
    """

    strides: tuple[Stride, ...] = ()
    numbers: Mapping[str, Number] = field(default_factory=dict)
    usual: Mapping[str, Norm] = field(default_factory=dict)
    verdicts: Mapping[str, str] = field(default_factory=dict)
    measured: Mapping[str, str] = field(default_factory=dict)
    missing: str = ""
    estimate: StrideEstimate | None = None
    manner: Manner = "walk"
    unknown: str = ""

    __repr__ = short_repr

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


_UNKNOWN = (
    "stance, swing and flight of a run are left out: kinematics find its contacts within some 20 ms "
    "(Handsaker 2016, Fellin 2010), a tenth of a stance; force plates measure them (--forces)"
)

_OF_CONTACT = ("stance", "swing", "stance_symmetry", "double_support", "flight")
"""Ends of the names of numbers that need to know how long a foot stands."""


def walk_numbers(robot: Robot, gait: Gait, feet: FootMarkers | None = None) -> WalkNumbers:
    """The numbers of a walk; lengths by the markers of the feet, else those of this robot's legs.

    Where no foot has a whole cycle they are those of an estimated stride (`exo_pin.gait.half_strides`).
    Without a body the leg length is unknown: then only the speed has a usual range.

    Args:
        robot: On the person's body.
        gait: The walk.
        feet: Heel and toe markers of its trial.
    """
    try:
        gait = with_events(robot, gait)
        how, estimate, walk = manner(gait), walk_estimate(gait), unrolled(gait)
        soles = sole_points(robot, walk)
        numbers = _known(gait, how, _numbers(gait, estimate, walk.time, soles[:, :, 0]))
    except GaitError as error:
        return WalkNumbers(missing=str(error))
    seen = {name: (number, ON_THE_MODEL) for name, number in numbers.items() if _is_length(number)}
    if feet is not None:
        seen |= _at_markers(gait, estimate, feet)
    if how == "walk":
        seen |= _clearances(gait, soles[: len(gait), :, 1], feet)
    found = WalkNumbers(
        strides=strides_of_both(gait),
        numbers=numbers | {name: number for name, (number, _) in seen.items()},
        measured={name: where for name, (_, where) in seen.items()},
        estimate=estimate,
        manner=how,
    )
    if how == "run":  # the published ranges are those of walks
        return replace(found, unknown="" if contacts_are_measured(gait) else _UNKNOWN)
    leg_length, stature = (robot.body.leg_length, robot.body.stature) if robot.body else 2 * (math.nan,)
    return replace(
        found,
        usual=normal(found.numbers, leg_length=leg_length, stature=stature),
        verdicts=against_normal(found.numbers, leg_length=leg_length, stature=stature),
    )


def spatiotemporal(robot: Robot, gait: Gait) -> dict[str, Number]:
    """Cadence, speed, lengths, width and phases of a gait; see `exo_pin.gait.spatiotemporal`.

    Events are the gait's own, or those of its kinematics. Lengths are those of this robot's legs. Where no
    foot has a whole cycle the numbers are those of an estimated stride, as of `walk_numbers`.

    Pauses, turns and other spans that are no strides (`exo_pin.gait.strides`) are left out, and of a run
    whose contacts come from kinematics alone what needs them: stance, swing, flight.

    Raises:
        GaitError: There are no gait cycles, and no stride can be estimated.
    """
    gait = with_events(robot, gait)
    walk = unrolled(gait)
    heels = sole_points(robot, walk)[:, :, 0]
    return _known(gait, manner(gait), _numbers(gait, walk_estimate(gait), walk.time, heels))


def walking_speed(robot: Robot, gait: Gait) -> float:
    """Speed of a gait on this robot's legs [m/s], see `spatiotemporal`; NaN where it is unknown."""
    try:
        numbers = spatiotemporal(robot, gait)
    except GaitError:
        return math.nan
    return numbers["speed"].mean if "speed" in numbers else math.nan


def _known(gait: Gait, how: Manner, numbers: dict[str, Number]) -> dict[str, Number]:
    """The numbers without those that need contacts where a run's are not measured."""
    if how == "run" and not contacts_are_measured(gait):
        return {name: x for name, x in numbers.items() if not name.endswith(_OF_CONTACT)}
    return numbers


def _is_length(number: Number) -> bool:
    """Whether it depends on where on the foot it is measured."""
    return number.unit in ("m", "m/s")


def _numbers(gait: Gait, estimate: StrideEstimate | None, time: Array, heels: Array) -> dict[str, Number]:
    """The numbers of a gait with events, its heels `(n, 2, 3)` at times `(n,)`; raises `GaitError`."""
    if estimate is not None:
        return estimated_numbers(gait, estimate, time, heels)
    walk = unrolled(gait)
    return numbers_of(
        time,
        heels,
        walk.events,
        pelvis=None if walk.base is None else walk.base[:, :2, 3],
        spans=counted_strides(walk),
        until=gait.duration if gait.periodic else float("inf"),
    )


def _at_markers(
    gait: Gait, estimate: StrideEstimate | None, feet: FootMarkers
) -> dict[str, tuple[Number, str]]:
    """What heel markers measure of a gait with events, and where that is."""
    where = f"markers {', '.join(feet.heel_names)}"
    numbers = _numbers(gait, estimate, feet.time, feet.heels)
    return {
        name: (number, where)
        for name, number in numbers.items()
        if _is_length(number) or name == "step_length_symmetry"
    }


def _clearances(gait: Gait, balls: Array, feet: FootMarkers | None) -> dict[str, tuple[Number, str]]:
    """Clearances of the toes, and where each was measured: at their markers, else at the model's balls.

    The model has none where the pelvis's height was not recorded.

    Args:
        gait: The walk, with events.
        balls: `(n, 2, 3)` balls of the model's feet [m].
        feet: Heel and toe markers of its trial.
    """
    found = {}
    if recorded_height(gait) is not None:
        found = {
            x: (number, ON_THE_MODEL) for x, number in toe_clearances(gait.time, balls, gait.events).items()
        }
    if feet is not None:
        where = f"markers {', '.join(feet.toe_names)}"
        seen = toe_clearances(feet.time, feet.toes, gait.events)
        found |= {name: (number, where) for name, number in seen.items()}
    return found
