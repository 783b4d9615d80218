"""exo_pin: a person's walk becomes an exoskeleton's walk.

The public names stand in the table below and are imported when first used.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from exo_pin import anatomy, crosscheck, description, devices, dh, formats, gait, ik, kinematics, viewer
    from exo_pin.anatomy import FEET, JOINTS, Body
    from exo_pin.errors import (
        ConvergenceError,
        DescriptionError,
        ExoPinError,
        FormatError,
        GaitError,
        LimitError,
        UnknownNameError,
    )
    from exo_pin.formats import load_gait, save_gait
    from exo_pin.gait import Event, Gait, normative_gait
    from exo_pin.kinematics import poses
    from exo_pin.robot import Robot, load_robot, load_urdf
    from exo_pin.viewer import view

__version__ = "0.1.0"

_HOMES = {
    "exo_pin.anatomy": ("Body", "FEET", "JOINTS"),
    "exo_pin.errors": (
        "ConvergenceError",
        "DescriptionError",
        "ExoPinError",
        "FormatError",
        "GaitError",
        "LimitError",
        "UnknownNameError",
    ),
    "exo_pin.formats": ("load_gait", "save_gait"),
    "exo_pin.gait": ("Event", "Gait", "normative_gait"),
    "exo_pin.kinematics": ("poses",),
    "exo_pin.robot": ("Robot", "load_robot", "load_urdf"),
    "exo_pin.viewer": ("view",),
}
_MODULES = (
    "anatomy",
    "crosscheck",
    "description",
    "devices",
    "dh",
    "formats",
    "gait",
    "ik",
    "kinematics",
    "viewer",
)
_HOME = {name: home for home, names in _HOMES.items() for name in names}

__all__ = [  # noqa: PLE0604  # strings throughout: the table above
    *_HOME,
    *_MODULES,
]


def __getattr__(name: str) -> object:
    """Import a public name when it is first asked for (PEP 562)."""
    if name in _MODULES:
        return import_module(f"exo_pin.{name}")
    if name in _HOME:
        return getattr(import_module(_HOME[name]), name)
    raise AttributeError(f"module 'exo_pin' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)
