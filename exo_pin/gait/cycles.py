"""A walk cut into its cycles, each brought to 101 points: mean, spread, and cycles that stand out."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from exo_pin.anatomy import SIDES
from exo_pin.errors import GaitError, UnknownNameError
from exo_pin.gait import curves
from exo_pin.gait.checks import read_only
from exo_pin.gait.walk import Gait

Array = NDArray[np.float64]

POINTS = 101
"""0, 1, ... 100 % of the cycle."""

ODD = 3.0
"""A cycle that lies this many times further from the median cycle than cycles usually do stands out ..."""

ODD_ANGLE = np.radians(3.0)
"""... if it is also this far off [rad, rms over cycle and joints]."""

LONGEST = 3.0
"""A stride longer than this many median strides holds a pause or a missed event."""


@dataclass(frozen=True, eq=False)
class Cycles:
    """The cycles of one foot, from heel strike to its next heel strike.

    Attributes:
        side: Whose heel strikes cut the walk.
        q: `(k, points, 12)` joint angles of both legs, in the order of `JOINTS` [rad].
        start: `(k,)` heel strikes that begin the cycles [s].
        duration: `(k,)` stride times [s].
        skipped: Times [s] of heel strikes whose stride was left out: longer than three median strides.
    """

    side: str
    q: Array
    start: Array
    duration: Array
    skipped: tuple[float, ...] = ()

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
        GaitError: Fewer than two heel strikes of that foot.
        UnknownNameError: There is no such side.
    """
    if side not in SIDES:
        raise UnknownNameError("side", side, SIDES)
    walk = unrolled(gait)
    strikes = [e.time for e in walk.events if e.side == side and e.kind == "heel_strike"]
    if gait.periodic:  # as many cycles as it has strikes, each followed around the end
        strikes = strikes[: sum(t < gait.duration * (1 - 1e-9) for t in strikes) + 1]
    if len(strikes) < 2:
        raise GaitError(
            f"no gait cycles found: {len(strikes)} heel strikes of the {side} foot; 2 make a cycle"
        )
    strides = np.diff(strikes)
    kept = strides <= LONGEST * np.median(strides)
    pairs = [pair for pair, keep in zip(pairwise(strikes), kept, strict=True) if keep]
    q = [curves.resampled(walk.time, walk.q, np.linspace(a, b, points), periodic=False) for a, b in pairs]
    skipped = tuple(t for t, keep in zip(strikes, kept, strict=False) if not keep)
    start = np.array([a for a, _ in pairs])
    return Cycles(side, read_only(np.array(q)), read_only(start), read_only(strides[kept]), skipped)


def unrolled(gait: Gait) -> Gait:
    """A periodic gait as a recording of a cycle and a bit: every heel strike is followed by another one."""
    if not gait.periodic:
        return gait
    twice = gait.repeated(3)
    T = gait.duration
    keep = twice.time <= 2 * T
    base = None if twice.base is None else twice.base[keep]
    end = float(twice.time[keep][-1])
    events = tuple(event for event in twice.events if event.time <= end)
    return Gait(twice.time[keep], twice.q[keep], base=base, events=events, source=gait.source)
