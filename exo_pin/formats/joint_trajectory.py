"""ROS `trajectory_msgs/JointTrajectory` as YAML or JSON: what a controller takes, without ROS."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from exo_pin.anatomy import JOINTS
from exo_pin.arrays import Array
from exo_pin.errors import FormatError, UnknownNameError
from exo_pin.files import read_text, write_text
from exo_pin.formats.reading import Reading
from exo_pin.formats.tables import pelvis_notes
from exo_pin.formats.tables.notes import Note, Notes, read, split, to_gait, to_lines
from exo_pin.gait import Gait
from exo_pin.safe.yaml_reader import load_yaml

REMARK = "# JointTrajectory [rad, rad/s, rad/s^2, s]; positive is what the joint's name says."
START = "start"
"""Note that keeps the first time of a walk whose trajectory, as any, starts at 0; others keep the pelvis."""

WRAPPINGS = ("trajectory", "joint_trajectory")
"""Fields under which other ROS messages hold a JointTrajectory."""

NOTES = "exo_pin"
"""Key of a JSON file that keeps the notes, which YAML has in comments."""

DEEPEST = 64
"""Brackets within brackets; a trajectory has four."""


def read_yaml(path: Path, reading: Reading) -> Gait:
    """Read a gait from YAML; errors as in `read_json`."""
    text = read_text(path)
    head = [line for line in text.split("\n") if line.startswith("#")]
    return _gait(path, load_yaml(path, text), split(head), reading)


def read_json(path: Path, reading: Reading) -> Gait:
    """Read a gait from JSON: `joint_names` and `points` with `positions` and `time_from_start`.

    Velocities and accelerations are checked for their number and left out: a `Gait` has its own. The mapping
    may name foreign joints; time is `sec` and `nanosec`, `secs` and `nsecs`, or a number of seconds.

    Raises:
        FormatError: With file and reason: not such a message, joints missing, points that do not fit.
        UnknownNameError: The mapping names no joint of ours.
    """
    text = read_text(path)
    _check_depth(path, text)
    try:
        message = json.loads(text)
    except (ValueError, RecursionError) as error:
        line = getattr(error, "lineno", None)
        raise FormatError(path, f"no JSON: {str(error)[:200]}", line=line) from error
    lines = message.get(NOTES, []) if isinstance(message, dict) else []
    lines = [line for line in lines if isinstance(line, str)] if isinstance(lines, list) else []
    return _gait(path, message, split(lines), reading)


def write_yaml(gait: Gait, path: Path) -> None:
    """Write positions, velocities, accelerations and times from the start; notes are comments."""
    points = [
        "- positions: [{}]\n  velocities: [{}]\n  accelerations: [{}]\n  time_from_start: "
        "{{sec: {}, nanosec: {}}}".format(*(_numbers(row) for row in rows), *_stamp(t))
        for t, *rows in zip(_from_start(gait), gait.q, gait.dq, gait.ddq, strict=True)
    ]
    names = "joint_names:\n" + "\n".join(f"- {joint}" for joint in JOINTS)
    header = 'header: {stamp: {sec: 0, nanosec: 0}, frame_id: ""}'
    write_text(path, "\n".join([REMARK, *_notes(gait), header, names, "points:", *points, ""]))


def write_json(gait: Gait, path: Path) -> None:
    """Write the same message as JSON; notes are under the key `exo_pin`."""
    points = [
        {
            "positions": q.tolist(),
            "velocities": dq.tolist(),
            "accelerations": ddq.tolist(),
            "time_from_start": dict(zip(("sec", "nanosec"), _stamp(t), strict=True)),
        }
        for t, q, dq, ddq in zip(_from_start(gait), gait.q, gait.dq, gait.ddq, strict=True)
    ]
    message = {
        "header": {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": ""},
        "joint_names": list(JOINTS),
        "points": points,
        NOTES: _notes(gait),
    }
    write_text(path, json.dumps(message) + "\n")


def _notes(gait: Gait) -> list[str]:
    start = float(gait.time[0])
    notes = to_lines(Notes(gait.events, gait.periodic, gait.source))
    return [*notes, f"# {START}: {start!r}", *pelvis_notes.to_lines(gait.base)]


def _from_start(gait: Gait) -> list[float]:
    return list((gait.time - gait.time[0]).tolist())


def _stamp(seconds: float) -> tuple[int, int]:
    return divmod(round(seconds * 1e9), 10**9)


def _numbers(row: Array) -> str:
    return ", ".join(map(_yaml_float, row.tolist()))


def _yaml_float(x: float) -> str:
    """As YAML 1.1 reads it: 1e-05 without a point would be a text."""
    text = repr(x)
    return text.replace("e", ".0e") if "e" in text and "." not in text else text


def _check_depth(path: Path, text: str) -> None:
    depth = 0
    for mark in text:
        depth += (mark in "[{") - (mark in "]}")
        if depth > DEEPEST:
            raise FormatError(path, f"brackets more than {DEEPEST} deep; a trajectory has four")


def _gait(path: Path, message: object, notes: list[Note], reading: Reading) -> Gait:
    reading.refuse(
        path, "preset", "units", why="a trajectory is in radians, positive as the joints' names say"
    )
    message = _inner(message)
    if not isinstance(message, dict) or not {"joint_names", "points"} <= set(message):
        raise FormatError(path, "no JointTrajectory; expected the keys joint_names and points")
    columns = _columns(path, message["joint_names"], reading)
    points = message["points"]
    if not isinstance(points, list) or len(points) < 2:
        raise FormatError(path, "points must be a list of at least 2")
    k = len(message["joint_names"])
    q = np.array([_row(path, i, point, "positions", k) for i, point in enumerate(points)])
    for i, point in enumerate(points):
        for name in ("velocities", "accelerations"):
            if point.get(name):
                _row(path, i, point, name, k)
    time = np.array([_seconds(path, i, point) for i, point in enumerate(points)])
    start = [note for note in notes if note.key == START]
    try:
        time += float(start[0].value) if start else 0.0
    except ValueError:
        raise FormatError(path, f"start is {start[0].value[:40]!r}, expected seconds") from None
    base = pelvis_notes.read_base(path, notes, len(time))
    return to_gait(path, time, q[:, columns], base, read(path, notes))


def _inner(message: object) -> object:
    """The JointTrajectory inside a goal of FollowJointTrajectory or a RobotTrajectory, or what was given."""
    for key in ("goal", *WRAPPINGS):
        if isinstance(message, dict) and isinstance(message.get(key), dict):
            message = message[key]
    return message


def _columns(path: Path, names: object, reading: Reading) -> list[int]:
    """Where each of our joints stands in the message."""
    if not isinstance(names, list) or not all(isinstance(name, str) for name in names):
        raise FormatError(path, "joint_names must be a list of names")
    for joint in reading.mapping.values():
        if joint not in JOINTS:
            raise UnknownNameError("joint", joint, JOINTS)
    ours = [reading.mapping.get(name, name) for name in names]
    gone = [joint for joint in JOINTS if ours.count(joint) != 1]
    if gone:
        found = ", ".join(names[:12])[:300]
        raise FormatError(path, f"joints {', '.join(gone)} must be there once each; the file has {found}")
    return [ours.index(joint) for joint in JOINTS]


def _row(path: Path, i: int, point: object, name: str, k: int) -> list[float]:
    values = point.get(name) if isinstance(point, dict) else None
    if not isinstance(values, list) or len(values) != k or not all(map(_is_number, values)):
        raise FormatError(path, f"point {i}: {name} must be {k} numbers")
    return [float(value) for value in values]


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) < 1e300


def _seconds(path: Path, i: int, point: dict[str, Any]) -> float:
    stamp = point.get("time_from_start")
    if isinstance(stamp, (int, float)) and _is_number(stamp):
        return float(stamp)
    if isinstance(stamp, dict):
        seconds: Any = stamp.get("sec", stamp.get("secs", 0))
        rest: Any = stamp.get("nanosec", stamp.get("nsecs", 0))
        if _is_number(seconds) and _is_number(rest):
            return float(seconds) + float(rest) * 1e-9
    raise FormatError(path, f"point {i}: time_from_start must be seconds, or sec and nanosec")
