"""Least-squares fit of a body to markers: poses, and calibration of segment lengths and marker places."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from exo_pin import ik
from exo_pin.anatomy import SIDES
from exo_pin.anatomy.human import EXTREME_RANGES
from exo_pin.arrays import Array
from exo_pin.errors import GaitError
from exo_pin.kinematics import poses
from exo_pin.markers.body_scale import Sizes, body_of
from exo_pin.markers.marker_places import MarkerPlaces, marker_places
from exo_pin.markers.marker_sets import MarkerSet
from exo_pin.markers.rigid_fit import rigid_fit
from exo_pin.robot import Robot, load_robot

_ROUNDS = 2
"""Times that sizes and places are calibrated by the poses and the poses solved again."""

_SAMPLES = 16
"""Frames of the calibration, evenly over the trial."""

_MEASURED_SPREAD = 0.010
"""How well a marker's mean place in the solved poses is known [m]; weighs it against the set's place."""

_LENGTH_STEP = 0.02
"""Relative change of a length that is tried."""

_KNEE_SEED = 0.2
"""Knees at the start of the search [rad]: a straight leg hides which way it bends."""

_FROM_SEED = ik.Dls(tolerance=1e-6, restarts=0, max_iterations=12)
"""Markers are never met exactly: no restarts, and an end. On recordings 8 steps leave 1e-12 m of the RMS."""

_FROM_NEIGHBOUR = dataclasses.replace(_FROM_SEED, max_iterations=6)
"""The same where the answer for all but the same body is known."""


@dataclass(frozen=True)
class CalibratedBody:
    """A calibrated body: its sizes, where the markers sit on it, and the robot of these sizes."""

    sizes: Sizes
    places: MarkerPlaces
    robot: Robot


def some_frames(path: Array) -> Array:
    """`(_SAMPLES, 3)` of a path, evenly over the trial."""
    return np.asarray(path[np.unique(np.linspace(0, len(path) - 1, _SAMPLES).astype(int))])


def human_robot(chosen: MarkerSet, sizes: Sizes) -> Robot:
    """A robot of these sizes that floats, with a person's extreme joint ranges: no device limits a trial."""
    body = body_of(sizes, chosen, mass=None, sex="male")  # masses do not move a marker
    return load_robot(dataclasses.replace(body, limits=EXTREME_RANGES), base="floating")


def resized(robot: Robot, sizes: Sizes) -> Robot:
    """The robot with other lengths of thigh and shank: knee and ankle are moved, masses stay behind.

    Building a robot anew takes 0.3 s, and calibration tries a dozen; it needs the places of the links only.
    """
    model = robot.model.copy()
    for k, side in enumerate(SIDES):
        for joint, part in (("knee_flexion", sizes.thigh), ("ankle_dorsiflexion", 1 - sizes.thigh)):
            at = model.jointPlacements[model.getJointId(f"{side}_{joint}")]
            at.translation = np.array([0.0, 0.0, -sizes.leg[k] * part])
    return dataclasses.replace(robot, model=model, body=None)


def calibrated(chosen: MarkerSet, sizes: Sizes, pelvis: Array, paths: dict[str, Array]) -> CalibratedBody:
    """Sizes and places that fit the markers best, starting from the set's.

    Args:
        chosen: The marker set.
        sizes: First estimate.
        pelvis: `(k, 3)` places of the pelvis's markers [m].
        paths: Marker -> `(n, 3)` path [m], of some frames.

    Raises:
        GaitError: The pelvis's markers are never seen together.
    """
    robot = human_robot(chosen, sizes)
    places, q = marker_places(chosen, sizes, pelvis, paths), None
    for _ in range(_ROUNDS):
        for name in ("leg", "thigh"):
            q, _, _ = fit_poses(resized(robot, sizes), places, paths, q)
            sizes = _refined(robot, sizes, places, paths, name, q)
        nominal = marker_places(chosen, sizes, pelvis, paths)
        places = _measured_places(resized(robot, sizes), nominal, places, paths, q)
    return CalibratedBody(sizes, places, resized(robot, sizes))


def _refined(
    robot: Robot, sizes: Sizes, places: MarkerPlaces, paths: dict[str, Array], name: str, q: Array | None
) -> Sizes:
    """The size at the vertex of the parabola through the errors at three sizes."""
    factors = (1 - _LENGTH_STEP, 1.0, 1 + _LENGTH_STEP)
    tried = [_scaled(sizes, name, factor) for factor in factors]
    cost = [float(np.nanmean(fit_poses(resized(robot, s), places, paths, q)[1] ** 2)) for s in tried]
    curvature = cost[0] - 2 * cost[1] + cost[2]
    if curvature <= 0:
        return tried[int(np.argmin(cost))]
    vertex = 1 + _LENGTH_STEP * float(np.clip(0.5 * (cost[0] - cost[2]) / curvature, -1.5, 1.5))
    return _scaled(sizes, name, vertex)


def _scaled(sizes: Sizes, name: str, factor: float) -> Sizes:
    if name == "leg":
        return sizes._replace(leg=(sizes.leg[0] * factor, sizes.leg[1] * factor))
    return sizes._replace(thigh=sizes.thigh * factor)


def _measured_places(
    robot: Robot, nominal: MarkerPlaces, places: MarkerPlaces, paths: dict[str, Array], q: Array | None
) -> MarkerPlaces:
    """Each marker's place: where it is in the solved poses, weighed against where the set has it."""
    q, _, _ = fit_poses(robot, places, paths, q)
    links = list(places.names)
    T = poses(robot, q, links)
    local = {}
    for i, link in enumerate(links):
        seen = np.stack([paths[name] for name in places.names[link]], axis=1) - T[:, i, None, :3, 3]
        mean = np.nanmean(np.einsum("nji,nkj->nki", T[:, i, :3, :3], seen), axis=0)
        weight = nominal.spread[link] ** 2 / (nominal.spread[link] ** 2 + _MEASURED_SPREAD**2)
        if link == "pelvis":
            weight = np.zeros_like(weight)  # the pelvis's own triangle is the frame of everything else
        local[link] = nominal.local[link] + weight[:, None] * (mean - nominal.local[link])
    return places._replace(local=local)


def fit_poses(
    robot: Robot, places: MarkerPlaces, paths: Mapping[str, Array], q0: Array | None = None
) -> tuple[Array, Array, tuple[str, ...]]:
    """The robot's poses that fit the markers best.

    Args:
        robot: The robot, with a floating base.
        places: Where markers sit on its links.
        paths: Marker -> `(n, 3)` path [m].
        q0: `(n, nq)` near the solution, if known.

    Returns:
        Configurations `(n, nq)`, errors `(n, k)` [m] and names of the k markers.

    Raises:
        GaitError: The pelvis's markers are never seen together.
    """
    links = list(places.names)
    points = {link: np.stack([paths[name] for name in places.names[link]], axis=1) for link in links}
    targets = {link: ik.Points(places.local[link], points[link]) for link in links}
    start, settings = (_start(robot, places, paths), _FROM_SEED) if q0 is None else (q0, _FROM_NEIGHBOUR)
    track = ik.track(robot, targets, start, settings=settings)
    T = poses(robot, track.q, links)
    errors = []
    for i, link in enumerate(links):
        reached = T[:, i, None, :3, 3] + places.local[link] @ T[:, i, :3, :3].swapaxes(1, 2)
        errors.append(np.linalg.norm(reached - points[link], axis=2))
    return track.q, np.concatenate(errors, axis=1), tuple(n for link in links for n in places.names[link])


def _start(robot: Robot, places: MarkerPlaces, paths: Mapping[str, Array]) -> Array:
    """Configurations `(n, nq)` with the pelvis on its markers and the knees a little bent."""
    pelvis = dict(zip(places.names["pelvis"], places.local["pelvis"], strict=True))
    T = rigid_fit(pelvis, paths)
    good = np.flatnonzero(~np.isnan(T[:, 0, 0]))
    if not len(good):
        raise GaitError("the pelvis's markers are never seen together")
    nearest = good[np.abs(good[:, None] - np.arange(len(T))).argmin(axis=0)]
    q = np.tile(robot.neutral, (len(T), 1))
    q[:, : robot.nq - len(robot.joints)] = _floating(T[nearest])
    q[:, [robot.column(f"{side}_knee_flexion") for side in SIDES]] = _KNEE_SEED
    return q


def _floating(T: Array) -> Array:
    """`(n, 7)` position and quaternion x, y, z, w of poses, as a floating base has them."""
    import pinocchio as pin

    return np.array([pin.SE3ToXYZQUAT(pin.SE3(pose)) for pose in T])
