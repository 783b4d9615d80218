"""Targets of retargeting: one record for each robot, its URDF from example-robot-data or from the user."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import radians
from pathlib import Path
from types import MappingProxyType

from exo_pin.arguments import names, number, real, table, text, word
from exo_pin.errors import DescriptionError
from exo_pin.retarget.axes import SIGNED_AXES
from exo_pin.short_repr import short_repr

Pair = tuple[float, float]


@dataclass(frozen=True, eq=False)
class Target:
    """A robot with two legs. Missing entries are derived from the robot's structure.

    Attributes:
        name: Its name for `retarget(..., robot=...)`.
        file: End of the URDF's path in example-robot-data, or the path of any URDF.
        feet: Links of the left and right foot; empty: the ends of the two legs that reach down.
        forward: Axis of the root link that points forward: `"x"`, `"-x"`, `"y"` ...; empty: it follows from
            which leg is left.
        up: Axis of the root link that points up; empty: away from the feet.
        stand: Joint angles [rad] at which the robot stands on straight legs with level feet; zero for others.
        limits: Joint limits [rad] that replace the file's.
        locked: Joints that are held as the robot stands.
        title: Full name of the robot.
        paint: Colour and opacity (RGBA) to draw it in; None: its own colours.
        licence: Owner and licence of its files, as example-robot-data states them.
        remarks: Known peculiarities of the robot or its files.

    Raises:
        DescriptionError: An entry is of a wrong kind, a number is not finite, or a lower limit is not below
            the upper one. Names of joints and links are looked up when the robot is loaded.
        UnknownNameError: An axis is none of `SIGNED_AXES`.
    """

    name: str
    file: str | Path
    feet: tuple[str, ...] = ()
    forward: str = ""
    up: str = ""
    stand: Mapping[str, float] = field(default_factory=dict)
    limits: Mapping[str, Pair] = field(default_factory=dict)
    locked: tuple[str, ...] = ()
    title: str = ""
    paint: tuple[float, float, float, float] | None = None
    licence: str = ""
    remarks: str = ""

    __repr__ = short_repr

    def __post_init__(self) -> None:
        for name in ("name", "title", "licence", "remarks"):
            text(name, getattr(self, name))
        if not isinstance(self.file, str | Path):
            raise DescriptionError(f"file is {self.file!r}; a path is accepted")
        names("locked", self.locked)
        if len(names("feet", self.feet)) not in (0, 2):
            raise DescriptionError(f"feet are {', '.join(self.feet)}; a left and a right link are accepted")
        for name, axis in (("forward", self.forward), ("up", self.up)):
            word(f"axis ({name})", axis, ("", *SIGNED_AXES))
        for joint, angle in table("stand", self.stand).items():
            number(f"stand of {joint}", angle)
        for joint, span in table("limits", self.limits).items():
            low, high = real(f"limits of {joint}", span, (2,)).tolist()
            number(f"upper limit of {joint}", high, above=low)
        if self.paint is not None:
            real("paint", self.paint, (4,))


def _both(limits: Mapping[str, Pair], mirrored: Mapping[str, Pair]) -> Mapping[str, Pair]:
    """Limits [deg] of a leg, by the end of the joint's name, for `LLEG_` and `RLEG_` [rad]."""
    found = {}
    for name, (low, high) in {**limits, **mirrored}.items():
        found[f"LLEG_{name}"] = (radians(low), radians(high))
        low, high = (-high, -low) if name in mirrored else (low, high)
        found[f"RLEG_{name}"] = (radians(low), radians(high))
    return MappingProxyType(found)


_TALOS = Target(
    "talos",
    "talos_data/robots/talos_reduced.urdf",
    feet=("leg_left_6_link", "leg_right_6_link"),
    title="TALOS (PAL Robotics)",
    licence="PAL Robotics, Apache-2.0",
)
_ROMEO = Target(
    "romeo",
    "romeo_description/urdf/romeo_small.urdf",
    feet=("l_ankle", "r_ankle"),
    stand=MappingProxyType(
        {"LShoulderPitch": 1.5, "RShoulderPitch": 1.5, "LElbowYaw": -0.4, "RElbowYaw": 0.4}
    ),
    title="Romeo (Aldebaran)",
    licence="LAAS-CNRS, BSD",
)
_ICUB = Target(
    "icub",
    "icub_description/robots/icub_reduced.urdf",
    feet=("l_ankle_2", "r_ankle_2"),
    forward="-x",
    title="iCub (IIT)",
    licence="robotology's icub-models, CC-BY-SA-4.0",
)
_G1 = Target(
    "g1",
    "g1_description/urdf/g1_29dof_rev_1_0.urdf",
    feet=("left_ankle_roll_link", "right_ankle_roll_link"),
    title="G1 (Unitree)",
    licence="Unitree, BSD-3-Clause",
    remarks="The hip's roll and yaw axes are inclined by 10 degrees and its three axes do not meet.",
)
_SIMPLE_HUMANOID = Target(
    "simple_humanoid",
    "simple_humanoid_description/urdf/simple_humanoid.urdf",
    limits=_both(
        {"HIP_P": (-120.0, 40.1), "KNEE": (0.0, 150.0), "ANKLE_P": (-72.8, 39.0)},
        {"HIP_Y": (-20.0, 90.0), "HIP_R": (-30.0, 30.0), "ANKLE_R": (-30.0, 30.0)},
    ),
    title="simple humanoid (Gepetto team)",
    licence="LAAS-CNRS, BSD-2-Clause",
    remarks="The file's leg limits have slipped from joint to joint (the left knee has -120 .. 40 degrees, "
    "both ankles 0 .. 150). Used instead: the file's own pairs of numbers at the joints where they fit and "
    "where TALOS has them, and +-30 degrees for hip and ankle roll. The file has no "
    "visuals: capsules are drawn.",
)
_HUMAN = Target(
    "human",
    "human_description/robots/human.urdf",
    feet=("left_foot", "right_foot"),
    up="y",
    paint=(0.80, 0.66, 0.56, 1.0),
    title="human_description (Gepetto team)",
    licence="Gepetto team, BSD-2-Clause",
    remarks="A person with ISB joints; its root link has y up, and its garish colours are not shown.",
)
_BOLT = Target(
    "bolt",
    "bolt_description/robots/bolt.urdf",
    feet=("FL_FOOT", "FR_FOOT"),
    title="Bolt (Open Dynamic Robot Initiative)",
    licence="Open Dynamic Robot Initiative, BSD-3-Clause",
    remarks="Three joints per leg and point feet: the feet's places are met, their attitude is not; without "
    "hip rotation and ankles, these are dropped.",
)

TARGETS: Mapping[str, Target] = MappingProxyType(
    {t.name: t for t in (_TALOS, _ROMEO, _ICUB, _G1, _SIMPLE_HUMANOID, _HUMAN, _BOLT)}
)
"""Every target by name."""

UNFIT: Mapping[str, str] = MappingProxyType(
    {
        "cassie": "example-robot-data has Cassie as SDF alone, its legs as closed loops with springs (rods "
        "from the hip to the tarsus); a URDF cannot hold loops, and cut open the legs would not be Cassie's. "
        "An open-chain URDF of it can be given as a file",
    }
)
"""Robots that a user might expect, and the reason why they are not among `TARGETS`."""
