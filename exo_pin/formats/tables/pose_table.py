"""Tables of foot poses: what `exo-pin fk` writes and `exo-pin ik` reads."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike

from exo_pin.anatomy import FEET
from exo_pin.arrays import Array
from exo_pin.errors import FormatError, GaitError, UnknownNameError
from exo_pin.formats.tables.csv_table import read_csv, write_csv
from exo_pin.formats.tables.notes import Notes, read
from exo_pin.formats.tables.pose_columns import pose_names, pose_values, read_poses
from exo_pin.gait import Event
from exo_pin.gait.validation import check_events, check_poses, check_time, frozen

TIME = "time_s"
PELVIS = "pelvis"
TITLE = "Poses in the world: time [s], position [m], unit quaternion w x y z."


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

    def __init__(
        self,
        time: ArrayLike,
        base: ArrayLike | None,
        targets: Mapping[str, ArrayLike],
        *,
        events: Iterable[Event] = (),
        periodic: bool = False,
        source: str = "",
    ) -> None:
        put = object.__setattr__  # the dataclass is frozen for everyone else
        put(self, "time", frozen(time, "time"))
        check_time(self.time, periodic)
        put(self, "base", None if base is None else frozen(base, "base"))
        if not targets:
            raise GaitError(f"no targets; expected poses of {' or '.join(FEET)}")
        put(self, "targets", MappingProxyType({name: frozen(T, name) for name, T in targets.items()}))
        put(self, "events", tuple(sorted(events, key=lambda event: event.time)))
        put(self, "periodic", bool(periodic))
        put(self, "source", str(source))
        self._check()

    def _check(self) -> None:
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

    Raises:
        FormatError: If the file is not such a table; with file, line and reason.
    """
    path = Path(path)
    frames = {frame: pose_names(frame) for frame in (PELVIS, *FEET)}
    table, present, comments = read_csv(path, (TIME,), frames)
    feet = [frame for frame in present if frame in FEET]
    if not feet:
        line = table.lines[0] - 1
        raise FormatError(path, f"no foot; expected columns {', '.join(pose_names(FEET[0]))}", line=line)
    notes = read(path, comments)
    base = read_poses(table, PELVIS) if PELVIS in present else None
    targets = {frame: read_poses(table, frame) for frame in feet}
    source = path.name if notes.source is None else notes.source
    try:
        return Poses(
            table.times(TIME), base, targets, events=notes.events, periodic=notes.periodic, source=source
        )
    except FormatError:
        raise
    except GaitError as error:
        raise FormatError(path, str(error)) from error


def save_poses(poses: Poses, path: str | Path) -> None:
    """Write poses so that `load_poses` brings them back within 1e-12; quaternions have qw >= 0.

    Raises:
        FormatError: If the file cannot be written.
    """
    frames = {PELVIS: poses.base} if poses.base is not None else {}
    frames |= poses.targets
    names = [TIME, *(name for frame in frames for name in pose_names(frame))]
    values = np.hstack([poses.time[:, None], *map(pose_values, frames.values())])
    write_csv(Path(path), TITLE, Notes(poses.events, poses.periodic, poses.source), names, values)
