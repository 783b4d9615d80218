"""Spatiotemporal parameters of a walk: cadence, speed, lengths, width, phases, symmetry, with spread."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.names import EventKind, Side
from exo_pin.arguments import number, real
from exo_pin.arrays import Array
from exo_pin.errors import GaitError
from exo_pin.gait.event import SAME_TIME, Event, between, flat_times
from exo_pin.gait.strides import Stride
from exo_pin.gait.validation import check_time, frozen

_STATIONARY = 0.05
"""A ground slower than this [m/s] is at rest: no treadmill."""

Measure = tuple[str, ArrayLike]
"""Unit and the single values."""


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

    @staticmethod
    def of(values: ArrayLike, unit: str) -> Number:
        """The measure over its single values, one or more.

        Raises:
            GaitError: There is none, or one is not finite.
        """
        x = real("values", values, ("n",), error=GaitError)
        if not len(x):
            raise GaitError("a measure needs one value at least")
        sd = float(x.std(ddof=1)) if len(x) > 1 else float("nan")
        return Number(float(x.mean()), sd, len(x), unit)


def spatiotemporal(
    time: ArrayLike,
    heels: ArrayLike,
    events: Iterable[Event],
    *,
    pelvis: ArrayLike | None = None,
    spans: Sequence[Stride] | None = None,
    until: float = float("inf"),
) -> dict[str, Number]:
    """Numbers of a walk from where the heels are and when they touch; over ground or on a treadmill.

    Lengths are measured over the ground: where the resting feet move faster than the pelvis gets along (a
    treadmill, or a walk on the spot), their motion is the ground's and is taken off. Step length and width
    are along and across the stride that the step belongs to, so a gentle curve does not matter.

    Args:
        time: `(n,)` times of the samples [s].
        heels: `(n, 2, 2)` or `(n, 2, 3)` left and right heel in the world, z up [m]; NaN where it was not
            seen: what needs it is left out.
        events: Heel strikes and toe-offs.
        pelvis: `(n, 2)` where the pelvis is, if it moves in the world [m].
        spans: The strides to count (`exo_pin.gait.strides`); default: all between two strikes of a foot.
        until: What begins later is not counted: the end of the first round of a walk that repeats [s].

    Returns:
        `cadence`, `speed`, `stride_time`, `stride_length`, `step_width`, `double_support` (of a run:
        `flight`), and by side, as `left_stance`: `step_length`, `step_time`, `stance`, `swing`;
        `step_length_symmetry` and the like are `2 |L - R| / (L + R)` in per cent (Robinson 1987), 0 for equal
        sides, of the means, with the standard deviation of the single cycles' index. What is unknown is left
        out.

    Raises:
        GaitError: No foot with two heel strikes, or unusable arrays.
    """
    t, p = frozen(time, "time"), real("heels", heels, gaps=True, error=GaitError).copy()
    check_time(t, periodic=False)
    if not (isinstance(until, float) and until == math.inf):
        number("until", until, error=GaitError)
    if p.ndim != 3 or p.shape[:2] != (len(t), 2) or p.shape[2] not in (2, 3):
        raise GaitError(f"heels have shape {p.shape}, expected ({len(t)}, 2, 3)")
    walk = _Walk(t, p, events)
    if spans is None:
        spans = [Stride(side, *ab) for side in SIDES for ab in pairwise(walk.times("heel_strike", side))]
    if not spans:
        raise GaitError("no gait cycles found: no foot strikes the ground twice")
    counted = [span for span in spans if span.start < until - SAME_TIME]
    way = None if pelvis is None else real("pelvis", pelvis, (len(t), 2), error=GaitError)
    ground = _ground(walk, way)
    paths = _paths(walk, spans, ground)
    length = np.array([np.linalg.norm(paths[span]) for span in counted])
    duration = np.array([span.duration for span in counted])
    measures = {
        "cadence": ("steps/min", 120 / duration),
        "speed": ("m/s", length / duration),
        "stride_time": ("s", duration),
        "stride_length": ("m", length),
        **_steps(walk, paths, ground, until),
        **_phases(walk, counted),
    }
    known = {name: (unit, _known(values)) for name, (unit, values) in measures.items()}
    out = {name: Number.of(values, unit) for name, (unit, values) in known.items() if len(values)}
    return out | _symmetry({name: values for name, (_, values) in known.items() if len(values)})


def ground_velocity(
    time: ArrayLike, heels: ArrayLike, events: Iterable[Event], pelvis: ArrayLike | None = None
) -> Array:
    """Velocity `(2,)` of the ground [m/s]: 0 over ground, that of the resting feet on a treadmill.

    Args:
        time: `(n,)` [s].
        heels: `(n, 2, 2)` or `(n, 2, 3)` left and right heel in the world, z up [m].
        events: Heel strikes and toe-offs.
        pelvis: `(n, 2)` where the pelvis is, if it moves in the world [m].
    """
    walk = _Walk(np.asarray(time, dtype=float), np.asarray(heels, dtype=float), events)
    return _ground(walk, None if pelvis is None else np.asarray(pelvis, dtype=float))


class _Walk:
    """Paths of the heels and times of the events, by side."""

    def __init__(self, time: Array, heels: Array, events: Iterable[Event]) -> None:
        self.time = time
        self.events = sorted(events, key=lambda event: event.time)
        self._paths = {side: [heels[:, k, axis].copy() for axis in range(2)] for k, side in enumerate(SIDES)}
        self._times: dict[tuple[str, str], list[float]] = {}
        for event in self.events:
            self._times.setdefault((event.kind, event.side), []).append(event.time)

    def times(self, kind: EventKind, side: Side) -> Sequence[float]:
        """Times of the events of a kind and side, sorted [s]."""
        return self._times.get((kind, side), [])

    def at(self, side: Side, times: Sequence[float] | Array) -> Array:
        """Horizontal positions of the heel at m times [s], `(m, 2)` [m]."""
        return np.stack([np.interp(times, self.time, path) for path in self._paths[side]], axis=-1)


def _paths(walk: _Walk, spans: Sequence[Stride], ground: Array) -> dict[Stride, Array]:
    """From a foot's strike to its next one over the ground, `(2,)` [m], of each span."""
    paths: dict[Stride, Array] = {}
    for side in SIDES:
        mine = [span for span in spans if span.side == side]
        moved = walk.at(side, [x.end for x in mine]) - walk.at(side, [x.start for x in mine])
        paths |= zip(mine, moved - np.outer([x.duration for x in mine], ground), strict=True)
    return paths


def _ground(walk: _Walk, pelvis: Array | None) -> Array:
    """Velocity `(2,)` of the ground [m/s]: the resting feet's, 0 where it is slow or the person gets along.

    The sides have the same weight, or one foot's drift would turn the walk's direction.
    """
    resting = []
    for side in SIDES:
        start, end = np.array(list(flat_times(walk.events, side))).reshape(-1, 2).T
        moves = (walk.at(side, end) - walk.at(side, start)) / (end - start)[:, None]
        moves = moves[np.isfinite(moves).all(axis=1)]
        resting += [np.median(moves, axis=0)] if len(moves) else []
    velocity = np.mean(resting, axis=0) if resting else np.zeros(2)
    along = np.zeros(2)
    if pelvis is not None:
        along = (pelvis[-1] - pelvis[0]) / (walk.time[-1] - walk.time[0])
    slower = np.linalg.norm(velocity) < max(_STATIONARY, float(np.linalg.norm(along)))
    return np.zeros(2) if slower else velocity


def _steps(walk: _Walk, paths: Mapping[Stride, Array], ground: Array, until: float) -> dict[str, Measure]:
    """Lengths, times and widths from one foot's strike to the other's."""
    strikes = [event for event in walk.events if event.kind == "heel_strike"]
    times_by_side = {side: walk.times("heel_strike", side) for side in SIDES}
    places = {
        (side, t): place
        for side, at in times_by_side.items()
        for t, place in zip(at, walk.at(side, at), strict=True)
    }
    lengths: dict[str, list[float]] = {side: [] for side in SIDES}
    times: dict[str, list[float]] = {side: [] for side in SIDES}
    widths = []
    begins = {(span.side, span.start): span for span in paths}
    ends = {(span.side, span.end): span for span in paths}
    for a, b in pairwise(strikes):
        around = [span for span in (begins.get((a.side, a.time)), ends.get((b.side, b.time))) if span]
        if a.side == b.side or not around or a.time > until - SAME_TIME:
            continue
        courses = [paths[span] for span in around]
        course = sum((path for path in courses if np.isfinite(path).all()), np.zeros(2))
        forward = course / (float(np.linalg.norm(course)) or np.nan)
        step = places[b.side, b.time] - places[a.side, a.time] - ground * (b.time - a.time)
        lengths[b.side].append(float(step @ forward))
        times[b.side].append(b.time - a.time)
        widths.append(abs(float(step[1] * forward[0] - step[0] * forward[1])))
    out: dict[str, Measure] = {"step_width": ("m", widths)} if widths else {}
    for side in SIDES:
        if lengths[side]:
            out[f"{side}_step_length"] = ("m", lengths[side])
            out[f"{side}_step_time"] = ("s", times[side])
    return out


def _phases(walk: _Walk, spans: Sequence[Stride]) -> dict[str, Measure]:
    """Stance, swing and double support, or a run's flight, in per cent of the stride."""
    shares: dict[str, list[float]] = {}
    for side, a, b, _ in spans:
        offs = between(walk.times("toe_off", side), a, b)
        if len(offs) != 1:
            continue
        stance = 100 * (offs[0] - a) / (b - a)
        shares.setdefault(f"{side}_stance", []).append(stance)
        shares.setdefault(f"{side}_swing", []).append(100 - stance)
        other = SIDES[1 - SIDES.index(side)]
        ends = between(walk.times("toe_off", other), a, offs[0])
        starts = between(walk.times("heel_strike", other), a, offs[0])
        flight = _flight(walk, other, a, offs[0], b)
        if flight is not None:
            shares.setdefault("flight", []).append(100 * flight / (b - a))
        if len(ends) == len(starts) == 1:
            both = (ends[0] - a) + (offs[0] - starts[0])
            shares.setdefault("double_support", []).append(100 * both / (b - a))
    return {name: ("%", values) for name, values in shares.items()}


def _flight(walk: _Walk, other: Side, a: float, off: float, b: float) -> float | None:
    """How long both feet are in the air in a stride from a to b whose foot leaves at `off` [s]; None: not."""
    strikes, offs = (between(walk.times(kind, other), off, b) for kind in ("heel_strike", "toe_off"))
    if not (len(strikes) == len(offs) == 1 and strikes[0] < offs[0]):
        return None
    return (strikes[0] - off) + (b - offs[0])


def _symmetry(values: Mapping[str, Array]) -> dict[str, Number]:
    """How much the sides differ; the spread is that of the index from cycle to cycle, signs kept."""
    out = {}
    for name in ("step_length", "step_time", "stance"):
        left, right = (values.get(f"{side}_{name}") for side in SIDES)
        if left is None or right is None or not left.mean() + right.mean() > 0:
            continue
        n = min(len(left), len(right))
        index = 200 * abs(left.mean() - right.mean()) / (left.mean() + right.mean())
        each = Number.of(200 * (left[:n] - right[:n]) / (left[:n] + right[:n]), "%")
        out[f"{name}_symmetry"] = Number(float(index), each.sd, n, "%")
    return out


def _known(values: ArrayLike) -> Array:
    """The values that are known, without NaN."""
    x = np.asarray(values, dtype=float)
    return np.asarray(x[np.isfinite(x)])
