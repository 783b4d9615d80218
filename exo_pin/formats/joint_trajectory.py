"""ROS `trajectory_msgs/JointTrajectory` messages as YAML or JSON, for controllers, without ROS."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from exo_pin.anatomy import JOINTS
from exo_pin.errors import FormatError, UnknownNameError
from exo_pin.files import read_text
from exo_pin.formats.read_options import ReadOptions
from exo_pin.formats.tables.metadata import (
    Comment,
    comments_in,
    read_metadata,
    read_pelvis,
    to_gait,
)
from exo_pin.formats.trial_file import TrialFile
from exo_pin.gait import Gait
from exo_pin.safe.yaml_reader import load_yaml

START_COMMENT = "start"
"""Comment with the first time of a walk, whose trajectory, as any, starts at 0."""

_WRAPPINGS = ("trajectory", "joint_trajectory")
"""Fields under which other ROS messages hold a JointTrajectory."""

COMMENTS_KEY = "exo_pin"
"""Key of a JSON file with the comment lines, which YAML has as comments."""

_DEEPEST = 64
"""Brackets within brackets; a trajectory has four."""


@dataclass(frozen=True, eq=False)
class TrajectoryFile(TrialFile):
    """A ROS message.

    Attributes:
        message: The parsed text.
        comments: Comment lines with the metadata of a walk.
    """

    message: object
    comments: list[Comment]

    def gait(self, options: ReadOptions) -> Gait:
        """The walk of `joint_names` and `points` with `positions` and `time_from_start`.

        Velocities and accelerations are checked for their number and left out: a `Gait` has its own. The
        mapping may name foreign joints; time is `sec` and `nanosec`, `secs` and `nsecs`, or a number of
        seconds.

        Raises:
            FormatError: With file and reason: not such a message, joints missing, points that do not fit.
            UnknownNameError: The mapping names no joint of `JOINTS`.
        """
        why = "a trajectory is in radians, positive as the joints' names say"
        options.refuse(self.path, "preset", "units", why=why)
        return _gait(self.path, _inner(self.message), self.comments, options)


def open_yaml(path: Path) -> TrajectoryFile:
    """Read a YAML message; raises `FormatError`."""
    text = read_text(path)
    head = [line for line in text.split("\n") if line.startswith("#")]
    return TrajectoryFile(path, load_yaml(path, text), comments_in(head))


def open_json(path: Path) -> TrajectoryFile:
    """Read a JSON message; raises `FormatError`."""
    text = read_text(path)
    _check_depth(path, text)
    try:
        message = json.loads(text)
    except (ValueError, RecursionError) as error:
        line = error.lineno if isinstance(error, json.JSONDecodeError) else None
        raise FormatError(path, f"no JSON: {str(error)[:200]}", line=line) from error
    lines = message.get(COMMENTS_KEY, []) if isinstance(message, dict) else []
    lines = [line for line in lines if isinstance(line, str)] if isinstance(lines, list) else []
    return TrajectoryFile(path, message, comments_in(lines))


def _check_depth(path: Path, text: str) -> None:
    depth = 0
    for mark in text:
        depth += (mark in "[{") - (mark in "]}")
        if depth > _DEEPEST:
            raise FormatError(path, f"brackets more than {_DEEPEST} deep; a trajectory has four")


def _gait(path: Path, message: object, comments: list[Comment], options: ReadOptions) -> Gait:
    if not isinstance(message, dict) or not {"joint_names", "points"} <= set(message):
        raise FormatError(path, "no JointTrajectory; expected the keys joint_names and points")
    columns = _columns(path, message["joint_names"], options)
    points = message["points"]
    if not isinstance(points, list) or len(points) < 2:
        raise FormatError(path, "points must be a list of at least 2")
    k = len(message["joint_names"])
    q = np.array([_row(path, i, point, "positions", k) for i, point in enumerate(points)])
    for i, point in enumerate(points):
        for name in ("velocities", "accelerations"):
            if point.get(name):
                _row(path, i, point, name, k)
    time = np.array([_seconds(path, i, point) for i, point in enumerate(points)]) + _start(path, comments)
    base = read_pelvis(path, comments, len(time))
    return to_gait(path, time, q[:, columns], base, read_metadata(path, comments))


def _start(path: Path, comments: list[Comment]) -> float:
    """First time of the walk [s]."""
    start = next((comment.value for comment in comments if comment.key == START_COMMENT), "0")
    try:
        return float(start)
    except ValueError:
        raise FormatError(path, f"start is {start[:40]!r}, expected seconds") from None


def _inner(message: object) -> object:
    """The JointTrajectory inside a goal of FollowJointTrajectory or a RobotTrajectory, or what was given."""
    for key in ("goal", *_WRAPPINGS):
        if isinstance(message, dict) and isinstance(message.get(key), dict):
            message = message[key]
    return message


def _columns(path: Path, names: object, options: ReadOptions) -> list[int]:
    """Where each of our joints stands in the message."""
    if not isinstance(names, list) or not all(isinstance(name, str) for name in names):
        raise FormatError(path, "joint_names must be a list of names")
    for joint in options.mapping.values():
        if joint not in JOINTS:
            raise UnknownNameError("joint", joint, JOINTS)
    ours = [options.mapping.get(name, name) for name in names]
    gone = [joint for joint in JOINTS if ours.count(joint) != 1]
    if gone:
        wanted, found = (", ".join(some[:3]) + " ..." * (len(some) > 3) for some in (gone, names))
        raise FormatError(
            path, f"joints must be there once each, but not so {wanted}; the file has {found[:120]}"
        )
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
