"""The loop of a simulation: measure, control, support, step; every step is written down."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from exo_pin.anatomy import JOINTS
from exo_pin.arrays import Array, as_floats
from exo_pin.control import Controller, Patient, Reference, raised_where
from exo_pin.control.users_code import LONGEST_ANSWER, time_limit
from exo_pin.errors import DescriptionError, ExoPinError
from exo_pin.robot import Robot
from exo_pin.robot.floating_base import base_coordinates, base_poses
from exo_pin.simulation.pelvis_support import PelvisSupport
from exo_pin.simulation.plant import Joints
from exo_pin.simulation.recording import Columns, Recording
from exo_pin.simulation.reference_motion import ReferenceMotion
from exo_pin.simulation.support_force import SupportForce

_FREE = 6

_LOOK = 10
"""Steps from one look at the engine's warnings to the next: a look takes 1 us, and a bad state stays."""

_FASTEST = 50.0
"""A joint that is faster diverges [rad/s]."""


@contextlib.contextmanager
def _no_log() -> Iterator[None]:
    """MuJoCo writes no file of its warnings into the working folder: the loop reads them from the state."""
    import mujoco

    before = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(lambda message: None)
    try:
        yield
    finally:
        mujoco.set_mju_user_warning(before)


def _too_long(step: int) -> DescriptionError:
    return DescriptionError(
        f"the controller does not answer within {LONGEST_ANSWER:g} s in step {step}; "
        "it is called once a step and returns 12 torques"
    )


def _columns(places: list[int]) -> Columns:
    """Places as an index: a slice where they follow each other, which is five times faster."""
    first = places[0]
    whole = places == list(range(first, first + len(places)))
    return slice(first, first + len(places)) if whole else np.array(places)


class Loop:
    """One run, step by step; `run` does it all.

    Args:
        model: MuJoCo's model.
        robot: The floating robot that it was made from.
        walk: The walk to follow.
        controller: Gives the motors' torques.
        joints: Motors, friction and encoders.
        patient: The person; None gives no torque.
        support: Holds the pelvis.
        unloading: Constant upward force at mid-hip [N].
        pushes: `(N, 2)` horizontal force at mid-hip in each step [N].
        every: Steps from one call of the controller to the next.
        delay: Steps from measurement to torque.
    """

    def __init__(
        self,
        model: Any,
        robot: Robot,
        walk: ReferenceMotion,
        controller: Controller,
        joints: Joints,
        patient: Patient | None,
        support: PelvisSupport,
        unloading: float,
        pushes: Array,
        *,
        every: int = 1,
        delay: int = 0,
    ) -> None:
        import mujoco

        self._model, self._walk, self._controller = model, walk, controller
        self._sense = getattr(controller, "sense", None)
        self._joints, self._patient = joints, patient
        self._support = SupportForce(support, walk, unloading, pushes)
        self._every, self._delay = every, delay
        self._data, self._advance = mujoco.MjData(model), mujoco.mj_step
        names = [name for name in robot.joints if name in JOINTS]
        self._ours = _columns([JOINTS.index(name) for name in names])
        self._qpos = _columns([model.joint(name).qposadr[0] for name in names])
        self._dofs = _columns([model.joint(name).dofadr[0] for name in names])
        self._record = Recording(len(walk.time), model, self._ours)
        bad = (
            mujoco.mjtWarning.mjWARN_BADQPOS,
            mujoco.mjtWarning.mjWARN_BADQVEL,
            mujoco.mjtWarning.mjWARN_BADQACC,
        )
        self._warnings = [int(kind) for kind in bad]
        self._given = np.zeros(walk.torque.shape) if patient is None else patient.given(walk.torque)
        self._times, self._references = walk.time.tolist(), self._wanted_walk()
        self._q, self._dq = np.zeros(len(JOINTS)), np.zeros(len(JOINTS))
        self._nerves = 0 if patient is None else round(patient.delay / float(model.opt.timestep))
        self._start()

    def run(self, after: Callable[[int], None] = lambda step: None) -> tuple[Recording, str]:
        """Run to the end, or to the last good step.

        Args:
            after: Called after each step with its number.

        Returns:
            What happened, and why it ended early (empty: it did not).

        Raises:
            DescriptionError: The controller's answer cannot be used.
        """
        record = self._record
        with time_limit(LONGEST_ANSWER, _too_long) as progress, _no_log():
            for k in range(len(self._walk.time)):
                why = self._step(k)
                if why:
                    record.cut(max(k, 1))
                    return record, why
                progress.steps = k + 1
                after(k)
        return record, ""

    def _step(self, k: int) -> str:
        """One step; why the run cannot go on after it, empty if it can."""
        record, data = self._record, self._data
        record.qpos[k], record.qvel[k] = data.qpos, data.qvel
        self._q[self._ours] = data.qpos[self._qpos]
        self._dq[self._ours] = data.qvel[self._dofs]
        record.wanted[k] = record.wanted[k - 1] if k % self._every else self._asked(k)
        self._apply(k)
        self._advance(self._model, data)
        record.constraint[k] = data.qfrc_constraint
        record.sensed[k] = data.sensordata
        record.energy[k] = data.energy
        self._look()
        return self._bad(k)

    def _start(self) -> None:
        """Put the robot where the walk begins, with the walk's velocities."""
        walk, data = self._walk, self._data
        data.qpos[:7] = base_coordinates(walk.base[0])[[0, 1, 2, 6, 3, 4, 5]]  # the real part first
        data.qvel[:3] = walk.base_velocity[0, :3]
        data.qvel[3:_FREE] = walk.base[0, :3, :3].T @ walk.base_velocity[0, 3:]
        data.qpos[self._qpos], data.qvel[self._dofs] = walk.q[0][self._ours], walk.dq[0][self._ours]
        self._look()

    def _look(self) -> None:
        """The state as lists: the support and the limits compute with plain floats."""
        self._place, self._rates = self._data.qpos.tolist(), self._data.qvel.tolist()
        speeds = self._rates[_FREE:]
        self._fastest = max(max(speeds), -min(speeds))

    def _wanted_walk(self) -> Iterator[Reference]:
        """The walk for the controller: a record for each call, of arrays that nothing else reads."""
        walk, given = self._walk, self._given
        parts = (walk.q, walk.dq, walk.ddq, walk.torque, walk.torque - given)
        rows = [x[:: self._every].copy() for x in parts]
        return map(Reference, walk.phase[:: self._every].tolist(), *rows)

    def _asked(self, k: int) -> Array:
        """The controller's answer, checked. It gets copies of everything, which it may change."""
        time, now = self._times[k], next(self._references)
        try:
            if self._sense is not None:
                self._sense(*self._pelvis())
            tau = self._controller(time, self._joints.measured(self._q), self._dq.copy(), now)
        except ExoPinError:
            raise
        except (Exception, SystemExit) as error:  # whatever a user's code raises
            raise DescriptionError(f"the controller fails at {time:.3f} s: {raised_where(error)}") from error
        try:
            answer = as_floats(tau)
        except (TypeError, ValueError, OverflowError):
            answer = np.zeros(0)
        if answer.shape != (len(JOINTS),) or not math.isfinite(sum(answer.tolist())):
            raise DescriptionError(
                f"the controller's answer at {time:.3f} s is {tau!r:.80}; "
                f"{len(JOINTS)} finite torques [N m] are accepted"
            )
        return answer

    def _pelvis(self) -> tuple[Array, Array]:
        """Pose (4, 4) and velocity (6,) of the pelvis, world axes."""
        x, y, z, w, i, j, k = self._place[:7]
        T, rates = base_poses(np.array([x, y, z, i, j, k, w])), np.array(self._rates[:_FREE])
        rates[3:] = T[:3, :3] @ rates[3:]
        return T, rates

    def _apply(self, k: int) -> None:
        """Torques of motors, person and friction, and the support, as generalised forces."""
        record, force, dq = self._record, self._data.qfrc_applied, self._dq
        total = self._joints.motor(record.wanted[max(k - self._delay, 0)], dq, self._fastest)
        record.motor[k] = total
        if self._patient is not None:
            person = self._person(k)
            record.person[k] = person
            total = total + person
        friction = self._joints.friction(dq)
        if friction is not None:
            record.friction[k] = friction
            total = total + friction
        force[self._dofs] = total[self._ours]
        record.support[k], force[:_FREE] = self._support.at(k, self._place, self._rates)

    def _person(self, k: int) -> Array:
        """Torques (12,) of the person: what nerves give is late, tissues are not."""
        assert self._patient is not None
        walk, past = self._walk, max(k - self._nerves, 0)
        if self._nerves:
            qpos, qvel = self._record.qpos[past], self._record.qvel[past]
            late, rate = np.zeros(len(JOINTS)), np.zeros(len(JOINTS))
            late[self._ours], rate[self._ours] = qpos[self._qpos], qvel[self._dofs]
        else:
            late, rate = self._q, self._dq
        own = self._patient.own(late, rate, walk.q[past], walk.dq[past])
        torque: Array = self._given[past] + own + self._patient.tissues(self._q)
        return torque

    def _bad(self, k: int) -> str:
        """Why the run cannot go on."""
        if not math.isfinite(sum(self._rates) + sum(self._place)):
            return "a position or velocity is not finite"
        if self._fastest > _FASTEST:
            return f"a joint is faster than {_FASTEST:g} rad/s"
        if k % _LOOK == 0 and self._data.warning.number[self._warnings].any():
            return "MuJoCo warns of a bad state"
        return ""
