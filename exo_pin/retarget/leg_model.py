"""Both legs of a biped as a robot of their own: what inverse kinematics moves, the rest held as it stands."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pinocchio as pin

from exo_pin.arrays import Array
from exo_pin.retarget.robot_legs import RobotLeg
from exo_pin.robot import Robot


def leg_model(legs: Sequence[RobotLeg]) -> Robot:
    """A robot of the legs' joints alone, zero where the biped stands, in the walker's axes.

    Waist, arms and toes are held as they stand, knees keep to their branch; a joint that follows another is
    one of the robot's joints. Frames are the feet's links by their sides, so that no name occurs twice.

    Args:
        legs: Left and right.
    """
    model = pin.Model()
    for leg in legs:
        _add(model, leg)
    return Robot(
        model=model,
        urdf="",
        joints=tuple(model.names)[1:],
        lower=np.array(model.lowerPositionLimit),
        upper=np.array(model.upperPositionLimit),
        velocity=np.array(model.velocityLimit),
        effort=np.array(model.effortLimit),
        placement=np.eye(4),
    )


def _chain_limits(leg: RobotLeg) -> Array:
    """Limits (K, 2) of all joints of the chain, the knee on its branch [rad]."""
    found = np.zeros((len(leg.chain), 2))
    for k, row in enumerate(leg.drive):
        j = int(np.flatnonzero(row)[0])
        found[k] = np.sort(row[j] * leg.allowed[j])
    return found


def _add(model: pin.Model, leg: RobotLeg) -> None:
    parent, frame, place = 0, 0, np.zeros(3)
    for k, (low, high) in enumerate(_chain_limits(leg)):
        axis, point = leg.chain_axes[k], leg.chain_points[k]
        joint = pin.JointModelRevoluteUnaligned(axis / np.linalg.norm(axis))
        shift = pin.SE3(np.eye(3), point - place)
        bounds = ([0.0], [0.0], [low], [high])
        parent = model.addJoint(parent, joint, shift, f"{leg.side} {k}", *map(np.array, bounds))
        frame = model.addJointFrame(parent)
        place = point
    tip = pin.SE3(leg.T[:3, :3], leg.T[:3, 3] - place)
    model.addFrame(pin.Frame(leg.side, parent, frame, tip, pin.FrameType.BODY))
