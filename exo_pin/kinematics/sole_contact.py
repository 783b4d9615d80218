"""Contact with the ground: heights of the sole corners, and gait events from kinematics."""

from __future__ import annotations

import dataclasses
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from exo_pin.anatomy import CORNERS, FEET, JOINTS, SIDES
from exo_pin.arguments import number
from exo_pin.arrays import Array, Mask
from exo_pin.chunks import for_chunks
from exo_pin.errors import GaitError
from exo_pin.gait import Event, Gait
from exo_pin.gait.heading import headings
from exo_pin.gait.running_method import Runner
from exo_pin.gait.stride_checks import Feet
from exo_pin.gait.strides import counted_strides, turns_of
from exo_pin.gait.walking_bouts import walking_events
from exo_pin.kinematics.motion import poses, positions
from exo_pin.kinematics.sole_points import heels_and_balls
from exo_pin.robot import Robot
from exo_pin.short_repr import short_repr

TOUCH_HEIGHT = 0.01
"""A corner this close to the ground touches [m]: soft soles and averaged gaits leave a centimetre."""


_KNEES = [JOINTS.index(f"{side}_knee_flexion") for side in SIDES]

_HELD = 1e-3
"""A pelvis that moves up and down by less than this [m] was held: that of a walker does by 20 to 50 mm."""

_LARGE_TURN = np.pi / 2
"""A larger rotation of the pelvis [rad] is named where a motion is refused as no walk."""


class Contacts(NamedTuple):
    """Sole corners over the ground.

    Attributes:
        corners: Names of the corners, left foot first.
        position: (..., 8, 3) in the world [m].
        height: (..., 8) above the ground [m].
        touching: (..., 8) True where a corner is within the tolerance of the ground.
        feet: (..., 2) True where any corner of the left, right foot touches.
    """

    corners: tuple[str, ...]
    position: Array
    height: Array
    touching: Mask
    feet: Mask

    def __repr__(self) -> str:
        return short_repr(self)


def contacts(
    robot: Robot,
    q: Gait | npt.ArrayLike,
    *,
    base: npt.ArrayLike | None = None,
    ground: float = 0.0,
    tolerance: float = TOUCH_HEIGHT,
) -> Contacts:
    """Which corner of which foot touches the ground, by geometry alone.

    Args:
        robot: The robot.
        q: Configurations (..., nq) [rad], or a gait.
        base: T_world_pelvis as in `exo_pin.kinematics.poses`.
        ground: Height of the ground [m].
        tolerance: Corners up to this height touch [m].

    Raises:
        DescriptionError: The shape of q or base does not fit, or a number is not finite.
    """
    ground, tolerance = number("ground", ground), number("tolerance", tolerance)
    position = positions(robot, q, CORNERS, base=base)
    height = position[..., 2] - ground
    touching = height <= tolerance
    feet = np.asarray(touching.reshape(*touching.shape[:-1], len(FEET), -1).any(axis=-1))
    return Contacts(CORNERS, position, height, touching, feet)


def events(robot: Robot, gait: Gait) -> tuple[Event, ...]:
    """Heel strikes and toe-offs of a gait from its kinematics.

    Of a walk by Zeni 2008, strikes refined by O'Connor 2007; of a run by Handsaker 2016 and Fellin 2010.

    Heel and ball of each foot are measured forward of the pelvis, along its horizontal heading: that serves
    on the treadmill and over ground, in any direction of the walk. Parts that are no walk give no events;
    see `exo_pin.gait.walking_bouts`. Where the pelvis's motion is unknown, minus the length of the leg serves
    as the height of a foot.

    Raises:
        GaitError: There are no gait cycles in the motion; the message gives the objection.
    """
    soles, pelvis, heading = _soles_and_pelvis(robot, gait)
    height = recorded_height(gait)
    upright = Feet(gait.time, soles[:, :, 0], soles[:, :, 1], pelvis[:, :2], heading)
    runner = Runner(upright, gait.q[:, _KNEES], height)
    if gait.base is None:
        # on an upright pelvis swing feet sink below standing ones: legs shorten all the same
        along = soles - pelvis[:, None, None]
        shorter = -np.hypot(along[..., 2], np.einsum("nfpk,nk->nfp", along[..., :2], heading))
        soles = np.concatenate([soles[..., :2], shorter[..., None]], axis=-1)
    feet = upright._replace(heel=soles[:, :, 0], toe=soles[:, :, 1])
    try:
        found = walking_events(feet, periodic=gait.periodic, heights=height is not None, runner=runner)
    except GaitError as error:
        turn = abs(float(turns_of(gait, gait.time[[0, -1]])[0]))
        hint = f"; the pelvis turns by {np.degrees(turn):.0f} deg on the spot" if turn > _LARGE_TURN else ""
        raise GaitError(f"{error}{hint}") from error
    counted_strides(dataclasses.replace(gait, events=found))  # refuses a motion without any
    return found


def _soles_and_pelvis(robot: Robot, gait: Gait) -> tuple[Array, Array, Array]:
    """Heels and balls `(n, 2, 2, 3)` and the pelvis `(n, 3)` [m], and its heading `(n, 2)`, in the world."""
    base, q = robot.base_of(gait), robot.from_gait(gait)
    soles, pelvis, heading = np.empty((len(q), 2, 2, 3)), np.empty((len(q), 3)), np.empty((len(q), 2))

    def of_chunk(part: slice) -> None:
        T = poses(robot, q[part], ("pelvis", *CORNERS), base=None if base is None else base[part])
        soles[part] = heels_and_balls(T[:, 1:, :3, 3])
        pelvis[part], heading[part] = T[:, 0, :3, 3], headings(T[:, 0])

    for_chunks(len(q), q, of_chunk)
    return soles, pelvis, heading


def recorded_height(gait: Gait) -> Array | None:
    """`(n,)` height of the pelvis [m], or None where it was not recorded: held, it says nothing."""
    if gait.base is None or float(np.ptp(gait.base[:, 2, 3])) <= _HELD:
        return None
    return np.asarray(gait.base[:, 2, 3])


def with_events(robot: Robot, gait: Gait) -> Gait:
    """The gait with events: its own, or those of its kinematics.

    Raises:
        GaitError: It has none, and there are no gait cycles in the motion.
    """
    return gait if gait.events else dataclasses.replace(gait, events=events(robot, gait))
