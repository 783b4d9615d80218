"""What a walk asks of each joint, against what the joint has."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from exo_pin.anatomy import JOINTS
from exo_pin.gait import Gait
from exo_pin.robot import Robot

Array = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]

ACCELERATION = 200.0
"""Largest joint acceleration [rad/s^2], a design choice: no source gives one for these devices; Schwartz's
(2008) very fast walk asks up to 150."""

ROUNDING = 1e-9
"""An excess this small is rounding [rad, rad/s, rad/s^2]."""


@dataclass(frozen=True, eq=False)
class JointDemand:
    """One joint in one walk.

    Attributes:
        joint: Its name.
        q: Asked angles (n,) [rad].
        dq: Asked speeds (n,) [rad/s].
        ddq: Asked accelerations (n,) [rad/s^2].
        lower: Lower limit [rad].
        upper: Upper limit [rad].
        speed: Largest speed [rad/s].
        acceleration: Largest acceleration [rad/s^2].
    """

    joint: str
    q: Array
    dq: Array
    ddq: Array
    lower: float
    upper: float
    speed: float
    acceleration: float

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
    def ok(self) -> bool:
        """Within all three."""
        return not (self.outside | self.too_fast | self.too_hard).any()

    @property
    def cadence(self) -> float:
        """How much faster speed and acceleration allow: they grow with the factor and with its square."""
        by_speed = 1 / self.speed_use if self.speed_use else np.inf
        by_acceleration = self.acceleration_use**-0.5 if self.acceleration_use else np.inf
        return float(min(by_speed, by_acceleration))

    @property
    def amplitude(self) -> float:
        """How much of the joint's movement about its mean fits range, speed and acceleration; 1: all of it.

        0 where the mean itself is out of range; infinite for a joint that stands still within it.
        """
        middle = float(self.q.mean())
        up, down = float(self.q.max()) - middle, middle - float(self.q.min())
        if not self.lower - ROUNDING <= middle <= self.upper + ROUNDING:
            return 0.0
        shares = [(self.upper - middle, up), (middle - self.lower, down)]
        shares += [(1.0, self.speed_use), (1.0, self.acceleration_use)]
        return min((max(room, 0.0) / asked if asked > ROUNDING else np.inf) for room, asked in shares)


def demands(robot: Robot, gait: Gait, *, acceleration: float = ACCELERATION) -> list[JointDemand]:
    """What the walk asks of each joint of the device that the gait knows (not of slides or toes).

    Args:
        robot: The device, its hips in the clinical order.
        gait: The walk; speeds and accelerations are its own derivatives.
        acceleration: Largest acceleration of every joint [rad/s^2].
    """
    found = []
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
            )
            found.append(demand)
    return found
