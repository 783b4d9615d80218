"""C3D content through ezc3d, which runs in a child process with limits of time and memory."""

from __future__ import annotations

import io
import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from exo_pin.errors import FormatError
from exo_pin.files import read_bytes
from exo_pin.formats.c3d import header
from exo_pin.formats.c3d.byte_order import INTEL, floats, integers
from exo_pin.formats.c3d.content import C3dContent, C3dEvents, C3dPlate
from exo_pin.gait.trial import unique

TIME_LIMIT = 60
"""Of the child process [s]; a file of the largest size takes ezc3d some ten."""

CHILD_SCRIPT = Path(__file__).with_name("child_process.py")

_MEGABYTES = 2048
"""Memory of the child process, besides a multiple of the file."""

_INTEGER, _REAL = 2, 4
"""Types of parameters that hold numbers, and the bytes of one."""

_HEADER_NUMBERS = (
    (2, 12, _INTEGER),
    (12, 16, _REAL),
    (16, 20, _INTEGER),
    (20, 24, _REAL),
    (24, 304, _INTEGER),
    (304, 376, _REAL),
)
"""Numbers of the first block: from, to [byte], type; flags and labels of events follow."""

_Found = Mapping[str, NDArray[Any]]


def read_content(path: Path) -> C3dContent:
    """Read a C3D file.

    Raises:
        FormatError: With file and reason: damaged, or ezc3d cannot read it.
    """
    data = read_bytes(path)
    layout = header.check(path, data)
    found = _child(path) if layout.processor == INTEL else _converted(path, data, layout)
    shape = found["points"].shape
    if shape != (3, layout.points, layout.frames) or len(found["labels"]) < layout.points:
        raise FormatError(
            path, "the header and the data have different numbers of points or frames; damaged?"
        )
    mass = float(found["mass"][0]) if found["mass"].size else 0.0
    return C3dContent(
        time=(layout.first - 1 + np.arange(layout.frames)) / layout.rate,
        columns=unique(found["labels"][: layout.points].tolist()),
        points=found["points"],
        angles=frozenset(unique(found["angles"].tolist())),
        outputs=_outputs(found),
        length_unit=_first(found, "units"),
        angle_unit=_first(found, "angle_units"),
        vertical=_first(found, "y_screen") or "",
        events=_events(found, data, layout),
        analog_rate=float(found["analog_rate"]),
        plates=_plates(found),
        mass=mass if mass > 0 else None,
        analysis=_analysis(found),
    )


def to_intel(path: Path, data: bytes, layout: header.Layout) -> bytes:
    """The file of a DEC or MIPS machine as an Intel machine writes it, which ezc3d reads.

    Args:
        path: The file, for messages.
        data: Its content.
        layout: Of `header.check`.

    Returns:
        The same bytes where the file is Intel's.
    """
    if layout.processor == INTEL:
        return data
    out = bytearray(data)
    places = list(_HEADER_NUMBERS)
    for record in header.records(path, data, layout):
        places.append((record.next_at, record.next_at + 2, _INTEGER))
        if record.kind in (_INTEGER, _REAL):
            places.append((record.at, record.at + record.size * record.kind, record.kind))
    places.append((layout.begin, layout.end, _REAL if layout.real else _INTEGER))
    for start, stop, kind in places:
        read, as_intel = (integers, "<u2") if kind == _INTEGER else (floats, "<f4")
        out[start:stop] = np.asarray(read(data[start:stop], layout.processor)).astype(as_intel).tobytes()
    out[layout.parameters + 3] = INTEL
    return bytes(out)


def _converted(path: Path, data: bytes, layout: header.Layout) -> _Found:
    """What ezc3d reads of a DEC or MIPS file after conversion."""
    with tempfile.TemporaryDirectory() as folder:
        intel = Path(folder) / "intel.c3d"
        intel.write_bytes(to_intel(path, data, layout))
        return _child(path, intel)


def _child(path: Path, file: Path | None = None) -> _Found:
    """What ezc3d reads of a file, by default of the one that messages name."""
    file = file or path
    megabytes = _MEGABYTES + 32 * (file.stat().st_size >> 20)
    words = [sys.executable, "-P", str(CHILD_SCRIPT), str(file.resolve()), str(megabytes), str(TIME_LIMIT)]
    environment = os.environ | {"OPENBLAS_NUM_THREADS": "1"}  # its threads would reserve memory
    try:
        ended = subprocess.run(
            words, capture_output=True, timeout=2 * TIME_LIMIT, env=environment, check=False
        )
    except subprocess.TimeoutExpired:
        raise FormatError(path, f"reading takes more than {2 * TIME_LIMIT:g} s; damaged?") from None
    if ended.returncode:
        raise FormatError(path, _failure(ended))
    with np.load(io.BytesIO(ended.stdout), allow_pickle=False) as archive:
        return dict(archive)


def _failure(ended: subprocess.CompletedProcess[bytes]) -> str:
    """Why there is nothing, in words of this package: the reader's own say nothing about the file."""
    if b"No module named" in ended.stderr:
        return "a C3D file is read by the Python package ezc3d, which is not installed"
    if ended.returncode < 0 or b"MemoryError" in ended.stderr:
        return "its parameters or data crash the reader or take too much memory; damaged?"
    return "its parameters or data do not fit the C3D format; damaged?"


def _first(found: _Found, name: str) -> str | None:
    """The first text of a parameter, or None."""
    return str(found[name][0]).strip() if found[name].size else None


def _outputs(found: _Found) -> frozenset[str]:
    """Names of what is neither point nor angle."""
    groups = ("forces", "moments", "powers", "scalars")
    return frozenset(name for group in groups for name in unique(found[group].tolist()))


def _events(found: _Found, data: bytes, layout: header.Layout) -> C3dEvents:
    labels = tuple(found["event_labels"].tolist())
    if labels:
        return C3dEvents(found["event_times"], labels, tuple(found["event_contexts"].tolist()))
    times, labels = header.events(data, layout.processor)
    return C3dEvents(times, labels, (), in_header=bool(labels))


def _analysis(found: _Found) -> dict[str, tuple[float, str]]:
    """Name -> value and unit of the first of each name."""
    rows = zip(found["analysis_names"], found["analysis_values"], found["analysis_units"], strict=False)
    out: dict[str, tuple[float, str]] = {}
    for name, value, unit in rows:
        out.setdefault(str(name).strip(), (float(value), str(unit).strip()))
    return out


def _plates(found: _Found) -> tuple[C3dPlate, ...]:
    plates = list[C3dPlate]()
    while (key := f"plate_{len(plates)}") + "_force" in found:
        force, point, moment = (found[f"{key}_{x}"].T for x in ("force", "center_of_pressure", "Tz"))
        newton, torque, length = (str(unit).strip() for unit in found[f"{key}_units"])
        plates.append(C3dPlate(force, point, moment, (newton, torque, length)))
    return tuple(plates)
