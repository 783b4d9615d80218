"""Grading of a walk on a device: fits, fits with the smallest concession, or does not fit.

Three grades. The device *fits* where it can copy the walk in the joints that it drives; it fits with a
*concession* where the recorded knee must be held at its stop, or the walk be slower or smaller; else *no*.
Joints that it locks do not enter the verdict: what the feet lose by them stands beside it.
"""

from __future__ import annotations

import contextlib
from typing import get_args

from exo_pin import devices
from exo_pin.anatomy import Body
from exo_pin.anatomy.names import FitWord, HipOrder, KneeRule, PelvisMotion
from exo_pin.arguments import word
from exo_pin.compare import Conditions
from exo_pin.devices import Device
from exo_pin.errors import GaitError
from exo_pin.feasible.assessment import feasible
from exo_pin.feasible.belt import within_belt
from exo_pin.feasible.concession import knee_concession, other_walks
from exo_pin.feasible.device_walk import DeviceWalk
from exo_pin.feasible.feasibility import Feasibility
from exo_pin.feasible.knee_stop import bent, held_at_stop
from exo_pin.gait import Gait, Torques
from exo_pin.kinematics import with_events
from exo_pin.robot import Robot, load_robot


def pelvis_by_default(device: Device) -> PelvisMotion:
    """A device whose stand has slides holds the pelvis itself; any other goes along with the recorded one."""
    return "device" if device.slides else "recorded"


def device_walk(
    gait: Gait,
    device: str | Device = "exo12",
    body: Body | None = None,
    *,
    pelvis: PelvisMotion | None = None,
    knee: KneeRule = "stop",
    acceleration: float | None = None,
    gap: float = 0.0,
    torques: Torques | None = None,
    hip_order: HipOrder = "clinical",
) -> DeviceWalk:
    """A device's answer to a walk.

    Args:
        gait: The walk. The accelerations of a recording carry its noise: filter it first.
        device: Name, file or record.
        body: Who wears it; `Body.from_stature()` if left out.
        pelvis: Who moves the pelvis; `pelvis_by_default` if left out.
        knee: What becomes of a recorded knee beyond its stop.
        acceleration: Largest acceleration of every joint [rad/s^2]; the device's own if left out.
        gap: Distance that parts of the device must keep [m].
        torques: Joint torques of the walk; not checked if left out, nor at another cadence or amplitude.
        hip_order: Order of the hip axes, which have the limits.

    Raises:
        UnknownNameError: The device, the rule for the knee or who moves the pelvis is unknown.
        GaitError: The torques are at other times than the walk.
        DescriptionError: Acceleration or gap is no finite number.
    """
    word("rule for the knee", knee, get_args(KneeRule))
    device = devices.find(device)
    conditions = Conditions(pelvis_by_default(device) if pelvis is None else pelvis)

    def assessed(walk: Gait, tau: Torques | None) -> Feasibility:
        return feasible(
            walk, device, body, acceleration=acceleration, gap=gap, torques=tau, hip_order=hip_order
        )

    full = load_robot(body)
    with contextlib.suppress(GaitError):  # its own, not those of a walk with held knees: they set the speed
        gait = with_events(full, gait)
    start = bent(full, gait) if knee == "bend" and _hyperextends(full, gait) else gait
    first = assessed(start, torques)
    held = held_at_stop(full, first.robot, start) if knee == "stop" else None
    made = () if held is None else (knee_concession(held),)
    walk = start if held is None else held.gait
    found = first if held is None else assessed(walk, torques)
    if found.failures:
        tried = (pair for pair in other_walks(walk, found) if not assessed(pair[1], None).failures)
        concession, walk = next(tried, (None, start))
        made = () if concession is None else (*made, concession)
        verdict: FitWord = "no" if concession is None else "concession"
    else:
        verdict = "concession" if made else "fits"
    answer = DeviceWalk(device, gait, walk, first, verdict, made, conditions)
    return within_belt(answer, lambda slower: not assessed(slower, None).failures)


def _hyperextends(robot: Robot, gait: Gait) -> bool:
    return held_at_stop(robot, robot, gait) is not None
