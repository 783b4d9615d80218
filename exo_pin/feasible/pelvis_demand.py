"""Demand of a walk on the pelvis's carrier: its prismatic joints, and the motion that it blocks."""

from __future__ import annotations

import numpy as np

from exo_pin.arrays import Array
from exo_pin.demand import JointDemand, PeakDemand, RangeDemand
from exo_pin.devices import SLIDES
from exo_pin.gait import Gait
from exo_pin.gait.rigid_poses import angle_of
from exo_pin.gait.time_series import derivative
from exo_pin.kinematics.resting_stance import stand
from exo_pin.robot import Robot


def slide_demands(robot: Robot, gait: Gait) -> tuple[JointDemand, ...]:
    """The demand on each prismatic joint of the pelvis, about the pelvis's mean place [m].

    Their acceleration has no limit: no source states one.
    """
    if gait.base is None:
        return ()
    places, period = _from_stand(gait, gait.base)[:, :3, 3], gait.duration if gait.periodic else None
    found = []
    for axis, name in enumerate(SLIDES):
        if name in robot.joints:
            j, place = robot.joints.index(name), places[:, axis : axis + 1]
            dq, ddq = (derivative(gait.time, place, order, period)[:, 0] for order in (1, 2))
            demand = JointDemand(
                joint=name,
                position=RangeDemand(place[:, 0], (float(robot.lower[j]), float(robot.upper[j]))),
                speed=PeakDemand(dq, float(robot.velocity[j])),
                acceleration=PeakDemand(ddq, np.inf),
            )
            found.append(demand)
    return tuple(found)


def blocked_motion(robot: Robot, gait: Gait) -> dict[str, float]:
    """Largest motion of the pelvis that the device blocks, by prismatic joint [m]; and `pelvis_turn` [rad].

    Empty where the pelvis moves freely with the person.
    """
    if gait.base is None or (robot.device is not None and robot.device.pelvis == "free"):
        return {}
    T_stand_pelvis = _from_stand(gait, gait.base)
    blocked = {
        name: float(np.abs(T_stand_pelvis[:, axis, 3]).max())
        for axis, name in enumerate(SLIDES)
        if name not in robot.joints
    }
    return blocked | {"pelvis_turn": float(angle_of(T_stand_pelvis[:, :3, :3]).max())}


def _from_stand(gait: Gait, base: Array) -> Array:
    """T_stand_pelvis (n, 4, 4)."""
    return np.asarray(np.linalg.inv(stand(gait.time, base, periodic=gait.periodic)) @ base)
