"""The person of an OpenSim model: mass, and lengths of the legs between its joint centres."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from exo_pin.anatomy import SIDES, joint
from exo_pin.anatomy.names import Movement, Side
from exo_pin.anatomy.person import Measure, Person
from exo_pin.arrays import Array
from exo_pin.errors import FormatError
from exo_pin.formats.opensim.coordinate_names import COORDINATE_OF
from exo_pin.formats.opensim.osim_joint import Joint, joint_centre
from exo_pin.formats.opensim.osim_model import OsimModel, load_model

_CENTRES: tuple[Movement, ...] = ("hip_flexion", "knee_flexion", "ankle_dorsiflexion")
"""Movements whose joints lie in the ends of thigh and shank."""


def model_person(path: str | Path) -> Person:
    """The person that a model was scaled to: its mass, thighs, shanks and the distance of its hips.

    Joint centres are those of the model's default pose, where a knee that glides has its default angle. A
    model of one leg, or whose joints do not lead from a hip to an ankle, gives what it has.

    Raises:
        FormatError: The file cannot be read.
    """
    model = load_model(path)
    sizes: dict[str, Measure] = {}
    if model.mass > 0:
        sizes["mass"] = _measure(model, model.mass, "all its bodies")
    hips = []
    for side in SIDES:
        centres = _centres(model, side)
        hips += centres[:1]
        for size, a, b in zip(("thigh", "shank"), centres, centres[1:], strict=False):
            sizes[f"{side}_{size}"] = _measure(model, _apart(a, b), "joint centre to joint centre")
    if len(hips) == len(SIDES):
        sizes["hip_width"] = _measure(model, _apart(*hips), "hip centre to hip centre")
    return Person(sizes)


def _measure(model: OsimModel, value: float, what: str) -> Measure:
    return Measure(value, "model", f"{model.path.name}: {what}")


def _centres(model: OsimModel, side: Side) -> list[Array]:
    """Hip, knee and ankle centre `(3,)` in the pelvis, as far as the joints lead from the pelvis on [m]."""
    joints = [model.moved_by(COORDINATE_OF[joint(side, movement)]) for movement in _CENTRES]
    hip = joints[0]
    if hip is None:
        return []
    found: list[Array] = []
    for link in joints:
        chain = _from_pelvis(model, hip, link)
        if not chain:
            break
        found.append(joint_centre(chain, model.defaults))
    return found


def _from_pelvis(model: OsimModel, hip: Joint, link: Joint | None) -> list[Joint]:
    """The joints from a hip to a joint of its leg; empty where they do not lead there."""
    if link is None:
        return []
    try:
        chain = model.chain(link.child)
    except FormatError:
        return []
    return chain[chain.index(hip) :] if hip in chain else []


def _apart(a: Array, b: Array) -> float:
    return float(np.linalg.norm(a - b))
