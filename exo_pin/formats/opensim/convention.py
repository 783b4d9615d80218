"""Conventions of an OpenSim model's coordinates: axes, signs and defaults, usual or by its .osim file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import reduce
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from exo_pin.anatomy import MOVEMENTS, SIDES, joint
from exo_pin.anatomy.names import PelvisRotation, Side
from exo_pin.arrays import Array
from exo_pin.errors import FormatError, UnknownNameError
from exo_pin.formats.opensim.coordinate_names import COORDINATE_OF
from exo_pin.formats.opensim.osim_joint import Joint
from exo_pin.formats.opensim.osim_model import OsimModel, load_model
from exo_pin.formats.opensim.pelvis_axes import PELVIS_ROTATIONS, pelvis_joint, zxy
from exo_pin.formats.sign_presets import Point

_POSITIVE_AXIS: dict[str, tuple[int, int, int]] = {
    "hip_flexion": (0, 0, 1),
    "hip_adduction": (1, 0, 0),
    "hip_rotation": (0, 1, 0),
    "knee_flexion": (0, 0, -1),
    "ankle_dorsiflexion": (0, 0, 1),
    "ankle_inversion": (1, 0, 0),
}
"""Movement of the right leg -> its axis of rotation in OpenSim's pelvis; of the left leg x and y are
negative."""

_PROBE = 1e-3
"""The rotation by which an axis is found [rad]."""

_CLEAR = 0.5
"""Cosine between a joint's axis and the movement's, above which a sign is clear; a subtalar axis has 0.8."""


class Convention(NamedTuple):
    """Axes, signs and defaults of the coordinates of a model.

    Attributes:
        chain: The joints from the ground to the pelvis.
        mid_hip: Midway between the hip centres in the pelvis, OpenSim axes [m]; None: the preset's.
        signs: Joint of ours -> +1 or -1, where the model states it.
        defaults: Coordinates that a file need not name, with the value they then have [rad, m].
        hips: Side -> the hip joint, where its order is not flexion, adduction, rotation.
        description: In words, for the source of a walk.
    """

    chain: tuple[Joint, ...]
    mid_hip: Point | None = None
    signs: Mapping[str, int] = MappingProxyType({})
    defaults: Mapping[str, float] = MappingProxyType({})
    hips: Mapping[Side, Joint] = MappingProxyType({})
    description: str = ""

    @property
    def pelvis(self) -> tuple[str, ...]:
        """Names of the pelvis's coordinates."""
        return tuple(dict.fromkeys(name for joint in self.chain for name in joint.coordinates))

    @property
    def pelvis_angles(self) -> tuple[str, ...]:
        """Names of those that are angles."""
        return tuple(axis.coordinate for joint in self.chain for axis in joint.rotations if axis.coordinate)


def default_convention(order: Sequence[PelvisRotation] | None = None) -> Convention:
    """The convention of most models; `order`: of the pelvis's rotations, if the user knows it.

    Raises:
        UnknownNameError: `order` is not tilt, list and rotation in some order.
    """
    if order is not None and sorted(order) != sorted(PELVIS_ROTATIONS):
        raise UnknownNameError(
            "order of rotations", ",".join(order), (f"{','.join(PELVIS_ROTATIONS)} in any order",)
        )
    how = f"the {'usual ' * (order is None)}order {', '.join(order or PELVIS_ROTATIONS)}"
    description = f"pelvis in {how} with a generic mid-hip, as no model (.osim) is given"
    return Convention((pelvis_joint(order or tuple(PELVIS_ROTATIONS)),), description=description)


def model_convention(path: str | Path) -> Convention:
    """The convention of a model by its .osim file.

    Raises:
        FormatError: The file cannot be read, has no hips, or moves its pelvis along curves.
    """
    model = load_model(path)
    hips = {side: _hip(model, COORDINATE_OF[joint(side, "hip_flexion")]) for side in SIDES}
    pelvis = hips["left"].parent
    chain = tuple(model.chain(pelvis))
    signs = {ours: sign for ours, name in COORDINATE_OF.items() if (sign := _sign(model, pelvis, ours, name))}
    wanted = {side: [COORDINATE_OF[joint(side, m)] for m in MOVEMENTS[:3]] for side in SIDES}
    odd = {side: hip for side, hip in hips.items() if _is_odd(model, hip, wanted[side])}
    for link in (*chain, *odd.values()):
        if not all(axis.linear for axis in (*link.rotations, *link.translations)):
            raise FormatError(model.path, f"joint {link.name!r} moves along curves; expected axes")
    x, y, z = np.mean([_centre(hip) for hip in hips.values()], axis=0).tolist()
    order = ", ".join(name for link in chain for name in link.coordinates)
    description = f"pelvis ({order}), mid-hip and signs as {model.path.name} has them"
    return Convention(chain, (x, y, z), signs, model.defaults, odd, description)


def hip_angles(hip: Joint, side: Side, values: Mapping[str, Array]) -> Array:
    """Angles of a hip whose axes come in another order.

    Args:
        hip: The joint.
        side: Left or right.
        values: Its coordinates, `(n,)` each [rad].

    Returns:
        `(n, 3)` flexion, adduction, rotation [rad].
    """
    at_rest = hip.transform({name: np.zeros(1) for name in hip.coordinates})[0, :3, :3]
    mirrored = 1 if side == "right" else -1
    return zxy(hip.transform(values)[:, :3, :3] @ at_rest.T) * [1, mirrored, mirrored]


def _hip(model: OsimModel, coordinate: str) -> Joint:
    found = model.moved_by(coordinate)
    if found is None:
        raise FormatError(
            model.path, f"no joint rotates by {coordinate!r}; expected a model with OpenSim's hips"
        )
    return found


def _centre(hip: Joint) -> Array:
    """`(3,)` the hip centre in the pelvis [m]."""
    T = hip.transform({name: np.zeros(1) for name in hip.coordinates} or {"": np.zeros(1)})
    return np.asarray((T @ hip.in_child)[0, :3, 3])


def _is_odd(model: OsimModel, hip: Joint, usual_order: Sequence[str]) -> bool:
    """Whether the hip's axes follow each other in another order than flexion, adduction, rotation."""
    order = [axis.coordinate for axis in hip.rotations if axis.coordinate]
    if order == [name for name in usual_order if name in order]:
        return False
    if not set(hip.coordinates) <= set(usual_order):
        why = f"joint {hip.name[:60]!r} moves by {', '.join(hip.coordinates)[:200]}"
        raise FormatError(model.path, f"{why}; expected rotations by {', '.join(usual_order)}")
    return True


def _sign(model: OsimModel, pelvis: str, ours: str, coordinate: str) -> int:
    """+1 or -1: which way a coordinate rotates its joint; 0 where the model does not state it."""
    moved = model.moved_by(coordinate)
    links = [] if moved is None else model.chain(moved.child)
    if pelvis not in [link.child for link in links]:
        return 0
    links = links[[link.child for link in links].index(pelvis) + 1 :]
    if not links:  # it moves the pelvis itself
        return 0
    names = {name for link in links for name in link.coordinates}
    values = {name: np.array([0.0, _PROBE if name == coordinate else 0.0]) for name in names}
    R = reduce(np.matmul, [link.transform(values)[:, :3, :3] for link in links])
    turn = R[1] @ R[0].T
    axis = np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
    side, _, movement = ours.partition("_")
    positive = np.array(_POSITIVE_AXIS[movement]) * ([1, 1, 1] if side == "right" else [-1, -1, 1])
    cosine = float(axis @ positive) / max(float(np.linalg.norm(axis)), 1e-12)
    return 0 if abs(cosine) < _CLEAR else 1 if cosine > 0 else -1
