"""The controllers by name, or from a file."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

import numpy as np

from exo_pin.anatomy import JOINTS
from exo_pin.arrays import Array
from exo_pin.control.assist_as_needed import AssistAsNeeded
from exo_pin.control.controller import Controller, Reference
from exo_pin.control.controller_file import load_controller
from exo_pin.control.servo import SOFT_DAMPING, SOFT_STIFFNESS, ComputedTorque, GravityServo, Servo
from exo_pin.control.stabiliser import FreeServo, Stabiliser
from exo_pin.errors import known_name, same_name
from exo_pin.plugins import plugin, plugin_names


class Off:
    """The motors are switched off."""

    def __call__(self, time: float, q: Array, dq: Array, reference: Reference) -> Array:
        """Zeros (12,)."""
        return np.zeros(len(JOINTS))


CONTROLLERS: Mapping[str, Callable[[], Controller]] = MappingProxyType(
    {
        "pd": Servo,
        "pd_free": FreeServo,
        "pd_stabilised": Stabiliser,
        "pd_only": lambda: Servo(feed_forward=False),
        "pd_gravity": GravityServo,
        "computed_torque": ComputedTorque,
        "impedance": lambda: Servo(SOFT_STIFFNESS, SOFT_DAMPING, feed_forward=False),
        "impedance_ff": lambda: Servo(SOFT_STIFFNESS, SOFT_DAMPING),
        "assist_as_needed": AssistAsNeeded,
        "off": Off,
    }
)
"""Name -> a new controller: a stiff servo plus what the person does not give, the same with the ankles of a
free pelvis, with a stabiliser of its balance, the servo alone, the servo plus
the weight of the legs, computed torque, soft without and with feed-forward, assistance as needed, none."""


def find_controller(controller: str | Controller) -> tuple[str, Controller]:
    """Name and controller: one of `CONTROLLERS`, `file.py:Class`, a plug-in's class, or the object itself.

    Raises:
        DescriptionError: Another package's controller cannot be loaded.
        UnknownNameError: There is no such controller.
        FormatError: The file cannot be run.
    """
    if isinstance(controller, Controller):  # anything that can be called
        return getattr(controller, "__name__", type(controller).__name__), controller
    if isinstance(controller, str) and controller.partition(":")[0].endswith(".py"):
        return controller.rpartition("/")[2], load_controller(controller)
    if same_name(controller, CONTROLLERS) is None:
        added = plugin("exo_pin.controllers", controller, type)
        if added is not None:
            return controller, added()
    name = known_name("controller", controller, (*CONTROLLERS, *plugin_names("exo_pin.controllers")))
    return name, CONTROLLERS[name]()
