"""A run as gaits and torques: the walk as simulated, the walk to follow, the torques of the motors."""

from __future__ import annotations

import dataclasses

import numpy as np

from exo_pin.arrays import Array
from exo_pin.errors import GaitError
from exo_pin.gait import Event, Gait, Torques
from exo_pin.robot.gait_columns import in_hip_order
from exo_pin.simulation.simulated_walk import SimulatedWalk

RATE = 100.0
"""Samples per second [Hz]: a tenth of the steps at 1 ms."""


def walked(run: SimulatedWalk, *, rate: float = RATE) -> Gait:
    """The simulated walk, over the belt where it belongs to a treadmill, with the planned events.

    Args:
        run: What was simulated.
        rate: Samples per second [Hz].

    Raises:
        GaitError: The run ended before its second sample.
    """
    if len(run.time[:: run.steps_per_sample(rate)]) < 2:
        raise GaitError(f"the run ends after {len(run.time)} steps ({run.ended}): there is no walk to show")
    gait = run.to_gait(rate=rate)
    assert gait.base is not None  # the simulated pelvis is free
    base = _on_the_spot(run, gait.base, gait.time)
    return dataclasses.replace(gait, base=base, events=_events(run, float(gait.time[-1])))


def wanted(run: SimulatedWalk, *, rate: float = RATE) -> Gait:
    """The walk that was to be followed, sampled as `walked` is.

    Args:
        run: What was simulated.
        rate: Samples per second [Hz].
    """
    rows = slice(None, len(run.time), run.steps_per_sample(rate))
    time, base = run.reference.time[rows], run.reference.base[rows]
    return Gait(
        time,
        in_hip_order(run.reference.q[rows], source=run.robot.hip_order, target="clinical"),
        base=_on_the_spot(run, base, time),
        events=_events(run, float(time[-1])),
        source=run.gait.source,
    )


def motor_torques(run: SimulatedWalk, *, rate: float = RATE) -> Torques:
    """The motors' torques, sampled as `walked` is.

    Args:
        run: What was simulated.
        rate: Samples per second [Hz].

    Raises:
        GaitError: A torque is larger than a leg bears: motors without limits.
    """
    rows = slice(None, None, run.steps_per_sample(rate))
    return Torques(run.time[rows], run.motor[rows], source=f"motors under the controller {run.controller}")


def _on_the_spot(run: SimulatedWalk, base: Array, time: Array) -> Array:
    """Poses (n, 4, 4) seen from the support: in the simulation the belt stands, the pelvis moves."""
    moved = np.array(base)
    moved[:, 0, 3] -= run.reference.belt_speed * time
    return moved


def _events(run: SimulatedWalk, end: float) -> tuple[Event, ...]:
    """Events of the walk that was to be followed, on the clock of the run, which starts at 0."""
    walk, start = run.gait, float(run.gait.time[0])
    cycles = range(int(end / walk.duration) + 1) if walk.periodic else range(1)
    times = [(e, e.time - start + k * walk.duration) for k in cycles for e in walk.events]
    return tuple(dataclasses.replace(event, time=time) for event, time in times if 0.0 <= time <= end)
