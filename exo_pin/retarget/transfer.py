"""Retargeting: foot by foot through inverse kinematics, and joint by joint through the hips' rotation.

The feet's paths are seen from the pelvis and scaled, hip to ankle, by the ratio of the legs' reaches; the
feet keep their attitude. Joint by joint copies the angles, the hip's three through its rotation into the
robot's own order of axes.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from exo_pin import ik
from exo_pin.anatomy import JOINTS, SIDES, Body
from exo_pin.anatomy.hip import reorder
from exo_pin.dh.leg import chain
from exo_pin.dh.recursion import tree
from exo_pin.errors import DescriptionError
from exo_pin.gait import Gait
from exo_pin.ik.leg import Leg, leg
from exo_pin.kinematics import poses
from exo_pin.retarget.targets import Target, find, load
from exo_pin.robot import Robot, load_robot

Array = npt.NDArray[np.float64]

SETTINGS = ik.Auto(tolerance=1e-6)
"""A micrometre and a microradian are enough for a robot's joints."""


@dataclass(frozen=True, eq=False)
class Retargeted:
    """A walk on another robot, its base held where the pelvis is.

    Attributes:
        target: The robot's record.
        robot: The robot.
        time: Times (n,) [s].
        q: Joint values (n, nq), foot by foot, within the robot's limits [rad].
        scale: Robot's leg over the body's, left and right.
        position_error: Distance of the ankles from the scaled paths (n, 2) [m].
        rotation_error: Angle of the feet from the walk's (n, 2) [rad].
        copied: Joint values (n, nq), joint by joint, not cut to the limits [rad].
    """

    target: Target
    robot: Robot
    time: Array
    q: Array
    scale: tuple[float, float]
    position_error: Array
    rotation_error: Array
    copied: Array

    @property
    def legs(self) -> tuple[str, ...]:
        """The joints of both legs."""
        return (*self.target.left, *self.target.right)

    def limit_use(self) -> dict[str, tuple[float, float, int]]:
        """By leg joint: smallest and largest value asked joint by joint [rad], samples outside the limits."""
        use = {}
        for name in self.legs:
            j, k = self.robot.column(name), self.robot.joints.index(name)
            asked = self.copied[:, j]
            outside = (asked < self.robot.lower[k] - 1e-9) | (asked > self.robot.upper[k] + 1e-9)
            use[name] = (float(asked.min()), float(asked.max()), int(outside.sum()))
        return use

    def facts(self) -> dict[str, Any]:
        """Plain values for JSON."""
        missed = (self.position_error > 1e-5) | (self.rotation_error > 1e-5)
        return {
            "robot": self.target.name,
            "samples": len(self.time),
            "scale": list(self.scale),
            "position_error_mm": {
                "rms": 1e3 * float(np.sqrt(np.mean(self.position_error**2))),
                "max": 1e3 * float(self.position_error.max()),
            },
            "rotation_error_deg": {
                "rms": float(np.degrees(np.sqrt(np.mean(self.rotation_error**2)))),
                "max": float(np.degrees(self.rotation_error.max())),
            },
            "samples_missed": int(missed.any(axis=1).sum()),
            "joint_by_joint": {
                name: {"min_deg": float(np.degrees(a)), "max_deg": float(np.degrees(b)), "samples_outside": n}
                for name, (a, b, n) in self.limit_use().items()
            },
            "remarks": self.target.remarks,
        }


def retarget(gait: Gait, robot: str | Target = "talos", body: Body | None = None) -> Retargeted:
    """Bring a walk to another robot.

    Args:
        gait: The walk.
        robot: One of `TARGETS` by name, or a record.
        body: Whose walk it is; `Body.from_stature()` if left out.

    Raises:
        UnknownNameError: The robot is unknown.
        DescriptionError: Its URDF is missing, or a leg is not a chain of six joints.
    """
    target = find(robot)
    machine, walker = load(target), load_robot(body)
    legs = [_leg(machine, foot) for foot in target.feet]
    turn = np.diag([-1.0, -1.0, 1.0]) if target.backward else np.eye(3)
    q = walker.from_gait(gait)
    names = [f"{side}_{link}" for side in SIDES for link in ("thigh", "sole_plate")]
    T = poses(walker, q, names, base=np.eye(4))  # hip centre and ankle, seen from the pelvis
    scale, goals = [], {}
    for k, (side, own) in enumerate(zip(SIDES, legs, strict=True)):
        hip, foot = T[:, 2 * k], T[:, 2 * k + 1]
        sizes = walker.body.leg(side) if walker.body is not None else None
        assert sizes is not None  # load_robot made it
        scale.append(own.reach / (sizes.thigh + sizes.shank))
        goals[target.feet[k]] = _goal(own, turn, scale[k] * (foot - hip)[:, :3, 3], foot[:, :3, :3])
    copied = _copied(gait, target, machine, turn, legs)
    start = np.clip(copied, machine.lower, machine.upper)
    track = ik.track(machine, goals, start, settings=SETTINGS)
    return Retargeted(
        target=target,
        robot=machine,
        time=gait.time,
        q=track.q,
        scale=(scale[0], scale[1]),
        position_error=track.position_error,
        rotation_error=track.rotation_error,
        copied=copied,
    )


def _leg(machine: Robot, foot: str) -> Leg:
    own = leg(machine, foot)
    if own is None:
        raise DescriptionError(f"{foot} of {machine.name} does not hang on a chain of six revolute joints")
    return own


def _goal(own: Leg, turn: Array, ankle: Array, R: Array) -> Array:
    """Poses of the robot's foot link: the ankle at the hip plus the scaled path, the foot's own attitude."""
    T = np.tile(np.eye(4), (len(R), 1, 1))
    T[:, :3, :3] = turn @ R @ turn.T @ own.tip[:3, :3]
    T[:, :3, 3] = own.hip + ankle @ turn.T - np.einsum("nij,j->ni", T[:, :3, :3], own.ankle_in_frame)
    return T


def _copied(gait: Gait, target: Target, machine: Robot, turn: Array, legs: list[Leg]) -> Array:
    """The gait's angles on the robot's joints, with the sign that each axis asks for."""
    q = np.tile(machine.neutral, (len(gait), 1))
    axes = {link.name: link.axis for link in tree(Body.from_stature())}
    for k, (side, own) in enumerate(zip(SIDES, legs, strict=True)):
        first = 6 * k
        angles = np.array(gait.q[:, first : first + 6])
        angles[:, :3] = reorder(angles[:, :3], side, source="clinical", target=target.hip_order)
        named = dict(zip(JOINTS[first : first + 6], angles.T, strict=True))
        for movement, joint, axis in zip(
            chain(target.hip_order), (target.left, target.right)[k], own.axes, strict=True
        ):
            name = f"{side}_{movement}"
            q[:, machine.column(joint)] = np.sign(axes[name] @ turn.T @ axis) * named[name]
    return q
