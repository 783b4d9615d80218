"""Validation of a walk's arrays: shape, time, angles, poses and events."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from exo_pin.anatomy import JOINTS
from exo_pin.arrays import Array, as_floats
from exo_pin.errors import GaitError
from exo_pin.gait import rigid_poses
from exo_pin.gait.event import SAME_TIME, Event

_LARGEST_ANGLE = np.pi
"""No joint of a leg turns further [rad]; a larger number is nearly always degrees taken for radians."""

FURTHEST = 1e4
"""From the origin of a laboratory [m]; a position beyond is a damaged number."""

LARGEST_TIME = 1e9
"""Thirty years [s]: a number beyond is no time of a walk."""

_UNIFORM = 1e-6
"""How far the samples of a periodic gait may lie off an even grid, as a fraction of the step."""


def read_only(array: Array) -> Array:
    """The same array, closed for writing."""
    array.setflags(write=False)
    return array


def frozen(values: ArrayLike, name: str) -> Array:
    """A read-only copy of real numbers, shared where nothing can change it; `GaitError` if they are none."""
    try:
        array = as_floats(values)
        return array if _unchangeable(array) else read_only(np.array(array))
    except (TypeError, ValueError):
        raise GaitError(f"{name} is not an array of real numbers") from None


def _unchangeable(array: Array) -> bool:
    """Whether an array is read-only, and all that its memory belongs to: those of a gait, of a file."""
    owner: object = array
    while isinstance(owner, np.ndarray) and not owner.flags.writeable:
        owner = owner.base
    return owner is None or isinstance(owner, bytes)


def duration(time: Array, periodic: bool) -> float:
    """Last minus first sample, and where the walk repeats also the step back to its start [s]."""
    n = len(time)
    span = float(time[-1] - time[0])
    return span * n / (n - 1) if periodic else span


def check_time(time: Array, periodic: bool) -> None:
    """Raises `GaitError` unless `time` is `(n,)`, n >= 2, finite and increasing; even from 0 if periodic."""
    if time.ndim != 1 or len(time) < 2:
        raise GaitError(f"time has shape {time.shape}, expected (n,) with at least 2 samples")
    bad = np.flatnonzero(~(np.abs(time) <= LARGEST_TIME))
    if bad.size:
        raise GaitError(f"time of frame {bad[0]} is {time[bad[0]]:g}, expected seconds")
    late = np.flatnonzero(np.diff(time) < SAME_TIME)  # differences of such samples would be rounding
    if late.size:
        k = int(late[0])
        raise GaitError(
            f"time does not increase from frame {k} ({time[k]:.12g} s) "
            f"to frame {k + 1} ({time[k + 1]:.12g} s); expected strictly increasing seconds"
        )
    if periodic:
        _check_cycle(time)


def _check_cycle(time: Array) -> None:
    if time[0] != 0:
        raise GaitError(f"a periodic gait stores [0, T): its time starts at 0, not at {time[0]:g} s")
    step = time[-1] / (len(time) - 1)
    off = np.abs(time - step * np.arange(len(time)))
    if off.max() > _UNIFORM * step:
        raise GaitError(
            f"a periodic gait is evenly sampled, but frame {int(off.argmax())} lies {off.max():.3g} s off "
            "the grid; resample it before it is marked as periodic"
        )


def check_angles(q: Array, n: int) -> None:
    """Raises `GaitError` unless `q` is `(n, 12)`, finite and within half a turn."""
    if q.shape != (n, len(JOINTS)):
        raise GaitError(
            f"q has shape {q.shape}, expected ({n}, {len(JOINTS)}): a row per time, columns as JOINTS"
        )
    for bad, hint in (
        (~np.isfinite(q), "expected a finite angle"),
        (np.abs(q) > _LARGEST_ANGLE, "more than half a turn; degrees given as radians?"),
    ):
        if bad.any():
            frame, joint = np.argwhere(bad)[0]
            raise GaitError(f"{JOINTS[joint]} of frame {frame} is {q[frame, joint]:g} rad: {hint}")


def check_poses(T: Array, n: int, name: str) -> None:
    """Raises `GaitError` unless `T` is `(n, 4, 4)` rigid poses.

    Args:
        T: The poses.
        n: Number of samples.
        name: Name of the array in messages.
    """
    if T.shape != (n, 4, 4):
        raise GaitError(f"{name} has shape {T.shape}, expected ({n}, 4, 4): a pose in the world per time")
    far = np.flatnonzero((np.abs(T[:, :3, 3]) > FURTHEST).any(axis=1))
    if far.size:
        raise GaitError(f"{name} of frame {far[0]} is more than {FURTHEST:g} m away; expected metres")
    wrong = rigid_poses.not_rigid(T)
    if wrong is not None:
        raise GaitError(
            f"{name} of frame {wrong} is no rigid pose; expected a rotation, metres and last row 0 0 0 1"
        )


def check_events(events: Sequence[Event], time: Array, periodic: bool) -> None:
    """Raises `GaitError` for an event outside the walk: [start, end), or [start, end] if not periodic.

    Args:
        events: Gait events.
        time: `(n,)` [s].
        periodic: Whether the walk repeats.
    """
    start = float(time[0])
    end = start + duration(time, periodic)
    for event in events:
        inside = start <= event.time < end if periodic else start <= event.time <= end
        if not inside:
            raise GaitError(
                f"event {event.kind} {event.side} at {event.time:g} s "
                f"lies outside the walk, {start:g} to {end:g} s"
            )
