"""The manner of a gait, walk or run, by its contacts: whether a runner flies between them."""

from __future__ import annotations

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.names import Manner
from exo_pin.gait.event import Event, between, stance_shares, times_of
from exo_pin.gait.gait import Gait
from exo_pin.gait.running_method import RUNNING_SOURCES
from exo_pin.gait.strides import unrolled

_RUNS_STANCE = 0.5
"""A run's foot stands for less than this part of the stride."""


def manner(gait: Gait) -> Manner:
    """`"run"` where most steps have a flight between the contacts, or most stances are under half a stride.

    A walk without events, or with too few to tell, is `"walk"`.
    """
    events = unrolled(gait).events
    if any(event.source.startswith(RUNNING_SOURCES) for event in events):
        return "run"
    flights = _flights(events)
    if flights:
        return "run" if np.mean(flights) > 0.5 else "walk"
    stances = [share for side in SIDES for share in stance_shares(events, side)]
    return "run" if stances and np.median(stances) < _RUNS_STANCE else "walk"


def contacts_are_measured(gait: Gait) -> bool:
    """Whether contacts of a run do not come from its kinematics alone: some are a plate's, or the file's."""
    sources = {event.source for event in gait.events}
    return any(not source.startswith(RUNNING_SOURCES) for source in sources)


def _flights(events: tuple[Event, ...]) -> list[bool]:
    """Of each step whose first foot leaves the ground: whether it does before the other foot strikes."""
    strikes = [e for e in events if e.kind == "heel_strike"]
    offs = {side: times_of(events, "toe_off", side) for side in SIDES}
    found = []
    for a, b, following in zip(strikes, strikes[1:], [*strikes[2:], None], strict=False):
        if a.side == b.side:
            continue
        until = following.time if following else np.inf
        left = between(offs[a.side], a.time, until)
        found += [left[0] < b.time] if left else []
    return found
