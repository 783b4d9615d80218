"""First sizes of the person of a marker trial, from distances between the markers alone."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.names import Side
from exo_pin.arrays import Array
from exo_pin.errors import GaitError
from exo_pin.markers.hip_centres import Pelvis, distance, pelvis_of
from exo_pin.markers.person_sizes import Sizes
from exo_pin.markers.rigid_fit import rigid_fit
from exo_pin.markers.spots import MarkerSet

_THIGH_PART = 0.245 / (0.245 + 0.246)
"""Thigh in hip to ankle, Drillis & Contini 1966 (in Winter)."""

_ANKLE_HEIGHTS = (0.03, 0.15)
"""Plausible heights of the ankle over the ground [m]; outside, the laboratory's floor is not at 0."""


def first_sizes(chosen: MarkerSet, paths: Mapping[str, Array]) -> tuple[Sizes, Pelvis]:
    """Sizes from distances alone, and where the pelvis's markers sit.

    The leg's length is the longest distance from hip to ankle, when the leg is all but straight.

    Args:
        chosen: The marker set.
        paths: By the set's names, `(n, 3)` with z up [m].

    Raises:
        GaitError: Markers are never seen together.
    """
    pelvis = pelvis_of(chosen, paths)
    T = rigid_fit(pelvis.places, paths)
    feet = [_foot(chosen, paths, side) for side in SIDES]
    legs, heights = [], []
    for side, foot in zip(SIDES, feet, strict=True):
        hip = (T @ np.array([0.0, pelvis.hip_width / 2 * (1 if side == "left" else -1), 0.0, 1.0]))[:, :3]
        ankle = _ankle(chosen, paths, side, foot)
        span = np.linalg.norm(hip - ankle, axis=1)
        if np.isnan(span).all():
            raise GaitError(f"the markers of pelvis and {side} foot are never seen together")
        legs.append(float(np.nanpercentile(span, 98)))
        heights.append(float(np.nanpercentile(ankle[:, 2], 5)))
    height = float(np.mean(heights))
    floor = height if _ANKLE_HEIGHTS[0] < height < _ANKLE_HEIGHTS[1] else None
    thigh, shank = (tuple(part * leg for leg in legs) for part in (_THIGH_PART, 1 - _THIGH_PART))
    return Sizes(pelvis.hip_width, thigh, shank, (feet[0], feet[1]), floor), pelvis  # type: ignore[arg-type]


def _foot(chosen: MarkerSet, paths: Mapping[str, Array], side: Side) -> float:
    """Length of the foot [m]: distances of its markers in those of their places."""
    spots = {name: spot for name, spot in chosen.spots.items() if spot.link == f"{side}_sole_plate"}
    measured = nominal = 0.0
    for a, b in combinations([name for name in spots if name in paths], 2):
        apart = float(np.linalg.norm(np.subtract(spots[a].place, spots[b].place)))
        weight = 1 / (spots[a].spread ** 2 + spots[b].spread ** 2)
        if not np.isnan(paths[a] - paths[b]).all():
            measured += weight * distance(paths, a, b) * apart
            nominal += weight * apart**2
    if not nominal:
        raise GaitError(
            f"the markers of the {side} foot are never seen together; their distance gives the scale"
        )
    return measured / nominal


def _ankle(chosen: MarkerSet, paths: Mapping[str, Array], side: Side, foot: float) -> Array:
    """`(n, 3)` ankle centre: midway between the malleoli, or by the foot's markers."""
    malleoli = [
        [name for name in chosen.marking(f"{which}_malleolus", side) if name in paths]
        for which in ("lateral", "medial")
    ]
    if all(malleoli):
        return np.asarray((paths[malleoli[0][0]] + paths[malleoli[1][0]]) / 2)
    places = {
        name: np.array(spot.place) * foot
        for name, spot in chosen.spots.items()
        if spot.link == f"{side}_sole_plate" and name in paths
    }
    if len(places) >= 3:
        return np.asarray(rigid_fit(places, paths)[:, :3, 3])
    return _ankle_of_two(places, paths)


def _ankle_of_two(places: Mapping[str, Array], paths: Mapping[str, Array]) -> Array:
    """`(n, 3)` ankle centre of a foot with two markers, which is taken as not rolled about their line."""
    (heel, toe), (p, q) = places.values(), (paths[name] for name in places)
    forward = (q - p) / np.linalg.norm(q - p, axis=1, keepdims=True)
    left = np.cross([0.0, 0.0, 1.0], forward)
    left /= np.maximum(np.linalg.norm(left, axis=1, keepdims=True), 1e-9)
    axes = np.stack([forward, left, np.cross(forward, left)], axis=2)
    own = (toe - heel) / np.linalg.norm(toe - heel)
    side = np.cross([0.0, 0.0, 1.0], own)
    side /= np.linalg.norm(side)
    own_axes = np.stack([own, side, np.cross(own, side)], axis=1)
    return np.asarray(p - np.einsum("nij,kj,k->ni", axes, own_axes.T, heel))
