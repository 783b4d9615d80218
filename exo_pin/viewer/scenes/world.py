"""The world around the figures, fitted to the walk: belt, floor, paths, marks, and what the cameras frame."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.names import Side
from exo_pin.arrays import Array
from exo_pin.gait import Gait
from exo_pin.ground import PlacedWalk
from exo_pin.viewer.drawing_commands import Command
from exo_pin.viewer.meshes.thinning import polyline
from exo_pin.viewer.scenes import props
from exo_pin.viewer.scenes.actor import Mount
from exo_pin.viewer.scenes.scene import ROOT, Box, Marks

SECOND = f"{ROOT}/second_treadmill"
"""Path of the treadmill of a ghost beside the first figure."""

ASIDE = -1.15
"""Where it stands, to the left [m]."""

_UNTHINNED = 400
"""A foot's path of no more samples than this is drawn through all of them."""

TRACE_POINTS = 2000
"""Through no more points than this, however long the recording."""

TRACE_ERROR = 1e-3
"""A longer one is nowhere wrong by more than this [m], if `TRACE_POINTS` points suffice."""


def world(
    gait: Gait, walk: PlacedWalk, feet: Sequence[Mount], *, ghost: bool = False
) -> tuple[list[Command], Marks]:
    """All drawings but the figures, and the nodes among them that the page moves.

    Args:
        gait: The walk's duration.
        walk: The walk on its ground.
        feet: Left and right sole.
        ghost: Whether a second walk may need a treadmill of its own.
    """
    commands = props.studio()
    belt, ground = None, 0.0
    if not walk.support.overground:
        mill = props.Treadmill.under(walk, gait.duration)
        mills = {f"{ROOT}/treadmill": mill} | ({SECOND: replace(mill, aside=ASIDE)} if ghost else {})
        commands += [command for path, each in mills.items() for command in props.treadmill(path, each)]
        belt, ground = props.belt(tuple(mills), mill), -props.DECK
    commands += props.floor(f"{ROOT}/floor", ground, float(np.abs(walk.base[:, :2, 3]).max()) + 4.0)
    commands += props.centre_of_mass(f"{ROOT}/marks/com")
    contact: dict[Side, str] = {}
    for k, side in enumerate(SIDES):
        foot = feet[k]
        contact[side] = f"{foot.node}/contact/sole"
        commands += props.contact_sole(contact[side], foot.size, foot.center, foot.T)
        path, color = _thinned(walk.feet[:, k, :3, 3]), props.SIDE_COLORS[side]
        commands.append(props.trace(f"{ROOT}/traces/{side}", path, color, closed=gait.periodic))
    return commands, Marks(f"{ROOT}/marks/com/ball", f"{ROOT}/marks/com/disc", 0.003, contact, belt)


def boxes(walk: PlacedWalk, above_hips: float) -> dict[str, Box]:
    """What the cameras frame: the whole figure, the feet, and the treadmill if there is one.

    Args:
        walk: The walk on its ground.
        above_hips: How far the figure reaches above the hips [m].
    """
    framed = slice(1 if walk.support.overground else None)  # over ground the cameras go along
    y, z = float(walk.base[framed, 1, 3].mean()), float(walk.base[0, 2, 3])
    here = walk.corners[framed, :, 0]
    low, high = float(here.min()) - 0.05, float(here.max()) + 0.12
    bottom, top = (0.0 if walk.support.overground else -props.DECK), z + above_hips
    middle = (low + high) / 2
    found = {
        "whole": Box((middle, y, (bottom + top) / 2), (high - low, 0.75, top - bottom)),
        "feet": Box((middle, y, 0.12), (high - low, 0.6, 0.4)),
    }
    if walk.support.overground:
        return found
    return found | {"treadmill": props.frame(props.Treadmill.under(walk))}


def _thinned(points: Array) -> Array:
    return points if len(points) <= _UNTHINNED else polyline(points, TRACE_ERROR, TRACE_POINTS)
