"""Torques of a walk, joint by joint: peak, power, work per stride, and the parts of motors and person."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple, cast

import numpy as np

from exo_pin.anatomy import JOINTS, SIDES
from exo_pin.anatomy.names import Side
from exo_pin.arguments import real
from exo_pin.arrays import Array, json_numbers
from exo_pin.control.patient import Patient, shares
from exo_pin.dynamics import Dynamics
from exo_pin.errors import GaitError
from exo_pin.gait import Gait
from exo_pin.gait.leg_cycles import cycle_times
from exo_pin.short_repr import short_repr


class StrideWork(NamedTuple):
    """Mechanical work of a joint over a stride, mean of its strides [J]; NaN where none is valid throughout.

    Attributes:
        net: Energy that the joint gives.
        positive: What it gives, where it gives.
        negative: What it takes, where it takes; 0 or less.
        strides: How many strides.
    """

    net: float
    positive: float
    negative: float
    strides: int


@dataclass(frozen=True, eq=False)
class JointTorque:
    """The torque of one joint over the valid frames of a walk.

    Attributes:
        joint: Its name.
        peak: Largest absolute torque [N m].
        rms: Root mean square [N m].
        per_kg: Peak by the person's mass [N m/kg]; NaN where nobody wears the device.
        power: Largest absolute power [W].
        work: Per stride of its leg.
        motor_share: Of motors in the torques of motors and person, 0 to 1: sums of absolute values.
        motor_peak: Largest absolute torque of the motor [N m].
        person_peak: Largest absolute torque of the person [N m].
    """

    joint: str
    peak: float
    rms: float
    per_kg: float
    power: float
    work: StrideWork
    motor_share: float
    motor_peak: float
    person_peak: float

    __repr__ = short_repr

    def facts(self) -> dict[str, Any]:
        """Numbers for JSON; None for what is not known."""
        numbers = {
            "peak_Nm": self.peak,
            "rms_Nm": self.rms,
            "peak_Nm_per_kg": self.per_kg,
            "peak_W": self.power,
            "work_J_per_stride": self.work.net,
            "positive_work_J_per_stride": self.work.positive,
            "negative_work_J_per_stride": self.work.negative,
            "motor_share": self.motor_share,
            "motor_peak_Nm": self.motor_peak,
            "person_peak_Nm": self.person_peak,
        }
        return {name: x if np.isfinite(x) else None for name, x in numbers.items()} | {
            "strides": self.work.strides
        }


@dataclass(frozen=True, eq=False)
class WalkTorques:
    """The torques of a walk, shared by motors and person.

    Attributes:
        found: The inverse dynamics.
        motors: `(n, 12)` torques of the motors [N m].
        person: `(n, 12)` torques of the person; both add up to those of `found`.
        joints: By joint, in the order of `JOINTS`, without joints that are locked.
        shared: Who gives what, in words.
    """

    found: Dynamics
    motors: Array
    person: Array
    joints: Mapping[str, JointTorque]
    shared: str

    __repr__ = short_repr

    def facts(self) -> dict[str, Any]:
        """Numbers for JSON: those of the inverse dynamics, with more of each joint."""
        joints = {name: joint.facts() for name, joint in self.joints.items()}
        return self.found.facts() | {"joints": joints, "shared": self.shared}

    def curves(self) -> dict[str, Any]:
        """Torques of motors and person by joint for JSON; None in frames that are not valid."""
        return {
            key: {name: json_numbers(values[:, JOINTS.index(name)]) for name in self.joints}
            for key, values in (("motor_Nm", self.motors), ("person_Nm", self.person))
        }

    @property
    def missing(self) -> tuple[str, ...]:
        """Sides of which no work per stride is known, in sentences."""
        none = [side for side in SIDES if any(_is_of(j, side) and not j.work.strides for j in self._all)]
        return tuple(
            f"no stride of the {side} foot is valid throughout: its work is not known" for side in none
        )

    @property
    def _all(self) -> tuple[JointTorque, ...]:
        return tuple(self.joints.values())


def walk_torques(
    found: Dynamics, gait: Gait, patient: Patient | None = None, assist: float | None = None
) -> WalkTorques:
    """Share the torques of a walk, and sum them up by joint.

    Args:
        found: The inverse dynamics of the walk.
        gait: The walk, with events where work per stride is wanted.
        patient: The person; None gives nothing, the motors do it all.
        assist: Share of the motors of what the relaxed leg requires, 0 to 1; None: what the person leaves.

    Raises:
        DescriptionError: `assist` is not within 0 to 1.
        GaitError: No torque is known.
    """
    if not np.isfinite(found.torque).any():
        raise GaitError("no torque is known: no frame is valid")
    motors, person = shares(found.torque, gait.q, found.velocity, patient, assist)
    joints = {
        name: _joint(found, gait, k, motors[:, k], person[:, k])
        for k, name in enumerate(JOINTS)
        if np.isfinite(found.torque[:, k]).any()
    }
    return WalkTorques(found, motors, person, joints, _words(patient, assist))


def _words(patient: Patient | None, assist: float | None) -> str:
    if assist is not None:
        rest = "the person" if patient is None else patient.name
        return f"motors give {100 * assist:g} % of what the relaxed leg requires, {rest} the rest"
    if patient is None:
        return "motors alone"
    return f"{patient.name} as the patient's record says, motors the rest"


def _joint(found: Dynamics, gait: Gait, k: int, motor: Array, person: Array) -> JointTorque:
    tau, body = found.torque[:, k], found.robot.body
    peak = _largest(tau)
    by_motor, by_person = (float(np.nansum(np.abs(part))) for part in (motor, person))
    side = cast(Side, JOINTS[k].partition("_")[0])
    return JointTorque(
        joint=JOINTS[k],
        peak=peak,
        rms=float(np.sqrt(np.nanmean(tau**2))),
        per_kg=peak / body.mass if body is not None and body.wearer else float("nan"),
        power=_largest(found.power[:, k]),
        work=stride_work(gait, side, found.power[:, k]),
        motor_share=by_motor / (by_motor + by_person) if by_motor + by_person else float("nan"),
        motor_peak=_largest(motor),
        person_peak=_largest(person),
    )


def _is_of(joint: JointTorque, side: Side) -> bool:
    return joint.joint.startswith(f"{side}_")


def _largest(values: Array) -> float:
    return float(np.nanmax(np.abs(values)))


def stride_work(gait: Gait, side: Side, power: Array) -> StrideWork:
    """Work per stride of a leg: the integral of the power over its strides that are valid throughout.

    Args:
        gait: The walk, with events.
        side: Whose strides.
        power: `(n,)` at the samples of the walk [W]; NaN where unknown.

    Raises:
        DescriptionError: `power` has another shape or is infinite.
        UnknownNameError: There is no such side.
    """
    power = real("power", power, (len(gait),), gaps=True)
    times = cycle_times(gait, side)
    values = np.interp(times, gait.time, power, period=gait.duration if gait.periodic else None)
    whole = np.isfinite(values).all(axis=1)
    if not whole.any():
        return StrideWork(float("nan"), float("nan"), float("nan"), 0)
    t, p = times[whole], values[whole]
    parts = (p, np.maximum(p, 0.0), np.minimum(p, 0.0))
    net, positive, negative = (float(np.trapezoid(part, t, axis=1).mean()) for part in parts)
    return StrideWork(net, positive, negative, int(whole.sum()))
