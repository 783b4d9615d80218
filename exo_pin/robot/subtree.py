"""A subtree of the robot: the joints that move a group of frames, with limits and a reduced model."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
import pinocchio as pin

from exo_pin.arrays import Array, Index
from exo_pin.robot.floating_base import FREE
from exo_pin.robot.subtree_arrays import SubtreeArrays, read_arrays
from exo_pin.short_repr import short_repr

_LINK = " (link)"  # added for a moment to the name of a link that a joint has too


@dataclass(frozen=True, eq=False)
class Subtree:
    """The joints that move a group of frames, every other joint of the robot fixed.

    Attributes:
        model: Pinocchio's reduced model.
        frames: Names of the frames.
        ids: Their indices in the reduced model.
        columns: Where the subtree's configuration stands in the robot's q.
        lower: Lower limits of the configuration; minus infinity for a floating base.
        upper: Upper limits of the configuration.
        floating: Whether a floating base is part of it.
    """

    model: Any
    frames: tuple[str, ...]
    ids: tuple[int, ...]
    columns: Index
    lower: Array
    upper: Array
    floating: bool

    __repr__ = short_repr

    @cached_property
    def arrays(self) -> SubtreeArrays | None:
        """The joints as arrays; None with a floating base or a joint neither revolute nor prismatic."""
        return None if self.floating else read_arrays(self.model, self.ids)

    @property
    def middle(self) -> Array:
        """The configuration with every limited joint at the middle of its range, the others at zero."""
        q = np.asarray(pin.neutral(self.model))
        bounded = np.isfinite(self.lower) & np.isfinite(self.upper)
        q[bounded] = 0.5 * (self.lower[bounded] + self.upper[bounded])
        return q

    def narrowed(self, lower: Array, upper: Array) -> Subtree:
        """The same subtree within further limits (nq,); where they leave nothing, its own limits win."""
        low, high = (np.clip(limit, self.lower, self.upper) for limit in (lower, upper))
        return replace(self, lower=low, upper=high)

    def box(self, q: Array) -> tuple[Array, Array]:
        """How far a step (nv,) may go down and up from q."""
        down, up = self.lower - q, self.upper - q
        return (down[1:], up[1:]) if self.floating else (down, up)  # nq = nv + 1 with a quaternion

    def difference(self, q: Array, target: Array) -> Array:
        """The step (nv,) from q to another configuration."""
        return np.asarray(pin.difference(self.model, q, target)) if self.floating else target - q

    def moved(self, q: Array, step: Array) -> Array:
        """The configuration after a step, rounding kept inside the limits."""
        q = np.asarray(pin.integrate(self.model, q, step)) if self.floating else q + step
        return np.minimum(np.maximum(q, self.lower), self.upper)


def supporting_joints(model: Any, frame: int) -> set[int]:
    """Pinocchio's indices of the joints that carry a frame, from the root outwards."""
    return {int(j) for j in model.supports[model.frames[frame].parentJoint]} - {0}


def independent_groups(joints: Mapping[str, set[int]]) -> list[tuple[str, ...]]:
    """Names of frames, those that share joints in one group.

    Args:
        joints: The joints that move each frame, by its name.
    """
    groups: list[tuple[list[str], set[int]]] = []
    for name, own in joints.items():
        names, union = [name], set(own)
        for other in [g for g in groups if g[1] & own]:
            groups.remove(other)
            names, union = other[0] + names, union | other[1]
        groups.append((names, union))
    return [tuple(names) for names, _ in groups]


def read_subtree(
    model: Any, frames: tuple[str, ...], joints: set[int], *, rest: Array, floating: bool
) -> Subtree:
    """A subtree from Pinocchio's model of the whole robot.

    Args:
        model: Pinocchio's model.
        frames: Names of the frames.
        joints: Pinocchio's indices of the joints that stay movable.
        rest: Configuration (nq,) at which the other joints are fixed.
        floating: Whether the robot's floating base is among the joints.
    """
    fixed = [j for j in range(1, model.njoints) if j not in joints]
    reduced = _reduced(model, fixed, rest)
    columns = [c for j in sorted(joints) for c in range(model.idx_qs[j], model.idx_qs[j] + model.nqs[j])]
    lower, upper = np.array(reduced.lowerPositionLimit), np.array(reduced.upperPositionLimit)
    if floating:
        lower[:FREE], upper[:FREE] = -np.inf, np.inf
    ids = tuple(frame_index(reduced, name) for name in frames)
    return Subtree(reduced, frames, ids, np.array(columns, dtype=int), lower, upper, floating)


def _reduced(model: Any, fixed: list[int], rest: Array) -> Any:
    """Pinocchio's reduced model, also where a link has the name of a joint, which Pinocchio cannot reduce."""
    joints = set(model.names)
    shared = {f.name for f in model.frames if f.type == pin.FrameType.BODY and f.name in joints}
    if not shared:
        return pin.buildReducedModel(model, fixed, rest)
    renamed = model.copy()
    _rename_links(renamed, {name: name + _LINK for name in shared})
    reduced = pin.buildReducedModel(renamed, fixed, rest)
    _rename_links(reduced, {name + _LINK: name for name in shared})
    return reduced


def _rename_links(model: Any, names: Mapping[str, str]) -> None:
    for k in range(model.nframes):  # by index: slices of Pinocchio's vectors are copies
        if model.frames[k].type == pin.FrameType.BODY:
            model.frames[k].name = names.get(model.frames[k].name, model.frames[k].name)


def frame_index(model: Any, name: str) -> int:
    """Pinocchio's index of a link, point frame or joint (a fixed one too), in this order.

    Pinocchio refuses a name without a kind where two frames have it: a link and a joint, or a link called
    `universe`, as Pinocchio's own root is. An unknown name has the number of frames as its index.
    """
    for kind in (pin.FrameType.BODY, pin.FrameType.JOINT, pin.FrameType.FIXED_JOINT):
        index = int(model.getFrameId(name, kind))
        if index < model.nframes:
            break
    return index
