"""Checks of candidate strides: whether the span between two heel strikes of a foot is a stride of a walk."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.names import Side
from exo_pin.arrays import Array
from exo_pin.gait.event import EVENT_KINDS, FOOT_FLAT, Event, between

_LEAST_STEP = 0.15
"""The other foot strikes at least this part of the stride after and before this one: limps reach 0.3."""

_STRIKE_HEIGHT = (0.4, 0.05)
"""A foot strikes the ground no higher above its resting height than this part of its swing's height, and
this [m]."""

_STANCE_ABOVE_SWING = 0.01
"""A foot may be higher in stance than in swing by as much [m]: averaged walks drag their feet."""

_FLAT_RANGE = 0.06
"""A foot at rest moves up and down by less [m]; over a pelvis that is held still the ground does by 4 cm."""

_SHORTEST_STRIDE = 0.10
"""A shorter stride over the ground [m] is stepping on the spot."""

QUICKEST_STRIDE = 0.4
"""No stride of a person is quicker [s]: 300 steps/min."""

_EARLY_TOE_OFF = 0.2
"""The other foot may leave the ground this part of the stride before this one strikes: Zeni's method errs."""

LONGEST_FLIGHT = 0.45
"""The same in runs: a sprinter flies for 0.25 of the stride."""


class Feet(NamedTuple):
    """Both feet, left and right, and the pelvis over the ground, z up.

    Attributes:
        time: `(n,)` [s].
        heel: `(n, 2, 3)` [m]. Where the pelvis's tilt is unknown, minus the length of the leg serves as z:
            see `exo_pin.kinematics.events`.
        toe: `(n, 2, 3)` balls of the feet, or toes [m].
        pelvis: `(n, 2)` [m].
        heading: `(n, 2)` unit vectors: the pelvis's heading.
    """

    time: Array
    heel: Array
    toe: Array
    pelvis: Array
    heading: Array

    def ahead(self, part: Array) -> Array:
        """`(n, 2)` how far a part of each foot is ahead of the pelvis [m]."""
        return np.asarray(np.einsum("nfk,nk->nf", part[..., :2] - self.pelvis[:, None], self.heading))


class CandidateStride(NamedTuple):
    """The span between two heel strikes of a foot.

    Attributes:
        side: Whose.
        strike: Heel strike [s].
        off: Toe-off [s]; the heel strike where there is not exactly one.
        end: Next heel strike [s].
        why: Why it is no stride; empty where it is.
    """

    side: Side
    strike: float
    off: float
    end: float
    why: str


def candidate_strides(
    feet: Feet, first: Array, events: list[Event], side: Side, *, early: float = _EARLY_TOE_OFF
) -> list[CandidateStride]:
    """Every span between two strikes of a foot, with the objection to it.

    Args:
        feet: The motion of both feet and the pelvis, n samples.
        first: `(n, 2, 3)` the part of each foot that lands first, heel or toe [m].
        events: Heel strikes and toe-offs of both feet, sorted by time.
        side: Whose strides.
        early: The other foot may leave the ground this part of the stride before this one strikes.
    """
    mine: dict[str, list[float]] = {kind: [] for kind in EVENT_KINDS}
    other: dict[str, list[float]] = {kind: [] for kind in EVENT_KINDS}
    for event in events:
        (mine if event.side == side else other)[event.kind].append(event.time)
    found = []
    for a, b in pairwise(mine["heel_strike"]):
        offs = between(mine["toe_off"], a, b)
        why = "heel strikes and toe-offs of one foot do not take turns" if len(offs) != 1 else ""
        why = why or _order_objection(other, a, b, early)
        why = why or _path_objection(feet, first, SIDES.index(side), (a, offs[0], b))
        found.append(CandidateStride(side, a, offs[0] if offs else a, b, why))
    return found


def consistent(candidates: list[CandidateStride]) -> list[CandidateStride]:
    """The candidates of both feet; one that holds an end of a refused one of the other foot is refused."""
    objections: dict[str, dict[float, str]] = {side: {} for side in SIDES}
    for stride in candidates:
        for t in (stride.strike, stride.end):
            objections[stride.side][t] = stride.why or objections[stride.side].get(t, "")
    times = {side: sorted(known) for side, known in objections.items()}

    def partner(stride: CandidateStride) -> str:
        other = SIDES[1 - SIDES.index(stride.side)]
        inside = between(times[other], stride.strike, stride.end)
        return next(filter(None, (objections[other][t] for t in inside)), "")

    return [stride if stride.why else stride._replace(why=partner(stride)) for stride in candidates]


def _order_objection(other: Mapping[str, Sequence[float]], a: float, b: float, early: float) -> str:
    """The objection to a stride from a to b [s] in the events of the other foot."""
    if b - a < QUICKEST_STRIDE:
        return f"the feet swing to and fro in less than {QUICKEST_STRIDE:g} s: noise?"
    strikes = between(other["heel_strike"], a, b)
    if len(strikes) != 1:
        return "the left and the right foot do not take turns"
    if not _LEAST_STEP < (strikes[0] - a) / (b - a) < 1 - _LEAST_STEP:
        return "both feet move forward together; in a walk they take turns"
    if not between(other["toe_off"], a - early * (b - a), strikes[0]):
        return "one foot does not leave the ground while the other one stands"
    return ""


def _path_objection(feet: Feet, first: Array, k: int, moments: tuple[float, float, float]) -> str:
    """The objection in the path of foot k to a stride with these strike, toe-off and next strike [s]."""
    strike, off, end = moments
    begin, stop = np.searchsorted(feet.time, [strike, end])
    rows = slice(max(begin - 1, 0), stop + 1)  # long recordings have thousands of strides
    first, feet = first[rows], Feet(*(part[rows] for part in feet))
    high = strike_in_the_air(feet, first[:, k, 2], strike, off, end)
    if high:
        return high
    sole = np.minimum(feet.heel[:, k, 2], feet.toe[:, k, 2])
    stance, swing = (_mean(feet.time, sole, a, b) for a, b in ((strike, off), (off, end)))
    if stance > swing + _STANCE_ABOVE_SWING:
        return "the feet are higher in stance than in swing"
    a, b = (strike + part * (off - strike) for part in FOOT_FLAT)
    resting = np.interp(np.linspace(a, b, 20), feet.time, sole)
    if np.ptp(resting) > _FLAT_RANGE:
        return "the feet go up and down where they should rest on the ground: cycling?"
    path = np.stack(
        [np.interp([strike, end, a, b], feet.time, first[:, k, axis]) for axis in range(2)], axis=1
    )
    ground = (path[3] - path[2]) / (b - a)
    length = float(np.linalg.norm(path[1] - path[0] - ground * (end - strike)))
    if length < _SHORTEST_STRIDE:
        return f"the feet do not get along: stepping on the spot; strides of less than {_SHORTEST_STRIDE:g} m"
    return ""


def strike_in_the_air(feet: Feet, height: Array, strike: float, off: float, end: float) -> str:
    """The objection to a strike at which the foot is too high to meet the ground; empty for none.

    Args:
        feet: The motion, n samples.
        height: `(n,)` of the part of the foot that lands first [m].
        strike: Heel strike [s].
        off: Toe-off [s].
        end: End of the swing [s].
    """
    rest = _mean(feet.time, height, *(strike + part * (off - strike) for part in FOOT_FLAT))
    swing = height[(feet.time >= off) & (feet.time <= end)]
    lift = float(swing.max()) - rest if len(swing) else 0.0
    above = float(np.interp(strike, feet.time, height)) - rest
    if above <= _STRIKE_HEIGHT[0] * max(lift, 0.0) + _STRIKE_HEIGHT[1]:
        return ""
    return "the feet are furthest ahead in the air, not on the ground: marching on the spot, or cycling?"


def _mean(time: Array, y: Array, start: float, end: float) -> float:
    """Mean of a curve over a span of time."""
    t = np.linspace(start, end, 20)
    return float(np.interp(t, time, y).mean())
