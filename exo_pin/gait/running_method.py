"""Running events: contacts by the feet's vertical acceleration and the knees; recognition of a run."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.arrays import Array
from exo_pin.gait.event import EVENT_KINDS, Event, between, times_of
from exo_pin.gait.foot_velocity import slopes, vertex
from exo_pin.gait.stride_checks import Feet
from exo_pin.gait.time_series import rows_within

STRIKE = "Handsaker 2016, running"
TOE_OFF = "Fellin 2010, running"
RUNNING_SOURCES = (STRIKE, TOE_OFF)

_LANDS_WITHIN = 0.25
"""A runner's foot meets the ground at most this part of the stride after it was furthest ahead."""

_HALF_WINDOW = 0.020
"""Velocities and accelerations are slopes of lines through the samples this far before and after [s]."""

_USUAL_STRIDE = 0.72
"""Stride time of a run [s] where a recording is too short to have one: 165 steps a minute."""

_FALLS = -3.0
"""Vertical acceleration of the pelvis [m/s^2] before a strike, below which the runner is in the air: nearly
-g there. A walker's pelvis is at its lowest when a foot strikes, so that it accelerates upwards then."""

_BEFORE = 0.04
"""So long before the strike [s] that acceleration is taken."""

_SHORT_STANCE, _BENT_KNEE = 0.56, np.radians(75.0)
"""Where the pelvis was not recorded, a run has stances shorter than this part of the stride, from the strike
to Zeni's toe-off, which is 5 to 15 % late in runs, and knees that bend further than this [rad] in swing.
Walks of any speed have 56 to 70 % and 60 to 70 degrees (Schwartz 2008)."""

_SLOWEST = 1.2
"""No run is slower [m/s]; who marches on the spot is."""

_NEAR_GROUND = 0.035
"""A foot lands when it is less than this above its lowest place of the next quarter stride [m]."""

_ENDS = 3
"""Samples at either end of a recording where slopes are rough."""

_STRONG = 0.7
"""A contact's peak of acceleration is at least this part of the usual one: weaker ones are no contact."""


class Runner(NamedTuple):
    """What contacts of a run are found by.

    Attributes:
        feet: The feet over the ground, or under an upright pelvis where its motion was not recorded.
        knee: `(n, 2)` flexion of the left and right knee [rad].
        height: `(n,)` of the pelvis over the ground [m]; None where it was not recorded.
    """

    feet: Feet
    knee: Array
    height: Array | None


def running_events(runner: Runner, known: Sequence[Event]) -> list[Event]:
    """Heel strikes and toe-offs as of a run, whether the motion is one or not.

    Strikes: J. C. Handsaker, S. E. Forrester, J. P. Folland, M. I. Black, S. J. Allen, "A kinematic
    algorithm to identify gait events during running at different speeds and with different footstrike
    types", J Biomech 49 (2016): the peak of the vertical acceleration of heel or forefoot, whichever is
    first, here of the lower of the two; +3 ms (95 %: -12 .. +18) from force plates. Toe-offs: R. E. Fellin,
    W. C. Rose, T. D. Royer, I. S. Davis, "Comparison of methods for kinematic identification of footstrike
    and toe-off during overground and treadmill running", J Sci Med Sport 13 (2010) 646-650: the knee's peak
    extension; 5 ms (mean absolute error, 40 runners).

    Args:
        runner: The motion.
        known: The extremes of the feet's motion as events (`exo_pin.gait.zeni_method.candidates`): around
            them contacts are looked for.
    """
    feet, stride = runner.feet, stride_time(known)
    soles = np.minimum(feet.heel[..., 2], feet.toe[..., 2])
    grid, up = _acceleration(feet.time, soles)
    found = []
    for k, side in enumerate(SIDES):
        ahead, behind = (times_of(known, kind, side) for kind in EVENT_KINDS)
        latest = [t + _LANDS_WITHIN * stride for t in ahead]
        spans = [(t, min([end, *between(behind, t, end)])) for t, end in zip(ahead, latest, strict=True)]
        if runner.height is not None:
            spans = [(_near_ground(feet.time, soles[:, k], *span), span[1]) for span in spans]
        else:  # a landing that the recording cuts off looks like what comes before it
            spans = [span for span in spans if span[1] < feet.time[-1]]
        landed = _contacts(grid, up[:, k], spans)
        found += [Event(t, "heel_strike", side, STRIKE) for t in landed]
        straight = -runner.knee[:, k]
        offs = [_extended(feet.time, straight, landed, t, stride) for t in behind]
        found += [Event(t, "toe_off", side, TOE_OFF) for t in offs if t is not None]
    return sorted(found, key=lambda event: event.time)


def _near_ground(time: Array, sole: Array, start: float, end: float) -> float:
    """From when on a sole `(n,)` is near its lowest place between two moments [s]."""
    rows = rows_within(time, start, end)
    near = np.flatnonzero(sole[rows] <= sole[rows].min(initial=np.inf) + _NEAR_GROUND)
    return float(time[rows][near[0]]) if len(near) else start


def _contacts(time: Array, up: Array, spans: Sequence[tuple[float, float]]) -> list[float]:
    """When the lower part of a foot has its peak of acceleration in each span, if it is a strong one [s]."""
    peaks = [_peak(time, up, *span) for span in spans]
    usual = float(np.median([size for _, size in peaks if size > 0] or [0.0]))
    return [t for t, size in peaks if size >= _STRONG * usual > 0]


def _extended(
    time: Array, straight: Array, landed: Sequence[float], behind: float, stride: float
) -> float | None:
    """When the knee is most extended late in the stance that ends before Zeni's toe-off [s], or None."""
    before = between(landed, behind - stride, behind)
    start = (before[-1] + behind) / 2 if before else behind - stride / 5
    off, size = _peak(time, straight, start, behind + _LANDS_WITHIN / 4 * stride)
    return off if np.isfinite(size) else None


def stride_time(events: Sequence[Event]) -> float:
    """Median time from a foot's strike to its next one; else twice that from foot to foot [s]."""
    strikes = [e for e in events if e.kind == "heel_strike"]
    own = [np.diff([e.time for e in strikes if e.side == side]) for side in SIDES]
    strides = np.concatenate(own)
    if len(strides):
        return float(np.median(strides))
    apart = np.diff([e.time for e in strikes])
    return 2 * float(np.median(apart)) if len(apart) else _USUAL_STRIDE


def looks_like_a_run(runner: Runner, events: Sequence[Event], known: Sequence[Event]) -> bool:
    """Whether the runner is in the air before most strikes; without the pelvis's height, stances decide.

    Args:
        runner: The motion.
        events: Of `running_events`.
        known: The extremes of the feet's motion as events.
    """
    steps = [e for e in events if e.kind == "heel_strike"]
    if not steps:
        return False
    if runner.height is not None:
        grid, up = _acceleration(runner.feet.time, runner.height[:, None])
        before = [e.time - _BEFORE for e in steps if e.time - _BEFORE >= grid[0]]
        return bool(before) and float(np.median(np.interp(before, grid, up[:, 0]))) < _FALLS
    stride = stride_time(events)
    offs_of = {side: times_of(known, "toe_off", side) for side in SIDES}
    stances = [
        (offs[0] - e.time) / stride
        for e in steps
        if (offs := between(offs_of[e.side], e.time, e.time + stride))
    ]
    bent = float(np.percentile(runner.knee, 98, axis=0).min()) > _BENT_KNEE
    short = bool(stances) and float(np.median(stances)) < _SHORT_STANCE
    return bent and short and _backwards(runner.feet, events) > _SLOWEST


def _backwards(feet: Feet, events: Sequence[Event]) -> float:
    """Median speed at which a standing foot goes back under the pelvis [m/s]: that of the runner."""
    ahead, speeds = feet.ahead(feet.toe), []
    for k, side in enumerate(SIDES):
        strikes = np.array(times_of(events, "heel_strike", side))
        a, b = (np.interp(strikes + late, feet.time, ahead[:, k]) for late in (0.05, 0.15))
        speeds += ((a - b) / 0.1).tolist()
    return float(np.median(speeds)) if speeds else 0.0


def _acceleration(time: Array, height: Array) -> tuple[Array, Array]:
    grid, velocity = slopes(time, height, _HALF_WINDOW)
    return slopes(grid, velocity, _HALF_WINDOW)


def _peak(time: Array, values: Array, start: float, end: float) -> tuple[float, float]:
    """When values `(n,)` have their peak between two moments [s], and how high; -inf for none."""
    first, stop = np.searchsorted(time, [start, end])
    if stop - first < 3:
        return start, -np.inf
    k = int(first + values[first:stop].argmax())
    inside = max(first - 1, _ENDS) < k < min(stop, len(time) - _ENDS) - 1
    return vertex(time, values, k), float(values[k]) if inside else -np.inf
