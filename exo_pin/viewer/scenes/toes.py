"""Toes in the picture: a gait has no toe angles, so they bend as far as the ground demands."""

from __future__ import annotations

import numpy as np

from exo_pin.anatomy import SIDES, Body
from exo_pin.arrays import Array
from exo_pin.devices import TOES
from exo_pin.ground.placement import Placement
from exo_pin.ground.stance import lowest_corners


def toes(body: Body, shown: Placement) -> dict[str, Array]:
    """Toe angles (n,) [rad] by joint, toes up positive, that keep the tips out of the ground.

    A toe of length L behind a ball at height h, on a foot that points down by an angle a, reaches the ground
    where h = L sin(a - toe); it bends by what is beyond that.
    """
    angles = {}
    for k, (side, joint) in enumerate(zip(SIDES, TOES, strict=True)):
        leg = body.leg(side)
        length = leg.foot_length - leg.heel - leg.ball
        down = np.arcsin(np.clip(-shown.feet[:, k, 2, 0], -1.0, 1.0))
        height = np.clip(lowest_corners(shown.corners)[side], 0.0, length)
        angles[joint] = np.maximum(down - np.arcsin(height / length), 0.0)
    return angles
