"""A walk cut into its cycles, each brought to 101 points: mean, spread, and cycles that stand out."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from exo_pin.anatomy import SIDES
from exo_pin.errors import GaitError, UnknownNameError
from exo_pin.gait import curves
from exo_pin.gait.checks import read_only
from exo_pin.gait.strides import Stride, strides, unrolled
from exo_pin.gait.walk import Gait

Array = NDArray[np.float64]

POINTS = 101
"""0, 1, ... 100 % of the cycle."""

ODD = 3.0
"""A cycle that lies this many times further from the median cycle than cycles usually do stands out ..."""

ODD_ANGLE = np.radians(3.0)
"""... if it is also this far off [rad, rms over cycle and joints]."""


@dataclass(frozen=True, eq=False)
class Cycles:
    """The cycles of one foot, from heel strike to its next heel strike.

    Attributes:
        side: Whose heel strikes cut the walk.
        q: `(k, points, 12)` joint angles of both legs, in the order of `JOINTS` [rad].
        start: `(k,)` heel strikes that begin the cycles [s].
        duration: `(k,)` stride times [s].
        skipped: Strides that were left out, with the reasons: pauses, turns, missed events.
    """

    side: str
    q: Array
    start: Array
    duration: Array
    skipped: tuple[Stride, ...] = ()

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
        odd = (away > ODD * np.median(away)) & (away > ODD_ANGLE)
        return tuple(int(k) for k in np.flatnonzero(odd))

    def average(self, source: str = "") -> Gait:
        """The mean cycle as a periodic gait of `points - 1` samples; ends that do not meet are closed.

        The gap between 100 % and 0 % is spread evenly over the cycle.
        """
        gap = self.mean[-1] - self.mean[0]
        q = self.mean[:-1] - gap * (np.arange(len(self.mean) - 1) / (len(self.mean) - 1))[:, None]
        T = float(self.duration.mean())
        time = T * np.arange(len(q)) / len(q)
        return Gait(time, q, periodic=True, source=source or f"mean of {len(self)} {self.side} cycles")


def cycles(gait: Gait, side: str = "left", *, points: int = POINTS) -> Cycles:
    """Cut a walk at the heel strikes of one foot; every cycle gets the same number of points.

    A periodic gait is one cycle and more: it is followed around its end.

    Raises:
        GaitError: Fewer than two heel strikes of that foot, or no stride of a walk between them.
        UnknownNameError: There is no such side.
    """
    if side not in SIDES:
        raise UnknownNameError("side", side, SIDES)
    walk = unrolled(gait)
    spans = strides(walk, side)
    if gait.periodic:  # as many cycles as it has strikes, each followed around the end
        spans = tuple(span for span in spans if span.start < gait.duration * (1 - 1e-9))
    kept = [span for span in spans if not span.why]
    if not kept:
        raise GaitError(f"no gait cycles found: {_why_none(walk, spans, side)}")
    q = [
        curves.resampled(walk.time, walk.q, np.linspace(span.start, span.end, points), periodic=False)
        for span in kept
    ]
    start, duration = (np.array([getattr(span, name) for span in kept]) for name in ("start", "duration"))
    skipped = tuple(span for span in spans if span.why)
    return Cycles(side, read_only(np.array(q)), read_only(start), read_only(duration), skipped)


def _why_none(walk: Gait, spans: tuple[Stride, ...], side: str) -> str:
    """What speaks against every stride."""
    if spans:
        return spans[0].why
    count = sum(event.side == side and event.kind == "heel_strike" for event in walk.events)
    return f"{count} heel strike{'s' * (count != 1)} of the {side} foot; 2 make a cycle"
