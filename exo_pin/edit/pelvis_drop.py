"""Lowering of the pelvis where the legs do not reach the feet: by how much, and along a smooth curve."""

from __future__ import annotations

import numpy as np

from exo_pin.anatomy import FEET
from exo_pin.arrays import Array
from exo_pin.robot import Robot

_SMOOTHING = 0.12
"""The pelvis is lowered within this time before it must be [s], and raised within as much after."""

_LARGEST_DROP = 0.10
"""The pelvis is lowered by no more than this [m]."""

_SAME_LENGTH = 1e-4
"""A leg that is longer than before by no more than this [m] counts as equally long."""


def drop(robot: Robot, feet: tuple[Array, Array], base: tuple[Array, Array], slack: float) -> Array:
    """The drop of the pelvis in each sample that lets both legs reach their feet.

    A leg may be as long as it was in that sample, or as its reach less the slack, whichever is longer.

    Args:
        robot: The robot; feet without a leg of six joints require no drop.
        feet: Poses `(n, 2, 4, 4)` before and after the edit [m].
        base: T_world_pelvis `(n, 4, 4)` before and after it.
        slack: Reach that a leg keeps in reserve, so that its knee stays bent [m].

    Returns:
        `(n,)` drops, at most 0.10 m [m].
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
        longest = np.maximum(np.linalg.norm(old, axis=1) + _SAME_LENGTH, leg.reach - slack)
        within = longest**2 - new[:, 0] ** 2 - new[:, 1] ** 2
        down = np.where(within > 0, -new[:, 2] - np.sqrt(np.maximum(within, 0.0)), _LARGEST_DROP)
        needed = np.maximum(needed, np.where(np.linalg.norm(new, axis=1) > longest, down, 0.0))
    return np.clip(needed, 0.0, _LARGEST_DROP)


def smoothed(needed: Array, step: float, periodic: bool) -> Array:
    """A smooth curve `(n,)` nowhere below the needed drop: a moving maximum, then a weighted moving average.

    Args:
        needed: `(n,)` drops [m].
        step: Time between samples [s].
        periodic: Whether the samples are a cycle.
    """
    half = min(max(round(_SMOOTHING / step), 1), len(needed) - 1)
    window = np.hanning(2 * half + 3)[1:-1]
    wide = np.lib.stride_tricks.sliding_window_view(_around(needed, half, periodic), 2 * half + 1).max(axis=1)
    return np.asarray(np.convolve(_around(wide, half, periodic), window / window.sum(), "valid"))


def _around(y: Array, half: int, periodic: bool) -> Array:
    """The curve with `half` samples more on either side: of the next cycle, or the end sample repeated."""
    return np.pad(y, half, mode="wrap") if periodic else np.pad(y, half, mode="edge")
