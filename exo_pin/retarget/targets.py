"""Robots to retarget to: one record each, their URDFs from example-robot-data."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path
from types import MappingProxyType

from exo_pin.errors import DescriptionError, UnknownNameError
from exo_pin.robot import Robot, load_urdf


@dataclass(frozen=True, eq=False)
class Target:
    """A humanoid.

    Attributes:
        name: What `retarget(..., robot=...)` calls it.
        file: End of the URDF's path in example-robot-data.
        left: Joints of the left leg from the hip outwards: three of the hip, knee, two of the ankle.
        right: The same of the right leg.
        feet: Links of the left and right foot; at zero they stand level.
        hip_order: Order of the hip joints, `"clinical"` or `"yaw_roll_pitch"`.
        backward: Whether the robot's base has x to the back.
        remarks: What to know.
    """

    name: str
    file: str
    left: tuple[str, ...]
    right: tuple[str, ...]
    feet: tuple[str, str]
    hip_order: str
    backward: bool = False
    remarks: str = ""


def _named(pattern: str, *parts: str) -> tuple[str, ...]:
    return tuple(pattern.format(part) for part in parts)


_PARTS = ("HipYaw", "HipRoll", "HipPitch", "KneePitch", "AnklePitch", "AnkleRoll")
_SNAKE = ("hip_pitch", "hip_roll", "hip_yaw", "knee", "ankle_pitch", "ankle_roll")

TALOS = Target(
    name="talos",
    file="talos_data/robots/talos_reduced.urdf",
    left=_named("leg_left_{}_joint", *"123456"),
    right=_named("leg_right_{}_joint", *"123456"),
    feet=("leg_left_6_link", "leg_right_6_link"),
    hip_order="yaw_roll_pitch",
)
ROMEO = Target(
    name="romeo",
    file="romeo_description/urdf/romeo_small.urdf",
    left=_named("L{}", *_PARTS),
    right=_named("R{}", *_PARTS),
    feet=("l_ankle", "r_ankle"),
    hip_order="yaw_roll_pitch",
)
ICUB = Target(
    name="icub",
    file="icub_description/robots/icub_reduced.urdf",
    left=_named("l_{}", *_SNAKE),
    right=_named("r_{}", *_SNAKE),
    feet=("l_ankle_2", "r_ankle_2"),
    hip_order="clinical",
    backward=True,
)
G1 = Target(
    name="g1",
    file="g1_description/urdf/g1_29dof_rev_1_0.urdf",
    left=_named("left_{}_joint", *_SNAKE),
    right=_named("right_{}_joint", *_SNAKE),
    feet=("left_ankle_roll_link", "right_ankle_roll_link"),
    hip_order="clinical",
    remarks="The hip axes are inclined and do not meet: joint by joint is only near.",
)

TARGETS: Mapping[str, Target] = MappingProxyType({t.name: t for t in (TALOS, ROMEO, ICUB, G1)})
"""Every target by name."""


def find(target: str | Target) -> Target:
    """The target of that name; a record is handed back.

    Raises:
        UnknownNameError: There is none.
    """
    if isinstance(target, Target):
        return target
    if target not in TARGETS:
        raise UnknownNameError("robot to retarget to", target, TARGETS)
    return TARGETS[target]


def load(target: str | Target) -> Robot:
    """The target's robot, its base held.

    Raises:
        UnknownNameError: The target is unknown.
        DescriptionError: example-robot-data does not have it.
    """
    found = find(target)
    try:
        files = distribution("example-robot-data").files or []
    except PackageNotFoundError:
        raise DescriptionError(f"{found.name} comes with example-robot-data; install it") from None
    for file in files:
        if str(file).endswith(f"/{found.file}"):
            return load_urdf(Path(str(file.locate())))
    raise DescriptionError(f"example-robot-data has no {found.file}")
