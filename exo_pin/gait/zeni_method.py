"""Zeni's method: heel strikes and toe-offs at the extremes of the feet's motion relative to the pelvis."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.names import EventKind, Side
from exo_pin.arguments import number
from exo_pin.arrays import Array, Index
from exo_pin.errors import GaitError
from exo_pin.gait.event import Event
from exo_pin.gait.foot_velocity import vertex
from exo_pin.gait.validation import check_time, frozen

ZENI = "Zeni 2008"
_SMALLEST_EXCURSION = 0.05
"""A foot that moves less than this to and fro [m] is not walking."""

_PROMINENCE = 0.3
"""Least prominence of a maximum on both sides, as a part of the usual excursion."""

_PROMINENCE_AT_ENDS = 0.05
"""The same towards an end of the recording, where a part of the swing is missing."""

_WINDOW = 3.0
"""Length of the spans that the usual excursion is measured in [s]: a stride of a slow walk and more."""

_IN_PHASE = 0.5
"""Correlation of the two feet's curves above which they jump or are the same foot; walking has about -0.9."""


def zeni(
    time: ArrayLike,
    heel_forward: ArrayLike,
    toe_forward: ArrayLike,
    *,
    periodic: bool = False,
    smallest_excursion: float = _SMALLEST_EXCURSION,
) -> tuple[Event, ...]:
    """Contact events of forward walking, overground or on a treadmill.

    Heel strike is where the heel is furthest ahead of the pelvis, toe-off where the toe is furthest behind:
    J. A. Zeni, J. G. Richards, J. S. Higginson, "Two simple methods for determining gait events during
    treadmill and overground walking using kinematic data", Gait & Posture 27 (2008) 710-714. Extremes
    of less prominence than 30 % of the foot's usual excursion count as noise; the moment is refined with a
    parabola through three samples.

    Args:
        time: `(n,)` [s].
        heel_forward: `(n, 2)` heels ahead of the pelvis along the walking direction, left and right [m].
        toe_forward: `(n, 2)` toes likewise.
        periodic: The samples are one or more cycles [0, T) of a walk that repeats.
        smallest_excursion: A foot that moves less to and fro is standing [m].

    Returns:
        Events sorted by time, within the recording.

    Raises:
        GaitError: No gait cycles: standing, a foot without both kinds of event, events of a foot that do not
            take turns, feet that do not take turns; or unusable arrays.
    """
    heels = frozen(heel_forward, "heel_forward")
    events = candidates(time, heels, toe_forward, periodic=periodic, smallest_excursion=smallest_excursion)
    check_apart(heels)
    check_turns(events, periodic)
    return tuple(events)


def candidates(
    time: ArrayLike,
    heel_forward: ArrayLike,
    toe_forward: ArrayLike,
    *,
    periodic: bool = False,
    smallest_excursion: float = _SMALLEST_EXCURSION,
    source: str = ZENI,
) -> list[Event]:
    """The extremes of each foot's motion as events sorted by time, walk or not.

    Args:
        time: `(n,)` [s].
        heel_forward: `(n, 2)` heels ahead of the pelvis along the walking direction, left and right [m].
        toe_forward: `(n, 2)` toes likewise.
        periodic: The samples are one or more cycles [0, T) of a walk that repeats.
        smallest_excursion: A foot that moves less to and fro is standing [m].
        source: Of the events.

    Raises:
        GaitError: A foot hardly moves, or unusable arrays.
    """
    t = frozen(time, "time")
    check_time(t, periodic)
    number("smallest_excursion", smallest_excursion, least=0.0, error=GaitError)
    curves: dict[EventKind, Array] = {
        "heel_strike": frozen(heel_forward, "heel_forward"),
        "toe_off": -frozen(toe_forward, "toe_forward"),
    }
    events = []
    for kind, curve in curves.items():
        if curve.shape != (len(t), 2) or not np.isfinite(curve).all():
            raise GaitError(f"{kind}: expected finite positions ({len(t)}, 2) [m], left and right")
        for side, y in zip(SIDES, curve.T, strict=True):
            events += [
                Event(x, kind, side, source) for x in _maxima(t, y, side, periodic, smallest_excursion)
            ]
    return sorted(events, key=lambda event: event.time)


def _maxima(time: Array, y: Array, side: Side, periodic: bool, smallest: float) -> list[float]:
    """Times of the prominent maxima of y."""
    excursion = _excursion(time, y, smallest)
    if excursion < smallest:
        raise GaitError(
            f"no gait cycles found: the {side} foot moves {excursion:.3f} m to and fro, "
            f"less than {smallest:g} m"
        )
    height = _PROMINENCE * excursion
    if not periodic:
        peaks = _prominent(y, height, _PROMINENCE_AT_ENDS * excursion)
        return [vertex(time, y, i) for i in peaks]
    n, start = len(y), int(y.argmin())
    step = time[-1] / (n - 1)
    cycle = np.roll(y, -start)
    peaks = _prominent(np.append(cycle, cycle[0]), height, height)
    around = np.concatenate([cycle[-1:], cycle, cycle[:1]])
    grid = step * np.arange(-1, n + 1)
    return [(vertex(grid, around, i + 1) + start * step) % (n * step) for i in peaks]


def _excursion(time: Array, y: Array, smallest: float) -> float:
    """How far the foot usually moves to and fro [m], where it moves: before and after it may stand."""
    length = int(np.searchsorted(time, time[0] + _WINDOW))
    windows = np.lib.stride_tricks.sliding_window_view(y, min(length, len(y)))[:: max(length // 4, 1)]
    spans = np.ptp(np.percentile(windows, [5, 95], axis=1), axis=0)  # no single sample
    walks = spans[spans >= smallest]
    return float(np.median(walks) if len(walks) else spans.max())


def _prominent(y: Array, height: float, border: float) -> list[int]:
    """Indices of the maxima that rise by `height` on both sides; by `border` on a side that meets an end.

    One pass that keeps the last extremes: a maximum is certain once the curve has fallen from it by
    `height`, a minimum once it has risen by as much.
    """
    peaks: list[int] = []
    top = bottom = 0
    rising: bool | None = None  # which way the curve goes is unknown until it has moved by `height`
    turns = _turning_points(y)
    for i, value in zip(turns.tolist(), y[turns].tolist(), strict=True):
        if value > y[top]:
            top = i
        if value < y[bottom]:
            bottom = i
        if rising is not False and y[top] - value >= height:
            if rising or y[top] - y[: top + 1].min() >= border:
                peaks.append(top)
            rising, bottom = False, i
        elif rising is not True and value - y[bottom] >= height:
            rising, top = True, i
    if rising and y[top] - y[-1] >= border:
        peaks.append(top)
    return peaks


def _turning_points(y: Array) -> Index:
    """Indices of the samples at which y does not go on rising or falling, and of its ends."""
    way = np.sign(np.diff(y))
    goes_on = (way[1:] == way[:-1]) & (way[1:] != 0)
    return np.flatnonzero(np.concatenate([[True], ~goes_on, [True]]))


def check_apart(forward: Array) -> None:
    """Raises `GaitError` if left and right foot `(n, 2)` [m] move forward together."""
    left, right = (forward - forward.mean(axis=0)).T
    if left @ right > _IN_PHASE * np.linalg.norm(left) * np.linalg.norm(right):
        raise GaitError("no gait cycles found: both feet move forward together; in a walk they take turns")


def check_turns(events: list[Event], periodic: bool = False) -> None:
    """Both feet strike and leave in turns, and so do left and right.

    Raises:
        GaitError: They do not.
    """
    for side in SIDES:
        mine = [event for event in events if event.side == side]
        if len({event.kind for event in mine}) < 2:
            raise GaitError(
                f"no gait cycles found: the {side} foot does not both strike the ground and leave it"
            )
        _check_turns(
            [event.kind for event in mine], f"heel strikes and toe-offs of the {side} foot", periodic
        )
    strikes = [event.side for event in events if event.kind == "heel_strike"]
    _check_turns(strikes, "heel strikes of the left and the right foot", periodic)


def _check_turns(labels: Sequence[str], what: str, periodic: bool) -> None:
    around = [*labels, *labels[:1]] if periodic else labels
    if any(first == second for first, second in pairwise(around)):
        raise GaitError(f"no gait cycles found: {what} do not take turns")
