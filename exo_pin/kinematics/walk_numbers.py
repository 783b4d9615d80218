"""Spatiotemporal numbers of a walk by the paths of its feet."""

from __future__ import annotations

import numpy as np

from exo_pin.anatomy import CORNERS, FEET, SIDES
from exo_pin.arrays import Array
from exo_pin.errors import GaitError
from exo_pin.gait import Gait
from exo_pin.gait.spatiotemporal import Number
from exo_pin.gait.spatiotemporal import spatiotemporal as numbers_of
from exo_pin.gait.strides import strides, unrolled
from exo_pin.kinematics.contact import with_events
from exo_pin.kinematics.motion import poses
from exo_pin.robot import Robot


def spatiotemporal(robot: Robot, gait: Gait) -> dict[str, Number]:
    """Cadence, speed, lengths, width and phases of a gait; see `exo_pin.gait.spatiotemporal`.

    Events are the gait's own, or those of its kinematics. Lengths are those of this robot's legs.

    Pauses, turns and other spans that are no strides (`exo_pin.gait.strides`) are left out.

    Raises:
        GaitError: There are no gait cycles.
    """
    gait = with_events(robot, gait)
    walk = unrolled(gait)
    spans = [span for side in SIDES for span in strides(walk, side)]
    counted = [span for span in spans if not span.why]
    if spans and not counted:
        raise GaitError(f"no gait cycles found: {spans[0].why}")
    return numbers_of(
        walk.time,
        sole_points(robot, walk)[:, :, 0],
        walk.events,
        pelvis=None if walk.base is None else walk.base[:, :2, 3],
        spans=counted,
        until=gait.duration if gait.periodic else float("inf"),
    )


def sole_points(robot: Robot, gait: Gait) -> Array:
    """`(n, 2, 2, 3)` left and right foot: heel and ball, midway between their corners [m]."""
    base = robot.base_of(gait)
    corners = poses(robot, robot.from_gait(gait), CORNERS, base=base)[..., :3, 3]
    return np.asarray(corners.reshape(len(gait), len(FEET), 2, 2, 3).mean(axis=3))
