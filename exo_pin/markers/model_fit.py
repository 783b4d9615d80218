"""A model as the person of a trial: markers that sit elsewhere than the model has them are left out."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations

import numpy as np

from exo_pin.arrays import Array
from exo_pin.markers.calibration import CalibratedBody, some_frames
from exo_pin.markers.marker_fit import fit_poses
from exo_pin.markers.marker_places import MarkerPlaces, marker_places
from exo_pin.markers.person_robot import person_robot
from exo_pin.markers.person_sizes import Sizes
from exo_pin.markers.recognition import gaps
from exo_pin.markers.spots import MarkerSet

_MISPLACED = 0.05
"""A marker that is on average further from its place [m] has been put elsewhere since ..."""

_TIMES_USUAL = 4.0
"""... if it is also this many times as far as the usual marker."""

_UNSCALED = 0.08
"""Markers of a segment lie further apart than in a scaled model by more than this part: another person's."""


def model_body(chosen: MarkerSet, sizes: Sizes, paths: Mapping[str, Array]) -> CalibratedBody:
    """The person of a model, without markers that have been put elsewhere since it was scaled.

    Args:
        chosen: The model's markers.
        sizes: The model's.
        paths: Marker -> `(n, 3)` path [m].

    Raises:
        GaitError: The pelvis's markers are never seen together.
    """
    robot, places = person_robot(sizes), marker_places(chosen, sizes, paths)
    remarks = _scale_remarks(places, paths)
    some = {name: some_frames(path) for name, path in paths.items()}
    _, error, names = fit_poses(robot, places, some)
    rms = dict(zip(names, np.sqrt(np.nanmean(error**2, axis=0)).tolist(), strict=True))
    least = max(_MISPLACED, _TIMES_USUAL * float(np.median(list(rms.values()))))
    away = [name for name, off in rms.items() if off > least]
    kept = [name for name in names if name not in away]
    if not away or list(gaps(chosen, kept)):
        return CalibratedBody(sizes, places, robot, remarks)
    shown = ", ".join(f"{name} ({1e3 * rms[name]:.0f} mm)" for name in away)
    remark = f"markers that are elsewhere than {chosen.name} has them are left out: {shown}"
    return CalibratedBody(sizes, places.only(kept), robot, (*remarks, remark))


def _scale_remarks(places: MarkerPlaces, paths: Mapping[str, Array]) -> tuple[str, ...]:
    """Whether markers of one segment are as far apart as in the model (median over pairs)."""
    ratios = []
    for link, names in places.names.items():
        for a, b in combinations(range(len(names)), 2):
            model = float(np.linalg.norm(places.local[link][a] - places.local[link][b]))
            apart = np.linalg.norm(paths[names[a]] - paths[names[b]], axis=1)
            if model > _MISPLACED and not np.isnan(apart).all():
                ratios.append(float(np.nanmedian(apart)) / model)
    ratio = float(np.median(ratios)) if ratios else 1.0
    if abs(ratio - 1) < _UNSCALED:
        return ()
    return (f"markers lie {ratio:.2f} times as far apart as in the model: is it scaled to this person?",)
