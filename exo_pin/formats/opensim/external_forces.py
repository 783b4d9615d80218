"""Ground reaction forces in OpenSim's storage format, with column names of three styles."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from exo_pin.arrays import Array
from exo_pin.errors import FormatError
from exo_pin.formats.opensim.coordinate_table import is_time
from exo_pin.formats.opensim.pelvis_axes import FROM_OPENSIM
from exo_pin.formats.opensim.storage import Storage
from exo_pin.formats.tables.numeric_table import NumericTable
from exo_pin.gait.trial import LARGEST_FORCE, ForcePlate
from exo_pin.gait.validation import FURTHEST

_FORCE_COLUMN = re.compile(
    r"(?P<head>.*?)(?P<kind>force|torque|moment)(?P<tail>.*?)_?(?P<what>[vpm]?)(?P<axis>[xyz])$",
    re.IGNORECASE,
)
"""`1_ground_force_vx`, `ground_force_1_vx`, `ground_force_l_px`, `ground_torque_x`, `l_ground_moment_mx`."""


def force_plates(storage: Storage) -> tuple[ForcePlate, ...]:
    """The force plates of a storage file; OpenSim's axes (y up) become this package's (z up).

    A point or moment that is NaN, as many programs write it while nobody stands on the plate, is 0; under a
    load it stays NaN.

    Raises:
        FormatError: With reason: no forces, columns that are missing.
    """
    path = storage.table.path
    names = tuple("time" if is_time(name) else name for name in storage.table.names)
    table = replace(storage.table, names=names)
    if "time" not in table.names:
        raise FormatError(path, "no column 'time'", line=table.lines[0] - 1)
    groups = _groups(table.names)
    if not groups:
        raise FormatError(path, "no ground reaction forces; expected columns like ground_force_vx")
    used = list(dict.fromkeys(name for columns in groups.values() for name in columns.values()))
    table.refuse_repeated(["time", *used])
    table, doubled = table.once_each_time("time", used)
    time, remarks = table.times("time"), (*storage.remarks, *doubled)
    bare = [name for name, columns in groups.items() if not _MOMENTS & set(columns)]
    remarks += tuple(
        f"{_title(name)} has no torque columns: its free moments are taken as 0" for name in bare
    )
    plates = (_plate(table, time, name, columns) for name, columns in groups.items())
    return tuple(replace(plate, remarks=remarks) for plate in plates)


def _groups(names: Iterable[str]) -> dict[str, dict[str, str]]:
    """Plate -> (`vx`, `py`, `mz` ...) -> column."""
    groups: dict[str, dict[str, str]] = {}
    for name in names:
        match = _FORCE_COLUMN.match(name)
        if match is None:
            continue
        what = "m" if match["kind"].lower() != "force" else match["what"].lower()
        key = re.sub("ground", "", match["head"] + match["tail"], flags=re.IGNORECASE).strip("_")
        groups.setdefault(key, {})[what + match["axis"].lower()] = name
    return {key: columns for key, columns in groups.items() if {"vx", "vy", "vz"} <= set(columns)}


_MOMENTS = {"mx", "my", "mz"}

_LOADED = 20.0
"""Force that shows a foot on the plate [N]; with less, its point is noise divided by noise."""

_MOST = {"v": (LARGEST_FORCE, "N"), "p": (FURTHEST, "m"), "m": (LARGEST_FORCE, "N m")}
"""What is read at most, with its unit."""


def _title(name: str) -> str:
    return f"force plate {name}".strip()


def _plate(table: NumericTable, time: Array, name: str, columns: dict[str, str]) -> ForcePlate:
    parts, loaded = [], np.zeros((len(time), 1), dtype=bool)
    kinds = "vpm" if _MOMENTS & set(columns) else "vp"
    for what in kinds:
        absent = [what + axis for axis in "xyz" if what + axis not in columns]
        if absent:
            raise FormatError(table.path, f"force plate {name or '1'} has no column for {', '.join(absent)}")
        names = [columns[what + axis] for axis in "xyz"]
        values = table.columns(names)
        if what == "v":
            table.refuse(np.isnan(values), names, "expected a finite number")
            loaded = np.abs(values).max(axis=1, keepdims=True) > _LOADED
        most, unit = _MOST[what]
        large = np.abs(values) > most
        table.refuse(large & (loaded | (what == "v")), names, f"more than {most:g} {unit}")
        parts.append(np.where(large | (np.isnan(values) & ~loaded), 0.0, values) @ FROM_OPENSIM.T)
    force, point, moment = [*parts, *[np.zeros_like(parts[0])] * (3 - len(parts))]
    return ForcePlate(_title(name), time, force, point, moment)
