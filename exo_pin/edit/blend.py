"""Blends of two walks at equal phases: with a constant share, or as a transition from one to the other."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from exo_pin.anatomy.names import Side
from exo_pin.arguments import MOST_SAMPLES, number
from exo_pin.arrays import Array
from exo_pin.errors import GaitError
from exo_pin.gait import Event, Gait
from exo_pin.gait.rigid_poses import nearest_pose
from exo_pin.gait.time_series import at_phase

_LARGEST_WARP = 0.9
"""Largest relative change of a phase's rate by the time warp; at 1 the phase would run backwards."""

_ITERATIONS = 30
"""Of the fixed-point and Newton iterations for phases; each leaves a small part of the error before it."""


def blended(first: Gait, second: Gait, *, share: float = 0.5) -> Gait:
    """A walk between two periodic ones: every angle, the pelvis and the period mixed at equal phase.

    Phases count from the heel strikes where both walks have them, else from the starts of the cycles.

    Args:
        first: The walk at share 0.
        second: The walk at share 1.
        share: Of the second walk, between 0 and 1.

    Raises:
        GaitError: One of them is not periodic, or the share is not between 0 and 1.
    """
    number("share", share, least=0.0, most=1.0, error=GaitError)
    pair = _Pair.of(first, second)
    n = max(len(first), len(second))
    T = (1 - share) * first.duration + share * second.duration
    phase = np.arange(n) / n - pair.start
    q, base = pair.mixed(phase, np.full(n, share))
    events = tuple(
        dataclasses.replace(event, time=(pair.phase(event, share) + pair.start) % 1 * T)
        for event in (first if share < 0.5 else second).events
    )
    source = f"{first.source}; blended {share:g} with ({second.source})"
    return Gait(T * np.arange(n) / n, q, base=base, events=events, periodic=True, source=source)


def transitioned(
    first: Gait,
    second: Gait,
    *,
    cycles: float = 3.0,
    seconds: float | None = None,
    before: float = 2.0,
    after: float = 2.0,
) -> Gait:
    """Some cycles of one walk, a smooth transition, and some cycles of another one.

    The second walk's share grows from 0 to 1 as 10 s^3 - 15 s^4 + 6 s^5, and so does its share of the cycle's
    duration. Angles and pelvis are mixed at equal phases, counted from the heel strikes of both feet. The
    result has two continuous derivatives in time: angle, velocity and acceleration do not jump.

    Args:
        first: The walk at the start, from a left heel strike on; periodic.
        second: The walk at the end; periodic.
        cycles: Length of the transition in cycles.
        seconds: Length of the transition in time instead [s].
        before: Cycles of the first walk.
        after: Cycles of the second walk.

    Returns:
        A recording with events, evenly sampled.

    Raises:
        GaitError: A walk is not periodic, a length is not positive or too long, or heel strikes are too far
            apart.
    """
    pair = _Pair.of(first, second)
    T = (first.duration, second.duration)
    number("cycles", cycles, error=GaitError)
    over = cycles if seconds is None else 2 * number("seconds", seconds, error=GaitError) / sum(T)
    most = MOST_SAMPLES / (3 * max(len(first), len(second)))
    for name, value, least in (("transition", over, 1e-3), ("before", before, 0.0), ("after", after, 0.0)):
        number(f"{name} in cycles", value, least=least, most=most, error=GaitError)
    total = before + over + after

    def share(phase: Array) -> Array:
        s = np.clip((phase - before) / over, 0, 1)
        return np.asarray(s**3 * (10 - 15 * s + 6 * s**2))

    def clock(phase: Array) -> Array:
        s = np.clip((phase - before) / over, 0, 1)
        beyond = np.maximum(phase - before - over, 0)
        grown = over * s**4 * (2.5 - 3 * s + s**2) + beyond  # integral of the share
        return np.asarray(T[0] * phase + (T[1] - T[0]) * grown)

    end = float(clock(np.array([total]))[0])
    n = max(2, int(np.ceil(end / min(T[0] / len(first), T[1] / len(second)))) + 1)
    time = np.linspace(0, end, n)
    phase = time / end * total
    for _ in range(_ITERATIONS):  # Newton's method: the clock is smooth and strictly increasing
        phase = np.clip(phase - (clock(phase) - time) / (T[0] + (T[1] - T[0]) * share(phase)), 0, total)
    q, base = pair.mixed(phase, share(phase))
    events = tuple(event for event in _events(pair, share, clock, total) if event.time <= end)
    length = f"{over:g} cycles" if seconds is None else f"{seconds:g} s"
    source = f"{first.source}; over within {length} to ({second.source})"
    return Gait(time, q, base=base, events=events, source=source)


class _Pair(NamedTuple):
    """Two periodic walks whose phases are counted from a left heel strike.

    Attributes:
        walks: Both.
        starts: Phase of the left heel strike in each walk's own cycle.
        rights: Phase of the right heel strike after it; 0.5 for both where one is unknown.
    """

    walks: tuple[Gait, Gait]
    starts: tuple[float, float]
    rights: tuple[float, float]

    @classmethod
    def of(cls, first: Gait, second: Gait) -> _Pair:
        """Both walks with the phases of their heel strikes.

        Raises:
            GaitError: A walk is not periodic, or their right heel strikes are too far apart.
        """
        if not (first.periodic and second.periodic):
            raise GaitError(
                "only periodic gaits can be blended: a recording's mean cycle is one (edit --cycle)"
            )
        walks = (first, second)
        left, right = ([_strike(walk, side) for walk in walks] for side in ("left", "right"))
        starts = (0.0, 0.0) if left[0] is None or left[1] is None else (left[0], left[1])
        rights = (0.5, 0.5)
        if right[0] is not None and right[1] is not None and None not in left:
            rights = ((right[0] - starts[0]) % 1, (right[1] - starts[1]) % 1)
        pair = cls(walks, starts, rights)
        if abs(rights[0] - rights[1]) * np.pi / np.sin(np.pi * np.array(rights)).min() ** 2 > _LARGEST_WARP:
            raise GaitError(
                f"right heel strikes at {rights[0]:.0%} and {rights[1]:.0%} of the cycle are too far apart"
            )
        return pair

    @property
    def start(self) -> float:
        """Phase of the left heel strike in the first walk's cycle."""
        return self.starts[0]

    def mixed(self, phase: Array, share: Array) -> tuple[Array, Array | None]:
        """Angles `(k, 12)` and pelvis `(k, 4, 4)` at phases and shares `(k,)`."""
        weights = (1 - share)[:, None], share[:, None]
        own = [self._own(k, phase, share) for k in range(2)]
        q = sum(w * at_phase(walk.q, p) for w, walk, p in zip(weights, self.walks, own, strict=True))
        bases = [walk.base for walk in self.walks]
        if bases[0] is None or bases[1] is None:
            return np.asarray(q), None
        flat = sum(
            w * at_phase(base.reshape(-1, 16), p)
            for w, base, p in zip(weights, bases, own, strict=True)
            if base is not None
        )
        return np.asarray(q), nearest_pose(np.asarray(flat).reshape(-1, 4, 4))

    def phase(self, event: Event, share: float) -> float:
        """Phase of an event of one walk in the blend; unchanged if the other walk has no such event."""
        own = [self._of(event, k) for k in range(2)]
        if own[0] is None or own[1] is None:
            return own[0] or own[1] or 0.0
        return own[0] + share * ((own[1] - own[0] + 0.5) % 1 - 0.5)

    def _of(self, event: Event, k: int) -> float | None:
        """The phase of that kind of event in one of the walks."""
        walk = self.walks[k]
        for other in walk.events:
            if (other.kind, other.side) == (event.kind, event.side):
                return (other.time / walk.duration - self.starts[k]) % 1
        return None

    def _own(self, k: int, phase: Array, share: Array) -> Array:
        """The phase in a walk's own cycle, warped so that the right heel strikes of both walks coincide."""
        right = (1 - share) * self.rights[0] + share * self.rights[1]
        warp = (self.rights[k] - right) * (np.sin(np.pi * phase) / np.sin(np.pi * right)) ** 2
        return np.asarray(phase + warp + self.starts[k])


def _strike(walk: Gait, side: Side) -> float | None:
    """Phase of a foot's first heel strike, if the walk has one."""
    times = [e.time for e in walk.events if e.side == side and e.kind == "heel_strike"]
    return times[0] / walk.duration if times else None


def _events(
    pair: _Pair, share: Callable[[Array], Array], clock: Callable[[Array], Array], total: float
) -> list[Event]:
    """The events of the transition, where both walks have them."""
    found = []
    for event in pair.walks[0].events:
        for cycle in range(-1, int(total) + 2):
            at = np.array([float(cycle)])
            for _ in range(_ITERATIONS):
                at = np.array([cycle + pair.phase(event, float(share(at)[0]))])
            if 0 <= at[0] <= total:
                found.append(dataclasses.replace(event, time=float(clock(at)[0])))
    return sorted(found, key=lambda event: event.time)
