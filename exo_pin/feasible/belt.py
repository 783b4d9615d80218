"""The speed of a treadmill under a device's own motion, and the slower walk that keeps it."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

from exo_pin.feasible.concession import LEAST_SHARE, Concession, floored
from exo_pin.feasible.device_walk import DeviceWalk
from exo_pin.gait import Gait
from exo_pin.robot.model import LIMIT_TOLERANCE


def within_belt(answer: DeviceWalk, possible: Callable[[Gait], bool]) -> DeviceWalk:
    """The answer, or the same with a slower walk where the device's own motion is too fast for its treadmill.

    The feet of a device that holds the pelvis, or misses the recorded ones, take the belt to another speed
    than the person's. Where no slower walk is possible, the answer stays; `DeviceWalk.belt_warning` says so.

    Args:
        answer: To the walk as its joints allow it.
        possible: Whether the device can do a slower walk.
    """
    if answer.verdict == "no":
        return answer
    slower = answer
    while (excess := _belt_excess(slower)) > 1.0:
        cadence = floored(_cadence(slower) / excess)
        walk = slower.gait.slowed(_cadence(slower) / max(cadence, LEAST_SHARE))
        if cadence < LEAST_SHARE or not possible(walk):
            return answer
        made = *_without_cadence(answer), _belt_concession(answer, cadence)
        slower = dataclasses.replace(answer, gait=walk, verdict="concession", concessions=made)
    return slower


def _belt_excess(answer: DeviceWalk) -> float:
    """How many times too fast the belt runs; at most 1 where it does not."""
    if answer.belt is None or answer.device.treadmill is None:
        return 0.0
    return answer.belt / (answer.device.treadmill[1] + LIMIT_TOLERANCE)


def _cadence(answer: DeviceWalk) -> float:
    """Share of the recorded cadence that the walk has."""
    return next((made.how_much for made in answer.concessions if made.what == "cadence"), 1.0)


def _without_cadence(answer: DeviceWalk) -> tuple[Concession, ...]:
    return tuple(made for made in answer.concessions if made.what != "cadence")


def _belt_concession(answer: DeviceWalk, cadence: float) -> Concession:
    """A slower walk for the sake of the belt, after what made the walk slower before."""
    assert answer.belt is not None
    assert answer.device.treadmill is not None
    before = [made.note for made in answer.concessions if made.what == "cadence"]
    slowest, fastest = answer.device.treadmill
    belt = (
        f"the device's own motion takes the belt to {answer.belt:.2f} m/s at cadence {_cadence(answer):.2f}"
    )
    if all(fit.ok for fit in answer.as_recorded.fits):  # else the range was stated
        belt += f", {slowest:.2f} to {fastest:.2f} m/s possible"
    return Concession("cadence", cadence, "times", "; ".join([*before, belt]))
