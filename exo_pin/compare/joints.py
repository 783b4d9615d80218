"""Which joints are worth their motor: every choice of the six movements of a leg, and what it loses."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np
import pinocchio as pin

from exo_pin.anatomy import MOVEMENTS, Body
from exo_pin.compare.loss import root_mean_square
from exo_pin.compare.motion import SETTINGS, Walk, best, walk
from exo_pin.devices import movement_of
from exo_pin.gait import Gait
from exo_pin.robot import Robot

SAMPLES = 25
"""Samples of a periodic gait that the study looks at."""

SEARCH = dataclasses.replace(SETTINGS, max_iterations=50)
"""Enough steps to settle a loss within a few hundredths of a millimetre of where 200 steps lead."""

Subset = frozenset[str]
Progress = Callable[[Iterable[tuple[str, ...]]], Iterable[tuple[str, ...]]]


@dataclass(frozen=True, eq=False)
class Worth:
    """What every choice of movements, the same on both legs, loses of a walk.

    Attributes:
        walk: The recorded walk.
        losses: By the movements that are driven, all 2^6 choices: root mean square distance of the soles'
            corners from the recorded ones [m], best motion within the joint limits, the pelvis as recorded.
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

    Args:
        gait: The walk; a periodic one is taken at `SAMPLES` samples.
        body: Who wears it; `Body.from_stature()` if left out.
        progress: Wraps the choices, e.g. in a progress bar.
    """
    recorded = walk(gait.resampled(SAMPLES) if gait.periodic and len(gait) > SAMPLES else gait, body)
    losses = {
        frozenset(chosen): _loss(recorded, narrowed(recorded.robot, chosen))
        for chosen in progress(_choices())
    }
    return Worth(recorded, losses)


def narrowed(robot: Robot, movements: Iterable[str]) -> Robot:
    """The robot with the joints of all other movements fixed at zero.

    A leg keeps at least one joint, since a leg without any has nothing to solve; it is held at zero by its
    limits.
    """
    free = set(movements)
    kept = {*free, *[m for m in MOVEMENTS if m not in free][: max(0, 1 - len(free))]}
    locked = [robot.model.getJointId(joint) for joint in robot.joints if movement_of(joint) not in kept]
    model = pin.buildReducedModel(robot.model, locked, robot.neutral)
    stays = np.array([movement_of(joint) in kept for joint in robot.joints])
    joints = tuple(joint for joint in robot.joints if movement_of(joint) in kept)
    loose = np.array([movement_of(joint) in free for joint in joints])
    lower, upper = (np.where(loose, limit[stays], 0.0) for limit in (robot.lower, robot.upper))
    model.lowerPositionLimit, model.upperPositionLimit = lower, upper
    speed, effort = robot.velocity[stays], robot.effort[stays]
    return dataclasses.replace(
        robot, model=model, joints=joints, lower=lower, upper=upper, velocity=speed, effort=effort
    )


def _choices() -> list[tuple[str, ...]]:
    return [chosen for count in range(len(MOVEMENTS) + 1) for chosen in combinations(MOVEMENTS, count)]


def _loss(recorded: Walk, robot: Robot) -> float:
    squares = ((best(recorded, robot, settings=SEARCH).corners - recorded.corners) ** 2).sum(axis=-1)
    return root_mean_square(np.sqrt(squares))


def _in_order(chosen: Iterable[str]) -> tuple[str, ...]:
    return tuple(m for m in MOVEMENTS if m in set(chosen))


def _falling(values: dict[str, float]) -> dict[str, float]:
    return dict(sorted(values.items(), key=lambda item: -item[1]))
