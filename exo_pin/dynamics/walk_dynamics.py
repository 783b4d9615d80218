"""`Dynamics`: joint torques of a walk, the forces behind them, and how far they can be trusted."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from exo_pin.anatomy import FEET, JOINTS
from exo_pin.anatomy.names import Masses, Reaction, Side
from exo_pin.arrays import Array, Mask, json_numbers
from exo_pin.dynamics.base_motion import Motion
from exo_pin.dynamics.ground_forces import GroundForces, foot_plates
from exo_pin.dynamics.plate_checks import WeightCheck
from exo_pin.dynamics.residual import Residual
from exo_pin.gait import Torques
from exo_pin.gait.trial import ForcePlate
from exo_pin.html_summary import joint_panels, table
from exo_pin.robot import Robot
from exo_pin.short_repr import short_repr

RIGID_TRUNK = (
    "Head, arms and trunk move with the pelvis as one rigid body: a recording's lumbar motion is not used, "
    "and its inertia is part of the residual."
)


@dataclass(frozen=True, eq=False, kw_only=True)
class Dynamics:
    """Inverse dynamics of a walk, n samples. Torques are NaN where they are not known, never zero.

    Attributes:
        time: `(n,)` clock of the walk [s].
        torque: `(n, 12)` in the order of `JOINTS`, positive the way the joint is named [N m]; about the
            robot's own hip axes. NaN in frames that are not valid, and for joints that the robot locks.
        velocity: `(n, 12)` joint velocities, likewise [rad/s].
        support_wrench: `(n, 6)` what acts on the pelvis besides: force, then moment about mid-hip, world axes
            [N, N m], the body-weight support included. With plates it is what the model does not explain.
        ground: Forces of the ground on the feet, `(n, 2, 3)` each; NaN in frames that are not valid.
        valid: `(n,)` whether the ground reaction of every standing foot is known.
        reaction: `"measured"` by force plates, `"predicted"`: an assumption, or `"planned"` with the walk.
        masses: Whose masses move.
        mass: Their sum [kg].
        body_weight_support: Constant vertical force on the pelvis, as a part of the weight of that mass.
        robot: The floating robot whose dynamics these are.
        motion: Its motion, filtered as `motion.how` tells; `motion.base` is where the pelvis is.
        weight: Weight on the plates against that of the masses; None without plates.
        source: Where the numbers come from, in words.
        remarks: What is not valid, doubtful or left out, a plain sentence each.
    """

    time: Array
    torque: Array
    velocity: Array
    support_wrench: Array
    ground: GroundForces
    valid: Mask
    reaction: Reaction
    masses: Masses
    mass: float
    body_weight_support: float
    robot: Robot
    motion: Motion
    weight: WeightCheck | None
    source: str
    remarks: tuple[str, ...]

    __repr__ = short_repr

    @property
    def power(self) -> Array:
        """`(n, 12)` mechanical power of each joint, positive where it gives energy [W]."""
        return self.torque * self.velocity

    @property
    def support_force(self) -> float:
        """The constant vertical force of the body-weight support [N]."""
        return self.body_weight_support * self.mass * float(np.abs(self.robot.model.gravity.linear[2]))

    @cached_property
    def residual(self) -> Residual:
        """What the model does not explain: the support wrench less the body-weight support."""
        wrench = self.support_wrench - np.array([0.0, 0.0, self.support_force, 0.0, 0.0, 0.0])
        return Residual(wrench, self.ground.force.sum(axis=1), self._com_height, self.weight_force)

    @property
    def weight_force(self) -> float:
        """Weight of the masses [N]."""
        return self.mass * float(np.abs(self.robot.model.gravity.linear[2]))

    @cached_property
    def _com_height(self) -> float:
        from exo_pin.kinematics import center_of_mass

        return float(center_of_mass(self.robot, self.motion.q).position[:, 2].mean())

    def to_torques(self) -> Torques:
        """The joint torques as data of the walk, e.g. for `demand.joint_demands`.

        Raises:
            GaitError: No frame is valid.
        """
        return Torques(self.time, self.torque, source=self.source, remarks=self.remarks)

    def foot_forces(self) -> dict[Side, ForcePlate]:
        """Forces of the ground on each foot over the longest run of valid frames, without gaps."""
        return foot_plates(self.ground, self.time, self.valid)

    def _repr_html_(self) -> str:
        """The torques as a row of panels, for notebooks."""
        facts = {
            "ground reaction": self.reaction,
            "valid frames": f"{int(self.valid.sum())} of {len(self.valid)}",
            "mass [kg]": self.mass,
            "source": self.source,
        }
        return joint_panels(self.time, self.torque, "N m") + table(facts)

    def facts(self) -> dict[str, Any]:
        """Peaks and sums as plain values for JSON, over the valid frames; units as the keys say."""
        return {
            "joints": {
                name: {
                    "peak_Nm": float(np.nanmax(np.abs(tau))),
                    "rms_Nm": float(np.sqrt(np.nanmean(tau**2))),
                    "peak_W": float(np.nanmax(np.abs(tau * speed))),
                }
                for name, tau, speed in zip(JOINTS, self.torque.T, self.velocity.T, strict=True)
                if np.isfinite(tau).any()
            },
            "residual": self.residual.facts(),
            "ground_reaction": self.reaction,
            "masses": self.masses,
            "mass_kg": self.mass,
            "body_weight_support_N": self.support_force,
            "frames": len(self.time),
            "valid_frames": int(self.valid.sum()),
            "weight": None
            if self.weight is None
            else {"plates_N": self.weight.measured, "masses_N": self.weight.expected},
            "source": self.source,
            "remarks": list(self.remarks),
        }

    def curves(self) -> dict[str, Any]:
        """The curves as plain values for JSON; None in frames that are not valid."""
        return {
            "time": self.time.tolist(),
            "valid": self.valid.tolist(),
            "torque_Nm": {n: json_numbers(tau) for n, tau in zip(JOINTS, self.torque.T, strict=True)},
            "power_W": {n: json_numbers(p) for n, p in zip(JOINTS, self.power.T, strict=True)},
            "support_wrench": json_numbers(self.support_wrench),
            "ground": {
                foot: {
                    "force_N": json_numbers(self.ground.force[:, k]),
                    "point_m": json_numbers(self.ground.point[:, k]),
                    "moment_Nm": json_numbers(self.ground.moment[:, k]),
                }
                for k, foot in enumerate(FEET)
            },
        }

    def to_json(self) -> dict[str, Any]:
        """Facts and curves."""
        return self.facts() | self.curves()
