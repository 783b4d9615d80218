"""Metadata of a walk in comment lines `# key: value` of a text file: events, period, source, pelvis poses."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple, cast

import numpy as np

from exo_pin.anatomy.names import EventKind, Side
from exo_pin.arrays import Array
from exo_pin.errors import FormatError, naming_file
from exo_pin.formats.tables.numeric_table import NumericTable
from exo_pin.formats.tables.pose_columns import pose_names, pose_values, read_poses
from exo_pin.gait import Event, Gait

MOST_EVENTS = 100_000
"""A day's walk: bounds memory."""

_PELVIS = "pelvis"
"""`# pelvis: x y z qw qx qy qz` [m, unit quaternion], a line for every sample."""


class Comment(NamedTuple):
    """One comment line `# key: value`."""

    line: int
    key: str
    value: str


class Metadata(NamedTuple):
    """What the columns of a table do not hold.

    Attributes:
        events: Foot contacts.
        periodic: Whether the walk repeats.
        source: Where the numbers come from; None where the file does not state it.
        remarks: What reading the file held, corrected or ignored, a plain sentence each; never written.
    """

    events: tuple[Event, ...] = ()
    periodic: bool = False
    source: str | None = None
    remarks: tuple[str, ...] = ()


def comment_lines(metadata: Metadata) -> list[str]:
    """The comment lines that `read_metadata` turns back into the same metadata."""
    events = (
        f"# event: {event.time!r} {event.kind} {event.side} {json.dumps(event.source)}"
        for event in metadata.events
    )
    return [
        f"# source: {json.dumps(metadata.source or '')}",
        f"# periodic: {str(metadata.periodic).lower()}",
        *events,
    ]


def pelvis_lines(base: Array | None) -> list[str]:
    """The comment lines that `read_pelvis` turns back into the same poses `(n, 4, 4)`.

    For a message that holds joints only, as a JointTrajectory.
    """
    rows = [] if base is None else pose_values(base).tolist()
    return [f"# {_PELVIS}: {' '.join(map(repr, row))}" for row in rows]


def comments_in(lines: Iterable[str], *, first: int = 1) -> list[Comment]:
    """The `# key: value` lines among `lines`; `first` is the number of the first line."""
    comments = []
    for number, line in enumerate(lines, first):
        key, colon, value = line.lstrip("# \t").partition(":")
        if line.startswith("#") and colon:
            comments.append(Comment(number, key.strip().lower(), value.strip()))
    return comments


def read_metadata(path: Path, comments: Sequence[Comment]) -> Metadata:
    """Events, period and source.

    Raises:
        FormatError: One of these lines is malformed.
    """
    lines = [comment for comment in comments if comment.key == "event"]
    if len(lines) > MOST_EVENTS:
        why = f"{len(lines)} events; at most {MOST_EVENTS} are read"
        raise FormatError(path, why, line=lines[MOST_EVENTS].line)
    events = tuple(_event(path, comment) for comment in lines)
    periodic = [_truth(path, comment) for comment in comments if comment.key == "periodic"]
    source = [_text(path, comment, comment.value) for comment in comments if comment.key == "source"]
    return Metadata(events, any(periodic), "; ".join(source) if source else None)


def read_pelvis(path: Path, comments: Sequence[Comment], n: int) -> Array | None:
    """The pelvis's poses of a walk.

    Args:
        path: The file, for messages.
        comments: Its comment lines.
        n: Samples of the walk.

    Returns:
        `(n, 4, 4)` T_world_pelvis [m], or None where there are no such lines.

    Raises:
        FormatError: The lines are not n, or hold no poses.
    """
    lines = [comment for comment in comments if comment.key == _PELVIS]
    if not lines:
        return None
    if len(lines) != n:
        raise FormatError(path, f"{len(lines)} lines '# {_PELVIS}: ...' for {n} points", line=lines[0].line)
    values = np.array([_pose(path, comment) for comment in lines])
    numbers = [comment.line for comment in lines]
    return read_poses(NumericTable(path, pose_names(_PELVIS), values, numbers), _PELVIS)


def event_of(time: float, kind: str, side: str, source: str) -> Event:
    """An event by the words of a file.

    Args:
        time: When [s].
        kind: One of `EVENT_KINDS`, else refused.
        side: One of `SIDES`, else refused.
        source: Where the event comes from, in words.

    Raises:
        GaitError: The time is not finite, or kind or side are unknown.
    """
    return Event(time, cast(EventKind, kind), cast(Side, side), source)  # Event itself checks both words


def to_gait(path: Path, time: Array, q: Array, base: Array | None, metadata: Metadata) -> Gait:
    """The gait that a file describes; its source is the file's name where the file states none.

    Args:
        path: The file.
        time: `(n,)` [s].
        q: `(n, 12)` joint angles [rad].
        base: `(n, 4, 4)` T_world_pelvis [m], or None.
        metadata: Events, period, source and remarks.

    Raises:
        FormatError: The numbers are no walk.
    """
    source = path.name if metadata.source is None else metadata.source
    with naming_file(path):
        return Gait(
            time,
            q,
            base=base,
            events=metadata.events,
            periodic=metadata.periodic,
            source=source,
            remarks=metadata.remarks,
        )


def _event(path: Path, comment: Comment) -> Event:
    time, kind, side, source, *_ = [*comment.value.split(maxsplit=3), *[""] * 4]
    try:
        with naming_file(path, line=comment.line):
            return event_of(float(time), kind, side, _text(path, comment, source))
    except ValueError as error:
        why = f"event {comment.value!r}: expected 'time kind side', e.g. '0.62 toe_off left'"
        raise FormatError(path, why, line=comment.line) from error


def _truth(path: Path, comment: Comment) -> bool:
    if comment.value.lower() not in ("true", "false"):
        why = f"periodic is {comment.value!r}, expected true or false"
        raise FormatError(path, why, line=comment.line)
    return comment.value.lower() == "true"


def _text(path: Path, comment: Comment, value: str) -> str:
    """Words as they stand, or between quotation marks as JSON writes them."""
    if not value.startswith('"'):
        return value
    try:
        text = json.loads(value)
    except ValueError as error:
        why = f"{comment.key}: the quoted text is malformed"
        raise FormatError(path, why, line=comment.line) from error
    # no half characters, which nobody could print
    return str(text).encode("utf-8", "replace").decode("utf-8")


def _pose(path: Path, comment: Comment) -> list[float]:
    try:
        numbers = [float(word) for word in comment.value.split()]
    except ValueError:
        numbers = []
    if len(numbers) != 7 or not np.isfinite(numbers).all():
        why = f"{_PELVIS}: expected x y z [m] and qw qx qy qz, seven numbers"
        raise FormatError(path, why, line=comment.line)
    return numbers
