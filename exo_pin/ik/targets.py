"""Targets: poses, positions and points that frames shall reach, checked, errors named by frame and sample."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import isfinite

import numpy as np
import numpy.typing as npt

from exo_pin.arguments import number, real, table
from exo_pin.arrays import Array, Index, as_floats, beside, is_remote
from exo_pin.chunks import for_chunks
from exo_pin.errors import DescriptionError
from exo_pin.robot import Robot
from exo_pin.short_repr import short_repr

_ORTHONORMAL = 1e-6
"""Largest `deviation` from a pose that passes as rounding; what passes is straightened."""
_EXACT = 1e-13  # a rotation this good needs no straightening


@dataclass(frozen=True, eq=False)
class Pose:
    """A full pose as target, with weights.

    Attributes:
        T: T_world_frame (n, 4, 4), or (4, 4) for `solve`.
        position_weight: Multiplies the position error; 0: the position is left free.
        rotation_weight: Multiplies the rotation error; 0: the rotation is left free.
    """

    T: npt.ArrayLike
    position_weight: float = 1.0
    rotation_weight: float = 1.0

    __repr__ = short_repr


@dataclass(frozen=True, eq=False)
class Position:
    """The origin of a frame as target, its rotation left free.

    Attributes:
        p: Positions in the world (n, 3) [m], or (3,) for `solve`.
        weight: Multiplies the error.
    """

    p: npt.ArrayLike
    weight: float = 1.0

    __repr__ = short_repr


@dataclass(frozen=True, eq=False)
class Points:
    """Points fixed on a link (markers) as target.

    Attributes:
        local: Where the points sit, in the axes of the frame (k, 3) [m].
        p: Where they shall be in the world (n, k, 3) [m], or (k, 3) for `solve`; a marker that was not seen
            is a row of NaN and has no weight.
        weight: Multiplies the errors, one for all or one each (k,).
    """

    local: npt.ArrayLike
    p: npt.ArrayLike
    weight: npt.ArrayLike = 1.0

    __repr__ = short_repr


Target = npt.ArrayLike | Pose | Position | Points


@dataclass(frozen=True, eq=False)
class Goal:
    """A checked target of one frame, in the axes of the robot at its own placement.

    Attributes:
        frame: Name of the frame.
        local: Points on the frame (k, 3) [m]; its origin alone for poses and positions.
        p: Where the points shall be (n, k, 3) [m].
        R: Rotation of the frame (n, 3, 3); None where it is left free.
        weight: Of each point (n, k); 0 where it was not seen.
        rotation_weight: Of the rotation.
    """

    frame: str
    local: Array
    p: Array
    R: Array | None
    weight: Array
    rotation_weight: float

    def only(self, samples: Index) -> Goal:
        """The goal at some of its samples."""
        R = None if self.R is None else self.R[samples]
        return replace(self, p=self.p[samples], R=R, weight=self.weight[samples])


def check(robot: Robot, targets: Mapping[str, Target], carry: Array | None) -> tuple[list[Goal], int]:
    """The targets as goals and their common number of samples.

    Args:
        robot: Whose frames they are.
        targets: By name of the frame.
        carry: Takes the world to the robot at its own placement: (4, 4), (n, 4, 4), or None for the identity.

    Raises:
        UnknownNameError: A frame is unknown.
        DescriptionError: A shape does not fit, a number is not finite, a matrix is not a pose.
    """
    if not table("targets", targets):
        raise DescriptionError("no target was given; name at least one frame")
    goals = []
    for frame, target in targets.items():
        robot.frame(frame)
        goals.append(_goal(frame, target, carry))
    counts = {goal.frame: len(goal.p) for goal in goals}
    n = next(iter(counts.values()))
    if any(count != n for count in counts.values()):
        raise DescriptionError(f"the targets have different numbers of samples: {counts}")
    if len({is_remote(goal.p) for goal in goals}) > 1:
        raise DescriptionError(
            "some targets are arrays of NumPy, others of an accelerator; one kind is accepted"
        )
    return goals, n


def pose_array(name: str, T: npt.ArrayLike) -> Array:
    """Poses (n, 4, 4), checked and their rotations straightened.

    Raises:
        DescriptionError: Names what the poses belong to and the first sample that is wrong.
    """
    T = target_numbers(name, T)
    if T.ndim != 3 or T.shape[1:] != (4, 4):
        raise DescriptionError(f"{name}: poses have shape {T.shape}; (n, 4, 4) is accepted")
    worst: list[float] = []
    for_chunks(len(T), T, lambda part: worst.append(float(deviation(T[part]).max())))
    if all(off <= _EXACT for off in worst):
        return T
    if not all(off <= _ORTHONORMAL for off in worst):
        _finite(name, T)
        k = int(np.argmax(deviation(T) > _ORTHONORMAL))
        raise DescriptionError(f"{name}, frame {k}: not a pose (a rotation matrix and last row 0 0 0 1)")
    return straightened(T)


def deviation(T: Array) -> Array:
    """How far each of the poses (m, 4, 4) is from one: lengths, angles and handedness of the axes (m,).

    The third axis is compared with the cross product of the others: fewer products than R^T R and a
    determinant. Infinite where a number is not finite.
    """
    x = np.ascontiguousarray(T.reshape(-1, 16).T, like=T)
    (a0, a1, a2), (b0, b1, b2), (c0, c1, c2) = ((x[j], x[4 + j], x[8 + j]) for j in range(3))
    with np.errstate(all="ignore"):
        off: Array = abs(a0 * a0 + a1 * a1 + a2 * a2 - 1.0)
        off += abs(b0 * b0 + b1 * b1 + b2 * b2 - 1.0)
        off += abs(a0 * b0 + a1 * b1 + a2 * b2)
        off += abs(a1 * b2 - a2 * b1 - c0)
        off += abs(a2 * b0 - a0 * b2 - c1)
        off += abs(a0 * b1 - a1 * b0 - c2)
        off += abs(x[12]) + abs(x[13]) + abs(x[14]) + abs(x[15] - 1.0)
        off[~np.isfinite(off + x[3] + x[7] + x[11])] = np.inf
    return off


def is_pose(T: list[float]) -> bool:
    """Whether 16 numbers, row by row, are a pose: `deviation` in plain floats, for one sample at a time."""
    a0, b0, c0, x, a1, b1, c1, y, a2, b2, c2, z, *last = T
    off = abs(a0 * a0 + a1 * a1 + a2 * a2 - 1.0) + abs(b0 * b0 + b1 * b1 + b2 * b2 - 1.0)
    off += abs(a0 * b0 + a1 * b1 + a2 * b2) + abs(a1 * b2 - a2 * b1 - c0)
    off += abs(a2 * b0 - a0 * b2 - c1) + abs(a0 * b1 - a1 * b0 - c2)
    return off <= _ORTHONORMAL and isfinite(x + y + z) and last == [0.0, 0.0, 0.0, 1.0]


def straightened(T: Array) -> Array:
    """Nearly exact rotations made exact to rounding (Newton steps of the polar decomposition)."""
    R = T[:, :3, :3]
    unit = beside(np.eye(3), T)
    for _ in range(2):
        gram = R.swapaxes(1, 2) @ R
        if not len(R) or np.abs(gram - unit).max() < _EXACT:
            break
        R = R @ (1.5 * unit - 0.5 * gram)
    T = T.copy()
    T[:, :3, :3] = R
    return T


def _goal(frame: str, target: Target, carry: Array | None) -> Goal:
    if isinstance(target, Points):
        return _points(frame, target, carry)
    if isinstance(target, Position):
        p = target_numbers(frame, target.p)
        if p.ndim != 2 or p.shape[1] != 3:
            raise DescriptionError(f"{frame}: positions have shape {p.shape}; (n, 3) is accepted")
        _finite(frame, p)
        ones = np.broadcast_to(_weight(frame, target.weight), (len(p), 1))
        return Goal(frame, np.zeros((1, 3)), _carried(frame, p[:, None], carry), None, ones, 0.0)
    pose = target if isinstance(target, Pose) else Pose(target)
    T = pose_array(frame, pose.T)
    if carry is not None:
        T = _fits(frame, carry, T) @ T
    ones = np.broadcast_to(_weight(frame, pose.position_weight), (len(T), 1))
    rotation_weight = _weight(frame, pose.rotation_weight)
    R = T[:, :3, :3] if rotation_weight else None
    return Goal(frame, np.zeros((1, 3)), T[:, None, :3, 3], R, ones, rotation_weight)


def _points(frame: str, target: Points, carry: Array | None) -> Goal:
    local, p = target_numbers(frame, target.local), target_numbers(frame, target.p)
    if local.ndim != 2 or local.shape[1] != 3 or p.ndim != 3 or p.shape[1:] != local.shape:
        raise DescriptionError(
            f"{frame}: points have shapes {local.shape} and {p.shape}; (k, 3) and (n, k, 3) are accepted"
        )
    _finite(f"{frame} (local)", local)
    seen = np.asarray(~np.isnan(p).any(axis=2))
    _finite(frame, np.where(seen[..., None], p, 0.0))
    given = real(f"{frame}: weight", target.weight)
    if given.shape not in ((), (len(local),)) or (given < 0.0).any():
        raise DescriptionError(f"{frame}: one weight or {len(local)}, none negative, are accepted")
    weight = np.broadcast_to(given, (len(local),))
    p = _carried(frame, np.where(seen[..., None], p, 0.0), carry)
    return Goal(frame, local, p, None, weight * seen, 0.0)


def target_numbers(name: str, values: npt.ArrayLike) -> Array:
    """Real numbers, which may hold gaps.

    Raises:
        DescriptionError: They are none; names the frame.
    """
    try:
        return as_floats(values)
    except (TypeError, ValueError):
        raise DescriptionError(f"{name}: the target is not an array of real numbers") from None


def _finite(name: str, values: Array) -> None:
    finite = np.isfinite(values)
    if finite.all():
        return
    k = int(np.argmin(finite.all(axis=tuple(range(1, values.ndim)))))
    raise DescriptionError(f"{name}, frame {k}: the target holds NaN or infinity")


def _weight(frame: str, weight: float) -> float:
    return number(f"{frame}: a weight", weight, least=0.0)


def _fits(frame: str, carry: Array, T: Array) -> Array:
    if carry.ndim == 3 and len(carry) != len(T):
        raise DescriptionError(f"{frame}: {len(T)} samples, but base has {len(carry)}")
    return beside(carry, T)


def _carried(frame: str, p: Array, carry: Array | None) -> Array:
    if carry is None:
        return p
    T = _fits(frame, carry, p)
    return np.asarray(p @ T[..., :3, :3].swapaxes(-1, -2) + T[..., None, :3, 3])
