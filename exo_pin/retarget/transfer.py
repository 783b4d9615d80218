"""Retargeting: foot by foot through inverse kinematics, and joint by joint through the hips' rotation.

Foot by foot, the paths of the ankles relative to the hips are scaled by the ratio of the legs' reaches; the
feet keep their attitude in the world. A person's pelvis leans forward, a robot's trunk does not: the robot's
hips take over the mean lean. Joint by joint, the angles are copied: the rotation of the hip (with that lean)
and of the ankle is decomposed about the robot's own axes, whatever their order.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from exo_pin import ik
from exo_pin.anatomy import JOINTS, SIDES, Body
from exo_pin.arrays import Array
from exo_pin.gait import Gait
from exo_pin.gait.rigid_poses import about
from exo_pin.kinematics import poses
from exo_pin.retarget.axes import angles_about
from exo_pin.retarget.biped import Biped, as_biped, load
from exo_pin.retarget.retargeted import Retargeted
from exo_pin.retarget.robot_legs import RobotLeg
from exo_pin.retarget.target_robots import Target
from exo_pin.robot import Robot, load_robot, load_urdf

RobotSource = str | Path | Target | Robot | Biped

_SIX_JOINTS = ik.Auto(tolerance=1e-6, dls=ik.Dls(restarts=0))
"""A micrometre and a microradian suffice for a robot's joints; the copied angles are a good start."""

_FEWER_JOINTS = ik.Dls(tolerance=1e-9, restarts=0, warm_start=False)
"""For legs that cannot reach every attitude: least squares for each sample from the copied angles."""

_SHRINKAGES = (1.0, 0.99, 0.98, 0.97, 0.96, 0.95)
"""Factors on the paths, tried in this order where limits, or hip axes without a common point, forbid them."""

_ROTATION_WEIGHT = 1e-3
"""Weight of the attitude against the place, for legs that cannot reach both."""

_ARM = 0.1
"""Distance from the ankle of the points that stand for the attitude [m]."""


def retarget(gait: Gait, robot: RobotSource = "talos", body: Body | None = None) -> Retargeted:
    """Retarget a walk to another robot.

    Args:
        gait: The walk.
        robot: One of `TARGETS` by name, the path of a URDF or of a TOML record, a record, a robot from
            `load_urdf`, or a `Biped`.
        body: Whose walk it is; `Body.from_stature()` if left out.

    Raises:
        UnknownNameError: The robot is unknown.
        DescriptionError: Its URDF is missing, or is no robot with two legs.
        FormatError: Its record is not accepted.
    """
    biped = _biped(robot)
    walker = load_robot(body)
    lean = _lean(gait)
    T = _links(gait, walker, lean)
    copied = _copied(gait, biped, T[..., :3, :3])
    assert walker.body is not None  # load_robot made it
    own = [walker.body.leg(side) for side in SIDES]
    ratios = [leg.reach / (size.thigh + size.shank) for leg, size in zip(biped.legs, own, strict=True)]
    best: Retargeted | None = None
    for share in _SHRINKAGES:
        tried = _solved(gait, walker, biped, T, (share * ratios[0], share * ratios[1]), copied, lean)
        if best is None or tried.missed.sum() < best.missed.sum():
            best = tried
        if not best.missed.any():
            break
    assert best is not None  # there is a first share
    return best


def joint_by_joint(gait: Gait, biped: Biped, body: Body | None = None) -> Array:
    """Joint values (n, nq) that copy the walk's angles, hips and ankles through their rotation [rad].

    Args:
        gait: The walk.
        biped: The robot.
        body: Whose walk it is; `Body.from_stature()` if left out.
    """
    return _copied(gait, biped, _links(gait, load_robot(body), _lean(gait))[..., :3, :3])


def _biped(robot: RobotSource) -> Biped:
    if isinstance(robot, Biped):
        return robot
    if not isinstance(robot, Robot):
        return load(robot)
    if robot.base != "fixed" or (robot.placement != np.eye(4)).any():
        robot = load_urdf(robot.urdf, path=robot.path)  # its root at the origin
    return as_biped(Target(robot.name, ""), robot)


def _lean(gait: Gait) -> float:
    """Mean forward lean of the pelvis [rad]."""
    if gait.base is None:
        return 0.0
    R = gait.base[:, :3, :3]
    return float(np.arctan2(-R[:, 2, 0].mean(), R[:, 2, 2].mean()))


def _links(gait: Gait, walker: Robot, lean: float) -> Array:
    """Poses (n, 2, 3, 4, 4) of thigh, shank and foot of both legs relative to an upright pelvis."""
    names = [f"{side}_{link}" for side in SIDES for link in ("thigh", "shank", "sole_plate")]
    T = poses(walker, walker.from_gait(gait), names, base=np.eye(4))
    return np.asarray(_tilt(lean) @ T.reshape(len(gait), 2, 3, 4, 4))


def _tilt(lean: float) -> Array:
    """A pose (4, 4) rotated forward about the axis to the left."""
    T = np.eye(4)
    T[:3, :3] = about((0.0, 1.0, 0.0), lean)
    return T


def _solved(
    gait: Gait,
    walker: Robot,
    biped: Biped,
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
            for k, (leg, s) in enumerate(zip(biped.legs, scale, strict=True))
        ],
        axis=1,
    )
    R = T[:, :, 2, :3, :3]
    robot = biped.robot
    start = np.array(copied)
    low = robot.nq - len(robot.joints)
    start[:, low:] = np.clip(start[:, low:], robot.lower, robot.upper)
    goals = {leg.foot: _goal(biped, leg, ankles[:, k], R[:, k]) for k, leg in enumerate(biped.legs)}
    six_joints = all(leg.reaches_any_pose for leg in biped.legs)
    q = ik.track(robot, goals, start, settings=_SIX_JOINTS if six_joints else _FEWER_JOINTS).q
    return Retargeted(
        biped=biped,
        gait=gait,
        q=q,
        copied=copied,
        base=_base(gait, walker, biped, scale, lean),
        lean=lean,
        scale=scale,
        ankles=ankles,
        attitudes=R,
        body=walker.body,
    )


def _goal(biped: Biped, leg: RobotLeg, ankle: Array, R: Array) -> ik.Points | Array:
    """Goals (n, 4, 4) of the foot's link; for legs of fewer joints its ankle, and weak points around it."""
    rotation = biped.rotation
    T = np.tile(np.eye(4), (len(R), 1, 1))
    T[:, :3, :3] = rotation @ R @ leg.T[:3, :3]
    T[:, :3, 3] = ankle @ rotation.T - np.einsum("nij,j->ni", T[:, :3, :3], leg.ankle_in_foot)
    if leg.reaches_any_pose:
        return T
    local = leg.ankle_in_foot + np.vstack([np.zeros(3), _ARM * np.eye(3)])
    points = local @ np.swapaxes(T[:, :3, :3], -1, -2) + T[:, None, :3, 3]
    return ik.Points(local, points, (1.0, *3 * (_ROTATION_WEIGHT,)))


def _copied(gait: Gait, biped: Biped, R: Array) -> Array:
    """Joint values (n, nq) that copy the gait: R (n, 2, 3, 3, 3) are rotations of thigh, shank and foot."""
    q = np.tile(biped.stand, (len(gait), 1))
    for k, (side, leg) in enumerate(zip(SIDES, biped.legs, strict=True)):
        thigh, shank, foot = (R[:, k, j] for j in range(3))
        knee = leg.knee
        bent = gait.q[:, JOINTS.index(f"{side}_knee_flexion")] * np.sign(leg.axes[knee, 1])
        parts = [angles_about(leg.axes[:knee], thigh), bent[:, None]]
        if knee + 1 < len(leg.joints):
            parts.append(angles_about(leg.axes[knee + 1 :], np.swapaxes(shank, -1, -2) @ foot))
        q[:, [biped.robot.column(joint) for joint in leg.joints]] += np.concatenate(parts, axis=1)
    return q


def _base(gait: Gait, walker: Robot, biped: Biped, scale: tuple[float, float], lean: float) -> Array:
    """T_world_root (n, 4, 4): the midpoint of the hips follows the pelvis's scaled path and its rotation."""
    pelvis = walker.pelvis_poses(gait)
    T = pelvis.copy()
    T[:, :3, :3] = pelvis[:, :3, :3] @ _tilt(-lean)[:3, :3] @ biped.rotation.T
    hips = biped.rotation @ (biped.legs[0].hip + biped.legs[1].hip) / 2
    T[:, :3, 3] = np.mean(scale) * pelvis[:, :3, 3] - T[:, :3, :3] @ hips
    return T
