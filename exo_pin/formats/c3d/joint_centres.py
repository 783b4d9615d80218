"""Lengths of the legs by the joint centres that a model wrote into a C3D file: Plug-in Gait, pyCGM2."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.names import Side
from exo_pin.anatomy.person import Measure, Person
from exo_pin.arrays import Array
from exo_pin.gait.trial import Markers, to_z_up

_CENTRES: dict[str, tuple[str, ...]] = {
    "hip": ("FEP", "HJC"),
    "knee": ("FEO", "KJC"),
    "ankle": ("TIO", "AJC"),
}
"""Joint -> points behind the side's letter: ends of Plug-in Gait's segment axes, then centres by name. A
femur's axis ends in the hip (`FEP`) and begins in the knee (`FEO`), a tibia's begins in the ankle (`TIO`)."""

_LARGEST_SPREAD = 0.25
"""Points whose distance varies by more than this part of it (90 % of the frames) are on no one segment."""

_ANKLE_HEIGHTS = (0.03, 0.15)
"""Plausible heights of the ankle over the ground [m]; outside, the laboratory's floor is not at 0."""

_STANDING = 5.0
"""Percentile of the ankle's height that a standing foot has."""


def measured_person(trial: Markers) -> Person:
    """The person by distances between joint centres: thighs, shanks, hips, and how high the ankles stand.

    Args:
        trial: With its virtual points among the markers.
    """
    sizes = dict[str, Measure]()
    for side in SIDES:
        points = {joint: name for joint in _CENTRES if (name := _point(trial, side, joint))}
        for size, (a, b) in zip(("thigh", "shank"), pairwise(_CENTRES), strict=True):
            if a in points and b in points:
                sizes |= _distance(trial, f"{side}_{size}", points[a], points[b])
        if "ankle" in points:
            sizes |= _ankle_height(trial, f"{side}_ankle_height", points["ankle"])
    hips = [_point(trial, side, "hip") for side in SIDES]
    return Person(sizes | (_distance(trial, "hip_width", *hips) if all(hips) else {}))


def _point(trial: Markers, side: Side, joint: str) -> str:
    """The first known name of a joint's centre that the trial has; "" where it has none."""
    names = (f"{side[0].upper()}{word}" for word in _CENTRES[joint])
    return next((name for name in names if name in trial.names), "")


def _distance(trial: Markers, size: str, a: str, b: str) -> dict[str, Measure]:
    """The median distance of two points [m]; nothing where they are not on one segment."""
    away = np.linalg.norm(trial.of(a) - trial.of(b), axis=1)
    away = away[np.isfinite(away)]
    if not len(away):
        return {}
    low, middle, high = np.percentile(away, [5, 50, 95])
    if high - low > _LARGEST_SPREAD * middle:
        return {}
    return {size: Measure(float(middle), "joint centres", f"{a} to {b}, median of {len(away)} frames")}


def _ankle_height(trial: Markers, size: str, name: str) -> dict[str, Measure]:
    """The ankle's height over the floor while the foot stands [m]; nothing where the floor is not known."""
    if not trial.up:
        return {}
    heights: Array = (trial.of(name) @ to_z_up(trial.up).T)[:, 2]
    heights = heights[np.isfinite(heights)]
    low = float(np.percentile(heights, _STANDING)) if len(heights) else 0.0
    if not _ANKLE_HEIGHTS[0] <= low <= _ANKLE_HEIGHTS[1]:
        return {}
    return {size: Measure(low, "joint centres", f"lowest height of {name} over the floor")}
