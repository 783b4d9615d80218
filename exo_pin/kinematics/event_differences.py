"""Differences of a walk's events to those of force plates: by the file's events, and by kinematics."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from exo_pin.anatomy.names import EventKind
from exo_pin.errors import GaitError
from exo_pin.gait import Event, Gait
from exo_pin.gait.event import EVENT_KINDS
from exo_pin.gait.trial import ForcePlate
from exo_pin.kinematics.plate_contacts import plate_events, same_moment
from exo_pin.kinematics.sole_contact import events
from exo_pin.robot import Robot

CONSISTENT = 0.05
"""Events that differ by more [s] are not the plates': O'Connor 2007 found 16 + 2 x 15 ms (mean, 2 sd)."""

_WORDS: dict[EventKind, str] = {"heel_strike": "heel strikes", "toe_off": "toe-offs"}


class EventDifference(NamedTuple):
    """How late events of one origin and kind are, against force plates.

    Attributes:
        source: The events' own source, e.g. `"C3D event"` or `"Zeni 2008"`.
        kind: `"heel_strike"` or `"toe_off"`.
        late: `(n,)` event minus plate, of each contact that both found [s].
    """

    source: str
    kind: EventKind
    late: tuple[float, ...]

    @property
    def mean(self) -> float:
        """Mean of the differences [s]."""
        return float(np.mean(self.late))

    @property
    def largest(self) -> float:
        """The difference furthest from 0, with its sign [s]."""
        return max(self.late, key=abs)

    def __str__(self) -> str:
        n = len(self.late)
        count = f"{n} contact{'s' * (n != 1)}, at most {1e3 * self.largest:+.0f}"
        return f"{_WORDS[self.kind]} by {self.source} {1e3 * self.mean:+.0f} ms ({count})"


def event_differences(robot: Robot, gait: Gait, forces: Iterable[ForcePlate]) -> tuple[EventDifference, ...]:
    """The walk's own events, then those of its kinematics, against the plates; empty where they share none.

    Args:
        robot: The robot that walks.
        gait: The walk as its file has it, in the world of the plates.
        forces: Force plates, z up.
    """
    try:
        measured = plate_events(robot, gait, forces)
    except GaitError:
        return ()
    return (*differences(gait.events, measured), *differences(_by_kinematics(robot, gait), measured))


def disagreements(found: Iterable[EventDifference]) -> tuple[str, ...]:
    """The differences that are too large for events of the same contacts, a sentence each."""
    return tuple(
        f"{_WORDS[x.kind]} by {x.source} differ from the force plates by {1e3 * x.largest:+.0f} ms, more "
        f"than {1e3 * CONSISTENT:.0f}: another trial's forces, or clocks that differ?"
        for x in found
        if abs(x.largest) > CONSISTENT
    )


def _by_kinematics(robot: Robot, gait: Gait) -> tuple[Event, ...]:
    try:
        return events(robot, dataclasses.replace(gait, events=()))
    except GaitError:
        return ()


def differences(known: Sequence[Event], measured: Sequence[Event]) -> tuple[EventDifference, ...]:
    """How late known events are against those of the plates, by source and kind, kinds in their order."""
    late: dict[tuple[EventKind, str], list[float]] = {}
    for plate in measured:
        near = [event for event in known if same_moment(event, plate)]
        if near:
            event = min(near, key=lambda event: abs(event.time - plate.time))
            late.setdefault((plate.kind, event.source), []).append(event.time - plate.time)
    ordered = sorted(late, key=lambda key: EVENT_KINDS.index(key[0]))
    return tuple(EventDifference(source, kind, tuple(late[kind, source])) for kind, source in ordered)
