"""How an OpenSim model means its coordinates: by habit, or as its .osim file says."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import reduce
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from exo_pin.anatomy import MOVEMENTS, SIDES, joint
from exo_pin.anatomy.names import Side
from exo_pin.arrays import Array
from exo_pin.errors import FormatError, UnknownNameError
from exo_pin.formats.opensim.osim_joint import Joint
from exo_pin.formats.opensim.osim_model import OsimModel, load_model
from exo_pin.formats.opensim.pelvis_axes import TURNS, usual, zxy
from exo_pin.formats.presets import OPENSIM, PRESETS, Point

POSITIVE = {
    "hip_flexion": (0, 0, 1),
    "hip_adduction": (1, 0, 0),
    "hip_rotation": (0, 1, 0),
    "knee_flexion": (0, 0, -1),
    "ankle_dorsiflexion": (0, 0, 1),
    "ankle_inversion": (1, 0, 0),
}
"""Movement of the right leg -> the vector about which it turns, in OpenSim's pelvis; of the left leg x and y
are the other way round."""

SMALL = 1e-3
"""The turn by which an axis is found [rad]."""

CLEAR = 0.5
"""Cosine between a joint's axis and the movement's, above which a sign is clear; a subtalar axis has 0.8."""


class Convention(NamedTuple):
    """What must be known of a model to read its coordinates.

    Attributes:
        chain: The joints from the ground to the pelvis.
        mid_hip: Midway between the hip centres in the pelvis, OpenSim axes [m]; None: the preset's.
        signs: Joint of ours -> +1 or -1, where the model tells.
        defaults: Coordinates that a file need not name, with the value they then have [rad, m].
        hips: Side -> the hip joint, where its order is not flexion, adduction, rotation.
        said: What the notes say.
    """

    chain: tuple[Joint, ...]
    mid_hip: Point | None = None
    signs: Mapping[str, int] = MappingProxyType({})
    defaults: Mapping[str, float] = MappingProxyType({})
    hips: Mapping[str, Joint] = MappingProxyType({})
    said: str = ""

    @property
    def pelvis(self) -> tuple[str, ...]:
        """Names of the pelvis's coordinates."""
        return tuple(dict.fromkeys(name for joint in self.chain for name in joint.coordinates))

    def holding(self, values: Mapping[str, float]) -> Convention:
        """The same with further coordinates that a file need not name."""
        return self._replace(defaults={**self.defaults, **values})

    @property
    def turning(self) -> tuple[str, ...]:
        """Those of them that are angles."""
        return tuple(axis.coordinate for joint in self.chain for axis in joint.turns if axis.coordinate)


def by_habit(order: Sequence[str] | None = None) -> Convention:
    """What most models have; `order`: of the pelvis's turns, if the user knows it.

    Raises:
        UnknownNameError: `order` is not tilt, list and rotation in some order.
    """
    if order is not None and sorted(order) != sorted(TURNS):
        raise UnknownNameError("order of turns", ",".join(order), (f"{','.join(TURNS)} in any order",))
    how = f"the {'usual ' * (order is None)}order {', '.join(order or TURNS)}"
    said = f"pelvis in {how} with a generic mid-hip, as no model (.osim) is given"
    return Convention((usual(order or tuple(TURNS)),), said=said)


def by_model(path: str | Path, columns: Mapping[str, str]) -> Convention:
    """What the model's own file says.

    Args:
        path: An .osim file.
        columns: Our joint -> the model's coordinate.

    Raises:
        FormatError: The file cannot be read, has no hips, or moves its pelvis along curves.
    """
    model = load_model(path)
    hips = {side: _hip(model, columns[joint(side, "hip_flexion")]) for side in SIDES}
    pelvis = hips["left"].parent
    chain = tuple(model.chain(pelvis))
    signs = {ours: sign for ours, name in columns.items() if (sign := _sign(model, pelvis, ours, name))}
    wanted = {side: [columns[joint(side, m)] for m in MOVEMENTS[:3]] for side in SIDES}
    odd = {side: hip for side, hip in hips.items() if _is_odd(model, hip, wanted[side])}
    for link in (*chain, *odd.values()):
        if not all(axis.linear for axis in (*link.turns, *link.slides)):
            raise FormatError(model.path, f"joint {link.name!r} moves along curves; expected axes")
    x, y, z = np.mean([_centre(hip) for hip in hips.values()], axis=0).tolist()
    defaults = dict.fromkeys(columns.values(), 0.0) | model.defaults
    order = ", ".join(name for link in chain for name in link.coordinates)
    said = f"pelvis ({order}), mid-hip and signs as {model.path.name} has them"
    return Convention(chain, (x, y, z), signs, defaults, odd, said)


def habit_of(knee: int) -> str:
    """The preset whose knee has this sign."""
    return next(name for name in OPENSIM if PRESETS[name].knee == knee)


def hip_angles(hip: Joint, side: Side, values: Mapping[str, Array]) -> Array:
    """`(n, 3)` flexion, adduction, rotation [rad], of a hip whose axes come in another order."""
    at_rest = hip.placed({name: np.zeros(1) for name in hip.coordinates})[0, :3, :3]
    mirrored = 1 if side == "right" else -1
    return zxy(hip.placed(values)[:, :3, :3] @ at_rest.T) * [1, mirrored, mirrored]


def _hip(model: OsimModel, coordinate: str) -> Joint:
    found = model.moved_by(coordinate)
    if found is None:
        raise FormatError(
            model.path, f"no joint turns by {coordinate!r}; expected a model with OpenSim's hips"
        )
    return found


def _centre(hip: Joint) -> Array:
    """`(3,)` where the hip turns, in the pelvis [m]."""
    T = hip.placed({name: np.zeros(1) for name in hip.coordinates} or {"": np.zeros(1)})
    return np.asarray((T @ hip.in_child)[0, :3, 3])


def _is_odd(model: OsimModel, hip: Joint, usual_order: Sequence[str]) -> bool:
    """Whether the hip's axes follow each other in another order than flexion, adduction, rotation."""
    order = [axis.coordinate for axis in hip.turns if axis.coordinate]
    if order == [name for name in usual_order if name in order]:
        return False
    if not set(hip.coordinates) <= set(usual_order):
        why = f"joint {hip.name[:60]!r} moves by {', '.join(hip.coordinates)[:200]}"
        raise FormatError(model.path, f"{why}; expected turns by {', '.join(usual_order)}")
    return True


def _sign(model: OsimModel, pelvis: str, ours: str, coordinate: str) -> int:
    """+1 or -1: which way a coordinate turns its joint; 0 where the model does not tell."""
    moved = model.moved_by(coordinate)
    links = [] if moved is None else model.chain(moved.child)
    if pelvis not in [link.child for link in links]:
        return 0
    links = links[[link.child for link in links].index(pelvis) + 1 :]
    if not links:  # it moves the pelvis itself
        return 0
    names = {name for link in links for name in link.coordinates}
    values = {name: np.array([0.0, SMALL if name == coordinate else 0.0]) for name in names}
    R = reduce(np.matmul, [link.placed(values)[:, :3, :3] for link in links])
    turn = R[1] @ R[0].T
    axis = np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
    side, _, movement = ours.partition("_")
    positive = np.array(POSITIVE[movement]) * ([1, 1, 1] if side == "right" else [-1, -1, 1])
    cosine = float(axis @ positive) / max(float(np.linalg.norm(axis)), 1e-12)
    return 0 if abs(cosine) < CLEAR else 1 if cosine > 0 else -1
