"""Predicted ground reaction of a walk without force plates: an assumption, never a measurement.

The vertical force is what the motion of the whole body takes, less the body-weight support; two standing feet
share it; each foot's force acts at its lowest sole corners and points to a virtual pivot above the
hips (Maus et al., Nature Communications 1:70, 2010). What the horizontal motion takes beyond that is
the support's.
"""

from __future__ import annotations

import numpy as np

from exo_pin.anatomy import CORNERS, FEET
from exo_pin.arrays import Array
from exo_pin.dynamics.base_motion import Motion
from exo_pin.dynamics.ground_forces import GroundForces
from exo_pin.kinematics import poses
from exo_pin.robot import Robot

PIVOT_HEIGHT = 0.3
"""Of the point above mid-hip that the forces pass through [m]: hip torques stay small with it (a choice)."""

_SOFTNESS = 0.006
"""Height [m] over which the weight goes from one corner of a sole to the next, as a foot rolls."""


def predicted(robot: Robot, motion: Motion, vertical: Array, share: Array) -> GroundForces:
    """Ground forces of a walk on level ground.

    Args:
        robot: A floating robot with the corners of its soles.
        motion: Its motion, n samples.
        vertical: `(n,)` vertical force of both feet [N]; a ground cannot pull, so less than 0 counts as 0.
        share: `(n, 2)` part of it under each foot.
    """
    corners = poses(robot, motion.q, CORNERS)[..., :3, 3].reshape(len(motion.q), len(FEET), -1, 3)
    height = corners[..., 2] - corners[..., 2].min(axis=-1, keepdims=True)
    weight = np.exp(-height / _SOFTNESS)
    weight /= weight.sum(axis=-1, keepdims=True)
    point = np.einsum("nfc,nfck->nfk", weight, corners)
    towards = motion.base[:, None, :3, 3] + [0.0, 0.0, PIVOT_HEIGHT] - point
    load = np.maximum(vertical, 0.0)[:, None] * share
    force = load[..., None] * towards / towards[..., 2:]
    return GroundForces(force, np.where(load[..., None] > 0.0, point, np.nan), np.zeros_like(force))
