"""What a controller is: a function from measured joints and the walk wanted to torques."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

from exo_pin.arrays import Array
from exo_pin.control.users_code import users_code
from exo_pin.errors import DescriptionError
from exo_pin.gait import Gait
from exo_pin.robot import Robot
from exo_pin.short_repr import short_repr


@dataclass(slots=True, eq=False)
class Reference:
    """The walk that is wanted, at one moment.

    Arrays are `(12,)` in the order of `JOINTS`, about the robot's own hip axes.

    Attributes:
        phase: Of the gait cycle from 0 to 1; of a recording, the part that is over.
        q: Joint angles [rad].
        dq: Joint velocities [rad/s].
        ddq: Joint accelerations [rad/s^2].
        feed_forward: Torques that the walk requires by inverse dynamics, with ground and support [N m].
        missing: What the person does not give of them: all without a person [N m].
    """

    phase: float
    q: Array
    dq: Array
    ddq: Array
    feed_forward: Array
    missing: Array

    __repr__ = short_repr


@runtime_checkable
class Controller(Protocol):
    """Torques of the motors.

    A controller may have `reset(robot, gait)` too, which is called once before a run: with the robot that it
    believes to control (the model, not the simulated one with its errors) and the walk.

    A controller may have `sense(pose, velocity)` too, which is called before each call with the state of the
    pelvis: pose (4, 4), and velocity (6,) linear, then angular, world axes [m/s, rad/s]. It is exact, as a
    perfect inertial sensor with odometry would give it; a controller that keeps a balance needs it.
    """

    def __call__(self, time: float, q: Array, dq: Array, reference: Reference) -> Array:
        """Torques (12,) [N m] in the order of `JOINTS`; those of joints without a motor are ignored.

        Args:
            time: Since the start of the run [s].
            q: Measured joint angles (12,) [rad]; zero where the robot has no such joint.
            dq: Measured joint velocities (12,) [rad/s].
            reference: The walk wanted now.
        """
        ...


def reset(controller: Controller, robot: Robot, gait: Gait) -> None:
    """Call a controller's `reset`, if it has one.

    Args:
        controller: Of this package or a user's.
        robot: The model that it believes to control.
        gait: The walk.

    Raises:
        DescriptionError: A user's `reset` raises or does not end.
    """
    begin = getattr(controller, "reset", None)
    if begin is not None:
        with users_code(lambda why: DescriptionError(f"the controller's reset fails: {why}")):
            begin(robot, gait)
