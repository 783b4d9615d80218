"""Phases of the gait cycle of a foot (Perry 1992), from its heel strikes and toe-offs."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import Literal, NamedTuple

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.names import Side
from exo_pin.arrays import Array, Mask
from exo_pin.gait.event import SAME_TIME, WHOLE_STRIDE, Event, stance_shares, whole_stances
from exo_pin.gait.gait import Gait
from exo_pin.gait.half_strides import stride_estimate

PHASES = {
    "loading response": (0.0, 12.0),
    "mid stance": (12.0, 31.0),
    "terminal stance": (31.0, 50.0),
    "pre-swing": (50.0, 62.0),
    "initial swing": (62.0, 75.0),
    "mid swing": (75.0, 87.0),
    "terminal swing": (87.0, 100.0),
}
"""Begin and end in percent of the foot's cycle (Perry 1992, Gait Analysis); its toe-off is at 62."""

PERRY_TOE_OFF = 62.0
"""Toe-off in Perry's division [%]; the walk's own where its events tell."""


class ToeOff(NamedTuple):
    """The usual toe-off of a foot.

    Attributes:
        percent: Of the stride.
        by: What tells it: the walk's strides, an estimated stride, or nothing (assumed).
    """

    percent: float
    by: Literal["events", "estimated stride", "assumed"]


def toe_off(gait: Gait, side: Side) -> ToeOff:
    """Mean toe-off of a foot's whole strides; else its stance in an estimated stride, else Perry's 62 %."""
    shares = stance_shares(_events(gait, side), side)
    if shares:
        return ToeOff(100 * float(np.mean(shares)), "events")
    estimate = stride_estimate(gait, side)
    stances = [end - start for start, end in whole_stances(gait.events, side)]
    if estimate and stances and np.mean(stances) < estimate.duration:
        return ToeOff(100 * float(np.mean(stances)) / estimate.duration, "estimated stride")
    return ToeOff(PERRY_TOE_OFF, "assumed")


def division(gait: Gait) -> str:
    """Where toe-off divides the strides of a walk, in words for people; which foot's is assumed."""
    found = {side: toe_off(gait, side) for side in SIDES}
    return "toe-off at " + ", ".join(f"{x.percent:.0f} % ({side}, {x.by})" for side, x in found.items())


def percent(gait: Gait, side: Side) -> Array:
    """Percent `(n,)` of the foot's stride; NaN where no whole stance, swing or stride surrounds a sample.

    A stance or swing whose stride is not whole in the recording is placed by the usual toe-off (`toe_off`).
    """
    return _placed(gait, side)[0]


def masks(gait: Gait, side: Side) -> dict[str, Mask]:
    """Which samples `(n,)` belong to each phase of a foot; none where events are missing.

    Perry's phases keep their parts of stance and swing; each stride's own toe-off divides the two.
    """
    share, off = _placed(gait, side)
    with np.errstate(invalid="ignore", divide="ignore"):  # NaN belongs to no phase
        swing = PERRY_TOE_OFF + (100 - PERRY_TOE_OFF) * (share - off) / (100 - off)
        stage = np.where(share < off, PERRY_TOE_OFF * share / off, swing)
        return {name: (stage >= low) & (stage < high) for name, (low, high) in PHASES.items()}


def _events(gait: Gait, side: Side) -> list[Event]:
    """The events of a foot, sorted; those of a walk that repeats for three rounds."""
    mine = [event for event in gait.events if event.side == side]
    if gait.periodic:
        rounds = (k * gait.duration for k in (-1, 0, 1))
        mine = [replace(event, time=event.time + shift) for shift in rounds for event in mine]
    return sorted(mine, key=lambda event: event.time)


def _placed(gait: Gait, side: Side) -> tuple[Array, Array]:
    """Percent of the stride, and toe-off of that stride in percent, both `(n,)`."""
    events, usual = _events(gait, side), toe_off(gait, side).percent
    share, offs = (np.full(len(gait), np.nan) for _ in range(2))
    for k, (a, b) in enumerate(pairwise(events)):
        if (a.kind, b.kind) == ("toe_off", "toe_off"):
            continue
        first = k if a.kind == "heel_strike" else k - 1
        around = events[first : first + 3] if first >= 0 else []
        off = usual
        if tuple(event.kind for event in around) == WHOLE_STRIDE:
            off = 100 * (around[1].time - around[0].time) / (around[2].time - around[0].time)
        low = 0.0 if a.kind == "heel_strike" else off
        high = off if b.kind == "toe_off" else 100.0
        inside = (gait.time >= a.time - SAME_TIME) & (gait.time < b.time - SAME_TIME)
        done = (gait.time[inside] - a.time) / (b.time - a.time)
        share[inside] = low + (high - low) * np.clip(done, 0.0, 1.0)
        offs[inside] = off
    return share, offs
