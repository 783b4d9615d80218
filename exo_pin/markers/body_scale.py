"""Sizes of the body of a marker trial, from distances between its markers."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from exo_pin.anatomy import SIDES, Body
from exo_pin.anatomy.human import usual_mass
from exo_pin.anatomy.names import Sex
from exo_pin.anatomy.sizes import SIZES
from exo_pin.arrays import Array
from exo_pin.errors import DescriptionError, GaitError
from exo_pin.formats.units import METRES_PER
from exo_pin.markers.marker_sets import MarkerSet
from exo_pin.markers.rigid_fit import rigid_fit

_THIGH_PART = 0.245 / (0.245 + 0.246)
"""Thigh in hip to ankle, Drillis & Contini 1966 (in Winter)."""

_LEG_PART = 0.245 + 0.246
"""Hip to ankle / stature, the same."""

_MARKER_RADIUS = 0.007
"""Of a usual marker [m]: what Davis's regression takes off."""

_ANKLE_HEIGHTS = (0.03, 0.15)
"""Plausible heights of the ankle over the ground [m]; outside, the laboratory's floor is not at 0."""


class Sizes(NamedTuple):
    """Sizes of a body by its markers [m].

    Attributes:
        hip_width: Between the hip centres.
        leg: Hip to ankle, left and right.
        thigh: Part of the thigh in it.
        foot: Distance of heel and toe marker, left and right.
        ankle: Height of the ankle over the ground, or None.
    """

    hip_width: float
    leg: tuple[float, float]
    thigh: float
    foot: tuple[float, float]
    ankle: float | None


def first_sizes(chosen: MarkerSet, paths: Mapping[str, Array]) -> tuple[Sizes, Array]:
    """Sizes from distances alone, and where the set's pelvis markers sit from the mid-hip.

    The leg's length is the longest distance from hip to ankle, when the leg is all but straight.

    Args:
        chosen: The marker set.
        paths: By the set's names, `(n, 3)` with z up [m].

    Raises:
        GaitError: Markers are never seen together.
    """
    asis = _distance(paths, chosen.asis.format(S="L"), chosen.asis.format(S="R"))
    feet = [_distance(paths, *(name.format(S=side[0].upper()) for name in chosen.heel_toe)) for side in SIDES]
    hips = _hips(chosen, paths, asis)
    pelvis = _pelvis(chosen, hips, paths)
    T = rigid_fit(pelvis, paths)
    legs, heights = [], []
    for k, side in enumerate(SIDES):
        spots = chosen.spots()
        places = {
            name: np.array(spot.place) * feet[k]
            for name, (link, spot) in spots.items()
            if link == f"{side}_sole_plate" and name in paths
        }
        hip = (T @ np.array([0.0, hips.width / 2 * (1 if side == "left" else -1), 0.0, 1.0]))[:, :3]
        ankle = _ankle(places, paths)
        legs.append(float(np.nanpercentile(np.linalg.norm(hip - ankle, axis=1), 98)))
        heights.append(float(np.nanpercentile(ankle[:, 2], 5)))
    height = float(np.mean(heights))
    floor = height if _ANKLE_HEIGHTS[0] < height < _ANKLE_HEIGHTS[1] else None
    return Sizes(hips.width, (legs[0], legs[1]), _THIGH_PART, (feet[0], feet[1]), floor), _stack(pelvis)


class _Hips(NamedTuple):
    """The hip centres: their distance, and their middle seen from the middle of the ASIS markers [m]."""

    width: float
    middle: Array | None


def _hips(chosen: MarkerSet, paths: Mapping[str, Array], asis: float) -> _Hips:
    """By the set's own ratio, or by Davis et al. 1991 (Hum Mov Sci 10:575) as Plug-in Gait has it."""
    if chosen.hip_width is not None:
        return _Hips(chosen.hip_width * asis, None)
    parts = (("ASI", "KNE"), ("KNE", "ANK"))
    sides = [S for S in "LR" if f"{S}KNE" in paths and f"{S}ANK" in paths]
    leg = float(np.mean([sum(_distance(paths, f"{S}{a}", f"{S}{b}") for a, b in parts) for S in sides]))
    C, theta, beta = 0.115 * leg - 0.0153, 0.5, 0.314
    trochanter = 0.1288 * leg - 0.04856 + _MARKER_RADIUS
    x = C * np.cos(theta) * np.sin(beta) - trochanter * np.cos(beta)
    z = -C * np.cos(theta) * np.cos(beta) - trochanter * np.sin(beta)
    return _Hips(asis - 2 * C * np.sin(theta), np.array([x, 0.0, z]))


def _pelvis(chosen: MarkerSet, hips: _Hips, paths: Mapping[str, Array]) -> dict[str, Array]:
    """Pelvis markers from the mid-hip [m]: the set's places, or this pelvis's own triangle."""
    spots = {
        name: spot for name, (link, spot) in chosen.spots().items() if link == "pelvis" and name in paths
    }
    if hips.middle is None:
        return {name: np.array(spot.place) * hips.width for name, spot in spots.items()}
    left, right = (paths[chosen.asis.format(S=S)] for S in "LR")
    back = paths["SACR"]
    half = float(np.nanmedian(np.linalg.norm(left - right, axis=1))) / 2
    depth = float(np.nanmedian(np.linalg.norm((left + right) / 2 - back, axis=1)))
    triangle = {"LASI": [0, half, 0], "RASI": [0, -half, 0], "SACR": [-depth, 0, 0]}
    return {name: np.array(triangle[name], dtype=float) - hips.middle for name in spots}  # in the set's order


def _stack(places: Mapping[str, Array]) -> Array:
    return np.array(list(places.values()))


def _distance(paths: Mapping[str, Array], a: str, b: str) -> float:
    both = np.linalg.norm(paths[a] - paths[b], axis=1)
    if np.isnan(both).all():
        raise GaitError(f"markers {a} and {b} are never seen together; their distance gives the scale")
    return float(np.nanmedian(both))


def _ankle(places: Mapping[str, Array], paths: Mapping[str, Array]) -> Array:
    """`(n, 3)` ankle centre: by the foot's markers, up to the roll about heel and toe."""
    if len(places) >= 3:
        return np.asarray(rigid_fit(places, paths)[:, :3, 3])
    (heel, toe), (p, q) = places.values(), (paths[name] for name in places)
    forward = (q - p) / np.linalg.norm(q - p, axis=1, keepdims=True)
    left = np.cross([0.0, 0.0, 1.0], forward)  # a foot with two markers is taken as not rolled
    left /= np.maximum(np.linalg.norm(left, axis=1, keepdims=True), 1e-9)
    axes = np.stack([forward, left, np.cross(forward, left)], axis=2)
    own = (toe - heel) / np.linalg.norm(toe - heel)
    side = np.cross([0.0, 0.0, 1.0], own)
    side /= np.linalg.norm(side)
    own_axes = np.stack([own, side, np.cross(own, side)], axis=1)
    return np.asarray(p - np.einsum("nij,kj,k->ni", axes, own_axes.T, heel))


def check_lengths(sizes: Sizes, unit: str) -> None:
    """Refuse lengths that no person has, before anything is fitted to them.

    Args:
        sizes: By markers.
        unit: What the file states its lengths in; "" where it states none.

    Raises:
        GaitError: With the unit in which they would be a person's.
    """
    size, stature = SIZES["stature"], float(np.mean(sizes.leg)) / _LEG_PART
    if size.low <= stature <= size.high:
        return
    says = f"; the file says {unit}" if unit else ""
    for word, metres in (("metres", 1.0), ("centimetres", 1e-2), ("millimetres", 1e-3)):
        fitting = stature * metres / METRES_PER.get(unit, 1.0)
        if size.low <= fitting <= size.high:
            raise GaitError(
                f"the markers are no person's, whose stature would be {stature:.2g} m: in {word}? "
                f"It would be {fitting:.2f} m then{says}"
            )
    raise GaitError(
        f"the markers are no person's, whose stature would be {stature:.2g} m{says}; "
        f"{size.low:g} .. {size.high:g} m is accepted"
    )


def body_of(sizes: Sizes, chosen: MarkerSet, *, mass: float | None, sex: Sex) -> Body:
    """The body with these sizes; all others follow from the stature by the length of the legs.

    Args:
        sizes: By markers.
        chosen: The marker set.
        mass: Of the person [kg]; None: by stature.
        sex: Whose segment masses.

    Raises:
        GaitError: No person has such sizes: wrong units or wrong markers.
    """
    stature = float(np.mean(sizes.leg)) / _LEG_PART
    measures = {"hip_width": sizes.hip_width}
    for k, side in enumerate(SIDES):
        measures[f"{side}_thigh"] = sizes.leg[k] * sizes.thigh
        measures[f"{side}_shank"] = sizes.leg[k] * (1 - sizes.thigh)
        measures[f"{side}_foot_length"] = sizes.foot[k] * chosen.foot_length
        if sizes.ankle is not None:
            measures[f"{side}_ankle_height"] = sizes.ankle
    try:
        weight = usual_mass(stature) if mass is None else mass
        rounded = {name: round(value, 6) for name, value in measures.items()}
        return Body.from_stature(round(stature, 4), mass=weight, sex=sex, **rounded)
    except DescriptionError as error:
        raise GaitError(f"the markers are no person's: {error}") from error
