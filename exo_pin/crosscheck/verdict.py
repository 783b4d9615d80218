"""Verdict over a gait on a robot: every cross-check, and the joint limits."""

from __future__ import annotations

import importlib.util
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from exo_pin import ik
from exo_pin.arguments import LARGEST_SEED, count
from exo_pin.crosscheck.dynamics_witnesses import DYNAMICS_TOLERANCE, inverse_dynamics
from exo_pin.crosscheck.recovery import ANGLE_TOLERANCE, IK_TOLERANCE, Recovery, recover
from exo_pin.crosscheck.witnesses import FK_TOLERANCE, forward
from exo_pin.demand import RangeDemand, range_demands
from exo_pin.gait import Gait, normative_gait
from exo_pin.robot import Robot
from exo_pin.short_repr import short_repr
from exo_pin.simulation import simulate

_ITERATED = 1000  # samples that the slower iterative solver repeats
_RANDOM = 1000  # random configurations in the forward check


@dataclass(frozen=True, eq=False)
class Check:
    """The verdict over one gait on one robot.

    Attributes:
        fk: Largest difference to Pinocchio, by witness.
        recovery: The round trip through inverse kinematics.
        limits: By joint, its angles against its range [rad].
        agreement: Largest difference between the angles of closed form and iterative solver [rad], over
            comparable angles (`Recovery.comparable`) of the first 1000 samples.
        dynamics: Largest relative difference of dynamics to Pinocchio, by witness: inverse dynamics, and as
            `"simulation"` the accelerations of a simulated cycle; empty where it was not checked.
    """

    fk: dict[str, float]
    recovery: Recovery
    limits: dict[str, RangeDemand]
    agreement: float
    dynamics: dict[str, float] = field(default_factory=dict)

    __repr__ = short_repr

    @property
    def dynamics_ok(self) -> bool:
        """Whether all witnesses of inverse dynamics agree with Pinocchio."""
        return max(self.dynamics.values(), default=0.0) <= DYNAMICS_TOLERANCE

    @property
    def fk_ok(self) -> bool:
        """Whether all witnesses agree with Pinocchio."""
        return max(self.fk.values()) <= FK_TOLERANCE

    @property
    def ik_ok(self) -> bool:
        """Whether every frame within the limits was recovered."""
        track, within = self.recovery.track, self.recovery.within
        errors = np.maximum(track.position_error, track.rotation_error)[within]
        return bool(track.converged[within].all() and (errors <= IK_TOLERANCE).all())

    @property
    def angles_ok(self) -> bool:
        """Whether recovered and given angles agree, and both methods, where angles are comparable."""
        return self.recovery.largest_angle_error <= ANGLE_TOLERANCE and self.agreement <= ANGLE_TOLERANCE

    @property
    def joints_outside(self) -> list[str]:
        """Joints that leave their range in some frame."""
        return [joint for joint, demand in self.limits.items() if demand.outside.any()]

    @property
    def limits_ok(self) -> bool:
        """Whether every joint keeps its range in every frame."""
        return not self.joints_outside

    @property
    def consistent(self) -> bool:
        """Whether every cross-check succeeds, whatever the joint limits say."""
        return self.fk_ok and self.ik_ok and self.angles_ok and self.dynamics_ok

    @property
    def ok(self) -> bool:
        """Whether every cross-check succeeds and every joint keeps its range."""
        return self.consistent and self.limits_ok

    def facts(self) -> dict[str, Any]:
        """The verdict as plain values for JSON; units as the keys say, limits in degrees."""
        recovery = self.recovery
        dynamics = {"dynamics_max_relative_difference": self.dynamics} if self.dynamics else {}
        return dynamics | {
            "fk_max_difference": self.fk,
            "ik": {
                "frames": len(recovery.track.q),
                "frames_within_limits": int(recovery.within.sum()),
                "converged": int(recovery.track.converged.sum()),
                "max_position_error_m": recovery.largest_position_error,
                "max_rotation_error_rad": recovery.largest_rotation_error,
                "max_angle_error_deg": float(np.degrees(recovery.largest_angle_error)),
                "method_agreement_deg": float(np.degrees(self.agreement)),
            },
            "limits": {
                joint: {
                    "min": float(np.degrees(demand.lowest)),
                    "max": float(np.degrees(demand.highest)),
                    "violated_frames": demand.samples_outside,
                }
                for joint, demand in self.limits.items()
            },
            "ok": self.ok,
        }


def check(robot: Robot, gait: Gait, *, seed: int = 0, dynamics: bool = False) -> Check:
    """Every cross-check of a gait on a robot.

    Args:
        robot: A robot made from a `Body`.
        gait: The walk.
        seed: Of the random configurations that the forward check adds to the gait's own.
        dynamics: Whether dynamics are checked too: inverse on random states, forward on a simulated cycle.

    Raises:
        DescriptionError: The seed is no whole number from 0 on, or the robot is none of this package's.
    """
    seed = count("seed", seed, 0, LARGEST_SEED)
    rng = np.random.default_rng(seed)
    random = rng.uniform(robot.lower, robot.upper, (_RANDOM, len(robot.joints)))
    recovery = recover(robot, gait)
    return Check(
        forward(robot, np.concatenate([robot.from_gait(gait), random])),
        recovery,
        range_demands(robot, robot.from_gait(gait)),
        _agreement(robot, gait, recovery),
        inverse_dynamics(robot, seed=seed) | _simulated(robot) if dynamics else {},
    )


def _simulated(robot: Robot) -> dict[str, float]:
    """MuJoCo's accelerations over one cycle of the normal walk by torques, against Pinocchio's."""
    if importlib.util.find_spec("mujoco") is None:
        return {}
    return {"simulation": simulate(robot, normative_gait(), cycles=1).witness}


def _agreement(robot: Robot, gait: Gait, recovery: Recovery) -> float:
    """Largest difference [rad] between recovered angles and the iterative solver's, where comparable."""
    n = min(len(gait), _ITERATED)
    base = None if gait.base is None else gait.base[:n]
    other = recover(robot, Gait(gait.time[:n], gait.q[:n], base=base), settings=ik.Dls())
    difference = np.abs(recovery.gait.q[:n] - other.gait.q)[recovery.comparable[:n]]
    return float(difference.max(initial=0.0))
