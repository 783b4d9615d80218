"""Checks of candidate strides: whether the span between two heel strikes of a foot is a stride of a walk."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.names import Side
from exo_pin.arrays import Array, Mask
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


IN_THE_AIR = "the feet are furthest ahead in the air, not on the ground: marching on the spot, or cycling?"
_HIGH_STANCE = "the feet are higher in stance than in swing"
_UP_AND_DOWN = "the feet go up and down where they should rest on the ground: cycling?"
_ON_THE_SPOT = f"the feet do not get along: stepping on the spot; strides of less than {_SHORTEST_STRIDE:g} m"
"""Objections to a stride in its path."""


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
        found.append(CandidateStride(side, a, offs[0] if offs else a, b, why))
    in_order = [stride for stride in found if not stride.why]
    whys = iter(_path_objections(feet, first, SIDES.index(side), in_order))
    return [stride if stride.why else stride._replace(why=next(whys)) for stride in found]


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


def _path_objections(feet: Feet, first: Array, k: int, strides: Sequence[CandidateStride]) -> list[str]:
    """The objection in the path of foot k to each stride; empty for none."""
    strike, off, end = np.array([(x.strike, x.off, x.end) for x in strides]).reshape(-1, 3).T
    flat, lift_off = (strike + part * (off - strike) for part in FOOT_FLAT)
    sole = np.minimum(feet.heel[:, k, 2], feet.toe[:, k, 2])
    stance, swing, resting = (
        _along(feet.time, sole, *span) for span in ((strike, off), (off, end), (flat, lift_off))
    )
    places = [
        np.array([np.interp(t, feet.time, first[:, k, axis]) for axis in range(2)])
        for t in (strike, end, flat, lift_off)
    ]
    objections = (
        (IN_THE_AIR, strikes_in_the_air(feet.time, first[:, k, 2], strike, off, end)),
        (_HIGH_STANCE, stance.mean(axis=0) > swing.mean(axis=0) + _STANCE_ABOVE_SWING),
        (_UP_AND_DOWN, np.ptp(resting, axis=0) > _FLAT_RANGE),
        (_ON_THE_SPOT, _lengths(places, (end - strike) / (lift_off - flat)) < _SHORTEST_STRIDE),
    )
    return [next((why for why, holds in objections if holds[i]), "") for i in range(len(strides))]


def _lengths(places: Sequence[Array], times: Array) -> Array:
    """Lengths `(m,)` of strides over the ground, which moves as the resting foot does [m].

    Args:
        places: Of the foot at its strike, its next one, and from where to where it rests, `(2, m)` each [m].
        times: `(m,)` how often the rest would fit into the stride.
    """
    strike, end, flat, lift_off = places
    return np.asarray(np.linalg.norm(end - strike - (lift_off - flat) * times, axis=0))


def strikes_in_the_air(time: Array, height: Array, strike: Array, off: Array, end: Array) -> Mask:
    """Whether a foot is too high to meet the ground at each of m strikes, `(m,)`.

    Args:
        time: `(n,)` [s].
        height: `(n,)` of the part of the foot that lands first [m].
        strike: `(m,)` heel strikes [s].
        off: `(m,)` toe-offs [s].
        end: `(m,)` ends of the swings [s].
    """
    a, b = (strike + part * (off - strike) for part in FOOT_FLAT)
    rest = _along(time, height, a, b).mean(axis=0)
    rows = zip(np.searchsorted(time, off), np.searchsorted(time, end, side="right"), strict=True)
    highest = np.array([height[i:j].max(initial=-np.inf) for i, j in rows])
    lift = np.maximum(highest - rest, 0.0)
    above = np.interp(strike, time, height) - rest
    return np.asarray(above > _STRIKE_HEIGHT[0] * lift + _STRIKE_HEIGHT[1])


def _along(time: Array, y: Array, start: Array, end: Array) -> Array:
    """Values `(20, m)` of a curve over m spans of time."""
    return np.asarray(np.interp(np.linspace(start, end, 20), time, y))
