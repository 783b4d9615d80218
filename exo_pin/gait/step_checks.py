"""One foot from heel strike to heel strike, and what in its path speaks against a stride of a walk."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.names import Side
from exo_pin.arrays import Array
from exo_pin.gait.event import EVENT_KINDS, FOOT_FLAT, Event, between

APART = 0.15
"""The other foot strikes at least this part of the stride after and before this one: limps reach 0.3."""

AIRBORNE = (0.4, 0.05)
"""A foot strikes the ground no higher than this part of its swing's height, and this [m], above its rest."""

LIFTED = 0.01
"""A foot may be as much higher in stance than in swing [m]: averaged walks drag their feet."""

LEVEL = 0.06
"""A resting foot goes up and down by less [m]; over a pelvis that is held still the ground does by 4 cm."""

SHORTEST = 0.10
"""A stride gets along by as much [m] over the ground, or it is stepping on the spot."""

QUICKEST = 0.4
"""Nobody walks quicker strides [s]: 300 steps/min."""

EARLY = 0.2
"""The other foot may leave the ground this part of the stride before this one strikes: the method errs."""


class Feet(NamedTuple):
    """Both feet, left and right, and the pelvis over the ground, z up.

    Attributes:
        time: `(n,)` [s].
        heel: `(n, 2, 3)` [m]. Where nobody knows the pelvis's tilt, the height that a straighter leg leaves
            below the pelvis serves as z: see `exo_pin.kinematics.events`.
        toe: `(n, 2, 3)` balls of the feet, or toes [m].
        pelvis: `(n, 2)` [m].
        heading: `(n, 2)` unit vectors: where the pelvis looks.
    """

    time: Array
    heel: Array
    toe: Array
    pelvis: Array
    heading: Array

    def ahead(self, part: Array) -> Array:
        """`(n, 2)` how far a part of each foot is ahead of the pelvis [m]."""
        return np.asarray(np.einsum("nfk,nk->nf", part[..., :2] - self.pelvis[:, None], self.heading))


class Step(NamedTuple):
    """One foot from heel strike to heel strike."""

    side: Side
    strike: float
    off: float
    end: float
    why: str


def steps_of(feet: Feet, first: Array, events: list[Event], side: Side) -> list[Step]:
    """Every span between two strikes of a foot, and what speaks against it."""
    mine: dict[str, list[float]] = {kind: [] for kind in EVENT_KINDS}
    other: dict[str, list[float]] = {kind: [] for kind in EVENT_KINDS}
    for event in events:
        (mine if event.side == side else other)[event.kind].append(event.time)
    steps = []
    for a, b in pairwise(mine["heel_strike"]):
        offs = between(mine["toe_off"], a, b)
        why = "heel strikes and toe-offs of one foot do not take turns" if len(offs) != 1 else ""
        why = why or _order(other, a, b) or _against(feet, first, SIDES.index(side), (a, offs[0], b))
        steps.append(Step(side, a, offs[0] if offs else a, b, why))
    return steps


def agreed(steps: list[Step]) -> list[Step]:
    """The same; a step in which a step of the other foot begins or ends that is none, is none either."""
    doubts: dict[str, dict[float, str]] = {side: {} for side in SIDES}
    for step in steps:
        for t in (step.strike, step.end):
            doubts[step.side][t] = step.why or doubts[step.side].get(t, "")
    times = {side: sorted(known) for side, known in doubts.items()}

    def partner(step: Step) -> str:
        other = SIDES[1 - SIDES.index(step.side)]
        inside = between(times[other], step.strike, step.end)
        return next(filter(None, (doubts[other][t] for t in inside)), "")

    return [step if step.why else step._replace(why=partner(step)) for step in steps]


def _order(other: Mapping[str, Sequence[float]], a: float, b: float) -> str:
    """What in the other foot's events speaks against a stride from a to b."""
    if b - a < QUICKEST:
        return f"the feet swing to and fro in less than {QUICKEST:g} s: noise?"
    strikes = between(other["heel_strike"], a, b)
    if len(strikes) != 1:
        return "the left and the right foot do not take turns"
    if not APART < (strikes[0] - a) / (b - a) < 1 - APART:
        return "both feet move forward together; in a walk they take turns"
    if not between(other["toe_off"], a - EARLY * (b - a), strikes[0]):
        return "one foot does not leave the ground while the other one stands"
    return ""


def _against(feet: Feet, first: Array, k: int, moments: tuple[float, float, float]) -> str:
    """What in the path of foot k speaks against a stride with these strike, toe-off and next strike."""
    strike, off, end = moments
    begin, stop = np.searchsorted(feet.time, [strike, end])
    rows = slice(max(begin - 1, 0), stop + 1)  # long recordings have thousands of strides
    first, feet = first[rows], Feet(*(part[rows] for part in feet))
    high = in_the_air(feet, first[:, k, 2], strike, off, end)
    if high:
        return high
    sole = np.minimum(feet.heel[:, k, 2], feet.toe[:, k, 2])
    stance, swing = (_mean(feet.time, sole, a, b) for a, b in ((strike, off), (off, end)))
    if stance > swing + LIFTED:
        return "the feet are higher in stance than in swing"
    a, b = (strike + part * (off - strike) for part in FOOT_FLAT)
    resting = np.interp(np.linspace(a, b, 20), feet.time, sole)
    if np.ptp(resting) > LEVEL:
        return "the feet go up and down where they should rest on the ground: cycling?"
    path = np.stack(
        [np.interp([strike, end, a, b], feet.time, first[:, k, axis]) for axis in range(2)], axis=1
    )
    ground = (path[3] - path[2]) / (b - a)
    length = float(np.linalg.norm(path[1] - path[0] - ground * (end - strike)))
    if length < SHORTEST:
        return f"the feet do not get along: stepping on the spot; strides of less than {SHORTEST:g} m"
    return ""


def in_the_air(feet: Feet, height: Array, strike: float, off: float, end: float) -> str:
    """Whether a part of the foot is too high to strike the ground, in words."""
    rest = _mean(feet.time, height, *(strike + part * (off - strike) for part in FOOT_FLAT))
    swing = height[(feet.time >= off) & (feet.time <= end)]
    lift = float(swing.max()) - rest if len(swing) else 0.0
    above = float(np.interp(strike, feet.time, height)) - rest
    if above <= AIRBORNE[0] * max(lift, 0.0) + AIRBORNE[1]:
        return ""
    return "the feet are furthest ahead in the air, not on the ground: marching on the spot, or cycling?"


def _mean(time: Array, y: Array, start: float, end: float) -> float:
    """Mean of a curve over a span of time."""
    t = np.linspace(start, end, 20)
    return float(np.interp(t, time, y).mean())
