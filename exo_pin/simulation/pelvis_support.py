"""The balance support: a spring and damper from the pelvis to where the walk carries it, and unloading."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal, get_args

import numpy as np

from exo_pin import arguments
from exo_pin.devices import SLIDES, Device
from exo_pin.errors import DescriptionError

SupportName = Literal["soft", "stiff", "stand", "none"]

_AXES = 6


@dataclass(frozen=True)
class PelvisSupport:
    """Stiffness and damping towards the carried pelvis, world axes: x, y, z, then turning about them.

    Attributes:
        name: What people call it.
        stiffness: Six numbers [N/m, N m/rad].
        damping: Six numbers [N s/m, N m s/rad].

    Raises:
        DescriptionError: A number is negative or not finite, or there are not six.
    """

    name: str = "soft"
    stiffness: tuple[float, ...] = (2e4, 2e4, 2e3, 4e3, 4e3, 4e3)
    damping: tuple[float, ...] = (2e3, 2e3, 6e2, 4e2, 4e2, 4e2)

    def __post_init__(self) -> None:
        for what, values in (("stiffness", self.stiffness), ("damping", self.damping)):
            if (arguments.real(f"{what} of the support", values, (_AXES,)) < 0.0).any():
                raise DescriptionError(f"{what} of the support is {values}; numbers from 0 on are accepted")

    @property
    def free(self) -> bool:
        """Whether it holds nothing: no spring, no damper."""
        return not any((*self.stiffness, *self.damping))


_STIFF_STIFFNESS, _STIFF_DAMPING = (1e5, 1e5, 1e5, 2e4, 2e4, 2e4), (6e3, 6e3, 6e3, 1e3, 1e3, 1e3)
"""Of a frame that hardly gives way: critically damped for some 90 kg (a choice)."""

_SUPPORTS: Mapping[str, PelvisSupport] = MappingProxyType(
    {
        "soft": PelvisSupport(),
        "stiff": PelvisSupport("stiff", _STIFF_STIFFNESS, _STIFF_DAMPING),
        "none": PelvisSupport("none", (0.0,) * _AXES, (0.0,) * _AXES),
    }
)
"""`soft` leaves the weight to the legs (soft upwards); `stiff` carries part of it; `none` holds nothing."""


def find_support(support: SupportName | PelvisSupport, device: Device | None) -> PelvisSupport:
    """A support by name, or the record itself.

    `stand` is a device's own: stiff where the stand holds the pelvis, free along its slides.

    Args:
        support: `"soft"`, `"stiff"`, `"stand"`, `"none"` or a record.
        device: The device; its slides make the stand.

    Raises:
        UnknownNameError: There is no such support.
        DescriptionError: `stand` for a device without one.
    """
    if isinstance(support, PelvisSupport):
        return support
    if support == "stand":
        return _stand(device)
    return _SUPPORTS[arguments.word("support", support, get_args(SupportName))]


def _stand(device: Device | None) -> PelvisSupport:
    if device is None or device.pelvis == "free":
        name = "a URDF from elsewhere" if device is None else device.name
        raise DescriptionError(f"{name} has no stand; soft, stiff or none is accepted")
    slides = device.slides
    held = np.array([name not in slides for name in SLIDES] + [True] * 3)
    return PelvisSupport(
        "stand",
        tuple(np.where(held, _STIFF_STIFFNESS, 0.0).tolist()),
        tuple(np.where(held, _STIFF_DAMPING, 0.0).tolist()),
    )
