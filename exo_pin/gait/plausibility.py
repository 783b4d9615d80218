"""Plausibility of a walk: one word and the reasons against it; signs, presets and units probably mistaken."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from exo_pin.anatomy import JOINTS, SIDES
from exo_pin.anatomy.human import EXTREME_RANGES, HYPEREXTENDED_KNEE
from exo_pin.anatomy.names import PlausibilityWord, Side
from exo_pin.arrays import Array
from exo_pin.gait.gait import Gait

_LONG_SHARE = 0.3
"""Part of the samples that is a long time."""

_LEAST_MOTION = np.radians(3.0)
"""In a walk some joint moves more than this [rad]; less is standing, or degrees converted twice."""

_LONGEST_SAMPLE_STEP = 0.2
"""No recording of a walk has its samples further apart than this [s]: 5 Hz, a few per step."""


@dataclass(frozen=True)
class Plausibility:
    """The verdict on a walk as it was read, the same in every output.

    Attributes:
        reasons: Each finding that speaks against the walk, with its probable cause; empty where none does.
    """

    reasons: tuple[str, ...] = ()

    @property
    def word(self) -> PlausibilityWord:
        """`"plausible"`, or `"doubtful"` where there is a reason."""
        return "doubtful" if self.reasons else "plausible"

    def __str__(self) -> str:
        """The word, and after a colon the reasons."""
        return ": ".join(filter(None, (self.word, "; ".join(self.reasons))))

    def with_reasons(self, more: Iterable[str]) -> Plausibility:
        """The verdict with further reasons; one that is known already is not repeated."""
        return replace(self, reasons=tuple(dict.fromkeys((*self.reasons, *more))))

    def facts(self) -> dict[str, Any]:
        """For JSON."""
        return {"word": self.word, "reasons": list(self.reasons)}


def implausibilities(gait: Gait) -> tuple[str, ...]:
    """What is implausible about the signs, units and times of a walk; nothing for a usual walk.

    Each text names the finding, the part of the walk that has it, and the probable mistake.
    """
    reasons = [_backwards(gait.q, side) for side in SIDES]
    if np.ptp(gait.q, axis=0).max() < _LEAST_MOTION:
        moved = np.degrees(np.ptp(gait.q, axis=0).max())
        reasons.append(f"no joint moves more than {moved:.1f} deg: standing, or units?")
    reasons += [_impossible(gait.q[:, k], joint) for k, joint in enumerate(JOINTS)]
    reasons += [_swing(gait.q), _sparse(gait.time)]
    return tuple(reason for reason in reasons if reason)


def _sparse(time: Array) -> str:
    apart = float(np.median(np.diff(time)))
    return f"samples are {apart:.3g} s apart: is the time in seconds?" if apart > _LONGEST_SAMPLE_STEP else ""


def _backwards(q: Array, side: Side) -> str:
    knee = q[:, JOINTS.index(f"{side}_knee_flexion")]
    share = float((knee < HYPEREXTENDED_KNEE).mean())
    if share < _LONG_SHARE:
        return ""
    return f"{side} knee bends backwards for {100 * share:.0f} % of the cycle: sign or preset?"


def _impossible(angle: Array, joint: str) -> str:
    low, high = EXTREME_RANGES[joint]
    share = float(((angle < low) | (angle > high)).mean())
    if not share:
        return ""
    span = f"{np.degrees(angle.min()):.0f} .. {np.degrees(angle.max()):.0f} deg"
    return f"{joint} is beyond human range for {100 * share:.0f} % of the cycle ({span}): sign or units?"


def _swing(q: Array) -> str:
    """In a walk the hip flexes while the knee does: the swing. Both sides against it means a hip's sign."""
    against = []
    for side in SIDES:
        hip, knee = (q[:, JOINTS.index(f"{side}_{movement}")] for movement in ("hip_flexion", "knee_flexion"))
        if np.ptp(knee) < np.radians(30) or np.ptp(hip) < np.radians(15):
            return ""
        bent = knee >= np.percentile(knee, 85)
        rate = np.gradient(hip)
        against.append(float(rate[bent].mean()) < 0 and float((rate[bent] < 0).mean()) > 0.8)
    if not all(against):
        return ""
    return "both hips extend while the knee is bent most (swing): sign of the hip, or a walk backwards?"
