"""Limbs: targets that share joints are solved together, each group on its own reduced model."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pinocchio as pin

from exo_pin.arrays import Array, Index
from exo_pin.ik.targets import Goal
from exo_pin.robot import Robot

AXES = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
_SKEW = np.array([pin.skew(axis).ravel() for axis in np.eye(3)])
"""Takes vectors (m, 3) to their cross-product matrices (m, 9)."""


@dataclass(frozen=True, eq=False)
class Limb:
    """The joints that move a group of frames, everything else of the robot held at rest.

    Attributes:
        model: Pinocchio's reduced model.
        frames: Names of the target frames.
        ids: Their indices in the reduced model.
        q: Entries of the robot's q that belong to this limb.
        lower: Lower limits of q; minus infinity for a floating base.
        upper: Upper limits of q.
        floats: Whether a floating base is part of it.
    """

    model: Any
    frames: tuple[str, ...]
    ids: tuple[int, ...]
    q: Index
    lower: Array
    upper: Array
    floats: bool

    @property
    def middle(self) -> Array:
        """The configuration with every limited joint at the middle of its range, the others at zero."""
        q = np.asarray(pin.neutral(self.model))
        bounded = np.isfinite(self.lower) & np.isfinite(self.upper)
        q[bounded] = 0.5 * (self.lower[bounded] + self.upper[bounded])
        return q

    def box(self, q: Array) -> tuple[Array, Array]:
        """How far a step (nv,) may go down and up from q."""
        down, up = self.lower - q, self.upper - q
        return (down[1:], up[1:]) if self.floats else (down, up)  # nq = nv + 1 with a quaternion

    def difference(self, q: Array, target: Array) -> Array:
        """The step (nv,) from q to another configuration."""
        return np.asarray(pin.difference(self.model, q, target)) if self.floats else target - q

    def moved(self, q: Array, step: Array) -> Array:
        """The configuration after a step, rounding kept inside the limits."""
        q = np.asarray(pin.integrate(self.model, q, step)) if self.floats else q + step
        return np.minimum(np.maximum(q, self.lower), self.upper)


def limbs(robot: Robot, frames: tuple[str, ...], *, base_moves: bool) -> list[Limb]:
    """The independent groups of frames with the joints that move them."""
    joints = {name: _joints_of(robot, name, base_moves=base_moves) for name in frames}
    groups: list[tuple[list[str], set[int]]] = []
    for name, own in joints.items():
        names, union = [name], set(own)
        for other in [g for g in groups if g[1] & own]:
            groups.remove(other)
            names, union = other[0] + names, union | other[1]
        groups.append((names, union))
    return [_limb(robot, tuple(names), union) for names, union in groups]


def narrowed(limb: Limb, lower: Array, upper: Array) -> Limb:
    """The same limb within further limits (nq,); where they leave nothing, its own limits win."""
    low, high = (np.clip(limit, limb.lower, limb.upper) for limit in (lower, upper))
    return replace(limb, lower=low, upper=high)


def residual(
    limb: Limb, data: Any, q: Array, goals: list[Goal], k: int, scale: tuple[float, float] = (1.0, 1.0)
) -> tuple[Array, Array, Array]:
    """Weighted error (m,) in world axes, its Jacobian (m, nv), and per frame distance and angle (2, F)."""
    pin.computeJointJacobians(limb.model, data, q)
    parts, slopes, errors = [], [], np.full((2, len(goals)), np.nan)
    for f, (index, goal) in enumerate(zip(limb.ids, goals, strict=True)):
        M = pin.updateFramePlacement(limb.model, data, index)
        J = pin.getFrameJacobian(limb.model, data, index, AXES).reshape(6, -1)  # one joint: a vector
        R = M.rotation
        e, slope, errors[0, f] = _points(goal, k, R, M.translation, J)
        parts.append(scale[0] * e)
        slopes.append(scale[0] * slope)
        if goal.R is not None:
            turn = pin.log3(goal.R[k] @ R.T)
            errors[1, f] = np.sqrt(turn @ turn)
            parts.append(scale[1] * goal.rotation_weight * turn)
            slopes.append(scale[1] * goal.rotation_weight * J[3:])
    return np.concatenate(parts), np.concatenate(slopes), errors


def _points(goal: Goal, k: int, R: Array, origin: Array, J: Array) -> tuple[Array, Array, float]:
    """Weighted error (3m,) of a frame's m points, its Jacobian (3m, nv), and the largest distance."""
    if len(goal.local) == 1 and not goal.local.any():  # a pose or a position: the frame's own origin
        e, weight = goal.p[k, 0] - origin, goal.weight[k, 0]
        return weight * e, weight * J[:3], float(np.sqrt(e @ e)) if weight else 0.0
    arms, weight = goal.local @ R.T, goal.weight[k]
    e = goal.p[k] - origin - arms
    distance = np.sqrt(np.einsum("ij,ij->i", e, e))
    slope = J[:3] - (arms @ _SKEW).reshape(-1, 3, 3) @ J[3:]  # a turn w moves the end of an arm by w x arm
    slope *= weight[:, None, None]
    worst = float((distance * (weight > 0)).max())
    return (weight[:, None] * e).ravel(), slope.reshape(-1, J.shape[1]), worst


def _joints_of(robot: Robot, frame: str, *, base_moves: bool) -> set[int]:
    model = robot.model
    chain = {int(j) for j in model.supports[model.frames[robot.frame(frame)].parentJoint]} - {0}
    if robot.base == "floating" and not base_moves:
        chain.discard(1)
    return chain


def _limb(robot: Robot, frames: tuple[str, ...], joints: set[int]) -> Limb:
    model = robot.model
    locked = [j for j in range(1, model.njoints) if j not in joints]
    reduced = pin.buildReducedModel(model, locked, robot.neutral)
    columns = [c for j in sorted(joints) for c in range(model.idx_qs[j], model.idx_qs[j] + model.nqs[j])]
    floats = robot.base == "floating" and 1 in joints
    lower, upper = np.array(reduced.lowerPositionLimit), np.array(reduced.upperPositionLimit)
    if floats:
        lower[:7], upper[:7] = -np.inf, np.inf
    ids = tuple(_frame(reduced, name) for name in frames)
    return Limb(reduced, frames, ids, np.array(columns, dtype=int), lower, upper, floats)


def _frame(model: Any, name: str) -> int:
    for kind in (pin.FrameType.BODY, pin.FrameType.JOINT):
        index = model.getFrameId(name, kind)
        if index < model.nframes:
            return int(index)
    return int(model.getFrameId(name))  # a joint that is locked here turned into a fixed frame
