"""Choices of driven joints: the loss of a walk for every subset of the six movements of a leg."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import reduce
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np

from exo_pin.anatomy import FEET, MOVEMENTS, Body
from exo_pin.anatomy.names import Movement
from exo_pin.arrays import Array
from exo_pin.compare.best_motion import LEAST_DECREASE, MOST_SWEEPS, plain_copy
from exo_pin.compare.recorded_walk import Walk, corners, sole_targets, walk
from exo_pin.devices import movement_of
from exo_pin.gait import Gait
from exo_pin.ik.least_squares.dls import settle
from exo_pin.kinematics import poses
from exo_pin.short_repr import short_repr

_SAMPLES = 25  # of a periodic gait are compared

_LEAST_GAIN = 1e-6  # a choice whose loss falls by less is not solved again [m]

Subset = frozenset[Movement]
Progress = Callable[[Iterable[int]], Iterable[int]]


class Choice(NamedTuple):
    """One subset of movements that are driven on both legs, and its loss.

    Attributes:
        motors: Number of motors of both legs.
        movements: The driven movements, in the order of `MOVEMENTS`.
        loss: Root mean square distance of the soles' corners from the recorded ones [m].
    """

    motors: int
    movements: tuple[Movement, ...]
    loss: float


@dataclass(frozen=True, eq=False)
class JointChoices:
    """The loss of a walk for every choice of driven movements, the same on both legs.

    Attributes:
        walk: The recorded walk.
        losses: Loss of all 2^6 choices, by the movements that are driven: root mean square distance of the
            soles' corners from the recorded ones [m]. Every sample has its best configuration within the
            joint limits, without velocity limits, the pelvis moving as recorded.
    """

    walk: Walk
    losses: dict[Subset, float]

    __repr__ = short_repr

    @property
    def choices(self) -> list[Choice]:
        """All choices, in the order in which they were computed."""
        return [self._choice(chosen) for chosen in self.losses]

    @property
    def leave_one_out(self) -> dict[Movement, float]:
        """Loss when one movement alone is locked [m], the largest first."""
        full = frozenset(MOVEMENTS)
        losses = {m: self.losses[full - {m}] for m in MOVEMENTS}
        return dict(sorted(losses.items(), key=lambda item: -item[1]))

    @property
    def add_one_in(self) -> list[tuple[Movement, float]]:
        """Greedy order of movements: the largest decrease of the loss first; each with the loss left [m]."""
        chosen: Subset = frozenset()
        steps: list[tuple[Movement, float]] = []
        while len(chosen) < len(MOVEMENTS):
            rest = [m for m in MOVEMENTS if m not in chosen]
            added = min(rest, key=lambda m: self.losses[chosen | {m}])
            chosen = chosen | {added}
            steps.append((added, self.losses[chosen]))
        return steps

    @property
    def pareto(self) -> list[Choice]:
        """The choice with the least loss for each number of motors."""
        best = []
        for count in range(len(MOVEMENTS) + 1):
            some = [chosen for chosen in self.losses if len(chosen) == count]
            best.append(self._choice(min(some, key=lambda chosen: self.losses[chosen])))
        return best

    def facts(self) -> dict[str, Any]:
        """Plain values for JSON."""
        return {
            "gait": {"source": self.walk.gait.source, "samples": len(self.walk.gait)},
            "leave_one_out_mm": {m: 1e3 * loss for m, loss in self.leave_one_out.items()},
            "add_one_in": [{"movement": m, "left_mm": 1e3 * loss} for m, loss in self.add_one_in],
            "pareto": [
                {"motors": motors, "movements": movements, "sole_rms_mm": 1e3 * loss}
                for motors, movements, loss in self.pareto
            ],
            "all": [
                {"movements": movements, "motors": motors, "sole_rms_mm": 1e3 * loss}
                for motors, movements, loss in self.choices
            ],
        }

    def _choice(self, chosen: Subset) -> Choice:
        return Choice(2 * len(chosen), tuple(m for m in MOVEMENTS if m in chosen), self.losses[chosen])


def compare_joints(gait: Gait, body: Body | None = None, *, progress: Progress = iter) -> JointChoices:
    """The loss of a walk for every choice of driven movements.

    A locked joint is one whose limits are both zero, so that the samples of all choices of the same size are
    solved together. Each choice starts from the plain copy, from the solution of the best choice with one
    movement less, and from its neighbours' solutions, and keeps the best: a further joint never increases the
    loss.

    Args:
        gait: The walk; a periodic one with more than 25 samples is resampled to 25.
        body: Who wears the device; `Body.from_stature()` if left out.
        progress: Wraps the numbers of movements, e.g. in a progress bar.
    """
    recorded = walk(gait.resampled(_SAMPLES) if gait.periodic and len(gait) > _SAMPLES else gait, body)
    copy = plain_copy(recorded, recorded.robot, recorded.gait.q)
    found: dict[Subset, _Solution] = {}
    for count in progress(range(len(MOVEMENTS) + 1)):
        choices = [frozenset(chosen) for chosen in combinations(MOVEMENTS, count)]
        starts = [[copy] * len(choices)]
        if count:
            starts.append([min((found[c - {m}] for m in c), key=lambda f: f.loss).q for c in choices])
        found.update(zip(choices, _best_of(recorded, choices, starts), strict=True))
    return JointChoices(recorded, {chosen: solution.loss for chosen, solution in found.items()})


class _Solution(NamedTuple):
    """Configurations (n, 12), and by sample the mean squared error of the soles' corners (n,) [m^2]."""

    q: Array
    squares: Array

    @property
    def loss(self) -> float:
        return float(np.sqrt(self.squares.mean()))


def _best_of(recorded: Walk, choices: Sequence[Subset], starts: Iterable[Sequence[Array]]) -> list[_Solution]:
    """For each choice the best solution of all starts, which no neighbour's solution as a start improves."""
    tried = [_solved(recorded, choices, start) for start in starts]
    best = [reduce(_better, some) for some in zip(*tried, strict=True)]
    unfinished = list(range(len(choices)))
    for _ in range(MOST_SWEEPS):
        before = [solution.loss for solution in best]
        for shift in (1, -1):
            seeds = [np.roll(best[k].q, shift, axis=0) for k in unfinished]
            solved = _solved(recorded, [choices[k] for k in unfinished], seeds)
            for k, again in zip(unfinished, solved, strict=True):
                best[k] = _better(best[k], again)
        unfinished = [k for k in unfinished if best[k].loss < before[k] - _LEAST_GAIN]
        if not unfinished:
            break
    return best


def _solved(recorded: Walk, choices: Sequence[Subset], starts: Sequence[Array]) -> list[_Solution]:
    """The least squares solution of each choice from its start, all samples of all choices at once."""
    robot, n = recorded.robot, len(recorded.base)
    free = np.repeat([[movement_of(joint) in c for joint in robot.joints] for c in choices], n, axis=0)
    lower, upper = (np.where(free, limit, 0.0) for limit in (robot.lower, robot.upper))
    base = np.tile(recorded.base, (len(choices), 1, 1))
    wanted = np.tile(recorded.corners, (len(choices), 1, 1, 1))
    q = settle(robot, sole_targets(robot, wanted), np.concatenate(starts), lower, upper, base=base)
    missed = ((corners(robot, poses(robot, q, FEET, base=base)) - wanted) ** 2).sum(axis=-1)
    squares = missed.mean(axis=(1, 2)).reshape(len(choices), n)
    return [_Solution(*pair) for pair in zip(q.reshape(len(choices), n, -1), squares, strict=True)]


def _better(one: _Solution, other: _Solution) -> _Solution:
    first = one.squares <= other.squares + LEAST_DECREASE
    return _Solution(np.where(first[:, None], one.q, other.q), np.where(first, one.squares, other.squares))
