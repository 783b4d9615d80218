"""Passive moments of hip, knee and ankle: what muscles and tissues of a relaxed leg give by their length."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from exo_pin import arguments
from exo_pin.anatomy import JOINTS, SIDES
from exo_pin.anatomy.names import joint
from exo_pin.arrays import Array

_HIP, _KNEE, _PLANTARFLEXION = (-20.0, 100.0), (0.0, 120.0), (-20.0, 40.0)
"""Angles that the exponentials are used for [deg]; beyond them the moment stays (they would explode)."""

_LEGS = [
    [
        JOINTS.index(joint(side, movement))
        for movement in ("hip_flexion", "knee_flexion", "ankle_dorsiflexion")
    ]
    for side in SIDES
]
"""Columns of hip, knee and ankle of each leg."""

_DEGREES = 180.0 / math.pi


def passive_moments(q: npt.ArrayLike) -> Array:
    """Passive moments of the joints (..., 12) [N m] of a relaxed adult, in the order of `JOINTS`.

    Riener and Edrich (1999), J Biomech 32(5):539, from ten healthy people: hip, knee and ankle in the
    sagittal plane, each depending on its neighbours through the muscles that span two joints. The other
    movements have no moment. A moment is positive the way its joint is named. The sign of the ankle's angle
    is inferred: the moment of the gastrocnemius must fall as the knee bends and grow with dorsiflexion.

    Args:
        q: Joint angles (..., 12) in the order of `JOINTS`, clinical [rad].

    Raises:
        DescriptionError: The last axis is not 12, or an angle is not finite.
    """
    return moments(arguments.real("q", q, (..., len(JOINTS))))


def moments(q: Array) -> Array:
    """The moments of `passive_moments` for angles (..., 12) that are known to be finite."""
    out = np.zeros(q.shape)
    if q.ndim == 1:  # one sample, as in a control loop: floats are ten times faster than arrays of two
        angles = q.tolist()
        for hip, knee, ankle in _LEGS:
            h, k = _within(_DEGREES * angles[hip], _HIP), _within(_DEGREES * angles[knee], _KNEE)
            a = _within(-_DEGREES * angles[ankle], _PLANTARFLEXION)
            out[hip], out[knee], out[ankle] = _leg(h, k, a, math.exp)
        return out
    for hip, knee, ankle in _LEGS:
        flexed, bent = np.clip(np.degrees(q[..., hip]), *_HIP), np.clip(np.degrees(q[..., knee]), *_KNEE)
        plantar = np.clip(-np.degrees(q[..., ankle]), *_PLANTARFLEXION)
        out[..., hip], out[..., knee], out[..., ankle] = _leg(flexed, bent, plantar, np.exp)
    return out


def _within(x: float, span: tuple[float, float]) -> float:
    return min(max(x, span[0]), span[1])


def _leg(h: Any, k: Any, a: Any, exp: Callable[[Any], Any]) -> tuple[Any, Any, Any]:
    """Moments of hip flexion, knee flexion and ankle dorsiflexion [N m].

    Args:
        h: Hip flexion [deg].
        k: Knee flexion [deg].
        a: Plantarflexion [deg].
        exp: The exponential function of their type.
    """
    hip = exp(1.4655 - 0.0034 * k - 0.0750 * h) - exp(1.3403 - 0.0226 * k + 0.0305 * h) + 8.072
    knee = (
        exp(1.800 - 0.0460 * a - 0.0352 * k + 0.0217 * h)
        - exp(-3.971 - 0.0004 * a + 0.0495 * k - 0.0128 * h)
        + exp(2.220 - 0.150 * k)
        - 4.820
    )
    ankle = exp(-7.9763 + 0.1949 * a + 0.0008 * k) - exp(2.1016 - 0.0843 * a - 0.0176 * k) + 1.792
    return hip, knee, ankle
