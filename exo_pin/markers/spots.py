"""Marker sets as records: which markers there are, and where each sits on its segment."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple, get_args

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.names import HipRegression, Segment, Side
from exo_pin.arguments import names, number, real, table, text, word
from exo_pin.errors import DescriptionError
from exo_pin.markers.person_sizes import Sizes
from exo_pin.short_repr import short_repr

SEGMENTS: tuple[Segment, ...] = get_args(Segment)

_LINKS: dict[Segment, str] = {"thigh": "thigh", "shank": "shank", "foot": "sole_plate"}
"""Segment -> link of the robot, behind its side."""


class Spot(NamedTuple):
    """Where one marker sits.

    Attributes:
        segment: The segment it sits on.
        side: Of the body; None on the pelvis.
        place: Forward, left and up from the segment's origin: the point midway between the hip centres, the
            hip, the knee, the ankle; in lengths of the segment (hip width, thigh, shank, foot).
        spread: How far laboratories put it from there [m]: what lies within is left to the data.
        landmark: What it marks, a name of `landmarks.toml`; "" for a place between landmarks.
    """

    segment: Segment
    side: Side | None
    place: tuple[float, float, float]
    spread: float
    landmark: str = ""

    @property
    def link(self) -> str:
        """The robot's link that it sits on."""
        return f"{self.side}_{_LINKS[self.segment]}" if self.side else self.segment


@dataclass(frozen=True, eq=False)
class MarkerSet:
    """A laboratory's markers.

    Attributes:
        name: Its name in `--markers`.
        title: In words.
        source: Where names and places come from.
        hips: How the hip centres follow from the pelvis's markers: Davis 1991, Harrington 2007, or their
            distance in distances of the two front markers, each pelvis marker at its place then.
        spots: Marker -> where it sits.
        also: Marker -> further names that laboratories give it.
        known_as: Further names of the set.
        sizes: Of the person, where the set is a model that was scaled to one; places are fixed then.

    Raises:
        DescriptionError: An entry is of a wrong kind, or a number is not finite.
        UnknownNameError: There is no such segment, side or rule for the hip centres.
    """

    name: str
    title: str
    source: str
    hips: HipRegression | float
    spots: Mapping[str, Spot]
    also: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    known_as: tuple[str, ...] = ()
    sizes: Sizes | None = None

    __repr__ = short_repr

    def __post_init__(self) -> None:
        if isinstance(self.hips, str):
            word("rule for the hip centres", self.hips, get_args(HipRegression))
        else:
            number("hips", self.hips, above=0.0)
        for marker, spot in table("spots", self.spots).items():
            _check(marker, spot)
        for marker, further in table("also", self.also).items():
            names(f"further names of {marker}", further)

    def names(self, marker: str) -> tuple[str, ...]:
        """All names of a marker.

        Raises:
            DescriptionError: The marker is no text.
        """
        return (text("marker", marker), *self.also.get(marker, ()))

    def marking(self, landmark: str, side: Side | None = None) -> tuple[str, ...]:
        """The markers of a landmark, on one side or (pelvis) both.

        Raises:
            DescriptionError: The landmark is no text.
            UnknownNameError: There is no such side.
        """
        text("landmark", landmark)
        if side is not None:
            word("side", side, SIDES)
        return tuple(
            name
            for name, spot in self.spots.items()
            if spot.landmark == landmark and side in (None, side_of(spot))
        )


def _check(marker: str, spot: Spot) -> None:
    """Refuse a spot with a wrong value."""
    if not isinstance(spot, Spot):
        raise DescriptionError(f"the place of marker {marker} is no Spot; one is accepted")
    word(f"segment of marker {marker}", spot.segment, SEGMENTS)
    if spot.side is not None:
        word(f"side of marker {marker}", spot.side, SIDES)
    real(f"place of marker {marker}", spot.place, (3,))
    number(f"spread of marker {marker}", spot.spread, least=0.0)
    text(f"landmark of marker {marker}", spot.landmark)


def side_of(spot: Spot) -> Side | None:
    """The side of the body a marker is on, also on the pelvis; None in its middle."""
    if spot.side or not spot.place[1]:
        return spot.side
    return "left" if spot.place[1] > 0 else "right"


def plain(name: str) -> str:
    """A marker's name as it is compared: capitals and digits only."""
    return re.sub(r"[^A-Z0-9]", "", name.upper())
