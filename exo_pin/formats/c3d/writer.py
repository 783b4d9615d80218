"""A gait as a C3D file with Plug-in Gait's model angles, the pelvis's segment frame and the events."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from exo_pin.anatomy import JOINTS
from exo_pin.arrays import Array
from exo_pin.errors import FormatError
from exo_pin.files import read_bytes, write_bytes
from exo_pin.formats.c3d.event_words import EVENT_WORDS
from exo_pin.formats.c3d.plug_in_gait import PELVIS_FRAME, PLUG_IN_GAIT, angle_of
from exo_pin.gait import Gait
from exo_pin.signals import EVEN_GRID, ROUNDED_TIME

_AXIS = 100.0
"""Length of the pelvis's axes in the file [mm]."""

_EVENT_LABELS = {kind: words[0].title() for kind, words in EVENT_WORDS.items()}


def write_gait(gait: Gait, path: Path) -> None:
    """Write angles in degrees as 32-bit numbers: they come back within 1e-5 degrees and 1e-6 m.

    Angles that Plug-in Gait has and a gait has not (knee Y and Z, ankle Z) are 0. Source and period are not
    in the file. It has a rate, no times: times that were rounded to milliseconds come back on the grid.

    Raises:
        FormatError: The samples are uneven or do not fall on frames, or the file cannot be written.
    """
    rate, first = _grid(gait, path)
    try:
        import ezc3d  # 0.1 s, needed here only
    except ImportError:
        why = "cannot be written: C3D files are written by the Python package ezc3d, which is not installed; "
        why += "write .csv, .mot, .npz or another format instead (it has no wheel for Linux on ARM)"
        raise FormatError(path, why) from None
    file = ezc3d.c3d()
    points = _angles(gait) | _pelvis(gait)
    file["parameters"]["POINT"]["RATE"]["value"] = [rate]
    file["parameters"]["POINT"]["LABELS"]["value"] = list(points)
    file["data"]["points"] = np.stack([_padded(values) for values in points.values()], axis=1)
    file["header"]["points"]["first_frame"] = first  # ezc3d counts from 0
    for name, value in (
        ("UNITS", ["mm"]),
        ("ANGLE_UNITS", ["deg"]),
        ("X_SCREEN", ["+X"]),
        ("Y_SCREEN", ["+Z"]),
    ):
        file.add_parameter("POINT", name, value)
    file.add_parameter("POINT", "ANGLES", [name for name in points if name.endswith("Angles")])
    _events(file, gait)
    with tempfile.TemporaryDirectory() as folder:
        draft = Path(folder) / "gait.c3d"
        file.write(str(draft))
        write_bytes(path, read_bytes(draft))


def _grid(gait: Gait, path: Path) -> tuple[float, int]:
    """Frames per second, and the number of the first frame from 0."""
    step = float(gait.time[-1] - gait.time[0]) / (len(gait) - 1)
    frames = gait.time / step
    off = step * float(np.abs(frames - np.round(frames[0]) - np.arange(len(gait))).max())
    if (
        off > max(EVEN_GRID * step, min(ROUNDED_TIME, step / 4))
        or frames[0] < -EVEN_GRID
        or frames[0] > 60_000
    ):
        why = (
            f"its samples lie up to {off:.2g} s off the frames of a C3D file; sample the walk at a rate first"
        )
        raise FormatError(path, f"cannot be written: {why}")
    return 1 / step, round(float(frames[0]))


def _angles(gait: Gait) -> dict[str, Array]:
    """Model angle -> `(n, 3)` [deg]."""
    points: dict[str, Array] = {}
    for column, joint in PLUG_IN_GAIT.mapping.items():
        name, k, sign = angle_of(column)
        values = points.setdefault(name, np.zeros((len(gait), 3)))
        values[:, k] = sign * np.degrees(gait.q[:, JOINTS.index(joint)])
    return points


def _pelvis(gait: Gait) -> dict[str, Array]:
    """Segment frame -> `(n, 3)` [mm]."""
    if gait.base is None:
        return {}
    origin = 1e3 * gait.base[:, :3, 3]
    ends = [origin + _AXIS * gait.base[:, :3, k] for k in range(3)]
    return dict(zip(PELVIS_FRAME, [origin, *ends], strict=True))


def _padded(values: Array) -> Array:
    return np.vstack([values.T, np.ones(len(values))])


def _events(file: Any, gait: Gait) -> None:
    events = gait.events
    if not events:
        return
    minutes, seconds = zip(*(divmod(event.time, 60) for event in events), strict=True)
    file.add_parameter("EVENT", "USED", [len(events)])
    file.add_parameter("EVENT", "LABELS", [_EVENT_LABELS[event.kind] for event in events])
    file.add_parameter("EVENT", "CONTEXTS", [event.side.title() for event in events])
    file.add_parameter("EVENT", "TIMES", np.array([minutes, seconds]))
