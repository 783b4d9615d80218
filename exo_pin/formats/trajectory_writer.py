"""A walk as a ROS JointTrajectory message in YAML or JSON."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

from exo_pin.anatomy import JOINTS
from exo_pin.arrays import Array
from exo_pin.files import write_text
from exo_pin.formats.joint_trajectory import COMMENTS_KEY, START_COMMENT
from exo_pin.formats.tables.metadata import Metadata, comment_lines, pelvis_lines
from exo_pin.gait import Gait

_REMARK = "# JointTrajectory [rad, rad/s, rad/s^2, s]; positive is what the joint's name says."


def write_yaml(gait: Gait, path: Path) -> None:
    """Write positions, velocities, accelerations and times from the start; metadata are comments."""
    motion = (gait.q, gait.dq, gait.ddq)
    write_text(path, yaml_message(JOINTS, _from_start(gait), motion, [_REMARK, *_comments(gait)]))


def yaml_message(
    joints: Sequence[str], time: Sequence[float], motion: Sequence[Array], comments: Sequence[str]
) -> str:
    """A JointTrajectory message in YAML.

    Args:
        joints: Their J names.
        time: n times from the start [s].
        motion: Positions, velocities and accelerations `(n, J)` [rad, rad/s, rad/s^2].
        comments: Lines above the message, each of which starts with `#`.
    """
    points = [
        "- positions: [{}]\n  velocities: [{}]\n  accelerations: [{}]\n  time_from_start: "
        "{{sec: {}, nanosec: {}}}".format(*(_numbers(row) for row in rows), *_stamp(t))
        for t, *rows in zip(time, *motion, strict=True)
    ]
    names = "joint_names:\n" + "\n".join(f"- {joint}" for joint in joints)
    header = 'header: {stamp: {sec: 0, nanosec: 0}, frame_id: ""}'
    return "\n".join([*comments, header, names, "points:", *points, ""])


def write_json(gait: Gait, path: Path) -> None:
    """Write the same message as JSON; metadata are under the key `exo_pin`."""
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
        COMMENTS_KEY: _comments(gait),
    }
    write_text(path, json.dumps(message) + "\n")


def _comments(gait: Gait) -> list[str]:
    start = float(gait.time[0])
    lines = comment_lines(Metadata(gait.events, gait.periodic, gait.source))
    return [*lines, f"# {START_COMMENT}: {start!r}", *pelvis_lines(gait.base)]


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
