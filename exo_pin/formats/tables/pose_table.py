"""Tables of foot poses: what `exo-pin fk` writes and `exo-pin ik` reads."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike

from exo_pin.anatomy import FEET
from exo_pin.arguments import table
from exo_pin.arrays import Array
from exo_pin.errors import FormatError, GaitError, UnknownNameError, naming_file
from exo_pin.files import read_lines
from exo_pin.formats.tables.csv_table import parse_csv, write_csv
from exo_pin.formats.tables.metadata import Metadata, read_metadata
from exo_pin.formats.tables.pose_columns import pose_names, pose_values, read_poses
from exo_pin.frozen_fields import set_fields
from exo_pin.gait import Event
from exo_pin.gait.even_clock import even_clock, evened_remark, within
from exo_pin.gait.validation import check_events, check_poses, check_time, frozen
from exo_pin.short_repr import short_repr

_TIME = "time_s"
_PELVIS = "pelvis"
_TITLE = "Poses in the world: time [s], position [m], unit quaternion w x y z."


@dataclass(frozen=True, eq=False, init=False)
class Poses:
    """Where the feet are over time.

    Attributes:
        time: `(n,)` strictly increasing [s].
        base: `(n, 4, 4)` pose of the pelvis in the world [m], or None if it does not move.
        targets: Frame (`left_foot`, `right_foot`) -> `(n, 4, 4)` pose in the world [m].
        events: Foot contacts, sorted by time, as in a `Gait`.
        periodic: Whether the motion repeats; then it stores [0, T).
        source: Where the numbers come from, in words.
        remarks: What reading the file corrected, a plain sentence each.

    Raises:
        GaitError: If time, poses or events are unusable; the message says which and where.
        UnknownNameError: If a target is no foot.
    """

    time: Array
    base: Array | None
    targets: Mapping[str, Array]
    events: tuple[Event, ...]
    periodic: bool
    source: str
    remarks: tuple[str, ...]

    __repr__ = short_repr

    def __init__(
        self,
        time: ArrayLike,
        base: ArrayLike | None,
        targets: Mapping[str, ArrayLike],
        *,
        events: Iterable[Event] = (),
        periodic: bool = False,
        source: str = "",
        remarks: Iterable[str] = (),
    ) -> None:
        table("targets", targets, error=GaitError)
        set_fields(
            self,
            time=frozen(time, "time"),
            base=None if base is None else frozen(base, "base"),
            targets=MappingProxyType({name: frozen(T, name) for name, T in targets.items()}),
            events=tuple(sorted(events, key=lambda event: event.time)),
            periodic=bool(periodic),
            source=str(source),
            remarks=tuple(remarks),
        )
        self._check()

    def _check(self) -> None:
        check_time(self.time, self.periodic)
        if not self.targets:
            raise GaitError(f"no targets; expected poses of {' or '.join(FEET)}")
        n = len(self.time)
        for name in self.targets:
            if name not in FEET:
                raise UnknownNameError("foot", name, FEET)
        for name, T in (("base", self.base), *self.targets.items()):
            if T is not None:
                check_poses(T, n, name)
        check_events(self.events, self.time, self.periodic)


def load_poses(path: str | Path) -> Poses:
    """Read columns `time_s` and, per frame, `<frame>_{x,y,z}_m` and `<frame>_{qw,qx,qy,qz}`.

    Frames are `left_foot`, `right_foot` (at least one) and `pelvis` (the base, optional), all in the world.
    Time stamps that the file rounded are put back on their even grid; `remarks` states it.

    Raises:
        FormatError: If the file is not such a table; with file, line and reason.
    """
    path = Path(path)
    frames = {frame: pose_names(frame) for frame in (_PELVIS, *FEET)}
    table, present, comments = parse_csv(path, read_lines(path), (_TIME,), frames)
    feet = [frame for frame in present if frame in FEET]
    if not feet:
        line = table.lines[0] - 1
        raise FormatError(path, f"no foot; expected columns {', '.join(pose_names(FEET[0]))}", line=line)
    metadata = read_metadata(path, comments)
    base = read_poses(table, _PELVIS) if _PELVIS in present else None
    targets = {frame: read_poses(table, frame) for frame in feet}
    source = path.name if metadata.source is None else metadata.source
    time = table.times(_TIME)
    even = even_clock(time)
    with naming_file(path):
        return Poses(
            time if even is None else even,
            base,
            targets,
            events=metadata.events if even is None else tuple(_kept_within(metadata.events, even)),
            periodic=metadata.periodic,
            source=source,
            remarks=() if even is None else (evened_remark(time, even),),
        )


def _kept_within(events: Iterable[Event], even: Array) -> Iterator[Event]:
    return (replace(event, time=within(event.time, even)) for event in events)


def save_poses(poses: Poses, path: str | Path) -> None:
    """Write poses so that `load_poses` brings them back within 1e-12; quaternions have qw >= 0.

    Raises:
        FormatError: If the file cannot be written.
    """
    frames = {_PELVIS: poses.base} if poses.base is not None else {}
    frames |= poses.targets
    names = [_TIME, *(name for frame in frames for name in pose_names(frame))]
    values = np.hstack([poses.time[:, None], *map(pose_values, frames.values())])
    write_csv(Path(path), _TITLE, Metadata(poses.events, poses.periodic, poses.source), names, values)
