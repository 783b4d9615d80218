"""Online: one sample after another, made for a control loop of 1 kHz."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
import pinocchio as pin

from exo_pin.anatomy import FEET
from exo_pin.errors import DescriptionError
from exo_pin.ik.dls import descend
from exo_pin.ik.leg import Leg, leg
from exo_pin.ik.limb import limbs
from exo_pin.ik.settings import Dls
from exo_pin.ik.single import Formula, formula
from exo_pin.ik.solvers import NEARLY, closed_form_of
from exo_pin.ik.targets import Goal
from exo_pin.robot import Robot

asarray, forward = np.asarray, pin.framesForwardKinematics  # looked up once: this is the inner loop
Array = npt.NDArray[np.float64]
_PARTS = 3.0  # nine entries each within x make an angle of at most 2.1 x


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
        self._model, self._tolerance = robot.model, tolerance
        self._settings = Dls(tolerance=tolerance, max_iterations=max_iterations, restarts=0)
        self.q = robot.neutral if q0 is None else np.array(q0, dtype=float)
        if self.q.shape != (robot.nq,):
            raise DescriptionError(f"q0 has shape {self.q.shape}; ({robot.nq},) is accepted")
        self.reached, self.slowed = False, False
        self._legs = [_own_leg(robot, name) for name in frames]
        self._formulas = [_formula(own) for own in self._legs]
        self._exact = None not in self._formulas
        self._columns = _together(np.concatenate([own.columns for own in self._legs]))
        self._limbs = [limbs(robot, (name,), base_moves=False)[0] for name in frames]
        self._limb_data = {limb.frames[0]: limb.model.createData() for limb in self._limbs}
        self._largest = None if dt is None else robot.velocity * dt
        self._carry = None if base is None else robot.placement @ np.linalg.inv(np.asarray(base, dtype=float))
        self._trial = self.q.copy()
        self._data = robot.model.createData()
        pin.framesForwardKinematics(robot.model, self._data, self.q)
        tips = [self._data.oMf[robot.frame(name)] for name in frames]
        self._tips = tips  # keeps the memory of the next two alive; they follow every call of `forward`
        self._R, self._p = [tip.rotation for tip in tips], [tip.translation for tip in tips]

    def step(self, *targets: npt.ArrayLike) -> Array:
        """The next answer (nq,), for one target pose (4, 4) per frame in the order of `frames`."""
        numbers: list[list[float]] = []
        angles: list[float] = []
        for solve, target in zip(self._formulas, targets, strict=True):
            T = asarray(target, float)
            flat = (T if self._carry is None else self._carry @ T).ravel().tolist()
            numbers.append(flat)
            if solve is not None:
                angles += solve(flat)
        if self._exact:
            self._trial[self._columns] = angles
        if (self._exact and self._good(numbers)) or self._iterate(numbers):
            return self._accept()
        self.reached = self.slowed = False
        return self.q

    def _good(self, targets: list[list[float]]) -> bool:
        """Whether Pinocchio finds every frame at its target."""
        forward(self._model, self._data, self._trial)
        tol = self._tolerance / _PARTS
        for R, p, t in zip(self._R, self._p, targets, strict=True):
            (a, b, c), (d, e, f), (g, h, i) = R.tolist()
            x, y, z = p.tolist()
            if not (
                -tol < x - t[3] < tol
                and -tol < y - t[7] < tol
                and -tol < z - t[11] < tol
                and -tol < a - t[0] < tol
                and -tol < b - t[1] < tol
                and -tol < c - t[2] < tol
                and -tol < d - t[4] < tol
                and -tol < e - t[5] < tol
                and -tol < f - t[6] < tol
                and -tol < g - t[8] < tol
                and -tol < h - t[9] < tol
                and -tol < i - t[10] < tol
            ):
                return False
        return True

    def _accept(self) -> Array:
        """Take the trial, as far as the speed limits allow."""
        self.reached = True
        if self._largest is not None:
            joints = slice(len(self.q) - len(self._largest), None)
            step = self._trial[joints] - self.q[joints]
            excess = float((np.abs(step) / self._largest).max())
            self.slowed = excess > 1.0
            if self.slowed:
                self.q[joints] += step / excess
                self._trial[:], self.reached = self.q, False
                return self.q
        self.q[:] = self._trial
        return self.q

    def _iterate(self, targets: list[list[float]]) -> bool:
        """A few damped steps per leg: from the last answer, then from the nearest ideal leg's."""
        for limb, own, target in zip(self._limbs, self._legs, targets, strict=True):
            T = np.array(target).reshape(4, 4)
            if not np.isfinite(T).all():
                return False
            p, R = T[None, None, :3, 3], T[None, :3, :3]
            goal = Goal(own.frame, np.zeros((1, 3)), p, R, np.ones((1, 1)), 1.0)
            near = closed_form_of(own, tolerance=NEARLY)
            seeds = [self.q[own.columns]]
            if near is not None:
                seeds.append(np.array(formula(near, own.lower.tolist(), own.upper.tolist())(target)))
            for seed in seeds:
                answer = descend(limb, self._limb_data[own.frame], seed, [goal], 0, self._settings)
                if answer.converged:
                    break
            self._trial[own.columns] = answer.q
        return self._good(targets)


def _own_leg(robot: Robot, frame: str) -> Leg:
    own = leg(robot, frame)
    if own is None:
        raise DescriptionError(f"{frame} is not on a leg of six revolute joints; use ik.solve for it")
    return own


def _formula(own: Leg) -> Formula | None:
    exact = closed_form_of(own)
    return None if exact is None else formula(exact, own.lower.tolist(), own.upper.tolist())


def _together(columns: npt.NDArray[np.int64]) -> slice | npt.NDArray[np.int64]:
    """A slice where the joints stand side by side: quicker to write to."""
    first = int(columns[0])
    beside = bool((np.diff(columns) == 1).all())
    return slice(first, first + len(columns)) if beside else columns
