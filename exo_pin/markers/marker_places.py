"""Places of markers on the links of a robot: those of the marker set, scaled to a body."""

from __future__ import annotations

from collections.abc import Container, Mapping
from typing import NamedTuple

import numpy as np

from exo_pin.arrays import Array
from exo_pin.markers.person_sizes import Sizes
from exo_pin.markers.spots import MarkerSet


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

    def by_marker(self) -> dict[str, Array]:
        """Marker -> `(3,)` place in its link [m]."""
        return {
            name: place
            for link, row in self.names.items()
            for name, place in zip(row, self.local[link], strict=True)
        }

    def only(self, names: Container[str]) -> MarkerPlaces:
        """The places of some markers."""
        keep = {link: [name in names for name in row] for link, row in self.names.items()}
        rows = {link: tuple(np.array(row)[keep[link]].tolist()) for link, row in self.names.items()}
        local, spread = (
            {link: values[keep[link]] for link, values in part.items() if rows[link]}
            for part in (self.local, self.spread)
        )
        return MarkerPlaces({link: row for link, row in rows.items() if row}, local, spread)


def marker_places(
    chosen: MarkerSet, sizes: Sizes, names: Mapping[str, Array], own: Mapping[str, Array] | None = None
) -> MarkerPlaces:
    """The set's places on a body of these sizes.

    Args:
        chosen: The marker set.
        sizes: Of the body.
        names: By the names of the markers of the trial.
        own: Marker -> `(3,)` place in its link [m], where it is known better than by the set.
    """
    rows: dict[str, list[tuple[str, Array, float]]] = {}
    for name, spot in chosen.spots.items():
        if name in names:
            place = np.array(spot.place) * sizes.length(spot.segment, spot.side)
            rows.setdefault(spot.link, []).append((name, (own or {}).get(name, place), spot.spread))
    return MarkerPlaces(
        {link: tuple(name for name, _, _ in row) for link, row in rows.items()},
        {link: np.array([place for _, place, _ in row]) for link, row in rows.items()},
        {link: np.array([spread for *_, spread in row]) for link, row in rows.items()},
    )
