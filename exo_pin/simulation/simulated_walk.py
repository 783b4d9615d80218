"""`SimulatedWalk`: what was simulated, and what happened at every step, in the words of the walk."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from exo_pin import arguments
from exo_pin.anatomy import JOINTS
from exo_pin.arrays import Array
from exo_pin.control import Patient
from exo_pin.dynamics import Dynamics
from exo_pin.gait import Gait
from exo_pin.robot import Robot
from exo_pin.robot.gait_columns import in_joint_order
from exo_pin.simulation.contact_forces import FloorForces, floor_forces
from exo_pin.simulation.pelvis_support import PelvisSupport
from exo_pin.simulation.plant import Plant
from exo_pin.simulation.push import Push, pushed
from exo_pin.simulation.recording import Recording
from exo_pin.simulation.reference_motion import ReferenceMotion
from exo_pin.simulation.witness import pinocchio_state, rotations


@dataclass(frozen=True, eq=False, kw_only=True)
class SimulatedWalk:
    """One simulated walk, N steps. Joints are in the order of `JOINTS`, in the robot's own hip axes.

    Attributes:
        gait: The walk that was to be followed, as given.
        robot: The floating robot that was simulated, with the errors of its model.
        required: Its inverse dynamics, by the model.
        reference: The walk at the steps of the run.
        record: What was written down at every step.
        controller: Name of the controller.
        patient: The person; None gave no torque.
        support: What held the pelvis.
        pushes: At the pelvis.
        plant: The machine.
        body_weight_support: Constant upward force as a part of the weight.
        weight: Of the simulated robot [N].
        timestep: [s].
        ended: Why the run ended before its time; empty where it did not.
        cpu_time: What the loop took [s].
    """

    gait: Gait
    robot: Robot
    required: Dynamics
    reference: ReferenceMotion
    record: Recording
    controller: str
    patient: Patient | None
    support: PelvisSupport
    pushes: tuple[Push, ...]
    plant: Plant
    body_weight_support: float
    weight: float
    timestep: float
    ended: str
    cpu_time: float

    @property
    def time(self) -> Array:
        """`(N,)` [s]."""
        return self.reference.time[: len(self.record.qpos)]

    @cached_property
    def q(self) -> Array:
        """`(N, 12)` joint angles; zero for joints that the robot lacks [rad]."""
        return in_joint_order(self.robot.joints, self.record.qpos[:, 7:])

    @cached_property
    def dq(self) -> Array:
        """`(N, 12)` joint velocities [rad/s]."""
        return in_joint_order(self.robot.joints, self.record.qvel[:, 6:])

    @property
    def motor(self) -> Array:
        """`(N, 12)` torques of the motors [N m]."""
        return self.record.motor

    @property
    def person(self) -> Array:
        """`(N, 12)` torques of the person [N m]."""
        return self.record.person

    @property
    def support_wrench(self) -> Array:
        """`(N, 6)` of the support on the pelvis: force, moment about mid-hip, world axes [N, N m]."""
        force = pushed(self.pushes, self.reference)[: len(self.record.support)]
        return self.record.support - np.pad(force, ((0, 0), (0, 4)))

    @cached_property
    def floor(self) -> FloorForces:
        """Forces of the floor on each foot, with their centres of pressure."""
        return floor_forces(self.record.sensed)

    @cached_property
    def base(self) -> Array:
        """`(N, 4, 4)` pose of the pelvis; a treadmill's belt stands still, the pelvis moves over it."""
        T = np.tile(np.eye(4), (len(self.record.qpos), 1, 1))
        T[:, :3, :3], T[:, :3, 3] = rotations(self.record), self.record.qpos[:, :3]
        return T

    def to_gait(self, *, rate: float = 100.0) -> Gait:
        """The simulated walk as a recording: angles, pelvis; no events.

        Args:
            rate: Samples per second [Hz].
        """
        every = self.steps_per_sample(rate)
        q, _ = pinocchio_state(self.record, self.robot)
        rows = slice(None, None, every)
        time = self.time[rows]
        still = Gait(time, np.zeros((len(time), len(JOINTS))), source=f"simulated: {self.gait.source}")
        return self.robot.to_gait(q[rows], like=still)

    def steps_per_sample(self, rate: float) -> int:
        """Steps from one sample to the next at a rate [Hz], at least 1.

        Raises:
            DescriptionError: The rate is not within 0.001 to 1e6 Hz.
        """
        rate = arguments.number("rate", rate, least=1e-3, most=1e6)
        return max(round(1.0 / (rate * self.timestep)), 1)
