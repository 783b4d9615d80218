"""Heel strikes and toe-offs among the events of a C3D file, and what became of the others."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import zip_longest
from typing import NamedTuple

import numpy as np

from exo_pin.arrays import Array
from exo_pin.formats.c3d.event_words import kind_and_side
from exo_pin.gait import Event

_LABELS_QUOTED = 3
"""Different labels that are quoted where events are not understood."""

_LONGEST_LABEL = 24
"""Letters of a label that are quoted."""

_SAME_EVENT = 1e-4
"""Two events of one foot and kind closer than this [s] are one, written twice."""


class FootEvents(NamedTuple):
    """The foot contacts of a file.

    Attributes:
        events: Sorted by time.
        remarks: What happened to events that are not among them, a sentence each.
    """

    events: tuple[Event, ...]
    remarks: tuple[str, ...]


def foot_events(
    times: Array, labels: Sequence[str], contexts: Sequence[str], span: tuple[float, float], step: float
) -> FootEvents:
    """Heel strikes and toe-offs of a left or right foot within a span of time.

    Args:
        times: EVENT:TIMES in any of the layouts of `event_seconds`.
        labels: What happened: `Foot Strike`, `LHS`, `right toe off`.
        contexts: Whose: `Left`, `Right`, `General`; may be fewer than the labels.
        span: First and last time [s].
        step: From frame to frame [s]; an event up to half of it outside the span lies on the end of the span.
    """
    seconds = event_seconds(times, len(labels))
    if seconds is None:
        why = f"EVENT:TIMES has {times.size} numbers for {len(labels)} labels: no event of the file is used"
        return FootEvents((), (why,))
    found, unknown, outside = list[Event](), list[str](), list[float]()
    for time, label, context in zip_longest(seconds.tolist(), labels, contexts):
        words = (label or "").strip(), (context or "").strip()
        kind, side = kind_and_side(*words)
        if time is None or not kind or not side or not np.isfinite(time):
            if words[0] or time:  # else room that a program keeps for more events
                unknown.append(f"{words[0]} ({words[1]})" if words[1] else words[0])
        elif not span[0] - step / 2 <= time <= span[1] + step / 2:
            outside.append(time)
        else:
            found.append(Event(min(max(time, span[0]), span[1]), kind, side, "C3D event"))
    kept = _once(found)
    doubled = [f"{_events(len(found) - len(kept))} in the file twice"] if len(kept) < len(found) else []
    return FootEvents(kept, (*_not_understood(unknown), *_outside(outside, span), *doubled))


def event_seconds(times: Array, count: int) -> Array | None:
    """Times of events [s], most often `(count,)`, or None where the layout is not known.

    Known are rows of whole minutes and of seconds `(2, k)`, the same as columns `(k, 2)`, both flat (pairs of
    minutes and seconds, or all minutes before all seconds), and seconds alone.

    Args:
        times: As the file has them.
        count: Number of labels.
    """
    values = np.atleast_2d(np.asarray(times, dtype=float))
    if len(values) == 2:
        return _rounded(*values)
    flat = values.ravel()
    if flat.size == count:
        return np.asarray(np.round(flat, 6))
    if flat.size != 2 * count:
        return None
    pairs, halves = flat.reshape(-1, 2).T, flat.reshape(2, -1)
    return _rounded(*(pairs if _whole(pairs[0]) or not _whole(halves[0]) else halves))


def _whole(minutes: Array) -> bool:
    return bool((minutes == np.round(minutes)).all())


def _rounded(minutes: Array, seconds: Array) -> Array:
    return np.asarray(np.round(60 * minutes + seconds, 6))


def _once(events: Iterable[Event]) -> tuple[Event, ...]:
    """The events in order, without those that are there twice."""
    out = list[Event]()
    for event in sorted(events, key=lambda event: (event.side, event.kind, event.time)):
        last = out[-1] if out else None
        same = last and (last.side, last.kind) == (event.side, event.kind)
        if not (same and last and event.time - last.time < _SAME_EVENT):
            out.append(event)
    return tuple(sorted(out, key=lambda event: event.time))


def _events(count: int) -> str:
    return f"{count} event is" if count == 1 else f"{count} events are"


def _not_understood(labels: Sequence[str]) -> list[str]:
    if not labels:
        return []
    distinct = list(dict.fromkeys(labels))
    quoted = ", ".join(ascii(label[:_LONGEST_LABEL]) for label in distinct[:_LABELS_QUOTED])
    more = " ..." if len(distinct) > _LABELS_QUOTED else ""
    return [f"{_events(len(labels))} not understood as a foot's strike or toe-off: {quoted}{more}"]


def _outside(times: Sequence[float], span: tuple[float, float]) -> list[str]:
    if not times:
        return []
    first, last = span
    lie = "1 event lies" if len(times) == 1 else f"{len(times)} events lie"
    moved = first > 0 and min(times) >= 0 and max(times) <= last - first
    hint = "; counted from the first frame?" if moved else ""
    return [f"{lie} outside the trial, {first:.2f} .. {last:.2f} s, and cannot be used{hint}"]
