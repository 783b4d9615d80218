"""Cross-checks: four ways of forward kinematics against each other, inverse against forward, joint limits."""

from __future__ import annotations

import io
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from exo_pin import dh, ik
from exo_pin.anatomy import FEET, JOINTS
from exo_pin.errors import DescriptionError
from exo_pin.gait import Gait
from exo_pin.kinematics import poses
from exo_pin.robot import Robot

Array = npt.NDArray[np.float64]

FK_TOLERANCE = 1e-12
"""Largest difference between two ways of forward kinematics [m, and of a rotation matrix's entries]."""

IK_TOLERANCE = 1e-9
"""Largest distance of the recovered from the given foot [m and rad]."""

BENT_KNEE = np.radians(5.0)
"""Angles are compared where the knee is bent more than this [rad]: towards a straight knee a foot's pose
hardly tells the knee's angle."""

_SAMPLES = 200
"""Configurations that yourdfpy is asked for: it takes a millisecond each."""

_GRID = 6
"""Decimals of the angles that yourdfpy is asked for: the scene graph below it leaves out turns, and changes
of a turn, below 1e-8 rad."""


@dataclass(frozen=True, eq=False)
class Recovery:
    """What inverse kinematics made of a gait's feet; the row `k` belongs to the gait's sample `k`.

    Attributes:
        given: The walk whose feet were given.
        gait: The recovered walk.
        track: The solver's own account.
        within: (n,) True where the given angles are within the robot's limits.
    """

    given: Gait
    gait: Gait
    track: ik.Track
    within: npt.NDArray[np.bool_]

    @property
    def angle_error(self) -> Array:
        """(n, 12) recovered minus given angles [rad]."""
        return self.gait.q - self.given.q

    @property
    def comparable(self) -> npt.NDArray[np.bool_]:
        """(n, 12) True for angles within limits, of a leg whose knee is bent more than `BENT_KNEE`."""
        knees = [JOINTS.index(f"{side}_knee_flexion") for side in ("left", "right")]
        bent = np.repeat(self.gait.q[:, knees] > BENT_KNEE, len(JOINTS) // 2, axis=1)
        return np.asarray(bent & self.within[:, None])


def recover(robot: Robot, gait: Gait, *, settings: Any = None) -> Recovery:
    """Forward kinematics of the gait's feet, then inverse kinematics of those feet.

    Args:
        robot: The robot.
        gait: The walk.
        settings: Settings of `ik.track`; its default if left out.
    """
    q = robot.from_gait(gait)
    base = gait.base if robot.base == "fixed" else None
    feet = poses(robot, q, FEET, base=base)
    chosen = {} if settings is None else {"settings": settings}
    track = ik.track(robot, {foot: feet[:, k] for k, foot in enumerate(FEET)}, base=base, **chosen)
    angles = robot.angles(q)
    within = np.all((angles >= robot.lower - 1e-9) & (angles <= robot.upper + 1e-9), axis=1)
    return Recovery(gait, robot.to_gait(track.q, gait), track, within)


def forward(robot: Robot, q: npt.ArrayLike) -> dict[str, float]:
    """Largest difference to Pinocchio of each witness: positions [m] and rotation matrices' entries.

    Args:
        robot: A robot made from a `Body`.
        q: Configurations (n, nq) [rad]; at most 200 of them, evenly chosen and rounded to
            a microradian, are given to yourdfpy.

    Returns:
        `recursion`, `dh` and `yourdfpy`: over every joint's link, locked joints too, and both feet.

    Raises:
        DescriptionError: The robot is not an exoskeleton of this package.
    """
    if robot.body is None or robot.base != "fixed":
        raise DescriptionError("the witness needs a robot that load_robot made with a fixed base")
    q = np.asarray(q, dtype=float).reshape(-1, robot.nq)
    few = q[np.unique(np.linspace(0, len(q) - 1, _SAMPLES).astype(int))]
    body, order = robot.body, robot.hip_order

    def by(witness: Callable[..., dict[str, Array]], q: Array) -> dict[str, Array]:
        angles = dict(zip(robot.joints, robot.angles(q).T, strict=True))
        return dh.of_device(body, angles, hip_order=order, witness=witness)

    witnesses: dict[str, tuple[Array, Callable[[Array], dict[str, Array]]]] = {
        "recursion": (q, lambda q: by(dh.recursion, q)),
        "dh": (q, lambda q: by(dh.modified_dh, q)),
        "yourdfpy": (np.round(few, _GRID), lambda q: _yourdfpy(robot, q)),
    }
    return {name: _difference(robot, q, witness(q)) for name, (q, witness) in witnesses.items()}


def _difference(robot: Robot, q: Array, poses_of: dict[str, Array]) -> float:
    """Largest difference in any entry of any pose, all relative to the pelvis (or the stand it slides on)."""
    names = tuple(poses_of)
    ours = poses(robot, q, names, base=np.eye(4))
    return float(max(np.abs(poses_of[name] - ours[:, k]).max() for k, name in enumerate(names)))


def _yourdfpy(robot: Robot, q: Array) -> dict[str, Array]:
    """Poses by yourdfpy, which reads the same URDF with code of its own."""
    import yourdfpy  # 0.5 s, needed here only

    scene = yourdfpy.URDF.load(io.BytesIO(robot.urdf.encode()), load_meshes=False)
    links = {joint: scene.joint_map[joint].child for joint in (*robot.joints, *JOINTS)}
    links |= {foot: foot for foot in FEET}
    out = {name: np.empty((len(q), 4, 4)) for name in links}
    for k, row in enumerate(q):
        scene.update_cfg(dict(zip(robot.joints, row, strict=True)))
        for name, link in links.items():
            out[name][k] = scene.get_transform(link, scene.base_link)
    return out


@dataclass(frozen=True, eq=False)
class Check:
    """The verdict over one gait on one robot.

    Attributes:
        fk: Largest difference to Pinocchio by witness.
        recovery: The inverse kinematics' round trip.
        limits: By joint: smallest and largest angle [rad], number of frames outside the robot's limits.
        agreement: Largest difference between the closed form's and the iterative solver's angles [rad], where
            `Recovery.comparable`.
    """

    fk: dict[str, float]
    recovery: Recovery
    limits: dict[str, tuple[float, float, int]]
    agreement: float

    @property
    def fk_ok(self) -> bool:
        """All witnesses agree with Pinocchio."""
        return max(self.fk.values()) <= FK_TOLERANCE

    @property
    def ik_ok(self) -> bool:
        """Every frame within limits was recovered."""
        track, within = self.recovery.track, self.recovery.within
        errors = np.maximum(track.position_error, track.rotation_error)[within]
        return bool(track.converged[within].all() and (errors <= IK_TOLERANCE).all())

    @property
    def limits_ok(self) -> bool:
        """No joint leaves its limits in any frame."""
        return not any(frames for _, _, frames in self.limits.values())

    @property
    def ok(self) -> bool:
        """All of the above."""
        return self.fk_ok and self.ik_ok and self.limits_ok

    def facts(self) -> dict[str, Any]:
        """The verdict as plain numbers for JSON: metres, radians and degrees as the names say."""
        track, within = self.recovery.track, self.recovery.within
        angles = np.degrees(np.abs(self.recovery.angle_error[self.recovery.comparable]))
        return {
            "fk_max_difference": self.fk,
            "ik": {
                "frames": len(track.q),
                "frames_within_limits": int(within.sum()),
                "converged": int(track.converged.sum()),
                "max_position_error_m": float(track.position_error[within].max(initial=0.0)),
                "max_rotation_error_rad": float(track.rotation_error[within].max(initial=0.0)),
                "max_angle_error_deg": float(angles.max(initial=0.0)),
                "method_agreement_deg": float(np.degrees(self.agreement)),
            },
            "limits": {
                joint: {"min": float(np.degrees(low)), "max": float(np.degrees(high)), "violated_frames": n}
                for joint, (low, high, n) in self.limits.items()
            },
            "ok": self.ok,
        }


def check(robot: Robot, gait: Gait, *, seed: int = 0) -> Check:
    """Every cross-check of a gait on a robot.

    Args:
        robot: A robot made from a `Body`.
        gait: The walk.
        seed: Seed of the random configurations that join the gait's own in the forward check.
    """
    rng = np.random.default_rng(seed)
    random = rng.uniform(robot.lower, robot.upper, (1000, len(robot.joints)))
    recovery = recover(robot, gait)
    other = recover(robot, gait, settings=ik.Dls())
    difference = np.abs(recovery.gait.q - other.gait.q)[recovery.comparable]
    return Check(
        forward(robot, np.concatenate([robot.from_gait(gait), random])),
        recovery,
        limits(robot, gait),
        float(difference.max(initial=0.0)),
    )


def limits(robot: Robot, gait: Gait) -> dict[str, tuple[float, float, int]]:
    """By joint: smallest and largest angle [rad], and in how many frames it is outside the robot's limits."""
    angles = robot.angles(robot.from_gait(gait))
    outside = ((angles < robot.lower - 1e-9) | (angles > robot.upper + 1e-9)).sum(axis=0)
    return {
        joint: (float(angles[:, j].min()), float(angles[:, j].max()), int(outside[j]))
        for j, joint in enumerate(robot.joints)
    }
