"""Which of a motion's foot turns are a walk's heel strikes and toe-offs: what looks otherwise is refused."""

from __future__ import annotations

import dataclasses
from collections import Counter
from collections.abc import Callable
from itertools import pairwise

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.arrays import Array
from exo_pin.errors import GaitError
from exo_pin.gait.event import SAME_TIME, Event
from exo_pin.gait.events import SOURCE, candidates, check_apart, check_turns
from exo_pin.gait.step_checks import Feet, Step, agreed, in_the_air, steps_of

NEAR = 1.5
"""Events of a broken stride at an end belong to the walk if they lie within this many strides of it."""


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
    middle = [e for e in walking(thrice) if period <= e.time + SAME_TIME < 2 * period]
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
    steps = agreed([step for side in SIDES for step in steps_of(feet, first, events, side)])
    if not steps:
        return _too_short(feet, first, events), 0, ""
    good = [step for step in steps if not step.why]
    if not good:
        why = Counter(step.why for step in steps).most_common(1)[0][0]
        return (), 0, f"no gait cycles found: {why}"
    return _kept(events, steps, good), len(good), ""


def _too_short(feet: Feet, first: Array, events: list[Event]) -> tuple[Event, ...]:
    """Events of a recording without a whole stride, if they may belong to a walk."""
    check_apart(feet.ahead(first))
    check_turns(events)
    for k, side in enumerate(SIDES):
        mine = [event for event in events if event.side == side]
        for strike, off in pairwise(mine):
            if strike.kind != "heel_strike":
                continue
            high = in_the_air(feet, first[:, k, 2], strike.time, off.time, float(feet.time[-1]))
            if high:
                raise GaitError(f"no gait cycles found: {high}")
    return tuple(events)


def _kept(events: list[Event], steps: list[Step], good: list[Step]) -> tuple[Event, ...]:
    """The events of good steps, and those before the first and after the last that touch no other motion."""
    usual = float(np.median([step.end - step.strike for step in good]))
    sure = {(step.side, t) for step in good for t in (step.strike, step.off, step.end)}
    start, end = min(step.strike for step in good), max(step.end for step in good)
    spans = {}  # steps of a foot follow each other without gaps
    for side in SIDES:
        mine = [step for step in steps if step.side == side]
        if mine:
            spans[side] = min(step.strike for step in mine), max(step.end for step in mine)

    def belongs(event: Event) -> bool:
        first, last = spans.get(event.side, (end, start))
        touches = first <= event.time <= last
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
