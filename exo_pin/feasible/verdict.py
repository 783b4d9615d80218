"""The verdict over one walk on one device, and how much of the walk is possible."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from exo_pin.anatomy import JOINTS, SIDES, Body
from exo_pin.devices import Device
from exo_pin.errors import GaitError
from exo_pin.feasible.collision import Nearest, nearest
from exo_pin.feasible.limits import ACCELERATION, JointDemand, demands
from exo_pin.gait import Gait
from exo_pin.gait.phases import PHASES, percent
from exo_pin.kinematics import events
from exo_pin.robot import Robot, load_robot

Array = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]

MOST = 3.0
"""Amplitudes are sought up to this factor."""

FASTEST = 10.0
"""Cadences are sought up to this factor."""

_STEPS = 12  # halvings of the interval of amplitudes: to a thousandth


@dataclass(frozen=True, eq=False)
class Feasibility:
    """Whether a device can do a walk.

    Attributes:
        robot: The device on the body.
        gait: The walk as the device does it: locked joints at zero.
        joints: What each joint of the device is asked.
        nearest: Distance between its parts.
        gap: Distance that the parts must keep [m].
        reach: By side: least reach to spare between hip and ankle [m]; negative: too far by that much.
        dropped: By locked joint: the largest angle that the walk asks of it [rad]; it does not enter the
            verdict (`exo_pin.compare` says what it costs).
        cadence: Largest factor on the speed of the whole walk that speeds and accelerations allow; at most
            `FASTEST`.
        amplitude: Largest factor on every joint's movement about its mean that the limits and the gap allow,
            at the walk's own cadence; at most `MOST`; 0 where not even the mean posture is possible.
    """

    robot: Robot
    gait: Gait
    joints: tuple[JointDemand, ...]
    nearest: Nearest
    gap: float
    reach: dict[str, float]
    dropped: dict[str, float]
    cadence: float
    amplitude: float

    @property
    def colliding(self) -> Mask:
        """Samples (n,) at which parts come nearer than the gap."""
        return self.nearest.distance < self.gap

    @property
    def ok(self) -> bool:
        """Every joint within its limits, no parts too near, and nothing out of reach."""
        return (
            all(demand.ok for demand in self.joints)
            and not bool(self.colliding.any())
            and min(self.reach.values()) >= -1e-9
        )

    @property
    def failures(self) -> list[tuple[str, str, Mask]]:
        """What fails: the joint or pair of parts, how, and at which samples (n,)."""
        kinds = (
            ("outside", "outside its range"),
            ("too_fast", "too fast"),
            ("too_hard", "accelerated too hard"),
        )
        found = [
            (demand.joint, text, getattr(demand, kind))
            for demand in self.joints
            for kind, text in kinds
            if getattr(demand, kind).any()
        ]
        if self.colliding.any():
            a, b = self.nearest.pairs[int(self.nearest.distance.argmin())]
            found.append((f"{a} and {b}", "too near", self.colliding))
        return found

    def phases(self, mask: Mask, name: str) -> list[str]:
        """Phases of the cycle in which marked samples lie: of the foot on the joint's side, else the left."""
        side = next((s for s in SIDES if name.startswith(s)), SIDES[0])
        share = percent(self.gait, side)[mask]
        return [p for p, (low, high) in PHASES.items() if ((share >= low) & (share < high)).any()]

    def facts(self) -> dict[str, Any]:
        """The verdict as plain values for JSON."""
        least = int(self.nearest.distance.argmin())
        return {
            "device": self.robot.name,
            "ok": self.ok,
            "joints": {d.joint: _demand(d) for d in self.joints},
            "clearance_mm": 1e3 * float(self.nearest.distance[least]),
            "clearance_between": self.nearest.pairs[least],
            "reach_to_spare_mm": {side: 1e3 * slack for side, slack in self.reach.items()},
            "failures": [
                {"what": name, "how": how, "samples": int(mask.sum()), "phases": self.phases(mask, name)}
                for name, how, mask in self.failures
            ],
            "dropped_deg": {joint: float(np.degrees(x)) for joint, x in self.dropped.items()},
            "largest_cadence_factor": self.cadence,
            "largest_amplitude_factor": self.amplitude,
        }


def feasible(
    gait: Gait,
    device: str | Device = "exo12",
    body: Body | None = None,
    *,
    acceleration: float = ACCELERATION,
    gap: float = 0.0,
) -> Feasibility:
    """Whether a device can do a walk with a person, the pelvis moving as recorded.

    Args:
        gait: The walk. A recording's accelerations carry its noise: filter it first.
        device: Name, file or record.
        body: Who wears it; `Body.from_stature()` if left out.
        acceleration: Largest acceleration of every joint [rad/s^2].
        gap: Distance that parts of the device must keep [m].

    Raises:
        UnknownNameError: The device is unknown.
    """
    robot = load_robot(body, device=device)
    full = np.array(gait.q)
    done = dataclasses.replace(robot.to_gait(robot.from_gait(gait), gait), base=gait.base)
    if not done.events:
        done = _with_events(robot, done)
    asked = demands(robot, done, acceleration=acceleration)
    locked = [k for k, joint in enumerate(JOINTS) if joint not in robot.joints]
    return Feasibility(
        robot=robot,
        gait=done,
        joints=tuple(asked),
        nearest=nearest(robot, robot.from_gait(done)),
        gap=gap,
        reach={side: _reach(robot, done, side) for side in SIDES},
        dropped={JOINTS[k]: float(np.abs(full[:, k]).max()) for k in locked},
        cadence=min(FASTEST, *(demand.cadence for demand in asked)),
        amplitude=_amplitude(robot, done, asked, gap),
    )


def scaled(gait: Gait, factor: float) -> Gait:
    """The walk with every joint's movement about its mean made larger or smaller."""
    middle = gait.q.mean(axis=0)
    return dataclasses.replace(gait, q=middle + factor * (gait.q - middle))


def _amplitude(robot: Robot, gait: Gait, asked: list[JointDemand], gap: float) -> float:
    """The limits are linear in the factor; of the collisions it is assumed that more movement is no safer."""
    high = min(MOST, *(demand.amplitude for demand in asked))
    if _apart(robot, gait, high, gap):
        return high
    if not _apart(robot, gait, 0.0, gap):
        return 0.0
    low = 0.0
    for _ in range(_STEPS):
        middle = (low + high) / 2
        low, high = (middle, high) if _apart(robot, gait, middle, gap) else (low, middle)
    return low


def _apart(robot: Robot, gait: Gait, factor: float, gap: float) -> bool:
    q = robot.from_gait(scaled(gait, factor))
    return bool((nearest(robot, q).distance >= gap).all())


def _reach(robot: Robot, gait: Gait, side: str) -> float:
    """What the straightest knee reaches from hip to ankle, less what is asked, least over the walk [m]."""
    assert robot.body is not None  # load_robot made it
    leg, name = robot.body.leg(side), f"{side}_knee_flexion"
    straightest = 0.0
    if name in robot.joints:
        k = robot.joints.index(name)
        straightest = float(np.clip(0.0, robot.lower[k], robot.upper[k]))
    knee = np.append(gait.q[:, JOINTS.index(name)], straightest)
    length = np.sqrt(leg.thigh**2 + leg.shank**2 + 2 * leg.thigh * leg.shank * np.cos(knee))
    return float((length[-1] - length[:-1]).min())


def _with_events(robot: Robot, gait: Gait) -> Gait:
    try:
        return dataclasses.replace(gait, events=events(robot, gait))
    except GaitError:  # no cycles in it: phases are then unknown
        return gait


def _demand(demand: JointDemand) -> dict[str, Any]:
    degrees = {
        "min_deg": demand.q.min(),
        "max_deg": demand.q.max(),
        "lower_deg": demand.lower,
        "upper_deg": demand.upper,
        "margin_deg": demand.margin,
    }
    return {name: float(np.degrees(x)) for name, x in degrees.items()} | {
        "speed_use": demand.speed_use,
        "acceleration_use": demand.acceleration_use,
        "ok": demand.ok,
    }
