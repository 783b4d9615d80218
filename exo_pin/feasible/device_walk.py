"""A device's answer to a walk: verdict, reason, smallest concession, motion and loss, one for every command.

Three grades. The device *fits* where it can copy the walk in the joints that it drives; it fits with a
*concession* where the recorded knee must be held at its stop, or the walk be slower or smaller; else *no*.
Joints that it locks do not enter the verdict: what the feet lose by them stands beside it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from exo_pin import devices
from exo_pin.anatomy import Body
from exo_pin.anatomy.names import ConcessionKind, FitWord, HipOrder, KneeRule, PelvisMotion
from exo_pin.compare import Conditions, Loss, compare
from exo_pin.devices import Device
from exo_pin.feasible.amplitude import with_amplitude
from exo_pin.feasible.assessment import feasible
from exo_pin.feasible.feasibility import Feasibility
from exo_pin.feasible.knee_stop import HeldKnees, bent, held_at_stop
from exo_pin.gait import Gait, Torques
from exo_pin.robot import Robot, load_robot

LEAST_SHARE = 0.5
"""Less than this share of the recorded cadence or amplitude is no concession but another walk (a choice)."""

_HUNDREDTHS = 100


@dataclass(frozen=True)
class Concession:
    """What the walk must give up so that the device can do it.

    Attributes:
        what: The kind.
        how_much: Largest distance of a foot [mm], or the factor on cadence or amplitude.
        unit: `"mm"` or `"times"`.
        note: Feet and frames, or the reason.
    """

    what: ConcessionKind
    how_much: float
    unit: str
    note: str

    @property
    def words(self) -> str:
        """The concession in words, with its reason."""
        if self.what == "knee held at its stop":
            return f"{self.what}: {self.note}"
        return f"{self.what} {self.how_much:.2f} ({self.note})"

    def facts(self) -> dict[str, Any]:
        """Plain values for JSON."""
        return {"what": self.what, "how_much": self.how_much, "unit": self.unit}


@dataclass(frozen=True, eq=False)
class DeviceWalk:
    """A device's answer to a walk.

    Attributes:
        device: The device.
        recorded: The walk as given.
        gait: The walk after all concessions; where the verdict is no, the walk as given.
        as_recorded: Assessment of the walk as given.
        verdict: The grade.
        concessions: In the order in which they were made; the last one decides.
        conditions: Who moves the pelvis.
    """

    device: Device
    recorded: Gait
    gait: Gait
    as_recorded: Feasibility
    verdict: FitWord
    concessions: tuple[Concession, ...]
    conditions: Conditions

    @property
    def ok(self) -> bool:
        """Whether the device fits, with or without a concession."""
        return self.verdict != "no"

    @property
    def concession(self) -> Concession | None:
        """The one that decides; None where the device fits as it is, or not at all."""
        return self.concessions[-1] if self.concessions else None

    @cached_property
    def loss(self) -> Loss:
        """The device's best motion towards the feet of `gait`, and what it misses."""
        body = self.as_recorded.robot.body
        return compare(self.gait, [self.device], body, conditions=self.conditions).best[0]

    @property
    def reason(self) -> str:
        """Why the verdict is what it is, in words."""
        if self.verdict == "no":
            return "; ".join(map(self.as_recorded.words, self.as_recorded.failures))
        if self.concessions:
            return "; ".join(concession.words for concession in self.concessions)
        return "every joint that it drives keeps its limits"

    @property
    def title(self) -> str:
        """What people call the device."""
        return self.device.title or self.device.name

    @property
    def sentence(self) -> str:
        """Verdict and reason."""
        words = {"fits": "fits", "concession": "fits with a concession", "no": "does not fit"}
        return f"{self.title} {words[self.verdict]}: {self.reason}"

    @property
    def loss_sentence(self) -> str:
        """What the soles lose, and who moves the pelvis."""
        pelvis = {
            "recorded": "the pelvis moving as recorded",
            "device": "the pelvis as the device holds it",
        }["recorded" if self.device.pelvis == "free" else self.conditions.pelvis]
        rms, most = 1e3 * self.loss.rms, 1e3 * self.loss.sole_spread.max
        walk = "those of the walk with its concession" if self.concessions else "the recorded ones"
        return (
            f"{self.title} ({self.device.motors} motors), {pelvis}: the soles miss {walk} by {rms:.1f} mm "
            f"rms, {most:.1f} mm at most."
        )

    def facts(self) -> dict[str, Any]:
        """Plain values for JSON."""
        first = self.concession
        return {
            "verdict": self.verdict,
            "reason": self.reason,
            "concession": None if first is None else first.facts(),
            "concessions": [concession.facts() for concession in self.concessions],
            "pelvis": self.conditions.pelvis,
            "sole_rms_mm": 1e3 * self.loss.rms,
            "sole_max_mm": 1e3 * self.loss.sole_spread.max,
        }


def pelvis_by_default(device: Device) -> PelvisMotion:
    """A device whose stand has slides holds the pelvis itself; any other goes along with the recorded one."""
    return "device" if device.slides else "recorded"


def device_walk(
    gait: Gait,
    device: str | Device = "exo12",
    body: Body | None = None,
    *,
    pelvis: PelvisMotion | None = None,
    knee: KneeRule = "stop",
    acceleration: float | None = None,
    gap: float = 0.0,
    torques: Torques | None = None,
    hip_order: HipOrder = "clinical",
) -> DeviceWalk:
    """A device's answer to a walk.

    Args:
        gait: The walk. The accelerations of a recording carry its noise: filter it first.
        device: Name, file or record.
        body: Who wears it; `Body.from_stature()` if left out.
        pelvis: Who moves the pelvis; `pelvis_by_default` if left out.
        knee: What becomes of a recorded knee beyond its stop.
        acceleration: Largest acceleration of every joint [rad/s^2]; the device's own if left out.
        gap: Distance that parts of the device must keep [m].
        torques: Joint torques of the walk; not checked if left out, nor at another cadence or amplitude.
        hip_order: Order of the hip axes, which have the limits.

    Raises:
        UnknownNameError: The device is unknown.
        GaitError: The torques are at other times than the walk.
    """
    device = devices.find(device)
    conditions = Conditions(pelvis or pelvis_by_default(device))

    def assessed(walk: Gait, tau: Torques | None) -> Feasibility:
        return feasible(
            walk, device, body, acceleration=acceleration, gap=gap, torques=tau, hip_order=hip_order
        )

    full = load_robot(body)
    start = bent(full, gait) if knee == "bend" and _hyperextends(full, gait) else gait
    first = assessed(start, torques)
    held = held_at_stop(full, first.robot, start) if knee == "stop" else None
    made = () if held is None else (_knee(held),)
    walk = start if held is None else held.gait
    found = first if held is None else assessed(walk, torques)
    if found.failures:
        tried = (pair for pair in _other_walks(walk, found) if not assessed(pair[1], None).failures)
        concession, walk = next(tried, (None, start))
        made = () if concession is None else (*made, concession)
        verdict: FitWord = "no" if concession is None else "concession"
    else:
        verdict = "concession" if made else "fits"
    return DeviceWalk(device, gait, walk, first, verdict, made, conditions)


def _hyperextends(robot: Robot, gait: Gait) -> bool:
    return held_at_stop(robot, robot, gait) is not None


def _knee(held: HeldKnees) -> Concession:
    return Concession("knee held at its stop", 1e3 * float(held.moved.max()), "mm", held.words)


def _other_walks(gait: Gait, found: Feasibility) -> list[tuple[Concession, Gait]]:
    """Slower and smaller walks that the limits allow, the one nearest to the walk first."""
    why = "; ".join(dict.fromkeys(f"{failure.what}: {failure.how}" for failure in found.failures))
    cadence = _floor(found.cadence) if found.cadence_decides else 0.0
    amplitude = _floor(found.amplitude) if found.amplitude_decides else 0.0
    slower = (Concession("cadence", cadence, "times", why), gait.slowed(1.0 / max(cadence, LEAST_SHARE)))
    smaller = (Concession("amplitude", amplitude, "times", why), with_amplitude(gait, amplitude))
    nearest_first = sorted((slower, smaller), key=lambda pair: -pair[0].how_much)
    return [pair for pair in nearest_first if LEAST_SHARE <= pair[0].how_much < 1.0]


def _floor(factor: float) -> float:
    return math.floor(_HUNDREDTHS * factor) / _HUNDREDTHS
