"""What a walk asks of the device that carries the pelvis: of its slides, and of what it holds."""

from __future__ import annotations

import numpy as np

from exo_pin.arrays import Array
from exo_pin.demand import JointDemand
from exo_pin.devices import SLIDES
from exo_pin.gait import Gait
from exo_pin.gait.curves import derivative
from exo_pin.gait.rigid import angle_of
from exo_pin.kinematics.resting_stance import stand
from exo_pin.robot import Robot

TURN = "pelvis_turn"


def slides(robot: Robot, gait: Gait) -> list[JointDemand]:
    """What each slide of the device is asked, about the pelvis' mean place [m].

    No source limits their acceleration.
    """
    if gait.base is None:
        return []
    shift, period = _seen(gait)[:, :3, 3], gait.duration if gait.periodic else None
    found = []
    for axis, name in enumerate(SLIDES):
        if name in robot.joints:
            j, way = robot.joints.index(name), shift[:, axis : axis + 1]
            demand = JointDemand(
                joint=name,
                q=way[:, 0],
                dq=derivative(gait.time, way, 1, period)[:, 0],
                ddq=derivative(gait.time, way, 2, period)[:, 0],
                lower=float(robot.lower[j]),
                upper=float(robot.upper[j]),
                speed=float(robot.velocity[j]),
                acceleration=np.inf,
            )
            found.append(demand)
    return found


def dropped(robot: Robot, gait: Gait) -> dict[str, float]:
    """What the walk's pelvis does and the device does not let it: by slide [m], and `TURN` [rad], largest.

    Nothing where the pelvis goes with the person.
    """
    if gait.base is None or (robot.device is not None and robot.device.pelvis == "free"):
        return {}
    seen = _seen(gait)
    lost = {
        name: float(np.abs(seen[:, axis, 3]).max())
        for axis, name in enumerate(SLIDES)
        if name not in robot.joints
    }
    return lost | {TURN: float(angle_of(seen[:, :3, :3]).max())}


def _seen(gait: Gait) -> Array:
    """T_stand_pelvis (n, 4, 4)."""
    assert gait.base is not None  # the callers ask
    return np.asarray(np.linalg.inv(stand(gait.time, gait.base, periodic=gait.periodic)) @ gait.base)
