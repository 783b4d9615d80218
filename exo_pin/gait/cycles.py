"""Gait cycles: a walk cut at heel strikes, each cycle at 101 points, with mean, spread and outliers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.names import EventKind, Side
from exo_pin.arguments import MOST_SAMPLES, count
from exo_pin.arrays import Array
from exo_pin.errors import GaitError, UnknownNameError
from exo_pin.gait import time_series
from exo_pin.gait.event import EVENT_KINDS, Event, times_of
from exo_pin.gait.gait import Gait
from exo_pin.gait.heading import mean_heading
from exo_pin.gait.rigid_poses import nearest_pose
from exo_pin.gait.strides import Stride, strides, unrolled
from exo_pin.gait.validation import read_only
from exo_pin.short_repr import short_repr

CYCLE_POINTS = 101
"""0, 1, ... 100 % of the cycle."""

_OUTLIER_FACTOR = 3.0
"""An outlier lies this many times further from the median cycle than cycles usually do ..."""

_OUTLIER_ANGLE = np.radians(3.0)
"""... and is at least this far off [rad, rms over cycle and joints]."""


@dataclass(frozen=True, eq=False)
class Cycles:
    """The cycles of one foot, from heel strike to its next heel strike.

    Attributes:
        side: Whose heel strikes cut the walk.
        q: `(k, points, 12)` joint angles of both legs, in the order of `JOINTS` [rad].
        start: `(k,)` heel strikes that begin the cycles [s].
        duration: `(k,)` stride times [s].
        skipped: Strides that were left out, with the reasons: pauses, turns, missed events.
        base: `(k, points, 4, 4)` the pelvis of each cycle, turned to walk along x, its even travel taken
            off, or None if it does not move [m].
        contacts: Kind and side of an event -> its phases (0 to 1) in the cycles that have one such event.
        sources: Kind and side of an event -> what the events of the walk come from.
    """

    side: Side
    q: Array
    start: Array
    duration: Array
    skipped: tuple[Stride, ...] = ()
    base: Array | None = None
    contacts: Mapping[tuple[EventKind, Side], Array] = field(default_factory=dict)
    sources: Mapping[tuple[EventKind, Side], str] = field(default_factory=dict)

    __repr__ = short_repr

    def __len__(self) -> int:
        """Number of cycles k."""
        return len(self.q)

    @property
    def percent(self) -> Array:
        """`(points,)` of the cycle."""
        return np.linspace(0, 100, self.q.shape[1])

    @cached_property
    def mean(self) -> Array:
        """`(points, 12)` mean over the cycles [rad]."""
        return read_only(self.q.mean(axis=0))

    @cached_property
    def sd(self) -> Array:
        """`(points, 12)` standard deviation (n - 1) [rad]; NaN for a single cycle."""
        if len(self) < 2:
            return read_only(np.full(self.q.shape[1:], np.nan))
        return read_only(self.q.std(axis=0, ddof=1))

    @cached_property
    def outliers(self) -> tuple[int, ...]:
        """Cycles whose rms distance to the median cycle is 3 times the usual and more than 3 degrees."""
        if len(self) < 3:
            return ()
        away = np.sqrt(((self.q - np.median(self.q, axis=0)) ** 2).mean(axis=(1, 2)))
        odd = (away > _OUTLIER_FACTOR * np.median(away)) & (away > _OUTLIER_ANGLE)
        return tuple(int(k) for k in np.flatnonzero(odd))

    def average(self, source: str = "") -> Gait:
        """The mean cycle as a periodic gait of `points - 1` samples, with the mean pelvis and mean events.

        Ends that do not meet are closed: the gap between 100 % and 0 % is spread evenly over the cycle.
        """
        q = _closed(self.mean)
        base = None if self.base is None else nearest_pose(_closed(self.base.mean(axis=0)))
        T = float(self.duration.mean())
        source = source or f"mean of {len(self)} {self.side} cycle{'s' * (len(self) != 1)}"
        events = tuple(
            Event(
                T * float(phases.mean()),
                kind,
                side,
                _mean_source(self.sources.get((kind, side), ""), len(phases)),
            )
            for (kind, side), phases in self.contacts.items()
        )
        return Gait(T * np.arange(len(q)) / len(q), q, base=base, events=events, periodic=True, source=source)


def cycles(gait: Gait, side: Side = "left", *, points: int = CYCLE_POINTS) -> Cycles:
    """Cut a walk at the heel strikes of one foot; every cycle gets the same number of points.

    A periodic gait is followed around its end, so it has a cycle for every heel strike of the foot.

    Args:
        gait: A walk with events.
        side: Whose heel strikes cut it.
        points: Number of points of each cycle, both ends included: 2 to 100 000.

    Raises:
        GaitError: Fewer than two heel strikes of that foot, no stride of a walk between them, or too few
            or too many points.
        UnknownNameError: There is no such side.
    """
    if side not in SIDES:
        raise UnknownNameError("side", side, SIDES)
    points = count("points", points, 2, MOST_SAMPLES // 10, error=GaitError)
    walk, spans = unrolled(gait), strides(gait, side)
    kept = [span for span in spans if not span.why]
    if not kept:
        raise GaitError(f"no gait cycles found: {_why_none(walk, spans, side)}")
    moments = np.concatenate([np.linspace(span.start, span.end, points) for span in kept])
    q = time_series.resampled(walk.time, walk.q, moments, periodic=False).reshape(len(kept), points, -1)
    base = None
    if walk.base is not None:
        flat = time_series.resampled(walk.time, walk.base.reshape(-1, 16), moments, periodic=False)
        base = np.array([_on_the_spot(cycle) for cycle in flat.reshape(len(kept), points, 16)])
    start, duration = (np.array([getattr(span, name) for span in kept]) for name in ("start", "duration"))
    skipped = tuple(span for span in spans if span.why)
    return Cycles(
        side,
        read_only(q),
        read_only(start),
        read_only(duration),
        skipped,
        None if base is None else read_only(base),
        _contacts(walk, kept),
        _sources(walk),
    )


def _sources(walk: Gait) -> dict[tuple[EventKind, Side], str]:
    """What the events of each kind and side come from."""
    found: dict[tuple[EventKind, Side], set[str]] = {}
    for event in walk.events:
        found.setdefault((event.kind, event.side), set()).add(event.source)
    return {key: " and ".join(sorted(filter(None, sources))) for key, sources in found.items()}


def _mean_source(source: str, n: int) -> str:
    """The source of a mean event: whether it was measured depends on what it is the mean of."""
    return ", ".join(filter(None, (source, f"mean of {n}")))


def _on_the_spot(flat: Array) -> Array:
    """Poses `(n, 4, 4)` of one cycle from entries `(n, 16)`: heading along x, without the even travel."""
    base = nearest_pose(flat.reshape(-1, 4, 4))
    c, s = mean_heading(base)
    base[:, :2] = np.array([[c, s], [-s, c]]) @ base[:, :2]
    share = np.linspace(0, 1, len(base))[:, None]
    base[:, :2, 3] -= share * (base[-1, :2, 3] - base[0, :2, 3])
    base[:, :2, 3] -= base[:-1, :2, 3].mean(axis=0)
    return base


def _contacts(walk: Gait, spans: Sequence[Stride]) -> dict[tuple[EventKind, Side], Array]:
    """Phases of the events of each kind and side, from the cycles that have one of them."""
    found: dict[tuple[EventKind, Side], Array] = {}
    for side in SIDES:
        for kind in EVENT_KINDS:
            times = np.array(times_of(walk.events, kind, side))
            inside = [(span, times[slice(*np.searchsorted(times, span[1:3]))]) for span in spans]
            phases = [(t[0] - span.start) / span.duration for span, t in inside if len(t) == 1]
            if phases:
                found[kind, side] = np.array(phases)
    return found


def _closed(y: Array) -> Array:
    """The samples `(points, ...)` of a cycle but the last one, its gap to the first spread over them all."""
    share = (np.arange(len(y) - 1) / (len(y) - 1)).reshape(-1, *(1,) * (y.ndim - 1))
    return np.asarray(y[:-1] - share * (y[-1] - y[0]))


def _why_none(walk: Gait, spans: tuple[Stride, ...], side: Side) -> str:
    """The objection to the first stride, or how many heel strikes there are."""
    if spans:
        return spans[0].why
    count = sum(event.side == side and event.kind == "heel_strike" for event in walk.events)
    return f"{count} heel strike{'s' * (count != 1)} of the {side} foot; 2 make a cycle"
