"""Force plates of the section Devices of a Vicon Nexus export: force and centre of pressure over time."""

from __future__ import annotations

import numpy as np

from exo_pin.formats.c3d.plates import FoundPlates
from exo_pin.formats.nexus.sections import ExportedSection, Quantity
from exo_pin.formats.units import is_newton, metres_per
from exo_pin.gait.trial import ForcePlate, plate_damage

_LOADED = 20.0
"""Vertical force from which a plate is loaded [N]."""


def force_devices(section: ExportedSection) -> FoundPlates:
    """The force plates of a section: pairs of quantities with the axes Fx Fy Fz and Cx Cy Cz of one device.

    Nexus may export the force on the plate instead of that on the foot: where the plates are pressed upwards,
    the sign is turned. Free moments are not in the export and are 0.
    """
    per_frame = int(section.part.max()) + 1 if section.part.size else 1
    time = ((section.frame - 1) * per_frame + section.part) / section.rate
    plates, remarks = list[ForcePlate](), list[str]()
    forces = [q for q in section.quantities if _axes(q, "F")]
    points = [q for q in section.quantities if _axes(q, "C")]
    for quantity in forces:
        name = _device(quantity)
        at = next((q for q in points if _device(q) == name), None)
        metres = None if at is None else metres_per(at.units[0])
        force = np.nan_to_num(quantity.values[:, :3])
        if at is None or metres is None or not is_newton(quantity.units[0]):
            remarks.append(f"device {name[:60]} is left out: expected N and a centre of pressure in mm")
            continue
        point = metres * at.values[:, :3]
        damage = plate_damage(force, point)
        if damage:
            remarks.append(f"device {name[:60]} has {damage} and is left out: damaged?")
            continue
        loaded = force[np.abs(force[:, 2]) > _LOADED, 2]
        if loaded.size and loaded.mean() < 0:
            force = -force
            remarks.append(f"device {name[:60]}: the file has the force on the plate; the sign is turned")
        plates.append(ForcePlate(name, time, force, point, np.zeros_like(force)))
    return FoundPlates(tuple(plates), tuple(remarks))


def _axes(quantity: Quantity, letter: str) -> bool:
    axes = tuple(axis.lower() for axis in quantity.axes[:3])
    return axes == tuple(f"{letter.lower()}{axis}" for axis in "xyz")


def _device(quantity: Quantity) -> str:
    """`Force Plate 1 - Force` -> `Force Plate 1`."""
    return quantity.name.rpartition(" - ")[0] or quantity.name
