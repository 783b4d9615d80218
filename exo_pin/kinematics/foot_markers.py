"""Heel and toe markers of a trial: where the feet were seen, without any model."""

from __future__ import annotations

import re

import numpy as np

from exo_pin import signals
from exo_pin.anatomy import SIDES
from exo_pin.anatomy.names import Side, Vertical
from exo_pin.arrays import Array
from exo_pin.gait import Gait
from exo_pin.gait.marked_feet import FootMarkers
from exo_pin.gait.trial import UP_AXES, Markers, to_z_up
from exo_pin.kinematics.sole_points import sole_points
from exo_pin.robot import Robot

_HEELS = ("HEE", "HEEL", "CALC", "CAL", "CALCANEUS", "CA", "HEELMARKER", "CALCSTUDY")
_TOES = (
    "TOE",
    "TOETIP",
    "TOES",
    "MT2",
    "MTH2",
    "MTP2",
    "SM",
    "SMH",
    "BIGTOE",
    "HALLUX",
    "HLX",
    "MTP1",
    "MT1",
)
"""Names of the markers on the heel and at the front of the foot, without the side: Plug-in Gait, Helen Hayes,
OpenSim, Stanford and OpenCap, CAST and IOR. An earlier one wins; toes are both of the same name."""

_SAME_WORLD = 0.3
"""Heel markers further from the model's heels than this [m] are not in the world of the walk."""


def foot_markers(trial: Markers, robot: Robot, gait: Gait) -> FootMarkers | None:
    """The heel and toe markers of a walk's trial; None where both heels are not marked.

    Where the trial does not state its vertical, it is the axis with which the markers lie at the walk's feet.

    Args:
        trial: The markers.
        robot: On the person's body.
        gait: The walk of this trial.
    """
    heels, toes = _pair(trial.names, _HEELS), _pair(trial.names, _TOES)
    if not heels:
        return None
    up = _vertical(trial, heels, robot, gait)
    if up is None:
        return None
    seen = trial.turned(to_z_up(up))
    nowhere = np.full((len(trial), len(SIDES), 3), np.nan)
    return FootMarkers(trial.time, _paths(seen, heels), _paths(seen, toes) if toes else nowhere, heels, toes)


def _pair(names: tuple[str, ...], words: tuple[str, ...]) -> tuple[str, ...]:
    """The left and the right marker of the first name that both feet have; else empty."""
    for word in words:
        found = [next((name for name in names if _is(name, word, side)), "") for side in SIDES]
        if all(found):
            return tuple(found)
    return ()


def _is(name: str, word: str, side: Side) -> bool:
    """Whether a marker is this one of a side: its letter or word before or behind, any marks and case."""
    plain = re.sub(r"[^A-Z0-9]", "", name.rpartition(":")[2].upper())
    marks = (side[0].upper(), side.upper())
    return any(plain in (f"{mark}{word}", f"{word}{mark}") for mark in marks)


def _paths(trial: Markers, names: tuple[str, ...]) -> Array:
    """`(n, 2, 3)` with short gaps filled."""
    return np.stack([signals.filled(trial.time, trial.of(name)).values for name in names], axis=1)


def _vertical(trial: Markers, heels: tuple[str, ...], robot: Robot, gait: Gait) -> Vertical | None:
    """The trial's vertical; None where it is not known, or the markers are in another world than the walk."""
    if gait.base is None:
        return trial.up or None
    model = sole_points(robot, gait)[:, :, 0]
    paths = _paths(trial, heels)
    inside = (trial.time >= gait.time[0]) & (trial.time <= gait.time[-1])
    away = {}
    for up in (trial.up,) if trial.up else UP_AXES:
        at = np.stack([np.interp(trial.time[inside], gait.time, x) for x in model.reshape(len(gait), -1).T])
        apart = (paths[inside] @ to_z_up(up).T).reshape(int(inside.sum()), -1) - at.T
        off = np.linalg.norm(apart.reshape(-1, 3), axis=1)
        away[up] = float(np.nanmedian(off)) if np.isfinite(off).any() else np.inf
    best = min(away, key=lambda up: away[up])
    return best if away[best] < _SAME_WORLD else None
