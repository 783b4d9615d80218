"""Header and parameter records of a C3D file, checked before anything else reads it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from exo_pin.errors import FormatError

INTEL, DEC, MIPS = 84, 85, 86
PROCESSORS = {INTEL: "<u2", DEC: "<u2", MIPS: ">u2"}
"""Processor that wrote the numbers -> its whole numbers."""

_SIGN_BYTES = {INTEL: 15, DEC: 13, MIPS: 12}
"""Processor -> the byte of the header with the sign of the scale."""

_BLOCK = 512
_KEY = 0x50
_MOST_PARAMETERS = 20_000
_FOUR_LETTERS = 12345
"""The word before the header's events where their labels have four letters."""

_MOST_HEADER_EVENTS = 18


class Layout(NamedTuple):
    """The sizes that a C3D file states, checked to fit into it.

    Attributes:
        points: Points per frame.
        frames: Frames of the file.
        first: Number of the first frame, counted from 1.
        processor: Which wrote the numbers, one of `PROCESSORS`.
        header_events: Events that stand in the header.
    """

    points: int
    frames: int
    first: int
    processor: int
    header_events: int


class Record(NamedTuple):
    """One parameter's, or group's, place in the file.

    Attributes:
        group: Number of its group.
        name: In capitals.
        kind: Bytes of a value: -1 for text, 1, 2 or 4 (real); 0 for a group.
        size: Values.
        at: Where they begin [byte].
    """

    group: int
    name: str
    kind: int
    size: int
    at: int


def check(path: Path, data: bytes) -> Layout:
    """Walk through the header and the parameters as the C3D user guide lays them out.

    Raises:
        FormatError: It is no C3D file, a record points out of it, or the data are cut short.
    """
    if len(data) < 2 * _BLOCK or data[1] != _KEY:
        raise FormatError(path, "not a C3D file: its first block does not say so")
    start = (data[0] - 1) * _BLOCK
    if not _BLOCK <= start <= len(data) - _BLOCK:
        raise FormatError(path, "the header points to parameters outside the file; cut short?")
    processor = data[start + 3]
    if processor not in PROCESSORS:
        raise FormatError(
            path, f"written by processor {processor}; expected 84 (Intel), 85 (DEC) or 86 (MIPS)"
        )
    words = _integers(data[:20], processor)
    points, analog, first, last = (int(words[k]) for k in (1, 2, 3, 4))
    begin = (int(words[8]) - 1) * _BLOCK
    numbers = _numbers(path, data, start, begin, processor)
    frames = _frames(numbers, first, last)
    real = data[_SIGN_BYTES[processor]] & 0x80 != 0  # a negative scale stands for 32-bit numbers
    end = begin + frames * (4 * points + analog) * (4 if real else 2)
    if begin <= start or end > len(data):
        raise FormatError(path, f"says it has {end} bytes, the file has {len(data)}; cut short?")
    if numbers.get("POINT:USED", points) != points:
        raise FormatError(path, f"says {points} points in one place and {numbers['POINT:USED']} in another")
    if frames < 1:
        raise FormatError(path, f"has {frames} frames; expected a recording")
    key, count = _integers(data[298:302], processor).tolist()
    known = key == _FOUR_LETTERS and count <= _MOST_HEADER_EVENTS
    return Layout(points, frames, numbers.get("START", first), processor, count if known else 0)


def _frames(numbers: dict[str, int], first: int, last: int) -> int:
    """Frames of the file: the 16 bits of the header overflow, longer trials say it in TRIAL."""
    if "START" in numbers and "END" in numbers:
        return numbers["END"] - numbers["START"] + 1
    return numbers.get("POINT:FRAMES", last - first + 1) if last == 0xFFFF else last - first + 1


def _numbers(path: Path, data: bytes, start: int, begin: int, processor: int) -> dict[str, int]:
    """The whole numbers that matter here, from `GROUP:NAME`."""
    groups: dict[int, str] = {}
    found: dict[tuple[int, str], list[int]] = {}
    for record in _records(path, _section(data, start, begin), start + 4, processor):
        if record.kind == 0:
            groups[record.group] = record.name
        elif record.kind == 2 and 1 <= record.size <= 2:
            raw = data[record.at : record.at + 2 * record.size]
            found[record.group, record.name] = _integers(raw, processor).tolist()
    numbers = {f"{groups.get(g, '?')}:{name}": values for (g, name), values in found.items()}
    out = {key: values[0] for key, values in numbers.items() if key in ("POINT:USED", "POINT:FRAMES")}
    for key, name in (("START", "TRIAL:ACTUAL_START_FIELD"), ("END", "TRIAL:ACTUAL_END_FIELD")):
        if len(numbers.get(name, [])) == 2:
            out[key] = numbers[name][0] + 65536 * numbers[name][1]
    return out


def _section(data: bytes, start: int, begin: int) -> bytes:
    """The file up to the end of its parameters."""
    return data[: min(len(data), max(start + data[start + 2] * _BLOCK, begin))]


def _records(path: Path, section: bytes, at: int, processor: int) -> Iterator[Record]:
    """Groups (kind 0) and parameters, one after the other; every step stays inside the section."""
    for _ in range(_MOST_PARAMETERS):
        if at + 2 > len(section):
            return
        length, group = (int(x) for x in np.frombuffer(section, "i1", 2, at))
        name_at, length = at + 2, abs(length)
        next_at = name_at + length
        if not length:
            return
        if next_at + 4 > len(section):
            raise FormatError(path, "a parameter's name leaves the file; damaged or cut short")
        name = section[name_at:next_at].decode("latin-1").upper()
        if group < 0:
            yield Record(-group, name, 0, 0, next_at)
        else:
            yield _parameter(path, section, group, name, next_at)
        step = int(_integers(section[next_at : next_at + 2], processor)[0])
        if not step:
            return
        at = next_at + step
    raise FormatError(path, f"more than {_MOST_PARAMETERS} parameters; damaged?")


def _parameter(path: Path, section: bytes, group: int, name: str, next_at: int) -> Record:
    at = next_at + 2
    kind, dimensions = (int(x) for x in np.frombuffer(section, "i1", 2, at))
    sizes = list(section[at + 2 : at + 2 + max(dimensions, 0)])
    count = int(np.prod(sizes, dtype=object)) if sizes else 1
    data_at = at + 2 + len(sizes)
    if kind not in (-1, 1, 2, 4) or dimensions < 0 or dimensions > 7 or len(sizes) < dimensions:
        raise FormatError(path, f"parameter {name[:40]!r} is malformed; damaged?")
    if data_at + count * abs(kind) > len(section):
        raise FormatError(path, f"parameter {name[:40]!r} leaves the file; damaged or cut short")
    return Record(group, name, kind, count, data_at)


def _integers(raw: bytes, processor: int) -> NDArray[np.uint16]:
    """Unsigned integers of 16 bits."""
    return np.frombuffer(raw, PROCESSORS[processor]).astype(np.uint16)
