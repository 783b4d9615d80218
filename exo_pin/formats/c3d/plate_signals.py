"""Force plates of a C3D file from their analog signals: force, centre of pressure and free moment.

The types are those of the C3D user guide (Motion Lab Systems, FORCE_PLATFORM:TYPE): 1 measures force, centre
of pressure and free moment, 2 force and moment, 3 eight forces of piezoelectric sensors, 4 is 2 with a
calibration matrix. Each measures in its own axes, which its corners define.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from exo_pin.arrays import Array
from exo_pin.formats.c3d.content import C3dPlate
from exo_pin.formats.c3d.parameters import C3dParameters

_CHANNELS = {1: 6, 2: 6, 3: 8, 4: 6}
"""Type of plate -> its analog channels."""

_MOST_PLATES = 64


class FoundSignals(NamedTuple):
    """Plates in the units of the file, and what is left out of them, a sentence each."""

    plates: tuple[C3dPlate, ...]
    remarks: tuple[str, ...]


class _Geometry(NamedTuple):
    """Of one plate: how it measures and where.

    Attributes:
        kind: Its type.
        origin: `(3,)` of the sensors, in the plate's axes.
        axes: `(3, 3)` the plate's axes in the laboratory.
        centre: `(3,)` of its surface, in the laboratory.
        calibration: `(6, 6)` matrix.
    """

    kind: int
    origin: Array
    axes: Array
    centre: Array
    calibration: Array


def plates_of(parameters: C3dParameters, signals: Array) -> FoundSignals:
    """The force plates of a file.

    Args:
        parameters: Of the file.
        signals: `(c, m)` the analog signals of FORCE_PLATFORM:CHANNEL, plate after plate.
    """
    channel = parameters.numbers.get("FORCE_PLATFORM:CHANNEL", np.zeros((0, 0)))
    channel = channel.reshape(len(channel), channel.size // max(len(channel), 1))
    used = min(int(parameters.number("FORCE_PLATFORM:USED") or 0), channel.shape[1], _MOST_PLATES)
    force, length = parameters.text("FORCE_PLATFORM:UNITS") or "N", parameters.text("POINT:UNITS") or "m"
    units = (force, f"{force}{length}", length)
    plates, remarks = list[C3dPlate](), list[str]()
    for k in range(used):
        geometry = _geometry(parameters, k)
        rows = signals[k * len(channel) : (k + 1) * len(channel)]
        if geometry is None or len(rows) < _CHANNELS[geometry.kind] or not rows.size:
            kind = _at(parameters, "TYPE", k)
            stated = f"of type {kind[0]:g}" if kind.size else "without a type"
            remarks.append(
                f"force plate {k + 1} ({stated}) is left out: its geometry or signals are not read"
            )
            continue
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            plates.append(C3dPlate(*_loads(geometry, rows[: _CHANNELS[geometry.kind]]), units))
    return FoundSignals(tuple(plates), tuple(remarks))


def _geometry(parameters: C3dParameters, k: int) -> _Geometry | None:
    """Of plate k; None where it is not stated, or of another type."""
    kind, corners, origin = (_at(parameters, name, k) for name in ("TYPE", "CORNERS", "ORIGIN"))
    known = int(kind[0]) if kind.size and np.isfinite(kind[0]) else 0
    if known not in _CHANNELS or corners.shape != (3, 4) or origin.shape != (3,):
        return None
    calibration = _at(parameters, "CAL_MATRIX", k)
    if known == 4 and calibration.size and calibration.shape != (6, 6):
        return None
    x, y = corners[:, 0] - corners[:, 1], corners[:, 0] - corners[:, 3]
    z = np.cross(x, y)
    axes = np.stack([_unit(x), _unit(np.cross(z, x)), _unit(z)], axis=1)
    if not np.isfinite(axes).all():
        return None
    origin = -origin if origin[2] > 0 else origin  # seen from the sensors
    square = calibration if known == 4 and calibration.size else np.eye(6)
    return _Geometry(known, origin, axes, corners.mean(axis=1), square)


def _at(parameters: C3dParameters, name: str, k: int) -> Array:
    """The part of a parameter that belongs to plate k: the last dimension counts the plates."""
    values = parameters.numbers.get(f"FORCE_PLATFORM:{name}", np.zeros(0))
    if name == "TYPE":
        return np.asarray(values.ravel()[k : k + 1])
    wanted = {"CORNERS": (3, 4), "ORIGIN": (3,), "CAL_MATRIX": (6, 6)}[name]
    size = int(np.prod(wanted))
    flat = values.ravel(order="F")[k * size : (k + 1) * size]
    return np.asarray(flat.reshape(wanted, order="F") if flat.size == size else np.zeros(0))


def _unit(vector: Array) -> Array:
    length = float(np.linalg.norm(vector))
    return np.asarray(vector / length if length > 0 else np.full(3, np.nan))


def _loads(plate: _Geometry, rows: Array) -> tuple[Array, Array, Array]:
    """`(m, 3)` force, centre of pressure and free moment in the laboratory."""
    if plate.kind == 1:
        force, point, moment = rows[:3].T, rows[3:].T.copy(), rows[3:].T.copy()
        point[:, 2], moment[:, :2] = 0.0, 0.0
    else:
        force, moment = _sensors(plate, rows)
        point = np.stack([-moment[:, 1], moment[:, 0], np.zeros(len(force))], axis=1) / force[:, 2:]
        point[:, 2] = np.where(force[:, 2] == 0, np.nan, 0.0)
        moment = moment + np.cross(force, point)
    return force @ plate.axes.T, point @ plate.axes.T + plate.centre, moment @ plate.axes.T


def _sensors(plate: _Geometry, rows: Array) -> tuple[Array, Array]:
    """`(m, 3)` force, and moment about the middle of the surface, in the plate's axes."""
    if plate.kind == 3:
        x12, x34, y14, y23, z1, z2, z3, z4 = rows
        force = np.stack([x12 + x34, y14 + y23, z1 + z2 + z3 + z4], axis=1)
        a, b = plate.origin[:2]
        turning = [b * (z1 + z2 - z3 - z4), a * (z2 + z3 - z1 - z4), b * (x34 - x12) + a * (y14 - y23)]
        return force, np.stack(turning, axis=1) + np.cross(force, plate.origin * [0, 0, 1])
    six = (plate.calibration @ rows).T
    return six[:, :3], six[:, 3:] + np.cross(six[:, :3], plate.origin)
