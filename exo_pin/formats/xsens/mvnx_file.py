"""Joint angles of Xsens MVN as a walk: their order and signs, the pelvis's motion, foot contacts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from types import MappingProxyType

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.names import EventKind, Movement, Side
from exo_pin.arrays import Array, Mask
from exo_pin.errors import FormatError
from exo_pin.formats.read_options import ReadOptions
from exo_pin.formats.tables.metadata import Metadata, to_gait
from exo_pin.formats.trial_file import TrialFile
from exo_pin.formats.xsens.mvnx_frames import MvnxFrames, read_frames
from exo_pin.gait import Event, Gait
from exo_pin.gait.quaternions import rotations

_ANGLES: Mapping[Movement, tuple[str, int, int]] = MappingProxyType(
    {
        "hip_flexion": ("Hip", 2, 1),
        "hip_adduction": ("Hip", 0, -1),
        "hip_rotation": ("Hip", 1, 1),
        "knee_flexion": ("Knee", 2, 1),
        "ankle_dorsiflexion": ("Ankle", 2, 1),
        "ankle_inversion": ("Ankle", 0, -1),
    }
)
"""Movement -> joint of MVN, its component (x, y, z) and sign.

MVN decomposes the rotation between two segments (x forward, y up, z right: ISB) in the order Z X Y: flexion,
abduction, rotation (MVN user manual, "Joint angles"), the order of this package's clinical hip. x is positive
in abduction and eversion, y in internal rotation, z in flexion and dorsiflexion, on both sides: so the
orientations of the segments in a published recording say within 0.001 degrees for every sign of both legs
(robotology-playground/xsens-mvn, Meri-020.mvnx; `test_mvnx` repeats one frame)."""

_SHORTEST = 0.1
"""A contact, or a gap in one, that is shorter [s] is no step but noise of the detection."""


@dataclass(frozen=True, eq=False)
class MvnxFile(TrialFile):
    """An .mvnx file.

    Attributes:
        frames: Its recording.
    """

    frames: MvnxFrames

    def gait(self, options: ReadOptions) -> Gait:
        """The walk by MVN's joint angles; the pelvis's pose, if there, becomes the base.

        Raises:
            FormatError: Joints of the legs miss, or the numbers are no walk.
        """
        why = "MVN's joint angles have one order and sign, in degrees"
        options.refuse(self.path, "preset", "mapping", "units", why=why)
        frames = self.frames
        absent = sorted(_needed() - set(frames.joints))
        if absent:
            raise FormatError(
                self.path, f"no joint {', '.join(absent)}; the legs need {len(_needed())} joints"
            )
        q = np.column_stack([_angle(frames, side, movement) for side in SIDES for movement in _ANGLES])
        base = _base(self.path, frames)
        events = _events(frames)
        remarks = [] if base is not None else ["no position and orientation of the pelvis: it does not move"]
        version = f" {frames.version}" if frames.version else ""
        source = f"{self.path.name}, Xsens MVN{version[:40]} joint angles (ZXY)"
        metadata = Metadata(events, source=source, remarks=tuple(remarks))
        return to_gait(self.path, frames.time, q, base, metadata)


def open_mvnx(path: Path) -> MvnxFile:
    """Read an .mvnx file; raises `FormatError`."""
    return MvnxFile(path, read_frames(path))


def _joint(side: Side, name: str) -> str:
    return f"j{side.title()}{name}"


def _needed() -> set[str]:
    return {_joint(side, name) for side in SIDES for name, _, _ in _ANGLES.values()}


def _angle(frames: MvnxFrames, side: Side, movement: Movement) -> Array:
    """`(n,)` [rad]."""
    name, component, sign = _ANGLES[movement]
    return np.asarray(sign * np.radians(frames.joints[_joint(side, name)][:, component]))


def _base(path: Path, frames: MvnxFrames) -> Array | None:
    """`(n, 4, 4)` T_world_pelvis: MVN's pelvis lies midway between the hips, x forward, y left, z up."""
    if frames.pelvis_quaternion is None or frames.pelvis_position is None:
        return None
    length = np.linalg.norm(frames.pelvis_quaternion, axis=1)
    if (np.abs(length - 1) > 1e-2).any():
        raise FormatError(path, "the pelvis's orientation is no unit quaternion")
    T = np.tile(np.eye(4), (len(length), 1, 1))
    T[:, :3, :3] = rotations(frames.pelvis_quaternion / length[:, None])
    T[:, :3, 3] = frames.pelvis_position
    return T


def _events(frames: MvnxFrames) -> tuple[Event, ...]:
    """Heel strikes and toe-offs where MVN's contacts of a foot begin and end."""
    out = list[Event]()
    for side in SIDES:
        points = [values for name, values in frames.contacts.items() if name.startswith(side.title())]
        if not points:
            continue
        down = _without_flicker(np.any([values > 0 for values in points], axis=0), frames.time)
        for k in np.flatnonzero(np.diff(down.astype(int))) + 1:
            kind: EventKind = "heel_strike" if down[k] else "toe_off"
            out.append(Event(float(frames.time[k]), kind, side, "MVN foot contact"))
    return tuple(out)


def _without_flicker(down: Mask, time: Array) -> Mask:
    """The contacts without gaps, and then without contacts, that are too short."""
    kept = down.copy()
    for state in (False, True):
        edges = np.flatnonzero(np.diff(kept.astype(int))) + 1
        for start, stop in pairwise(edges.tolist()):
            if kept[start] == state and time[stop] - time[start] < _SHORTEST:
                kept[start:stop] = not state
    return kept
