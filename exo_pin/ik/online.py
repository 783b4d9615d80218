"""Inverse kinematics online: one sample after another, for a control loop of 1 kHz."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from math import dist
from typing import Any

import numpy as np
import numpy.typing as npt
import pinocchio as pin

from exo_pin.anatomy import FEET
from exo_pin.arrays import Array, Index
from exo_pin.errors import DescriptionError
from exo_pin.ik.least_squares.driver import minimise
from exo_pin.ik.least_squares.single_sample import SampleKernel
from exo_pin.ik.leg.scalar import approximate_formula, exact_formula
from exo_pin.ik.settings import Dls
from exo_pin.ik.targets import Goal, pose_array
from exo_pin.robot import Robot
from exo_pin.robot.leg_axes import LEG_JOINTS, LegAxes

_asarray, _forward_kinematics = np.asarray, pin.framesForwardKinematics  # found once: an inner loop


class Online:
    """Inverse kinematics that keeps its state from call to call.

    `q = online.step(T_left, T_right)` answers a pair of foot poses by the closed form (by a few damped steps
    from the last answer on legs that have none), checks the answer with Pinocchio's forward kinematics, and
    never leaves the joint limits or, if `dt` is given, the joints' speed limits. A target that cannot be met
    changes nothing: the last good answer is returned and `reached` is False.

    Attributes:
        q: The present answer (nq,); the same array after every step.
        reached: Whether the last target was met within the tolerance.
        slowed: Whether a speed limit cut the last step short; `reached` is False then, too.
    """

    def __init__(
        self,
        robot: Robot,
        q0: npt.ArrayLike | None = None,
        *,
        frames: Sequence[str] = FEET,
        tolerance: float = 1e-9,
        dt: float | None = None,
        max_iterations: int = 8,
        base: npt.ArrayLike | None = None,
    ) -> None:
        """Prepare a loop.

        Args:
            robot: The robot; a floating base stays where q0 has it.
            q0: The configuration (nq,) at the start; joints at zero if left out.
            frames: Frames that `step` takes targets for, each on a leg of six joints.
            tolerance: Largest error of an accepted answer [m, rad].
            dt: Time between two steps [s]; None: no speed limit.
            max_iterations: Damped steps per leg and sample where the closed form does not answer.
            base: T_world_pelvis (4, 4); the robot's own placement if left out.

        Raises:
            DescriptionError: A frame is not on a leg of six joints, or a number is wrong.
            UnknownNameError: A frame is unknown.
        """
        self._tolerance = tolerance  # of the distance between matrices, never less than the angle
        self._settings = Dls(tolerance=tolerance / 4, max_iterations=max_iterations, restarts=0)
        self.q = robot.neutral if q0 is None else np.array(q0, dtype=float)
        if self.q.shape != (robot.nq,):
            raise DescriptionError(f"q0 has shape {self.q.shape}; ({robot.nq},) is accepted")
        self.reached, self.slowed = False, False
        self._legs = [_own_leg(robot, name) for name in frames]
        formulas = [exact_formula(own) for own in self._legs]
        self._formulas = [solve for solve in formulas if solve is not None]
        self._exact = len(self._formulas) == len(formulas)
        self._columns = _as_slice(np.concatenate([own.columns for own in self._legs]))
        self._subtrees = [robot.subtree((name,)) for name in frames]
        self._subtree_data = {subtree.frames[0]: subtree.model.createData() for subtree in self._subtrees}
        first = robot.nq - len(robot.joints)
        speeds = robot.velocity[np.concatenate([own.columns for own in self._legs]) - first]
        self._largest = None if dt is None else speeds * dt
        self._carry = _carry(robot, self.q, base)
        self._trial = self.q[self._columns].copy()
        self._model = _bare_legs(self._legs)
        self._data = self._model.createData()
        self._tips = [self._data.oMf[self._model.getFrameId(name)] for name in frames]
        self._memory = self._trial.data
        self._pack = struct.Struct(f"{len(self._trial)}d").pack_into  # half the cost of an assignment

    def step(self, *targets: npt.ArrayLike) -> Array:
        """The next answer (nq,), for one target pose (4, 4) per frame in the order of `frames`."""
        if len(targets) != len(self._tips):
            raise DescriptionError(f"{len(targets)} targets were given for {len(self._tips)} frames")
        if self._carry is not None:
            targets = tuple(self._carry @ _asarray(T, float) for T in targets)
        numbers = [_asarray(T, float).ravel().tolist() for T in targets]
        if self._exact:
            angles: list[float] = []
            for solve, T in zip(self._formulas, numbers):  # noqa: B905  # counted above, and strict costs time
                angles += solve(T)
            self._pack(self._memory, 0, *angles)
            if self._reached(numbers):
                return self._accept()
        if self._iterate(numbers):
            return self._accept()
        self.reached = self.slowed = False
        return self.q

    def _reached(self, targets: list[list[float]]) -> bool:
        """Whether Pinocchio finds every frame at its target."""
        _forward_kinematics(self._model, self._data, self._trial)
        for tip, T in zip(self._tips, targets):  # noqa: B905  # counted in `step`, and strict costs time
            if not dist(tip.homogeneous.ravel().tolist(), T) < self._tolerance:  # NaN is not reached
                return False
        return True

    def _accept(self) -> Array:
        """Take the trial, as far as the speed limits allow."""
        self.reached = True
        if self._largest is not None:
            step = self._trial - self.q[self._columns]
            excess = float((np.abs(step) / self._largest).max())
            self.slowed = excess > 1.0
            if self.slowed:
                self.q[self._columns] += step / excess
                self.reached = False
                return self.q
        self.q[self._columns] = self._trial
        return self.q

    def _iterate(self, targets: list[list[float]]) -> bool:
        """A few damped steps per leg: from the last answer, then from the nearest closed form."""
        for j, (subtree, own, target) in enumerate(zip(self._subtrees, self._legs, targets, strict=True)):
            T = np.array(target).reshape(4, 4)
            if not np.isfinite(T).all():
                return False
            p, R = T[None, None, :3, 3], T[None, :3, :3]
            goal = Goal(own.frame, np.zeros((1, 3)), p, R, np.ones((1, 1)), 1.0)
            near = approximate_formula(own)
            kernel = SampleKernel(subtree, self._subtree_data[own.frame], [goal], 0)
            seeds = [self.q[own.columns]]
            if near is not None:
                seeds.append(np.array(near(target)))
            for seed in seeds:
                answer = minimise(kernel, seed[:, None], self._settings)
                if answer.reached(self._settings.tolerance)[0]:
                    break
            self._trial[LEG_JOINTS * j : LEG_JOINTS * (j + 1)] = answer.q[:, 0]
        return self._reached(targets)


def _own_leg(robot: Robot, frame: str) -> LegAxes:
    own = robot.leg(frame)
    if own is None:
        raise DescriptionError(f"{frame} is not on a leg of six revolute joints; use ik.solve for it")
    return own


def _carry(robot: Robot, q: Array, base: npt.ArrayLike | None) -> Array | None:
    """Takes world targets to the robot at its own placement (4, 4); None where it stands there."""
    if base is not None:
        return np.asarray(robot.placement @ np.linalg.inv(pose_array("base", np.asarray(base)[None])[0]))
    if robot.base == "floating":
        return np.asarray(robot.placement @ pin.XYZQUATToSE3(q[:7]).inverse().homogeneous)
    return None


def _bare_legs(legs: Sequence[LegAxes]) -> Any:
    """Pinocchio's model of nothing but the legs' joints and tips: half the cost of the whole robot's."""
    model = pin.Model()
    for own in legs:
        parent, before = 0, np.zeros(3)
        for j in range(LEG_JOINTS):
            place = pin.SE3(np.eye(3), own.points[j] - before)
            joint = pin.JointModelRevoluteUnaligned(own.axes[j])
            parent, before = model.addJoint(parent, joint, place, f"{own.frame}_{j}"), own.points[j]
        tip = pin.SE3(own.tip[:3, :3], own.tip[:3, 3] - before)
        model.addFrame(pin.Frame(own.frame, parent, tip, pin.FrameType.OP_FRAME))
    return model


def _as_slice(columns: Index) -> slice | Index:
    """A slice where the joints stand side by side: quicker to write to."""
    first = int(columns[0])
    beside = bool((np.diff(columns) == 1).all())
    return slice(first, first + len(columns)) if beside else columns
