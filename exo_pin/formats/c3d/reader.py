"""C3D trials through ezc3d: markers, Plug-in Gait model angles, events and force plates."""

from __future__ import annotations

import io
import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from exo_pin.anatomy import JOINTS
from exo_pin.arrays import Array
from exo_pin.errors import FormatError, GaitError
from exo_pin.files import read_bytes
from exo_pin.formats.c3d import byte_order, header, number_formats
from exo_pin.formats.c3d.foot_contacts import foot_events
from exo_pin.formats.presets import PRESETS
from exo_pin.formats.reading import Reading
from exo_pin.formats.tables.notes import Notes, to_gait
from exo_pin.gait import Gait
from exo_pin.gait.rigid_poses import nearest_pose
from exo_pin.gait.trial import ForcePlate, Markers, to_z_up, unique
from exo_pin.signals import longest_run

METRES = {"mm": 1e-3, "cm": 1e-2, "m": 1.0}
NEWTON_METRES = {"Nmm": 1e-3, "Nm": 1.0, "N.m": 1.0, "N.mm": 1e-3}
RADIANS = {"deg": np.pi / 180, "degrees": np.pi / 180, "rad": 1.0, "radians": 1.0}
SECONDS = 60
"""A file of the largest size takes ezc3d some ten."""

MEGABYTES = 2048
"""What the child may have besides a multiple of the file."""

CHILD = Path(__file__).with_name("child_process.py")

PIG = PRESETS["vicon-pig"]
PELVIS = ("PELO", "PELA", "PELL", "PELP")
"""Plug-in Gait's pelvis: its origin midway between the hip centres and a point on each axis."""


def read_markers(path: Path) -> Markers:
    """Read a trial; lengths in metres, angles in radians, time from the file's first frame on.

    Raises:
        FormatError: With file and reason; ezc3d runs in a process of its own, with limits.
    """
    time, found, places = _read(path)
    points = np.moveaxis(found["points"], 0, -1)  # (k, n, 3)
    angular = _angular(places, found)
    spatial = [name for name in places if name not in angular and name not in _others(found)]
    position = np.moveaxis(points[[places[name] for name in spatial]], 0, 1) * _unit(
        path, found, "units", METRES
    )
    position = np.where((position == 0).all(axis=2, keepdims=True), np.nan, position)  # 0, 0, 0: not seen
    scale = _unit(path, found, "angle_units", RADIANS, "deg")
    try:
        return Markers(
            time,
            tuple(spatial),
            position,
            up=_up(found),
            angles={name: points[places[name]] * scale for name in angular},
            events=foot_events(
                found["event_times"], found["event_labels"], found["event_contexts"], (time[0], time[-1])
            ),
            plates=_plates(path, found, float(time[0])),
            source=path.name,
        )
    except GaitError as error:
        raise FormatError(path, str(error)) from error


def read_outputs(path: Path, names: Sequence[str]) -> tuple[Array, dict[str, Array], float | None]:
    """Time `(n,)` [s], the named model outputs `(n, 3)` that are there, the person's mass [kg] or None.

    Outputs are in the file's own units; where all three numbers are 0 there is none: NaN. Errors as of
    `read_markers`.
    """
    time, found, places = _read(path)
    outputs = {name: found["points"][:, places[name]].T for name in names if name in places}
    gaps = {
        name: np.where((rows == 0).all(axis=1, keepdims=True), np.nan, rows) for name, rows in outputs.items()
    }
    mass = float(found["mass"][0]) if found["mass"].size else 0.0
    return time, gaps, mass if mass > 0 else None


def _read(path: Path) -> tuple[Array, dict[str, NDArray[Any]], dict[str, int]]:
    """Time `(n,)` [s], what ezc3d reads, and where each point stands."""
    data = read_bytes(path)
    layout = header.check(path, data)
    found = _child(path) if layout.processor == number_formats.INTEL else _turned(path, data, layout)
    shape = found["points"].shape
    if shape != (3, layout.points, layout.frames) or len(found["labels"]) < layout.points:
        raise FormatError(
            path, "the header and the data tell different numbers of points or frames; damaged?"
        )
    time = (layout.first - 1 + np.arange(layout.frames)) / layout.rate
    return time, found, unique(found["labels"][: layout.points].tolist())


def read_gait(path: Path, reading: Reading) -> Gait:
    """Read Plug-in Gait's model angles; the pelvis's segment frame, if there, becomes the base.

    The longest run of frames with all angles is read, and the source says which where it is not the file.

    Raises:
        FormatError: The file has no such angles (its markers may still do), or cannot be read.
    """
    reading.refuse(path, "mapping", "units", why="its parameters name the angles and their units")
    if reading.preset not in (None, PIG.name):
        raise FormatError(
            path, f"preset {reading.preset!r} does not fit a C3D file; its angles are {PIG.name}"
        )
    return model_angles(path, read_markers(path))


def has_angles(trial: Markers) -> bool:
    """Whether the trial has all of Plug-in Gait's leg angles."""
    return all(angle_of(column)[0] in trial.angles for column in PIG.mapping)


def model_angles(path: Path, trial: Markers) -> Gait:
    """The trial's own angles as a gait; errors as in `read_gait`."""
    if not has_angles(trial):
        gone = sorted({angle_of(column)[0] for column in PIG.mapping} - set(trial.angles))
        raise FormatError(path, f"no model angles {', '.join(gone)}; its markers need inverse kinematics")
    columns = {joint: angle_of(column) for column, joint in PIG.mapping.items()}
    q = np.column_stack([_channel(trial, *columns[joint]) for joint in JOINTS])
    start, stop = longest_run((np.isfinite(q) & (q != 0)).any(axis=1) & np.isfinite(q).all(axis=1))
    if stop - start < 2:
        raise FormatError(path, "the model angles are empty")
    time, source = trial.time[start:stop], f"{path.name}, Plug-in Gait model angles"
    if stop - start < len(trial):
        source += f", frames {start} to {stop - 1} of {len(trial)}"
    events = tuple(event for event in trial.events if time[0] <= event.time <= time[-1])
    base = _pelvis(trial, start, stop)
    return to_gait(path, time, q[start:stop], base, Notes(events, source=source))


def _channel(trial: Markers, name: str, k: int, sign: int) -> Array:
    return np.asarray(sign * trial.angles[name][:, k])


def angle_of(column: str) -> tuple[str, int, int]:
    """`-LAnkleAngles_Y` -> the angle's name, which of its three, and the sign."""
    name, _, axis = column.lstrip("-").rpartition("_")
    return name, "XYZ".index(axis), -1 if column.startswith("-") else 1


def _pelvis(trial: Markers, start: int, stop: int) -> Array | None:
    """T_world_pelvis of these frames by the segment frame; None where it or the vertical is not known."""
    if not set(PELVIS) <= set(trial.names):
        return None
    origin, *ends = (trial.of(name)[start:stop] for name in PELVIS)
    axes = np.stack([end - origin for end in ends], axis=2)
    up = trial.up or _nearest_axis(axes[:, :, 2].mean(axis=0))
    if not up or not np.isfinite(axes).all():
        return None
    T = np.tile(np.eye(4), (len(axes), 1, 1))
    T[:, :3, 3] = origin @ to_z_up(up).T
    T[:, :3, :3] = to_z_up(up) @ axes / np.maximum(np.linalg.norm(axes, axis=1, keepdims=True), 1e-12)
    return nearest_pose(T)


def _nearest_axis(direction: Array) -> str:
    """Which axis of the laboratory a direction lies along, or "" where none is within some 30 degrees."""
    k = int(np.abs(direction).argmax())
    clear = abs(direction[k]) > 2 * np.linalg.norm(np.delete(direction, k))
    return f"{'+' if direction[k] > 0 else '-'}{'xyz'[k]}" if clear else ""


def _turned(path: Path, data: bytes, layout: header.Layout) -> dict[str, NDArray[Any]]:
    """What ezc3d reads of a file by a DEC or MIPS machine, after its numbers were turned into Intel's."""
    with tempfile.TemporaryDirectory() as folder:
        turned = Path(folder) / "intel.c3d"
        turned.write_bytes(byte_order.to_intel(path, data, layout))
        return _child(path, turned)


def _child(path: Path, file: Path | None = None) -> dict[str, NDArray[Any]]:
    """What ezc3d reads of a file, by default of the one that messages name."""
    file = file or path
    size = file.stat().st_size >> 20
    words = [sys.executable, "-P", str(CHILD), str(file.resolve()), str(MEGABYTES + 32 * size), str(SECONDS)]
    environment = os.environ | {"OPENBLAS_NUM_THREADS": "1"}  # its threads would reserve memory
    try:
        ended = subprocess.run(words, capture_output=True, timeout=2 * SECONDS, env=environment, check=False)
    except subprocess.TimeoutExpired:
        raise FormatError(path, "ezc3d hangs on this file; damaged?") from None
    if ended.returncode:
        last = ended.stderr.decode("utf-8", "replace").strip().rpartition("\n")[2]
        why = f"it ended with signal {-ended.returncode}" if ended.returncode < 0 else last[-200:]
        raise FormatError(path, f"ezc3d cannot read this file: {why or 'no reason given'}")
    with np.load(io.BytesIO(ended.stdout), allow_pickle=False) as archive:
        return dict(archive)


def _angular(places: Mapping[str, int], found: Mapping[str, NDArray[Any]]) -> list[str]:
    """Names of the model angles: listed as such, or called so."""
    listed = set(unique(found["angles"].tolist()))
    return [name for name in places if name in listed or name.endswith("Angles")]


def _others(found: Mapping[str, NDArray[Any]]) -> set[str]:
    """Names of what is neither point nor angle."""
    return {
        name for key in ("forces", "moments", "powers", "scalars") for name in unique(found[key].tolist())
    }


def _unit(
    path: Path, found: Mapping[str, NDArray[Any]], key: str, known: Mapping[str, float], default: str = ""
) -> float:
    said = str(found[key][0]).strip() if found[key].size else default
    if said not in known:
        raise FormatError(path, f"POINT:{key.upper()} is {said[:20]!r}; {', '.join(known)} are accepted")
    return known[said]


def _up(found: Mapping[str, NDArray[Any]]) -> str:
    """The laboratory's vertical: the axis that is up on the screen."""
    said = str(found["y_screen"][0]).strip().lower() if found["y_screen"].size else ""
    said = said if said[:1] in "+-" else f"+{said}"
    return said if said[1:] in ("x", "y", "z") else ""


def _plates(path: Path, found: Mapping[str, NDArray[Any]], start: float) -> tuple[ForcePlate, ...]:
    rate, plates = float(found["analog_rate"]), list[ForcePlate]()
    while rate > 0 and (key := f"plate_{len(plates)}") + "_force" in found:
        newton, torque, length = (str(unit).strip() for unit in found[f"{key}_units"])
        if newton != "N" or torque not in NEWTON_METRES or length not in METRES:
            raise FormatError(path, f"a force plate in {newton}, {torque}, {length}; N, Nmm, mm are accepted")
        force, point, moment = (found[f"{key}_{x}"].T for x in ("force", "center_of_pressure", "Tz"))
        time = start + np.arange(len(force)) / rate
        name = f"force plate {len(plates) + 1}"
        plates.append(ForcePlate(name, time, force, point * METRES[length], moment * NEWTON_METRES[torque]))
    return tuple(plates)
