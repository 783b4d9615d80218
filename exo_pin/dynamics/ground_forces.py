"""Ground reaction of both feet: force, centre of pressure and free moment, or wrench about the origin."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.names import Side
from exo_pin.arrays import Array, Mask
from exo_pin.gait.trial import ForcePlate
from exo_pin.short_repr import short_repr
from exo_pin.signals import longest_run

LOADED = 20.0
"""Vertical force [N] from which a foot's centre of pressure is stated: with less it wanders."""


@dataclass(frozen=True, eq=False)
class GroundForces:
    """What the ground does to the feet, in world axes, in the order of `FEET`.

    Attributes:
        force: `(n, 2, 3)` [N].
        point: `(n, 2, 3)` centre of pressure [m]; NaN where the foot is not loaded.
        moment: `(n, 2, 3)` free moment at that point [N m].
    """

    force: Array
    point: Array
    moment: Array

    __repr__ = short_repr

    @property
    def wrench(self) -> Array:
        """`(n, 2, 6)` force, then moment about the world's origin [N, N m]."""
        arm = np.nan_to_num(np.cross(self.point, self.force))
        return np.concatenate([self.force, arm + self.moment], axis=-1)


def from_wrenches(wrench: Array, height: Array) -> GroundForces:
    """The same wrenches as forces at the centres of pressure, where the ground exerts no tilting moment.

    Args:
        wrench: `(n, 2, 6)` force, then moment about the world's origin [N, N m].
        height: `(n, 2)` height of the ground under each foot [m].
    """
    force, origin = wrench[..., :3], wrench[..., 3:]
    loaded = force[..., 2] > LOADED
    fz = np.where(loaded, force[..., 2], np.nan)
    x = (height * force[..., 0] - origin[..., 1]) / fz
    y = (height * force[..., 1] + origin[..., 0]) / fz
    point = np.stack([x, y, np.where(loaded, height, np.nan)], axis=-1)
    moment = origin - np.nan_to_num(np.cross(point, force))
    return GroundForces(force, point, moment)


def foot_plates(ground: GroundForces, time: Array, valid: Mask) -> dict[Side, ForcePlate]:
    """The forces on each foot as if it walked on a plate of its own, over the longest run of valid samples.

    A foot that is not loaded keeps the point of its nearest loaded sample, and the moment about that: so
    point and force can be interpolated between samples.

    Args:
        ground: Forces of n samples.
        time: `(n,)` [s].
        valid: `(n,)` where they are known.
    """
    run = slice(*longest_run(valid))
    found: dict[Side, ForcePlate] = {}
    for k, side in enumerate(SIDES):
        force, wrench = ground.force[run, k], ground.wrench[run, k]
        point = held(ground.point[run, k])
        moment = wrench[:, 3:] - np.cross(point, force)
        found[side] = ForcePlate(f"{side} foot", time[run], force, point, moment)
    return found


def held(point: Array) -> Array:
    """Points `(n, 3)` whose gaps have the nearest known one; 0 where there is none."""
    known = np.flatnonzero(np.isfinite(point).all(axis=1))
    if not len(known):
        return np.zeros_like(point)
    nearest = np.searchsorted((known[1:] + known[:-1]) / 2, np.arange(len(point)))
    return np.asarray(point[known[nearest]])
