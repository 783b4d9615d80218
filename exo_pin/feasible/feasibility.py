"""The verdict over one walk on one device: every failure, and how much of the walk is possible."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.arguments import real
from exo_pin.arrays import Mask
from exo_pin.demand import JointDemand
from exo_pin.devices import SLIDES
from exo_pin.feasible.collision import Nearest
from exo_pin.feasible.device_fit import Fit, leg_difference
from exo_pin.gait import Gait
from exo_pin.gait.phases import PHASES, percent
from exo_pin.gait.time_series import runs
from exo_pin.robot import Robot
from exo_pin.robot.model import LIMIT_TOLERANCE
from exo_pin.short_repr import short_repr

LARGEST_CADENCE = 10.0
"""Factors on the cadence end here."""


class Failure(NamedTuple):
    """One reason why a walk is not possible.

    Attributes:
        what: The joint, the pair of parts, the leg, or what does not fit.
        how: The failure in words.
        samples: Samples (n,) at which it occurs.
    """

    what: str
    how: str
    samples: Mask

    def __repr__(self) -> str:
        return short_repr(self)

    @property
    def frames(self) -> list[tuple[int, int]]:
        """First and last sample of each run of failing samples."""
        return [(first, stop - 1) for first, stop in runs(self.samples)]


@dataclass(frozen=True, eq=False)
class Feasibility:
    """Whether a device can do a walk.

    Attributes:
        robot: The device on the body.
        gait: The walk on the device, locked joints at zero.
        joints: The demand on each joint of the device.
        nearest: Distance between its parts.
        gap: Distance that the parts must keep [m].
        fits: Treadmill speed and stature against the device's record.
        reach: By side, the smallest remaining reach from hip to ankle [m]; negative: out of reach.
        dropped: By locked joint, its largest angle in the walk [rad]; and the pelvis's motion that the device
            blocks (`blocked_motion`) [m, rad]. These do not enter the verdict: `exo_pin.compare` quantifies
            their loss.
        cadence: Largest factor on the walk's cadence that the limits on speed and acceleration allow, at most
            `LARGEST_CADENCE`. It is meaningful only where nothing else fails (`cadence_decides`).
        amplitude: Largest factor on every joint's movement about its mean that limits and gap allow at the
            walk's own cadence, at most `LARGEST_AMPLITUDE`; 0 where even the mean posture is impossible.
    """

    robot: Robot
    gait: Gait
    joints: tuple[JointDemand, ...]
    nearest: Nearest
    gap: float
    fits: tuple[Fit, ...]
    reach: dict[str, float]
    dropped: dict[str, float]
    cadence: float
    amplitude: float

    __repr__ = short_repr

    @property
    def colliding(self) -> Mask:
        """Samples (n,) at which parts come closer than the gap."""
        return self.nearest.distance < self.gap

    @property
    def clearance(self) -> float:
        """Smallest distance between parts of the device over the walk [m]."""
        return float(self.nearest.distance.min())

    @property
    def closest_parts(self) -> tuple[str, str]:
        """Links of the two parts that come closest."""
        return self.nearest.pairs[int(self.nearest.distance.argmin())]

    @property
    def ok(self) -> bool:
        """Whether joints keep their limits, parts do not collide, the person fits, and feet are in reach."""
        return not self.failures

    @property
    def person_fits(self) -> bool:
        """Whether the device takes a person of these sizes and this mass."""
        return all(fit.ok for fit in self.fits if fit.what == "person")

    @property
    def cadence_decides(self) -> bool:
        """Whether only failures that depend on the cadence remain: speeds, accelerations, the treadmill."""
        return not (
            any(demand.position.outside.any() or _too_strong(demand).any() for demand in self.joints)
            or self.colliding.any()
            or self._out_of_reach
            or not self.person_fits
        )

    @property
    def amplitude_decides(self) -> bool:
        """Whether another amplitude can help: not with the stature, nor with torques (unknown then)."""
        too_strong = any(_too_strong(demand).any() for demand in self.joints)
        return not (too_strong or not self.person_fits)

    @property
    def failures(self) -> list[Failure]:
        """Every reason why the walk is not possible."""
        found = [failure for demand in self.joints for failure in _joint_failures(demand)]
        if self.colliding.any():
            found.append(Failure(" and ".join(self.closest_parts), "too near", self.colliding))
        always = np.ones(len(self.gait), dtype=bool)
        found += [Failure(fit.what, fit.how, always) for fit in self.fits if not fit.ok]
        return found + [Failure(f"{side} leg", "out of reach", always) for side in self._out_of_reach]

    def phases(self, mask: Mask, name: str) -> list[str]:
        """Phases of the gait cycle that hold marked samples.

        Args:
            mask: Marked samples (n,).
            name: A joint or part; the cycle is that of the foot on its side, of the left foot if it has none.

        Raises:
            DescriptionError: The shape of the mask does not fit the walk.
        """
        mask = real("mask", mask, (len(self.gait),)) != 0.0
        side = next((s for s in SIDES if name.startswith(s)), SIDES[0])
        share = percent(self.gait, side)[mask]
        return [p for p, (low, high) in PHASES.items() if ((share >= low) & (share < high)).any()]

    def words(self, failure: Failure) -> str:
        """A failure in words: what, how far, in how many samples and in which phases of the cycle."""
        if failure.what in ("treadmill", "person"):
            return f"{failure.what}: {failure.how}"
        frames = ", ".join(f"{a}" if a == b else f"{a}-{b}" for a, b in failure.frames)
        phases = self.phases(failure.samples, failure.what)
        where = f"; {', '.join(phases)}" if phases else ""
        count = int(failure.samples.sum())
        return f"{failure.what}: {failure.how} ({self.excess(failure)}) in {count} frames ({frames}{where})"

    def excess(self, failure: Failure) -> str:
        """How far a failure is beyond its limit, in words."""
        for demand in self.joints:
            if demand.joint == failure.what:
                return _excess(demand, failure.how)
        for side, slack in self.reach.items():
            if failure.what == f"{side} leg":
                return f"by {-1e3 * slack:.1f} mm"
        return f"by {1e3 * (self.gap - self.clearance):.1f} mm"

    @property
    def conditions(self) -> tuple[str, ...]:
        """Assumptions of the verdict, in sentences."""
        known = any(demand.torque is not None for demand in self.joints)
        torques = "torques as given" if known else "torques are not checked"
        assumed = f"the joints copy the walk, locked and passive ones at zero; {torques}"
        uneven = leg_difference(self.robot.body)
        remarks = () if self.robot.device is None else self.robot.device.remarks
        return (assumed, *(() if uneven is None else (uneven,)), *remarks)

    def facts(self) -> dict[str, Any]:
        """The verdict as plain values for JSON."""
        return {
            "device": self.robot.name,
            "ok": self.ok,
            "joints": {demand.joint: _demand_facts(demand) for demand in self.joints},
            "clearance_mm": 1e3 * self.clearance,
            "clearance_between": self.closest_parts,
            "fits": [fit.facts() for fit in self.fits],
            "reach_to_spare_mm": {side: 1e3 * slack for side, slack in self.reach.items()},
            "failures": [
                {
                    "what": failure.what,
                    "how": failure.how,
                    "samples": int(failure.samples.sum()),
                    "frames": failure.frames,
                    "phases": self.phases(failure.samples, failure.what),
                }
                for failure in self.failures
            ],
            "dropped_deg": {
                joint: float(np.degrees(x)) for joint, x in self.dropped.items() if joint not in SLIDES
            },
            "dropped_mm": {joint: 1e3 * x for joint, x in self.dropped.items() if joint in SLIDES},
            "conditions": list(self.conditions),
            "largest_cadence_factor": self.cadence if self.cadence_decides else None,
            "largest_amplitude_factor": self.amplitude if self.amplitude_decides else None,
        }

    @property
    def _out_of_reach(self) -> list[str]:
        return [side for side, slack in self.reach.items() if slack < -LIMIT_TOLERANCE]


def _too_strong(demand: JointDemand) -> Mask:
    if demand.torque is None:
        return np.zeros(len(demand.position.required), dtype=bool)
    return demand.torque.exceeded


def _excess(demand: JointDemand, how: str) -> str:
    """How far a joint is beyond one of its limits."""
    slides, degree = demand.prismatic, float(np.degrees(1.0))
    if how == "outside its range":
        scale, unit = (1e3, "mm") if slides else (degree, "deg")
        return f"by {-scale * demand.position.margin:.1f} {unit}"
    peak, unit = demand.speed, "m/s" if slides else "rad/s"
    if how == "accelerated too hard":
        peak, unit = demand.acceleration, f"{unit}^2"
    elif how == "too much torque" and demand.torque is not None:
        peak, unit = demand.torque, "N" if slides else "N m"
    return f"{peak.peak:.4g} of {peak.available:.4g} {unit}"


def _joint_failures(demand: JointDemand) -> Iterator[Failure]:
    kinds = (
        ("outside its range", demand.position.outside),
        ("too fast", demand.speed.exceeded),
        ("accelerated too hard", demand.acceleration.exceeded),
        ("too much torque", _too_strong(demand)),
    )
    yield from (Failure(demand.joint, how, samples) for how, samples in kinds if samples.any())


def _demand_facts(demand: JointDemand) -> dict[str, Any]:
    unit, scale = ("mm", 1e3) if demand.prismatic else ("deg", float(np.degrees(1.0)))
    position = demand.position
    values = {
        "min": position.lowest,
        "max": position.highest,
        "lower": position.available[0],
        "upper": position.available[1],
        "margin": position.margin,
    }
    return {f"{name}_{unit}": scale * x for name, x in values.items()} | {
        "speed_use": demand.speed.use,
        "acceleration_use": demand.acceleration.use,
        "torque_use": None if demand.torque is None else demand.torque.use,
        "ok": demand.ok,
    }
