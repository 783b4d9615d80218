"""A walk as a table of pandas or an array of xarray, and back."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from exo_pin.anatomy import JOINTS
from exo_pin.arrays import Array
from exo_pin.errors import GaitError
from exo_pin.gait.event import Event
from exo_pin.gait.quaternions import quaternions, rotations

if TYPE_CHECKING:
    from pandas import DataFrame
    from xarray import DataArray

PELVIS_COLUMNS = ("pelvis_x", "pelvis_y", "pelvis_z", "pelvis_qw", "pelvis_qx", "pelvis_qy", "pelvis_qz")
"""Columns of the pelvis: where it is [m], its attitude as a unit quaternion."""


def frame_of(time: Array, q: Array, base: Array | None, attrs: Mapping[str, Any]) -> DataFrame:
    """A column of angles for each joint [rad], with the pelvis if it moves; the index is time [s].

    Args:
        time: `(n,)` [s].
        q: `(n, 12)` in the order of `JOINTS` [rad].
        base: `(n, 4, 4)` pose of the pelvis, if it moves [m].
        attrs: What is no column: `periodic`, `source`, `events` as (side, kind, time).
    """
    from pandas import DataFrame, Index

    columns = dict(zip(JOINTS, q.T, strict=True))
    if base is not None:
        pelvis = np.hstack([base[:, :3, 3], quaternions(base[:, :3, :3])])
        columns |= dict(zip(PELVIS_COLUMNS, pelvis.T, strict=True))
    frame = DataFrame(columns, index=Index(time, name="time"))
    frame.attrs |= dict(attrs)
    return frame


def columns_of(frame: DataFrame) -> dict[str, Any]:
    """The arguments of a `Gait` from a table as `Gait.to_pandas` makes it.

    Args:
        frame: With the joints of `JOINTS`, time as its index; pelvis and `attrs` as they are there.

    Raises:
        GaitError: A joint, or some of the pelvis's columns are missing.
    """
    pelvis = [name for name in PELVIS_COLUMNS if name in frame.columns]
    wanted = (*JOINTS, *(PELVIS_COLUMNS if pelvis else ()))
    missing = [name for name in wanted if name not in frame.columns]
    if missing:
        raise GaitError(f"the table has no column {', '.join(missing)}; those of Gait.to_pandas are accepted")
    base = None
    if pelvis:
        numbers = frame[list(PELVIS_COLUMNS)].to_numpy(dtype=float)
        base = np.tile(np.eye(4), (len(frame), 1, 1))
        base[:, :3, 3], base[:, :3, :3] = numbers[:, :3], rotations(numbers[:, 3:])
    return {
        "time": frame.index.to_numpy(dtype=float),
        "q": frame[list(JOINTS)].to_numpy(dtype=float),
        "base": base,
        "events": tuple(Event(time, kind, side) for side, kind, time in frame.attrs.get("events", ())),
        "periodic": bool(frame.attrs.get("periodic", False)),
        "source": str(frame.attrs.get("source", "")),
    }


def array_of(time: Array, q: Array, attrs: Mapping[str, Any]) -> DataArray:
    """Angles [rad] with the dimensions time [s] and joint.

    Args:
        time: `(n,)` [s].
        q: `(n, 12)` in the order of `JOINTS` [rad].
        attrs: Further facts; the unit is added.
    """
    from xarray import DataArray

    coordinates = {"time": time, "joint": list(JOINTS)}
    return DataArray(
        q, dims=("time", "joint"), coords=coordinates, name="angle", attrs={"units": "rad", **attrs}
    )
