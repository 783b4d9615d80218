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
from exo_pin.formats.opensim.convention import Convention, default_convention, hip_angles, model_convention
from exo_pin.formats.opensim.coordinate_names import COORDINATE_OF, KNEES, LEG_COORDINATES
from exo_pin.formats.opensim.coordinate_table import TIME_COLUMN, coordinate_table
from exo_pin.formats.opensim.pelvis_axes import from_opensim
from exo_pin.formats.opensim.storage import Storage
from exo_pin.formats.read_options import ReadOptions
from exo_pin.formats.sign_presets import OPENSIM_PRESETS, Preset, find_preset, inferred_preset, preset_of_knee
from exo_pin.formats.tables.metadata import read_metadata, to_gait
from exo_pin.formats.units import ANGLE_UNITS, RADIANS_PER
from exo_pin.gait import Gait


@dataclass(frozen=True, eq=False)
class _Coordinates:
    """The coordinates of legs and pelvis.

    Attributes:
        time: `(n,)` [s].
        values: Coordinate -> `(n,)` [rad, m].
        held: Those that the file does not have.
        has_pelvis: Whether it has any of the pelvis.
    """

    time: Array
    values: dict[str, Array]
    held: list[str]
    has_pelvis: bool


def coordinates_gait(storage: Storage, options: ReadOptions) -> Gait:
    """The walk of joint coordinates; the pelvis's motion, if there, becomes the base.

    A model (`options.model`, an .osim file) has the axes and signs of pelvis and legs and the hip centres.
    Without one the pelvis rotates in OpenSim's usual order (or `options.pelvis_order`), the base's origin is
    put midway between the hips with the *generic* model's offset (gait2392: (-0.0707, -0.0661, 0) m in the
    pelvis), and the knee's sign comes from the preset, if one is named, else from our own header line, else
    from the angles where at least 90 % of the excursion lies on one side; `source` states all that. OpenSim's
    axes (x forward, y up, z right) become this package's. Toes, trunk and arms are left out.

    Args:
        storage: The file.
        options: Preset, units, model, order of the pelvis's rotations; the mapping holds joints at numbers.

    Raises:
        FormatError: With file, line and reason: forces, velocities, missing coordinates, no `inDegrees`,
            or a knee whose sign is not clear.
        UnknownNameError: There is no such preset.
    """
    path = storage.table.path
    chosen = None if options.preset is None else find_preset(options.preset, OPENSIM_PRESETS)
    degrees = _in_degrees(storage, options.units)
    convention = _convention(options.model, options.pelvis_order)
    convention = convention.with_defaults(_held_by_user(path, options.mapping, degrees))
    found = _coordinates(storage, convention, degrees)
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
    return to_gait(path, found.time, _leg_angles(found.values, chosen, convention), base, metadata)


def knee_preset(storage: Storage, model: Path | None = None) -> SignPreset:
    """The preset whose signs a file of coordinates has, as `coordinates_gait` finds it; errors as there."""
    convention = _convention(model, None)
    found = _coordinates(storage, convention, _in_degrees(storage, None))
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


def _coordinates(storage: Storage, convention: Convention, degrees: bool) -> _Coordinates:
    """Coordinates of legs and pelvis, those that are not in the file at the convention's defaults."""
    table = coordinate_table(storage, convention)
    time = table.times(TIME_COLUMN)
    wanted = list(dict.fromkeys([*LEG_COORDINATES, *convention.pelvis]))
    present = [name for name in wanted if name in table.names]
    lengths = [name for name in present if name not in (*LEG_COORDINATES, *convention.pelvis_angles)]
    angles = [name for name in present if name not in lengths]
    has_pelvis = bool(set(convention.pelvis) & set(present))
    table.refuse(np.isnan(table.columns(present)), present, "expected a finite number")
    # refuses what is absurd
    table.angles([name for name in angles if name in LEG_COORDINATES], degrees=degrees)
    values = dict(zip(angles, table.columns(angles).T * (np.pi / 180 if degrees else 1.0), strict=True))
    values |= dict(zip(lengths, table.columns(lengths).T, strict=True))
    held = [name for name in (wanted if has_pelvis else LEG_COORDINATES) if name not in values]
    values |= {name: np.full(len(time), convention.defaults.get(name, 0.0)) for name in held}
    return _Coordinates(time, values, held, has_pelvis)


def _held_by_user(path: Path, mapping: Mapping[str, str], degrees: bool) -> dict[str, float]:
    """Coordinates that the user holds at a number [rad]; other names need no mapping here."""
    held = {}
    for key, names in mapping.items():
        for name in names.split(","):
            if name.strip() not in COORDINATE_OF:
                raise UnknownNameError("joint", name.strip(), JOINTS)
            try:
                held[COORDINATE_OF[name.strip()]] = float(key) * RADIANS_PER["deg" if degrees else "rad"]
            except ValueError:
                why = f"mapping {key[:40]!r}: only a number, which holds a joint, is mapped here"
                raise FormatError(path, why) from None
    return held


def _in_degrees(storage: Storage, chosen: str | None) -> bool:
    """Whether angles are in degrees, by the header, or as the user chose where it does not state it."""
    path, stated = storage.table.path, storage.keys.get("indegrees")
    if stated is None and chosen in ANGLE_UNITS:
        return chosen == "deg"
    if stated is None or stated.lower() not in ("yes", "no"):
        found = "no inDegrees" if stated is None else f"inDegrees={stated[:20]!r}"
        why = f"{found} in the header; expected inDegrees=yes or inDegrees=no"
        raise FormatError(path, f"{why}, or that you give the units (deg or rad)")
    if chosen and (chosen == "deg") != (stated.lower() == "yes"):
        raise FormatError(path, f"units are given as {chosen}, but the header has inDegrees={stated}")
    return stated.lower() == "yes"


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
