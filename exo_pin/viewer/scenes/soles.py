"""The soles of any robot's feet, found in the foot's own shape: where it touches a level ground."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from exo_pin.anatomy import Body, Leg
from exo_pin.arrays import Array
from exo_pin.kinematics import poses
from exo_pin.retarget import Biped
from exo_pin.retarget.robot_legs import RobotLeg
from exo_pin.viewer.meshes.solids import Solid

_THICKNESS = 0.03
"""What lies less than this share of the leg above the lowest point belongs to the sole."""

_LEAST_HALF_WIDTH = 0.012
"""A sole reaches at least this far from its middle [m], so that a point foot has one."""


@dataclass(frozen=True, eq=False)
class Sole:
    """A foot's sole.

    Attributes:
        link: The foot's link.
        T: T_link_sole (4, 4): on the ground under the ankle, in the walker's axes, as the robot stands.
        corners: Heel medial, heel lateral, ball medial, ball lateral (4, 3), in the sole's axes [m].
        tip: How far the foot reaches forward in these axes [m]; the ball is no further forward than a
            person's, for a rigid foot that rolled over a longer tip would lift the whole robot.
    """

    link: str
    T: Array
    corners: Array
    tip: float

    @property
    def size(self) -> tuple[float, float]:
        """Length and width [m]."""
        return self.tip - float(self.corners[:, 0].min()), float(np.ptp(self.corners[:, 1]))

    @property
    def middle(self) -> tuple[float, float]:
        """Middle of the sole in its own axes, x and y [m]."""
        heel, y = self.corners[:, 0].min(), self.corners[:, 1]
        return float(heel + self.tip) / 2, float(y.min() + y.max()) / 2


def soles(biped: Biped, shapes: dict[str, Solid]) -> tuple[Sole, Sole]:
    """The soles of both feet from the shapes of the links (in their own axes).

    A foot without a shape gets a person's sole, as long for its leg as a person's is.
    """
    left, right = (_sole(biped, leg, shapes) for leg in biped.legs)
    return left, right


def _sole(biped: Biped, leg: RobotLeg, shapes: dict[str, Solid]) -> Sole:
    points = _points(biped, leg, shapes)
    if not len(points):
        return _persons_sole(leg)
    ground = float(points[:, 2].min())
    low = points[points[:, 2] < ground + _THICKNESS * leg.reach]
    ends = np.stack([low[:, :2].min(axis=0), low[:, :2].max(axis=0)])
    middle, half = ends.mean(axis=0), np.maximum(np.ptp(ends, axis=0) / 2, _LEAST_HALF_WIDTH)
    return _at(leg, ground, middle - half, middle + half)


def _points(biped: Biped, leg: RobotLeg, shapes: dict[str, Solid]) -> Array:
    """Vertices (k, 3) of all that moves with the foot's last joint, standing, in the walker's axes [m]."""
    robot = biped.robot
    joint = robot.model.frames[robot.frame(leg.foot)].parentJoint
    links = [
        str(frame.name)
        for frame in robot.model.frames
        if frame.type == pin.FrameType.BODY and frame.parentJoint == joint and frame.name in shapes
    ]
    if not links:
        return np.zeros((0, 3))
    T = poses(robot, biped.stand, links)
    rows = [shapes[link].vertices @ T[k, :3, :3].T + T[k, :3, 3] for k, link in enumerate(links)]
    return np.asarray(np.concatenate(rows) @ biped.rotation)


def _persons_sole(leg: RobotLeg) -> Sole:
    size, scale = _person_scale(leg)
    x, y, z = leg.ankle.tolist()
    heel, toes = x - scale * size.heel, x + scale * (size.foot_length - size.heel)
    half = scale * size.foot_width / 2
    ground = z - scale * size.ankle_height
    return _at(leg, ground, np.array([heel, y - half]), np.array([toes, y + half]))


def _person_scale(leg: RobotLeg) -> tuple[Leg, float]:
    """A person's leg, and the robot's over it."""
    size = Body.from_stature().leg("left")
    return size, leg.reach / (size.thigh + size.shank)


def _at(leg: RobotLeg, ground: float, low: Array, high: Array) -> Sole:
    """A sole between two corners (2,) at a height, all standing in the walker's axes."""
    T = np.eye(4)
    T[:3, 3] = *leg.ankle[:2], ground
    low, high = low - leg.ankle[:2], high - leg.ankle[:2]
    medial, lateral = (low[1], high[1]) if leg.side == "left" else (high[1], low[1])
    size, scale = _person_scale(leg)
    ball = min(float(high[0]), scale * size.ball)
    corners = np.array([[x, y, 0.0] for x in (low[0], ball) for y in (medial, lateral)])
    return Sole(leg.foot, np.linalg.inv(leg.T) @ T, corners, float(high[0]))
