"""The verdict over one walk on one device: what fails, where, and how much of the walk is possible."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import Any

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.arrays import Mask
from exo_pin.demand import ROUNDING, JointDemand
from exo_pin.devices import SLIDES
from exo_pin.feasible.collision import Nearest
from exo_pin.feasible.device_fit import Fit
from exo_pin.gait import Gait
from exo_pin.gait.curves import runs
from exo_pin.gait.phases import PHASES, percent
from exo_pin.robot import Robot

FASTEST = 10.0
"""Cadences are sought up to this factor."""


@dataclass(frozen=True, eq=False)
class Feasibility:
    """Whether a device can do a walk.

    Attributes:
        robot: The device on the body.
        gait: The walk as the device does it: locked joints at zero.
        joints: What each joint of the device is asked.
        nearest: Distance between its parts.
        gap: Distance that the parts must keep [m].
        fits: What the device's record says about its belt's speed and the person's stature.
        reach: By side: least reach to spare between hip and ankle [m]; negative: too far by that much.
        dropped: By locked joint: the largest angle that the walk asks of it [rad]; and what the pelvis does
            and the device does not let it (`pelvis.dropped`) [m, rad]. It does not enter the verdict
            (`exo_pin.compare` says what it costs).
        cadence: Largest factor on the speed of the whole walk that speeds and accelerations allow; at most
            `FASTEST`; no cadence helps where something else fails (`cadence_decides`).
        amplitude: Largest factor on every joint's movement about its mean that the limits and the gap allow,
            at the walk's own cadence; at most `MOST`; 0 where not even the mean posture is possible.
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
            and min(self.reach.values()) >= -ROUNDING
            and all(fit.ok for fit in self.fits)
        )

    @property
    def cadence_decides(self) -> bool:
        """Whether speeds and accelerations are all that may fail: ranges and gaps know no cadence."""
        return not (
            any((demand.outside | demand.too_strong).any() for demand in self.joints)
            or self.colliding.any()
            or min(self.reach.values()) < -ROUNDING
            or any(fit.what == "person" and not fit.ok for fit in self.fits)
        )

    @property
    def amplitude_decides(self) -> bool:
        """Whether the amplitude helps: torques at another one are not known, and people keep their size."""
        return not (
            any(demand.too_strong.any() for demand in self.joints)
            or any(fit.what == "person" and not fit.ok for fit in self.fits)
        )

    @property
    def failures(self) -> list[tuple[str, str, Mask]]:
        """What fails: the joint or pair of parts, how, and at which samples (n,)."""
        kinds = (
            ("outside", "outside its range"),
            ("too_fast", "too fast"),
            ("too_hard", "accelerated too hard"),
            ("too_strong", "too much torque"),
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
        always = np.ones(len(self.gait), dtype=bool)
        found += [(fit.what, fit.how, always) for fit in self.fits if not fit.ok]
        short = (side for side, slack in self.reach.items() if slack < -ROUNDING)
        return found + [(f"{side} leg", "out of reach", always) for side in short]

    def phases(self, mask: Mask, name: str) -> list[str]:
        """Phases of the cycle in which marked samples lie: of the foot on the joint's side, else the left."""
        side = next((s for s in SIDES if name.startswith(s)), SIDES[0])
        share = percent(self.gait, side)[mask]
        return [p for p, (low, high) in PHASES.items() if ((share >= low) & (share < high)).any()]

    @property
    def conditions(self) -> tuple[str, ...]:
        """What the verdict takes for granted, in sentences."""
        known = any(demand.torque_use is not None for demand in self.joints)
        torques = "torques as given" if known else "torques are not asked"
        plain = f"the joints copy the walk, locked and passive ones at zero; {torques}"
        return (plain, *(() if self.robot.device is None else self.robot.device.remarks))

    def facts(self) -> dict[str, Any]:
        """The verdict as plain values for JSON."""
        least = int(self.nearest.distance.argmin())
        return {
            "device": self.robot.name,
            "ok": self.ok,
            "joints": {d.joint: _demand(d) for d in self.joints},
            "clearance_mm": 1e3 * float(self.nearest.distance[least]),
            "clearance_between": self.nearest.pairs[least],
            "fits": [
                {**dataclasses.asdict(fit), "asked": number(fit.asked), "ok": fit.ok} for fit in self.fits
            ],
            "reach_to_spare_mm": {side: 1e3 * slack for side, slack in self.reach.items()},
            "failures": [
                {
                    "what": name,
                    "how": how,
                    "samples": int(mask.sum()),
                    "frames": [(first, stop - 1) for first, stop in runs(mask)],
                    "phases": self.phases(mask, name),
                }
                for name, how, mask in self.failures
            ],
            "dropped_deg": {
                joint: float(np.degrees(x)) for joint, x in self.dropped.items() if joint not in SLIDES
            },
            "dropped_mm": {joint: 1e3 * x for joint, x in self.dropped.items() if joint in SLIDES},
            "conditions": list(self.conditions),
            "largest_cadence_factor": self.cadence if self.cadence_decides else None,
            "largest_amplitude_factor": self.amplitude if self.amplitude_decides else None,
        }


def number(value: float) -> float | None:
    """The value, or None for NaN, which JSON does not know."""
    return None if np.isnan(value) else value


def _demand(demand: JointDemand) -> dict[str, Any]:
    unit, scale = ("mm", 1e3) if demand.slide else ("deg", float(np.degrees(1.0)))
    values = {
        "min": demand.q.min(),
        "max": demand.q.max(),
        "lower": demand.lower,
        "upper": demand.upper,
        "margin": demand.margin,
    }
    return {f"{name}_{unit}": float(scale * x) for name, x in values.items()} | {
        "speed_use": demand.speed_use,
        "acceleration_use": demand.acceleration_use,
        "torque_use": demand.torque_use,
        "ok": demand.ok,
    }
