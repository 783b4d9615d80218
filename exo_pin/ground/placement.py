"""The walk as the picture shows it: where pelvis, feet and centre of mass are, and who stands."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from exo_pin.anatomy import CORNERS, FEET
from exo_pin.arrays import Array
from exo_pin.gait import Gait
from exo_pin.ground import stance
from exo_pin.ground.support import WHO, Support, support
from exo_pin.kinematics import center_of_mass, poses
from exo_pin.robot import Robot


@dataclass(frozen=True, eq=False)
class Placement:
    """What is shown, sampled as the gait is.

    Attributes:
        time: `(n,)` from 0 [s].
        q: `(n, J)` joint values in the order of `Robot.joints` [rad].
        base: `(n, 4, 4)` pose of the pelvis as shown.
        feet: `(n, 2, 4, 4)` poses of `FEET` as shown.
        corners: `(n, 8, 3)` sole corners as shown [m].
        com: `(n, 3)` centre of mass as shown [m].
        stance: Side -> intervals on the ground.
        estimated: Whether stance is guessed from heights because the gait has no events.
        support: How the pelvis was carried, and what remains.
    """

    time: Array
    q: Array
    base: Array
    feet: Array
    corners: Array
    com: Array
    stance: stance.Intervals
    estimated: bool
    support: Support


def motion(robot: Robot, gait: Gait, style: str = "carried") -> Placement:
    """Put a robot through a gait and stand it on the ground.

    Args:
        robot: With the joints of a gait, `FEET` and `CORNERS`.
        gait: The walk; its own base motion is used if it has one.
        style: How the pelvis is carried, one of `support.STYLES`.

    Raises:
        UnknownNameError: The robot lacks a joint or frame of a walker, or there is no such style.
    """
    q = at_rest(robot, robot.from_gait(gait))
    back = np.linalg.inv(robot.placement)
    T_pelvis = back @ poses(robot, q, (*FEET, *CORNERS))  # (n, 10, 4, 4)
    com_pelvis = moved(back, center_of_mass(robot, q).position)
    given = np.tile(robot.placement, (len(gait), 1, 1)) if gait.base is None else gait.base
    return stood(gait, robot.angles(q), given, T_pelvis, com_pelvis, style)


def stood(
    gait: Gait, q: Array, given: Array, T_pelvis: Array, com_pelvis: Array, style: str, who: str = WHO
) -> Placement:
    """Stand any walker on the ground.

    Args:
        gait: Whose time and events the walk has.
        q: `(n, J)` joint values in the order of `Robot.joints` [rad].
        given: `(n, 4, 4)` pose of the pelvis (or root link) as given.
        T_pelvis: `(n, 10, 4, 4)` poses of `FEET` and `CORNERS` seen from there.
        com_pelvis: `(n, 3)` centre of mass seen from there [m].
        style: How the pelvis is carried, one of `support.STYLES`.
        who: Whom the note names.

    Raises:
        UnknownNameError: There is no such style.
    """
    corners = (given[:, None] @ T_pelvis[:, len(FEET) :])[..., :3, 3]
    known = stance.from_events(gait)
    standing = known or stance.estimated(gait, stance.lowest_corners(corners))
    carried = support(style, gait, given, corners, standing, who)
    base = carried.base
    shown = base[:, None] @ T_pelvis
    return Placement(
        time=gait.time - gait.time[0],
        q=q,
        base=base,
        feet=shown[:, : len(FEET)],
        corners=shown[:, len(FEET) :, :3, 3],
        com=moved(base, com_pelvis),
        stance=standing,
        estimated=known is None,
        support=carried,
    )


def at_rest(robot: Robot, q: Array) -> Array:
    """Configurations with a floating base put back to its placement, so that all robots are treated alike."""
    q = q.copy()
    if robot.base == "floating":
        free = robot.nq - len(robot.joints)
        q[:, :free] = robot.neutral[:free]
    return q


def moved(T: NDArray[np.floating[Any]], points: Array) -> Array:
    """Points `(..., 3)` by poses `(..., 4, 4)`."""
    out: Array = (T[..., :3, :3] @ points[..., None])[..., 0] + T[..., :3, 3]
    return out
