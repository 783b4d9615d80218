"""Marker-set files: a laboratory's marker set in TOML, by landmarks or by places of its own."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.names import HIP_REGRESSIONS, HipRegression, Segment, Side
from exo_pin.errors import DescriptionError, ExoPinError, FormatError, UnknownNameError
from exo_pin.markers.spots import SEGMENTS, MarkerSet, Spot, plain
from exo_pin.safe import toml_file

FOLDER = Path(__file__).with_name("sets")
"""The sets that come with the package; any of them is an example of the format."""

_LANDMARKS = FOLDER / "landmarks.toml"
_ENTRIES = ("name", "title", "source", "hips", "known_as", "markers", "also")
_DETAILS = ("segment", "place", "spread_mm", "landmark")
_FARTHEST = 3.0
"""No marker is further from its segment's origin than this, in lengths of the segment."""

_WIDEST = 300.0
"""Largest spread [mm]."""

_RATIOS = (0.2, 1.5)
"""Distance of the hip centres in distances of the front markers."""


class _Entry(NamedTuple):
    """One line of a set: as `Spot`, on the side of the body whose outward is positive."""

    segment: Segment
    sides: tuple[Side, ...]
    outward: tuple[float, float, float]
    spread: float
    landmark: str


def load_set(path: str | Path) -> MarkerSet:
    """Read a marker set.

    `markers` names each marker: a landmark of `landmarks.toml`, or a table with `segment`, `place` (forward,
    outward, up, in lengths of the segment), `spread_mm` and perhaps `landmark`. `{S}` in a name stands for L
    and R, `{Side}` for Left and Right; without it, a marker of a leg has the side in `segment`.

    Raises:
        FormatError: The file is no TOML, or a name or value in it is not accepted.
    """
    values = toml_file.read(path)
    try:
        return _set(values, Path(path).stem, _landmarks())
    except FormatError:
        raise
    except ExoPinError as error:
        raise FormatError(path, str(error)) from None


def _landmarks() -> dict[str, _Entry]:
    tables = toml_file.read(_LANDMARKS)
    return {
        name: _entry(name, {"segment": segment, **details, "landmark": name}, {})
        for segment, marks in tables.items()
        for name, details in marks.items()
    }


def _set(values: dict[str, Any], stem: str, landmarks: Mapping[str, _Entry]) -> MarkerSet:
    for entry in values:
        if entry not in _ENTRIES:
            raise UnknownNameError("entry of a marker set", entry, _ENTRIES)
    markers = values.get("markers")
    if not isinstance(markers, dict) or not markers:
        raise DescriptionError("has no table [markers]; expected lines like RASI = 'asis'")
    spots: dict[str, Spot] = {}
    for template, detail in markers.items():
        for name, spot in _spots(template, _entry(template, detail, landmarks)):
            if plain(name) in map(plain, spots):
                raise DescriptionError(f"marker {name!r} occurs more than once")
            spots[name] = spot
    return MarkerSet(
        name=_text(values, "name", stem),
        title=_text(values, "title", ""),
        source=_text(values, "source", ""),
        hips=_hips(values.get("hips", "harrington")),
        spots=spots,
        also=_also(values.get("also", {}), markers),
        known_as=_names("known_as", values.get("known_as", [])),
    )


def _text(values: Mapping[str, Any], name: str, default: str) -> str:
    text = values.get(name, default)
    if not isinstance(text, str):
        raise DescriptionError(f"{name} is {text!r}; a text is accepted")
    return text


def _names(name: str, value: object) -> tuple[str, ...]:
    if not isinstance(value, list) or not all(isinstance(x, str) for x in value):
        raise DescriptionError(f"{name} is {value!r}; a list of names is accepted")
    return tuple(value)


def _hips(value: object) -> HipRegression | float:
    for known in HIP_REGRESSIONS:
        if value == known:
            return known
    low, high = _RATIOS
    if isinstance(value, int | float) and not isinstance(value, bool) and low <= value <= high:
        return float(value)
    raise DescriptionError(f"hips is {value!r}; {', '.join(HIP_REGRESSIONS)} or {low} .. {high} is accepted")


def _also(value: object, markers: Mapping[str, Any]) -> dict[str, tuple[str, ...]]:
    if not isinstance(value, dict):
        raise DescriptionError("also is no table; expected lines like RASI = ['RASIS']")
    out: dict[str, tuple[str, ...]] = {}
    for template, further in value.items():
        if template not in markers:
            raise UnknownNameError("marker in [also]", template, markers)
        names = _names(f"also.{template}", further)
        for side in SIDES:
            out[_named(template, side)] = tuple(_named(name, side) for name in names)
    return out


def _named(template: str, side: Side) -> str:
    return template.replace("{S}", side[0].upper()).replace("{Side}", side.capitalize())


def _spots(template: str, entry: _Entry) -> Iterator[tuple[str, Spot]]:
    forward, outward, up = entry.outward
    segment, spread, landmark = entry.segment, entry.spread, entry.landmark
    paired = _named(template, "left") != template
    if not paired and segment != "pelvis" and len(entry.sides) == 2:
        why = f"{template!r} is on a {segment} without its side; write {{S}} in its name, or 'left {segment}'"
        raise DescriptionError(why)
    if not paired and segment == "pelvis" and len(entry.sides) == 2:
        if outward:
            raise DescriptionError(
                f"{template!r} is beside the middle of the pelvis; write {{S}} in its name"
            )
        yield template, Spot(segment, None, (forward, 0.0, up), spread, landmark)
        return
    for side in entry.sides:
        sign = 1 if side == "left" else -1
        place = (forward, sign * outward, up)
        yield (
            _named(template, side),
            Spot(segment, None if segment == "pelvis" else side, place, spread, landmark),
        )


def _entry(name: str, detail: object, landmarks: Mapping[str, _Entry]) -> _Entry:
    """A landmark's name, or a table of details, which go before those of the landmark that it names."""
    table = {"landmark": detail} if isinstance(detail, str) else detail
    if not isinstance(table, dict):
        raise DescriptionError(f"marker {name!r} is {detail!r}; a landmark or a table is accepted")
    for key in table:
        if key not in _DETAILS:
            raise UnknownNameError(f"entry of marker {name!r}", key, _DETAILS)
    landmark = table.get("landmark", "")
    known = landmarks.get(landmark) if isinstance(landmark, str) else None
    if landmark and landmarks and known is None:
        raise UnknownNameError("landmark", str(landmark), landmarks)
    sides, segment = (known.sides, known.segment) if known else (SIDES, None)
    if "segment" in table:
        sides, segment = _segment(name, table["segment"])
    outward = _place(name, table["place"]) if "place" in table else known.outward if known else None
    if segment is None or outward is None:
        raise DescriptionError(f"marker {name!r} has no {'place' if segment else 'segment'} and no landmark")
    spread = _spread(name, table["spread_mm"]) if "spread_mm" in table else known.spread if known else None
    if spread is None:
        raise DescriptionError(f"marker {name!r} has no spread_mm: how far it may be from its place")
    return _Entry(segment, sides, outward, spread, str(landmark))


def _segment(name: str, value: object) -> tuple[tuple[Side, ...], Segment]:
    """`thigh` (both sides), or `left thigh`."""
    words = value.split() if isinstance(value, str) else []
    sides = tuple(side for side in SIDES if side == words[0]) if len(words) == 2 else SIDES
    for segment in SEGMENTS:
        if words and sides and words[-1] == segment and (len(words) == 1 or segment != "pelvis"):
            return sides, segment
    known = (*SEGMENTS, *(f"{side} {segment}" for side in SIDES for segment in SEGMENTS[1:]))
    raise UnknownNameError(f"segment of marker {name!r}", str(value), known)


def _place(name: str, value: object) -> tuple[float, float, float]:
    if isinstance(value, list) and len(value) == 3 and all(_within(x, _FARTHEST) for x in value):
        x, y, z = (float(part) for part in value)
        return x, y, z
    why = f"three numbers forward, outward, up within {_FARTHEST:g} lengths of the segment"
    raise DescriptionError(f"place of marker {name!r} is {value!r}; {why} are accepted")


def _spread(name: str, value: object) -> float:
    if _within(value, _WIDEST) and isinstance(value, int | float) and value > 0:
        return float(value) / 1e3
    raise DescriptionError(f"spread_mm of marker {name!r} is {value!r}; 0 .. {_WIDEST:g} mm is accepted")


def _within(value: object, most: float) -> bool:
    number = isinstance(value, int | float) and not isinstance(value, bool)
    return number and math.isfinite(value) and abs(value) <= most  # type: ignore[arg-type]
