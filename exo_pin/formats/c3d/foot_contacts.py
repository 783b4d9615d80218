"""Heel strikes and toe-offs in the event labels of a C3D file, as different laboratories write them."""

from __future__ import annotations

import re
from collections.abc import Iterable

import numpy as np

from exo_pin.anatomy.names import EventKind, Side
from exo_pin.arrays import Array
from exo_pin.gait import Event

EVENT_WORDS: dict[EventKind, tuple[str, ...]] = {
    "heel_strike": (
        "foot strike",
        "heel strike",
        "footstrike",
        "heelstrike",
        "foot contact",
        "initial contact",
    ),
    "toe_off": ("foot off", "toe off", "footoff", "toeoff", "foot release"),
}
"""Kind of event -> its labels in lower case; the first, Vicon's, is also written."""

_LETTERS: dict[str, EventKind] = {
    **dict.fromkeys(("hs", "fs", "ic"), "heel_strike"),
    **dict.fromkeys(("to", "fo"), "toe_off"),
}
"""The same behind the letter of a side: `LHS`, `R_TO`."""

_KINDS: dict[str, EventKind] = {word: kind for kind, words in EVENT_WORDS.items() for word in words}
_CONTEXTS: dict[str, Side] = {"left": "left", "right": "right", "l": "left", "r": "right"}
_SIDED = re.compile(r"(?P<side>left|right|l|r) ?(?P<rest>.+)")


def foot_events(
    minutes_seconds: Array,
    labels: Iterable[str],
    contexts: Iterable[str],
    span: tuple[float, float],
) -> tuple[Event, ...]:
    """Heel strikes and toe-offs of a left or right foot within a span of time, in their order.

    Args:
        minutes_seconds: `(2, k)` as the file has it: whole minutes above seconds.
        labels: What happened: `Foot Strike`, `LHS`, `right toe off`.
        contexts: Whose: `Left`, `Right`, `General`.
        span: First and last time [s].
    """
    if minutes_seconds.ndim != 2 or len(minutes_seconds) != 2:
        return ()
    seconds = np.round(60 * minutes_seconds[0] + minutes_seconds[1], 6).tolist()
    events = []
    for time, label, context in zip(seconds, labels, contexts, strict=False):
        kind, side = _kind_and_side(_plain(label), _plain(context))
        if kind and side and span[0] <= time <= span[1]:
            events.append(Event(time, kind, side, "C3D event"))
    return tuple(sorted(events, key=lambda event: event.time))


def _plain(text: str) -> str:
    return " ".join(str(text).lower().replace("_", " ").replace("-", " ").split())


def _kind_and_side(label: str, context: str) -> tuple[EventKind | None, Side | None]:
    """Kind and side, None where the label is not known; the side in the context goes before the label's."""
    side = _CONTEXTS.get(context)
    if label in _KINDS:
        return _KINDS[label], side
    match = _SIDED.fullmatch(label)
    if match is None:
        return _LETTERS.get(label), side
    kind = _KINDS.get(match["rest"], _LETTERS.get(match["rest"]))
    return kind, side or _CONTEXTS[match["side"][0]]
