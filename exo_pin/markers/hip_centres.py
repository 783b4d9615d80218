"""Hip centres from the pelvis's markers: regressions of Davis 1991 and Harrington 2007, or a set's ratio."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.davis_hip import from_front_spine
from exo_pin.arrays import Array
from exo_pin.errors import GaitError
from exo_pin.markers.rigid_fit import rigid_fit
from exo_pin.markers.spots import MarkerSet

_MARKER_RADIUS = 0.007
"""Of a usual marker [m]: what Davis's regression takes off."""


class Pelvis(NamedTuple):
    """A pelvis with its markers.

    Attributes:
        hip_width: Distance of the hip centres [m].
        places: Marker -> `(3,)` forward, left and up from midway between the hip centres [m].
    """

    hip_width: float
    places: dict[str, Array]


def pelvis_of(chosen: MarkerSet, paths: Mapping[str, Array]) -> Pelvis:
    """The pelvis of a trial by distances between its markers.

    Args:
        chosen: The marker set.
        paths: By the set's names, `(n, 3)` [m].

    Raises:
        GaitError: Markers are never seen together.
    """
    spots = {name: spot for name, spot in chosen.spots.items() if spot.segment == "pelvis" and name in paths}
    fronts = [next(iter(chosen.marking("asis", side))) for side in SIDES]
    breadth = distance(paths, *fronts)
    if not isinstance(chosen.hips, str):
        width = chosen.hips * breadth
        return _shaped(width, {name: np.array(spot.place) * width for name, spot in spots.items()}, paths)
    middle = (paths[fronts[0]] + paths[fronts[1]]) / 2
    backs = {name: paths[name] for name, spot in spots.items() if spot.landmark in ("psis", "sacrum")}
    centre = [path for name, path in backs.items() if spots[name].landmark == "sacrum"] or [
        np.mean(list(backs.values()), axis=0)
    ]
    depth = _median(np.linalg.norm(middle - centre[0], axis=1), "front and back of the pelvis")
    leg = _leg(chosen, paths) if chosen.hips == "davis" else None
    width, at = _harrington(breadth, depth) if leg is None else _davis(breadth, leg)
    places = {}
    for name, spot in spots.items():
        y = float(spot.place[1]) * width
        if spot.landmark == "asis":
            places[name] = np.array([0.0, np.sign(y) * breadth / 2, 0.0]) - at
        elif spot.landmark in ("psis", "sacrum"):
            places[name] = np.array([-_depth(paths[name], middle, y), y, 0.0]) - at
        else:
            places[name] = np.array(spot.place) * width
    return _shaped(width, places, paths)


def _shaped(width: float, places: dict[str, Array], paths: Mapping[str, Array]) -> Pelvis:
    """A pelvis in its own shape: each marker where it is on average on the pelvis that fits all."""
    T = rigid_fit(places, paths)
    own = {}
    for name, place in places.items():
        local = np.einsum("nji,nj->ni", T[:, :3, :3], paths[name] - T[:, :3, 3])
        seen = local[~np.isnan(local).any(axis=1)]
        own[name] = seen.mean(axis=0) if len(seen) else place
    return Pelvis(width, own)


def _depth(path: Array, middle: Array, aside: float) -> float:
    """How far behind the front markers a back marker is, which is `aside` from the middle [m]."""
    far = _median(np.linalg.norm(path - middle, axis=1), "front and back of the pelvis")
    return float(np.sqrt(max(far**2 - aside**2, 0.0)))


def _leg(chosen: MarkerSet, paths: Mapping[str, Array]) -> float | None:
    """Length of the leg from the front of the pelvis over knee and ankle [m]; None without markers there."""
    lengths = []
    for side in SIDES:
        chain = [
            [name for name in chosen.marking(mark, side) if name in paths]
            for mark in ("asis", "lateral_epicondyle", "lateral_malleolus")
        ]
        if all(chain):
            a, b, c = (names[0] for names in chain)
            lengths.append(distance(paths, a, b) + distance(paths, b, c))
    return float(np.mean(lengths)) if lengths else None


def _davis(breadth: float, leg: float) -> tuple[float, Array]:
    """Hip width, and mid-hip from the middle of the front markers, by `anatomy.davis_hip`."""
    forward, inwards, up = from_front_spine(leg, _MARKER_RADIUS).tolist()
    return breadth - 2 * inwards, np.array([forward, 0.0, up])


def _harrington(breadth: float, depth: float) -> tuple[float, Array]:
    """The same by Harrington 2007, J Biomech 40:595 (its regression without the leg's length)."""
    at = np.array([-0.24 * depth - 0.0099, 0.0, -0.30 * breadth - 0.0109])
    return 2 * (0.33 * breadth + 0.0073), at


def distance(paths: Mapping[str, Array], a: str, b: str) -> float:
    """The usual distance of two markers [m].

    Args:
        paths: Marker -> `(n, 3)` path [m].
        a: One marker.
        b: The other.

    Raises:
        GaitError: They are never seen together.
    """
    return _median(np.linalg.norm(paths[a] - paths[b], axis=1), f"markers {a} and {b}")


def _median(values: Array, what: str) -> float:
    if np.isnan(values).all():
        raise GaitError(f"{what} are never seen together; their distance gives the scale")
    return float(np.nanmedian(values))
