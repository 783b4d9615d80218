"""Which joints are worth their motor: every choice of the six movements of a leg, and what it loses."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import reduce
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np

from exo_pin.anatomy import FEET, MOVEMENTS, Body
from exo_pin.arrays import Array
from exo_pin.compare.best_motion import BETTER, SWEEPS, Walk, corners, sole_targets, walk
from exo_pin.devices import movement_of
from exo_pin.gait import Gait
from exo_pin.ik.least_squares.subtree_kernel import settle
from exo_pin.kinematics import poses

SAMPLES = 25
"""Samples of a periodic gait that the study looks at."""

_WORTH_IT = 1e-6  # a choice whose loss falls by less is not asked again [m]

Subset = frozenset[str]
Progress = Callable[[Iterable[int]], Iterable[int]]


@dataclass(frozen=True, eq=False)
class Worth:
    """What every choice of movements, the same on both legs, loses of a walk.

    Attributes:
        walk: The recorded walk.
        losses: By the movements that are driven, all 2^6 choices: root mean square distance of the soles'
            corners from the recorded ones [m], the best sample by sample within the joint limits (speeds are
            not asked), the pelvis as recorded.
    """

    walk: Walk
    losses: dict[Subset, float]

    @property
    def leave_one_out(self) -> dict[str, float]:
        """What is lost when a movement alone is locked [m], the dearest first."""
        full = frozenset(MOVEMENTS)
        return _falling({m: self.losses[full - {m}] for m in MOVEMENTS})

    @property
    def add_one_in(self) -> list[tuple[str, float]]:
        """Greedy: the movement that helps most is added first; each with what is then still lost [m]."""
        chosen: Subset = frozenset()
        steps = []
        while len(chosen) < len(MOVEMENTS):
            rest = [m for m in MOVEMENTS if m not in chosen]
            added = min(rest, key=lambda m: self.losses[chosen | {m}])
            chosen = chosen | {added}
            steps.append((added, self.losses[chosen]))
        return steps

    @property
    def pareto(self) -> list[tuple[int, tuple[str, ...], float]]:
        """The choice that loses least for each number of motors: motors, movements, loss [m]."""
        front = []
        for count in range(len(MOVEMENTS) + 1):
            some = [chosen for chosen in self.losses if len(chosen) == count]
            chosen = min(some, key=lambda c: self.losses[c])
            front.append((2 * count, _in_order(chosen), self.losses[chosen]))
        return front

    def facts(self) -> dict[str, Any]:
        """Plain values for JSON."""
        return {
            "gait": {"source": self.walk.gait.source, "samples": len(self.walk.gait)},
            "leave_one_out_mm": {m: 1e3 * loss for m, loss in self.leave_one_out.items()},
            "add_one_in": [{"movement": m, "left_mm": 1e3 * loss} for m, loss in self.add_one_in],
            "pareto": [
                {"motors": motors, "movements": chosen, "sole_rms_mm": 1e3 * loss}
                for motors, chosen, loss in self.pareto
            ],
            "all": [
                {"movements": _in_order(chosen), "motors": 2 * len(chosen), "sole_rms_mm": 1e3 * loss}
                for chosen, loss in self.losses.items()
            ],
        }


def worth(gait: Gait, body: Body | None = None, *, progress: Progress = iter) -> Worth:
    """Try every choice of movements on a walk.

    A locked joint is one whose limits are both zero, so that the samples of all choices of the same size are
    solved together. Each starts from the plain copy, from what the best choice with one movement less
    reached, and from its neighbours' answers, and keeps the best: a further joint never costs.

    Args:
        gait: The walk; a periodic one is taken at `SAMPLES` samples.
        body: Who wears it; `Body.from_stature()` if left out.
        progress: Wraps the numbers of movements, e.g. in a progress bar.
    """
    recorded = walk(gait.resampled(SAMPLES) if gait.periodic and len(gait) > SAMPLES else gait, body)
    found: dict[Subset, _Found] = {}
    for count in progress(range(len(MOVEMENTS) + 1)):
        choices = [frozenset(chosen) for chosen in combinations(MOVEMENTS, count)]
        starts = [[_copy(recorded)] * len(choices)]
        if count:
            starts.append([min((found[c - {m}] for m in c), key=lambda f: f.loss).q for c in choices])
        found.update(zip(choices, _agreed(recorded, choices, starts), strict=True))
    return Worth(recorded, {chosen: result.loss for chosen, result in found.items()})


class _Found(NamedTuple):
    """Configurations (n, 12), and by sample the mean squared miss of the soles' corners (n,) [m^2]."""

    q: Array
    squares: Array

    @property
    def loss(self) -> float:
        return float(np.sqrt(self.squares.mean()))


def _agreed(recorded: Walk, choices: Sequence[Subset], starts: Iterable[Sequence[Array]]) -> list[_Found]:
    """The best of all starts, which no neighbour's answer, as another start, improves."""
    tried = [_settled(recorded, choices, start) for start in starts]
    best = [reduce(_better, some) for some in zip(*tried, strict=True)]
    busy = list(range(len(choices)))
    for _ in range(SWEEPS):
        before = [found.loss for found in best]
        for shift in (1, -1):
            seeds = [np.roll(best[k].q, shift, axis=0) for k in busy]
            for k, again in zip(busy, _settled(recorded, [choices[k] for k in busy], seeds), strict=True):
                best[k] = _better(best[k], again)
        busy = [k for k in busy if best[k].loss < before[k] - _WORTH_IT]
        if not busy:
            break
    return best


def _settled(recorded: Walk, choices: Sequence[Subset], starts: Sequence[Array]) -> list[_Found]:
    """The compromise of each choice from its start, all samples of all choices at once."""
    robot, n = recorded.robot, len(recorded.base)
    free = np.repeat([[movement_of(joint) in c for joint in robot.joints] for c in choices], n, axis=0)
    lower, upper = (np.where(free, limit, 0.0) for limit in (robot.lower, robot.upper))
    base = np.tile(recorded.base, (len(choices), 1, 1))
    wanted = np.tile(recorded.corners, (len(choices), 1, 1, 1))
    q = settle(robot, sole_targets(robot, wanted), np.concatenate(starts), lower, upper, base=base)
    missed = ((corners(robot, poses(robot, q, FEET, base=base)) - wanted) ** 2).sum(axis=-1)
    squares = missed.mean(axis=(1, 2)).reshape(len(choices), n)
    return [_Found(*pair) for pair in zip(q.reshape(len(choices), n, -1), squares, strict=True)]


def _better(one: _Found, other: _Found) -> _Found:
    first = one.squares <= other.squares + BETTER
    return _Found(np.where(first[:, None], one.q, other.q), np.where(first, one.squares, other.squares))


def _copy(recorded: Walk) -> Array:
    robot = recorded.robot
    return np.clip(robot.from_gait(recorded.gait), robot.lower, robot.upper)


def _in_order(chosen: Iterable[str]) -> tuple[str, ...]:
    return tuple(m for m in MOVEMENTS if m in set(chosen))


def _falling(values: dict[str, float]) -> dict[str, float]:
    return dict(sorted(values.items(), key=lambda item: -item[1]))
