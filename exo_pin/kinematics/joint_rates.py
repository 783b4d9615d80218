"""Joint velocities and accelerations of a walk, low-pass filtered where it is a recording."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exo_pin import signals
from exo_pin.arguments import count, number, real
from exo_pin.arrays import Array
from exo_pin.errors import GaitError
from exo_pin.gait import Gait, time_series
from exo_pin.robot import Robot
from exo_pin.short_repr import short_repr

_EXACT = 1e-6  # [s] off an even grid: rounding


@dataclass(frozen=True, eq=False)
class JointRates:
    """Rates of a robot's joints.

    Attributes:
        dq: `(n, J)` [rad/s].
        ddq: `(n, J)` [rad/s^2].
        how: Derivative and filter, in words.
    """

    dq: Array
    ddq: Array
    how: str

    __repr__ = short_repr


def joint_rates(robot: Robot, gait: Gait, *, cutoff: float | None) -> JointRates:
    """Rates of the joints in the robot's own order and hip convention.

    A periodic gait is differentiated by its Fourier series and never filtered.

    Args:
        robot: The robot.
        gait: The walk.
        cutoff: Low-pass before a recording is differentiated [Hz]; None: no filter.

    Raises:
        GaitError: The cut-off is no positive number.
    """
    if cutoff is not None:
        number("cutoff", cutoff, above=0.0, error=GaitError)
    q = robot.angles(robot.from_gait(gait))
    if gait.periodic:
        how = "Derivatives of the walk's Fourier series; not filtered."
        return _rates(gait, q, gait.duration, how)
    q, how = smoothed_curves(gait, q, cutoff)
    return _rates(gait, q, None, f"{how} Second-order differences.")


def _rates(gait: Gait, q: Array, period: float | None, how: str) -> JointRates:
    dq, ddq = (time_series.derivative(gait.time, q, order, period) for order in (1, 2))
    return JointRates(dq, ddq, how)


def smoothed_curves(
    gait: Gait, q: Array, cutoff: float | None, *, order: int = signals.ORDER, what: str = "Angles"
) -> tuple[Array, str]:
    """Filtered curves of a recording, and a sentence on how.

    Those on an uneven grid (rounded times in files) are brought to an even one first.

    Args:
        gait: The walk, whose clock is used.
        q: `(n, m)` curves.
        cutoff: Low-pass [Hz]; None: no filter.
        order: Of both passes together.
        what: What the curves are, the sentence's first word.

    Raises:
        GaitError: The shape of the curves does not fit the walk, or a number is not finite.
    """
    q = real("q", q, (len(gait), "m"), error=GaitError)
    count("order", order, 2, 8, error=GaitError)
    if cutoff is not None:
        number("cutoff", cutoff, above=0.0, error=GaitError)
    if cutoff is None:
        return q, f"{what} not filtered: accelerations carry the recording's noise."
    even = np.linspace(gait.time[0], gait.time[-1], len(gait))
    off = float(np.abs(gait.time - even).max())
    try:
        curves = time_series.resampled(gait.time, q, even, periodic=False)
        smooth = signals.lowpass(even, curves, cutoff=cutoff, order=order)
    except GaitError as error:
        return q, f"{what} not filtered, for the filter refused them ({error})."
    words = f"{what} low-pass filtered first (Butterworth, order {order}, zero lag, {cutoff:g} Hz)"
    if off < _EXACT:
        return smooth, f"{words}."
    back = time_series.resampled(even, smooth, gait.time, periodic=False)
    return back, f"{words}, on an even grid, from which the samples lie up to {1e3 * off:.2g} ms."
