"""Clock of force plates against that of a walk: heel strikes and toe-offs of both, side by side."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np

from exo_pin.errors import GaitError
from exo_pin.gait import Event, Gait
from exo_pin.gait.trial import ForcePlate
from exo_pin.kinematics import event_differences, plate_events
from exo_pin.kinematics.sole_contact import events
from exo_pin.robot import Robot

_APART = 0.06
"""Mean difference [s] of all events from which two clocks differ: kinematics alone are 5 to 30 ms off."""


def check_clock(robot: Robot, gait: Gait, forces: Sequence[ForcePlate]) -> None:
    """Refuse plates whose contacts come earlier or later than the feet's, all of them.

    Args:
        robot: The robot that walks.
        gait: The walk, in the world of the plates.
        forces: Force plates, z up.

    Raises:
        GaitError: With the difference.
    """
    walk = dataclasses.replace(gait, events=())
    found = event_differences(robot, walk, forces)
    late = [difference for kind in found for difference in kind.late]
    mean = float(np.mean(late)) if late else 0.0
    if len(late) > 1 and abs(mean) > _APART and len({difference > 0 for difference in late}) == 1:
        when = "later" if mean > 0 else "earlier"
        raise GaitError(
            f"by their motion the feet strike and leave the ground {1e3 * abs(mean):.0f} ms {when} than the "
            f"plates have it ({'; '.join(map(str, found))}): plates of another clock? The same is accepted"
        )
    if not late and len(_of_plates(robot, walk, forces)) > 1 and _by_motion(robot, walk):
        raise GaitError(
            "no heel strike or toe-off of the feet's motion is within 200 ms of one of the plates: plates of "
            "another clock or trial? The same clock is accepted"
        )


def _of_plates(robot: Robot, walk: Gait, forces: Sequence[ForcePlate]) -> tuple[Event, ...]:
    try:
        return plate_events(robot, walk, forces)
    except GaitError:
        return ()


def _by_motion(robot: Robot, walk: Gait) -> tuple[Event, ...]:
    try:
        return events(robot, walk)
    except GaitError:
        return ()
