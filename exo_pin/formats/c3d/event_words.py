"""Which foot strikes or leaves the ground, by an event's label and context in a laboratory's own words."""

from __future__ import annotations

import re

from exo_pin.anatomy.names import EventKind, Side

EVENT_WORDS: dict[EventKind, tuple[str, ...]] = {
    "heel_strike": (
        "foot strike",
        "heel strike",
        "foot contact",
        "heel contact",
        "initial contact",
        "ground contact",
        "touch down",
        "heel down",
        "foot down",
        "foot on",
        "strike",
        "contact",
        "hs",
        "fs",
        "ic",
        "hc",
        "fc",
        "td",
        "on",
    ),
    "toe_off": ("foot off", "toe off", "foot release", "foot up", "lift off", "off", "to", "fo"),
}
"""Kind of event -> its labels in lower case and single words; the first, Vicon's, is also written.

`on` and `off` are Visual3D's (`RON`, `LOFF`)."""

_KINDS = {word.replace(" ", ""): kind for kind, words in EVENT_WORDS.items() for word in words}
_SIDES: dict[str, Side] = {
    **dict.fromkeys(("left", "l", "lt", "lft"), "left"),
    **dict.fromkeys(("right", "r", "rt", "rgt"), "right"),
}
_FILLERS = ("foot", "leg", "limb", "side", "event")
"""Words that add nothing beside the kind and the side of an event."""

_NEW_WORD = re.compile(r"(?<=[a-z])(?=[A-Z])|(?<=\b[LR])(?=[A-Z][a-z])|[^A-Za-z]+")
"""`LeftToeOff`, `LHeelStrike`, `HS_L`, `RHS 2`: where a word ends."""


def kind_and_side(label: str, context: str) -> tuple[EventKind | None, Side | None]:
    """Kind and side of an event, each None where the words do not tell it.

    Args:
        label: What happened, perhaps whose: `Foot Strike`, `LHS`, `RON`, `HS_L`, `Right Toe Off`.
        context: Whose: `Left`, `Right`; another word or none leaves the side to the label.
    """
    kind, side = _label(label)
    stated = {_SIDES[word] for word in _words(context) if word in _SIDES}
    return kind, stated.pop() if len(stated) == 1 else side


def _label(label: str) -> tuple[EventKind | None, Side | None]:
    words = _words(label)
    sides = {_SIDES[word] for word in words if word in _SIDES}
    if len(sides) > 1:
        return None, None
    rest = [word for word in words if word not in _SIDES]
    side = next(iter(sides), None)
    for kept in (rest, [word for word in rest if word not in _FILLERS]):
        found = _compact("".join(kept), side)
        if found[0]:
            return found
    return None, side


def _compact(text: str, side: Side | None) -> tuple[EventKind | None, Side | None]:
    """Kind and side of letters without spaces, in which the side may be the first or the last one."""
    if text in _KINDS or side or len(text) < 2:
        return _KINDS.get(text), side
    for word in ("left", "right", "l", "r"):
        for rest in (text.removeprefix(word), text.removesuffix(word)):
            if rest != text and rest in _KINDS:
                return _KINDS[rest], _SIDES[word]
    return None, None


def _words(text: str) -> list[str]:
    return [word.lower() for word in _NEW_WORD.split(str(text)) if word]
