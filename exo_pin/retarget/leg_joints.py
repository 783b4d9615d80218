"""Joints of the two legs: counted from where the limbs part, those that are held or follow others apart."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
import pinocchio as pin

from exo_pin.arrays import Array
from exo_pin.errors import DescriptionError
from exo_pin.retarget.leg_search import FEWEST_JOINTS, Standing
from exo_pin.retarget.movements import movements
from exo_pin.robot.urdf_joints import Follower


@dataclass(frozen=True, eq=False)
class LimbJoints:
    """The joints of one leg.

    Attributes:
        free: Names of the joints that move on their own, from the hip outwards.
        chain: Names of all that move, in the order of the leg: those and their followers.
        drive: What each joint of the chain moves by, over the motion of the free joints (K, k).
        held: Names of joints that stay as they stand, and the reason, in the order of the leg.
    """

    free: tuple[str, ...]
    chain: tuple[str, ...]
    drive: Array
    held: Mapping[str, str] = field(default_factory=dict)


def own_joints(
    known: Standing, paths: tuple[list[int], list[int]], follow: Mapping[str, Follower]
) -> tuple[LimbJoints, LimbJoints]:
    """The joints of both legs, those that the limbs do not share.

    A joint that moves a joint of elsewhere, or follows one there, is held: the legs move apart from each
    other and from the rest.

    Args:
        known: The robot as it stands.
        paths: Pinocchio's indices of the joints of both limbs, from the root outwards.
        follow: The joints that follow others, by name.

    Raises:
        DescriptionError: A joint of a leg slides or has no axis.
    """
    names = known.robot.model.names
    parts = [[j for j in path if j not in other] for path, other in (paths, reversed(paths))]
    moving = [{str(names[j]) for j in part if j in known.movable} for part in parts]
    coupled = _coupled(moving, {str(names[j]) for path in paths for j in path}, follow)
    found = []
    for part, own in zip(parts, moving, strict=True):
        order = [str(names[j]) for j in part]
        held = {name: _still(known, name) for name in order if name not in own}
        held |= {name: coupled[name] for name in order if name in coupled}
        found.append(_limb([name for name in order if name not in held], held, follow))
    return found[0], found[1]


def _still(known: Standing, name: str) -> str:
    """Why a joint does not move."""
    k = known.robot.joints.index(name)
    coincide = known.robot.upper[k] <= known.robot.lower[k]
    return "its limits coincide" if coincide else "its record locks it"


def _coupled(moving: list[set[str]], of_limbs: set[str], follow: Mapping[str, Follower]) -> dict[str, str]:
    """Joints of the legs that are coupled to joints outside of their own leg, and to which."""
    found: dict[str, str] = {}
    for name, (leader, ratio, _) in follow.items():
        for own in moving:
            if name in own and not ratio:
                found[name] = f"it follows {leader} by a factor of zero"
            elif name in own and leader not in own:
                found[name] = f"it follows {leader}, which is not in its leg"
            elif leader in own and name not in own and name in of_limbs:
                found[leader] = f"{name}, which is not in its leg, follows it"
    for name, (leader, _, _) in follow.items():
        if leader in found and any(name in own for own in moving):
            found.setdefault(name, f"it follows {leader}, which is held")
    return found


def _limb(order: list[str], held: dict[str, str], follow: Mapping[str, Follower]) -> LimbJoints:
    free = [name for name in order if name not in follow]
    drive = np.zeros((len(order), len(free)))
    for row, name in enumerate(order):
        leader, ratio = (name, 1.0) if name in free else (follow[name].leader, follow[name].ratio)
        drive[row, free.index(leader)] = ratio
    return LimbJoints(tuple(free), tuple(order), drive, held)


def without_toes(known: Standing, limb: LimbJoints, rotation: Array) -> LimbJoints:
    """The same leg up to its ankle: joints of the toes are held.

    Args:
        known: The robot as it stands.
        limb: The joints of the leg.
        rotation: Rotation matrix (3, 3) from the walker's axes to the root link's.

    Raises:
        DescriptionError: The joints are no leg.
    """
    axes, points = axes_and_points(known, limb.free)
    count = len(movements(axes @ rotation, points @ rotation, limb.free))
    toes = dict.fromkeys(limb.free[count:], "a joint of the toes")
    if not toes:
        return limb
    rows = [k for k, row in enumerate(limb.drive) if not row[count:].any()]
    chain = tuple(limb.chain[k] for k in rows)
    return LimbJoints(limb.free[:count], chain, limb.drive[rows][:, :count], {**limb.held, **toes})


def check_pair(feet: tuple[str, str], limbs: tuple[LimbJoints, LimbJoints]) -> None:
    """Refuse legs that have too few joints, or not as many on both sides.

    Raises:
        DescriptionError: With the number of joints of both.
    """
    left, right = (len(limb.free) for limb in limbs)
    if left != right or left < FEWEST_JOINTS:
        held = [f"{name} is held: {why}" for limb in limbs for name, why in limb.held.items()]
        raise DescriptionError(
            f"{feet[0]} and {feet[1]} hang on {left} and {right} joints of their own"
            f"{f' ({held[0]})' if held else ''}; "
            f"two legs of {FEWEST_JOINTS} joints or more, as many on both sides, are accepted"
        )


def axes_and_points(known: Standing, joints: tuple[str, ...]) -> tuple[Array, Array]:
    """Directions of joint axes (k, 3), and points on them (k, 3) [m], as the robot stands.

    Raises:
        DescriptionError: A joint slides, or has no axis.
    """
    model = known.robot.model
    data = model.createData()
    jacobians = pin.computeJointJacobians(model, data, known.stand)
    ids = [model.getJointId(name) for name in joints]
    axes = np.array([jacobians[3:, model.idx_vs[j]] for j in ids]).reshape(-1, 3)
    for name, axis in zip(joints, axes, strict=True):
        if np.linalg.norm(axis) < 0.5:
            raise DescriptionError(
                f"joint {name} of a leg is prismatic, or has no axis; revolute joints are accepted, "
                "or `locked` in a record of the robot (docs/robots.md)"
            )
    return axes, np.array([data.oMi[j].translation for j in ids]).reshape(-1, 3)
