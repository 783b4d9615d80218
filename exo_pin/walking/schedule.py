"""The schedule of a walk: phases with both feet on the ground and with one, and the events between them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from exo_pin.arrays import Array, Index
from exo_pin.gait import Event
from exo_pin.walking.footsteps import Footsteps

PLANNED = "planned"
"""Source of a planned walk's events."""


class Phase(NamedTuple):
    """A part of the walk during which the same feet stand.

    Attributes:
        start: [s].
        end: [s].
        step: Index of the step that is taken; None while both feet stand.
        right: Share of the weight on the right foot at the start and at the end.
    """

    start: float
    end: float
    step: int | None
    right: tuple[float, float]


class PhaseSamples(NamedTuple):
    """The samples of a walk that lie in one phase.

    Attributes:
        phase: The phase.
        samples: Which ones.
        passed: How much of the phase has passed at each of them, 0 to 1.
    """

    phase: Phase
    samples: slice
    passed: Array


def phases(walk: Footsteps, rest: float) -> tuple[Phase, ...]:
    """All phases in order: rest, the weight to the first standing foot, the steps, the weight back, rest.

    Before the first and after the last step the weight moves for a whole step time, since it starts from
    rest and comes to rest.

    Args:
        walk: The footsteps.
        rest: Time of standing still before and after [s].
    """
    double = walk.double_support * walk.step_time
    single = walk.step_time - double
    found, t, right = [Phase(0.0, rest, None, (0.5, 0.5))], rest, 0.5
    for k, step in enumerate(walk.steps):
        standing = 1.0 if step.side == "left" else 0.0
        shift = double if k else walk.step_time
        found.append(Phase(t, t + shift, None, (right, standing)))
        found.append(Phase(t + shift, t + shift + single, k, (standing, standing)))
        t, right = found[-1].end, standing
    found.append(Phase(t, t + walk.step_time, None, (right, 0.5)))
    t = found[-1].end
    return (*found, Phase(t, t + rest, None, (0.5, 0.5)))


def events(walk: Footsteps, plan: tuple[Phase, ...]) -> tuple[Event, ...]:
    """A toe-off where each step begins, a heel strike where it ends; a flat foot lands as a whole."""
    found: list[Event] = []
    for phase in plan:
        if phase.step is not None:
            side = walk.steps[phase.step].side
            found.append(Event(phase.start, "toe_off", side, PLANNED))
            found.append(Event(phase.end, "heel_strike", side, PLANNED))
    return tuple(found)


def sample_times(plan: tuple[Phase, ...], rate: float) -> Array:
    """`(n,)` even times from the start to the end, at about that rate [s]."""
    end = plan[-1].end
    return np.linspace(0.0, end, round(end * rate) + 1)


def shares(parts: list[PhaseSamples], n: int) -> Array:
    """`(n, 2)` share of the weight on the left and on the right foot: s^2 (3 - 2 s) from foot to foot."""
    right = np.empty(n)
    for part in parts:
        before, after = part.phase.right
        s = part.passed
        right[part.samples] = before + (after - before) * s * s * (3.0 - 2.0 * s)
    return np.stack([1.0 - right, right], axis=1)


def sampled(plan: tuple[Phase, ...], time: Array) -> list[PhaseSamples]:
    """The samples of each phase."""
    cuts = [*np.searchsorted(time, [phase.start for phase in plan]).tolist(), len(time)]
    out = []
    for phase, a, b in zip(plan, cuts, cuts[1:], strict=False):
        passed = (time[a:b] - phase.start) / (phase.end - phase.start)
        out.append(PhaseSamples(phase, slice(a, b), np.clip(passed, 0.0, 1.0)))
    return out


def steps_at(plan: tuple[Phase, ...], time: Array) -> Index:
    """`(n,)` the step that is taken at each time, or taken next; the last one after it."""
    ends = [phase.end for phase in plan if phase.step is not None]
    return np.minimum(np.searchsorted(ends, time), len(ends) - 1)
