"""How far the pelvis must come down for the legs to reach, and how it does so without a jolt."""

from __future__ import annotations

import numpy as np

from exo_pin.anatomy import FEET
from exo_pin.arrays import Array
from exo_pin.robot import Robot

SOFTLY = 0.12
"""The pelvis comes down within this time before it must [s], and goes up within as much after."""

DEEPEST = 0.10
"""It comes down no further than this [m]."""

SAME = 1e-4
"""A leg that is this much longer than it was [m] is as long as it was."""


def drop(robot: Robot, feet: tuple[Array, Array], base: tuple[Array, Array], slack: float) -> Array:
    """How far the pelvis must come down in each sample for both legs to reach.

    A leg may be as long as it was in that sample, or as its reach less the slack, whichever is longer.

    Args:
        robot: The robot; feet that no leg of six joints carries ask for nothing.
        feet: Poses `(n, 2, 4, 4)` before and after the edit [m].
        base: T_world_pelvis `(n, 4, 4)` before and after it.
        slack: What a leg keeps of its reach, so that its knee stays bent [m].

    Returns:
        `(n,)` heights, at most `DEEPEST` [m].
    """
    needed = np.zeros(len(base[0]))
    for k, foot in enumerate(FEET):
        leg = robot.leg(foot)
        if leg is None:
            continue
        hip = np.linalg.inv(robot.placement)[:3] @ [*leg.hip, 1.0]  # in the pelvis
        old, new = (
            T[:, k, :3, :3] @ leg.ankle_in_frame + T[:, k, :3, 3] - B[:, :3, :3] @ hip - B[:, :3, 3]
            for T, B in zip(feet, base, strict=True)
        )
        longest = np.maximum(np.linalg.norm(old, axis=1) + SAME, leg.reach - slack)
        within = longest**2 - new[:, 0] ** 2 - new[:, 1] ** 2
        down = np.where(within > 0, -new[:, 2] - np.sqrt(np.maximum(within, 0.0)), DEEPEST)
        needed = np.maximum(needed, np.where(np.linalg.norm(new, axis=1) > longest, down, 0.0))
    return np.clip(needed, 0.0, DEEPEST)


def softened(needed: Array, step: float, periodic: bool) -> Array:
    """The lowest smooth course `(n,)` that is nowhere less than needed: its bumps widened, then averaged.

    Args:
        needed: `(n,)` heights [m].
        step: Time between samples [s].
        periodic: Whether the samples are a cycle.
    """
    half = min(max(round(SOFTLY / step), 1), len(needed) - 1)
    window = np.hanning(2 * half + 3)[1:-1]
    wide = np.lib.stride_tricks.sliding_window_view(_around(needed, half, periodic), 2 * half + 1).max(axis=1)
    return np.asarray(np.convolve(_around(wide, half, periodic), window / window.sum(), "valid"))


def _around(y: Array, half: int, periodic: bool) -> Array:
    """The course with `half` samples more on either side: of the next cycle, or the last one again."""
    return np.pad(y, half, mode="wrap") if periodic else np.pad(y, half, mode="edge")
