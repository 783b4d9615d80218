"""Slide of a standing foot over the ground, of recorded feet and of feet as they are drawn."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.names import Side
from exo_pin.arguments import real
from exo_pin.arrays import Array, Mask
from exo_pin.gait import Gait
from exo_pin.gait.event import flat_times
from exo_pin.gait.spatiotemporal import ground_velocity
from exo_pin.gait.time_series import rows_within, runs
from exo_pin.kinematics.sole_contact import TOUCH_HEIGHT
from exo_pin.kinematics.sole_points import sole_points
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


class SoleSlide(NamedTuple):
    """The largest path of a heel or a ball over the ground while it touches.

    Attributes:
        along: Fore and aft [m].
        sideways: [m].
    """

    along: float
    sideways: float


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
    soles = _over_ground(gait.time, points.mean(axis=2), ground)
    return tuple(slide for k, side in enumerate(SIDES) for slide in _slides(gait, side, soles[:, k]))


def largest_slide(robot: Robot, gait: Gait) -> StanceSlide | None:
    """The largest of `stance_slides`, or None where there are none."""
    return max(stance_slides(robot, gait), key=lambda slide: slide.distance, default=None)


def slide_doubts(robot: Robot, gait: Gait) -> tuple[str, ...]:
    """The largest slide of a standing foot in a sentence with its probable cause; none up to `LARGE_SLIDE`.

    Args:
        robot: With the person's sizes.
        gait: The walk; its events are used.
    """
    found = largest_slide(robot, gait)
    if found is None or found.distance <= LARGE_SLIDE:
        return ()
    when = f"{found.start:.2f} .. {found.end:.2f} s"
    return (
        f"the {found.side} foot slides {1e3 * found.distance:.0f} mm while it stands, {when}, more than "
        f"{1e3 * LARGE_SLIDE:.0f}: is the body the person's (--stature, --body, --model)?",
    )


def sole_slide(time: Array, points: Array, standing: Mask, ground: Array) -> SoleSlide:
    """The largest path of a heel or a ball over the ground, within one contact of a standing foot.

    Of a foot that stands, what is at most `TOUCH_HEIGHT` above its lower end is taken to touch, so that a
    standing foot that hovers is measured as well.

    Args:
        time: `(n,)` [s].
        points: `(n, 2, 2, 3)` left and right foot: heel and ball, x forward, z up [m].
        standing: `(n, 2)` which foot is to be measured.
        ground: `(2,)` velocity of the ground, x and y [m/s].

    Raises:
        DescriptionError: A shape does not fit, or a number is not finite.
    """
    time, ground = real("time", time, ("n",)), real("ground", ground, (2,))
    points = real("points", points, (len(time), 2, 2, 3))
    standing = real("standing", standing, (len(time), 2)) != 0.0
    heights = points[..., 2]
    touching = standing[..., None] & (heights <= heights.min(axis=2, keepdims=True) + TOUCH_HEIGHT)
    places = _over_ground(time, points, ground)
    paths = [
        np.ptp(places[start:end, foot, end_of_foot], axis=0)
        for foot, end_of_foot in np.ndindex(touching.shape[1:])
        for start, end in runs(touching[:, foot, end_of_foot])
    ]
    along, sideways = np.max(paths, axis=0, initial=0.0) if paths else (0.0, 0.0)
    return SoleSlide(float(along), float(sideways))


def _over_ground(time: Array, points: Array, ground: Array) -> Array:
    """Places `(n, ..., 2)` of points `(n, ..., 3)` seen from the ground [m]."""
    way = (time[:, None] * ground).reshape(len(time), *[1] * (points.ndim - 2), 2)
    return np.asarray(points[..., :2] - way)


def _slides(gait: Gait, side: Side, sole: Array) -> Iterator[StanceSlide]:
    """The slides of one foot, its sole `(n, 2)` seen from the ground [m]."""
    for start, end in flat_times(gait.events, side):
        places = sole[rows_within(gait.time, start, end)]
        if len(places) >= _FEWEST_SAMPLES:
            apart = np.linalg.norm(places[:, None] - places[None], axis=2)
            yield StanceSlide(side, start, end, float(apart.max()))
