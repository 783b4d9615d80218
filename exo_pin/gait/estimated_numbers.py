"""Spatiotemporal numbers of an estimated stride, of a walk in which no foot has a whole cycle."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.arrays import Array
from exo_pin.gait.event import Event, whole_stances
from exo_pin.gait.gait import Gait
from exo_pin.gait.half_strides import StrideEstimate
from exo_pin.gait.heading import heading
from exo_pin.gait.spatiotemporal import Number, ground_velocity, spatiotemporal


def estimated_numbers(gait: Gait, estimate: StrideEstimate, time: Array, heels: Array) -> dict[str, Number]:
    """Numbers between toe-offs where the stride was measured there, else of its step.

    Args:
        gait: A walk with events.
        estimate: Its stride (`exo_pin.gait.half_strides.walk_estimate`).
        time: `(n,)` [s].
        heels: `(n, 2, 3)` left and right heel in the world at these times, z up [m].

    Returns:
        As of `exo_pin.gait.spatiotemporal`; what one step does not show is left out.
    """
    once = {"cadence": (120 / estimate.duration, "steps/min"), "stride_time": (estimate.duration, "s")}
    strikes = [event for event in gait.events if event.kind == "heel_strike"]
    stances = {side: list(whole_stances(gait.events, side)) for side in SIDES}
    pelvis = None if gait.base is None else gait.base[:, :2, 3]
    for a, b in pairwise(strikes):
        if a.side != b.side:
            once[f"{b.side}_step_time"] = (b.time - a.time, "s")
            # without a whole stance nothing tells whether the ground moves: no treadmill's speed, no length
            if any(stances.values()) and not estimate.spans:
                along = _step_length(gait, time, heels, pelvis, (a, b))
                once |= {"speed": (along / (b.time - a.time), "m/s"), f"{b.side}_step_length": (along, "m")}
    for side, spans in stances.items():
        for start, end in spans:
            once[f"{side}_stance"] = (100 * (end - start) / estimate.duration, "%")
    numbers = {name: Number.of([x], unit) for name, (x, unit) in once.items()}
    if estimate.spans:
        numbers |= spatiotemporal(time, heels, gait.events, pelvis=pelvis, spans=estimate.spans)
    return numbers


def _step_length(
    gait: Gait, time: Array, heels: Array, pelvis: Array | None, strikes: tuple[Event, Event]
) -> float:
    """From one foot's strike to the other's over the ground, along the pelvis's mean heading [m]."""
    places = [
        [np.interp(strike.time, time, heels[:, SIDES.index(strike.side), axis]) for axis in range(2)]
        for strike in strikes
    ]
    ground = ground_velocity(time, heels, gait.events, pelvis)
    step = np.subtract(places[1], places[0]) - ground * (strikes[1].time - strikes[0].time)
    angle = heading(gait) or 0.0
    return float(step @ [math.cos(angle), math.sin(angle)])
