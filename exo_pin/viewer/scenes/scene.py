"""What the page is told: a `Scene` and its parts, plain values without behaviour."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from exo_pin.anatomy.names import Base, Side
from exo_pin.viewer.drawing_commands import Command
from exo_pin.viewer.scenes.link_nodes import Turn

if TYPE_CHECKING:
    from exo_pin.robot import Robot

Interval = tuple[float, float]
"""From, to [s] on the page's clock, which starts at 0."""


@dataclass(frozen=True)
class Chain:
    """A figure that the page poses by itself.

    Attributes:
        name: What it is, e.g. `"exo"`.
        root: Path of its base.
        links: Link name -> path of the node with that link's pose.
        joints: The joints, in the order of the columns of the array `q`.
        q: Name of the array of joint values, `(n, joints)` [rad, m].
        base: Name of the array of base poses, `(n, 7)`: x y z [m], quaternion x y z w.
    """

    name: str
    root: str
    links: Mapping[str, str]
    joints: tuple[Turn, ...]
    q: str
    base: Base


@dataclass(frozen=True)
class PhaseCycles:
    """The gait cycles in which phase is counted: whose heel strikes cut them, from and to [s].

    `side` is empty where no foot has a cycle, or a periodic walk has no heel strikes. The cycles of a
    periodic walk reach over its ends.
    """

    side: Side
    spans: tuple[Interval, ...]


@dataclass(frozen=True)
class Series:
    """One curve of a plot: a side, its column, its limits in the array's own unit."""

    side: Side
    column: int
    lower: float
    upper: float


@dataclass(frozen=True)
class Plot:
    """One plot: values are shown times `factor`, in `unit`, with `digits` decimals.

    `least` is the smallest range of the axis, so that a still joint does not look restless.
    """

    title: str
    series: tuple[Series, ...]
    factor: float
    unit: str
    digits: int
    least: float


@dataclass(frozen=True)
class PlotGroup:
    """One tab of plots: the arrays that it shows (solid, dashed, dotted) and its plots."""

    title: str
    values: str
    reference: str
    compared: str
    plots: tuple[Plot, ...]


@dataclass(frozen=True)
class Group:
    """Something that can be shown or hidden: its name for people and its nodes."""

    title: str
    paths: tuple[str, ...]
    shown: bool = True


@dataclass(frozen=True)
class Grip:
    """A foot that can be taken by the hand: its link (or frame) in the first chain, and its side."""

    link: str
    side: Side


@dataclass(frozen=True)
class Belt:
    """The treadmill's belt: node of the slats, their distance [m], speed backwards [m/s]."""

    path: str
    pitch: float
    speed: float


@dataclass(frozen=True)
class Marks:
    """Nodes that the page moves: centre of mass, its projection (at `height`), contact soles, belt."""

    com: str
    ground: str
    height: float
    contact: Mapping[str, str]
    belt: Belt | None


@dataclass(frozen=True)
class Box:
    """What a camera has to frame [m]."""

    center: tuple[float, float, float]
    size: tuple[float, float, float]


@dataclass(frozen=True)
class Facts:
    """All that the page knows besides drawings and samples.

    Attributes:
        title: Heading.
        subtitle: Where the walk comes from.
        notes: What the viewer must know about the picture, in sentences.
        duration: Length of the walk [s].
        start: The gait's own time at the page's 0 [s].
        periodic: Whether the last frame leads back to the first.
        cycles: The gait cycles, for the phase.
        stance: Side -> intervals on the ground.
        contact: How contact was found, for the legend.
        reference: What the dashed curves are, or empty.
        compared: What the dotted curves are, or empty.
        chains: The figures.
        grips: The feet of the first figure that can be dragged.
        plots: The tabs of plots.
        groups: What can be shown or hidden.
        marks: What moves besides the figures.
        boxes: `whole` and `feet`, for the cameras.
        follow: Whether the cameras go along with the pelvis.
        speed: Playback speed at first, 1 = as it happened.
        twins: Nodes that show the same as another: (path, source).
        shadowless: Paths that cast no shadow.
        lights: Light name -> intensity without the studio's environment.
    """

    title: str
    subtitle: str
    notes: tuple[str, ...]
    duration: float
    start: float
    periodic: bool
    cycles: PhaseCycles
    stance: Mapping[str, tuple[Interval, ...]]
    contact: str
    reference: str
    compared: str
    chains: tuple[Chain, ...]
    grips: tuple[Grip, ...]
    plots: tuple[PlotGroup, ...]
    groups: tuple[Group, ...]
    marks: Marks
    boxes: Mapping[str, Box]
    follow: bool
    speed: float
    twins: tuple[tuple[str, str], ...]
    shadowless: tuple[str, ...]
    lights: Mapping[str, float]


@dataclass(frozen=True, eq=False)
class Scene:
    """A walk ready to be shown: no transport, no browser, only values.

    Attributes:
        facts: What the page knows.
        commands: What draws it, in order (meshcat's protocol).
        arrays: Samples by name, each `(n, ...)`, float32 (times float64).
        robot: Of the first figure; the live viewer asks its inverse kinematics. None: nobody answers.
    """

    facts: Facts
    commands: tuple[Command, ...]
    arrays: Mapping[str, NDArray[np.floating[Any]]]
    robot: Robot | None = None

    @property
    def title(self) -> str:
        """The heading."""
        return self.facts.title
