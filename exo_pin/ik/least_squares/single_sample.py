"""Damped least squares for one subtree and one sample, on Pinocchio, with joint limits in every step.

Each step minimises |J x - e|^2 + damping |x|^2 over the steps that keep the joints within their limits
(`boxstep`). The damping follows the residual (Sugihara 2011, "Solvability-unconcerned inverse kinematics by
the Levenberg-Marquardt method", IEEE T-RO 27(5)): it vanishes at the target, so that convergence is
quadratic, and stays where the target is out of reach, so that the step remains bounded near singularities
(Nakamura and Hanafusa 1986). A step that does not reduce the error is taken back and damped more (Marquardt).
"""

from __future__ import annotations

from functools import partial
from typing import Any, NamedTuple

import numpy as np

from exo_pin.arrays import Array
from exo_pin.ik.least_squares.box_qp import box_step
from exo_pin.ik.least_squares.residual import residual
from exo_pin.ik.least_squares.restarts import starts
from exo_pin.ik.least_squares.second_order import bend, definite
from exo_pin.ik.settings import Dls
from exo_pin.ik.targets import Goal
from exo_pin.robot import Subtree

_FLOOR = 1e-13  # keeps the normal equations definite at a singular pose
_STUCK = 1e-10  # a step this small changes nothing any more [rad, m]
_STILL = 1e-7  # the same where the answer is a compromise with noise
_ROUNDED = 1e-8  # the next quadratic step is below rounding: a cost that does not fall is at its least
_CALMER, _STRONGER = 0.25, 4.0
_NOTHING = np.zeros((0, 0))


class Try(NamedTuple):
    """Where one start led: configuration, errors (2, F), steps, sum of squares, success."""

    q: Array
    errors: Array
    steps: int
    cost: float
    converged: bool


def best_try(
    subtree: Subtree,
    data: Any,
    seed: Array,
    goals: list[Goal],
    k: int,
    settings: Dls,
    *,
    reachable: bool = True,
    free: bool = False,
    compromise: bool = False,
) -> Try:
    """The answer from the seed; from other starts if that one got stuck short of a reachable target.

    `free`: the seed is no neighbour's answer, so that leaving it costs nothing. `compromise`: see `descend`.
    """
    first = descend(subtree, data, seed, goals, k, settings, free=free, compromise=compromise)
    steps = first.steps
    if first.converged or not reachable or (settings.damping and not free):
        return first
    for start in starts(subtree.middle, subtree.lower, subtree.upper, settings.restarts):
        again = descend(subtree, data, start, goals, k, settings, free=True)
        steps += again.steps
        if again.converged:
            return again._replace(steps=steps)
    return first._replace(steps=steps)


def descend(
    subtree: Subtree,
    data: Any,
    seed: Array,
    goals: list[Goal],
    k: int,
    settings: Dls,
    *,
    free: bool = False,
    compromise: bool = False,
) -> Try:
    """Levenberg-Marquardt steps within the limits from one start.

    `free`: no price on leaving the seed. `compromise`: the targets cannot all be met, so that steps with the
    whole second derivative (`bend`) are the shorter way.
    """
    look = partial(_look, subtree, data, goals, k, settings, compromise)
    price = 0.0 if free else settings.damping**2
    start = q = np.minimum(np.maximum(seed, subtree.lower), subtree.upper)
    e, J, errors, rest = look(q)
    away = np.zeros(subtree.model.nv)
    cost, factor, step = float(e @ e), 1.0, 0
    for step in range(1, settings.max_iterations + 1):
        if price == 0.0 and not np.nanmax(errors) > settings.tolerance:
            return Try(q, errors, step - 1, cost, True)
        A, g, room = J.T @ J, J.T @ e + price * away, subtree.box(q)
        A[np.diag_indices_from(A)] += factor * cost + price + _FLOOR
        x = box_step(*(definite(A, g, rest, *room) if compromise else (A, g)), *room)
        size = np.abs(x).max()
        if size < (_STILL if price else _STUCK):
            break
        trial = subtree.moved(q, x)
        there = look(trial)
        away_new = subtree.difference(trial, start) if price else away
        cost_new = float(there[0] @ there[0] + price * (away_new @ away_new))
        if cost_new < cost:
            q, away, cost = trial, away_new, cost_new
            e, J, errors, rest = there
            factor *= _CALMER
        elif compromise and size < _ROUNDED:
            break
        else:
            factor *= _STRONGER
    return Try(q, errors, step, cost, not np.nanmax(errors) > settings.tolerance)


def _look(
    subtree: Subtree, data: Any, goals: list[Goal], k: int, settings: Dls, compromise: bool, q: Array
) -> tuple[Array, Array, Array, Array]:
    """Error, Jacobian, distances and angles, and for a compromise what bends the cost."""
    scale = (settings.position_weight, settings.rotation_weight)
    e, J, errors = residual(subtree, data, q, goals, k, scale)
    return e, J, errors, bend(subtree, data, goals, k, scale) if compromise else _NOTHING
