"""A recorded knee beyond its stop: held there, so that the foot moves; or bent, so that the foot stays."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

import numpy as np

from exo_pin import ik
from exo_pin.anatomy import FEET, JOINTS, SIDES
from exo_pin.arrays import Array, Mask
from exo_pin.gait import Gait
from exo_pin.kinematics import poses
from exo_pin.robot import Robot
from exo_pin.robot.model import LIMIT_TOLERANCE


@dataclass(frozen=True, eq=False)
class HeldKnees:
    """A walk whose knees stop where the device's do.

    Attributes:
        gait: The walk with the knees held.
        frames: Samples (n, 2) in which the left and the right knee are held.
        moved: By how much each foot moves (n, 2) [m].
    """

    gait: Gait
    frames: Mask
    moved: Array

    @property
    def words(self) -> str:
        """Feet, millimetres and frames."""
        return ", ".join(
            f"{side} foot {1e3 * self.moved[:, k].max():.1f} mm off in {int(self.frames[:, k].sum())} frames"
            for k, side in enumerate(SIDES)
            if self.frames[:, k].any()
        )


def held_at_stop(robot: Robot, device: Robot, gait: Gait) -> HeldKnees | None:
    """The walk with hyperextended knees held at the stop; None where no knee goes beyond it.

    Args:
        robot: The full exoskeleton for the body, on which the feet are computed.
        device: The device; a knee that it locks has no stop.
        gait: The walk.
    """
    q, frames = np.array(gait.q), np.zeros((len(gait), len(SIDES)), dtype=bool)
    for k, side in enumerate(SIDES):
        name = f"{side}_knee_flexion"
        if name in device.joints:
            stop, j = float(device.lower[device.joints.index(name)]), JOINTS.index(name)
            frames[:, k] = q[:, j] < stop - LIMIT_TOLERANCE
            q[frames[:, k], j] = stop
    if not frames.any():
        return None
    held = dataclasses.replace(gait, q=q)
    before, after = (poses(robot, robot.from_gait(g), FEET, base=g.base)[..., :3, 3] for g in (gait, held))
    return HeldKnees(held, frames, np.linalg.norm(after - before, axis=-1))


def bent(robot: Robot, gait: Gait) -> Gait:
    """The walk with the feet where they are, and knees within their limits: what `ik.track` answers."""
    base = robot.base_of(gait)
    feet = poses(robot, robot.from_gait(gait), FEET, base=base)
    track = ik.track(robot, {foot: feet[:, k] for k, foot in enumerate(FEET)}, base=base)
    return robot.to_gait(track.q, gait)
