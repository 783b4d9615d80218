"""The world around the figures, fitted to the walk: belt, floor, paths, marks, and what the cameras frame."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from exo_pin.anatomy import CORNERS, FEET, SIDES
from exo_pin.anatomy.names import Side
from exo_pin.arrays import Array
from exo_pin.gait import Gait
from exo_pin.ground.placement import Placement
from exo_pin.robot import Robot
from exo_pin.viewer.drawing_commands import Command
from exo_pin.viewer.meshes.thinning import polyline
from exo_pin.viewer.scenes import props
from exo_pin.viewer.scenes.link_nodes import Linkage
from exo_pin.viewer.scenes.scene import Box, Marks

ROOT = "/exo_pin"
"""Every node of ours hangs below this one."""

TRACE_POINTS = 400
"""A foot's path of no more samples than this is drawn through all of them."""

TRACE_MOST = 2000
"""Through no more points than this, however long the recording."""

TRACE_ERROR = 1e-3
"""A longer one is drawn so that it is nowhere wrong by more than this [m], if `TRACE_MOST` points suffice."""


@dataclass(frozen=True, eq=False)
class Mount:
    """Where a green sole hangs.

    Attributes:
        node: Path of the foot's node.
        T: Pose of the sole's own axes there (4, 4): x forward, z up.
        size: Length and width of the sole [m].
        center: Its middle in its own axes [m].
    """

    node: str
    T: Array
    size: tuple[float, float]
    center: tuple[float, float, float]


def mounts(robot: Robot, shown: Placement, exo: Linkage) -> tuple[Mount, ...]:
    """Left and right sole of the exoskeleton."""
    nodes = [exo.links[foot] for foot in FEET]
    return tuple(
        Mount(node, np.eye(4), *_sole(robot, shown, side)) for node, side in zip(nodes, SIDES, strict=True)
    )


def world(gait: Gait, shown: Placement, feet: Sequence[Mount]) -> tuple[list[Command], Marks]:
    """All drawings but the figures, and the nodes among them that the page moves.

    Args:
        gait: Whose duration it is.
        shown: The walk as shown.
        feet: Left and right.
    """
    commands = props.studio()
    belt, ground = None, 0.0
    if not shown.support.overground:
        mill = _treadmill(shown, gait)
        commands += props.treadmill(f"{ROOT}/treadmill", mill)
        belt, ground = props.belt(f"{ROOT}/treadmill", mill), -props.DECK
    commands += props.floor(f"{ROOT}/floor", ground, float(np.abs(shown.base[:, :2, 3]).max()) + 4.0)
    commands += props.centre_of_mass(f"{ROOT}/marks/com")
    contact = {}
    for k, side in enumerate(SIDES):
        foot = feet[k]
        contact[side] = f"{foot.node}/contact/sole"
        commands += props.contact_sole(contact[side], foot.size, foot.center, foot.T)
        path, color = _thinned(shown.feet[:, k, :3, 3]), props.SIDE_COLORS[side]
        commands.append(props.trace(f"{ROOT}/traces/{side}", path, color, closed=gait.periodic))
    return commands, Marks(f"{ROOT}/marks/com/ball", f"{ROOT}/marks/com/disc", 0.003, contact, belt)


def boxes(shown: Placement, above_hips: float) -> dict[str, Box]:
    """What the cameras frame: the whole figure up to a height above the hips [m], and the feet."""
    framed = slice(1 if shown.support.overground else None)  # over ground the cameras go along
    y, z = float(shown.base[framed, 1, 3].mean()), float(shown.base[0, 2, 3])
    here = shown.corners[framed, :, 0]
    low, high = float(here.min()) - 0.05, float(here.max()) + 0.12
    bottom, top = (0.0 if shown.support.overground else -props.DECK), z + above_hips
    middle = (low + high) / 2
    return {
        "whole": Box((middle, y, (bottom + top) / 2), (high - low, 0.75, top - bottom)),
        "feet": Box((middle, y, 0.12), (high - low, 0.6, 0.4)),
    }


def _treadmill(shown: Placement, gait: Gait) -> props.Treadmill:
    low, high = float(shown.corners[..., 0].min()), float(shown.corners[..., 0].max())
    length = max(high - low + 0.75, 1.5)
    return props.Treadmill((low + high) / 2 + 0.05, length, 0.0, shown.support.belt_speed, gait.duration)


def _sole(
    robot: Robot, shown: Placement, side: Side
) -> tuple[tuple[float, float], tuple[float, float, float]]:
    """Length and width of a foot's sole [m] and its middle, seen from the foot's frame."""
    mine = [k for k, name in enumerate(CORNERS) if name.startswith(side)]
    T = shown.feet[0, SIDES.index(side)]
    corners = (shown.corners[0, mine] - T[:3, 3]) @ T[:3, :3]  # in the foot's own axes
    heel, front = float(corners[:, 0].min()), float(corners[:, 0].max())
    if robot.body is not None:  # the corners end at the ball of the foot, the plate at the toes
        front = heel + robot.body.leg(side).foot_length
    return (front - heel + 0.007, float(np.ptp(corners[:, 1])) + 0.009), ((heel + front) / 2, 0.0, 0.006)


def _thinned(points: Array) -> Array:
    return points if len(points) <= TRACE_POINTS else polyline(points, TRACE_ERROR, TRACE_MOST)
