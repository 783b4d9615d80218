"""Slide of a standing foot over the ground: how well the body's lengths go with the recorded motion."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.names import Side
from exo_pin.arrays import Array
from exo_pin.errors import GaitError
from exo_pin.gait import Gait
from exo_pin.gait.event import flat_times
from exo_pin.gait.spatiotemporal import ground_velocity
from exo_pin.kinematics.sole_contact import with_events
from exo_pin.kinematics.walk_numbers import sole_points
from exo_pin.robot import Robot

LARGE_SLIDE = 0.020
"""A foot that rests flat and slides further than this [m] does not stand: the recordings at hand stay below
on the bodies of their persons, and reach 0.03 to 0.07 on one that is a tenth too tall or a child's double."""

_FEWEST_SAMPLES = 3
"""Fewer samples of a flat foot do not show how far it slides."""

_STILL = 1e-6
"""A pelvis that stays within this [m] was not recorded: joint angles alone do not say where a foot is."""


class StanceSlide(NamedTuple):
    """How far one foot slid over the ground during one stance.

    Attributes:
        side: Whose foot.
        start: From when on it rested flat [s].
        end: Until when [s].
        distance: Between the two places of the sole that are furthest apart, level [m].
    """

    side: Side
    start: float
    end: float
    distance: float


def stance_slides(robot: Robot, gait: Gait) -> tuple[StanceSlide, ...]:
    """The slide of each foot in each whole stance, left foot first.

    The sole is midway between heel and ball, in the part of the stance in which the whole foot rests on the
    ground (`exo_pin.gait.event.FOOT_FLAT`). A person's foot stands there, so what slides tells of a body that
    is not the person's, or of angles and pelvis that do not belong together. On a treadmill the ground moves
    as the resting feet do in the mean: a body of a wrong size only changes the speed of the belt there.

    Args:
        robot: With the person's sizes.
        gait: The walk; its events are used. Without any, or where the pelvis's path was not recorded, there
            is nothing to compare.
    """
    if gait.base is None or not gait.events or np.ptp(gait.base[:, :2, 3], axis=0).max() < _STILL:
        return ()
    points = sole_points(robot, gait)
    ground = ground_velocity(gait.time, points[:, :, 0], gait.events, gait.base[:, :2, 3])
    soles = points.mean(axis=2)[..., :2] - (gait.time[:, None] * ground)[:, None]
    return tuple(slide for k, side in enumerate(SIDES) for slide in _slides(gait, side, soles[:, k]))


def largest_slide(robot: Robot, gait: Gait) -> StanceSlide | None:
    """The largest of `stance_slides`, or None where there are none."""
    return max(stance_slides(robot, gait), key=lambda slide: slide.distance, default=None)


def slide_doubts(robot: Robot, gait: Gait) -> tuple[str, ...]:
    """The largest slide of a standing foot in a sentence with its probable cause; none up to `LARGE_SLIDE`.

    Args:
        robot: With the person's sizes.
        gait: The walk; events by its kinematics where it has none.
    """
    try:
        found = largest_slide(robot, with_events(robot, gait))
    except GaitError:
        return ()
    if found is None or found.distance <= LARGE_SLIDE:
        return ()
    when = f"{found.start:.2f} .. {found.end:.2f} s"
    return (
        f"the {found.side} foot slides {1e3 * found.distance:.0f} mm while it stands, {when}, more than "
        f"{1e3 * LARGE_SLIDE:.0f}: is the body the person's (--stature, --body, --model)?",
    )


def _slides(gait: Gait, side: Side, sole: Array) -> Iterator[StanceSlide]:
    """The slides of one foot, its sole `(n, 2)` seen from the ground [m]."""
    for start, end in flat_times(gait.events, side):
        places = sole[(gait.time >= start) & (gait.time <= end)]
        if len(places) >= _FEWEST_SAMPLES:
            apart = np.linalg.norm(places[:, None] - places[None], axis=2)
            yield StanceSlide(side, start, end, float(apart.max()))
