"""Calibration of a person to markers: sizes, marker places and poses that fit best, near those of the set.

The cost is the mean over the frames of the markers' squared distances from the body, in units of their noise,
plus the squared distances of sizes and places from what the marker set expects, in units of their spread
(maximum a posteriori, Gauss-Newton). The poses are eliminated frame by frame (Schur complement), so the
system that is solved has the size of the body, not of the trial.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from exo_pin.arrays import Array, Mask
from exo_pin.markers.body_priors import Parameters, Priors, body_priors
from exo_pin.markers.hip_centres import Pelvis
from exo_pin.markers.marker_fit import fit_poses
from exo_pin.markers.marker_jacobians import MarkerJacobians, linearised, moved
from exo_pin.markers.marker_places import MarkerPlaces, marker_places
from exo_pin.markers.person_robot import person_robot, resized
from exo_pin.markers.person_sizes import Sizes
from exo_pin.markers.spots import MarkerSet
from exo_pin.robot import Robot

_SAMPLES = 24
"""Frames of the calibration, evenly over a trial."""

_TRUSTED = 0.0005
"""Noise of a marker [m] as if the body were right and nothing but the markers counted: the first fit."""

_MODEL_ERROR = 5.0
"""Noise in misfits of the first fit, which absorbs part of what skin and joints that are no hinges do."""

_NOISE = (0.0002, 0.03)
"""Smallest and largest noise of a marker that is believed [m]."""

_STEPS = 20
"""Most steps of Gauss and Newton."""

_SETTLED = 2e-5
"""A step that moves no size and no place further than this ends the search [m]."""

_ANGLE_DAMPING = 1e-8
"""Keeps a pose where the markers leave it open, against 1/m^2 of a marker's arm."""


@dataclass(frozen=True)
class CalibratedBody:
    """A calibrated body: its sizes, where the markers sit, the robot of these sizes; what was noticed."""

    sizes: Sizes
    places: MarkerPlaces
    robot: Robot
    remarks: tuple[str, ...] = ()


def some_frames(path: Array) -> Array:
    """At most `_SAMPLES` of the `(n, 3)` samples of a path, evenly over the trial."""
    return np.asarray(path[np.unique(np.linspace(0, len(path) - 1, _SAMPLES).astype(int))])


def calibrated(chosen: MarkerSet, sizes: Sizes, pelvis: Pelvis, paths: Mapping[str, Array]) -> CalibratedBody:
    """Sizes and places that fit the markers best, starting from the set's.

    Args:
        chosen: The marker set.
        sizes: First estimate.
        pelvis: The pelvis of the trial.
        paths: Marker -> `(n, 3)` path [m], of some frames.

    Raises:
        GaitError: The pelvis's markers are never seen together.
    """
    robot = person_robot(sizes)
    first = marker_places(chosen, sizes, paths, pelvis.places)
    q, _, _ = fit_poses(robot, first, paths, weights="spread")
    start = Parameters.of(sizes, first)
    priors = body_priors(chosen, start, pelvis)
    measured = np.stack([paths[name] for name in start.names], axis=1)
    _, misfit = _fitted(robot, q, start, priors, measured, _TRUSTED)
    noise = float(np.clip(_MODEL_ERROR * misfit, *_NOISE))
    now, _ = _fitted(robot, q, start, priors, measured, noise)
    places = marker_places(chosen, now.sizes, paths, now.places)
    return CalibratedBody(now.sizes, places, resized(robot, now.sizes))


def _fitted(
    robot: Robot, q: Array, now: Parameters, priors: Priors, measured: Array, noise: float
) -> tuple[Parameters, float]:
    """Sizes and places where the search settles, and how far the markers are from them [m]."""
    misfit = np.inf
    for _ in range(_STEPS):
        there = linearised(resized(robot, now.sizes), q, now)
        step, dq, misfit = _step(there, measured, priors.rows, priors.residual(now), noise)
        now, q = now.moved(step), moved(robot, q, dq)
        if np.abs(step).max() < _SETTLED:
            break
    return now, misfit


def _step(
    there: MarkerJacobians, measured: Array, rows: Array, prior: Array, noise: float
) -> tuple[Array, Array, float]:
    """The step of sizes and places, that of the poses `(n, nv)`, and how far the markers are off then [m]."""
    seen: Mask = np.asarray(~np.isnan(measured).any(axis=2))
    error = np.where(seen[..., None], measured - there.position, 0.0)
    n, k, _ = error.shape
    r = error.reshape(n, 3 * k)
    A = (there.by_pose * seen[..., None, None]).reshape(n, 3 * k, -1)
    B = (there.by_parameter * seen[..., None, None]).reshape(n, 3 * k, -1)
    AtA = A.swapaxes(1, 2) @ A + _ANGLE_DAMPING * np.eye(A.shape[2])
    AtB, Atr = A.swapaxes(1, 2) @ B, np.einsum("nij,ni->nj", A, r)
    weight = 1 / (n * noise**2)
    gain = np.linalg.solve(AtA, np.concatenate([AtB, Atr[..., None]], axis=2))
    H = rows.T @ rows + weight * (
        np.einsum("nij,nik->jk", B, B) - np.einsum("nij,nik->jk", AtB, gain[..., :-1])
    )
    g = rows.T @ prior + weight * (np.einsum("nij,ni->j", B, r) - np.einsum("nij,ni->j", AtB, gain[..., -1]))
    step = np.linalg.solve(H, g)
    dq = gain[..., -1] - gain[..., :-1] @ step
    left = r - np.einsum("nij,nj->ni", A, dq) - B @ step
    free = max(3 * int(seen.sum()) - dq.size, 1)
    return step, dq, float(np.sqrt((left**2).sum() / free))
