"""`Kinetics`: the forces and torques of a walk that are shown: ground reaction, support, torques, power."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

import numpy as np

from exo_pin.anatomy import FEET, SIDES
from exo_pin.arrays import Array, Index
from exo_pin.errors import GaitError
from exo_pin.kinematics import poses
from exo_pin.robot.gait_columns import in_joint_order
from exo_pin.short_repr import short_repr

if TYPE_CHECKING:
    from exo_pin.dynamics import Dynamics
    from exo_pin.simulation import Run

Origin = Literal["measured", "predicted", "planned", "simulated"]
"""Where a ground reaction comes from."""

_SAME = 1e-6
"""Times [s] of two clocks that differ by no more are the same."""


@dataclass(frozen=True, eq=False)
class Effort:
    """How hard the motors of a simulated walk work, `(n, 12)` each, in the order of `JOINTS`.

    Attributes:
        person: Torques of the person [N m].
        load: Torque of the motor as a part of its limit; NaN without a motor.
        error: Joint angle less that of the walk to follow [rad].
    """

    person: Array
    load: Array
    error: Array


@dataclass(frozen=True, eq=False)
class Kinetics:
    """Forces and torques of a walk, n samples; NaN where they are not known.

    Attributes:
        time: `(n,)` clock of the walk [s].
        origin: Where the ground reaction comes from.
        force: `(n, 2, 3)` of the ground on `FEET`, in the world of the walk [N].
        spot: `(n, 2, 3)` centre of pressure, in the axes of the foot [m].
        support: `(n, 3)` what holds the pelvis, in the world of the walk [N].
        torque: `(n, 12)` of the joints, or of the motors of a simulated walk [N m].
        power: `(n, 12)` of these torques [W].
        weight: Of all that is carried [N].
        unloading: Constant upward force of a body-weight support [N].
        source: Where torques and forces come from, in words.
        effort: Of a simulated walk.
    """

    time: Array
    origin: Origin
    force: Array
    spot: Array
    support: Array
    torque: Array
    power: Array
    weight: float
    unloading: float
    source: str
    effort: Effort | None = None

    __repr__ = short_repr

    @classmethod
    def of_dynamics(cls, found: Dynamics) -> Kinetics:
        """Inverse dynamics of a walk."""
        feet = poses(found.robot, found.motion.q, FEET)
        return cls(
            time=found.time,
            origin=found.reaction,
            force=found.ground.force,
            spot=_seen_from(feet, found.ground.point),
            support=np.where(found.valid[:, None], found.support_wrench[:, :3], np.nan),
            torque=found.torque,
            power=found.power,
            weight=found.weight_force,
            unloading=found.support_force,
            source=found.source,
        )

    @classmethod
    def of_run(cls, run: Run, rate: float) -> Kinetics:
        """What happened in a simulated walk.

        Args:
            run: The simulated walk.
            rate: Samples per second [Hz].
        """
        rows = slice(None, None, run.steps_per_sample(rate))
        feet = poses(run.robot, run.robot.from_gait(run.to_gait(rate=rate)), FEET)
        motor, limit = run.motor[rows], in_joint_order(run.robot.joints, run.robot.effort)
        load = np.abs(motor) / np.where(limit > 0.0, limit, np.nan)
        return cls(
            time=run.time[rows],
            origin="simulated",
            force=run.floor.force[rows],
            spot=_seen_from(feet, run.floor.point[rows]),
            support=run.support_wrench[rows, :3],
            torque=motor,
            power=motor * run.dq[rows],
            weight=run.weight,
            unloading=run.body_weight_support * run.weight,
            source=f"motors under the controller {run.controller}",
            effort=Effort(run.person[rows], load, run.q[rows] - run.reference.q[: len(run.q)][rows]),
        )

    def at(self, rows: Index | slice) -> Kinetics:
        """Some of the samples."""
        effort = self.effort
        if effort is not None:
            effort = Effort(effort.person[rows], effort.load[rows], effort.error[rows])
        names = ("time", "force", "spot", "support", "torque", "power")
        parts = {name: getattr(self, name)[rows] for name in names}
        return replace(self, **parts, effort=effort)

    def turned(self, R: Array) -> Kinetics:
        """The same in a world that is turned by a rotation (3, 3)."""
        return replace(self, force=self.force @ R.T, support=self.support @ R.T)

    def on(self, time: Array) -> Kinetics:
        """These, if they are sampled at these times.

        Raises:
            GaitError: They belong to another clock.
        """
        if len(time) != len(self.time) or np.abs(time - self.time).max() > _SAME:
            raise GaitError("the forces belong to another clock than the walk that is shown")
        return self

    def points(self, feet: Array) -> Array:
        """`(n, 2, 3)` centres of pressure on level ground under feet at poses `(n, 2, 4, 4)` [m]."""
        shown = np.einsum("nfij,nfj->nfi", feet[..., :3, :3], self.spot) + feet[..., :3, 3]
        shown[..., 2] = np.where(np.isfinite(shown[..., 2]), 0.0, np.nan)
        return np.asarray(shown)

    def loads(self) -> dict[str, Array]:
        """Ground reaction of each foot and support force, by name and direction `(n,)` [N]."""
        names = ("vertical_ground_reaction", "forward_ground_reaction", "sideways_ground_reaction")
        rows = {
            f"{side}_{name}": self.force[:, foot, axis]
            for axis, name in zip((2, 0, 1), names, strict=True)
            for foot, side in enumerate(SIDES)
        }
        held = "residual_force" if self.origin == "measured" else "support_force"
        up = (f"{held}_up", f"{held}_forward", f"{held}_sideways")
        return rows | {name: self.support[:, axis] for axis, name in zip((2, 0, 1), up, strict=True)}


def _seen_from(T: Array, points: Array) -> Array:
    """Points `(n, 2, 3)` of the world in the axes of frames at poses `(n, 2, 4, 4)`."""
    return np.asarray(np.einsum("nfji,nfj->nfi", T[..., :3, :3], points - T[..., :3, 3]))
