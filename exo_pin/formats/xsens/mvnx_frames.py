"""Frames of an .mvnx file as arrays: time, joint angles, poses of the pelvis, foot contacts."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple
from xml.etree.ElementTree import Element

import numpy as np

from exo_pin.arrays import Array
from exo_pin.errors import FormatError
from exo_pin.safe.plain_numbers import number_or_nan
from exo_pin.safe.xml_reader import XmlLimits, load_xml

_UNUSED = (
    *(
        "velocity",
        "acceleration",
        "angularVelocity",
        "angularAcceleration",
        "jointAngleXZY",
        "jointAngleErgo",
    ),
    *("jointAngleErgoXZY", "sensorAcceleration", "sensorAngularVelocity", "sensorFreeAcceleration"),
    *("sensorMagneticField", "sensorOrientation", "centerOfMass", "points", "marker", "sensors"),
    *("positionFingersLeft", "positionFingersRight", "orientationFingersLeft", "orientationFingersRight"),
    *("jointAngleFingersLeft", "jointAngleFingersRight"),
)
"""Elements that nothing here needs; they are most of a file."""

_LIMITS = XmlLimits(mebibytes=128, elements=4_000_000, skipped=frozenset(_UNUSED))
"""A recording of ten minutes at 60 Hz has 70 MiB and 600 000 elements."""

_STANDARD_JOINTS = (
    *("jL5S1", "jL4L3", "jL1T12", "jT9T8", "jT1C7", "jC1Head"),
    *(f"jRight{name}" for name in ("T4Shoulder", "Shoulder", "Elbow", "Wrist")),
    *(f"jLeft{name}" for name in ("T4Shoulder", "Shoulder", "Elbow", "Wrist")),
    *(f"jRight{name}" for name in ("Hip", "Knee", "Ankle", "BallFoot")),
    *(f"jLeft{name}" for name in ("Hip", "Knee", "Ankle", "BallFoot")),
)
"""Order of the joints where a file does not list them (MVN user manual)."""


class MvnxFrames(NamedTuple):
    """The frames of a recording.

    Attributes:
        time: `(n,)` [s].
        joints: Name of a joint -> `(n, 3)` its angles x, y, z [deg], as the file has them.
        pelvis_quaternion: `(n, 4)` orientation of the pelvis, w first; or None.
        pelvis_position: `(n, 3)` [m]; or None.
        contacts: Name of a foot's point -> `(n,)` whether it touches the ground (1) or not (0).
        version: Of the program, as the file states it.
    """

    time: Array
    joints: dict[str, Array]
    pelvis_quaternion: Array | None
    pelvis_position: Array | None
    contacts: dict[str, Array]
    version: str


def read_frames(path: Path) -> MvnxFrames:
    """Read an .mvnx file.

    Raises:
        FormatError: With file and reason: no XML, no frames with joint angles, frames that differ in size.
    """
    root = load_xml(path, _LIMITS)
    subject = next(root.iter("subject"), None)
    if root.tag != "mvnx" or subject is None:
        raise FormatError(path, "no .mvnx file: expected <mvnx> with a <subject>")
    frames = [frame for frame in subject.iter("frame") if frame.get("type", "normal") == "normal"]
    if len(frames) < 2:
        raise FormatError(path, f"{len(frames)} frames of type normal; a walk has at least 2")
    names = [joint.get("label", "") for joint in subject.iter("joint")] or list(_STANDARD_JOINTS)
    angles = _numbers(path, frames, "jointAngle", 3 * len(names))
    if angles is None:
        raise FormatError(path, "no <jointAngle> in its frames; export the joint angles in MVN")
    segments = [segment.get("label", "") for segment in subject.iter("segment")] or ["Pelvis"]
    first = segments.index("Pelvis") if "Pelvis" in segments else 0
    turn, place = (_numbers(path, frames, name, None) for name in ("orientation", "position"))
    version = next(root.iter("mvn"), root).get("version", "")
    return MvnxFrames(
        _times(path, subject, frames),
        {name: angles[:, 3 * k : 3 * k + 3] for k, name in enumerate(names)},
        _part(turn, first, 4),
        _part(place, first, 3),
        _contacts(path, subject, frames),
        version if version.isprintable() else "",
    )


def _numbers(path: Path, frames: Sequence[Element], name: str, width: int | None) -> Array | None:
    """`(n, width)` the numbers of one element of every frame; None where no frame has it."""
    found = [frame.find(name) for frame in frames]
    if not any(child is not None for child in found):
        return None
    rows = list[Array]()
    for frame, child in enumerate(found):
        try:
            row = np.array(((child.text or "") if child is not None else "").split(), dtype=float)
        except ValueError:
            raise FormatError(path, f"frame {frame}: <{name}> holds no numbers") from None
        width = row.size if width is None else width
        if row.size != width or not (np.abs(row) < _LARGEST).all():
            why = f"frame {frame}: <{name}> has {row.size} numbers, expected {width} finite ones"
            raise FormatError(path, why)
        rows.append(row)
    return np.array(rows)


_LARGEST = 1e6
"""No angle [deg], position [m] or part of a quaternion is larger."""


def _part(values: Array | None, k: int, width: int) -> Array | None:
    """`(n, width)` the numbers of one segment; None where there are none."""
    if values is None or values.shape[1] < (k + 1) * width:
        return None
    return values[:, k * width : (k + 1) * width]


def _times(path: Path, subject: Element, frames: Sequence[Element]) -> Array:
    """`(n,)` seconds: by the frames' numbers and the rate, which are exact, else by their milliseconds."""
    rate = number_or_nan(subject.get("frameRate", ""))
    indices = [number_or_nan(frame.get("index", "")) for frame in frames]
    if 0 < rate <= 1e5 and np.isfinite(indices).all() and (np.diff(indices) > 0).all():
        return np.array(indices) / rate
    times = np.array([number_or_nan(frame.get("time", "")) for frame in frames]) / 1000
    if not np.isfinite(times).all():
        raise FormatError(path, "its frames have neither numbers (index) at a frameRate nor times in ms")
    return times


def _contacts(path: Path, subject: Element, frames: Sequence[Element]) -> dict[str, Array]:
    """Which points of the feet touch the ground, where the file defines and has them."""
    names = [found.get("label", "") for found in subject.iter("contactDefinition")]
    values = _numbers(path, frames, "footContacts", len(names)) if names else None
    return {} if values is None else {name: values[:, k] for k, name in enumerate(names)}
