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
from exo_pin.arguments import count, names, number, real
from exo_pin.arrays import Array, Index
from exo_pin.errors import DescriptionError
from exo_pin.ik.least_squares.nearest_posture import NearestPosture, bare_legs
from exo_pin.ik.leg.scalar import approximate_formula, exact_formula
from exo_pin.ik.targets import is_pose, pose_array, target_numbers
from exo_pin.robot import Robot
from exo_pin.robot.floating_base import FREE, base_coordinates, base_poses
from exo_pin.robot.leg_axes import LEG_JOINTS, LegAxes
from exo_pin.robot.subtree import frame_index

_MOST_STEPS = 1_000_000  # damped steps for a sample: beyond, a number is a slip
_LARGEST_TOLERANCE = 1e3
_FLOAT, _POSE = np.dtype(float), (4, 4)
_forward_kinematics = pin.framesForwardKinematics  # found once: an inner loop


class Online:
    """Inverse kinematics that keeps its state from call to call.

    `q = online.step(T_left, T_right)` answers a pair of foot poses by the closed form (by a few damped steps
    from the last answer on legs that have none), checks the answer with Pinocchio's forward kinematics, and
    never leaves the joint limits or, if `dt` is given, the joints' speed limits. Each leg is on its own: one
    that cannot meet its target follows the posture nearest to it, from its last answer; the other goes on.
    A target that is no pose (NaN, no rotation) leaves its leg where it is. A loop can be pickled.

    Attributes:
        q: The present answer (nq,); the same array after every step.
        reached: Whether every frame met its last target within the tolerance.
        reached_by_foot: The same for each frame, in the order of `frames`.
        slowed: Whether a speed limit cut the last step of a leg short, which has not reached its target then.
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
            frames: Frames that `step` takes targets for, each on a leg of six joints of its own.
            tolerance: Largest error of an accepted answer [m, rad].
            dt: Time between two steps [s]; None: no speed limit.
            max_iterations: Damped steps per leg and sample where the closed form does not answer.
            base: T_world_pelvis (4, 4); the robot's own placement if left out.

        Raises:
            DescriptionError: A frame is not on a leg of six joints, two are on one leg, or a number is wrong.
            UnknownNameError: A frame is unknown.
        """
        frames = names("frames", frames)
        if not frames:
            raise DescriptionError("no frame was given; name at least one")
        number("tolerance", tolerance, above=0.0, most=_LARGEST_TOLERANCE)
        count("max_iterations", max_iterations, 1, _MOST_STEPS)
        if dt is not None:
            number("dt", dt, above=0.0)
        self._robot = robot
        self._options = {"frames": frames, "tolerance": tolerance, "dt": dt, "base": base}
        self._options["max_iterations"] = max_iterations
        self._tolerance = tolerance  # of the distance between matrices, never less than the angle
        start = robot.neutral if q0 is None else real("q0", q0, (robot.nq,)).copy()
        self.q = robot.unit_quaternion(start)
        axes = [_own_leg(robot, name) for name in frames]
        self._legs = [_Leg(own, robot, tolerance / 4, max_iterations, dt) for own in axes]
        self._formulas = [leg.exact for leg in self._legs if leg.exact is not None]
        self._exact = len(self._formulas) == len(self._legs)
        self._columns = _as_slice(_columns_apart(axes))
        self._largest = None if dt is None else np.concatenate([leg.largest for leg in self._legs])
        self._all, self._none = (True,) * len(axes), (False,) * len(axes)
        self.reached, self.slowed, self.reached_by_foot = False, False, self._none
        self._base: Array | None = None
        self._carry = self._standing(base)
        self._trial = self.q[self._columns].copy()
        self._model = bare_legs(axes)
        self._data = self._model.createData()
        self._tips = [self._data.oMf[frame_index(self._model, name)] for name in frames]
        self._memory = self._trial.data
        self._pack = struct.Struct(f"{len(self._trial)}d").pack_into  # half the cost of an assignment

    def step(self, *targets: npt.ArrayLike, base: npt.ArrayLike | None = None) -> Array:
        """The next answer (nq,), for one target pose (4, 4) per frame in the order of `frames`.

        Args:
            targets: T_world_frame (4, 4), one for each frame.
            base: T_world_pelvis (4, 4) from this step on; where it was if left out.

        Raises:
            DescriptionError: The number of targets or a shape is wrong, or a target holds no real numbers.
        """
        if len(targets) != len(self._tips):
            raise DescriptionError(f"{len(targets)} targets were given for {len(self._tips)} frames")
        if base is not None:
            self._carry = self._standing(base)
        if self._carry is not None:
            targets = tuple(self._carry @ _pose(T) for T in targets)
        numbers = [_pose(T).ravel().tolist() for T in targets]
        if self._exact:
            angles: list[float] = []
            for solve, T in zip(self._formulas, numbers):  # noqa: B905  # counted above, and strict costs time
                angles += solve(T)
            self._pack(self._memory, 0, *angles)
            if self._reached(numbers) and self._within_speeds():
                self.q[self._columns] = self._trial
                self.reached, self.slowed, self.reached_by_foot = True, False, self._all
                return self.q
        return self._leg_by_leg(numbers)

    def _reached(self, targets: list[list[float]]) -> bool:
        """Whether Pinocchio finds every frame at its target."""
        _forward_kinematics(self._model, self._data, self._trial)
        for tip, T in zip(self._tips, targets):  # noqa: B905  # counted in `step`, and strict costs time
            if not dist(tip.homogeneous.ravel().tolist(), T) < self._tolerance:  # NaN is not reached
                return False
        return True

    def _within_speeds(self) -> bool:
        """Whether the speed limits allow the whole step to the trial."""
        if self._largest is None:
            return True
        return bool((np.abs(self._trial - self.q[self._columns]) <= self._largest).all())

    def _leg_by_leg(self, targets: list[list[float]]) -> Array:
        """Each leg on its own: its answer or nearest posture, or as far on the way as its speeds allow."""
        met = self._each_reached(targets) if self._exact else self._none
        places = [slice(LEG_JOINTS * j, LEG_JOINTS * (j + 1)) for j in range(len(self._legs))]
        for j, leg in enumerate(self._legs):
            if not met[j]:
                self._trial[places[j]] = leg.nearest(targets[j], self.q[leg.columns])
        if not all(met):
            _forward_kinematics(self._model, self._data, self._trial)
            met = self._each_reached(targets)
        full = [leg.move(self.q, self._trial[place]) for leg, place in zip(self._legs, places, strict=True)]
        self.reached_by_foot = tuple(a and b for a, b in zip(met, full, strict=True))
        self.reached, self.slowed = all(self.reached_by_foot), not all(full)
        return self.q

    def _each_reached(self, targets: list[list[float]]) -> tuple[bool, ...]:
        """Whether each frame is at its target where forward kinematics was evaluated last."""
        tips = [tip.homogeneous.ravel().tolist() for tip in self._tips]
        return tuple(dist(tip, T) < self._tolerance for tip, T in zip(tips, targets, strict=True))

    def _standing(self, base: npt.ArrayLike | None) -> Array | None:
        """Takes world targets to the robot at its own placement (4, 4); None where it stands there."""
        robot = self._robot
        if base is None and robot.base == "fixed":
            return None
        if base is None:
            T = base_poses(self.q)
        else:
            T = real("base", base)
            if T.shape != (4, 4) or not is_pose(T.ravel().tolist()):
                T = pose_array("base", T[None])[0]  # straightened, or refused with the reason
            if robot.base == "floating":
                self.q[:FREE] = base_coordinates(T)
            self._base = T
        inverse = np.eye(4)
        inverse[:3, :3], inverse[:3, 3] = T[:3, :3].T, -T[:3, :3].T @ T[:3, 3]
        return np.asarray(robot.placement @ inverse)

    def __reduce__(self) -> tuple[Any, ...]:
        """The arguments and the state: Pinocchio's data and the bound formulas are made again."""
        state = self.reached, self.slowed, self.reached_by_foot
        return _restored, (self._robot, self.q, {**self._options, "base": self._base}, state)


def _pose(T: npt.ArrayLike) -> Array:
    """A target (4, 4), whatever numbers it holds.

    Raises:
        DescriptionError: It has another shape, or holds no real numbers.
    """
    if type(T) is not np.ndarray or T.dtype is not _FLOAT:
        T = target_numbers("target", T)
    if T.shape != _POSE:
        raise DescriptionError(f"a target has shape {T.shape}; (4, 4) is accepted")
    return T


def _restored(robot: Robot, q: Array, options: dict[str, Any], state: tuple[Any, ...]) -> Online:
    loop = Online(robot, q, **options)
    loop.reached, loop.slowed, loop.reached_by_foot = state
    return loop


class _Leg:
    """One leg of the loop: its formulas, its nearest posture, its largest step."""

    def __init__(
        self, own: LegAxes, robot: Robot, tolerance: float, max_iterations: int, dt: float | None
    ) -> None:
        self.columns = own.columns
        self.exact = exact_formula(own)
        self._formula = self.exact or approximate_formula(own)
        steps = max_iterations if self.exact is None else (max_iterations + 1) // 2  # nothing to reach
        self._posture = NearestPosture(own, tolerance=tolerance, max_iterations=steps)
        speeds = robot.velocity[own.columns - (robot.nq - len(robot.joints))]
        self.largest = None if dt is None else speeds * dt

    def nearest(self, T: list[float], q: Array) -> Array:
        """The posture (6,) nearest to the target pose (16 numbers), followed from q.

        The formula's answer, cut off at the limits, is a second start where it lies nearer than what q leads
        to, or may reach the target.
        """
        if not is_pose(T):
            return q
        target = pin.SE3(np.array(T).reshape(4, 4))
        if self._formula is None:
            return self._posture.from_start(q, target)[0]
        seed = np.array(self._formula(T))
        return self._posture.of_two_starts(q, seed, target, promising=self.exact is None)

    def move(self, q: Array, answer: Array) -> bool:
        """Move q (nq,) to the leg's answer (6,), or on a straight way as far as its speeds allow: False."""
        step = answer - q[self.columns]
        excess = 0.0 if self.largest is None else float((np.abs(step) / self.largest).max())
        if excess > 1.0:
            q[self.columns] += step / excess
            return False
        q[self.columns] = answer
        return True


def _own_leg(robot: Robot, frame: str) -> LegAxes:
    own = robot.leg(frame)
    if own is None:
        raise DescriptionError(f"{frame} is not on a leg of six revolute joints; use ik.solve for it")
    return own


def _columns_apart(legs: Sequence[LegAxes]) -> Index:
    """Where the legs' joints stand in q, one leg after another; each leg has one frame."""
    columns = np.concatenate([own.columns for own in legs])
    if len(np.unique(columns)) < len(columns):
        names = ", ".join(own.frame for own in legs)
        raise DescriptionError(f"{names}: two are on one leg; one frame for each leg is accepted")
    return columns


def _as_slice(columns: Index) -> slice | Index:
    """A slice where the joints stand side by side: quicker to write to."""
    first = int(columns[0])
    beside = bool((np.diff(columns) == 1).all())
    return slice(first, first + len(columns)) if beside else columns
