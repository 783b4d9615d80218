"""Force plates given to the feet: the wrench on each foot at the samples of a walk, and where it is known."""

from __future__ import annotations

import contextlib
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from exo_pin.anatomy import CORNERS, SIDES
from exo_pin.arrays import Array, Mask
from exo_pin.dynamics.ground_forces import GroundForces, from_wrenches, held
from exo_pin.dynamics.plate_checks import check_both_feet, check_plates, check_points, check_steps
from exo_pin.dynamics.plate_clock import check_event_times
from exo_pin.dynamics.standing_under_load import NO_FOOT, check_standing
from exo_pin.errors import GaitError
from exo_pin.gait import Event, Gait
from exo_pin.gait.trial import ForcePlate
from exo_pin.ground import lowest_corners
from exo_pin.ground.stance import standing_at_samples
from exo_pin.kinematics import PlateStep, events, poses
from exo_pin.kinematics.plate_contacts import merged_events, step_events, steps_under
from exo_pin.kinematics.sole_points import heels_and_balls
from exo_pin.robot import Robot

_EDGE = 0.05
"""A foot that stands this little [s] before or after its plate is loaded is not standing beside it: events of
kinematics are that uncertain."""


@dataclass(frozen=True, eq=False)
class PlateForces:
    """What force plates tell of a walk's ground reaction.

    Attributes:
        ground: Forces at the samples of the walk; NaN where `known` is False.
        known: `(n,)` whether each foot that stands does so on a plate of its own.
        remarks: What could not be used and why, a plain sentence each.
    """

    ground: GroundForces
    known: Mask
    remarks: tuple[str, ...]


def plate_forces(robot: Robot, gait: Gait, forces: Sequence[ForcePlate]) -> PlateForces:
    """The ground reaction that plates measured, foot by foot.

    Args:
        robot: The robot that walks, floating.
        gait: The walk, in the world of the plates, on their clock.
        forces: Force plates, z up.

    Raises:
        GaitError: The plates cannot belong to this walk, or no contact has a foot.
    """
    check_plates(gait, forces)
    corners = poses(robot, robot.from_gait(gait), CORNERS)[..., :3, 3]
    steps = steps_under(gait, heels_and_balls(corners), forces)
    moving = _events(robot, gait)
    stands = _standing_feet(gait, steps, corners, moving)
    check_standing(gait, corners, steps, gait.events or moving)
    check_steps(gait, steps, lowest_corners(corners))
    wrench, height = np.zeros((len(gait), 2, 6)), np.zeros((len(gait), 2))
    for step in steps:
        if step.side is not None:
            foot = SIDES.index(step.side)
            own, level = _at(step, gait.time)
            wrench[:, foot] += own
            height[:, foot] = np.where(np.isfinite(level), level, height[:, foot])
    check_both_feet(gait, steps, stands)
    beside = stands & ~_loaded(steps, gait.time)
    shared = _unassigned(steps, gait.time)
    outside = ~np.all([(gait.time >= p.time[0]) & (gait.time <= p.time[-1]) for p in forces], axis=0)
    known = np.asarray(~(beside.any(axis=1) | shared | outside))
    ground = from_wrenches(wrench, height)
    for values in (ground.force, ground.point, ground.moment):
        values[~known] = np.nan
    remarks = _remarks(known, np.asarray(beside.any(axis=1)), shared, outside, steps)
    return PlateForces(ground, known, remarks)


def _at(step: PlateStep, time: Array) -> tuple[Array, Array]:
    """Wrench `(n, 6)` about the world's origin of one contact at these times, 0 outside it; ground height."""
    plate, contact = step.plate, step.contact
    rows = slice(contact.start, contact.stop)
    check_points(step)
    force, point = plate.force[rows], held(plate.point[rows])
    moment = np.cross(point, force) + np.nan_to_num(plate.moment[rows])
    t, wrench = plate.time[rows], np.hstack([force, moment])
    if contact.strike is not None:  # it begins and ends with no force, where the plates saw that
        t, wrench = np.concatenate([[contact.strike], t]), np.vstack([np.zeros(6), wrench])
    if contact.off is not None:
        t, wrench = np.concatenate([t, [contact.off]]), np.vstack([wrench, np.zeros(6)])
    own = np.column_stack([np.interp(time, t, column, left=0.0, right=0.0) for column in wrench.T])
    inside = (time >= t[0]) & (time <= t[-1])
    return own, np.where(inside, float(np.median(point[:, 2])), np.nan)


def _events(robot: Robot, gait: Gait) -> tuple[Event, ...]:
    """Heel strikes and toe-offs of the motion; none where somebody stands, or in a part of a stance."""
    with contextlib.suppress(GaitError):
        return events(robot, gait)
    return ()


def _standing_feet(gait: Gait, steps: Sequence[PlateStep], corners: Array, moving: Sequence[Event]) -> Mask:
    """`(n, 2)` which foot stands, by plates and events, else by the heights of the soles.

    Raises:
        GaitError: The events of the plates are at other times than those of the feet.
    """
    measured = step_events(gait, steps)
    check_event_times(moving, measured)
    walk = merged_events(gait, gait.events or moving, measured)
    return standing_at_samples(walk, corners)


def _loaded(steps: Sequence[PlateStep], time: Array) -> Mask:
    """`(n, 2)` whether a plate bears the foot, or does so within `_EDGE`."""
    loaded = np.zeros((len(time), 2), dtype=bool)
    for step in steps:
        if step.side is not None:
            loaded[:, SIDES.index(step.side)] |= _during(step, time, _EDGE)
    return loaded


def _unassigned(steps: Sequence[PlateStep], time: Array) -> Mask:
    """`(n,)` whether a plate bears a force whose foot is not known, or two feet."""
    shared = np.zeros(len(time), dtype=bool)
    for step in steps:
        if step.side is None and step.why != NO_FOOT:
            shared |= _during(step, time, 0.0)
    return shared


def _during(step: PlateStep, time: Array, edge: float) -> Mask:
    start, stop = step.plate.time[step.contact.start], step.plate.time[step.contact.stop - 1]
    return np.asarray((time >= start - edge) & (time <= stop + edge))


def _remarks(
    known: Mask, beside: Mask, shared: Mask, outside: Mask, steps: Sequence[PlateStep]
) -> tuple[str, ...]:
    """Why samples have no ground reaction, with their numbers."""
    n = len(known)
    reasons = [
        (outside, "the plates were not recorded"),
        (beside & ~outside, "a foot stands on no plate"),
        (shared & ~beside & ~outside, "the force of a plate is not one foot's alone"),
    ]
    out = [f"{int(mask.sum())} of {n} frames are not valid: {why}" for mask, why in reasons if mask.any()]
    nobody = {step.plate.name for step in steps if step.why == NO_FOOT}
    if nobody:
        out.append(f"a force on {', '.join(sorted(nobody))} is not used: {NO_FOOT}")
    return tuple(out)
