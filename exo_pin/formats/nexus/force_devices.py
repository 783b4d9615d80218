"""Force plates of the section Devices of a Vicon Nexus export: force and centre of pressure over time."""

from __future__ import annotations

import numpy as np

from exo_pin.arrays import Array
from exo_pin.formats.c3d.plates import FoundPlates
from exo_pin.formats.nexus.free_moments import free_moments
from exo_pin.formats.nexus.sections import ExportedSection, Quantity
from exo_pin.formats.units import is_newton, metres_per, newton_metres_per
from exo_pin.gait.trial import ForcePlate, plate_damage

_LOADED = 20.0
"""Vertical force from which a plate is loaded [N]."""


def force_devices(section: ExportedSection) -> FoundPlates:
    """The force plates of a section: quantities with the axes Fx Fy Fz, Cx Cy Cz, Mx My Mz of one device.

    Nexus may export the force on the plate instead of that on the foot: where the plates are pressed upwards,
    the sign is turned. Without moments that agree with force and centre of pressure the free moment is 0.
    """
    per_frame = int(section.part.max()) + 1 if section.part.size else 1
    time = ((section.frame - 1) * per_frame + section.part) / section.rate
    plates, remarks = list[ForcePlate](), list[str]()
    for quantity in section.quantities:
        if not _axes(quantity, "F"):
            continue
        name = _device(quantity)
        parts = {letter: _part(section, name, letter) for letter in "CM"}
        force, point = np.nan_to_num(quantity.values[:, :3]), _metres(parts["C"])
        if point is None or not is_newton(quantity.units[0]):
            remarks.append(f"device {name[:60]} is left out: expected N and a centre of pressure in mm")
            continue
        if damage := plate_damage(force, point):
            remarks.append(f"device {name[:60]} has {damage} and is left out: damaged?")
            continue
        loaded = force[np.abs(force[:, 2]) > _LOADED, 2]
        sign = -1.0 if loaded.size and loaded.mean() < 0 else 1.0
        if sign < 0:
            remarks.append(f"device {name[:60]}: the file has the force on the plate; the sign is turned")
        moment, why = _free_moment(force, parts["M"], point)
        if why:
            remarks.append(f"device {name[:60]}: {why}: its free moments are taken as 0")
        plates.append(ForcePlate(name, time, sign * force, point, sign * moment))
    return FoundPlates(tuple(plates), tuple(remarks))


def _part(section: ExportedSection, device: str, letter: str) -> Quantity | None:
    """The quantity of that device with the axes of that letter."""
    found = (q for q in section.quantities if _axes(q, letter) and _device(q) == device)
    return next(found, None)


def _metres(point: Quantity | None) -> Array | None:
    """`(m, 3)` centre of pressure [m]; None without one."""
    metres = None if point is None else metres_per(point.units[0])
    return None if point is None or metres is None else np.asarray(metres * point.values[:, :3])


def _free_moment(force: Array, moment: Quantity | None, point: Array) -> tuple[Array, str]:
    """`(m, 3)` of the force in the file, and why it is not known; empty where it is."""
    nothing = np.zeros_like(force)
    if moment is None:
        return nothing, "no moments Mx, My, Mz"
    turning = newton_metres_per(moment.units[0])
    if turning is None:
        return nothing, f"moments in {moment.units[0][:12]!a}, not N.mm or N.m"
    free = free_moments(force, turning * moment.values[:, :3], point)
    if free is None:
        return nothing, "its moments do not agree with force and centre of pressure"
    return free, ""


def _axes(quantity: Quantity, letter: str) -> bool:
    axes = tuple(axis.lower() for axis in quantity.axes[:3])
    return axes == tuple(f"{letter.lower()}{axis}" for axis in "xyz")


def _device(quantity: Quantity) -> str:
    """`Force Plate 1 - Force` -> `Force Plate 1`."""
    return quantity.name.rpartition(" - ")[0] or quantity.name
