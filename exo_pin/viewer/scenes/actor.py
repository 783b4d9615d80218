"""The figures on the stage: the exoskeleton, its ghost, its wearer, each with drawings and samples."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from exo_pin.arrays import Array
from exo_pin.gait import Gait
from exo_pin.gait.heading import mean_heading
from exo_pin.gait.rigid_poses import about
from exo_pin.ground.placement import Placement, motion
from exo_pin.robot import Robot
from exo_pin.viewer.drawing_commands import Command, Material
from exo_pin.viewer.scenes.link_nodes import Linkage, linkage
from exo_pin.viewer.scenes.scene import Chain, Group
from exo_pin.viewer.scenes.toes import toes

GHOST = Material((0.36, 0.30, 0.55, 0.30), 0.6, 0.0, more=(("depthWrite", False),))
"""A second motion is a translucent violet: neither leg's colour."""


@dataclass(frozen=True, eq=False)
class Actor:
    """A figure that the page poses.

    Attributes:
        commands: What draws it.
        chain: How it is posed; names its arrays.
        arrays: Its samples, `(n, ...)`.
        group: What switches it on and off.
        twins: Nodes that show the same as another: (path, source).
    """

    commands: tuple[Command, ...]
    chain: Chain
    arrays: Mapping[str, Array]
    group: Group
    twins: tuple[tuple[str, str], ...] = ()


def exoskeleton(robot: Robot, shown: Placement, tree: Linkage) -> Actor:
    """The exoskeleton in the shown motion."""
    chain = Chain("exo", tree.root, tree.links, tree.turns, "q", "base")
    return Actor(tree.commands, chain, samples(robot, shown, tree, ""), Group("Exoskeleton", tree.looks))


def ghost(robot: Robot, gait: Gait, style: str, root: str, title: str) -> Actor:
    """A second motion of the same exoskeleton, on the clock of the first (see `aligned`)."""
    shown = motion(robot, gait, style)
    tree = linkage(robot.urdf, root, paint=GHOST)
    chain = Chain("ghost", tree.root, tree.links, tree.turns, "ghost_q", "ghost_base")
    return Actor(
        tree.commands, chain, samples(robot, shown, tree, "ghost_"), Group(f"Ghost: {title}", tree.looks)
    )


def aligned(gait: Gait, other: Gait) -> Gait:
    """Another gait sampled on a gait's clock.

    Cycles are laid over each other from left heel strike to left heel strike, whatever their durations;
    recordings run side by side from their starts, the shorter one waiting at its end. The other pelvis starts
    where the gait's does and heads the same way, wherever in its laboratory it was recorded.
    """
    n = len(gait)
    if gait.periodic and other.periodic:
        fitted = other.slowed(gait.duration / other.duration).resampled(n)
        shift = round(n * (_strike(gait) - _strike(other)))
        base = None if fitted.base is None else _brought(gait, np.roll(fitted.base, shift, axis=0))
        return Gait(
            gait.time, np.roll(fitted.q, shift, axis=0), base=base, periodic=True, source=other.source
        )
    step = gait.duration / (n if gait.periodic else n - 1)
    even = other.resampled(max(round(other.duration / step) + 1, 2))
    rows = np.minimum(np.arange(n), len(even) - 1)
    base = None if even.base is None else _brought(gait, even.base[rows])
    return Gait(gait.time, even.q[rows], base=base, source=other.source)


def in_step(gait: Gait, other: Gait) -> str:
    """How `aligned` has laid another gait over the first, in words."""
    if gait.periodic and other.periodic:
        return "The ghost's cycle is laid over the walk's, from left heel strike to left heel strike."
    return "The ghost starts together with the walk, whatever its phase, and waits at its end."


def _brought(gait: Gait, base: Array) -> Array:
    """The base poses `(n, 4, 4)` turned about the vertical and shifted level to a gait's own start."""
    own = np.eye(4)[None] if gait.base is None else gait.base
    (x, y), (u, v) = mean_heading(own), mean_heading(base)
    T = np.eye(4)
    T[:3, :3] = about((0.0, 0.0, 1.0), np.arctan2(y * u - x * v, x * u + y * v))
    T[:2, 3] = own[0, :2, 3] - T[:2, :2] @ base[0, :2, 3]
    return np.asarray(T @ base)


def flat_poses(T: Array) -> Array:
    """Poses `(n, 4, 4)` as `(n, 7)`: x y z [m], unit quaternion x y z w that never jumps to its negative."""
    rows = np.array([pin.SE3ToXYZQUAT(pin.SE3(pose)) for pose in T])
    turned = np.einsum("nk,nk->n", rows[1:, 3:], rows[:-1, 3:]) < 0
    rows[1:, 3:] *= np.cumprod(np.where(turned, -1.0, 1.0))[:, None]
    return rows


def samples(robot: Robot, shown: Placement, tree: Linkage, prefix: str) -> dict[str, Array]:
    """The arrays of a chain: joint values in the order of its turns, and base poses."""
    angles = dict(zip(robot.joints, shown.q.T, strict=True))
    if robot.body is not None:  # a gait has no toe angles
        most = {turn.name: turn.limits[1] for turn in tree.turns if turn.limits is not None}
        angles |= {toe: np.minimum(q, most.get(toe, 0.0)) for toe, q in toes(robot.body, shown).items()}
    still = np.zeros(len(shown.time))
    q = np.stack([angles.get(turn.name, still) for turn in tree.turns], axis=1)
    return {f"{prefix}q": q, f"{prefix}base": flat_poses(shown.base)}


def _strike(gait: Gait) -> float:
    """Where in the cycle the left heel strikes, 0 to 1; 0 if nothing is known."""
    times = [event.time for event in gait.events if (event.side, event.kind) == ("left", "heel_strike")]
    return (times[0] - float(gait.time[0])) / gait.duration if times else 0.0
