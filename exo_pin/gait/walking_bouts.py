"""Walking bouts: heel strikes and toe-offs of those parts of a motion that are a walk."""

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
from exo_pin.gait.foot_velocity import at_largest_fall
from exo_pin.gait.running_method import Runner, looks_like_a_run, running_events
from exo_pin.gait.stride_checks import (
    IN_THE_AIR,
    LONGEST_FLIGHT,
    CandidateStride,
    Feet,
    candidate_strides,
    consistent,
    strikes_in_the_air,
)
from exo_pin.gait.zeni_method import ZENI, candidates, check_apart, check_turns

_MARGIN = 1.5
"""Events of an incomplete stride belong to the walk if they lie within this many strides of its ends."""


def walking_events(
    feet: Feet,
    *,
    periodic: bool = False,
    heights: bool = True,
    runner: Runner | None = None,
) -> tuple[Event, ...]:
    """Heel strikes and toe-offs of the parts of a motion that are a walk, forward or backward, or a run.

    The extremes of the feet's motion (`exo_pin.gait.zeni`) are checked stride by stride, then heel strikes
    are moved to where the foot falls fastest (`exo_pin.gait.foot_velocity`). In a walk left and
    right take turns; a foot strikes near the ground, is lower in stance than in swing, and advances over the
    ground. Other motion (squats, standing up, marching or stepping on the spot) gives no event. In a walk
    backwards the toe lands first and the heel leaves last: there `heel_strike` is the first and `toe_off` the
    last contact, and the source of the events names it. A run (`exo_pin.gait.running_method`) has events by
    methods made for running.

    Args:
        feet: The motion.
        periodic: The samples are one or more cycles [0, T) of a walk that repeats.
        heights: The pelvis's vertical motion was recorded, so that heights over the ground are known: then
            heel strikes of a walk forward are refined by the foot's velocity.
        runner: What a run is recognised by; None: it is not.

    Raises:
        GaitError: Nothing in it is a walk; the message gives the most frequent objection.
    """
    if periodic:
        return _repeated(feet, heights, runner)
    run = () if runner is None else _run(runner)
    if run:
        return run
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
    if not heights or best is backward:
        return best[0]
    centre = (feet.heel[..., 2] + feet.toe[..., 2]) / 2
    return tuple(at_largest_fall(feet.time, centre, best[0]))


def _run(runner: Runner) -> tuple[Event, ...]:
    """Events of a run; none where the motion is no run, or none of its strides counts."""
    feet = runner.feet
    try:
        known = candidates(feet.time, feet.ahead(feet.heel), feet.ahead(feet.toe))
        check_apart(feet.ahead(feet.heel))
    except GaitError:
        return ()
    events = running_events(runner, known)
    if not looks_like_a_run(runner, events, known):
        return ()
    if runner.height is None:  # how high the feet are is not known: no stride is refused for it
        level = np.array([1.0, 1.0, 0.0])
        feet = feet._replace(heel=feet.heel * level, toe=feet.toe * level)
    each = [candidate_strides(feet, feet.heel, events, side, early=LONGEST_FLIGHT) for side in SIDES]
    strides = consistent([stride for of in each for stride in of])
    good = [stride for stride in strides if not stride.why]
    if strides:
        return _kept(events, strides, good) if good else ()
    return tuple(events)


def _repeated(feet: Feet, heights: bool, runner: Runner | None) -> tuple[Event, ...]:
    """Events of a walk that repeats: the middle one of three rounds."""
    n = len(feet.time)
    period = feet.time[-1] * n / (n - 1)
    if runner is not None:
        height = None if runner.height is None else np.tile(runner.height, 3)
        runner = Runner(_thrice(runner.feet, period), np.tile(runner.knee, (3, 1)), height)
    found = walking_events(_thrice(feet, period), heights=heights, runner=runner)
    middle = [e for e in found if period <= e.time + SAME_TIME < 2 * period]
    events = [dataclasses.replace(e, time=max(e.time - period, 0.0)) for e in middle]
    check_turns(events, periodic=True)
    return tuple(events)


def _thrice(feet: Feet, period: float) -> Feet:
    """Three rounds of a motion that repeats with that period [s]."""
    n = len(feet.time)
    time = np.asarray(period / n * np.arange(3 * n), dtype=np.float64)
    return Feet(time, *(np.concatenate([x] * 3) for x in feet[1:]))


def _one_way(feet: Feet, backwards: bool) -> tuple[tuple[Event, ...], int, str]:
    """Events of a walk forward, or backwards; its number of strides; the reason where there are none."""
    first, last = (feet.toe, feet.heel) if backwards else (feet.heel, feet.toe)  # to land, to leave
    sign = -1 if backwards else 1
    source = f"{ZENI}, walking backwards" if backwards else ZENI
    events = candidates(feet.time, sign * feet.ahead(first), sign * feet.ahead(last), source=source)
    strides = consistent(
        [stride for side in SIDES for stride in candidate_strides(feet, first, events, side)]
    )
    if not strides:
        return _too_short(feet, first, events), 0, ""
    good = [stride for stride in strides if not stride.why]
    if not good:
        why = Counter(stride.why for stride in strides).most_common(1)[0][0]
        return (), 0, f"no gait cycles found: {why}"
    return _kept(events, strides, good), len(good), ""


def _too_short(feet: Feet, first: Array, events: list[Event]) -> tuple[Event, ...]:
    """Events of a recording without a whole stride, if they may belong to a walk."""
    check_apart(feet.ahead(first))
    check_turns(events)
    for k, side in enumerate(SIDES):
        mine = [event for event in events if event.side == side]
        moments = [(a.time, b.time, feet.time[-1]) for a, b in pairwise(mine) if a.kind == "heel_strike"]
        if strikes_in_the_air(feet.time, first[:, k, 2], *np.array(moments).reshape(-1, 3).T).any():
            raise GaitError(f"no gait cycles found: {IN_THE_AIR}")
    return tuple(events)


def _kept(
    events: list[Event], strides: list[CandidateStride], good: list[CandidateStride]
) -> tuple[Event, ...]:
    """The events of good strides, and those before the first and after the last outside other motion."""
    usual = float(np.median([stride.end - stride.strike for stride in good]))
    sure = {(stride.side, t) for stride in good for t in (stride.strike, stride.off, stride.end)}
    start, end = min(stride.strike for stride in good), max(stride.end for stride in good)
    spans = {}  # strides of a foot follow each other without gaps
    for side in SIDES:
        mine = [stride for stride in strides if stride.side == side]
        if mine:
            spans[side] = min(stride.strike for stride in mine), max(stride.end for stride in mine)

    def belongs(event: Event) -> bool:
        first, last = spans.get(event.side, (end, start))
        touches = first <= event.time <= last
        near = start - _MARGIN * usual <= event.time <= end + _MARGIN * usual
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
