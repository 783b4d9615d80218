"""Pelvis coordinates of OpenSim (x forward, y up, z right), poses with z up, rotations as angles."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from exo_pin.anatomy.names import PelvisRotation
from exo_pin.arrays import Array
from exo_pin.formats.opensim.osim_joint import AXIS_X, AXIS_Y, AXIS_Z, Axis, Joint

FROM_OPENSIM = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])
"""Rotates a vector's OpenSim coordinates to this package's."""

PELVIS_ROTATIONS: dict[PelvisRotation, Axis] = {
    "tilt": Axis(AXIS_Z, "pelvis_tilt"),
    "list": Axis(AXIS_X, "pelvis_list"),
    "rotation": Axis(AXIS_Y, "pelvis_rotation"),
}
"""Rotations of the pelvis about OpenSim's usual axes, in its usual order."""

PELVIS_ANGLES = tuple(axis.coordinate for axis in PELVIS_ROTATIONS.values())
PELVIS_TRANSLATIONS = ("pelvis_tx", "pelvis_ty", "pelvis_tz")


def pelvis_joint(order: Sequence[PelvisRotation] = tuple(PELVIS_ROTATIONS)) -> Joint:
    """The joint of ground and pelvis in gait2354, gait2392, Rajagopal 2016 and their descendants.

    Args:
        order: The three names of `PELVIS_ROTATIONS`, from the ground to the pelvis.
    """
    rotations = tuple(PELVIS_ROTATIONS[name] for name in order)
    axes = zip((AXIS_X, AXIS_Y, AXIS_Z), PELVIS_TRANSLATIONS, strict=True)
    translations = tuple(Axis(axis, name) for axis, name in axes)
    return Joint("ground_pelvis", "ground", "pelvis", np.eye(4), np.eye(4), rotations, translations)


def from_opensim(chain: Sequence[Joint], values: Mapping[str, Array], mid_hip: ArrayLike) -> Array:
    """Poses of this package's pelvis, whose origin lies midway between the hips.

    Args:
        chain: The joints from the ground to OpenSim's pelvis.
        values: Their coordinates, `(n,)` each [rad, m].
        mid_hip: `(3,)` where our origin lies in OpenSim's pelvis, OpenSim axes [m].

    Returns:
        `(n, 4, 4)` T_world_pelvis [m].
    """
    T = np.eye(4)
    for joint in chain:
        T = T @ joint.transform(values)
    base = np.tile(np.eye(4), (len(T), 1, 1))
    base[:, :3, :3] = FROM_OPENSIM @ T[:, :3, :3] @ FROM_OPENSIM.T
    base[:, :3, 3] = (T[:, :3, 3] + T[:, :3, :3] @ np.asarray(mid_hip)) @ FROM_OPENSIM.T
    return base


def to_opensim(base: Array, mid_hip: ArrayLike) -> tuple[Array, Array]:
    """Inverse of `from_opensim`: `(n, 3)` tilt, list, rotation [rad], and `(n, 3)` translation [m]."""
    R = FROM_OPENSIM.T @ base[:, :3, :3] @ FROM_OPENSIM
    return zxy(R), base[:, :3, 3] @ FROM_OPENSIM - R @ np.asarray(mid_hip)


def zxy(R: Array) -> Array:
    """`(n, 3)` angles [rad], continuous in time, about z, the rotated x and the twice rotated y."""
    first = np.arctan2(-R[:, 0, 1], R[:, 1, 1])
    second = np.arctan2(R[:, 2, 1], np.hypot(R[:, 0, 1], R[:, 1, 1]))
    third = np.arctan2(-R[:, 2, 0], R[:, 2, 2])
    return np.unwrap(np.stack([first, second, third], axis=1), axis=0)


def body_fixed_xyz(R: Array) -> Array:
    """Angles (3,) about x, the new y and the new z that make up a rotation (3, 3) [rad]."""
    y = np.arcsin(np.clip(R[0, 2], -1.0, 1.0))
    if abs(R[0, 2]) > 1.0 - 1e-12:  # x and z turn about one line: all of it is given to x
        return np.array([np.arctan2(R[2, 1], R[1, 1]), y, 0.0])
    return np.array([np.arctan2(-R[1, 2], R[2, 2]), y, np.arctan2(-R[0, 1], R[0, 0])])
