"""Footsteps: where the feet stand, one step after the other, and how long a step takes."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from exo_pin.anatomy import SIDES, Body
from exo_pin.anatomy.names import OTHER_SIDE, Side
from exo_pin.arguments import count, number, word
from exo_pin.arrays import Array
from exo_pin.errors import GaitError
from exo_pin.frozen_fields import set_fields

MOST_FOOTSTEPS = 1000
"""Of one plan: a quarter of an hour; more is a slip of the hand."""

_FURTHEST = 1000.0  # from the start of a walk [m]
_MOST_TURN = 45.0  # of a step [deg]


@dataclass(frozen=True)
class Footstep:
    """Where one foot stands flat: the point of its sole under the ankle, on level ground.

    Attributes:
        side: `"left"` or `"right"`.
        x: Forward in the world [m].
        y: To the left [m].
        heading: Direction of the toes, counter-clockwise from x [rad].

    Raises:
        GaitError: A number is not finite.
        UnknownNameError: There is no such side.
    """

    side: Side
    x: float
    y: float
    heading: float = 0.0

    def __post_init__(self) -> None:
        word("side", self.side, SIDES)
        for name in ("x", "y", "heading"):
            set_fields(self, **{name: _within(f"footstep: {name}", getattr(self, name), _FURTHEST)})


@dataclass(frozen=True)
class Footsteps:
    """A walk as footsteps, from standing on both feet to standing on both feet.

    Attributes:
        start: Where the left and the right foot stand before the first step.
        steps: The steps in order; left and right take turns.
        step_time: From the landing of one foot to that of the other [s].
        double_support: Share of the step time with both feet on the ground, 0 < share < 1.
        clearance: Height of the swinging foot's ball over the ground in mid-swing [m].

    Raises:
        GaitError: There is no step or there are too many, the feet do not take turns, or a number is not
            accepted.
    """

    start: tuple[Footstep, Footstep]
    steps: tuple[Footstep, ...]
    step_time: float = 0.8
    double_support: float = 0.2
    clearance: float = 0.05

    def __post_init__(self) -> None:
        set_fields(self, start=tuple(self.start), steps=tuple(self.steps))
        for name, above, most in (("step_time", 0.0, 60.0), ("clearance", 0.0, 0.5)):
            value = number(
                name.replace("_", " "), getattr(self, name), above=above, most=most, error=GaitError
            )
            set_fields(self, **{name: value})
        set_fields(self, double_support=_share(self.double_support))
        if tuple(foot.side for foot in self.start) != SIDES:
            raise GaitError("footsteps: the start holds the left, then the right foot")
        count("number of steps", len(self.steps), 1, MOST_FOOTSTEPS, error=GaitError)
        for k, (before, after) in enumerate(zip(self.steps, self.steps[1:], strict=False), 1):
            if before.side == after.side:
                raise GaitError(
                    f"steps {k} and {k + 1} are both of the {after.side} foot; left and right take turns"
                )

    @property
    def words(self) -> str:
        """How many steps, how long and how quick, in words."""
        ahead = np.abs(self.relative()[:, 0]).max()
        n = len(self.steps)
        return f"{n} step{'s' * (n > 1)} of up to {ahead:.2f} m, {self.step_time:.3g} s each"

    def stances(self) -> tuple[Footstep, ...]:
        """Where the other foot stands during each step."""
        place = dict(zip(SIDES, self.start, strict=True))
        found = []
        for step in self.steps:
            found.append(place[OTHER_SIDE[step.side]])
            place[step.side] = step
        return tuple(found)

    def relative(self) -> Array:
        """`(steps, 3)` each step as the standing foot sees it: ahead, to the left [m], turned [rad]."""
        return np.array(
            [_seen_from(foot, step) for foot, step in zip(self.stances(), self.steps, strict=True)]
        )

    def shortened(self, factor: float) -> Footsteps:
        """The same steps with `factor` times their length ahead of the standing foot; width and turn stay.

        Raises:
            GaitError: The factor is not from 0 to 1.
        """
        factor = number("factor", factor, least=0.0, most=1.0, error=GaitError)
        return _chained(self, self.relative() * [factor, 1.0, 1.0])

    def mirrored(self) -> Footsteps:
        """The walk seen in a mirror: left and right change places."""
        left, right = map(_mirrored, reversed(self.start))
        return dataclasses.replace(self, start=(left, right), steps=tuple(map(_mirrored, self.steps)))


def footsteps(
    steps: int = 8,
    length: float = 0.30,
    *,
    width: float | None = None,
    turn: float = 0.0,
    step_time: float = 0.8,
    double_support: float = 0.2,
    clearance: float = 0.05,
    start: Side = "left",
) -> Footsteps:
    """Even steps, straight ahead or along a circle, and a last one that brings the feet together.

    Args:
        steps: How many, without the last one that closes the feet.
        length: From foot to foot along the way [m]; 0: on the spot, negative: backwards.
        width: Between the feet [m]; that of an average person's hips if left out.
        turn: Of every step, counter-clockwise [rad].
        step_time: From the landing of one foot to that of the other [s].
        double_support: Share of it with both feet on the ground.
        clearance: Height of the swinging foot's ball over the ground in mid-swing [m].
        start: The foot that steps first.

    Raises:
        GaitError: A number is not accepted; the message says which.
        UnknownNameError: There is no such side.
    """
    n = count("number of steps", steps, 1, MOST_FOOTSTEPS - 1, error=GaitError)
    length = _within("step length", length, 2.0)
    degrees = round(math.degrees(number("turn", turn, error=GaitError)), 9)
    turn = math.radians(_within("turn of a step [deg]", degrees, _MOST_TURN))
    across = Body.from_stature().hip_width if width is None else width
    across = number("step width", across, above=0.0, most=1.0, error=GaitError)
    side: Side = word("side", start, SIDES)
    centre, placed = np.zeros(3), []
    for k in range(n + 1):
        if k < n:
            centre = _ahead(centre, length, turn)
        placed.append(_beside(centre, side, across))
        side = OTHER_SIDE[side]
    left, right = (_beside(np.zeros(3), foot, across) for foot in SIDES)
    return Footsteps((left, right), tuple(placed), step_time, double_support, clearance)


def _within(name: str, value: float, most: float) -> float:
    return number(name, value, least=-most, most=most, error=GaitError)


def _share(value: float) -> float:
    share = number("double support", value, error=GaitError)
    if not 0.0 < share < 1.0:
        raise GaitError(
            f"double support is {share:g} of the step; a share between 0 and 1 is accepted, both excluded: "
            "the weight needs time to change feet, and the foot to swing"
        )
    return share


def _ahead(centre: Array, length: float, turn: float) -> Array:
    """The middle between the feet one step on: along the chord of a circle."""
    x, y, heading = centre
    chord = heading + turn / 2
    return np.array([x + length * math.cos(chord), y + length * math.sin(chord), heading + turn])


def _beside(centre: Array, side: Side, width: float) -> Footstep:
    x, y, heading = map(float, centre)
    out = 0.5 * width if side == "left" else -0.5 * width
    return Footstep(side, x - out * math.sin(heading), y + out * math.cos(heading), heading)


def _seen_from(foot: Footstep, step: Footstep) -> tuple[float, float, float]:
    dx, dy = step.x - foot.x, step.y - foot.y
    c, s = math.cos(foot.heading), math.sin(foot.heading)
    turned = math.remainder(step.heading - foot.heading, 2.0 * math.pi)
    return c * dx + s * dy, c * dy - s * dx, turned


def _placed(foot: Footstep, side: Side, relative: Iterable[float]) -> Footstep:
    ahead, left, turned = map(float, relative)
    c, s = math.cos(foot.heading), math.sin(foot.heading)
    return Footstep(side, foot.x + c * ahead - s * left, foot.y + s * ahead + c * left, foot.heading + turned)


def _chained(walk: Footsteps, relative: Array) -> Footsteps:
    """The same walk with other steps, each relative to the foot that stands."""
    place = dict(zip(SIDES, walk.start, strict=True))
    steps = []
    for step, seen in zip(walk.steps, relative, strict=True):
        place[step.side] = _placed(place[OTHER_SIDE[step.side]], step.side, seen)
        steps.append(place[step.side])
    return dataclasses.replace(walk, steps=tuple(steps))


def _mirrored(foot: Footstep) -> Footstep:
    return Footstep(OTHER_SIDE[foot.side], foot.x, -foot.y, -foot.heading)
