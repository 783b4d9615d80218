"""`Scene`: everything that the page needs to show a walk, as plain values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from exo_pin.anatomy.names import Side
from exo_pin.short_repr import short_repr
from exo_pin.viewer.drawing_commands import Command

if TYPE_CHECKING:
    from exo_pin.robot import Robot

ROOT = "/exo_pin"
"""Path of the node below which all others of a scene hang."""

Interval = tuple[float, float]
"""From, to [s] on the page's clock, which starts at 0."""

PlotSide = Literal["left", "right", "middle"]
"""Side of a joint; `"middle"`: a joint of the trunk."""


@dataclass(frozen=True)
class JointNode:
    """A moving joint in the page.

    Attributes:
        name: The joint's name.
        path: The node that rotates or slides.
        axis: Unit axis in the joint's frame.
        kind: `"revolute"` or `"prismatic"`.
        limits: Lower and upper limit [rad, m] for a slider in the page, or None: no slider.
        side: Side for the slider's colour; empty: what the joint's name begins with.
    """

    name: str
    path: str
    axis: tuple[float, float, float]
    kind: Literal["revolute", "prismatic"]
    limits: tuple[float, float] | None = None
    side: Side | Literal[""] = ""


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
    joints: tuple[JointNode, ...]
    q: str
    base: str


@dataclass(frozen=True)
class PhaseCycles:
    """The gait cycles in which phase is counted: side of the heel strikes between them, from and to [s].

    `side` is empty where no foot has a cycle, or a periodic walk has no heel strikes. The cycles of a
    periodic walk and estimated ones reach over its ends. `estimate` is what estimated cycles come from; empty
    for whole ones.
    """

    side: Side | Literal[""]
    spans: tuple[Interval, ...]
    estimate: str = ""


@dataclass(frozen=True)
class Series:
    """One curve of a plot: a side, its column, its limits in the array's own unit."""

    side: PlotSide
    column: int
    lower: float
    upper: float


@dataclass(frozen=True)
class Plot:
    """One plot: values are shown times `factor`, in `unit`, with `digits` decimals.

    `least` is the smallest range of the axis, so that a still joint does not look restless; `sign` is what a
    positive value means, empty where the title says it.
    """

    title: str
    series: tuple[Series, ...]
    factor: float
    unit: str
    digits: int
    least: float
    sign: str


@dataclass(frozen=True)
class PlotGroup:
    """One tab of plots: the arrays that it shows (solid, dashed, dotted) and its plots.

    `dashes` is what the dashed curves are, where they are not the walk's reference; `low` and `high` are the
    arrays of the normal band, empty where there is none.
    """

    title: str
    values: str
    reference: str
    compared: str
    plots: tuple[Plot, ...]
    dashes: str = ""
    low: str = ""
    high: str = ""


@dataclass(frozen=True)
class Group:
    """Something that can be shown or hidden: its name for people and its nodes."""

    title: str
    paths: tuple[str, ...]
    shown: bool = True


@dataclass(frozen=True)
class Handle:
    """A foot that can be dragged: its link (or frame) in the first chain, and its side."""

    link: str
    side: Side


@dataclass(frozen=True)
class Belt:
    """The treadmill's belt: nodes of the slats, their distance [m], speed backwards [m/s]."""

    paths: tuple[str, ...]
    pitch: float
    speed: float


@dataclass(frozen=True)
class Marks:
    """Nodes that the page moves: centre of mass, its projection (at `height`), contact soles, belt."""

    com: str
    ground: str
    height: float
    contact: Mapping[Side, str]
    belt: Belt | None


@dataclass(frozen=True)
class Beside:
    """Where the ghost walks beside the first figure.

    Attributes:
        chains: Names of its chain and of its wearer's.
        aside: Shift to the left [m].
        path: Of its own treadmill; empty over ground.
        shown: Whether it is there at first.
    """

    chains: tuple[str, ...]
    aside: float
    path: str
    shown: bool


@dataclass(frozen=True)
class Bar:
    """A bar along z of its node, 1 m long, that the page lays between two points [m].

    Attributes:
        path: Of its node.
        start: In the room.
        end: In the axes of the pelvis.
    """

    path: str
    start: tuple[float, float, float]
    end: tuple[float, float, float]


@dataclass(frozen=True)
class Arrow:
    """A force: its node, arrays of the force `(n, 3)` [N] and of where it acts `(n, 3)` [m], a CSS colour."""

    path: str
    force: str
    point: str
    color: str


@dataclass(frozen=True)
class Arc:
    """The torque of a joint, as an arc around its axis.

    Attributes:
        path: Of its node.
        cap: Path of the node for the disc that shows the motor's load.
        axis: Unit axis in the axes of the node.
        middle: Where on the axis its centre lies, at the outer face of the motor [m]; 0: no motor is there.
        radius: Of the arc [m].
        column: Of its torque and load.
    """

    path: str
    cap: str
    axis: tuple[float, float, float]
    middle: float
    radius: float
    column: int


@dataclass(frozen=True)
class ForceMarks:
    """Forces and torques in the picture.

    Attributes:
        arrows: The forces.
        length: Of an arrow [m/N].
        arcs: The torques.
        torque: Name of their array `(n, 12)` [N m].
        scale: Of an arc [N m/degree].
        load: Name of the array of motors' loads `(n, 12)`, 0 to 1; empty: not shown.
    """

    arrows: tuple[Arrow, ...]
    length: float
    arcs: tuple[Arc, ...]
    torque: str
    scale: float
    load: str


@dataclass(frozen=True)
class Key:
    """An entry of the legend: its name, a CSS colour, and what it means in a sentence."""

    title: str
    color: str
    hint: str = ""


@dataclass(frozen=True)
class Box:
    """What a camera has to frame [m]."""

    center: tuple[float, float, float]
    size: tuple[float, float, float]


@dataclass(frozen=True)
class Facts:
    """The header of a scene: all that the page needs besides drawings and samples.

    Attributes:
        title: Heading.
        subtitle: Who walks in what, for how long.
        notes: What people must know about the picture, in sentences.
        duration: Length of the walk [s].
        start: The gait's own time at the page's 0 [s].
        periodic: Whether the last frame leads back to the first.
        cycles: The gait cycles, for the phase.
        stance: Side -> intervals on the ground.
        contact: How contact was found, for the legend.
        reference: What the dashed curves are, or empty.
        compared: What the dotted curves are, or empty.
        chains: The figures.
        handles: The feet of the first figure that can be dragged.
        plots: The tabs of plots.
        groups: What can be shown or hidden.
        marks: What moves besides the figures.
        beside: Where the ghost may walk; None: there is none.
        bars: Of the balance support.
        forces: Forces and torques in the picture; None: they are not known.
        keys: Further entries of the legend.
        boxes: `whole`, `feet` and, if there is one, `treadmill`, for the cameras.
        follow: Whether the cameras go along with the pelvis.
        speed: Playback speed at first, 1 = as it happened.
        twins: Nodes that show the same as another: (path, source).
        painted: Nodes that show the shape of another in `paint`: (path, source).
        paint: The ghost's surface, as three.js reads it.
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
    stance: Mapping[Side, tuple[Interval, ...]]
    contact: str
    reference: str
    compared: str
    chains: tuple[Chain, ...]
    handles: tuple[Handle, ...]
    plots: tuple[PlotGroup, ...]
    groups: tuple[Group, ...]
    marks: Marks
    beside: Beside | None
    bars: tuple[Bar, ...]
    forces: ForceMarks | None
    keys: tuple[Key, ...]
    boxes: Mapping[str, Box]
    follow: bool
    speed: float
    twins: tuple[tuple[str, str], ...]
    painted: tuple[tuple[str, str], ...]
    paint: Mapping[str, Any]
    shadowless: tuple[str, ...]
    lights: Mapping[str, float]


@dataclass(frozen=True, eq=False)
class Scene:
    """A walk ready to be shown: no transport, no browser, only values.

    Attributes:
        facts: The header.
        commands: What draws it, in order (meshcat's protocol).
        arrays: Samples by name, each `(n, ...)`, float32 (times float64).
        robot: The first figure's, for inverse kinematics in the live viewer. None: the page uses its own.
    """

    facts: Facts
    commands: tuple[Command, ...]
    arrays: Mapping[str, NDArray[np.floating[Any]]]
    robot: Robot | None = None

    __repr__ = short_repr

    @property
    def title(self) -> str:
        """The heading."""
        return self.facts.title
