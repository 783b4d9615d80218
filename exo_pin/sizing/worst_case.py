"""Worst case of a device's joints over bodies, speeds and body-weight supports."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import product
from typing import Any, NamedTuple

from exo_pin import devices, dynamics
from exo_pin.anatomy import MOVEMENTS, Body
from exo_pin.anatomy.names import Speed
from exo_pin.arguments import word
from exo_pin.gait import SPEEDS, normative_gait
from exo_pin.robot import load_robot
from exo_pin.short_repr import short_repr
from exo_pin.sizing.gear import Ratios, fitting_ratios
from exo_pin.sizing.joint_load import JointLoad
from exo_pin.sizing.motor import Motor
from exo_pin.sizing.walk_sizing import joint_loads, stride_time

STATURES, MASSES, SUPPORTS = (1.50, 1.95), (50.0, 110.0), (0.0, 0.25, 0.5)
"""Corners of the bodies [m, kg] and parts of the weight that are carried: 4 bodies, 5 speeds, 3 supports."""


class SizingCase(NamedTuple):
    """One walk of the worst case: stature [m], mass [kg], speed, body-weight support as a part of 1."""

    stature: float
    mass: float
    speed: Speed
    support: float

    def __str__(self) -> str:
        """In words, for a table."""
        speed = self.speed.replace("_", " ")
        return f"{self.stature:.2f} m, {self.mass:.0f} kg, {speed}, {100 * self.support:.0f} % support"


CaseLoad = tuple[SizingCase, JointLoad]


@dataclass(frozen=True, eq=False)
class WorstCase:
    """The worst of one movement's loads over all cases; the left leg stands for both.

    Attributes:
        movement: Of `MOVEMENTS`.
        loads: Every case with its load.
        effort: Largest torque of the device's record [N m].
        velocity: Largest speed of the device's record [rad/s].
        ratios: The gear ratios with which a motor fits every case; None without a motor.
    """

    movement: str
    loads: tuple[CaseLoad, ...]
    effort: float
    velocity: float
    ratios: Ratios | None

    __repr__ = short_repr

    def worst(self, quantity: str) -> tuple[float, SizingCase]:
        """The largest value of a property of `JointLoad`, or of `energy`, and its case.

        Args:
            quantity: Its name, e.g. `"peak_torque"`; one of the values of `QUANTITIES`.

        Raises:
            UnknownNameError: There is no such quantity.
        """
        word("quantity", quantity, QUANTITIES.values())
        values = [(_value(load, quantity), case) for case, load in self.loads]
        return max(values, key=lambda pair: pair[0])

    @property
    def fitting(self) -> int:
        """Number of cases within the record's effort and velocity."""
        return sum(
            load.peak_torque <= self.effort and load.peak_speed <= self.velocity for _, load in self.loads
        )

    @property
    def fits(self) -> bool:
        """Whether one ratio of the motor fits every case, or without a motor the record's rectangle does."""
        return bool(self.ratios.ranges) if self.ratios is not None else self.fitting == len(self.loads)

    def facts(self) -> dict[str, Any]:
        """Plain values for JSON, units as the keys say."""
        facts: dict[str, Any] = {"fits": self.fits, "cases": len(self.loads)}
        for key, quantity in QUANTITIES.items():
            value, case = self.worst(quantity)
            facts[key] = {"value": value, "case": case._asdict()}
        if self.ratios is not None:
            return facts | {"motor": self.ratios.facts()}
        return facts | {"cases_within_rectangle": self.fitting}


QUANTITIES: Mapping[str, str] = {
    "peak_Nm": "peak_torque",
    "rms_Nm": "rms_torque",
    "peak_speed_rad_s": "peak_speed",
    "peak_W": "peak_power",
    "energy_J_per_stride": "energy",
}
"""What the worst is looked for of: key in JSON -> property of `JointLoad`."""


def bodies() -> tuple[Body, ...]:
    """The corners of the bodies."""
    return tuple(Body.from_stature(m, mass=kg) for m, kg in product(STATURES, MASSES))


def worst_cases(
    device: str | devices.Device, *, motor: Motor | None = None, people: Iterable[Body] | None = None
) -> tuple[WorstCase, ...]:
    """The worst case of every driven movement of a device under the normal walks; ground reaction predicted.

    Args:
        device: By name, file or record.
        motor: One for all joints, or None: the device's record counts.
        people: The bodies, e.g. with a progress bar around them; `bodies()` if left out.

    Raises:
        UnknownNameError: There is no such device.
        FormatError: The device's file is not accepted.
    """
    record = devices.find(device)
    found: dict[str, list[CaseLoad]] = {}
    for body in bodies() if people is None else people:
        for case, loads in _of_body(record, body):
            for movement in MOVEMENTS:
                name = f"left_{movement}"
                if name in loads and name not in record.passive:
                    found.setdefault(movement, []).append((case, loads[name]))
    return tuple(_worst(record, movement, pairs, motor) for movement, pairs in found.items())


def _of_body(device: devices.Device, body: Body) -> Iterator[tuple[SizingCase, Mapping[str, JointLoad]]]:
    """The loads of one body's joints at all speeds and supports."""
    robot = load_robot(body, device=device.carried())
    for speed in SPEEDS:
        walk = normative_gait(speed, leg_length=body.leg_length)
        stride = stride_time(robot, walk)
        for support in SUPPORTS:
            known = dynamics.torques(robot, walk, body_weight_support=support)
            yield SizingCase(body.stature, body.mass, speed, support), joint_loads(known, stride)


def _worst(device: devices.Device, movement: str, loads: list[CaseLoad], motor: Motor | None) -> WorstCase:
    actuator = device.actuators[movement]
    ratios = None if motor is None else fitting_ratios([load for _, load in loads], motor)
    return WorstCase(movement, tuple(loads), actuator.effort, actuator.velocity, ratios)


def _value(load: JointLoad, quantity: str) -> float:
    return load.energy() if quantity == "energy" else float(getattr(load, quantity))
