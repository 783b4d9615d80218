"""Assessment of a walk on a device: demand, collisions, reach, fit, largest cadence and amplitude."""

from __future__ import annotations

import contextlib
import dataclasses

import numpy as np

from exo_pin.anatomy import JOINTS, SIDES, Body
from exo_pin.anatomy.names import HipOrder, Side
from exo_pin.arguments import number
from exo_pin.demand import joint_demands
from exo_pin.devices import Device
from exo_pin.errors import GaitError
from exo_pin.feasible.amplitude import largest_amplitude
from exo_pin.feasible.collision import nearest
from exo_pin.feasible.device_fit import fits, within_belt_speed
from exo_pin.feasible.feasibility import LARGEST_CADENCE, Feasibility
from exo_pin.feasible.pelvis_demand import blocked_motion, slide_demands
from exo_pin.gait import Gait, Torques
from exo_pin.kinematics import with_events
from exo_pin.robot import Robot, load_robot


def feasible(
    gait: Gait,
    device: str | Device = "exo12",
    body: Body | None = None,
    *,
    acceleration: float | None = None,
    gap: float = 0.0,
    torques: Torques | None = None,
    hip_order: HipOrder = "clinical",
) -> Feasibility:
    """Whether a device can do a walk with a person; the pelvis moves as the device's prismatic joints allow.

    Args:
        gait: The walk. The accelerations of a recording carry its noise: filter it first.
        device: Name, file or record.
        body: Who wears it; `Body.from_stature()` if left out.
        acceleration: Largest acceleration of every joint [rad/s^2]; the device's own if left out.
        gap: Distance that parts of the device must keep [m].
        torques: Joint torques of the walk; not checked if left out.
        hip_order: Order of the hip axes, which have the limits.

    Raises:
        UnknownNameError: The device is unknown.
        GaitError: The torques are at other times than the walk.
        DescriptionError: Acceleration or gap is no finite number.
    """
    gap = number("gap", gap)
    robot = load_robot(body, device=device, hip_order=hip_order)
    done = dataclasses.replace(robot.to_gait(robot.from_gait(gait), gait), base=gait.base)
    with contextlib.suppress(GaitError):  # without cycles the phases are unknown
        done = with_events(robot, done)
    demands = joint_demands(robot, done, acceleration=acceleration, torques=torques)
    demands += slide_demands(robot, gait)
    fitted = fits(robot, gait)
    belts = [fit for fit in fitted if fit.what == "treadmill" and fit.required > 0.0]
    by_belt = (fit.available[1] / fit.required for fit in belts)
    return Feasibility(
        robot=robot,
        gait=done,
        joints=demands,
        nearest=nearest(robot, robot.from_gait(done)),
        gap=gap,
        fits=fitted,
        reach={side: _remaining_reach(robot, done, side) for side in SIDES},
        dropped=_locked_angles(robot, gait) | blocked_motion(robot, gait),
        cadence=min(LARGEST_CADENCE, *(demand.cadence_factor for demand in demands), *by_belt),
        amplitude=largest_amplitude(
            robot, gait, demands, gap, [within_belt_speed(fit, robot) for fit in belts]
        ),
    )


def _locked_angles(robot: Robot, gait: Gait) -> dict[str, float]:
    """Largest angle of the walk at each joint that the device locks [rad]."""
    largest = zip(JOINTS, np.abs(gait.q).max(axis=0).tolist(), strict=True)
    return {joint: angle for joint, angle in largest if joint not in robot.joints}


def _remaining_reach(robot: Robot, gait: Gait, side: Side) -> float:
    """Distance from hip to ankle with the straightest knee, less the largest one in the walk [m]."""
    assert robot.body is not None  # load_robot made it
    leg, name = robot.body.leg(side), f"{side}_knee_flexion"
    straightest = 0.0
    if name in robot.joints:
        k = robot.joints.index(name)
        straightest = float(np.clip(0.0, robot.lower[k], robot.upper[k]))
    knee = np.append(gait.q[:, JOINTS.index(name)], straightest)
    length = np.sqrt(leg.thigh**2 + leg.shank**2 + 2 * leg.thigh * leg.shank * np.cos(knee))
    return float((length[-1] - length[:-1]).min())
