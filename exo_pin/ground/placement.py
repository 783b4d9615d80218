"""A walk placed on its ground: where pelvis, feet and centre of mass are, and which foot stands."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from exo_pin.anatomy import CORNERS, FEET, SIDES, Body
from exo_pin.anatomy.names import SupportStyle
from exo_pin.arguments import real
from exo_pin.arrays import Array
from exo_pin.devices import TOES
from exo_pin.gait import Gait
from exo_pin.ground.stance import Intervals, estimated_stance, lowest_corners, stance_from_events
from exo_pin.ground.support import Support, support
from exo_pin.kinematics import center_of_mass, poses
from exo_pin.robot import Robot
from exo_pin.short_repr import short_repr

_EXOSKELETON = "Balance support: the pelvis"
"""Subject of the note on the support: an exoskeleton's pelvis hangs in one."""


@dataclass(frozen=True, eq=False)
class PlacedWalk:
    """A walk on its ground, sampled as its gait is.

    Attributes:
        time: `(n,)` from 0 [s].
        q: `(n, J)` joint values in the order of `Robot.joints` [rad].
        base: `(n, 4, 4)` pose of the pelvis as placed.
        feet: `(n, 2, 4, 4)` poses of `FEET` as placed.
        corners: `(n, 8, 3)` sole corners as placed [m].
        com: `(n, 3)` centre of mass as placed [m]; None where the robot states no masses.
        stance: Side -> intervals on the ground.
        estimated: Whether stance is guessed from heights because the gait has no events.
        support: How the pelvis was carried, and what remains.
    """

    time: Array
    q: Array
    base: Array
    feet: Array
    corners: Array
    com: Array | None
    stance: Intervals
    estimated: bool
    support: Support

    __repr__ = short_repr


def place_walk(robot: Robot, gait: Gait, style: SupportStyle = "carried") -> PlacedWalk:
    """Put a robot through a gait and stand it on the ground.

    Args:
        robot: With the joints of a gait, `FEET` and `CORNERS`.
        gait: The walk; its own base motion is used if it has one.
        style: How the pelvis is carried, one of `STYLES`.

    Raises:
        UnknownNameError: The robot lacks a joint or frame of a walker, or there is no such style.
    """
    q = _base_at_placement(robot, robot.from_gait(gait))
    back = np.linalg.inv(robot.placement)
    T_pelvis = back @ poses(robot, q, (*FEET, *CORNERS))  # (n, 10, 4, 4)
    com_pelvis = transformed(back, center_of_mass(robot, q).position)
    base = np.tile(robot.placement, (len(gait), 1, 1)) if gait.base is None else gait.base
    return place(gait, robot.angles(q), base, T_pelvis, com_pelvis, style, _EXOSKELETON)


def place(
    gait: Gait,
    q: Array,
    base: Array,
    T_pelvis: Array,
    com_pelvis: Array | None,
    style: SupportStyle,
    subject: str,
) -> PlacedWalk:
    """Stand any walker on the ground.

    Args:
        gait: The walk: n times and events.
        q: `(n, J)` joint values in the order of `Robot.joints` [rad].
        base: `(n, 4, 4)` pose of the pelvis (or root link) as given.
        T_pelvis: `(n, 10, 4, 4)` poses of `FEET` and `CORNERS` seen from there.
        com_pelvis: `(n, 3)` centre of mass seen from there [m]; None where it is not known.
        style: How the pelvis is carried, one of `STYLES`.
        subject: First words of the note on the support, e.g. `"The pelvis"`.

    Raises:
        UnknownNameError: There is no such style.
        DescriptionError: A shape does not fit the walk's n samples, or a number is not finite.
    """
    n = len(gait)
    q, base = real("q", q, (n, "J")), real("base", base, (n, 4, 4))
    T_pelvis = real("T_pelvis", T_pelvis, (n, len(FEET) + len(CORNERS), 4, 4))
    corners = (base[:, None] @ T_pelvis[:, len(FEET) :])[..., :3, 3]
    known = stance_from_events(gait)
    stance = known or estimated_stance(gait, lowest_corners(corners))
    carried = support(style, gait, base, corners, stance, subject)
    placed = carried.base[:, None] @ T_pelvis
    return PlacedWalk(
        time=gait.time - gait.time[0],
        q=q,
        base=carried.base,
        feet=placed[:, : len(FEET)],
        corners=placed[:, len(FEET) :, :3, 3],
        com=None if com_pelvis is None else transformed(carried.base, real("com_pelvis", com_pelvis, (n, 3))),
        stance=stance,
        estimated=known is None,
        support=carried,
    )


def toe_angles(body: Body, walk: PlacedWalk) -> dict[str, Array]:
    """Toe angles `(n,)` [rad] by joint, toes up positive, that keep the tips out of the ground.

    A gait has no toe angles. A toe of length L behind a ball at height h, on a foot that points down by an
    angle a, reaches the ground where h = L sin(a - toe); it bends by what is beyond that.
    """
    angles = {}
    for k, (side, joint) in enumerate(zip(SIDES, TOES, strict=True)):
        leg = body.leg(side)
        length = leg.foot_length - leg.heel - leg.ball
        down = np.arcsin(np.clip(-walk.feet[:, k, 2, 0], -1.0, 1.0))
        height = np.clip(lowest_corners(walk.corners)[side], 0.0, length)
        angles[joint] = np.maximum(down - np.arcsin(height / length), 0.0)
    return angles


def transformed(T: NDArray[np.floating[Any]], points: Array) -> Array:
    """Points `(..., 3)` by poses `(..., 4, 4)`."""
    out: Array = (T[..., :3, :3] @ points[..., None])[..., 0] + T[..., :3, 3]
    return out


def _base_at_placement(robot: Robot, q: Array) -> Array:
    """Configurations with a floating base put back to its placement, so that all robots are treated alike."""
    q = q.copy()
    if robot.base == "floating":
        free = robot.nq - len(robot.joints)
        q[:, :free] = robot.neutral[:free]
    return q
