"""Places of markers on the links of a robot: those of the marker set, scaled to a body."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from exo_pin.arrays import Array
from exo_pin.markers.body_scale import Sizes
from exo_pin.markers.marker_sets import MarkerSet


class MarkerPlaces(NamedTuple):
    """Where markers sit on the links of a robot.

    Attributes:
        names: Link -> names of its k markers.
        local: Link -> `(k, 3)` places in the link [m].
        spread: Link -> `(k,)` how far laboratories put them from there [m].
    """

    names: dict[str, tuple[str, ...]]
    local: dict[str, Array]
    spread: dict[str, Array]


def marker_places(chosen: MarkerSet, sizes: Sizes, pelvis: Array, names: Mapping[str, Array]) -> MarkerPlaces:
    """The set's places on a body of these sizes.

    Args:
        chosen: The marker set.
        sizes: Of the body.
        pelvis: `(k, 3)` places of the pelvis's k markers, in the order of the set [m].
        names: By the names of the markers of the trial.
    """
    lengths = {"thigh": sizes.thigh, "shank": 1 - sizes.thigh}
    rows: dict[str, list[tuple[str, Array, float]]] = {}
    for name, (link, spot) in chosen.spots().items():
        if name not in names:
            continue
        k = 0 if link.startswith("left") else 1
        scale = sizes.foot[k] if spot.segment == "foot" else sizes.leg[k] * lengths.get(spot.segment, 0.0)
        rows.setdefault(link, []).append((name, np.array(spot.place) * scale, spot.spread))
    local = {link: np.array([place for _, place, _ in row]) for link, row in rows.items()}
    local["pelvis"] = pelvis
    return MarkerPlaces(
        {link: tuple(name for name, _, _ in row) for link, row in rows.items()},
        local,
        {link: np.array([spread for *_, spread in row]) for link, row in rows.items()},
    )
