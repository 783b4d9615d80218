"""The force plates of a C3D file in SI units."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from exo_pin.arrays import Array
from exo_pin.formats.c3d.content import C3dPlate
from exo_pin.formats.units import is_newton, metres_per, newton_metres_per
from exo_pin.gait.trial import ForcePlate, plate_damage


class FoundPlates(NamedTuple):
    """Force plates, and what is changed or left out, a sentence each."""

    plates: tuple[ForcePlate, ...]
    remarks: tuple[str, ...]


def force_plates(
    found: Iterable[C3dPlate], rate: float, start: float, length: float | None = None
) -> FoundPlates:
    """Force plates on the trial's time axis; those in unknown units are left out.

    Args:
        found: In the units of the file.
        rate: Samples per second.
        start: Time of the first sample [s].
        length: Metres per unit of length; None: as each plate states it.
    """
    plates, remarks = list[ForcePlate](), list[str]()
    for k, plate in enumerate(found if rate > 0 else (), 1):
        newton, torque, unit = plate.units
        metres, turning = length or metres_per(unit), newton_metres_per(torque)
        if not is_newton(newton) or turning is None or metres is None:
            units = ", ".join(ascii(text[:12]) for text in plate.units)
            remarks.append(f"force plate {k} is in {units} and left out; N, Nmm, mm are read")
            continue
        point, moment = plate.point * metres, plate.moment * turning
        damage = plate_damage(plate.force, point)
        if damage:
            remarks.append(f"force plate {k} has {damage} and is left out: damaged?")
            continue
        time: Array = start + np.arange(len(plate.force)) / rate
        plates.append(ForcePlate(f"force plate {k}", time, plate.force, point, moment))
    return FoundPlates(tuple(plates), tuple(remarks))
