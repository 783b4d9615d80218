"""OpenSim coordinates (.mot, .sto) as a gait: names, signs, degrees, and the moving pelvis."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from exo_pin.anatomy import JOINTS, SIDES
from exo_pin.arrays import Array
from exo_pin.errors import FormatError, UnknownNameError
from exo_pin.formats.opensim.convention import Convention, by_habit, by_model, habit_of, hip_angles
from exo_pin.formats.opensim.pelvis_axes import from_opensim, to_opensim
from exo_pin.formats.opensim.storage import Storage, read_storage, write_storage
from exo_pin.formats.presets import OPENSIM, PRESETS, Preset, inferred, preset
from exo_pin.formats.reading import UNITS, Reading
from exo_pin.formats.tables.notes import Notes, read, to_gait, to_lines
from exo_pin.formats.tables.numeric_table import NumericTable
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

COLUMNS = dict(zip(JOINTS, LEGS, strict=True))

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

    A model (`reading.model`, an .osim file) tells the axes and signs of pelvis and legs and where the hips
    are. Without one the pelvis turns in OpenSim's usual order (or `reading.pelvis_order`), the base's origin
    is put midway between the hips with the *generic* model's offset (gait2392: (-0.0707, -0.0661, 0) m in the
    pelvis), and the knee's sign comes from the preset, if one is named, else from our own header line, else
    from the angles where at least 90 % of the excursion lies on one side; `source` tells all that. OpenSim's
    axes (x forward, y up, z right) become ours. Toes, trunk and arms are left out.

    Raises:
        FormatError: With file, line and reason: forces, velocities, missing coordinates, no `inDegrees`,
            or a knee whose sign is not clear.
        UnknownNameError: There is no such preset.
    """
    chosen = None if reading.preset is None else preset(reading.preset, OPENSIM)
    storage = read_storage(path, gaps=True)
    degrees = _in_degrees(storage, reading.units)
    means = _means(reading).holding(_held(path, reading.mapping, degrees))
    table = _coordinates(storage, means)
    time = table.times(TIME)
    values, held = _values(table, means, degrees)
    chosen, how = (chosen, "as told") if chosen else _sign(storage, values, means)
    base = None
    if set(means.pelvis) & set(table.names) and chosen.mid_hip is not None:
        base = from_opensim(means.chain, values, means.mid_hip or chosen.mid_hip)
    notes = read(path, storage.notes)
    if notes.source is None:
        sign = "positive" if chosen.knee > 0 else "negative"
        said = [f"{path.name}, read as {chosen.name}: knee {sign} in flexion ({how})"]
        said += [means.said] if base is not None or reading.model else []
        said += [f"not in the file, so held: {', '.join(held)}"] if held else []
        notes = notes._replace(source="; ".join(said))
    return to_gait(path, time, _legs(values, chosen, means), base, notes)


def preset_of(path: Path, *, model: Path | None = None) -> str:
    """The preset whose signs a file of coordinates has, as `read_gait` finds it; errors as there."""
    storage, means = read_storage(path), _means(Reading(model=model))
    values, _ = _values(_coordinates(storage, means), means, _in_degrees(storage))
    return _sign(storage, values, means)[0].name


def _means(reading: Reading) -> Convention:
    if reading.model is None:
        return by_habit(reading.pelvis_order)
    return by_model(reading.model, COLUMNS)


def _legs(values: Mapping[str, Array], chosen: Preset, means: Convention) -> Array:
    """`(n, 12)` angles [rad] with our signs."""
    q = np.column_stack([values[name] for name in LEGS])
    q *= [chosen.knee if c in KNEES else means.signs.get(name, 1) for name, c in COLUMNS.items()]
    for side, hip in means.hips.items():
        k = JOINTS.index(f"{side}_hip_flexion")
        q[:, k : k + 3] = hip_angles(hip, side, values)
    return q


def write_gait(gait: Gait, path: Path, *, habit: Preset = WRITTEN) -> None:
    """Write coordinates in degrees, with events and source in header comments.

    The knee's sign and the mid-hip's place in the pelvis are the habit's: Rajagopal's (knee positive in
    flexion), or another of `presets.OPENSIM` for a model of that family.
    """
    names, parts = [TIME], [gait.time[:, None]]
    if gait.base is not None:
        angles, translation = to_opensim(gait.base, habit.mid_hip or MID_HIP)
        names += [*ANGLES, *TRANSLATIONS]
        parts += [np.degrees(angles), translation]
    sign = "positive" if habit.knee > 0 else "negative"
    remarks = [
        f"Written by exo_pin: angles in degrees, translations in metres; knee_angle is {sign} in flexion.",
        f"# preset: {habit.name}",
        *to_lines(Notes(gait.events, gait.periodic, gait.source)),
    ]
    turned = [habit.knee if name in KNEES else 1 for name in LEGS]
    values = np.hstack([*parts, np.degrees(gait.q) * turned])
    write_storage(path, "Coordinates", remarks, [*names, *LEGS], values, degrees=True)


def _coordinates(storage: Storage, means: Convention) -> NumericTable:
    """The table with plain coordinate names; refuses what holds no coordinates."""
    table, path = storage.table, storage.table.path
    line = table.lines[0] - 1
    if storage.title.lower() in DERIVATIVES:
        raise FormatError(
            path, f"titled {storage.title[:40]!r}; expected coordinates, not their derivatives", line=1
        )
    names = tuple(_plain(name) for name in table.names)
    times = Counter(names)
    twice = [name for name in (TIME, *LEGS, *means.pelvis) if times[name] > 1]
    if twice:
        raise FormatError(path, f"coordinate {twice[0]!r} occurs more than once", line=line)
    gone = [name for name in (TIME, *LEGS) if name not in times and name not in means.defaults]
    if gone and any(re.search(r"force|moment|torque", name, re.IGNORECASE) for name in names):
        raise FormatError(
            path, "holds forces or moments; expected joint coordinates (inverse kinematics)", line=line
        )
    pelvis = [name for name in means.pelvis if name not in times and name not in means.defaults]
    if gone or 0 < len(pelvis) < len(means.pelvis):
        joints = ",".join(name for name, column in COLUMNS.items() if column in gone)
        hint = (
            f"; a model (.osim) may do without, a mapping holds joints at a number: 0={joints}"
            if joints
            else ""
        )
        raise FormatError(path, f"missing coordinates: {', '.join(gone or pelvis)}{hint}", line=line)
    return NumericTable(path, names, table.values, table.lines)


def _values(table: NumericTable, means: Convention, degrees: bool) -> tuple[dict[str, Array], list[str]]:
    """Coordinates of legs and pelvis `(n,)` [rad, m], and which of them the model's defaults gave."""
    wanted = list(dict.fromkeys([*LEGS, *means.pelvis]))
    there = [name for name in wanted if name in table.names]
    slides = [name for name in there if name not in (*LEGS, *means.turning)]
    turning = [name for name in there if name not in slides]
    if not set(means.pelvis) & set(there):
        wanted = list(LEGS)
    table.refuse(np.isnan(table.columns(there)), there, "expected a finite number")
    table.angles([name for name in turning if name in LEGS], degrees=degrees)  # refuses what is absurd
    values = dict(zip(turning, table.columns(turning).T * (np.pi / 180 if degrees else 1.0), strict=True))
    values |= dict(zip(slides, table.columns(slides).T, strict=True))
    held = [name for name in wanted if name not in values]
    n = len(table.values)
    return values | {name: np.full(n, means.defaults.get(name, 0.0)) for name in held}, held


def _held(path: Path, mapping: Mapping[str, str], degrees: bool) -> dict[str, float]:
    """Coordinates that the user holds at a number [rad]; other names need no mapping here."""
    held = {}
    for key, names in mapping.items():
        for name in names.split(","):
            if name.strip() not in COLUMNS:
                raise UnknownNameError("joint", name.strip(), JOINTS)
            try:
                held[COLUMNS[name.strip()]] = float(key) * (np.pi / 180 if degrees else 1.0)
            except ValueError:
                why = f"mapping {key[:40]!r}: only a number, which holds a joint, is mapped here"
                raise FormatError(path, why) from None
    return held


def _plain(name: str) -> str:
    """`/jointset/hip_r/hip_flexion_r/value` -> `hip_flexion_r`; `/.../speed` stays as it is."""
    parts = name.split("/")
    return parts[-2] if len(parts) > 1 and parts[-1] == "value" else name


def _in_degrees(storage: Storage, told: str | None = None) -> bool:
    """Whether angles are in degrees, by the header, or as told where it does not say."""
    path, said = storage.table.path, storage.keys.get("indegrees")
    if said is None and told in UNITS:
        return told == "deg"
    if said is None or said.lower() not in ("yes", "no"):
        found = "no inDegrees" if said is None else f"inDegrees={said[:20]!r}"
        why = f"{found} in the header; expected inDegrees=yes or inDegrees=no"
        raise FormatError(path, f"{why}, or that you give the units (deg or rad)")
    if told and (told == "deg") != (said.lower() == "yes"):
        raise FormatError(path, f"units are given as {told}, but the header has inDegrees={said}")
    return said.lower() == "yes"


def _sign(storage: Storage, values: Mapping[str, Array], means: Convention) -> tuple[Preset, str]:
    """Whose signs the file has, and how that is known."""
    told = {means.signs.get(name, 0) for name, column in COLUMNS.items() if column in KNEES}
    if told in ({1}, {-1}):
        return PRESETS[habit_of(told.pop())], "so its model"
    for note in storage.notes:
        if note.key == "preset" and note.value in OPENSIM:
            return PRESETS[note.value], "its header says so"
    found = inferred(np.column_stack([values[knee] for knee in KNEES]))
    if found is None:
        raise FormatError(
            storage.table.path,
            "the sign of the knee is not clear: knee_angle_l and _r bend less than 15 degrees (radians "
            "in a file of degrees?) or lie on both sides of 0; name the model with a preset "
            f"({', '.join(OPENSIM)}) or give its .osim file",
        )
    return found[0], f"inferred: {100 * found[1]:.0f} % of its excursion"
