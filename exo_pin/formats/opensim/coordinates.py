"""OpenSim coordinates as a walk: names, signs, degrees, and the moving pelvis."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from exo_pin.anatomy import JOINTS
from exo_pin.anatomy.names import PelvisRotation, SignPreset
from exo_pin.arrays import Array
from exo_pin.errors import FormatError, UnknownNameError
from exo_pin.formats.opensim.angle_units import in_degrees
from exo_pin.formats.opensim.convention import Convention, default_convention, hip_angles, model_convention
from exo_pin.formats.opensim.coordinate_names import COORDINATE_OF, KNEES, LEG_COORDINATES
from exo_pin.formats.opensim.coordinate_table import TIME_COLUMN, check_complete, coordinate_table
from exo_pin.formats.opensim.pelvis_axes import from_opensim
from exo_pin.formats.opensim.storage import Storage
from exo_pin.formats.read_options import ReadOptions
from exo_pin.formats.sign_presets import OPENSIM_PRESETS, Preset, find_preset, inferred_preset, preset_of_knee
from exo_pin.formats.tables.metadata import read_metadata, to_gait
from exo_pin.formats.tables.numeric_table import NumericTable
from exo_pin.formats.units import RADIANS_PER
from exo_pin.gait import Gait
from exo_pin.gait.validation import FURTHEST


@dataclass(frozen=True, eq=False)
class _Coordinates:
    """The coordinates of legs and pelvis.

    Attributes:
        time: `(n,)` [s].
        values: Coordinate -> `(n,)` [rad, m].
        held: Those that the file does not have.
        has_pelvis: Whether it has any of the pelvis.
        remarks: What was held and left out, a sentence each.
    """

    time: Array
    values: dict[str, Array]
    held: list[str]
    has_pelvis: bool
    remarks: list[str]


def coordinates_gait(storage: Storage, options: ReadOptions) -> Gait:
    """The walk of joint coordinates; the pelvis's motion, if there, becomes the base.

    A model (`options.model`, an .osim file) has the axes and signs of pelvis and legs and the hip centres.
    Without one the pelvis rotates in OpenSim's usual order (or `options.pelvis_order`), the base's origin is
    put midway between the hips with the *generic* model's offset (gait2392: (-0.0707, -0.0661, 0) m in the
    pelvis), and the knee's sign comes from the preset, if one is named, else from our own header line, else
    from the angles where at least 90 % of the excursion lies on one side; `source` states all that. OpenSim's
    axes (x forward, y up, z right) become this package's. Toes, trunk and arms are left out. Hip adduction
    and rotation, ankle inversion and single pelvis coordinates that the file lacks are held at the model's
    default, else at zero, and `remarks` names them.

    Args:
        storage: The file.
        options: Preset, units, model, order of the pelvis's rotations; the mapping holds joints or the
            pelvis's coordinates at numbers.

    Raises:
        FormatError: With file, line and reason: forces, velocities, a missing flexion of hip, knee or ankle,
            units or a knee's sign that are not clear.
        UnknownNameError: There is no such preset.
    """
    path = storage.table.path
    chosen = None if options.preset is None else find_preset(options.preset, OPENSIM_PRESETS)
    convention = _convention(options.model, options.pelvis_order)
    found = _coordinates(storage, convention, options)
    chosen, how = (chosen, "as told") if chosen else _knee_preset(storage, found.values, convention)
    base = None
    if found.has_pelvis and chosen.mid_hip is not None:
        base = from_opensim(convention.chain, found.values, convention.mid_hip or chosen.mid_hip)
    metadata = read_metadata(path, storage.comments)
    if metadata.source is None:
        sign = "positive" if chosen.knee > 0 else "negative"
        source = [f"{path.name}, read as {chosen.name}: knee {sign} in flexion ({how})"]
        source += [convention.description] if base is not None or options.model else []
        source += [f"not in the file, so held: {', '.join(found.held)}"] if found.held else []
        metadata = metadata._replace(source="; ".join(source))
    metadata = metadata._replace(remarks=(*storage.remarks, *found.remarks))
    return to_gait(path, found.time, _leg_angles(found.values, chosen, convention), base, metadata)


def knee_preset(storage: Storage, model: Path | None = None) -> SignPreset:
    """The preset whose signs a file of coordinates has, as `coordinates_gait` finds it; errors as there."""
    convention = _convention(model, None)
    found = _coordinates(storage, convention, ReadOptions())
    return _knee_preset(storage, found.values, convention)[0].name


def _convention(model: Path | None, order: tuple[PelvisRotation, ...] | None) -> Convention:
    return default_convention(order) if model is None else model_convention(model)


def _leg_angles(values: Mapping[str, Array], chosen: Preset, convention: Convention) -> Array:
    """`(n, 12)` angles [rad] with this package's signs."""
    q = np.column_stack([values[name] for name in LEG_COORDINATES])
    q *= [chosen.knee if c in KNEES else convention.signs.get(name, 1) for name, c in COORDINATE_OF.items()]
    for side, hip in convention.hips.items():
        k = JOINTS.index(f"{side}_hip_flexion")
        q[:, k : k + 3] = hip_angles(hip, side, values)
    return q


def _coordinates(storage: Storage, convention: Convention, options: ReadOptions) -> _Coordinates:
    """Coordinates of legs and pelvis [rad, m]; those that are not in the file are held."""
    table = coordinate_table(storage)
    degrees, remarks = in_degrees(table, storage.keys, options.units)
    given = _held_by_user(table.path, options.mapping, convention, degrees)
    wanted = list(dict.fromkeys([*LEG_COORDINATES, *convention.pelvis]))
    check_complete(table, given, wanted)
    present = [name for name in wanted if name in table.names]
    table, doubled = table.once_each_time(TIME_COLUMN, present)
    remarks += doubled
    time = table.times(TIME_COLUMN)
    values = _present(table, present, convention, degrees)
    has_pelvis = bool(set(convention.pelvis) & {*present, *given})
    held = [name for name in (wanted if has_pelvis else LEG_COORDINATES) if name not in values]
    at = {name: given.get(name, convention.defaults.get(name, 0.0)) for name in held}
    values |= {name: np.full(len(time), value) for name, value in at.items()}
    remarks += _held_remarks(at, given, convention)
    return _Coordinates(time, values, held, has_pelvis, remarks)


def _present(
    table: NumericTable, names: list[str], convention: Convention, degrees: bool
) -> dict[str, Array]:
    """The file's coordinates [rad, m]."""
    table.refuse(~np.isfinite(table.columns(names)), names, "expected a finite number")
    legs = [name for name in names if name in LEG_COORDINATES]
    table.angles(legs, degrees=degrees)  # refuses what is absurd
    angles = {*legs, *convention.pelvis_angles}
    lengths = [name for name in names if name not in angles]
    far = np.abs(table.columns(lengths)) > FURTHEST
    table.refuse(far, lengths, f"more than {FURTHEST:g} m away; expected metres")
    scale = RADIANS_PER["deg" if degrees else "rad"]
    columns = zip(names, table.columns(names).T, strict=True)
    return {name: column * (scale if name in angles else 1.0) for name, column in columns}


def _held_remarks(at: Mapping[str, float], given: Mapping[str, float], convention: Convention) -> list[str]:
    """What is held, where and by whom, a sentence each."""
    lengths = {*convention.pelvis} - {*convention.pelvis_angles}
    said = {
        name: f"{name} at {value:g} m" if name in lengths else f"{name} at {np.degrees(value):g} deg"
        for name, value in at.items()
    }
    by_model = [name for name in at if name not in given and name in convention.defaults]
    groups = {
        "as mapped": [name for name in at if name in given],
        "the model's default": by_model,
        "the model lacks them" if convention.defaults else "no model is given": [
            name for name in at if name not in given and name not in by_model
        ],
    }
    return [
        f"not in the file, so held: {', '.join(said[name] for name in names)} ({why})"
        for why, names in groups.items()
        if names
    ]


def _held_by_user(
    path: Path, mapping: Mapping[str, str], convention: Convention, degrees: bool
) -> dict[str, float]:
    """Coordinates that the user holds at a number [rad, m]; other names need no mapping here."""
    known = COORDINATE_OF | {name: name for name in (*LEG_COORDINATES, *convention.pelvis)}
    lengths = {*convention.pelvis} - {*convention.pelvis_angles}
    held = {}
    for key, names in mapping.items():
        for name in map(str.strip, names.split(",")):
            if name not in known:
                raise UnknownNameError("joint", name, (*JOINTS, *convention.pelvis))
            try:
                number = float(key)
            except ValueError:
                why = f"mapping {key[:40]!r}: only a number, which holds a joint, is mapped here"
                raise FormatError(path, why) from None
            scale = 1.0 if known[name] in lengths else RADIANS_PER["deg" if degrees else "rad"]
            held[known[name]] = number * scale
    return held


def _knee_preset(storage: Storage, values: Mapping[str, Array], convention: Convention) -> tuple[Preset, str]:
    """Whose signs the file has, and how that is known."""
    by_model = {convention.signs.get(name, 0) for name, column in COORDINATE_OF.items() if column in KNEES}
    if by_model in ({1}, {-1}):
        return preset_of_knee(by_model.pop()), "so its model"
    for comment in storage.comments:
        if comment.key == "preset" and comment.value in OPENSIM_PRESETS:
            return find_preset(comment.value), "its header says so"
    found = inferred_preset(np.column_stack([values[knee] for knee in KNEES]))
    if found is None:
        raise FormatError(
            storage.table.path,
            "the sign of the knee is not clear: knee_angle_l and _r bend less than 15 degrees (radians "
            "in a file of degrees?) or lie on both sides of 0; name the model with a preset "
            f"({', '.join(OPENSIM_PRESETS)}) or give its .osim file",
        )
    return found[0], f"inferred: {100 * found[1]:.0f} % of its excursion"
