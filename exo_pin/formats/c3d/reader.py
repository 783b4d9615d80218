"""C3D content through ezc3d or c3d, whichever reads the file, in a child process with limits."""

from __future__ import annotations

import io
import os
import subprocess
import sys
from collections.abc import Mapping
from importlib.util import find_spec
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from exo_pin.errors import FormatError
from exo_pin.files import read_bytes
from exo_pin.formats.c3d import header
from exo_pin.formats.c3d.content import C3dContent, C3dEvents
from exo_pin.formats.c3d.parameters import C3dParameters, from_json
from exo_pin.formats.c3d.plate_signals import plates_of
from exo_pin.gait.trial import unique

CHILD_SCRIPT = Path(__file__).with_name("child_process.py")

READERS = ("ezc3d", "c3d")
"""Packages in the order in which they are tried: the first is less strict, the second has a wheel for every
machine and knows the numbers of MIPS processors."""

TIME_LIMIT = 4.0
"""Of the child process [s], besides a second for every MiB; ezc3d reads ten in one."""

_MEGABYTES = 2048
"""Memory of the child process, besides a multiple of the file."""

_SLOWEST, _FASTEST = 0.01, 1e5
"""Frames per second that are believed [Hz]."""

_OUTPUTS = ("FORCES", "MOMENTS", "POWERS", "SCALARS")
"""Parameters of POINT that list what is neither point nor angle."""

_Found = Mapping[str, NDArray[Any]]


class _Failure(NamedTuple):
    """Why a reader has no answer, and whether another one should try."""

    why: str
    try_next: bool


def read_content(path: Path, readers: tuple[str, ...] = READERS) -> C3dContent:
    """Read a C3D file.

    Args:
        path: The file.
        readers: Packages that may read it, the preferred one first.

    Raises:
        FormatError: With file and reason: damaged, or no reader is installed or can read it.
    """
    data = read_bytes(path)
    layout = header.check(path, data)
    installed = [name for name in readers if find_spec(name)]
    able = [name for name in installed if (name, layout.processor) != ("ezc3d", header.MIPS)]
    if not able:
        needed = "c3d" if installed else " or ".join(readers)
        raise FormatError(path, f"such a C3D file is read by the Python package {needed}: not installed")
    first: _Failure | None = None
    for name in able:
        found = _child(path, name, len(data), layout)
        if not isinstance(found, _Failure):
            return _content(found, layout, [f"{able[0]} cannot read it, {name} does"] if first else [])
        first = first or found
        if not found.try_next:
            break
    assert first is not None  # the loop returned otherwise
    raise FormatError(path, first.why)


def _child(path: Path, reader: str, size: int, layout: header.Layout) -> _Found | _Failure:
    """What a reader finds in a file, or why it does not."""
    megabytes, seconds = _MEGABYTES + 32 * (size >> 20), TIME_LIMIT + (size >> 20)
    words = [sys.executable, "-P", str(CHILD_SCRIPT), f"by_{reader}", str(path.resolve())]
    words += [str(megabytes), str(max(round(seconds), 1))]
    environment = os.environ | {"OPENBLAS_NUM_THREADS": "1"}  # its threads would reserve memory
    try:
        ended = subprocess.run(words, capture_output=True, timeout=4 * seconds, env=environment, check=False)
    except subprocess.TimeoutExpired:
        return _Failure(f"reading takes more than {4 * seconds:g} s; damaged?", try_next=False)
    if ended.returncode:
        return _failure(ended)
    with np.load(io.BytesIO(ended.stdout), allow_pickle=False) as archive:
        found = dict(archive)
    return _contradiction(found, layout) or found


def _contradiction(found: _Found, layout: header.Layout) -> _Failure | None:
    """Where a reader's answer is not what the header states."""
    rate = float(found["rate"])
    if found["points"].shape != (3, layout.points, layout.frames):
        why = "the header and the data have different numbers of points or frames; damaged?"
        return _Failure(why, try_next=True)
    if not _SLOWEST <= rate <= _FASTEST:
        return _Failure(f"has {layout.frames} frames at {rate:g} Hz; expected a recording", try_next=True)
    return None


def _failure(ended: subprocess.CompletedProcess[bytes]) -> _Failure:
    """Why there is nothing, in words of this package: the reader's own say nothing about the file."""
    if ended.returncode < 0 or b"MemoryError" in ended.stderr:
        why = "its parameters or data crash the reader or take too much memory or time; damaged?"
        return _Failure(why, try_next=ended.returncode not in _TOO_LONG)
    return _Failure("its parameters or data do not fit the C3D format; damaged?", try_next=True)


_TOO_LONG = (-24, -9)
"""Exit status of a process that used up its time (SIGXCPU, SIGKILL): another reader would take as long."""


def _content(found: _Found, layout: header.Layout, remarks: list[str]) -> C3dContent:
    parameters = from_json(str(found["parameters"]))
    plates = plates_of(parameters, found["signals"])
    labels = parameters.all_texts("POINT:LABELS")[: layout.points]
    unnamed = [f"unnamed {k}" for k in range(len(labels) + 1, layout.points + 1)]
    if unnamed:
        remarks = [*remarks, f"{len(unnamed)} points have no label"]
    return C3dContent(
        time=(layout.first - 1 + np.arange(layout.frames)) / float(found["rate"]),
        columns=unique([*labels, *unnamed]),
        points=found["points"],
        angles=frozenset(unique(parameters.all_texts("POINT:ANGLES"))),
        outputs=frozenset(n for group in _OUTPUTS for n in unique(parameters.all_texts(f"POINT:{group}"))),
        length_unit=parameters.text("POINT:UNITS"),
        angle_unit=parameters.text("POINT:ANGLE_UNITS"),
        vertical=parameters.text("POINT:Y_SCREEN") or "",
        events=_events(found, parameters, layout),
        analog_rate=parameters.number("ANALOG:RATE") or 0.0,
        plates=plates.plates,
        parameters=parameters,
        analysis=_analysis(parameters),
        remarks=(*remarks, *plates.remarks),
    )


def _events(found: _Found, parameters: C3dParameters, layout: header.Layout) -> C3dEvents:
    """The events of the parameters, or of the header as in the 1990s."""
    labels = parameters.all_texts("EVENT:LABELS")
    if labels:
        contexts = parameters.all_texts("EVENT:CONTEXTS")
        return C3dEvents(parameters.all_numbers("EVENT:TIMES"), labels, contexts)
    count = layout.header_events
    times = found["event_times"][:count]
    words = tuple(str(label).strip(" \0") for label in found["event_labels"][:count])
    return C3dEvents(np.array([np.zeros(len(times)), times]), words, (), in_header=bool(words))


def _analysis(parameters: C3dParameters) -> dict[str, tuple[float, str]]:
    """Name -> value and unit of the first of each name."""
    names, units = (parameters.all_texts(f"ANALYSIS:{name}") for name in ("NAMES", "UNITS"))
    values = parameters.numbers.get("ANALYSIS:VALUES", np.zeros(0)).ravel().tolist()
    out: dict[str, tuple[float, str]] = {}
    for name, value, unit in zip(names, values, units, strict=False):
        out.setdefault(name, (float(value), unit))
    return out
