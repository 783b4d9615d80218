"""A device's answer to a walk: verdict, reason, concessions, motion, loss and belt, one for every command."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

from exo_pin.anatomy.names import FitWord
from exo_pin.compare import Conditions, Loss, compare
from exo_pin.devices import Device
from exo_pin.feasible.concession import Concession
from exo_pin.feasible.feasibility import Feasibility
from exo_pin.gait import Gait
from exo_pin.ground import belt_speed
from exo_pin.short_repr import short_repr

_BELT = 0.005
"""A belt that is beyond the device's speeds by less than this is not [m/s]: rounding of two decimals."""


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

    __repr__ = short_repr

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

    @cached_property
    def belt(self) -> float | None:
        """Speed of the treadmill under the device's motion [m/s]; None without one, or where it stands."""
        motion = self.loss.motion
        if self.device.treadmill is None or motion.gait.base is None:
            return None
        corners = motion.corners.reshape(len(motion.gait), -1, 3)
        return belt_speed(motion.gait, motion.gait.base, corners) or None

    @property
    def belt_warning(self) -> str:
        """What is wrong with the speed of the treadmill, in words; empty where nothing is."""
        if self.belt is None or self.device.treadmill is None:
            return ""
        slowest, fastest = self.device.treadmill
        if slowest - _BELT <= self.belt <= fastest + _BELT:
            return ""
        return (
            f"Warning: the belt runs at {self.belt:.2f} m/s here; {self.title}'s runs at {slowest:.2f} to "
            f"{fastest:.2f} m/s."
        )

    @property
    def largest_cadence(self) -> float | None:
        """Largest factor on the recorded cadence: of joints, treadmill and the device's own motion over it.

        The one of the concession where that is the cadence; None where another cadence does not help.
        """
        slower = next((made.how_much for made in self.concessions if made.what == "cadence"), None)
        if slower is not None or not self.as_recorded.cadence_decides:
            return slower
        if self.verdict == "no" or self.belt is None or self.device.treadmill is None:
            return self.as_recorded.cadence
        return max(1.0, min(self.as_recorded.cadence, self.device.treadmill[1] / self.belt))

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
            "belt_m_s": self.belt,
        }
