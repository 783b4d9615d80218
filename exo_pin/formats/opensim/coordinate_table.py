"""The table of a file of OpenSim coordinates, under plain names; which coordinates it may lack."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable

from exo_pin.errors import FormatError
from exo_pin.formats.opensim.coordinate_names import COORDINATE_OF, LEG_COORDINATES
from exo_pin.formats.opensim.storage import Storage
from exo_pin.formats.tables.numeric_table import NumericTable

TIME_COLUMN = "time"

NEEDED = tuple(
    name for name in LEG_COORDINATES if name.startswith(("hip_flexion", "knee_angle", "ankle_angle"))
)
"""Coordinates without which there is no walk; models lock or lack the others (subtalar joint, planar hip)."""

_USUAL = {*LEG_COORDINATES, *(f"pelvis_{part}" for part in ("tilt", "list", "rotation", "tx", "ty", "tz"))}
"""Names that programs write in capitals too."""

_DERIVATIVES = ("speeds", "velocities", "accelerations")
"""Titles of OpenSim's files with the same column names but other contents."""

_SHOWN = 6
"""Column names in a message."""


def coordinate_table(storage: Storage) -> NumericTable:
    """The table with plain coordinate names.

    Raises:
        FormatError: It holds no coordinates.
    """
    table, path = storage.table, storage.table.path
    if storage.title.lower() in _DERIVATIVES:
        raise FormatError(
            path, f"titled {storage.title[:40]!r}; expected coordinates, not their derivatives", line=1
        )
    names = tuple(plain_name(name) for name in table.names)
    plain = NumericTable(path, names, table.values, table.lines)
    if not set(LEG_COORDINATES) & set(names):
        raise FormatError(path, _instead(table.names), line=table.lines[0] - 1)
    return plain


def check_complete(table: NumericTable, given: Collection[str], used: Iterable[str]) -> None:
    """Check that a walk can be made.

    Args:
        table: With plain names.
        given: Coordinates that the user holds at a number.
        used: Coordinates that are read; each may occur once.

    Raises:
        FormatError: A needed coordinate misses, or one that is used occurs twice.
    """
    absent = [name for name in (TIME_COLUMN, *NEEDED) if name not in table.names and name not in given]
    if absent:
        joints = ",".join(name for name, column in COORDINATE_OF.items() if column in absent)
        hint = f"; a mapping holds joints at a number: 0={joints}" if joints else ""
        why = f"missing coordinates: {', '.join(absent)}{hint}"
        raise FormatError(table.path, why, line=table.lines[0] - 1)
    table.refuse_repeated((TIME_COLUMN, *used))


def _instead(names: tuple[str, ...]) -> str:
    """What a table without joint coordinates holds."""
    if any(re.search(r"force|moment|torque", name, re.IGNORECASE) and "/" not in name for name in names):
        return (
            "holds forces or moments; expected joint coordinates (inverse kinematics); such a file goes "
            "beside a walk, --forces FILE or --torques FILE"
        )
    shown = ", ".join(name[:40] for name in names[:_SHOWN]) + " ..." * (len(names) > _SHOWN)
    return f"missing coordinates: none of hip_flexion_r, knee_angle_r ... (columns: {shown})"


def is_time(name: str) -> bool:
    """Whether a column is named `time`, perhaps with a capital or its unit: `Time (s)`."""
    return bool(re.fullmatch(r"time\s*[\[(]?\s*(s|sec|seconds)?\s*[\])]?", name, re.IGNORECASE))


def plain_name(name: str) -> str:
    """`/jointset/hip_r/hip_flexion_r/value` -> `hip_flexion_r`, `Knee_Angle_R` -> `knee_angle_r`.

    Names that are not those of OpenSim's usual models stay as they are, `/.../speed` too.
    """
    if is_time(name):
        return TIME_COLUMN
    parts = name.split("/")
    name = parts[-2] if len(parts) > 1 and parts[-1].lower() == "value" else name
    return name.lower() if name.lower() in _USUAL else name
