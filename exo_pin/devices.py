"""Devices as data: which joints an exoskeleton drives, and what its actuators can do."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

from exo_pin.anatomy.names import JOINTS
from exo_pin.errors import UnknownNameError


class Actuator(NamedTuple):
    """Largest torque [N m] and speed [rad/s] at a joint."""

    effort: float
    velocity: float


@dataclass(frozen=True)
class Device:
    """One exoskeleton.

    Attributes:
        name: What `load_robot(device=...)` calls it.
        joints: The joints that move, names of `JOINTS`.
        actuators: By movement, the same left and right.
        source: Where the numbers come from.
    """

    name: str
    joints: tuple[str, ...]
    actuators: Mapping[str, Actuator]
    source: str


EXO12 = Device(
    name="exo12",
    joints=JOINTS,
    actuators={
        "hip_flexion": Actuator(150.0, 8.0),
        "hip_adduction": Actuator(120.0, 5.0),
        "hip_rotation": Actuator(60.0, 5.0),
        "knee_flexion": Actuator(150.0, 12.0),
        "ankle_dorsiflexion": Actuator(180.0, 8.0),
        "ankle_inversion": Actuator(60.0, 5.0),
    },
    source="Degrees of freedom: Chen, Zhang and Zhu. Torques and speeds: a design choice, above what a "
    "70 kg person's level walking at any of Schwartz's (2008) speeds needs; the paper gives none.",
)

DEVICES: Mapping[str, Device] = {device.name: device for device in (EXO12,)}
"""Every device by name."""


def find(name: str) -> Device:
    """The device of that name.

    Raises:
        UnknownNameError: There is none.
    """
    if name not in DEVICES:
        raise UnknownNameError("device", name, DEVICES)
    return DEVICES[name]
