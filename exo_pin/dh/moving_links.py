"""Masses of the recursion: what moves with which joint, from a body and numbers by link name."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from exo_pin.anatomy.body import Body
from exo_pin.anatomy.inertia import Inertial, total
from exo_pin.anatomy.names import SIDES, HipOrder, Side
from exo_pin.arguments import word
from exo_pin.arrays import Array
from exo_pin.dh.leg_chain import chain
from exo_pin.dh.recursion import Link, tree

_LINKS = ("hip_1", "hip_2", "thigh", "shank", "ankle", "sole_plate")
"""Names of a leg's links, from the pelvis outwards."""

PELVIS = "pelvis"
_TOE = "toe_dorsiflexion"


def links_with_toes(body: Body, hip_order: HipOrder, *, toes: bool) -> list[Link]:
    """The family tree without the pelvis, mothers first; with joints across the balls if there are toes."""
    links = list(tree(body, hip_order))
    for side in SIDES if toes else ():
        leg = body.leg(side)
        at = np.array([leg.ball, 0.0, -leg.ankle_height])
        links.append(Link(f"{side}_{_TOE}", f"{side}_{chain(hip_order)[-1]}", at, np.array([0.0, -1.0, 0.0])))
    return links


def moving_masses(
    body: Body, inertias: Mapping[str, Inertial], hip_order: HipOrder, *, toes: bool
) -> dict[str, Inertial]:
    """Mass, centre and inertia of what each joint moves, by the joint's name, and of the pelvis.

    Args:
        body: Sizes: where the frames on the soles are.
        inertias: By name of the URDF's link, each in its own axes.
        hip_order: Order of the hip joints.
        toes: Whether the foot plate ends at the ball.

    Raises:
        UnknownNameError: A link has no inertia.
    """
    needed = [PELVIS, *(f"{side}_{link}" for side in SIDES for link in _LINKS)]
    needed += [name for side in SIDES for name in _sole_frames(body, side)]
    for name in (*needed, *(f"{side}_toe_plate" for side in SIDES if toes)):
        word("link with an inertia", name, inertias)
    moved = {PELVIS: inertias[PELVIS]}
    for side in SIDES:
        for link, movement in zip(_LINKS, chain(hip_order), strict=True):
            moved[f"{side}_{movement}"] = inertias[f"{side}_{link}"]
        foot = f"{side}_{chain(hip_order)[-1]}"
        frames = [_moved(inertias[name], place) for name, place in _sole_frames(body, side).items()]
        moved[foot] = total([moved[foot], *frames])
        if toes:
            moved[f"{side}_{_TOE}"] = inertias[f"{side}_toe_plate"]
    return moved


def _sole_frames(body: Body, side: Side) -> dict[str, Array]:
    """Sole frame and corners by name, seen from the ankle [m]."""
    leg, inwards = body.leg(side), -1.0 if side == "left" else 1.0
    places = {f"{side}_foot": (0.0, 0.0)}
    for part, x in (("heel", -leg.heel), ("ball", leg.ball)):
        for edge, y in (("medial", inwards), ("lateral", -inwards)):
            places[f"{side}_{part}_{edge}"] = (x, y * leg.foot_width / 2)
    return {name: np.array([x, y, -leg.ankle_height]) for name, (x, y) in places.items()}


def _moved(part: Inertial, place: Array) -> Inertial:
    return part._replace(centre=part.centre + place)
