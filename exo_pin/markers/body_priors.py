"""Expectations of a body before its markers are fitted: proportions, symmetry, the set's marker places."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.arrays import Array
from exo_pin.markers.hip_centres import Pelvis
from exo_pin.markers.marker_places import MarkerPlaces
from exo_pin.markers.person_sizes import Sizes
from exo_pin.markers.spots import MarkerSet

SIZE_NAMES = (
    "hip_width",
    *(f"{side}_{segment}" for segment in ("thigh", "shank", "foot") for side in SIDES),
    *("pelvis_forward", "pelvis_up"),
)
"""The first entries of a vector of parameters [m]: sizes, and how far all pelvis markers are off together."""

FIRST_PLACE = len(SIZE_NAMES)
"""Index of the first marker's place in a vector of parameters."""

_HIP_CENTRE = 0.010
"""How well regressions place hip centres [m]: Sangeux 2015, Gait Posture 42:402, finds 8 to 20 mm."""

_PELVIS_SHAPE = 0.002
"""How well the shape of the pelvis is measured [m]: its markers define its axes."""

_SIDES_DIFFER = 0.010
"""Difference of left and right thighs, or shanks [m]."""

_SHARE = 0.02
"""Spread of the thigh's share in the leg (Drillis & Contini 1966: 0.499)."""

_LEG = 0.04
"""Relative error of a leg's length by its longest distance from hip to ankle."""

_FOOT = 0.03
"""Relative error of a foot's length by distances between its markers."""


class Parameters(NamedTuple):
    """Sizes of a body and the places of its markers.

    Attributes:
        sizes: The sizes.
        names: The k markers.
        links: Link of each.
        local: `(k, 3)` places in the links [m].
        spreads: `(k,)` [m].
        shift: Forward and up: how far all pelvis markers are off together [m].
    """

    sizes: Sizes
    names: tuple[str, ...]
    links: tuple[str, ...]
    local: Array
    spreads: Array
    shift: tuple[float, float] = (0.0, 0.0)

    @staticmethod
    def of(sizes: Sizes, places: MarkerPlaces) -> Parameters:
        """The parameters of sizes and places."""
        names = tuple(name for row in places.names.values() for name in row)
        links = tuple(link for link, row in places.names.items() for _ in row)
        local, spreads = (np.concatenate(list(rows.values())) for rows in (places.local, places.spread))
        return Parameters(sizes, names, links, local, spreads)

    @property
    def places(self) -> dict[str, Array]:
        """Marker -> `(3,)` place in its link [m]."""
        return dict(zip(self.names, self.local, strict=True))

    @property
    def vector(self) -> Array:
        """In the order of `SIZE_NAMES`, then the places."""
        s = self.sizes
        return np.concatenate([[s.hip_width, *s.thigh, *s.shank, *s.foot, *self.shift], self.local.ravel()])

    def moved(self, step: Array) -> Parameters:
        """The parameters after a step."""
        x = self.vector + step
        width, a, b, c, d, e, f, forward, up = x[:FIRST_PLACE].tolist()
        sizes = self.sizes._replace(hip_width=width, thigh=(a, b), shank=(c, d), foot=(e, f))
        return self._replace(sizes=sizes, local=x[FIRST_PLACE:].reshape(-1, 3), shift=(forward, up))


class Priors(NamedTuple):
    """Expectations as rows: `rows @ vector` should be `target`, in units of the spread.

    Attributes:
        rows: `(m, p)`.
        target: `(m,)`.
    """

    rows: Array
    target: Array

    def residual(self, now: Parameters) -> Array:
        """`(m,)` what is missing."""
        return np.asarray(self.target - self.rows @ now.vector)


def body_priors(chosen: MarkerSet, start: Parameters, pelvis: Pelvis) -> Priors:
    """The expectations for a trial.

    Args:
        chosen: The marker set.
        start: First sizes, and the markers.
        pelvis: The pelvis by distances between its markers.
    """
    width, leg = start.sizes.hip_width, float(np.mean(start.sizes.leg))
    share = start.sizes.thigh[0] / start.sizes.leg[0]
    table: list[tuple[dict[str, float], float, float]] = [
        ({"hip_width": 1.0}, width, _HIP_CENTRE),
        ({"pelvis_forward": 1.0}, 0.0, _HIP_CENTRE),
        ({"pelvis_up": 1.0}, 0.0, _HIP_CENTRE),
        *(({f"left_{part}": 1.0, f"right_{part}": -1.0}, 0.0, _SIDES_DIFFER) for part in ("thigh", "shank")),
    ]
    for k, side in enumerate(SIDES):
        thigh, shank, foot = f"{side}_thigh", f"{side}_shank", start.sizes.foot[k]
        table.append(({thigh: 1 - share, shank: -share}, 0.0, _SHARE * leg))
        table.append(({thigh: 1.0, shank: 1.0}, start.sizes.leg[k], _LEG * leg))
        table.append(({f"{side}_foot": 1.0}, foot, _FOOT * foot))
    p = len(start.vector)
    rows, target = np.zeros((len(table), p)), np.zeros(len(table))
    for i, (terms, value, spread) in enumerate(table):
        for name, factor in terms.items():
            rows[i, SIZE_NAMES.index(name)] = factor / spread
        target[i] = value / spread
    places, expected = _places(chosen, start, pelvis)
    return Priors(np.concatenate([rows, places]), np.concatenate([target, expected]))


def _places(chosen: MarkerSet, start: Parameters, pelvis: Pelvis) -> tuple[Array, Array]:
    """A marker sits at its place times its segment's length; those of the pelvis where they were measured."""
    k = len(start.names)
    rows, target = np.zeros((k, 3, FIRST_PLACE + 3 * k)), np.zeros((k, 3))
    for i, (name, spread) in enumerate(zip(start.names, start.spreads, strict=True)):
        spot, at = chosen.spots[name], FIRST_PLACE + 3 * i
        spread = spread if spot.side else _PELVIS_SHAPE
        rows[i, :, at : at + 3] = np.eye(3) / spread
        if spot.side is None:
            rows[i, 0, SIZE_NAMES.index("pelvis_forward")] = -1 / spread
            rows[i, 2, SIZE_NAMES.index("pelvis_up")] = -1 / spread
            target[i] = pelvis.places[name] / spread
        else:
            rows[i, :, SIZE_NAMES.index(f"{spot.side}_{spot.segment}")] = -np.array(spot.place) / spread
    return rows.reshape(3 * k, -1), target.ravel()
