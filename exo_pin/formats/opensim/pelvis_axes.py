"""The pelvis of OpenSim (x forward, y up, z right) and ours (x forward, y left, z up)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from exo_pin.arrays import Array
from exo_pin.formats.opensim.osim_joint import Axis, Joint, X, Y, Z

OURS = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])
"""Takes a vector's OpenSim coordinates to ours."""

TURNS = {
    "tilt": Axis(Z, "pelvis_tilt"),
    "list": Axis(X, "pelvis_list"),
    "rotation": Axis(Y, "pelvis_rotation"),
}
"""The pelvis's turns about OpenSim's usual axes, in its usual order."""

SLIDES = (Axis(X, "pelvis_tx"), Axis(Y, "pelvis_ty"), Axis(Z, "pelvis_tz"))


def usual(order: Sequence[str] = tuple(TURNS)) -> Joint:
    """The joint of ground and pelvis in gait2354, gait2392, Rajagopal 2016 and their descendants.

    Args:
        order: The three names of `TURNS`, from the ground to the pelvis.
    """
    turns = tuple(TURNS[name] for name in order)
    return Joint("ground_pelvis", "ground", "pelvis", np.eye(4), np.eye(4), turns, SLIDES)


def from_opensim(chain: Sequence[Joint], values: Mapping[str, Array], mid_hip: ArrayLike) -> Array:
    """Poses of our pelvis, whose origin lies midway between the hips.

    Args:
        chain: The joints from the ground to OpenSim's pelvis.
        values: Their coordinates, `(n,)` each [rad, m].
        mid_hip: `(3,)` where our origin lies in OpenSim's pelvis, OpenSim axes [m].

    Returns:
        `(n, 4, 4)` T_world_pelvis [m].
    """
    T = np.eye(4)
    for joint in chain:
        T = T @ joint.placed(values)
    base = np.tile(np.eye(4), (len(T), 1, 1))
    base[:, :3, :3] = OURS @ T[:, :3, :3] @ OURS.T
    base[:, :3, 3] = (T[:, :3, 3] + T[:, :3, :3] @ np.asarray(mid_hip)) @ OURS.T
    return base


def to_opensim(base: Array, mid_hip: ArrayLike) -> tuple[Array, Array]:
    """The way back: `(n, 3)` tilt, list, rotation [rad], continuous in time, and `(n, 3)` translation [m]."""
    R = OURS.T @ base[:, :3, :3] @ OURS
    return zxy(R), base[:, :3, 3] @ OURS - R @ np.asarray(mid_hip)


def zxy(R: Array) -> Array:
    """`(n, 3)` angles [rad], continuous in time, of turns about z, then the turned x, then the turned y."""
    first = np.arctan2(-R[:, 0, 1], R[:, 1, 1])
    second = np.arctan2(R[:, 2, 1], np.hypot(R[:, 0, 1], R[:, 1, 1]))
    third = np.arctan2(-R[:, 2, 0], R[:, 2, 2])
    return np.unwrap(np.stack([first, second, third], axis=1), axis=0)
