"""Retargeting: foot by foot through inverse kinematics, and joint by joint through the hips' rotation.

The feet's paths are seen from the pelvis and scaled, hip to ankle, by the ratio of the legs' reaches; the
feet keep their attitude in the world. A person's pelvis leans forward, a robot's trunk does not: what the
pelvis leans on average goes into the robot's hips. Joint by joint copies the angles: the hip's three (with
that lean) and the ankle's two through their rotation onto the robot's own axes, whatever their order.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from exo_pin import ik
from exo_pin.anatomy import JOINTS, SIDES, Body
from exo_pin.arrays import Array
from exo_pin.gait import Gait
from exo_pin.gait.rigid import about
from exo_pin.kinematics import poses
from exo_pin.retarget.axes import turns
from exo_pin.retarget.machine import Machine, load, ready
from exo_pin.retarget.retargeted import Retargeted
from exo_pin.retarget.robot_legs import RobotLeg
from exo_pin.retarget.target_robots import Target
from exo_pin.robot import Robot, load_robot, load_urdf

Walker = str | Path | Target | Robot | Machine

SETTINGS = ik.Auto(tolerance=1e-6, dls=ik.Dls(restarts=0))
"""A micrometre and a microradian are enough for a robot's joints; the copied angles are a good start."""

NEAREST = ik.Dls(tolerance=1e-9, restarts=0, warm_start=False)
"""For legs that cannot reach the attitude: each sample descends once from the copied angles."""

SHRINKING = (1.0, 0.99, 0.98, 0.97, 0.96, 0.95)
"""Paths are made smaller by up to a twentieth where limits, or hips whose axes do not meet, forbid them."""

LIGHT = 1e-3
"""Weight of the attitude against the place, where not both can be had."""

ARM = 0.1
"""The attitude is held by points so far from the ankle [m]."""


def retarget(gait: Gait, robot: Walker = "talos", body: Body | None = None) -> Retargeted:
    """Bring a walk to another robot.

    Args:
        gait: The walk.
        robot: One of `TARGETS` by name, the path of a URDF or of a TOML record, a record, a robot from
            `load_urdf`, or a machine that is ready.
        body: Whose walk it is; `Body.from_stature()` if left out.

    Raises:
        UnknownNameError: The robot is unknown.
        DescriptionError: Its URDF is missing or no robot with two legs.
        FormatError: Its record is not accepted.
    """
    machine = _machine(robot)
    walker = load_robot(body)
    lean = _lean(gait)
    T = _limbs(gait, walker, lean)
    copied = _copied(gait, machine, T[..., :3, :3])
    assert walker.body is not None  # load_robot made it
    own = [walker.body.leg(side) for side in SIDES]
    ratios = [leg.reach / (size.thigh + size.shank) for leg, size in zip(machine.legs, own, strict=True)]
    best: Retargeted | None = None
    for share in SHRINKING:
        tried = _solved(gait, walker, machine, T, (share * ratios[0], share * ratios[1]), copied, lean)
        if best is None or tried.missed.sum() < best.missed.sum():
            best = tried
        if not best.missed.any():
            break
    assert best is not None  # there is a first share
    return best


def joint_by_joint(gait: Gait, machine: Machine, body: Body | None = None) -> Array:
    """The walk's own angles on a robot's joints (n, nq), hips and ankles through their rotation [rad]."""
    return _copied(gait, machine, _limbs(gait, load_robot(body), _lean(gait))[..., :3, :3])


def _machine(robot: Walker) -> Machine:
    if isinstance(robot, Machine):
        return robot
    if not isinstance(robot, Robot):
        return load(robot)
    if robot.base != "fixed" or (robot.placement != np.eye(4)).any():
        robot = load_urdf(robot.urdf, path=robot.path)  # its root at the origin
    return ready(Target(robot.name, ""), robot)


def _lean(gait: Gait) -> float:
    """How far the pelvis is tilted forward on average [rad]."""
    if gait.base is None:
        return 0.0
    R = gait.base[:, :3, :3]
    return float(np.arctan2(-R[:, 2, 0].mean(), R[:, 2, 2].mean()))


def _limbs(gait: Gait, walker: Robot, lean: float) -> Array:
    """Poses (n, 2, 3, 4, 4) of thigh, shank and foot of both legs, seen from a pelvis set upright."""
    names = [f"{side}_{link}" for side in SIDES for link in ("thigh", "shank", "sole_plate")]
    T = poses(walker, walker.from_gait(gait), names, base=np.eye(4))
    return np.asarray(_tilt(lean) @ T.reshape(len(gait), 2, 3, 4, 4))


def _tilt(lean: float) -> Array:
    """A pose (4, 4) that is turned forward, about the axis to the left."""
    T = np.eye(4)
    T[:3, :3] = about((0.0, 1.0, 0.0), lean)
    return T


def _solved(
    gait: Gait,
    walker: Robot,
    machine: Machine,
    T: Array,
    scale: tuple[float, float],
    copied: Array,
    lean: float,
) -> Retargeted:
    """Foot by foot, the paths from hip to ankle scaled."""
    assert walker.body is not None  # load_robot made it
    ankles = np.stack(
        [
            leg.hip + s * (T[:, k, 2] - T[:, k, 0])[:, :3, 3]
            for k, (leg, s) in enumerate(zip(machine.legs, scale, strict=True))
        ],
        axis=1,
    )
    R = T[:, :, 2, :3, :3]
    robot = machine.robot
    start = np.array(copied)
    low = robot.nq - len(robot.joints)
    start[:, low:] = np.clip(start[:, low:], robot.lower, robot.upper)
    goals = {leg.foot: _goal(machine, leg, ankles[:, k], R[:, k]) for k, leg in enumerate(machine.legs)}
    whole = all(leg.whole for leg in machine.legs)
    q = ik.track(robot, goals, start, settings=SETTINGS if whole else NEAREST).q
    return Retargeted(
        machine=machine,
        gait=gait,
        q=q,
        copied=copied,
        base=_base(gait, walker, machine, scale, lean),
        lean=lean,
        scale=scale,
        ankles=ankles,
        attitudes=R,
        body=walker.body,
    )


def _goal(machine: Machine, leg: RobotLeg, ankle: Array, R: Array) -> ik.Points | Array:
    """Poses of the foot's link; for legs of fewer joints its ankle, and lightly points around it."""
    turn = machine.turn
    T = np.tile(np.eye(4), (len(R), 1, 1))
    T[:, :3, :3] = turn @ R @ leg.T[:3, :3]
    T[:, :3, 3] = ankle @ turn.T - np.einsum("nij,j->ni", T[:, :3, :3], leg.ankle_in_foot)
    if leg.whole:
        return T
    local = leg.ankle_in_foot + np.vstack([np.zeros(3), ARM * np.eye(3)])
    points = local @ np.swapaxes(T[:, :3, :3], -1, -2) + T[:, None, :3, 3]
    return ik.Points(local, points, (1.0, LIGHT, LIGHT, LIGHT))


def _copied(gait: Gait, machine: Machine, R: Array) -> Array:
    """The gait's angles on the robot's joints: R (n, 2, 3, 3, 3) are thigh, shank and foot."""
    q = np.tile(machine.stand, (len(gait), 1))
    for k, (side, leg) in enumerate(zip(SIDES, machine.legs, strict=True)):
        thigh, shank, foot = (R[:, k, j] for j in range(3))
        knee = leg.knee
        bent = gait.q[:, JOINTS.index(f"{side}_knee_flexion")] * np.sign(leg.axes[knee, 1])
        parts = [turns(leg.axes[:knee], thigh), bent[:, None]]
        if knee + 1 < len(leg.joints):
            parts.append(turns(leg.axes[knee + 1 :], np.swapaxes(shank, -1, -2) @ foot))
        q[:, [machine.robot.column(joint) for joint in leg.joints]] += np.concatenate(parts, axis=1)
    return q


def _base(gait: Gait, walker: Robot, machine: Machine, scale: tuple[float, float], lean: float) -> Array:
    """T_world_root (n, 4, 4): the middle of the hips goes the pelvis's way, scaled, and turns as it."""
    pelvis = np.tile(walker.placement, (len(gait), 1, 1)) if gait.base is None else gait.base
    T = np.array(pelvis, dtype=float)
    T[:, :3, :3] = pelvis[:, :3, :3] @ _tilt(-lean)[:3, :3] @ machine.turn.T
    hips = machine.turn @ (machine.legs[0].hip + machine.legs[1].hip) / 2
    T[:, :3, 3] = np.mean(scale) * pelvis[:, :3, 3] - T[:, :3, :3] @ hips
    return T
