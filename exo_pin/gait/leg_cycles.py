"""Each leg's joint angles over its own gait cycle: mean, spread, or an estimate from a single step."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from exo_pin.anatomy import JOINTS, MOVEMENTS, SIDES
from exo_pin.anatomy.names import Side
from exo_pin.arrays import Array
from exo_pin.errors import GaitError
from exo_pin.gait.cycles import CYCLE_POINTS, cycles
from exo_pin.gait.gait import Gait
from exo_pin.gait.half_strides import stride_estimate
from exo_pin.gait.strides import strides
from exo_pin.short_repr import short_repr


@dataclass(frozen=True, eq=False)
class LegCycle:
    """One leg's angles over its own cycle, heel strike at 0 %.

    Attributes:
        side: Which leg.
        percent: `(m,)` of the cycle; NaN separates two pieces of the curve.
        q: `(m, 6)` angles in the order of `MOVEMENTS` [rad].
        sd: `(m, 6)` standard deviation over the cycles [rad]; None for fewer than two.
        stance: Toe-off in percent of the cycle; NaN if unknown.
        note: How the curve was made.
        each: `(k, m, 6)` angles of each of k cycles [rad]; None where there is no whole one, or it repeats.
    """

    side: Side
    percent: Array
    q: Array
    sd: Array | None
    stance: float
    note: str
    each: Array | None = None

    __repr__ = short_repr


def leg_cycles(gait: Gait) -> tuple[LegCycle, ...]:
    """The cycle of each leg; a leg without a heel strike is left out.

    A leg without a whole cycle is placed in the cycle by one heel strike and an estimated stride time
    (`exo_pin.gait.half_strides`); its note says so.
    """
    found = (_leg(gait, side) for side in SIDES)
    return tuple(leg for leg in found if leg is not None)


def cycle_times(gait: Gait, side: Side) -> Array:
    """Times `(k, 101)` [s] at 0, 1 .. 100 % of each of a foot's k whole cycles; k may be 0."""
    whole = [stride for stride in strides(gait, side) if not stride.why]
    return np.array([np.linspace(x.start, x.end, CYCLE_POINTS) for x in whole]).reshape(-1, CYCLE_POINTS)


def mean_over_cycles(gait: Gait, times: Array, values: Array) -> Array:
    """A series of a walk over a foot's cycle: the mean of its cycles `(101,)`, linear between samples.

    Args:
        gait: The walk.
        times: `(k, 101)` of `cycle_times`, k at least 1 [s].
        values: `(n,)` the series at the samples of the walk, in any unit.
    """
    period = gait.duration if gait.periodic else None
    return np.asarray(np.interp(times, gait.time, values, period=period).mean(axis=0))


def _leg(gait: Gait, side: Side) -> LegCycle | None:
    columns = [JOINTS.index(f"{side}_{movement}") for movement in MOVEMENTS]
    try:
        found = cycles(gait, side)
    except GaitError:
        return _estimated(gait, side, columns)
    several = len(found) > 1 and not gait.periodic
    whole = "one cycle" if len(found) == 1 else f"mean of {len(found)} cycles, band: 1 sd between them"
    return LegCycle(
        side,
        found.percent,
        found.mean[:, columns],
        found.sd[:, columns] if several else None,
        _stance(gait, side, float(found.duration.mean())),
        f"{side}: {'one cycle of a periodic walk' if gait.periodic else whole}",
        None if gait.periodic else found.q[:, :, columns],
    )


def _estimated(gait: Gait, side: Side, columns: list[int]) -> LegCycle | None:
    """The whole recording, placed in the cycle by one heel strike and an estimated stride time."""
    estimate = stride_estimate(gait, side)
    if estimate is None:
        return None
    share = (gait.time - estimate.strike) / estimate.duration
    percent, q = 100 * (share - np.floor(share)), gait.q[:, columns]
    breaks = np.flatnonzero(np.diff(percent) < 0) + 1
    return LegCycle(
        side,
        np.insert(percent, breaks, np.nan),
        np.insert(q, breaks, np.nan, axis=0),
        None,
        _stance(gait, side, estimate.duration),
        f"{side}: {estimate}",
    )


def _stance(gait: Gait, side: Side, stride: float) -> float:
    """Toe-off in percent of the stride: mean over the heel strikes that a toe-off follows."""
    mine = [(e.time, e.kind) for e in gait.events if e.side == side]
    if gait.periodic:
        mine += [(t + gait.duration, kind) for t, kind in mine]
    shares = [
        (b - a) / stride
        for (a, first), (b, second) in pairwise(mine)
        if (first, second) == ("heel_strike", "toe_off")
    ]
    return 100 * float(np.mean(shares)) if shares else float("nan")
