"""What a C3D file says of its own size, checked against its length before anything else reads it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

from exo_pin.errors import FormatError

BLOCK = 512
KEY = 0x50
ENDIANS = {84: "<", 85: "<", 86: ">"}
"""Processor of the numbers: Intel, DEC, MIPS."""

MOST_PARAMETERS = 20_000


class Layout(NamedTuple):
    """The sizes that a C3D file claims, found to fit into it.

    Attributes:
        points: Points per frame.
        frames: Frames of the file.
        first: Number of the first frame, counted from 1.
        rate: Frames per second.
    """

    points: int
    frames: int
    first: int
    rate: float


class Parameter(NamedTuple):
    """One parameter's place in the file."""

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
    if len(data) < 2 * BLOCK or data[1] != KEY:
        raise FormatError(path, "not a C3D file: its first block does not say so")
    start = (data[0] - 1) * BLOCK
    if not BLOCK <= start <= len(data) - BLOCK:
        raise FormatError(path, "the header points to parameters outside the file; cut short?")
    processor = data[start + 3]
    if processor not in ENDIANS:
        raise FormatError(
            path, f"written by processor {processor}; expected 84 (Intel), 85 (DEC) or 86 (MIPS)"
        )
    if processor == 85:
        raise FormatError(path, "holds DEC numbers; save it again as an Intel C3D file")
    end = ENDIANS[processor]
    words = np.frombuffer(data, f"{end}u2", 10)
    scale, rate = (float(np.frombuffer(data, f"{end}f4", 1, at)[0]) for at in (12, 20))
    numbers = _numbers(path, data, start, int(words[8]), end)
    points, analog, first, last = (int(words[k]) for k in (1, 2, 3, 4))
    frames = _frames(numbers, first, last)
    begin = (int(words[8]) - 1) * BLOCK
    need = begin + frames * (4 * points + analog) * (4 if scale < 0 else 2)
    if begin <= start or need > len(data):
        raise FormatError(path, f"says it has {need} bytes, the file has {len(data)}; cut short?")
    if numbers.get("POINT:USED", points) != points:
        raise FormatError(path, f"says {points} points in one place and {numbers['POINT:USED']} in another")
    if not (np.isfinite(rate) and 0 < rate <= 1e5) or frames < 1:
        raise FormatError(path, f"has {frames} frames at {rate:g} Hz; expected a recording")
    return Layout(points, frames, numbers.get("START", first), rate)


def _frames(numbers: dict[str, int], first: int, last: int) -> int:
    """Frames of the file: the 16 bits of the header overflow, longer trials say it in TRIAL."""
    if "START" in numbers and "END" in numbers:
        return numbers["END"] - numbers["START"] + 1
    return numbers.get("POINT:FRAMES", last - first + 1) if last == 0xFFFF else last - first + 1


def _numbers(path: Path, data: bytes, start: int, data_start: int, end: str) -> dict[str, int]:
    """The whole numbers that matter here, from `GROUP:NAME`."""
    section = data[: min(len(data), max(start + data[start + 2] * BLOCK, (data_start - 1) * BLOCK))]
    groups: dict[int, str] = {}
    found: dict[tuple[int, str], list[int]] = {}
    for entry in _parameters(path, section, start + 4, end):
        if entry.kind == 0:
            groups[entry.group] = entry.name
        elif entry.kind == 2 and 1 <= entry.size <= 2:
            values = np.frombuffer(section, f"{end}u2", entry.size, entry.at)
            found[entry.group, entry.name] = [int(x) for x in values]
    numbers = {f"{groups.get(g, '?')}:{name}": values for (g, name), values in found.items()}
    out = {key: values[0] for key, values in numbers.items() if key in ("POINT:USED", "POINT:FRAMES")}
    for key, name in (("START", "TRIAL:ACTUAL_START_FIELD"), ("END", "TRIAL:ACTUAL_END_FIELD")):
        if len(numbers.get(name, [])) == 2:
            out[key] = numbers[name][0] + 65536 * numbers[name][1]
    return out


def _parameters(path: Path, section: bytes, at: int, end: str) -> Iterator[Parameter]:
    """Groups (kind 0) and parameters, one after the other; every step stays inside the section."""
    for _ in range(MOST_PARAMETERS):
        if at + 2 > len(section):
            return
        length, group = (int(x) for x in np.frombuffer(section, "i1", 2, at))
        name_at, length = at + 2, abs(length)
        offset_at = name_at + length
        if not length:
            return
        if offset_at + 4 > len(section):
            raise FormatError(path, "a parameter's name leaves the file; damaged or cut short")
        name = section[name_at:offset_at].decode("latin-1").upper()
        step = int(np.frombuffer(section, f"{end}u2", 1, offset_at)[0])
        if group < 0:
            yield Parameter(-group, name, 0, 0, offset_at)
        else:
            yield _parameter(path, section, group, name, offset_at + 2)
        if not step:
            return
        at = offset_at + step
    raise FormatError(path, f"more than {MOST_PARAMETERS} parameters; damaged?")


def _parameter(path: Path, section: bytes, group: int, name: str, at: int) -> Parameter:
    kind, dimensions = (int(x) for x in np.frombuffer(section, "i1", 2, at))
    sizes = list(section[at + 2 : at + 2 + max(dimensions, 0)])
    count = int(np.prod(sizes, dtype=object)) if sizes else 1
    data_at = at + 2 + len(sizes)
    if kind not in (-1, 1, 2, 4) or dimensions < 0 or dimensions > 7 or len(sizes) < dimensions:
        raise FormatError(path, f"parameter {name[:40]!r} is malformed; damaged?")
    if data_at + count * abs(kind) > len(section):
        raise FormatError(path, f"parameter {name[:40]!r} leaves the file; damaged or cut short")
    return Parameter(group, name, kind, count, data_at)
