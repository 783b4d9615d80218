"""Marker sets: where every marker sits on its segment, and recognition of the set of a trial."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import Literal, NamedTuple

from exo_pin.anatomy import SIDES
from exo_pin.errors import GaitError, UnknownNameError

Segment = Literal["pelvis", "thigh", "shank", "foot"]

_LINKS: dict[Segment, str] = {"thigh": "thigh", "shank": "shank", "foot": "sole_plate"}
"""Segment -> link of the robot, behind its side."""

_FEWEST = {"pelvis": 3, "thigh": 1, "shank": 1, "foot": 2}
"""Fewest markers that determine a segment, given its neighbours."""


class Spot(NamedTuple):
    """Where one marker sits on the right side of the body (or in its middle).

    Attributes:
        segment: The segment it sits on.
        place: Forward, left and up from the segment's origin: the point midway between the hip centres, the
            hip, the knee, the ankle; in lengths of the segment (hip width, thigh, shank, heel to toe marker).
        spread: How far laboratories put it from there [m]: what lies within is left to the data.
    """

    segment: Segment
    place: tuple[float, float, float]
    spread: float


class MarkerSet(NamedTuple):
    """A laboratory's markers.

    Attributes:
        name: Its name in `--markers`.
        middle: Markers in the middle of the body, by name.
        paired: Markers of both sides: `{S}` in the name stands for L or R; the left one is the mirror image.
        asis: Name of the front pelvis markers; their distance scales the pelvis where `hip_width` is given.
        heel_toe: Names of the markers whose distance scales the foot.
        foot_length: The foot's length in that distance.
        hip_width: Distance of the hip centres in distances of the `asis` markers; None: by Davis 1991.
        source: Where the places come from.
    """

    name: str
    middle: dict[str, Spot]
    paired: dict[str, Spot]
    asis: str
    heel_toe: tuple[str, str]
    foot_length: float
    hip_width: float | None
    source: str

    def spots(self) -> dict[str, tuple[str, Spot]]:
        """Marker -> its link of the robot, and its spot with left ones mirrored."""
        out = {name: ("pelvis", spot) for name, spot in self.middle.items()}
        for side in SIDES:
            for name, spot in self.paired.items():
                link = f"{side}_{_LINKS[spot.segment]}" if spot.segment in _LINKS else spot.segment
                x, y, z = spot.place
                mirrored = spot._replace(place=(x, -y if side == "left" else y, z))
                out[name.format(S=side[0].upper())] = (link, mirrored)
        return out


_ALTERNATIVES = {"SACR": " (or LPSI and RPSI)"}
"""Marker -> what may take its place."""

_LEAST_PART = 0.3
"""With a smaller part of a set's markers a trial is of another set."""

_BONE, _SKIN, _WAND = 0.012, 0.03, 0.10

_PIG = MarkerSet(
    name="plug-in-gait",
    middle={"SACR": Spot("pelvis", (-1.15, 0.0, 0.69), _BONE)},
    paired={
        "{S}ASI": Spot("pelvis", (0.27, -0.93, 0.69), _BONE),
        "{S}THI": Spot("thigh", (0.0, -0.36, -0.79), _WAND),
        "{S}KNE": Spot("thigh", (0.0, -0.155, -1.0), _BONE),
        "{S}TIB": Spot("shank", (0.0, -0.30, -0.63), _WAND),
        "{S}ANK": Spot("shank", (0.0, -0.115, -1.0), _BONE),
        "{S}HEE": Spot("foot", (-0.34, -0.01, -0.25), _BONE),
        "{S}TOE": Spot("foot", (0.655, -0.02, -0.15), _BONE),
    },
    asis="{S}ASI",
    heel_toe=("{S}HEE", "{S}TOE"),
    foot_length=1.30,
    hip_width=None,
    source="Plug-in Gait (Davis 1991); places: a static trial of biomechzoo (MIT), joint widths of adults",
)

_GAIT2354 = MarkerSet(
    name="opensim-gait2354",
    middle={"V.Sacral": Spot("pelvis", (-0.582, 0.0, 0.63), _BONE)},
    paired={
        "{S}.ASIS": Spot("pelvis", (0.575, -0.766, 0.581), _BONE),
        "{S}.Thigh.Upper": Spot("thigh", (0.095, -0.198, -0.468), _WAND),
        "{S}.Thigh.Front": Spot("thigh", (0.243, -0.012, -0.581), _WAND),
        "{S}.Thigh.Rear": Spot("thigh", (0.072, -0.172, -0.719), _WAND),
        "{S}.Knee.Lat": Spot("thigh", (-0.001, -0.134, -0.955), _BONE),
        "{S}.Knee.Med": Spot("thigh", (-0.002, 0.126, -0.972), _BONE),
        "{S}.Shank.Upper": Spot("shank", (-0.023, -0.175, -0.155), _WAND),
        "{S}.Shank.Front": Spot("shank", (0.118, -0.045, -0.256), _WAND),
        "{S}.Shank.Rear": Spot("shank", (-0.024, -0.198, -0.306), _WAND),
        "{S}.Ankle.Lat": Spot("shank", (-0.002, -0.129, -1.011), _BONE),
        "{S}.Ankle.Med": Spot("shank", (0.013, 0.084, -0.966), _BONE),
        "{S}.Heel": Spot("foot", (-0.264, -0.008, -0.086), _BONE),
        "{S}.Midfoot.Sup": Spot("foot", (0.286, 0.099, -0.055), _SKIN),
        "{S}.Midfoot.Lat": Spot("foot", (0.245, -0.259, -0.090), _SKIN),
        "{S}.Toe.Lat": Spot("foot", (0.510, -0.292, -0.168), _SKIN),
        "{S}.Toe.Med": Spot("foot", (0.543, 0.073, -0.146), _SKIN),
        "{S}.Toe.Tip": Spot("foot", (0.735, -0.026, -0.141), _BONE),
    },
    asis="{S}.ASIS",
    heel_toe=("{S}.Heel", "{S}.Toe.Tip"),
    foot_length=0.93,
    hip_width=0.653,
    source="OpenSim's gait2354 marker set (model credits CC BY 3.0), sides averaged; legs and pelvis only",
)

SETS = MappingProxyType({entry.name: entry for entry in (_PIG, _GAIT2354)})
"""Name -> marker set."""


def marker_set(names: Iterable[str], name: str | None = None) -> tuple[MarkerSet, dict[str, str]]:
    """The set that a trial's markers belong to.

    Args:
        names: The trial's markers.
        name: The set; None: the one that most markers belong to.

    Returns:
        The set, and by the set's name of a marker the trial's own (which may differ in case and marks).

    Raises:
        GaitError: Too few markers to determine every segment; the message says which.
        UnknownNameError: There is no such set.
    """
    if name is not None and name not in SETS:
        raise UnknownNameError("marker set", name, SETS)
    ours = {plain(own): own for own in names}
    found = {
        entry.name: {spot: ours[plain(spot)] for spot in entry.spots() if plain(spot) in ours}
        for entry in SETS.values()
        if name in (None, entry.name)
    }
    best = max(found, key=lambda key: len(found[key]))
    _check(SETS[best], found[best], list(ours.values()))
    return SETS[best], found[best]


def plain(name: str) -> str:
    """A marker's name as it is compared: capitals and digits only."""
    return re.sub(r"[^A-Z0-9]", "", name.upper())


def _check(chosen: MarkerSet, found: Mapping[str, str], own: Sequence[str]) -> None:
    """Raises `GaitError` where a segment lacks markers, or lengths have no markers."""
    wants = list(_gaps(chosen, found)) or list(_unscaled(chosen, found))
    if wants and len(found) < _LEAST_PART * len(chosen.spots()):
        shown = f"{', '.join(own[:10])}{' ...' * (len(own) > 10)}"
        sets = "; ".join(f"{entry.name} ({_names(entry)})" for entry in SETS.values())
        raise GaitError(f"its markers ({shown}) are of no known set; map them to one of {sets}")
    if wants:
        known = f"other names can be mapped; known sets: {', '.join(SETS)}"
        raise GaitError(f"marker set {chosen.name}: {'; '.join(wants)} ({known})")


def _names(entry: MarkerSet) -> str:
    return ", ".join([*entry.middle, *(name.format(S="L/R") for name in entry.paired)])


def _gaps(chosen: MarkerSet, found: Mapping[str, str]) -> Iterator[str]:
    """Which markers segments lack."""
    segments: dict[str, list[str]] = {}
    for marker, (link, spot) in chosen.spots().items():
        side = link.partition("_")[0] if link != spot.segment else ""
        segments.setdefault(f"{side} {spot.segment}".strip(), []).append(marker)
    for name, markers in segments.items():
        needed = _FEWEST[name.rpartition(" ")[2]]
        gone = [marker for marker in markers if marker not in found]
        if len(markers) - len(gone) < needed:
            has = f"{name} has {len(markers) - len(gone)} of the {needed} markers that it needs"
            either = [f"{marker}{_ALTERNATIVES.get(marker, '')}" for marker in gone]
            yield f"{has}, missing: {', '.join(either)}"


def _unscaled(chosen: MarkerSet, found: Mapping[str, str]) -> Iterator[str]:
    """Which markers lengths lack."""
    scale = [name.format(S=S) for name in (chosen.asis, *chosen.heel_toe) for S in "LR"]
    gone = [name for name in scale if name not in found]
    if gone:
        yield f"{', '.join(gone)} missing, which give{'s' * (len(gone) == 1)} the scale"
    if chosen.hip_width is None and not any({f"{S}KNE", f"{S}ANK"} <= set(found) for S in "LR"):
        yield "KNE and ANK of neither leg are there, which give its length"
