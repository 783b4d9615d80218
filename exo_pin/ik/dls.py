"""Damped least squares for one limb and one sample, on Pinocchio, with joint limits in every step.

Each step minimises |J x - e|^2 + damping |x|^2 over the steps that keep the joints within their limits
(`boxstep`). The damping follows the residual (Sugihara 2011, "Solvability-unconcerned inverse kinematics by
the Levenberg-Marquardt method", IEEE T-RO 27(5)): it vanishes at the target, so that convergence is
quadratic, and stays where the target is out of reach, so that the step remains bounded near singularities
(Nakamura and Hanafusa 1986). A step that does not reduce the error is taken back and damped more (Marquardt).
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from exo_pin.ik.boxstep import box_step
from exo_pin.ik.limb import Limb, residual
from exo_pin.ik.settings import Dls
from exo_pin.ik.targets import Goal

Array = npt.NDArray[np.float64]
_FLOOR = 1e-13  # keeps the normal equations definite at a singular pose
_STUCK = 1e-11  # a step this small changes nothing any more [rad, m]
_CALMER, _STRONGER = 0.25, 4.0


class Try(NamedTuple):
    """Where one start led: configuration, errors (2, F), steps, sum of squares, success."""

    q: Array
    errors: Array
    steps: int
    cost: float
    converged: bool


def best_try(
    limb: Limb, data: Any, seed: Array, goals: list[Goal], k: int, settings: Dls, *, reachable: bool = True
) -> Try:
    """The answer from the seed; from other starts if that one got stuck short of a reachable target."""
    first = descend(limb, data, seed, goals, k, settings)
    steps = first.steps
    if first.converged or not reachable:
        return first
    for start in _starts(limb, settings.restarts):
        again = descend(limb, data, start, goals, k, settings)
        steps += again.steps
        if again.converged:
            return again._replace(steps=steps)
    return first._replace(steps=steps)


def descend(limb: Limb, data: Any, seed: Array, goals: list[Goal], k: int, settings: Dls) -> Try:
    """Levenberg-Marquardt steps within the limits from one start."""
    scale = (settings.position_weight, settings.rotation_weight)
    q = np.minimum(np.maximum(seed, limb.lower), limb.upper)
    e, J, errors = residual(limb, data, q, goals, k, scale)
    cost, factor, step = float(e @ e), 1.0, 0
    for step in range(1, settings.max_iterations + 1):
        if not np.nanmax(errors) > settings.tolerance:
            return Try(q, errors, step - 1, cost, True)
        A = J.T @ J
        A[np.diag_indices_from(A)] += factor * cost + settings.damping**2 + _FLOOR
        x = box_step(A, J.T @ e, *limb.box(q))
        if np.abs(x).max() < _STUCK:
            break
        trial = limb.moved(q, x)
        e_new, J_new, errors_new = residual(limb, data, trial, goals, k, scale)
        cost_new = float(e_new @ e_new)
        if cost_new < cost:
            q, e, J, errors, cost = trial, e_new, J_new, errors_new, cost_new
            factor *= _CALMER
        else:
            factor *= _STRONGER
    return Try(q, errors, step, cost, not np.nanmax(errors) > settings.tolerance)


def _starts(limb: Limb, count: int) -> Iterator[Array]:
    """Mid-range first, then a fixed low-discrepancy sequence over the joint ranges (Roberts' R_d)."""
    if count:
        yield limb.middle
    bounded = np.isfinite(limb.lower) & np.isfinite(limb.upper)
    m = int(bounded.sum())
    root = 2.0
    for _ in range(40):  # the positive root of x**(m + 1) = x + 1
        root = (1.0 + root) ** (1.0 / (m + 1))
    pace = root ** -np.arange(1.0, m + 1.0)
    for i in range(1, count):
        q = limb.middle
        share = (0.5 + i * pace) % 1.0
        q[bounded] = limb.lower[bounded] + share * (limb.upper - limb.lower)[bounded]
        yield q
