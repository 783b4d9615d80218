"""The energy balance of a run: what the energy gained against the work of all forces."""

from __future__ import annotations

import numpy as np

from exo_pin.arrays import Array
from exo_pin.simulation.recording import Recording
from exo_pin.simulation.witness import rotations

_FREE = 6


def balance(record: Recording, timestep: float) -> float:
    """100 |dE - work of motors, person, friction, support, floor, stops| / integral of sum |tau dq|.

    A step's work is its force times the mean of the velocities before and after it: the velocity at the
    step's start alone is off by 0.6 %.

    Args:
        record: The run.
        timestep: [s].

    Returns:
        Percent; NaN where no torque turns anything over.
    """
    speed = (record.qvel[1:] + record.qvel[:-1]) / 2
    R = rotations(record)
    turned = np.einsum("nji,nj->ni", R, record.support[:, 3:])
    applied = np.hstack([record.support[:, :3], turned, _joints(record)]) + record.constraint
    work = timestep * float((applied[:-1] * speed).sum())
    gained = float(record.energy[-1].sum() - record.energy[0].sum())
    turnover = timestep * float(np.abs(_joints(record)[:-1] * speed[:, _FREE:]).sum())
    return 100.0 * abs(gained - work) / turnover if turnover else float("nan")


def _joints(record: Recording) -> Array:
    """`(N, J)` torques of motors, person and friction, in the order of MuJoCo's joints."""
    return (
        record.motor[:, record.columns]
        + record.person[:, record.columns]
        + record.friction[:, record.columns]
    )
