"""Least-squares fit of a body to markers: its pose in every frame."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Literal

import numpy as np

from exo_pin import ik
from exo_pin.anatomy import SIDES
from exo_pin.arrays import Array
from exo_pin.errors import GaitError
from exo_pin.kinematics import poses
from exo_pin.markers.marker_places import MarkerPlaces
from exo_pin.markers.rigid_fit import rigid_fit
from exo_pin.robot import Robot
from exo_pin.robot.floating_base import base_coordinates

_KNEE_SEED = 0.2
"""Knees at the start of the search [rad]: a straight leg hides which way it bends."""

_FROM_SEED = ik.Dls(tolerance=1e-6, restarts=0, max_iterations=12)
"""Markers are never met exactly: no restarts, and an end. On recordings 8 steps leave 1e-12 m of the RMS."""

_FROM_NEIGHBOUR = dataclasses.replace(_FROM_SEED, max_iterations=6)
"""The same where the answer for all but the same body is known."""

_MARKER_NOISE = 0.010
"""Of a marker in its place [m], against which the spread of the places weighs."""


def fit_poses(
    robot: Robot,
    places: MarkerPlaces,
    paths: Mapping[str, Array],
    q0: Array | None = None,
    *,
    weights: Literal["equal", "spread"] = "equal",
) -> tuple[Array, Array, tuple[str, ...]]:
    """The robot's poses that fit the markers best.

    Args:
        robot: The robot, with a floating base.
        places: Where markers sit on its links.
        paths: Marker -> `(n, 3)` path [m].
        q0: `(n, nq)` near the solution, if known.
        weights: All markers alike, or less where their place is less certain.

    Returns:
        Configurations `(n, nq)`, errors `(n, k)` [m] and names of the k markers.

    Raises:
        GaitError: The pelvis's markers are never seen together.
    """
    links = list(places.names)
    points = {link: np.stack([paths[name] for name in places.names[link]], axis=1) for link in links}
    targets = {
        link: ik.Points(places.local[link], points[link], _weight(places.spread[link], weights))
        for link in links
    }
    start, settings = (_start(robot, places, paths), _FROM_SEED) if q0 is None else (q0, _FROM_NEIGHBOUR)
    track = ik.track(robot, targets, start, settings=settings)
    T = poses(robot, track.q, links)
    errors = []
    for i, link in enumerate(links):
        reached = T[:, i, None, :3, 3] + places.local[link] @ T[:, i, :3, :3].swapaxes(1, 2)
        errors.append(np.linalg.norm(reached - points[link], axis=2))
    return track.q, np.concatenate(errors, axis=1), tuple(n for link in links for n in places.names[link])


def _weight(spread: Array, weights: Literal["equal", "spread"]) -> Array:
    """`(k,)` weights of the errors."""
    return np.ones(len(spread)) if weights == "equal" else _MARKER_NOISE / np.hypot(_MARKER_NOISE, spread)


def _start(robot: Robot, places: MarkerPlaces, paths: Mapping[str, Array]) -> Array:
    """Configurations `(n, nq)` with the pelvis on its markers and the knees a little bent."""
    pelvis = dict(zip(places.names["pelvis"], places.local["pelvis"], strict=True))
    T = rigid_fit(pelvis, paths)
    good = np.flatnonzero(~np.isnan(T[:, 0, 0]))
    if not len(good):
        raise GaitError("the pelvis's markers are never seen together")
    nearest = good[np.abs(good[:, None] - np.arange(len(T))).argmin(axis=0)]
    q = np.tile(robot.neutral, (len(T), 1))
    q[:, : robot.nq - len(robot.joints)] = base_coordinates(T[nearest])
    q[:, [robot.column(f"{side}_knee_flexion") for side in SIDES]] = _KNEE_SEED
    return q
