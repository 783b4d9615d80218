"""What a table of numbers cannot say, kept in comment lines `# key: value`: events, period, source."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

from exo_pin.arrays import Array
from exo_pin.errors import FormatError, GaitError
from exo_pin.gait import Event, Gait

MOST_EVENTS = 100_000
"""A day's walk: bounds memory."""


class Note(NamedTuple):
    """One comment line."""

    line: int
    key: str
    value: str


class Notes(NamedTuple):
    """The notes of a walk; other comments are for people."""

    events: tuple[Event, ...] = ()
    periodic: bool = False
    source: str | None = None


def to_lines(notes: Notes) -> list[str]:
    """The comment lines that `read` turns back into the same notes."""
    events = (
        f"# event: {event.time!r} {event.kind} {event.side} {json.dumps(event.source)}"
        for event in notes.events
    )
    return [
        f"# source: {json.dumps(notes.source or '')}",
        f"# periodic: {str(notes.periodic).lower()}",
        *events,
    ]


def split(lines: Iterable[str], *, first: int = 1) -> list[Note]:
    """The `# key: value` lines among `lines`; `first` is the number of the first line."""
    notes = []
    for number, line in enumerate(lines, first):
        key, colon, value = line.lstrip("# \t").partition(":")
        if line.startswith("#") and colon:
            notes.append(Note(number, key.strip().lower(), value.strip()))
    return notes


def read(path: Path, notes: Sequence[Note]) -> Notes:
    """Events, period and source.

    Raises:
        FormatError: If one of these lines is malformed.
    """
    said = [note for note in notes if note.key == "event"]
    if len(said) > MOST_EVENTS:
        raise FormatError(
            path, f"{len(said)} events; at most {MOST_EVENTS} are read", line=said[MOST_EVENTS].line
        )
    events = tuple(_event(path, note) for note in said)
    periodic = [_truth(path, note) for note in notes if note.key == "periodic"]
    source = [_text(path, note, note.value) for note in notes if note.key == "source"]
    return Notes(events, any(periodic), "; ".join(source) if source else None)


def to_gait(path: Path, time: Array, q: Array, base: Array | None, notes: Notes) -> Gait:
    """The gait that a file describes; its source is the file's name if the file does not say.

    Raises:
        FormatError: If the numbers are no walk.
    """
    source = path.name if notes.source is None else notes.source
    try:
        return Gait(time, q, base=base, events=notes.events, periodic=notes.periodic, source=source)
    except GaitError as error:
        raise FormatError(path, str(error)) from error


def _event(path: Path, note: Note) -> Event:
    time, kind, side, source, *_ = [*note.value.split(maxsplit=3), *[""] * 4]
    try:
        return Event(float(time), kind, side, _text(path, note, source))
    except ValueError as error:
        why = f"event {note.value!r}: expected 'time kind side', e.g. '0.62 toe_off left'"
        raise FormatError(path, why, line=note.line) from error
    except FormatError:
        raise
    except GaitError as error:
        raise FormatError(path, str(error), line=note.line) from error


def _truth(path: Path, note: Note) -> bool:
    if note.value.lower() not in ("true", "false"):
        raise FormatError(path, f"periodic is {note.value!r}, expected true or false", line=note.line)
    return note.value.lower() == "true"


def _text(path: Path, note: Note, value: str) -> str:
    """Words as they stand, or between quotation marks as JSON writes them."""
    if not value.startswith('"'):
        return value
    try:
        text = json.loads(value)
    except ValueError as error:
        raise FormatError(path, f"{note.key}: the quoted text is malformed", line=note.line) from error
    # no half characters, which nobody could print
    return str(text).encode("utf-8", "replace").decode("utf-8")
