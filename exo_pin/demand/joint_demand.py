"""The demand of a walk on the joints of a device: position, speed, acceleration, torque, power."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass

import numpy as np

from exo_pin.anatomy import JOINTS
from exo_pin.arguments import number
from exo_pin.arrays import Array
from exo_pin.demand.quantity import PeakDemand, RangeDemand, range_demands
from exo_pin.devices import SLIDES, movement_of
from exo_pin.devices.actuator import ACCELERATION_LIMIT, DEFAULT_ACCELERATIONS
from exo_pin.gait import Gait, Torques
from exo_pin.robot import Robot
from exo_pin.robot.model import LIMIT_TOLERANCE
from exo_pin.short_repr import short_repr


@dataclass(frozen=True, eq=False)
class JointDemand:
    """The demand of one walk on one joint. A prismatic joint has metres and newtons for radians and N m.

    Attributes:
        joint: Its name.
        position: Positions against the range [rad].
        speed: Velocities against the velocity limit [rad/s].
        acceleration: Accelerations against their limit [rad/s^2].
        torque: Torques against the effort limit [N m]; None where no torque is known.
    """

    joint: str
    position: RangeDemand
    speed: PeakDemand
    acceleration: PeakDemand
    torque: PeakDemand | None = None

    __repr__ = short_repr

    @property
    def prismatic(self) -> bool:
        """Whether the joint slides [m]; all others are revolute [rad]."""
        return self.joint in SLIDES

    @property
    def power(self) -> PeakDemand | None:
        """Mechanical power, torque times velocity [W]; no device states a limit. None without torques."""
        if self.torque is None:
            return None
        return PeakDemand(self.torque.required * self.speed.required, math.inf)

    @property
    def ok(self) -> bool:
        """Whether every required quantity is available."""
        peaks = (self.speed, self.acceleration, *(() if self.torque is None else (self.torque,)))
        return not (self.position.outside.any() or any(peak.exceeded.any() for peak in peaks))

    @property
    def cadence_factor(self) -> float:
        """Largest factor on the cadence: speed grows with the factor, acceleration with its square."""
        by_speed = 1 / self.speed.use if self.speed.use else math.inf
        by_acceleration = self.acceleration.use**-0.5 if self.acceleration.use else math.inf
        return min(by_speed, by_acceleration)

    @property
    def amplitude_factor(self) -> float:
        """Largest factor on the movement about its mean that range, speed and acceleration allow.

        Zero where the mean itself is out of range; infinite for a joint that stands still within its range. A
        prismatic joint follows the pelvis, not the other joints: its factor is infinite or zero. Torques at
        another amplitude are unknown.
        """
        if self.prismatic:
            return math.inf if self.ok else 0.0
        mean, (lower, upper) = float(self.position.required.mean()), self.position.available
        if not lower - LIMIT_TOLERANCE <= mean <= upper + LIMIT_TOLERANCE:
            return 0.0
        pairs = [  # available, required
            (upper - mean, self.position.highest - mean),
            (mean - lower, mean - self.position.lowest),
            (1.0, self.speed.use),
            (1.0, self.acceleration.use),
        ]
        return min(
            max(available, 0.0) / required if required > LIMIT_TOLERANCE else math.inf
            for available, required in pairs
        )


def joint_demands(
    robot: Robot, gait: Gait, *, acceleration: float | None = None, torques: Torques | None = None
) -> tuple[JointDemand, ...]:
    """The demand of a walk on each joint that gait and robot share, in the order of `exo_pin.anatomy.JOINTS`.

    The pelvis's prismatic joints are not among them: `exo_pin.feasible` derives theirs from the pelvis.

    Args:
        robot: The device. Angles and rates are those of its own joints, in its own hip order.
        gait: The walk.
        acceleration: Largest acceleration of every joint [rad/s^2]; the device's own if left out.
        torques: Joint torques of this walk, about the clinical axes; unknown if left out.

    Raises:
        GaitError: The torques are at other times than the walk.
        DescriptionError: The acceleration is no positive number.
    """
    if acceleration is not None:
        number("acceleration", acceleration, above=0.0)
    own, tau = _in_hip_order(robot, gait), None if torques is None else torques.at(gait.time)
    available = (
        acceleration_limits(robot) if acceleration is None else np.full(len(robot.joints), acceleration)
    )
    positions = range_demands(robot, robot.from_gait(gait))
    found = []
    for k, name in enumerate(JOINTS):
        if name in robot.joints:
            j = robot.joints.index(name)
            demand = JointDemand(
                joint=name,
                position=positions[name],
                speed=PeakDemand(own.dq[:, k], float(robot.velocity[j])),
                acceleration=PeakDemand(own.ddq[:, k], float(available[j])),
                torque=None if tau is None else _torque(tau[:, k], float(robot.effort[j])),
            )
            found.append(demand)
    return tuple(found)


def acceleration_limits(robot: Robot) -> Array:
    """Largest accelerations (J,) of a robot's joints by its record [rad/s^2]; infinite for slides [m/s^2]."""
    if robot.device is None:
        return np.array([DEFAULT_ACCELERATIONS.get(movement_of(j), ACCELERATION_LIMIT) for j in robot.joints])
    actuators = robot.device.actuators
    limits = [actuators[movement_of(joint)].acceleration for joint in robot.joints]
    return np.array(limits, dtype=float)


def _torque(tau: Array, effort: float) -> PeakDemand | None:
    return None if np.isnan(tau).all() else PeakDemand(tau, effort)


def _in_hip_order(robot: Robot, gait: Gait) -> Gait:
    """The gait with the hip angles of the robot's own order of axes."""
    if robot.hip_order == "clinical":
        return gait
    q, angles = np.array(gait.q), robot.angles(robot.from_gait(gait))
    for k, name in enumerate(JOINTS):
        if name in robot.joints:
            q[:, k] = angles[:, robot.joints.index(name)]
    return dataclasses.replace(gait, q=q)
