"""Devices side by side: one `Loss` each for the best motion and for the plain copy."""

from __future__ import annotations

import contextlib
import dataclasses
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from exo_pin import devices as known
from exo_pin.anatomy import Body
from exo_pin.arguments import several
from exo_pin.compare.best_motion import best, projected, robot_for
from exo_pin.compare.loss import Loss, clearance, step_width
from exo_pin.compare.motor_demand import MotorDemand, motor_demand
from exo_pin.compare.recorded_walk import DEFAULT_CONDITIONS, Conditions, Walk, walk
from exo_pin.devices import Device
from exo_pin.errors import GaitError
from exo_pin.files import json_number
from exo_pin.gait import Gait, Torques
from exo_pin.html_summary import table
from exo_pin.kinematics import with_events
from exo_pin.short_repr import short_repr


@dataclass(frozen=True, eq=False)
class Comparison:
    """The loss of every device under one walk.

    Attributes:
        walk: The recorded walk on the full exoskeleton.
        conditions: Who moves the pelvis, and whether passive joints are held.
        best: The best motions, least loss first.
        projected: The plain copies, in the same order of devices.
        motors: What the walk's torques require of the motors, in the same order; None without torques.
        torques: Where these torques come from, in words.
    """

    walk: Walk
    conditions: Conditions
    best: tuple[Loss, ...]
    projected: tuple[Loss, ...]
    motors: tuple[MotorDemand, ...] | None = None
    torques: str = ""

    __repr__ = short_repr

    def _repr_html_(self) -> str:
        """What each device loses at best, for notebooks."""
        return table({f"{loss.device.name}, rms loss of the feet [mm]": 1e3 * loss.rms for loss in self.best})

    def facts(self) -> dict[str, Any]:
        """Plain values for JSON; `motors` and `torques` where torques are given."""
        given: dict[str, Any] = {}
        if self.motors is not None:
            given = {"motors": [motor.facts() for motor in self.motors], "torques": self.torques}
        body, gait = self.walk.robot.body, self.walk.gait
        return {
            "gait": {"source": gait.source, "samples": len(gait), "duration_s": gait.duration},
            "body": {} if body is None else {"stature_m": body.stature, "mass_kg": body.mass},
            "conditions": dataclasses.asdict(self.conditions),
            "recorded": {
                "step_width_mm": json_number(1e3 * step_width(self.walk, self.walk.feet)),
                "clearance_mm": json_number(1e3 * clearance(self.walk, self.walk.corners)),
            },
            "best": [loss.facts() for loss in self.best],
            "projected": [loss.facts() for loss in self.projected],
            **given,
        }


def compare(
    gait: Gait,
    devices: Iterable[str | Device] = tuple(known.DEVICES),
    body: Body | None = None,
    *,
    conditions: Conditions = DEFAULT_CONDITIONS,
    torques: Torques | None = None,
) -> Comparison:
    """Compare devices under the same walk.

    Args:
        gait: The walk. Events that it lacks are detected in its kinematics, if it has cycles.
        devices: Names, device files or records; all known ones if left out.
        body: Who wears them; `Body.from_stature()` if left out.
        conditions: Who moves the pelvis, and whether passive joints are held.
        torques: Joint torques of the walk, against which the motors are judged; not judged if left out.

    Raises:
        GaitError: The torques are at other times than the walk.
        UnknownNameError: A device is unknown.
        DescriptionError: `devices` is no sequence.
    """
    body = Body.from_stature() if body is None else body
    recorded = walk(gait, body)
    with contextlib.suppress(GaitError):  # without cycles phases, step width and clearance are unknown
        recorded = dataclasses.replace(recorded, gait=with_events(recorded.robot, gait))
    pairs = []
    for device in map(known.find, several("devices", devices)):
        robot = robot_for(device, body, conditions)
        done = (best(recorded, robot, conditions), projected(recorded, robot, conditions))
        pairs.append(tuple(Loss(device, recorded, motion) for motion in done))
    pairs.sort(key=lambda pair: (round(pair[0].rms, 9), pair[0].device.motors))
    copies = tuple(pair[1] for pair in pairs)
    motors = None
    if torques is not None:
        motors = tuple(motor_demand(copy.device, copy.motion, torques) for copy in copies)
    source = "" if torques is None else torques.source
    return Comparison(recorded, conditions, tuple(pair[0] for pair in pairs), copies, motors, source)
