"""`feasible`: a walk is asked of a device, joint by joint, part by part, and the answers become a verdict."""

from __future__ import annotations

import contextlib
import dataclasses

import numpy as np

from exo_pin.anatomy import JOINTS, SIDES, Body
from exo_pin.anatomy.names import Side
from exo_pin.demand import ACCELERATION, demands
from exo_pin.devices import Device
from exo_pin.errors import GaitError
from exo_pin.feasible.amplitude import amplitude
from exo_pin.feasible.collision import nearest
from exo_pin.feasible.device_fit import fits, keeps_up
from exo_pin.feasible.feasibility import FASTEST, Feasibility
from exo_pin.feasible.pelvis_demand import dropped, slides
from exo_pin.gait import Gait, Torques
from exo_pin.kinematics import with_events
from exo_pin.robot import Robot, load_robot


def feasible(
    gait: Gait,
    device: str | Device = "exo12",
    body: Body | None = None,
    *,
    acceleration: float = ACCELERATION,
    gap: float = 0.0,
    torques: Torques | None = None,
) -> Feasibility:
    """Whether a device can do a walk with a person, the pelvis moving as its slides let it.

    Args:
        gait: The walk. A recording's accelerations carry its noise: filter it first.
        device: Name, file or record.
        body: Who wears it; `Body.from_stature()` if left out.
        acceleration: Largest acceleration of every joint [rad/s^2].
        gap: Distance that parts of the device must keep [m].
        torques: What the walk asks of the joints, on its clock; torques are not asked if left out.

    Raises:
        UnknownNameError: The device is unknown.
        GaitError: The torques are on another clock.
    """
    robot = load_robot(body, device=device)
    full = np.array(gait.q)
    done = dataclasses.replace(robot.to_gait(robot.from_gait(gait), gait), base=gait.base)
    with contextlib.suppress(GaitError):  # no cycles in it: phases are then unknown
        done = with_events(robot, done)
    asked = demands(robot, done, acceleration=acceleration, torques=torques) + slides(robot, gait)
    fitted = fits(robot, gait)
    belts = [fit for fit in fitted if fit.what == "treadmill" and fit.asked > 0.0]
    locked = [k for k, joint in enumerate(JOINTS) if joint not in robot.joints]
    return Feasibility(
        robot=robot,
        gait=done,
        joints=tuple(asked),
        nearest=nearest(robot, robot.from_gait(done)),
        gap=gap,
        fits=fitted,
        reach={side: _reach(robot, done, side) for side in SIDES},
        dropped={JOINTS[k]: float(np.abs(full[:, k]).max()) for k in locked} | dropped(robot, gait),
        cadence=min(FASTEST, *(demand.cadence for demand in asked), *(fit.high / fit.asked for fit in belts)),
        amplitude=amplitude(robot, gait, asked, gap, [keeps_up(fit, robot) for fit in belts]),
    )


def _reach(robot: Robot, gait: Gait, side: Side) -> float:
    """What the straightest knee reaches from hip to ankle, less what is asked, least over the walk [m]."""
    assert robot.body is not None  # load_robot made it
    leg, name = robot.body.leg(side), f"{side}_knee_flexion"
    straightest = 0.0
    if name in robot.joints:
        k = robot.joints.index(name)
        straightest = float(np.clip(0.0, robot.lower[k], robot.upper[k]))
    knee = np.append(gait.q[:, JOINTS.index(name)], straightest)
    length = np.sqrt(leg.thigh**2 + leg.shank**2 + 2 * leg.thigh * leg.shank * np.cos(knee))
    return float((length[-1] - length[:-1]).min())
