"""Forces and torques in the picture: arrows at feet and pelvis, arcs at the joints, load of the motors."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from exo_pin.anatomy import JOINTS, SIDES
from exo_pin.arrays import Array
from exo_pin.ground import PlacedWalk
from exo_pin.viewer.meshes.solids import Solid
from exo_pin.viewer.scenes.actor import ShownForces
from exo_pin.viewer.scenes.kinetics import Kinetics, Origin
from exo_pin.viewer.scenes.link_nodes import Linkage
from exo_pin.viewer.scenes.pendulum_mark import pendulum_mark
from exo_pin.viewer.scenes.scene import ROOT, Arc, Arrow, ForceMarks, Group, JointNode, Key

_WEIGHT_LONG = 0.6
"""An arrow as long as this [m] is the whole weight."""

_FULL_ARC = 300.0
"""Of the largest torque of the walk [degrees]."""

_GROUND, _SUPPORT, _TORQUE = "#0ca54b", "#8a4fd3", "#ff7a0a"
_LOAD = "linear-gradient(90deg, #2fb457, #e6b800, #c4221f)"
"""Colours of the arrows and arcs: of neither leg."""

_NEAR, _THICK = 0.075, 0.02
"""What is nearer than this to a joint's axis, and at most so deep below its outer face, is its motor [m]."""

_FORWARD = np.array([1.0, 0.0, 0.0])

_RIM = 0.03
"""An arc goes around a motor so far away [m]."""

_WIDE = 0.12
"""Radius of the arc of a joint without a motor on its axis [m]: hip rotation, about the thigh."""

_REACTION: Mapping[Origin, str] = {
    "measured": "ground reaction, measured",
    "predicted": "ground reaction, predicted",
    "planned": "ground reaction, planned",
    "simulated": "ground reaction, simulated",
}
_HELD: Mapping[Origin, str] = {
    "measured": "residual force",
    "predicted": "support force, predicted",
    "planned": "support force, planned",
    "simulated": "support force",
}
_HINTS: Mapping[Origin, str] = {
    "measured": "What the model does not explain; it acts on the pelvis in the inverse dynamics.",
    "predicted": "What the pelvis must be held with if the ground reaction is as predicted.",
    "planned": "None: the ground alone carries a planned walk.",
    "simulated": "Of the balance support on the pelvis.",
}


def shown_forces(kinetics: Kinetics, walk: PlacedWalk, tree: Linkage) -> ShownForces:
    """Arrows, arcs and motors' loads of a walk that is placed on its ground.

    Args:
        kinetics: Forces and torques on the samples of the walk.
        walk: Where feet and pelvis are shown.
        tree: The exoskeleton's nodes.
    """
    arrows, arrays = _arrows(kinetics, walk)
    arcs = tuple(_arcs(kinetics.torque, tree))
    peak = float(np.nanmax(np.abs(kinetics.torque)))
    arrays |= {"torque": kinetics.torque}
    loaded = kinetics.effort is not None
    if kinetics.effort is not None:
        arrays["load"] = kinetics.effort.load
    length = _WEIGHT_LONG / kinetics.weight
    groups, keys = _groups(kinetics, arrows, arcs), _keys(kinetics, peak)
    pendulum = pendulum_mark(kinetics, walk, length)
    if pendulum is not None:
        arrows, arrays = (*arrows, pendulum.arrow), arrays | pendulum.arrays
        groups, keys = (*groups, pendulum.group), (*keys, *pendulum.keys)
    marks = ForceMarks(arrows, length, arcs, "torque", peak / _FULL_ARC, "load" if loaded else "")
    return ShownForces(marks, arrays, groups, keys)


def _arrows(kinetics: Kinetics, walk: PlacedWalk) -> tuple[tuple[Arrow, ...], dict[str, Array]]:
    points = kinetics.points(walk.feet)
    arrows, arrays = [], dict[str, Array]()
    for foot, side in enumerate(SIDES):
        name = f"{side}_ground_reaction"
        arrays |= {name: kinetics.force[:, foot], f"{name}_at": points[:, foot]}
        arrows.append(Arrow(f"{ROOT}/forces/{name}", name, f"{name}_at", _GROUND))
    arrays |= {"support": kinetics.support, "support_at": walk.base[:, :3, 3]}
    arrows.append(Arrow(f"{ROOT}/forces/support", "support", "support_at", _SUPPORT))
    return tuple(arrows), arrays


def _arcs(torque: Array, tree: Linkage) -> Iterator[Arc]:
    """One for each joint with a torque, around its motor."""
    ends = {path: link for link, path in tree.links.items()}
    for joint in tree.joints:
        if joint.name in JOINTS and np.isfinite(torque[:, JOINTS.index(joint.name)]).any():
            middle, radius = _motor(joint, tree.shapes.get(ends[joint.path]))
            paths = f"{joint.path}/torque", f"{joint.path}/load"
            yield Arc(*paths, joint.axis, middle, radius, JOINTS.index(joint.name))


def _motor(joint: JointNode, shape: Solid | None) -> tuple[float, float]:
    """Where on the joint's axis the outer face of its motor lies [m], and the radius of an arc around it."""
    axis = np.array(joint.axis)
    if shape is None or axis[2]:  # of hip rotation, about the thigh
        return 0.0, _WIDE
    along = shape.vertices @ axis
    apart = np.linalg.norm(shape.vertices - along[:, None] * axis, axis=1)
    near = apart < _NEAR
    along, apart = along[near], apart[near]
    if not len(along):
        return 0.0, _WIDE
    forward = abs(axis[0]) > abs(axis[1])  # such a joint's motor is behind the leg, the others' beside it
    face = float(along[(shape.vertices[near] @ _FORWARD).argmin() if forward else np.abs(along).argmax()])
    return face, float(apart[np.abs(along - face) < _THICK].max()) + _RIM


def _groups(kinetics: Kinetics, arrows: tuple[Arrow, ...], arcs: tuple[Arc, ...]) -> tuple[Group, ...]:
    *feet, support = (arrow.path for arrow in arrows)
    reaction, held = (words[kinetics.origin] for words in (_REACTION, _HELD))
    groups = [
        Group(_capital(reaction), tuple(feet)),
        Group(_capital(held), (support,), shown=kinetics.origin != "measured"),
        Group("Joint torques", tuple(arc.path for arc in arcs)),
    ]
    loads = Group("Load of the motors", tuple(arc.cap for arc in arcs if arc.middle))
    return tuple(groups if kinetics.effort is None else [*groups, loads])


def _keys(kinetics: Kinetics, peak: float) -> tuple[Key, ...]:
    scale = f"An arrow of {_WEIGHT_LONG:g} m is the weight of {kinetics.weight:.0f} N."
    turn = f"An arc of {_FULL_ARC:g} degrees is {peak:.0f} N m, the largest torque of the walk."
    keys = [
        Key(_REACTION[kinetics.origin], _GROUND, f"At the centre of pressure of each foot. {scale}"),
        Key("joint torque" if kinetics.effort is None else "motor torque", _TORQUE, turn),
    ]
    if kinetics.origin != "measured":  # a residual is not shown at first
        keys.append(Key(_HELD[kinetics.origin], _SUPPORT, f"{_HINTS[kinetics.origin]} {scale}"))
    load = Key(
        "motor load", _LOAD, "Colour of each motor: green without torque, yellow at half, red at its limit."
    )
    return tuple(keys if kinetics.effort is None else [*keys, load])


def _capital(words: str) -> str:
    return words[:1].upper() + words[1:]
