"""Part of a walk of Project MARCH's exoskeleton (.subgait): set points of every joint, in YAML."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import ceil, degrees
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from exo_pin.anatomy import JOINTS, SIDES
from exo_pin.anatomy.hip_cardan_angles import reorder
from exo_pin.anatomy.names import Side
from exo_pin.arrays import Array
from exo_pin.errors import FormatError
from exo_pin.files import read_text
from exo_pin.formats.read_options import ReadOptions
from exo_pin.formats.tables.metadata import Metadata, to_gait
from exo_pin.formats.trial_file import TrialFile
from exo_pin.gait import Gait
from exo_pin.safe.yaml_reader import load_yaml

_MOVEMENTS = MappingProxyType(
    {
        "hip_fe": ("hip_flexion", 1),
        "hip": ("hip_flexion", 1),
        "hip_aa": ("hip_adduction", -1),
        "knee": ("knee_flexion", 1),
        "ankle": ("ankle_dorsiflexion", 1),
    }
)
"""Joint of the exoskeleton -> our movement and its sign. The axes of its URDF (project-march/ProjectMarch,
march_description/urdf/march4.xacro: z up, the walker faces -x) make flexion, dorsiflexion and, on both sides,
abduction positive. March III has one axis at the hip."""

_NEEDED = ("hip_flexion", "knee_flexion", "ankle_dorsiflexion")
"""Movements that a walk cannot be without."""

_RATE = 100.0
"""Samples per second that are made of the set points [Hz]."""

_LIMITS = MappingProxyType({"time_from_start": 3600.0, "position": np.pi, "velocity": 100.0})
"""Largest numbers of a set point [s, rad, rad/s]. A subgait takes a second or two (this bounds memory), a
motor of the exoskeleton turns by 2.5 rad/s."""


class _SetPoints(NamedTuple):
    """Of one joint, `(k,)` each: seconds, angles [rad] and velocities [rad/s]."""

    time: Array
    position: Array
    velocity: Array


@dataclass(frozen=True, eq=False)
class SubgaitFile(TrialFile):
    """A .subgait file.

    Attributes:
        content: The parsed text.
    """

    content: object

    def gait(self, options: ReadOptions) -> Gait:
        """The walk that the set points make by cubic Hermite interpolation, as in the exoskeleton.

        Raises:
            FormatError: With joint and set point: the content is no subgait, or its numbers are no walk.
        """
        why = "it names the exoskeleton's own joints, in radians"
        options.refuse(self.path, "preset", "mapping", "units", why=why)
        return _gait(self.path, self.content)


def open_subgait(path: Path) -> SubgaitFile:
    """Read a .subgait file; raises `FormatError`."""
    return SubgaitFile(path, load_yaml(path, read_text(path)))


def _gait(path: Path, content: object) -> Gait:
    points = {name: _set_points(path, name, given) for name, given in _by_joint(path, content).items()}
    known, unknown = dict[str, tuple[int, _SetPoints]](), list[str]()
    for name, given in points.items():
        side, _, rest = name.partition("_")
        movement, sign = _MOVEMENTS.get(rest, ("", 0))
        if side in SIDES and movement:
            known[f"{side}_{movement}"] = sign, given
        else:
            unknown.append(name)
    gone = [
        f"{side}_{movement}" for side in SIDES for movement in _NEEDED if f"{side}_{movement}" not in known
    ]
    if gone:
        why = f"no set points of {', '.join(gone)}; the file has {', '.join(points)[:200] or 'no joint'}"
        raise FormatError(path, why)
    time, remarks = _span(path, [given for _, given in known.values()], content)
    q = np.zeros((len(time), len(JOINTS)))
    for joint, (sign, given) in known.items():
        q[:, JOINTS.index(joint)] = sign * _interpolated(given, time)
    q, held = _clinical(q, known)
    remarks += [held, *([f"not used: {', '.join(unknown)[:200]}"] if unknown else [])]
    count = sum(len(given.time) for _, given in known.values())
    source = f"{path.name}: Project MARCH subgait, {count} set points, cubic Hermite at {_RATE:g} Hz"
    return to_gait(path, time, q, None, Metadata(source=source, remarks=tuple(remarks)))


def _by_joint(path: Path, content: object) -> dict[str, list[Any]]:
    """Joint -> its set points, of the layout by joint or of the older one, a JointTrajectory."""
    given = content.get("joints") if isinstance(content, dict) else None
    joints = given if isinstance(given, dict) else _transposed(content)
    if not joints or not all(isinstance(x, str) and isinstance(y, list) for x, y in joints.items()):
        raise FormatError(path, "no subgait; expected the key joints with a list of set points of each joint")
    return joints


def _transposed(content: object) -> dict[str, list[Any]]:
    """The set points by joint of a JointTrajectory; empty where the content is no such message."""
    found = content.get("trajectory") if isinstance(content, dict) else None
    message = found if isinstance(found, dict) else {}
    names, points = message.get("joint_names"), message.get("points")
    if not isinstance(names, list) or not isinstance(points, list):
        return {}
    rows = [point if isinstance(point, dict) else {} for point in points]
    lists = [row.get(many) for row in rows for many in _LISTS]
    if not all(isinstance(numbers, list) and len(numbers) == len(names) for numbers in lists):
        return {}
    return {str(name): [_set_point(row, k) for row in rows] for k, name in enumerate(names)}


def _set_point(row: Mapping[str, Any], k: int) -> dict[str, Any]:
    """One joint's part of a JointTrajectory's point."""
    numbers = {one: row[many][k] for many, one in _LISTS.items()}
    return {"time_from_start": row.get("time_from_start"), **numbers}


_LISTS = MappingProxyType({"positions": "position", "velocities": "velocity"})
"""Lists of a JointTrajectory's point -> what a joint's set point calls its number."""


def _set_points(path: Path, joint: str, given: list[Any]) -> _SetPoints:
    values = np.array([_numbers(path, joint, k, point) for k, point in enumerate(given, 1)]).reshape(-1, 3)
    if len(values) < 2 or not (np.diff(values[:, 0]) > 0).all():
        why = f"{joint[:40]}: expected at least 2 set points, each later than the one before"
        raise FormatError(path, why)
    return _SetPoints(*values.T)


def _numbers(path: Path, joint: str, k: int, point: object) -> list[float]:
    """Seconds, angle and velocity of one set point."""
    numbers = []
    for word, limit in _LIMITS.items():
        value: Any = point.get(word) if isinstance(point, dict) else None
        number: Any = _seconds(value) if word == "time_from_start" else value
        if not (_is_number(number) and abs(number) <= limit):
            why = f"{joint[:40]}, set point {k}: {word} must be a number up to {limit:.5g}"
            raise FormatError(path, why)
        numbers.append(float(number))
    return numbers


def _seconds(stamp: object) -> Any:
    """Seconds and nanoseconds, or nanoseconds alone (a whole number), or seconds; None for anything else."""
    if isinstance(stamp, dict):
        seconds: Any = stamp.get("secs", stamp.get("sec", 0))
        rest: Any = stamp.get("nsecs", stamp.get("nanosec", 0))
        return seconds + rest * 1e-9 if _is_number(seconds) and _is_number(rest) else None
    return stamp * 1e-9 if isinstance(stamp, int) and _is_number(stamp) else stamp


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) < 1e300


def _span(path: Path, joints: list[_SetPoints], content: Any) -> tuple[Array, list[str]]:
    """`(n,)` times at which every joint is known [s], and where the file states another duration."""
    start, stop = max(given.time[0] for given in joints), min(given.time[-1] for given in joints)
    if not stop - start > 1 / _RATE:
        raise FormatError(path, f"the joints are known together from {start:g} to {stop:g} s only")
    remarks = []
    last = max(given.time[-1] for given in joints)
    stated = _seconds(content.get("duration")) if isinstance(content, dict) else None
    if _is_number(stated) and abs(stated - stop) > 1 / _RATE:
        remarks.append(f"the file says {stated:g} s, its set points end at {stop:g} s")
    if last - stop > 1 / _RATE or start > 1 / _RATE:
        remarks.append(f"read from {start:g} to {stop:g} s, where every joint has set points")
    return np.linspace(start, stop, ceil((stop - start) * _RATE - 1e-6) + 1), remarks


def _interpolated(given: _SetPoints, time: Array) -> Array:
    from scipy.interpolate import CubicHermiteSpline  # 0.3 s, needed here only

    return np.asarray(CubicHermiteSpline(given.time, given.position, given.velocity)(time))


def _clinical(q: Array, known: Mapping[str, object]) -> tuple[Array, str]:
    """Angles in this package's order of hip axes, and what is held.

    The exoskeleton's hip abducts first and flexes then; without rotation that is the order yaw_roll_pitch.
    """
    columns = {side: _hip_columns(side) for side in SIDES}
    for side, hip in columns.items():
        q[:, hip] = reorder(q[:, hip], side, source="yaw_roll_pitch", target="clinical")
    turned = degrees(max(np.abs(q[:, hip[2]]).max() for hip in columns.values()))
    held = ["hip rotation", "ankle inversion"]
    held += [] if any(joint.endswith("adduction") for joint in known) else ["hip adduction"]
    text = f"the exoskeleton has no {' and no '.join(held)}: held at 0"
    if turned > 0.05:
        text += (
            f" on its own axes; it abducts before it flexes, in our order it rotates up to {turned:.1f} deg"
        )
    return q, text


def _hip_columns(side: Side) -> list[int]:
    return [JOINTS.index(f"{side}_hip_{word}") for word in ("flexion", "adduction", "rotation")]
