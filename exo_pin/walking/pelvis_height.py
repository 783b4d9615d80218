"""The pelvis's height of a walk: the one that leaves the joints most room to their limits."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from exo_pin.anatomy import FEET
from exo_pin.arrays import Array
from exo_pin.errors import DescriptionError
from exo_pin.ik.leg import closed_form
from exo_pin.ik.leg.geometry import exact_geometry
from exo_pin.robot import LegAxes, Robot, leg_forward

_DROPS = np.linspace(0.01, 0.14, 27)
"""How far mid-hip may hang below its height on straight legs, in that height."""

_KNEE_ROOM = 1.0 / 8.0
"""What a degree of room counts of a knee: the straighter it is, the faster it has to move (as 1 / sin). With
it knees stay bent by 19 degrees in steps of 0.3 m, and hips need 97 N m instead of 126 (a choice)."""


class LegRoom(NamedTuple):
    """The tightest place of a walk with the pelvis at one height.

    Attributes:
        height: Of mid-hip above the ground [m].
        room: Least distance of a joint from its limits, of a knee an eighth; negative: beyond them [rad].
        joint: Which joint that is.
        angle: Its angle there [rad].
        limits: Its lower and upper limit [rad].
        sample: Where in the walk.
        reach: By how much the foot is within the leg's reach there; negative: beyond it [m].
    """

    height: float
    room: float
    joint: str
    angle: float
    limits: tuple[float, float]
    sample: int
    reach: float


def best_height(robot: Robot, feet: Array, base: Array) -> LegRoom:
    """The pelvis's height with the most room to the nearest joint limit, and where it is tightest there.

    Args:
        robot: With a fixed pelvis.
        feet: `(n, 2, 4, 4)` poses of the feet.
        base: `(n, 4, 4)` poses of the pelvis; their heights do not count.

    Raises:
        DescriptionError: A leg has no closed form.
    """
    heights = float(robot.placement[2, 3]) * (1.0 - _DROPS)
    bases = np.tile(base, (len(heights), 1, 1, 1))
    bases[..., 2, 3] = heights[:, None]
    back = np.linalg.inv(bases)
    found = [_leg_rooms(robot, foot, back @ feet[:, k]) for k, foot in enumerate(FEET)]
    room = np.stack([leg.room for leg in found], axis=2)  # (heights, n, legs, joints)
    h = int(room.min(axis=(1, 2, 3)).argmax())
    sample, side, j = np.unravel_index(int(room[h].argmin()), room.shape[1:])
    leg, axes = found[int(side)], _leg(robot, FEET[int(side)])
    return LegRoom(
        height=float(heights[h]),
        room=float(room[h, sample, side, j]),
        joint=robot.joints[int(axes.columns[j])],
        angle=float(leg.angles[h, sample, j]),
        limits=(float(axes.lower[j]), float(axes.upper[j])),
        sample=int(sample),
        reach=float(leg.reach[h, sample]),
    )


class _Leg(NamedTuple):
    """One leg at several heights: angles and room to limits `(h, n, 6)`, reach `(h, n)`."""

    angles: Array
    room: Array
    reach: Array


def _leg_rooms(robot: Robot, foot: str, T_pelvis_foot: Array) -> _Leg:
    """The angles that a leg needs, limits or not, and what room they leave."""
    leg = _leg(robot, foot)
    geometry = exact_geometry(leg)
    if geometry is None:
        raise DescriptionError(_no_closed_form(foot))
    T = (robot.placement @ T_pelvis_foot).reshape(-1, 4, 4)
    R, p = leg_forward.components(T[:, :3, :3], T[:, :3, 3])
    shape = T_pelvis_foot.shape[:2]
    angles = closed_form.angles(geometry, R, p).T.reshape(*shape, 6)
    reach = leg_forward.reach_slack(leg, R, p).reshape(shape)
    room = np.minimum(angles - leg.lower, leg.upper - angles)
    room[..., 3] *= np.where(room[..., 3] > 0.0, _KNEE_ROOM, 1.0)
    room[..., 3] = np.where(reach < 0.0, reach / leg.reach, room[..., 3])
    return _Leg(angles, room, reach)


def _leg(robot: Robot, foot: str) -> LegAxes:
    leg = robot.leg(foot)
    if leg is None:
        raise DescriptionError(_no_closed_form(foot))
    return leg


def _no_closed_form(foot: str) -> str:
    return (
        f"{foot} is not on a leg of six driven joints with a closed form (docs/ik.md), which a walk in all "
        "directions needs; exo12 is accepted"
    )
