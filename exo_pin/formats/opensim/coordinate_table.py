"""The table of a file of OpenSim coordinates, checked to hold all that a walk needs."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

from exo_pin.errors import FormatError
from exo_pin.formats.opensim.convention import Convention
from exo_pin.formats.opensim.coordinate_names import COORDINATE_OF, LEG_COORDINATES
from exo_pin.formats.opensim.storage import Storage
from exo_pin.formats.tables.numeric_table import NumericTable

TIME_COLUMN = "time"

_DERIVATIVES = ("speeds", "velocities", "accelerations")
"""Titles of OpenSim's files with the same column names but other contents."""


def coordinate_table(storage: Storage, convention: Convention) -> NumericTable:
    """The table with plain coordinate names.

    Raises:
        FormatError: It holds no coordinates, one twice, or lacks one that has no default.
    """
    table, path = storage.table, storage.table.path
    line = table.lines[0] - 1
    if storage.title.lower() in _DERIVATIVES:
        raise FormatError(
            path, f"titled {storage.title[:40]!r}; expected coordinates, not their derivatives", line=1
        )
    names = tuple(_plain(name) for name in table.names)
    count = Counter(names)
    twice = [name for name in (TIME_COLUMN, *LEG_COORDINATES, *convention.pelvis) if count[name] > 1]
    if twice:
        raise FormatError(path, f"coordinate {twice[0]!r} occurs more than once", line=line)
    _check_complete(path, names, convention, line)
    return NumericTable(path, names, table.values, table.lines)


def _check_complete(path: Path, names: tuple[str, ...], convention: Convention, line: int) -> None:
    """Raises `FormatError` where a coordinate misses that has no default."""
    known = {*names, *convention.defaults}
    absent = [name for name in (TIME_COLUMN, *LEG_COORDINATES) if name not in known]
    if absent and any(re.search(r"force|moment|torque", name, re.IGNORECASE) for name in names):
        raise FormatError(
            path, "holds forces or moments; expected joint coordinates (inverse kinematics)", line=line
        )
    pelvis = [name for name in convention.pelvis if name not in known]
    if absent or 0 < len(pelvis) < len(convention.pelvis):
        joints = ",".join(name for name, column in COORDINATE_OF.items() if column in absent)
        hint = f"; a model (.osim) may do without, a mapping holds joints at a number: 0={joints}"
        why = f"missing coordinates: {', '.join(absent or pelvis)}{hint if joints else ''}"
        raise FormatError(path, why, line=line)


def _plain(name: str) -> str:
    """`/jointset/hip_r/hip_flexion_r/value` -> `hip_flexion_r`; `/.../speed` stays as it is."""
    parts = name.split("/")
    return parts[-2] if len(parts) > 1 and parts[-1] == "value" else name
