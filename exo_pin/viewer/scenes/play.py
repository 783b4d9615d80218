"""`Play`: who walks and what is drawn of it, the same for an exoskeleton and for any robot with two legs."""

from __future__ import annotations

from dataclasses import dataclass

from exo_pin.gait import Gait
from exo_pin.ground.placement import Placement
from exo_pin.robot import Robot
from exo_pin.viewer.scenes.actor import Actor
from exo_pin.viewer.scenes.joint_plots import Tab
from exo_pin.viewer.scenes.scene import Grip
from exo_pin.viewer.scenes.world import Mount


@dataclass(frozen=True, eq=False)
class Play:
    """What a scene is compiled from.

    Attributes:
        robot: Who walks.
        gait: Whose time and events the walk has.
        shown: The walk as shown.
        actors: The figures, the robot first.
        mounts: Left and right foot: where the green soles hang.
        grips: Feet that can be taken by the hand.
        tabs: The curves.
        reference: What the dashed curves are, or empty.
        compared: What the dotted curves are, or empty.
        top: How far the picture reaches above the robot's root [m].
        notes: What to know about the picture, in sentences.
    """

    robot: Robot
    gait: Gait
    shown: Placement
    actors: tuple[Actor, ...]
    mounts: tuple[Mount, ...]
    grips: tuple[Grip, ...]
    tabs: tuple[Tab, ...]
    reference: str
    compared: str
    top: float
    notes: tuple[str, ...]
