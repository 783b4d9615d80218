"""Markers of an OpenSim model on pelvis and legs, and the joint centres, with all coordinates at 0."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple
from xml.etree.ElementTree import Element

import numpy as np

from exo_pin.anatomy import SIDES, joint
from exo_pin.anatomy.names import Segment, Side
from exo_pin.arrays import Array
from exo_pin.errors import FormatError
from exo_pin.formats.opensim.coordinate_names import COORDINATE_OF
from exo_pin.formats.opensim.osim_joint import Joint, body_pose, joint_centre
from exo_pin.formats.opensim.osim_model import OsimModel, load_model
from exo_pin.formats.opensim.osim_xml import vector_of
from exo_pin.formats.opensim.pelvis_axes import FROM_OPENSIM
from exo_pin.safe.xml_reader import load_xml

_PARENTS = ("body", "socket_parent_frame", "socket_parent_frame_connectee_name", "parent_frame")
"""Elements of a marker that name its body, by version of OpenSim."""


class ModelMarker(NamedTuple):
    """A marker of a model.

    Attributes:
        name: In the model.
        segment: It sits on.
        side: Of the body; None on the pelvis.
        place: `(3,)` forward, left and up from midway between the hips, the hip, the knee, the ankle [m].
    """

    name: str
    segment: Segment
    side: Side | None
    place: Array


class ModelMarkers(NamedTuple):
    """The markers of a model on pelvis and legs.

    Attributes:
        path: The file.
        markers: On pelvis, thighs, shanks and feet; those of the trunk and the arms are left out.
        centres: Side -> `(3, 3)` hip, knee and ankle in the pelvis: forward, left, up [m].
    """

    path: Path
    markers: tuple[ModelMarker, ...]
    centres: dict[Side, Array]


class _Leg(NamedTuple):
    """Hip, knee and ankle joint of one leg, and their centres in the pelvis, OpenSim's axes [m]."""

    joints: tuple[Joint, Joint, Joint]
    centres: Array


def model_markers(path: str | Path) -> ModelMarkers:
    """The markers of a model, where they are in the pose in which every coordinate is 0.

    Raises:
        FormatError: The file cannot be read, lacks a leg's joints, or has no markers on the legs.
    """
    model = load_model(path)
    legs = {side: _leg(model, side) for side in SIDES}
    pelvis = legs["left"].joints[0].parent
    middle = np.mean([leg.centres[0] for leg in legs.values()], axis=0)
    found = []
    for element in load_xml(model.path).iter("Marker"):
        body = next((text.strip() for tag in _PARENTS if (text := element.findtext(tag))), "")
        marker = _marker(model, element, body.rpartition("/")[2], pelvis, legs, middle)
        if marker is not None:
            found.append(marker)
    if not found:
        raise FormatError(
            model.path, "the model has no markers on pelvis, thighs, shanks or feet (MarkerSet)"
        )
    centres = {side: (leg.centres - middle) @ FROM_OPENSIM.T for side, leg in legs.items()}
    return ModelMarkers(model.path, tuple({m.name: m for m in found}.values()), centres)


def _leg(model: OsimModel, side: Side) -> _Leg:
    names = [COORDINATE_OF[joint(side, m)] for m in ("hip_flexion", "knee_flexion", "ankle_dorsiflexion")]
    ankle = model.moved_by(names[2])
    chain = model.chain(ankle.child) if ankle else []
    links = [next((j for j in chain if name in [a.coordinate for a in j.rotations]), None) for name in names]
    hip, knee, last = links
    if hip is None or knee is None or last is None:
        raise FormatError(
            model.path, f"no chain of joints {', '.join(names)} from the pelvis to the {side} foot"
        )
    joints = (hip, knee, last)
    chains = [chain[chain.index(hip) : chain.index(j) + 1] for j in joints]
    return _Leg(joints, np.array([joint_centre(links, {}) for links in chains]))


def _marker(
    model: OsimModel, element: Element, body: str, pelvis: str, legs: dict[Side, _Leg], middle: Array
) -> ModelMarker | None:
    """The marker, or None on the trunk, an arm, a kneecap or the ground."""
    name, at = element.get("name", ""), np.append(vector_of(model.path, element, "location"), 1.0)
    if body == pelvis:
        return ModelMarker(name, "pelvis", None, FROM_OPENSIM @ (at[:3] - middle))
    for side, leg in legs.items():
        for segment, chain, centre in _segments(model, body, leg):
            place = (body_pose(chain, {}) @ at)[:3] - centre
            return ModelMarker(name, segment, side, FROM_OPENSIM @ place)
    return None


def _segments(model: OsimModel, body: str, leg: _Leg) -> Iterator[tuple[Segment, list[Joint], Array]]:
    """The segment that a body belongs to, with its chain from the pelvis and the centre of its joint."""
    try:
        chain = model.chain(body)
    except FormatError:
        return
    if leg.joints[0] not in chain:
        return
    chain = chain[chain.index(leg.joints[0]) :]
    parts: tuple[Segment, ...] = ("thigh", "shank", "foot")
    for segment, link, centre in reversed(list(zip(parts, leg.joints, leg.centres, strict=True))):
        if link in chain:
            beyond = chain[chain.index(link) + 1 :]
            if segment == "foot" or not any(j.coordinates for j in beyond):
                yield segment, chain, centre
            return
