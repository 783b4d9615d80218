"""Retargeting: foot by foot through inverse kinematics, and joint by joint through the hips' rotation.

Foot by foot, the paths of the ankles relative to the hips are scaled by the ratio of the legs' reaches; the
feet keep their attitude in the world. A person's pelvis leans forward, a robot's trunk does not: the robot's
hips take over the mean lean. Joint by joint, the angles are copied: the rotation of the hip (with that lean)
and of the ankle is decomposed about the robot's own axes, whatever their order.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

from exo_pin.anatomy import JOINTS, SIDES, Body
from exo_pin.arrays import Array
from exo_pin.gait import Gait
from exo_pin.gait.rigid_poses import about
from exo_pin.kinematics import poses
from exo_pin.retarget.axes import angles_about
from exo_pin.retarget.biped import Biped, as_biped, followed, load
from exo_pin.retarget.feet import FeetTask, foot_by_foot
from exo_pin.retarget.findings import findings
from exo_pin.retarget.leg_motion import ANKLE_FIRST, BALANCED
from exo_pin.retarget.retargeted import Retargeted
from exo_pin.retarget.target_robots import Target
from exo_pin.robot import Robot, load_robot, load_urdf

RobotSource = str | Path | Target | Robot | Biped

_LEAST_SHARE, _SHARES = 0.95, (0.99, 0.98, 0.97, 0.96)
"""Factors on the paths where limits, or hip axes that do not meet, forbid them: the least, those between."""


def retarget(gait: Gait, robot: RobotSource = "talos", body: Body | None = None) -> Retargeted:
    """Retarget a walk to another robot.

    Where the legs cannot do all of it, the attitude of the feet is given up before joints jump, and the
    ankles' places last; `Retargeted.notes` says so.

    Args:
        gait: The walk.
        robot: One of `TARGETS` by name, the path of a URDF, a xacro file or a TOML record, a record, a robot
            from `load_urdf`, or a `Biped`.
        body: Whose walk it is; `Body.from_stature()` if left out.

    Raises:
        UnknownNameError: The robot is unknown.
        DescriptionError: Its URDF is missing, or is no robot with two legs.
        FormatError: Its record is not accepted.
    """
    biped = _biped(robot)
    walker = load_robot(body)
    assert walker.body is not None  # load_robot made it
    lean = _lean(gait)
    T = _links(gait, walker, lean)
    copied = _copied(gait, biped, T[..., :3, :3])
    body = walker.body
    own = [body.leg(side) for side in SIDES]
    ratios = [leg.reach / (size.thigh + size.shank) for leg, size in zip(biped.legs, own, strict=True)]

    def made(share: float, weights: tuple[float, ...]) -> Retargeted:
        scale = share * ratios[0], share * ratios[1]
        ankles, attitudes = _goals(biped, T, scale)
        return Retargeted(
            biped=biped,
            gait=gait,
            q=foot_by_foot(FeetTask(biped, gait, ankles, attitudes), copied, weights),
            copied=copied,
            base=_base(gait, walker, biped, scale, lean),
            lean=lean,
            scale=scale,
            ankles=ankles,
            attitudes=attitudes,
            body=body,
        )

    found = _best(made)
    return replace(found, notes=findings(found))


def _best(made: Callable[[float, tuple[float, ...]], Retargeted]) -> Retargeted:
    """The walk on the largest paths that are reached; else with the ankles placed; else as near as can be."""
    whole, small = made(1.0, ANKLE_FIRST), None
    for enough in (_reached, _placed):
        if enough(whole):
            return whole
        small = small or made(_LEAST_SHARE, ANKLE_FIRST)
        if enough(small):
            between = (made(share, ANKLE_FIRST) for share in _SHARES)
            return next(filter(enough, between), small)
    near = [made(share, BALANCED) for share in (1.0, _LEAST_SHARE)]
    return min(near, key=lambda tried: tried.errors.position_rms)


def _reached(walk: Retargeted) -> bool:
    return not walk.missed.any() and not walk.jumps.any()


def _placed(walk: Retargeted) -> bool:
    return not walk.missed_places.any() and not walk.jumps.any()


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


def _goals(biped: Biped, T: Array, scale: tuple[float, float]) -> tuple[Array, Array]:
    """Goals of the ankles (n, 2, 3), the paths from hip to ankle scaled, and of the feet's rotation."""
    pairs = enumerate(zip(biped.legs, scale, strict=True))
    ankles = [leg.hip + s * (T[:, k, 2] - T[:, k, 0])[:, :3, 3] for k, (leg, s) in pairs]
    return np.stack(ankles, axis=1), T[:, :, 2, :3, :3]


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
        shared = leg.drive.sum(axis=0)  # a joint and its followers make its movement together
        columns = [biped.robot.column(joint) for joint in leg.joints]
        q[:, columns] += np.concatenate(parts, axis=1) / np.where(shared == 0, 1.0, shared)
    return followed(biped.robot, q, biped.follow)


def _base(gait: Gait, walker: Robot, biped: Biped, scale: tuple[float, float], lean: float) -> Array:
    """T_world_root (n, 4, 4): the midpoint of the hips follows the pelvis's scaled path and its rotation."""
    pelvis = walker.pelvis_poses(gait)
    T = pelvis.copy()
    T[:, :3, :3] = pelvis[:, :3, :3] @ _tilt(-lean)[:3, :3] @ biped.rotation.T
    hips = biped.rotation @ (biped.legs[0].hip + biped.legs[1].hip) / 2
    T[:, :3, 3] = np.mean(scale) * pelvis[:, :3, 3] - T[:, :3, :3] @ hips
    return T
