"""Pushes at the pelvis: a horizontal force for a short time."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from exo_pin import arguments
from exo_pin.arrays import Array
from exo_pin.errors import DescriptionError
from exo_pin.simulation.reference_motion import ReferenceMotion

_LARGEST, _LONGEST = 10_000.0, 60.0
"""Force [N] and duration [s]: more is a wrong unit."""


@dataclass(frozen=True)
class Push:
    """A constant force at mid-hip, along the heading that the walk's pelvis has when it begins.

    Attributes:
        forward: [N]; backwards negative.
        left: [N]; to the right negative.
        duration: [s].
        start: After the start of the run [s].

    Raises:
        DescriptionError: A number is not within its range.
    """

    forward: float
    left: float
    duration: float
    start: float

    def __post_init__(self) -> None:
        for name in ("forward", "left"):
            arguments.number(
                f"{name} force of the push [N]", getattr(self, name), least=-_LARGEST, most=_LARGEST
            )
        arguments.number("duration of the push [s]", self.duration, above=0.0, most=_LONGEST)
        arguments.number("start of the push [s]", self.start, least=0.0)


def pushed(pushes: Iterable[Push], walk: ReferenceMotion) -> Array:
    """`(N, 2)` force of all pushes at the steps of a walk, world axes [N].

    Raises:
        DescriptionError: A push begins after the end of the run.
    """
    force = np.zeros((len(walk.time), 2))
    for push in pushes:
        if push.start >= walk.time[-1]:
            raise DescriptionError(
                f"the push at {push.start:g} s is after the end of the run, {walk.time[-1]:.2f} s"
            )
        begin, end = np.searchsorted(walk.time, [push.start - 1e-9, push.start + push.duration - 1e-9])
        ahead = walk.base[begin, :2, 0] / np.linalg.norm(walk.base[begin, :2, 0])
        force[begin:end] += push.forward * ahead + push.left * np.array([-ahead[1], ahead[0]])
    return force
