"""Two-legged robots: the URDF of a target found and loaded, its legs and axes read."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from exo_pin import xacro_files
from exo_pin.arrays import Array
from exo_pin.errors import DescriptionError, UnknownNameError, same_name
from exo_pin.examples import located
from exo_pin.files import read_text
from exo_pin.plugins import plugin, plugin_names
from exo_pin.retarget import leg_search, target_file
from exo_pin.retarget.both_legs import on_their_branch, read_legs
from exo_pin.retarget.leg_search import NoPairError, Standing
from exo_pin.retarget.robot_legs import RobotLeg
from exo_pin.retarget.target_robots import TARGETS, UNFIT, Target
from exo_pin.robot import Robot, load_urdf, urdf_joints, urdf_tree
from exo_pin.robot.urdf_joints import Follower
from exo_pin.short_repr import short_repr

_UPWARD = ("z", "y", "x", "-z", "-y", "-x")
"""Axes of the root link that may point up, in the order in which they are tried."""


@dataclass(frozen=True, eq=False)
class Biped:
    """A robot with two legs to which a walk can be retargeted.

    Attributes:
        target: Its record.
        robot: The robot; its root stands at the origin.
        stand: Configuration (nq,) at which it stands.
        rotation: Rotation matrix (3, 3) from the walker's axes (x forward, y left, z up) to the root link's.
        legs: Left and right.
        follow: The joints that follow others (`<mimic>`), by name.
    """

    target: Target
    robot: Robot
    stand: Array
    rotation: Array
    legs: tuple[RobotLeg, RobotLeg]
    follow: Mapping[str, Follower] = field(default_factory=dict)

    __repr__ = short_repr

    @property
    def joints(self) -> tuple[str, ...]:
        """The joints of both legs, left first."""
        return self.legs[0].joints + self.legs[1].joints

    @property
    def joints_per_leg(self) -> int:
        """Number of joints of each leg."""
        return len(self.legs[0].joints)

    @property
    def hip_order(self) -> str:
        """The hip's axes from the pelvis outwards, in words."""
        return self.legs[0].hip_order


def find(target: str | Path | Target) -> Target:
    """The target of a name, or of a file (URDF, xacro, or a TOML record); a record is returned as it is.

    Raises:
        UnknownNameError: There is no such target.
        DescriptionError: Walks cannot be retargeted to it; the message has the reason.
        FormatError: The record is not accepted.
    """
    if isinstance(target, Target):
        return target
    path = Path(target)
    if str(target) in TARGETS:
        return TARGETS[str(target)]
    if str(target).lower() in UNFIT:
        raise DescriptionError(f"{target}: {UNFIT[str(target).lower()]}")
    if path.suffix.lower() == ".toml":
        return target_file.load(path)
    if path.suffix.lower() in (".urdf", ".xacro") or path.exists():
        return Target(path.name.partition(".")[0], path)
    same = same_name(str(target), TARGETS)
    if same is not None:
        return TARGETS[same]
    added = plugin("exo_pin.targets", str(target), Target)
    if added is None:
        known = (*TARGETS, *plugin_names("exo_pin.targets"))
        raise UnknownNameError("robot (a name, a .urdf, .xacro or .toml file)", str(target), known)
    return added


def load(target: str | Path | Target) -> Biped:
    """The target's robot, its base held at the origin.

    Raises:
        UnknownNameError: The target, a joint or a link of the record is unknown.
        DescriptionError: The URDF is missing or no robot with two legs.
        FormatError: The record is not accepted.
    """
    found = find(target)
    path = _packaged(found) if isinstance(found.file, str) else found.file
    return as_biped(found, load_urdf(_prepared(found, path), path=path))


def as_biped(target: Target, robot: Robot) -> Biped:
    """A loaded robot as a biped; feet and directions that its record lacks are found in its structure.

    Raises:
        UnknownNameError: A joint or link of the record is unknown.
        DescriptionError: It is no robot with two legs.
    """
    follow = urdf_joints.followers(robot.urdf)
    known = leg_search.standing(robot, _stand(target, robot, follow), target.locked)
    rotation, legs = _legs(target, known, follow)
    own = {name for leg in legs for name in leg.chain}
    others = [k for k, name in enumerate(robot.joints) if name not in own]
    columns = [robot.nq - len(robot.joints) + k for k in others]
    stand = known.stand.copy()
    stand[columns] = np.clip(stand[columns], robot.lower[others], robot.upper[others])
    return Biped(target, robot, stand, rotation, legs, follow)


def _legs(
    target: Target, known: Standing, follow: Mapping[str, Follower]
) -> tuple[Array, tuple[RobotLeg, RobotLeg]]:
    """The rotation (3, 3) from the walker's axes to the root link's, and the legs; any axis may point up."""
    refusals = []
    for up in (target.up,) if target.up else _UPWARD:
        try:
            rotation, legs = read_legs(known, follow, target.feet, target.forward, up)
        except NoPairError as error:
            refusals.append(error)
        else:
            return rotation, on_their_branch(legs)
    raise refusals[0]


def _stand(target: Target, robot: Robot, follow: Mapping[str, Follower]) -> Array:
    """The configuration (nq,) at which it stands, joints that cannot move at their limits."""
    stand = robot.q(target.stand)
    for name, low, high in zip(robot.joints, robot.lower, robot.upper, strict=True):
        if high <= low:
            stand[robot.column(name)] = low
    return followed(robot, stand, follow)


def followed(robot: Robot, q: Array, follow: Mapping[str, Follower]) -> Array:
    """Configurations (..., nq) with every follower where its leader takes it.

    Args:
        robot: The robot.
        q: Configurations (..., nq).
        follow: The joints that follow others, by name.
    """
    q = q.copy()
    for name, (leader, ratio, offset) in follow.items():
        if name in robot.joints and leader in robot.joints:
            q[..., robot.column(name)] = ratio * q[..., robot.column(leader)] + offset
    return q


def _packaged(target: Target) -> Path:
    """Path of the target's URDF in example-robot-data."""
    path = located(str(target.file))
    if path is None:
        raise DescriptionError(f"{target.name} needs example-robot-data, which has no {target.file} here")
    return path


def _prepared(target: Target, path: Path) -> str:
    """The URDF's text with the record's limits."""
    text = xacro_files.expanded(path) if path.suffix.lower() == ".xacro" else read_text(path)
    try:
        if "<" not in text:
            urdf_tree.parsed(text)  # refused: `load_urdf` would take it for the name of a file
        return urdf_joints.with_limits(text, target.limits) if target.limits else text
    except UnknownNameError:
        raise
    except DescriptionError as error:
        raise DescriptionError(f"{path}: {error}") from None
