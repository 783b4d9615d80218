"""The verdict over a gait on a robot: every cross-check, and the joint limits."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from exo_pin import ik
from exo_pin.crosscheck.recovery import ANGLE_TOLERANCE, IK_TOLERANCE, Recovery, recover
from exo_pin.crosscheck.witnesses import FK_TOLERANCE, forward
from exo_pin.gait import Gait
from exo_pin.robot import Robot

_ITERATED = 1000


@dataclass(frozen=True, eq=False)
class Check:
    """The verdict over one gait on one robot.

    Attributes:
        fk: Largest difference to Pinocchio by witness.
        recovery: The inverse kinematics' round trip.
        limits: By joint: smallest and largest angle [rad], number of frames outside the robot's limits.
        agreement: Largest difference between the closed form's and the iterative solver's angles [rad], where
            `Recovery.comparable`; over the first 1000 samples, since the iteration takes its time.
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
    def angles_ok(self) -> bool:
        """The recovered angles are the given ones, and both methods agree, where angles are comparable."""
        errors = np.abs(self.recovery.angle_error[self.recovery.comparable])
        return bool((errors <= ANGLE_TOLERANCE).all() and self.agreement <= ANGLE_TOLERANCE)

    @property
    def limits_ok(self) -> bool:
        """No joint leaves its limits in any frame."""
        return not any(frames for _, _, frames in self.limits.values())

    @property
    def ok(self) -> bool:
        """All of the above."""
        return self.fk_ok and self.ik_ok and self.angles_ok and self.limits_ok

    def facts(self) -> dict[str, Any]:
        """The verdict as plain numbers for JSON: metres, radians and degrees as the names say."""
        found = self.recovery
        return {
            "fk_max_difference": self.fk,
            "ik": {
                "frames": len(found.track),
                "frames_within_limits": int(found.within.sum()),
                "converged": int(found.track.converged.sum()),
                "max_position_error_m": found.largest_position_error,
                "max_rotation_error_rad": found.largest_rotation_error,
                "max_angle_error_deg": float(np.degrees(found.largest_angle_error)),
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
    return Check(
        forward(robot, np.concatenate([robot.from_gait(gait), random])),
        recovery,
        limits(robot, gait),
        _agreement(robot, gait, recovery),
    )


def _agreement(robot: Robot, gait: Gait, recovery: Recovery) -> float:
    """Largest difference [rad] between the recovered angles and those of the iteration, where comparable."""
    n = min(len(gait), _ITERATED)
    base = None if gait.base is None else gait.base[:n]
    other = recover(robot, Gait(gait.time[:n], gait.q[:n], base=base), settings=ik.Dls())
    difference = np.abs(recovery.gait.q[:n] - other.gait.q)[recovery.comparable[:n]]
    return float(difference.max(initial=0.0))


def limits(robot: Robot, gait: Gait) -> dict[str, tuple[float, float, int]]:
    """By joint: smallest and largest angle [rad], and in how many frames it is outside the robot's limits."""
    q = robot.from_gait(gait)
    angles, outside = robot.angles(q), robot.outside(q).sum(axis=0)
    return {
        joint: (float(angles[:, j].min()), float(angles[:, j].max()), int(outside[j]))
        for j, joint in enumerate(robot.joints)
    }
