"""What a walk's feet tell: its spatiotemporal numbers, and whose force a plate measured."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from exo_pin.anatomy import CORNERS, FEET, SIDES
from exo_pin.arrays import Array
from exo_pin.errors import GaitError
from exo_pin.gait import Event, Gait, force_plates
from exo_pin.gait.event import EVENT_KINDS
from exo_pin.gait.spatiotemporal import Number
from exo_pin.gait.spatiotemporal import spatiotemporal as numbers_of
from exo_pin.gait.strides import strides, unrolled
from exo_pin.kinematics.contact import with_events
from exo_pin.kinematics.motion import poses
from exo_pin.robot import Robot

if TYPE_CHECKING:  # the formats are many files, and only a name is needed
    from exo_pin.formats import ForcePlate


NEAR = 0.3
"""A foot whose sole is further from the force than this [m] is not the one on the plate."""

SAME = 0.2
"""Two strikes of a foot are further apart than this [s]; a stride takes 0.4 s or more."""

MOVED = ", set by the plates"
"""Added to the source of an event of kinematics that was moved by what plates saw of others."""

CLEARLY = 0.5
"""The other foot must be at least this many times further away, or nobody can tell whose the force is."""


def spatiotemporal(robot: Robot, gait: Gait) -> dict[str, Number]:
    """Cadence, speed, lengths, width and phases of a gait; see `exo_pin.gait.spatiotemporal`.

    Events are the gait's own, or those of its kinematics. Lengths are those of this robot's legs.

    Pauses, turns and other spans that are no strides (`exo_pin.gait.strides`) are left out.

    Raises:
        GaitError: There are no gait cycles.
    """
    gait = with_events(robot, gait)
    walk = unrolled(gait)
    spans = [span for side in SIDES for span in strides(walk, side)]
    counted = [span for span in spans if not span.why]
    if spans and not counted:
        raise GaitError(f"no gait cycles found: {spans[0].why}")
    return numbers_of(
        walk.time,
        _soles(robot, walk)[:, :, 0],
        walk.events,
        pelvis=None if walk.base is None else walk.base[:, :2, 3],
        spans=counted,
        until=gait.duration if gait.periodic else float("inf"),
    )


def plate_events(robot: Robot, gait: Gait, forces: Iterable[ForcePlate]) -> tuple[Event, ...]:
    """Heel strikes and toe-offs from force plates, z up; each contact belongs to the foot above it.

    A contact that could be either foot's, or nobody's, gives no event.

    Args:
        robot: The robot that walks.
        gait: The walk, in the world of the plates.
        forces: Force plates.

    Raises:
        GaitError: The gait does not move in the world, or no contact could be told.
    """
    if gait.base is None:
        raise GaitError("the pelvis does not move in the world, so no foot can be found on a force plate")
    soles = _soles(robot, gait).mean(axis=2)
    found = []
    for plate in forces:
        for contact in force_plates.contacts(plate.time, plate.force[:, 2]):
            side = _whose(gait.time, soles, plate, contact)
            times = {"heel_strike": contact.strike, "toe_off": contact.off}
            for kind, t in times.items():
                if side and t is not None and gait.time[0] <= t <= gait.time[-1]:
                    found.append(Event(t, kind, side, force_plates.FORCE_PLATE))
    if not found:
        raise GaitError("no contact of a foot with a force plate was found")
    return tuple(sorted(found, key=lambda event: event.time))


def with_plates(robot: Robot, gait: Gait, forces: Iterable[ForcePlate]) -> Gait:
    """The gait with events: those of the plates, and beside them its own or those of its kinematics.

    A plate measures a step or two, a walk has more; each event says its source. Kinematics find all strikes
    early and all toe-offs late, so those beside the plates' are moved by the mean difference at these: a
    stride from a measured strike to a found one would be short (by 50 ms of 830 on HC036A). A motion in
    which there is no walk, as standing on a plate, stays as it is.

    Raises:
        GaitError: As `plate_events`.
    """
    measured = plate_events(robot, gait, forces)
    try:
        known = with_events(robot, gait).events
    except GaitError:
        return gait
    others = [e for e in known if not any(_same(e, plate) for plate in measured)]
    if not gait.events:
        late = {kind: _late(known, measured, kind) for kind in EVENT_KINDS}
        moved = [Event(e.time + late[e.kind], e.kind, e.side, e.source + MOVED) for e in others]
        others = [e for e in moved if gait.time[0] <= e.time <= gait.time[-1]]
    found = sorted([*measured, *others], key=lambda event: event.time)
    return dataclasses.replace(gait, events=tuple(found))


def _late(known: Iterable[Event], measured: Iterable[Event], kind: str) -> float:
    """How much later than the known events of a kind the plates' are, in the mean [s]; 0 if unknown."""
    known = list(known)
    apart = [m.time - e.time for m in measured if m.kind == kind for e in known if _same(e, m)]
    return float(np.mean(apart)) if apart else 0.0


def _same(one: Event, other: Event) -> bool:
    """Whether two ways found the same moment of the same foot."""
    return (one.kind, one.side) == (other.kind, other.side) and abs(one.time - other.time) < SAME


def _whose(time: Array, soles: Array, plate: ForcePlate, contact: force_plates.Contact) -> str:
    """The side of the foot that is nearest to the force all the time, or "" where that is not clear."""
    rows = slice(contact.start, contact.stop)
    t, point = plate.time[rows], plate.point[rows, :2]
    seen = (t >= time[0]) & (t <= time[-1])
    if not seen.any():
        return ""
    away = np.empty(len(SIDES))
    for k in range(len(SIDES)):
        path = np.stack([np.interp(t[seen], time, soles[:, k, axis]) for axis in range(2)], axis=1)
        away[k] = np.median(np.linalg.norm(path - point[seen], axis=1))
    nearest = int(away.argmin())
    if away[nearest] > NEAR or away[nearest] > CLEARLY * away[1 - nearest]:
        return ""
    return SIDES[nearest]


def _soles(robot: Robot, gait: Gait) -> Array:
    """`(n, 2, 2, 3)` left and right foot: heel and ball, midway between their corners [m]."""
    base = robot.base_of(gait)
    corners = poses(robot, robot.from_gait(gait), CORNERS, base=base)[..., :3, 3]
    return np.asarray(corners.reshape(len(gait), len(FEET), 2, 2, 3).mean(axis=3))
