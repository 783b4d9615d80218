"""`Staging`: a placed walk with its figures, feet, handles and curves, ready to be compiled to a scene."""

from __future__ import annotations

from dataclasses import dataclass

from exo_pin.anatomy.names import SupportStyle
from exo_pin.arguments import number, word
from exo_pin.gait import Gait
from exo_pin.ground import STYLES, PlacedWalk
from exo_pin.robot import Robot
from exo_pin.short_repr import short_repr
from exo_pin.viewer.scenes.actor import Actor, DrawnSupport, Mount, ShownForces
from exo_pin.viewer.scenes.joint_plots import Tab
from exo_pin.viewer.scenes.scene import Handle, Key


@dataclass(frozen=True, eq=False)
class SceneOptions:
    """What a scene shows besides its walk.

    Attributes:
        title: Heading of the page.
        support: `"carried"`: the balance support moves the pelvis so that the standing foot stays on the
            ground; `"still"`: it holds the pelvis as in the paper.
        compare: A second walk, shown as a ghost, its curves dotted.
        compare_title: What the ghost is.
        notes: Sentences to print under the plots.
        speed: Playback speed at first; 1 is as it happened.
        beside: Whether the second walk is at first beside the first, on a treadmill of its own.

    Raises:
        UnknownNameError: There is no such support.
        DescriptionError: The speed is no positive number.
    """

    title: str = ""
    support: SupportStyle = "carried"
    compare: Gait | None = None
    compare_title: str = "compared"
    notes: tuple[str, ...] = ()
    speed: float = 1.0
    beside: bool = False

    __repr__ = short_repr

    def __post_init__(self) -> None:
        word("support", self.support, STYLES)
        number("speed", self.speed, above=0.0)


@dataclass(frozen=True, eq=False)
class Staging:
    """What a scene is compiled from.

    Attributes:
        robot: The first figure's robot.
        gait: Times and events of the walk.
        walk: The walk on its ground.
        actors: The figures, the robot first.
        mounts: Left and right foot: where the green soles hang.
        handles: Feet that can be dragged.
        tabs: The curves.
        reference: What the dashed curves are, or empty.
        compared: What the dotted curves are, or empty.
        top: How far the picture reaches above the robot's root [m].
        notes: What to know about the picture, in sentences.
        stand: The balance support, if the device has one.
        forces: Forces and torques in the picture, if they are known.
        keys: Further entries of the legend.
    """

    robot: Robot
    gait: Gait
    walk: PlacedWalk
    actors: tuple[Actor, ...]
    mounts: tuple[Mount, ...]
    handles: tuple[Handle, ...]
    tabs: tuple[Tab, ...]
    reference: str
    compared: str
    top: float
    notes: tuple[str, ...]
    stand: DrawnSupport | None = None
    forces: ShownForces | None = None
    keys: tuple[Key, ...] = ()
