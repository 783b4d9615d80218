"""Doubts whether the markers of a trial were understood: misfit, sides interchanged, joints beyond range."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from exo_pin.anatomy import JOINTS
from exo_pin.anatomy.sizes import DEFAULT_LIMITS
from exo_pin.arrays import Array
from exo_pin.kinematics import poses
from exo_pin.robot import Robot

_FITTING = 0.03
"""Markers further from their body [m, root mean square] are doubted: OpenSim's users ask for less than 0.02,
and the recordings at hand have 0.005 to 0.010."""

_MARGIN = np.radians(5.0)
"""How far beyond its usual limits a joint may be for a while [rad] ..."""

_SHARE = 0.1
"""... namely in this part of the frames ..."""

_FAR = np.radians(15.0)
"""... and how far it may be at no time."""


def misfit_doubts(rms: float, by_marker: Mapping[str, float]) -> tuple[str, ...]:
    """Doubts by the distances of the markers from the body.

    Args:
        rms: Over all markers and frames [m].
        by_marker: Marker -> its root mean square error [m].
    """
    if rms < _FITTING:
        return ()
    worst = ", ".join(sorted(by_marker, key=lambda name: -by_marker[name])[:3])
    return (
        f"markers lie {1e3 * rms:.0f} mm (RMS) from the body, {worst} furthest: "
        "markers or sides interchanged, or an axis mirrored?",
    )


def side_doubts(robot: Robot, q: Array) -> tuple[str, ...]:
    """Doubts by where pelvis and feet are.

    Args:
        robot: The person, with a floating base.
        q: `(n, nq)` the walk.
    """
    T = poses(robot, q, ["pelvis", "left_sole_plate", "right_sole_plate"])
    found = []
    if np.median(T[:, 0, 2, 2]) < 0:
        found.append("the pelvis is upside down: its left and right markers interchanged?")
    left = T[:, 0, :3, 1] * np.sign(np.median(T[:, 0, 2, 2]))
    apart = np.einsum("ni,ni->n", left, T[:, 1, :3, 3] - T[:, 2, :3, 3])
    if np.median(apart) < 0:
        found.append("the left foot is on the right of the right one: left and right markers interchanged?")
    return tuple(found)


def range_doubts(q: Array) -> tuple[str, ...]:
    """Doubts by joints that leave what they do in a walk.

    Args:
        q: `(n, 12)` angles in the order of `JOINTS` [rad].
    """
    found = []
    for k, joint in enumerate(JOINTS):
        low, high = DEFAULT_LIMITS[joint]
        beyond = np.maximum(low - q[:, k], q[:, k] - high)
        share = float((beyond > _MARGIN).mean())
        if share > _SHARE or beyond.max() > _FAR:
            span = f"{np.degrees(q[:, k].min()):.0f} .. {np.degrees(q[:, k].max()):.0f} deg"
            usual = f"{np.degrees(low):.0f} .. {np.degrees(high):.0f}"
            found.append(
                f"{joint} is {span} by the markers ({100 * share:.0f} % of the frames beyond {usual}): "
                "markers elsewhere than their set has them?"
            )
    return tuple(found)
