"""Contacts of the feet with force plates: which foot, and when it struck and left the ground."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.names import EventKind, Side
from exo_pin.arrays import Array
from exo_pin.errors import GaitError
from exo_pin.gait import Event, Gait, force_plates
from exo_pin.gait.event import EVENT_KINDS
from exo_pin.gait.trial import ForcePlate
from exo_pin.kinematics.sole_contact import with_events
from exo_pin.kinematics.sole_points import sole_points
from exo_pin.robot import Robot

FARTHEST = 0.3
"""A foot whose sole is further from the force than this [m] is not the one on the plate."""

_SAME_CONTACT = 0.2
"""Two strikes of a foot are further apart than this [s]; a stride takes 0.4 s or more."""

_MOVED = ", set by the plates"
"""Added to the source of an event of kinematics that was moved by what plates saw of others."""

_CLEARLY = 0.5
"""The other foot must be at least this many times further away, else the foot on the plate is not known."""

_SHARED = 0.05
"""A force that acts so long [s] under the other foot, or away from the foot, is not one foot's alone."""

LOADED_PART = 0.1
"""Part of a contact's largest force from which on its centre of pressure is used: with less it wanders."""


class PlateStep(NamedTuple):
    """One contact of a force plate, and the foot that made it.

    Attributes:
        plate: The force plate.
        contact: When it was loaded.
        side: The foot; None where it is not known, or the walk is at another time.
        why: Why it is not known; empty where it is, or where the walk is at another time.
    """

    plate: ForcePlate
    contact: force_plates.Contact
    side: Side | None
    why: str

    @property
    def when(self) -> str:
        """The plate, and from when to when it was loaded, in words."""
        start, stop = self.plate.time[self.contact.start], self.plate.time[self.contact.stop - 1]
        return f"{self.plate.name}, {start:.2f} .. {stop:.2f} s"


class _PlateEvents(NamedTuple):
    """What force plates measured of a walk.

    Attributes:
        events: Sorted by time.
        remarks: Why contacts give no event, a sentence for each reason.
    """

    events: tuple[Event, ...]
    remarks: tuple[str, ...]


def plate_events(robot: Robot, gait: Gait, forces: Iterable[ForcePlate]) -> tuple[Event, ...]:
    """Heel strikes and toe-offs from force plates, z up; each contact belongs to the foot above it.

    A contact that could be either foot's, that two feet share, or nobody's, gives no event.

    Args:
        robot: The robot that walks.
        gait: The walk, in the world of the plates.
        forces: Force plates.

    Raises:
        GaitError: The gait does not move in the world, or no contact has a foot.
    """
    return _plate_events(robot, gait, forces).events


def plate_steps(robot: Robot, gait: Gait, forces: Iterable[ForcePlate]) -> tuple[PlateStep, ...]:
    """Every contact with a force plate, z up, and the foot above it.

    Args:
        robot: The robot that walks.
        gait: The walk, in the world of the plates.
        forces: Force plates.

    Raises:
        GaitError: The gait does not move in the world.
    """
    if gait.base is None:
        raise GaitError("the pelvis does not move in the world, so no foot can be found on a force plate")
    return steps_under(gait, sole_points(robot, gait), forces)


def steps_under(gait: Gait, soles: Array, forces: Iterable[ForcePlate]) -> tuple[PlateStep, ...]:
    """The same from the paths of the soles.

    Args:
        gait: The walk.
        soles: `(n, 2, 2, 3)` left and right foot: heel and ball in the world [m].
        forces: Force plates.
    """
    soles = soles.mean(axis=2)
    return tuple(
        PlateStep(plate, contact, *_whose(gait.time, soles, plate, contact))
        for plate in forces
        for contact in force_plates.contacts(plate.time, plate.force[:, 2])
    )


def _plate_events(robot: Robot, gait: Gait, forces: Iterable[ForcePlate]) -> _PlateEvents:
    """Events and what gives none; errors as of `plate_events`."""
    steps, unused = plate_steps(robot, gait, forces), dict[str, list[str]]()  # reason -> contacts
    for step in steps:
        if step.why:
            unused.setdefault(step.why, []).append(step.when)
    found = step_events(gait, steps)
    contacts = [f"{'; '.join(of)}: {why}" for why, of in unused.items()]
    if not found:
        raise GaitError(": ".join(("no contact of a foot with a force plate was found", *contacts)))
    return _PlateEvents(found, tuple(f"no event by {words}" for words in contacts))


def step_events(gait: Gait, steps: Iterable[PlateStep]) -> tuple[Event, ...]:
    """Heel strikes and toe-offs of the contacts whose foot is known, within the walk, sorted by time."""
    found = list[Event]()
    for _, contact, side, _ in steps:
        times: dict[EventKind, float | None] = {"heel_strike": contact.strike, "toe_off": contact.off}
        for kind, t in times.items():
            if side and t is not None and gait.time[0] <= t <= gait.time[-1]:
                found.append(Event(t, kind, side, force_plates.FORCE_PLATE))
    return tuple(sorted(found, key=lambda event: event.time))


def with_plates(robot: Robot, gait: Gait, forces: Iterable[ForcePlate]) -> Gait:
    """The gait with events: those of the plates, and beside them its own or those of its kinematics.

    A plate measures a step or two, a walk has more; each event says its source. Kinematics find all strikes
    early and all toe-offs late, so those beside the plates' are moved by the mean difference at these: a
    stride from a measured strike to a found one would be short (by 50 ms of 830 on HC036A). A motion in
    which there is no walk, as standing on a plate, stays as it is.

    Args:
        robot: The robot that walks.
        gait: The walk, in the world of the plates.
        forces: Force plates, z up.

    Raises:
        GaitError: As `plate_events`.
    """
    measured, remarks = _plate_events(robot, gait, forces)
    gait = dataclasses.replace(gait, remarks=(*gait.remarks, *remarks))
    try:
        known = with_events(robot, gait).events
    except GaitError:
        return gait
    return merged_events(gait, known, measured)


def merged_events(gait: Gait, known: Iterable[Event], measured: Iterable[Event]) -> Gait:
    """The gait with the plates' events, and beside them the known ones, moved where they are kinematics'.

    Args:
        gait: The walk.
        known: Its own events, or those of its kinematics where it has none.
        measured: Those of the plates.
    """
    known, measured = tuple(known), tuple(measured)
    others = [e for e in known if not any(same_moment(e, plate) for plate in measured)]
    if not gait.events:
        late = {kind: _late(known, measured, kind) for kind in EVENT_KINDS}
        moved = [Event(e.time + late[e.kind], e.kind, e.side, e.source + _MOVED) for e in others]
        others = [e for e in moved if gait.time[0] <= e.time <= gait.time[-1]]
    found = sorted([*measured, *others], key=lambda event: event.time)
    return dataclasses.replace(gait, events=tuple(found))


def _late(known: Iterable[Event], measured: Iterable[Event], kind: EventKind) -> float:
    """How much later than the known events of a kind the plates' are, in the mean [s]; 0 if unknown."""
    known = list(known)
    apart = [m.time - e.time for m in measured if m.kind == kind for e in known if same_moment(e, m)]
    return float(np.mean(apart)) if apart else 0.0


def same_moment(one: Event, other: Event) -> bool:
    """Whether two ways found the same moment of the same foot."""
    return (one.kind, one.side) == (other.kind, other.side) and abs(one.time - other.time) < _SAME_CONTACT


def _whose(
    time: Array, soles: Array, plate: ForcePlate, contact: force_plates.Contact
) -> tuple[Side | None, str]:
    """The side of the foot that is nearest to the force all the time; or None, and why."""
    rows = slice(contact.start, contact.stop)
    t, point, force = plate.time[rows], plate.point[rows, :2], plate.force[rows, 2]
    seen = (t >= time[0]) & (t <= time[-1]) & np.isfinite(point).all(axis=1)
    seen &= force >= LOADED_PART * np.nanmax(force)  # a small force acts at no certain point
    if not seen.any():
        return None, ""  # outside the walk
    away = np.empty((len(SIDES), int(seen.sum())))
    for k in range(len(SIDES)):
        path = np.stack([np.interp(t[seen], time, soles[:, k, axis]) for axis in range(2)], axis=1)
        away[k] = np.linalg.norm(path - point[seen], axis=1)
    step = float(np.median(np.diff(plate.time)))
    left, right = np.median(away, axis=1)
    nearest = int(right < left)
    mine, other = away[nearest], away[1 - nearest]
    if np.median(mine) > FARTHEST:
        return None, "no foot is there"
    others = (mine > FARTHEST) | ((other <= FARTHEST) & (other < _CLEARLY * mine))
    if step * others.sum() >= _SHARED:
        return None, "both feet load it"
    if np.median(mine) > _CLEARLY * np.median(other):
        return None, "either foot could be the one on it"
    return SIDES[nearest], ""
