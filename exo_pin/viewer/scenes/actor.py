"""`Actor`: a figure that the page poses, with its drawings and samples; a stand and forces likewise."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from exo_pin.arrays import Array
from exo_pin.robot.floating_base import base_coordinates
from exo_pin.viewer.drawing_commands import Command, Material
from exo_pin.viewer.scenes.scene import Bar, Box, Chain, ForceMarks, Group, Key

GHOST = Material((0.36, 0.30, 0.55, 0.30), 0.6, 0.0, more=(("depthWrite", False),))
"""A second walk is a translucent violet: neither leg's colour."""


@dataclass(frozen=True, eq=False)
class Actor:
    """A figure that the page poses.

    Attributes:
        commands: What draws it.
        chain: How it is posed; names its arrays.
        arrays: Its samples, `(n, ...)`.
        group: What switches it on and off.
        twins: Nodes that show the same as another: (path, source).
        painted: Nodes that show the shape of another, painted as a ghost: (path, source).
    """

    commands: tuple[Command, ...]
    chain: Chain
    arrays: Mapping[str, Array]
    group: Group
    twins: tuple[tuple[str, str], ...] = ()
    painted: tuple[tuple[str, str], ...] = ()


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


@dataclass(frozen=True, eq=False)
class DrawnSupport:
    """A balance support.

    Attributes:
        commands: What draws its still parts and its bars.
        bars: What reaches from it to the pelvis.
        group: What switches it on and off.
        frame: What a camera has to frame.
    """

    commands: tuple[Command, ...]
    bars: tuple[Bar, ...]
    group: Group
    frame: Box


@dataclass(frozen=True, eq=False)
class ShownForces:
    """Forces as the page draws them.

    Attributes:
        marks: What moves, by which samples.
        arrays: The samples.
        groups: What can be switched off.
        keys: Entries of the legend.
    """

    marks: ForceMarks
    arrays: Mapping[str, Array]
    groups: tuple[Group, ...]
    keys: tuple[Key, ...]


def chain_samples(chain: Chain, angles: Mapping[str, Array], base: Array) -> dict[str, Array]:
    """The samples that pose a chain, under the names that the chain gives them.

    Args:
        chain: The figure's joints.
        angles: Joint -> `(n,)` values [rad, m]; a joint without values stays at zero.
        base: `(n, 4, 4)` pose of its base.
    """
    still = np.zeros(len(base))
    q = np.stack([angles.get(joint.name, still) for joint in chain.joints], axis=1)
    return {chain.q: q, chain.base: flat_poses(base)}


def flat_poses(T: Array) -> Array:
    """Poses `(n, 4, 4)` as `(n, 7)`: x y z [m], unit quaternion x y z w that never jumps to its negative."""
    rows = base_coordinates(T)
    flipped = np.einsum("nk,nk->n", rows[1:, 3:], rows[:-1, 3:]) < 0
    rows[1:, 3:] *= np.cumprod(np.where(flipped, -1.0, 1.0))[:, None]
    return rows
