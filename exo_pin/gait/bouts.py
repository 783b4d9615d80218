"""Which of a motion's foot turns are a walk's heel strikes and toe-offs: what looks otherwise is refused."""

from __future__ import annotations

import dataclasses
from collections import Counter
from collections.abc import Callable
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from exo_pin.anatomy import SIDES
from exo_pin.errors import GaitError
from exo_pin.gait.event import Event
from exo_pin.gait.events import SOURCE, TOGETHER, candidates, check_turns

Array = NDArray[np.float64]

APART = 0.15
"""The other foot strikes at least this part of the stride after and before this one: limps reach 0.3."""

REST = (0.2, 0.5)
"""Part of the stance in which the whole foot rests on the ground."""

AIRBORNE = (0.4, 0.03)
"""A foot strikes the ground no higher than this part of its swing's height, and this [m], above its rest."""

LIFTED = 0.01
"""A foot may be as much higher in stance than in swing [m]: averaged walks drag their feet."""

LEVEL = 0.05
"""A resting foot goes up and down by less [m]; over a pelvis that is held still the ground does by 4 cm."""

SHORTEST = 0.10
"""A stride gets along by as much [m] over the ground, or it is stepping on the spot."""

QUICKEST = 0.4
"""Nobody walks quicker strides [s]: 300 steps/min."""

EARLY = 0.1
"""The other foot may leave the ground this part of the stride before this one strikes: the method errs."""

NEAR = 1.5
"""Events belong to a walk if they lie within this many strides of one of its strides."""


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


class _Step(NamedTuple):
    """One foot from heel strike to heel strike."""

    side: str
    strike: float
    off: float
    end: float
    why: str


def walking(feet: Feet, *, periodic: bool = False) -> tuple[Event, ...]:
    """Heel strikes and toe-offs of the parts of a motion that are a walk, forward or backward.

    Zeni's turns of the feet (`exo_pin.gait.zeni`) are looked at stride by stride. In a walk left and right
    take turns; a foot strikes near the ground, is lower in stance than in swing, and gets along over the
    ground. What does not - squats, standing up, marching or stepping on the spot - gives no event. In a walk
    backwards the toe lands first and the heel leaves last: there `heel_strike` is the first and `toe_off` the
    last contact, and the events' source says so.

    Args:
        feet: The motion.
        periodic: The samples are one or more cycles [0, T) of a walk that repeats.

    Raises:
        GaitError: Nothing in it is a walk; the message says what speaks against it.
    """
    if periodic:
        return _repeated(feet)
    found = []
    for backwards in (False, True):
        try:
            found.append(_one_way(feet, backwards))
        except GaitError as error:
            found.append(((), 0, str(error)))
    forward, backward = found
    best = backward if backward[1] > forward[1] else forward
    if not best[0]:
        raise GaitError(best[2])
    return best[0]


def _repeated(feet: Feet) -> tuple[Event, ...]:
    """Events of a walk that repeats: the middle one of three rounds."""
    n = len(feet.time)
    period = feet.time[-1] * n / (n - 1)
    time = period / n * np.arange(3 * n)
    thrice = Feet(time, *(np.concatenate([x] * 3) for x in feet[1:]))
    middle = [e for e in walking(thrice) if period <= e.time + 1e-9 * period < 2 * period]
    events = [dataclasses.replace(e, time=max(e.time - period, 0.0)) for e in middle]
    check_turns(events, periodic=True)
    return tuple(events)


def _one_way(feet: Feet, backwards: bool) -> tuple[tuple[Event, ...], int, str]:
    """Events of a walk forward, or backwards; how many strides it has; why there are none."""
    first, last = (feet.toe, feet.heel) if backwards else (feet.heel, feet.toe)  # to land, to leave
    sign = -1 if backwards else 1
    events = candidates(feet.time, sign * feet.ahead(first), sign * feet.ahead(last))
    if backwards:
        events = [dataclasses.replace(event, source=f"{SOURCE}, walking backwards") for event in events]
    steps = [step for side in SIDES for step in _steps(feet, first, events, side)]
    if not steps:
        return _too_short(feet, first, events), 0, ""
    good = [step for step in steps if not step.why]
    if not good:
        why = Counter(step.why for step in steps).most_common(1)[0][0]
        return (), 0, f"no gait cycles found: {why}"
    return _kept(events, steps, good), len(good), ""


def _steps(feet: Feet, first: Array, events: list[Event], side: str) -> list[_Step]:
    """Every span between two strikes of a foot, and what speaks against it."""
    mine = [event for event in events if event.side == side]
    strikes = [event.time for event in mine if event.kind == "heel_strike"]
    other = [event for event in events if event.side != side]
    steps = []
    for a, b in pairwise(strikes):
        offs = [event.time for event in mine if event.kind == "toe_off" and a < event.time < b]
        why = "heel strikes and toe-offs of one foot do not take turns" if len(offs) != 1 else ""
        why = why or _order(other, a, b) or _against(feet, first, SIDES.index(side), (a, offs[0], b))
        steps.append(_Step(side, a, offs[0] if offs else a, b, why))
    return steps


def _order(other: list[Event], a: float, b: float) -> str:
    """What in the other foot's events speaks against a stride from a to b."""
    if b - a < QUICKEST:
        return f"the feet swing to and fro in less than {QUICKEST:g} s: noise?"
    strikes = [event.time for event in other if event.kind == "heel_strike" and a < event.time < b]
    if len(strikes) != 1:
        return "the left and the right foot do not take turns"
    if not APART < (strikes[0] - a) / (b - a) < 1 - APART:
        return "both feet move forward together; in a walk they take turns"
    early = a - EARLY * (b - a)
    if not any(event.kind == "toe_off" and early < event.time < strikes[0] for event in other):
        return "one foot does not leave the ground while the other one stands"
    return ""


def _against(feet: Feet, first: Array, k: int, moments: tuple[float, float, float]) -> str:
    """What in the path of foot k speaks against a stride with these strike, toe-off and next strike."""
    strike, off, end = moments
    high = _in_the_air(feet, first[:, k, 2], strike, off, end)
    if high:
        return high
    sole = np.minimum(feet.heel[:, k, 2], feet.toe[:, k, 2])
    stance, swing = (_mean(feet.time, sole, a, b) for a, b in ((strike, off), (off, end)))
    if stance > swing + LIFTED:
        return "the feet are higher in stance than in swing"
    a, b = (strike + part * (off - strike) for part in REST)
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


def _in_the_air(feet: Feet, height: Array, strike: float, off: float, end: float) -> str:
    """Whether a part of the foot is too high to strike the ground, in words."""
    rest = _mean(feet.time, height, *(strike + part * (off - strike) for part in REST))
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


def _too_short(feet: Feet, first: Array, events: list[Event]) -> tuple[Event, ...]:
    """Events of a recording without a whole stride, if they may belong to a walk."""
    left, right = (feet.ahead(first) - feet.ahead(first).mean(axis=0)).T
    if left @ right > TOGETHER * np.linalg.norm(left) * np.linalg.norm(right):
        raise GaitError("no gait cycles found: both feet move forward together; in a walk they take turns")
    check_turns(events)
    for k, side in enumerate(SIDES):
        mine = [event for event in events if event.side == side]
        for strike, off in pairwise(mine):
            if strike.kind != "heel_strike":
                continue
            high = _in_the_air(feet, first[:, k, 2], strike.time, off.time, float(feet.time[-1]))
            if high:
                raise GaitError(f"no gait cycles found: {high}")
    return tuple(events)


def _kept(events: list[Event], steps: list[_Step], good: list[_Step]) -> tuple[Event, ...]:
    """The events of good steps, and those before the first and after the last that touch no other motion."""
    usual = float(np.median([step.end - step.strike for step in good]))
    sure = {(step.side, t) for step in good for t in (step.strike, step.off, step.end)}
    start, end = min(step.strike for step in good), max(step.end for step in good)

    def belongs(event: Event) -> bool:
        touches = any(step.side == event.side and step.strike <= event.time <= step.end for step in steps)
        near = start - NEAR * usual <= event.time <= end + NEAR * usual
        return (event.side, event.time) in sure or (near and not touches)

    kept = [event for side in SIDES for event in _in_turns([e for e in events if e.side == side], belongs)]
    return tuple(sorted(kept, key=lambda event: event.time))


def _in_turns(mine: list[Event], belongs: Callable[[Event], bool]) -> list[Event]:
    """The events of one foot that belong to the walk, and between two strikes the last toe-off there was."""
    out: list[Event] = []
    for event in filter(belongs, mine):
        if out and out[-1].kind == event.kind:
            other = [e for e in mine if out[-1].time < e.time < event.time and e.kind != event.kind]
            if not other:
                continue
            out.append(other[-1])
        out.append(event)
    return out
