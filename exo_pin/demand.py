"""What a walk asks of each joint, against what the joint has: range, speed, acceleration, torque."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exo_pin.anatomy import JOINTS
from exo_pin.arrays import Array, Mask
from exo_pin.devices import SLIDES
from exo_pin.gait import Gait, Torques
from exo_pin.robot import Robot

ACCELERATION = 200.0
"""Largest joint acceleration [rad/s^2], a design choice: no source gives one for these devices; Schwartz's
(2008) very fast walk asks up to 150."""

ROUNDING = 1e-9
"""An excess this small is rounding [rad, rad/s, rad/s^2]."""


@dataclass(frozen=True, eq=False)
class JointDemand:
    """One joint in one walk; of a slide, metres and newtons stand where it says radians and newton metres.

    Attributes:
        joint: Its name.
        q: Asked angles (n,) [rad].
        dq: Asked speeds (n,) [rad/s].
        ddq: Asked accelerations (n,) [rad/s^2].
        lower: Lower limit [rad].
        upper: Upper limit [rad].
        speed: Largest speed [rad/s].
        acceleration: Largest acceleration [rad/s^2].
        tau: Asked torques (n,) [N m], NaN where they are not known; None: not asked.
        effort: Largest torque [N m].
    """

    joint: str
    q: Array
    dq: Array
    ddq: Array
    lower: float
    upper: float
    speed: float
    acceleration: float
    tau: Array | None = None
    effort: float = np.inf

    @property
    def slide(self) -> bool:
        """Whether it slides [m]; the others turn [rad]."""
        return self.joint in SLIDES

    @property
    def outside(self) -> Mask:
        """Samples (n,) outside the range."""
        return (self.q < self.lower - ROUNDING) | (self.q > self.upper + ROUNDING)

    @property
    def too_fast(self) -> Mask:
        """Samples (n,) faster than the joint can."""
        return np.abs(self.dq) > self.speed + ROUNDING

    @property
    def too_hard(self) -> Mask:
        """Samples (n,) accelerated harder than the joint can."""
        return np.abs(self.ddq) > self.acceleration + ROUNDING

    @property
    def too_strong(self) -> Mask:
        """Samples (n,) at which the torque is more than the joint has; none where it is not known."""
        if self.tau is None:
            return np.zeros(len(self.q), dtype=bool)
        return np.abs(np.nan_to_num(self.tau)) > self.effort + ROUNDING

    @property
    def margin(self) -> float:
        """Distance from the nearer end of the range [rad]; negative: outside by that much."""
        return float(min(self.q.min() - self.lower, self.upper - self.q.max()))

    @property
    def speed_use(self) -> float:
        """Share of the speed that is used; above 1: too fast."""
        return float(np.abs(self.dq).max() / self.speed)

    @property
    def acceleration_use(self) -> float:
        """Share of the acceleration that is used; above 1: too hard."""
        return float(np.abs(self.ddq).max() / self.acceleration)

    @property
    def torque_use(self) -> float | None:
        """Share of the torque that is used; above 1: too strong; None where it is not known."""
        if self.tau is None or np.isnan(self.tau).all():
            return None
        asked = float(np.nanmax(np.abs(self.tau)))
        return asked / self.effort if self.effort else np.inf if asked > ROUNDING else 0.0

    @property
    def ok(self) -> bool:
        """Within all of them."""
        return not (self.outside | self.too_fast | self.too_hard | self.too_strong).any()

    @property
    def cadence(self) -> float:
        """How much faster speed and acceleration allow: they grow with the factor and with its square."""
        by_speed = 1 / self.speed_use if self.speed_use else np.inf
        by_acceleration = self.acceleration_use**-0.5 if self.acceleration_use else np.inf
        return float(min(by_speed, by_acceleration))

    @property
    def amplitude(self) -> float:
        """How much of the joint's movement about its mean fits range, speed and acceleration; 1: all of it.

        0 where the mean itself is out of range; infinite for a joint that stands still within it. A slide
        moves with the pelvis, not with the joints: all or nothing. Torques at another amplitude are unknown.
        """
        if self.slide:
            return np.inf if self.ok else 0.0
        middle = float(self.q.mean())
        up, down = float(self.q.max()) - middle, middle - float(self.q.min())
        if not self.lower - ROUNDING <= middle <= self.upper + ROUNDING:
            return 0.0
        shares = [(self.upper - middle, up), (middle - self.lower, down)]
        shares += [(1.0, self.speed_use), (1.0, self.acceleration_use)]
        return min((max(room, 0.0) / asked if asked > ROUNDING else np.inf) for room, asked in shares)


def demands(
    robot: Robot, gait: Gait, *, acceleration: float = ACCELERATION, torques: Torques | None = None
) -> list[JointDemand]:
    """What the walk asks of each joint of the device that the gait knows (`pelvis.slides` of the slides).

    Args:
        robot: The device, its hips in the clinical order.
        gait: The walk; speeds and accelerations are its own derivatives.
        acceleration: Largest acceleration of every joint [rad/s^2].
        torques: Of this walk, on its clock; torques are not asked if left out.

    Raises:
        GaitError: The torques' clock is another one.
    """
    found, tau = [], None if torques is None else torques.at(gait.time)
    for k, name in enumerate(JOINTS):
        if name in robot.joints:
            j = robot.joints.index(name)
            demand = JointDemand(
                joint=name,
                q=gait.q[:, k],
                dq=gait.dq[:, k],
                ddq=gait.ddq[:, k],
                lower=float(robot.lower[j]),
                upper=float(robot.upper[j]),
                speed=float(robot.velocity[j]),
                acceleration=acceleration,
                tau=None if tau is None else tau[:, k],
                effort=float(robot.effort[j]),
            )
            found.append(demand)
    return found
