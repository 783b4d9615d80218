"""OpenSim coordinates (.mot, .sto) as a gait: names, signs, degrees, and the moving pelvis."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.errors import FormatError
from exo_pin.formats.notes import Notes, read, to_gait, to_lines
from exo_pin.formats.pelvis import from_opensim, to_opensim
from exo_pin.formats.presets import OPENSIM, PRESETS, Preset, inferred, preset
from exo_pin.formats.reading import Reading
from exo_pin.formats.storage import Storage, read_storage, write_storage
from exo_pin.formats.table import Array, Table
from exo_pin.gait import Gait

TIME = "time"
COORDINATES = {
    "hip_flexion": "hip_flexion",
    "hip_adduction": "hip_adduction",
    "hip_rotation": "hip_rotation",
    "knee_flexion": "knee_angle",
    "ankle_dorsiflexion": "ankle_angle",
    "ankle_inversion": "subtalar_angle",
}
"""Movement -> OpenSim's name without `_r` or `_l`; all signs but the knee's are ours."""

LEGS = tuple(f"{name}_{side[0]}" for side in SIDES for name in COORDINATES.values())
"""OpenSim's names in the order of `JOINTS`."""

KNEES = ("knee_angle_l", "knee_angle_r")
ANGLES = ("pelvis_tilt", "pelvis_list", "pelvis_rotation")
DERIVATIVES = ("speeds", "velocities", "accelerations")
"""Titles of OpenSim's files with the same column names but other contents."""

TRANSLATIONS = ("pelvis_tx", "pelvis_ty", "pelvis_tz")
WRITTEN = PRESETS["opensim-rajagopal"]
"""Our own files have the knee positive in flexion."""

MID_HIP = WRITTEN.mid_hip or (0.0, 0.0, 0.0)


def read_gait(path: Path, reading: Reading) -> Gait:
    """Read joint coordinates; the pelvis's motion, if there, becomes the base.

    The knee's sign comes from the preset, if one is named, else from our own header line, else from the
    angles where at least 90 % of the excursion lies on one side; `source` then tells so. OpenSim's axes (x
    forward, y up, z right) become ours, and the base's origin is put midway between the hips with the
    *generic* model's offset (gait2392: (-0.0707, -0.0661, 0) m in the pelvis). Toes, trunk and arms are left
    out.

    Raises:
        FormatError: With file, line and reason: forces, velocities, missing coordinates, no `inDegrees`,
            or a knee whose sign is not clear.
        UnknownNameError: There is no such preset.
    """
    reading.refuse(path, "mapping", "units", why="its names and its header tell")
    chosen = None if reading.preset is None else preset(reading.preset, OPENSIM)
    storage = read_storage(path)
    table = _coordinates(storage)
    time, degrees = table.times(TIME), _in_degrees(storage)
    q = table.angles(LEGS, degrees=degrees)
    notes = read(path, storage.notes)
    chosen, how = (chosen, "as told") if chosen else _sign(storage, table, degrees)
    q[:, [LEGS.index(knee) for knee in KNEES]] *= chosen.knee
    if notes.source is None:
        sign = "positive" if chosen.knee > 0 else "negative"
        notes = notes._replace(source=f"{path.name}, read as {chosen.name}: knee {sign} in flexion ({how})")
    return to_gait(path, time, q, _base(table, degrees, chosen), notes)


def preset_of(path: Path) -> str:
    """The preset whose signs a file of coordinates has, as `read_gait` finds it; errors as there."""
    storage = read_storage(path)
    return _sign(storage, _coordinates(storage), _in_degrees(storage))[0].name


def write_gait(gait: Gait, path: Path) -> None:
    """Write coordinates in degrees, knee positive in flexion, with events and source in header comments."""
    names, parts = [TIME], [gait.time[:, None]]
    if gait.base is not None:
        angles, translation = to_opensim(gait.base, MID_HIP)
        names += [*ANGLES, *TRANSLATIONS]
        parts += [np.degrees(angles), translation]
    remarks = [
        "Written by exo_pin: angles in degrees, translations in metres; knee_angle is positive in flexion.",
        f"# preset: {WRITTEN.name}",
        *to_lines(Notes(gait.events, gait.periodic, gait.source)),
    ]
    values = np.hstack([*parts, np.degrees(gait.q)])
    write_storage(path, "Coordinates", remarks, [*names, *LEGS], values, degrees=True)


def _coordinates(storage: Storage) -> Table:
    """The table with plain coordinate names; refuses what holds no coordinates."""
    table, path = storage.table, storage.table.path
    line = table.lines[0] - 1
    if storage.title.lower() in DERIVATIVES:
        raise FormatError(
            path, f"titled {storage.title[:40]!r}; expected coordinates, not their derivatives", line=1
        )
    names = tuple(_plain(name) for name in table.names)
    times = Counter(names)
    twice = [name for name in (TIME, *LEGS, *ANGLES, *TRANSLATIONS) if times[name] > 1]
    if twice:
        raise FormatError(path, f"coordinate {twice[0]!r} occurs more than once", line=line)
    gone = [name for name in (TIME, *LEGS) if name not in times]
    if gone and any(re.search(r"force|moment|torque", name, re.IGNORECASE) for name in names):
        raise FormatError(
            path, "holds forces or moments; expected joint coordinates (inverse kinematics)", line=line
        )
    pelvis = [name for name in (*ANGLES, *TRANSLATIONS) if name not in times]
    if gone or 0 < len(pelvis) < 6:
        raise FormatError(path, f"missing coordinates: {', '.join(gone or pelvis)}", line=line)
    return Table(path, names, table.values, table.lines)


def _plain(name: str) -> str:
    """`/jointset/hip_r/hip_flexion_r/value` -> `hip_flexion_r`; `/.../speed` stays as it is."""
    parts = name.split("/")
    return parts[-2] if len(parts) > 1 and parts[-1] == "value" else name


def _in_degrees(storage: Storage) -> bool:
    said = storage.keys.get("indegrees")
    if said is None or said.lower() not in ("yes", "no"):
        found = "no inDegrees" if said is None else f"inDegrees={said[:20]!r}"
        raise FormatError(
            storage.table.path, f"{found} in the header; expected inDegrees=yes or inDegrees=no"
        )
    return said.lower() == "yes"


def _sign(storage: Storage, table: Table, degrees: bool) -> tuple[Preset, str]:
    """Whose signs the file has, and how that is known."""
    for note in storage.notes:
        if note.key == "preset" and note.value in OPENSIM:
            return PRESETS[note.value], "its header says so"
    found = inferred(table.angles(KNEES, degrees=degrees))
    if found is None:
        raise FormatError(
            table.path,
            "the sign of the knee is not clear: knee_angle_l and _r bend less than 15 degrees or lie on both "
            f"sides of 0; name the model with a preset: {', '.join(OPENSIM)}",
        )
    return found[0], f"inferred: {100 * found[1]:.0f} % of its excursion"


def _base(table: Table, degrees: bool, chosen: Preset) -> Array | None:
    if ANGLES[0] not in table.names or chosen.mid_hip is None:
        return None
    angles = table.columns(ANGLES)
    angles = np.radians(angles) if degrees else angles
    return from_opensim(angles, table.columns(TRANSLATIONS), chosen.mid_hip)
