"""Foot contacts that a C3D file states, in the words of different laboratories."""

from __future__ import annotations

import re
from collections.abc import Iterable

import numpy as np

from exo_pin.arrays import Array
from exo_pin.gait import Event

WORDS = {
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
"""Kind -> what it is called, in lower case; Vicon's word first, which is also written."""

LETTERS = {"hs": "heel_strike", "fs": "heel_strike", "ic": "heel_strike", "to": "toe_off", "fo": "toe_off"}
"""The same behind the letter of a side: `LHS`, `R_TO`."""

KINDS = {word: kind for kind, words in WORDS.items() for word in words}
SIDED = re.compile(r"(?P<side>left|right|l|r) ?(?P<rest>.+)")


def foot_events(
    minutes_seconds: Array,
    labels: Iterable[str],
    contexts: Iterable[str],
    span: tuple[float, float],
) -> tuple[Event, ...]:
    """Strikes and offs of a left or right foot within a span of time, in their order.

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
        kind, side = _meaning(_plain(label), _plain(context))
        if kind and side and span[0] <= time <= span[1]:
            events.append(Event(time, kind, side, "C3D event"))
    return tuple(sorted(events, key=lambda event: event.time))


def _plain(text: str) -> str:
    return " ".join(str(text).lower().replace("_", " ").replace("-", " ").split())


def _meaning(label: str, context: str) -> tuple[str, str]:
    """Kind and side, or empty words; the context's side goes before the label's."""
    side = {"left": "left", "right": "right", "l": "left", "r": "right"}.get(context, "")
    if label in KINDS:
        return KINDS[label], side
    match = SIDED.fullmatch(label)
    if match is None:
        return LETTERS.get(label, ""), side
    kind = KINDS.get(match["rest"], LETTERS.get(match["rest"], ""))
    return kind, side or ("left" if match["side"][0] == "l" else "right")
