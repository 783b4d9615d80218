"""Spatiotemporal numbers of a walk by the paths of its feet, and against published ranges."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

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
    strides,
    walk_estimate,
)
from exo_pin.gait.event import Event, whole_stances
from exo_pin.gait.heading import heading
from exo_pin.gait.manner import contacts_are_measured
from exo_pin.gait.marked_feet import FootMarkers
from exo_pin.gait.published_ranges import CITATIONS
from exo_pin.gait.spatiotemporal import ground_velocity
from exo_pin.gait.spatiotemporal import spatiotemporal as numbers_of
from exo_pin.gait.strides import unrolled
from exo_pin.gait.toe_clearance import toe_clearances
from exo_pin.kinematics.sole_contact import recorded_height, with_events
from exo_pin.kinematics.sole_points import sole_points
from exo_pin.robot import Robot

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
    estimate = None
    try:
        gait = with_events(robot, gait)
        estimate = walk_estimate(gait)
        numbers = _known(gait, _all_numbers(robot, gait))
    except GaitError as error:
        return WalkNumbers(missing=str(error))
    numbers |= _model_clearances(robot, gait)
    measured = {name: ON_THE_MODEL for name, number in numbers.items() if number.unit in ("m", "m/s")}
    if feet is not None:
        seen = _at_markers(gait, feet)
        numbers |= {name: number for name, (number, _) in seen.items()}
        measured |= {name: where for name, (_, where) in seen.items()}
    leg_length = robot.body.leg_length if robot.body else math.nan
    if manner(gait) == "run":  # the published ranges are those of walks
        return WalkNumbers(
            strides=tuple(x for side in SIDES for x in strides(gait, side)),
            numbers={name: x for name, x in numbers.items() if not name.endswith("clearance")},
            measured={name: x for name, x in measured.items() if not name.endswith("clearance")},
            estimate=estimate,
            manner="run",
            unknown="" if contacts_are_measured(gait) else _UNKNOWN,
        )
    return WalkNumbers(
        strides=tuple(x for side in SIDES for x in strides(gait, side)),
        numbers=numbers,
        estimate=estimate,
        usual=normal(numbers, leg_length=leg_length),
        verdicts=against_normal(numbers, leg_length=leg_length),
        measured=measured,
    )


def spatiotemporal(robot: Robot, gait: Gait) -> dict[str, Number]:
    """Cadence, speed, lengths, width and phases of a gait; see `exo_pin.gait.spatiotemporal`.

    Events are the gait's own, or those of its kinematics. Lengths are those of this robot's legs.

    Pauses, turns and other spans that are no strides (`exo_pin.gait.strides`) are left out, and of a run
    whose contacts come from kinematics alone what needs them: stance, swing, flight.

    Raises:
        GaitError: There are no gait cycles.
    """
    gait = with_events(robot, gait)
    if walk_estimate(gait):
        raise GaitError("no gait cycles found: no foot strikes the ground twice")
    return _known(gait, _all_numbers(robot, gait))


def _known(gait: Gait, numbers: dict[str, Number]) -> dict[str, Number]:
    """The numbers without those that need contacts where a run's are not measured."""
    if manner(gait) == "run" and not contacts_are_measured(gait):
        return {name: x for name, x in numbers.items() if not name.endswith(_OF_CONTACT)}
    return numbers


def _all_numbers(robot: Robot, gait: Gait) -> dict[str, Number]:
    walk = unrolled(gait)
    return _numbers(gait, walk.time, sole_points(robot, walk)[:, :, 0])


def _numbers(gait: Gait, time: Array, heels: Array) -> dict[str, Number]:
    """The numbers of a gait with events, its heels `(n, 2, 3)` at times `(n,)`; raises `GaitError`."""
    estimate = walk_estimate(gait)
    if estimate is not None:
        return _estimated(gait, estimate, time, heels)
    walk = unrolled(gait)
    spans = [span for side in SIDES for span in strides(walk, side)]
    counted = [span for span in spans if not span.why]
    if spans and not counted:
        raise GaitError(f"no gait cycles found: {spans[0].why}")
    return numbers_of(
        time,
        heels,
        walk.events,
        pelvis=None if walk.base is None else walk.base[:, :2, 3],
        spans=counted,
        until=gait.duration if gait.periodic else float("inf"),
    )


def _estimated(gait: Gait, estimate: StrideEstimate, time: Array, heels: Array) -> dict[str, Number]:
    """The numbers of an estimated stride: between toe-offs where it was measured there, else of its step."""
    pelvis = None if gait.base is None else gait.base[:, :2, 3]
    once = {"cadence": (120 / estimate.duration, "steps/min"), "stride_time": (estimate.duration, "s")}
    strikes = [event for event in gait.events if event.kind == "heel_strike"]
    # without a whole stance nothing tells whether the ground moves: no treadmill's speed, no length
    stood = any(True for side in SIDES for _ in whole_stances(gait.events, side))
    for a, b in pairwise(strikes):
        if a.side != b.side:
            once[f"{b.side}_step_time"] = (b.time - a.time, "s")
            if stood and not estimate.spans:
                along = _step_length(gait, time, heels, (a, b))
                once |= {"speed": (along / (b.time - a.time), "m/s"), f"{b.side}_step_length": (along, "m")}
    for side in SIDES:
        for start, end in whole_stances(gait.events, side):
            once[f"{side}_stance"] = (100 * (end - start) / estimate.duration, "%")
    numbers = {name: Number(x, math.nan, 1, unit) for name, (x, unit) in once.items()}
    if estimate.spans:
        numbers |= numbers_of(time, heels, gait.events, pelvis=pelvis, spans=estimate.spans)
    return numbers


def _step_length(gait: Gait, time: Array, heels: Array, strikes: tuple[Event, Event]) -> float:
    """From one foot's strike to the other's over the ground, along the pelvis's mean heading [m]."""
    pelvis = None if gait.base is None else gait.base[:, :2, 3]
    places = [
        [np.interp(strike.time, time, heels[:, SIDES.index(strike.side), axis]) for axis in range(2)]
        for strike in strikes
    ]
    ground = ground_velocity(time, heels, gait.events, pelvis)
    step = np.subtract(places[1], places[0]) - ground * (strikes[1].time - strikes[0].time)
    angle = heading(gait) or 0.0
    return float(step @ [math.cos(angle), math.sin(angle)])


def _at_markers(gait: Gait, feet: FootMarkers) -> dict[str, tuple[Number, str]]:
    """What heel and toe markers measure of a gait with events, and where that is."""
    heels, toes = (f"markers {', '.join(names)}" for names in (feet.heel_names, feet.toe_names))
    lengths = _numbers(gait, feet.time, feet.heels)
    found = {name: (number, heels) for name, number in lengths.items() if number.unit in ("m", "m/s")}
    symmetry = "step_length_symmetry"
    found |= {symmetry: (lengths[symmetry], heels)} if symmetry in lengths else {}
    clearances = toe_clearances(feet.time, feet.toes, gait.events)
    return found | {name: (number, toes) for name, number in clearances.items()}


def _model_clearances(robot: Robot, gait: Gait) -> dict[str, Number]:
    """Clearance of the balls of the model's feet; nothing where the pelvis's height was not recorded."""
    if recorded_height(gait) is None:
        return {}
    return toe_clearances(gait.time, sole_points(robot, gait)[:, :, 1], gait.events)
