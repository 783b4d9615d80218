"""The numbers of a walk: cadence, speed, lengths, width, phases, symmetry, each with its spread."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from exo_pin.anatomy import SIDES
from exo_pin.errors import GaitError
from exo_pin.gait.checks import check_time, frozen
from exo_pin.gait.event import Event

Array = NDArray[np.float64]

FLAT = (0.2, 0.5)
"""Part of the stance in which the foot rests on the ground: after the heel's roll, before it lifts."""

STILL = 0.05
"""A ground that seems to move slower than this [m/s] stands still."""


class Number(NamedTuple):
    """One measure over all its occurrences.

    Attributes:
        mean: Mean.
        sd: Standard deviation (n - 1); NaN for one occurrence.
        n: How many.
        unit: Its unit.
    """

    mean: float
    sd: float
    n: int
    unit: str


class Range(NamedTuple):
    """What is usual.

    Attributes:
        low: Lower end.
        high: Upper end.
        unit: Its unit.
    """

    low: float
    high: float
    unit: str


NORMAL_SOURCE = "healthy adults at free speed, customary clinical ranges (speed to width: 18 to 29 years)"
NORMAL: Mapping[str, Range] = {
    "speed": Range(1.20, 1.65, "m/s"),
    "cadence": Range(99.0, 113.0, "steps/min"),
    "stride_length": Range(1.35, 1.66, "m"),
    "step_width": Range(0.08, 0.135, "m"),
    "stance": Range(58.0, 64.0, "%"),
    "double_support": Range(16.0, 26.0, "%"),
}
"""Ranges to compare an adult with; children walk with shorter and quicker steps."""


def spatiotemporal(time: ArrayLike, heels: ArrayLike, events: Iterable[Event]) -> dict[str, Number]:
    """Numbers of a walk from where the heels are and when they touch; over ground or on a treadmill.

    Lengths are measured over the ground: where the resting foot moves evenly (a treadmill, or a walk on the
    spot), that motion is the ground's and is taken off. Step length and width are along and across the
    direction of the walk, from the other foot's last heel strike to this one's.

    Args:
        time: `(n,)` [s].
        heels: `(n, 2, 2)` or `(n, 2, 3)` left and right heel in the world, z up [m].
        events: Heel strikes and toe-offs.

    Returns:
        `cadence`, `speed`, `stride_time`, `stride_length`, `step_width`, `double_support`, and by side, as
        `left_stance`: `step_length`, `step_time`, `stance`, `swing`; `step_length_symmetry` and the like are
        2 |L - R| / (L + R) in per cent (Robinson 1987), 0 for equal sides. What cannot be told is left out.

    Raises:
        GaitError: No foot with two heel strikes, or unusable arrays.
    """
    t, p = frozen(time, "time"), frozen(heels, "heels")
    check_time(t, periodic=False)
    if p.ndim != 3 or p.shape[:2] != (len(t), 2) or p.shape[2] not in (2, 3):
        raise GaitError(f"heels have shape {p.shape}, expected ({len(t)}, 2, 3)")
    walk = _Walk(t, p[:, :, :2], sorted(events, key=lambda event: event.time))
    strides = [(side, a, b) for side in SIDES for a, b in pairwise(walk.times("heel_strike", side))]
    if not strides:
        raise GaitError("no gait cycles found: no foot strikes the ground twice")
    ground = walk.ground()
    path = np.array([walk.at(side, b) - walk.at(side, a) - ground * (b - a) for side, a, b in strides])
    length, duration = np.linalg.norm(path, axis=1), np.array([b - a for _, a, b in strides])
    total = path.sum(axis=0)
    forward = total / max(float(np.linalg.norm(total)), 1e-9)
    out = {
        "cadence": _number(120 / duration, "steps/min"),
        "speed": _number(length / duration, "m/s"),
        "stride_time": _number(duration, "s"),
        "stride_length": _number(length, "m"),
    }
    out |= _steps(walk, ground, forward) | _phases(walk, strides)
    return out | _symmetry(out)


class _Walk(NamedTuple):
    time: Array
    heels: Array
    events: Sequence[Event]

    def times(self, kind: str, side: str) -> list[float]:
        """When the foot does that."""
        return [event.time for event in self.events if (event.kind, event.side) == (kind, side)]

    def at(self, side: str, t: float) -> Array:
        """Where the heel is, `(2,)`."""
        path = self.heels[:, SIDES.index(side)]
        return np.array([np.interp(t, self.time, path[:, k]) for k in range(2)])

    def ground(self) -> Array:
        """Velocity `(2,)` of the ground [m/s]: of the feet while they rest, 0 where that is slow."""
        rest = []
        for side in SIDES:
            for strike, off in _spans(self, "heel_strike", "toe_off", side):
                a, b = (strike + part * (off - strike) for part in FLAT)
                rest.append((self.at(side, b) - self.at(side, a)) / (b - a))
        velocity = np.median(rest, axis=0) if rest else np.zeros(2)
        return velocity if np.linalg.norm(velocity) > STILL else np.zeros(2)


def _spans(walk: _Walk, first: str, second: str, side: str) -> list[tuple[float, float]]:
    """From each first kind of event to the foot's next event, where that is of the second kind."""
    mine = [event for event in walk.events if event.side == side]
    return [(a.time, b.time) for a, b in pairwise(mine) if (a.kind, b.kind) == (first, second)]


def _steps(walk: _Walk, ground: Array, forward: Array) -> dict[str, Number]:
    """Lengths, times and widths from one foot's strike to the other's."""
    strikes = [event for event in walk.events if event.kind == "heel_strike"]
    lengths: dict[str, list[float]] = {side: [] for side in SIDES}
    times: dict[str, list[float]] = {side: [] for side in SIDES}
    widths = []
    for a, b in pairwise(strikes):
        if a.side == b.side:
            continue
        step = walk.at(b.side, b.time) - walk.at(a.side, a.time) - ground * (b.time - a.time)
        lengths[b.side].append(float(step @ forward))
        times[b.side].append(b.time - a.time)
        widths.append(abs(float(step[1] * forward[0] - step[0] * forward[1])))
    out = {"step_width": _number(widths, "m")} if widths else {}
    for side in SIDES:
        if lengths[side]:
            out[f"{side}_step_length"] = _number(lengths[side], "m")
            out[f"{side}_step_time"] = _number(times[side], "s")
    return out


def _phases(walk: _Walk, strides: Sequence[tuple[str, float, float]]) -> dict[str, Number]:
    """Stance, swing and double support in per cent of the stride."""
    shares: dict[str, list[float]] = {}
    for side, a, b in strides:
        offs = [t for t in walk.times("toe_off", side) if a < t < b]
        if len(offs) != 1:
            continue
        stance = 100 * (offs[0] - a) / (b - a)
        shares.setdefault(f"{side}_stance", []).append(stance)
        shares.setdefault(f"{side}_swing", []).append(100 - stance)
        other = SIDES[1 - SIDES.index(side)]
        ends = [t for t in walk.times("toe_off", other) if a < t < offs[0]]
        starts = [t for t in walk.times("heel_strike", other) if a < t < offs[0]]
        if len(ends) == len(starts) == 1:
            both = (ends[0] - a) + (offs[0] - starts[0])
            shares.setdefault("double_support", []).append(100 * both / (b - a))
    return {name: _number(values, "%") for name, values in shares.items()}


def _symmetry(numbers: Mapping[str, Number]) -> dict[str, Number]:
    out = {}
    for name in ("step_length", "step_time", "stance"):
        left, right = (numbers.get(f"{side}_{name}") for side in SIDES)
        if left and right and left.mean + right.mean > 0:
            index = 200 * abs(left.mean - right.mean) / (left.mean + right.mean)
            out[f"{name}_symmetry"] = Number(index, float("nan"), 1, "%")
    return out


def _number(values: ArrayLike, unit: str) -> Number:
    x = np.asarray(values, dtype=float)
    sd = float(x.std(ddof=1)) if len(x) > 1 else float("nan")
    return Number(float(x.mean()), sd, len(x), unit)


def against_normal(numbers: Mapping[str, Number]) -> dict[str, str]:
    """Each number that has a usual range: `within`, `below` or `above` it; the side is left aside."""
    verdicts = {}
    for name, number in numbers.items():
        usual = NORMAL.get(name.removeprefix("left_").removeprefix("right_"))
        if usual is not None:
            below, above = number.mean < usual.low, number.mean > usual.high
            verdicts[name] = "below" if below else "above" if above else "within"
    return verdicts
