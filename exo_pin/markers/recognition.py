"""Recognition of the marker set of a trial: names compared, the best match, and what it lacks."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.names import Segment
from exo_pin.arguments import names as as_names
from exo_pin.errors import GaitError
from exo_pin.markers.marker_sets import SETS
from exo_pin.markers.spots import MarkerSet, plain

FEWEST: dict[Segment, int] = {"pelvis": 3, "thigh": 1, "shank": 1, "foot": 2}
"""Fewest markers that determine a segment, given its neighbours."""

_LINK_ENDS: dict[Segment, str] = {
    "pelvis": "pelvis",
    "thigh": "thigh",
    "shank": "shank",
    "foot": "sole_plate",
}

_LEAST_PART = 0.3
"""With a smaller part of a set's markers a trial is of another set."""

_COMMON_PART = 0.5
"""A word at the start or end of more names than this is no part of them: the subject's name, `_study`."""

_MARKS = r"[\s:._-]"
"""What separates words of a name."""

_MOST_PREFIXES = 3
"""Words before the names of a trial: a subject's name and number."""

_MOST_NAMES = 15
"""Unused markers that are named."""

_FILLERS = ("MARKER", "MRK", "STUDY")
"""Words at the end of a marker's name that say nothing."""


class Recognised(NamedTuple):
    """A trial's markers as those of a set.

    Attributes:
        chosen: The set.
        own: Marker of the set -> the trial's own name.
        unused: Names of the trial's other markers.
    """

    chosen: MarkerSet
    own: dict[str, str]
    unused: tuple[str, ...]

    @property
    def sentence(self) -> str:
        """Which set, how much of it, and what is left over."""
        text = f"marker set {self.chosen.name}: {len(self.own)} of its {len(self.chosen.spots)} markers"
        if not self.unused:
            return f"{text}; every marker of the file is used"
        shown = ", ".join(self.unused[:_MOST_NAMES]) + " ..." * (len(self.unused) > _MOST_NAMES)
        return f"{text}; not used: {len(self.unused)} of the file's ({shown})"


def recognise(names: Iterable[str], chosen: MarkerSet | None = None) -> Recognised:
    """The set that a trial's markers belong to: the one with most of them and no segment bare.

    Args:
        names: The trial's markers.
        chosen: The set, where it is known.

    Raises:
        GaitError: Too few markers to determine every segment; the message says which.
    """
    given = list(as_names("names", names, error=GaitError))
    candidates = SETS.values() if chosen is None else [chosen]
    matches = [(entry, _matched(entry, spelling)) for entry in candidates for spelling in _spellings(given)]
    best, own = max(matches, key=lambda match: _merit(*match))
    _check(best, own, given, known=chosen is not None)
    used = set(own.values())
    return Recognised(best, own, tuple(name for name in given if name not in used))


def fewest_on(link: str) -> int:
    """Fewest markers that determine a link of the robot."""
    return FEWEST[next(segment for segment in FEWEST if link.endswith(_LINK_ENDS[segment]))]


def _merit(entry: MarkerSet, own: Mapping[str, str]) -> tuple[bool, float]:
    """Whether it can be used; then the markers found times the part of the set that they are."""
    complete = not list(gaps(entry, own)) and not list(_unscaled(entry, own))
    return complete, len(own) ** 2 / len(entry.spots)


def _matched(entry: MarkerSet, spelling: Mapping[str, str]) -> dict[str, str]:
    """Marker of the set -> the trial's name; no name of the trial twice."""
    out: dict[str, str] = {}
    for marker in entry.spots:
        for name in entry.names(marker):
            own = spelling.get(plain(name))
            if own is not None and own not in out.values():
                out[marker] = own
                break
    return out


def _spellings(names: list[str]) -> Iterator[dict[str, str]]:
    """Plain name -> own name, as it stands, and without the words that most names share."""
    for spelled in (names, [_without_filler(name) for name in names]):
        yield _plainly(spelled, names)
        short = spelled
        for _ in range(_MOST_PREFIXES):
            prefix = _shared_prefix(short)
            if not prefix:
                break
            short = [name[len(prefix) + 1 :] if _has(name, prefix) else name for name in short]
            yield _plainly(short, names)


def _plainly(spelled: list[str], own: list[str]) -> dict[str, str]:
    out: dict[str, str] = {}
    for name, given in zip(spelled, own, strict=True):
        out.setdefault(plain(name), given)
    return out


def _without_filler(name: str) -> str:
    """A name without a word at its end that says nothing; its marks stay."""
    return re.sub(rf"(?i)[\s:._-]*({'|'.join(_FILLERS)})$", "", name) or name


def _shared_prefix(names: list[str]) -> str:
    """The word that more than `_COMMON_PART` of the names begin with, or ""."""
    words = [re.split(_MARKS, name, maxsplit=1)[0] for name in names if re.search(_MARKS, name)]
    (word, count), *_ = Counter(words).most_common(1) or [("", 0)]
    return word if count > _COMMON_PART * len(names) else ""


def _has(name: str, prefix: str) -> bool:
    return re.match(re.escape(prefix) + _MARKS, name) is not None


def _check(chosen: MarkerSet, found: Mapping[str, str], given: list[str], *, known: bool) -> None:
    """Raises `GaitError` where a segment lacks markers, or lengths have no markers."""
    wants = list(gaps(chosen, found)) or list(_unscaled(chosen, found))
    if wants and not known and len(found) < _LEAST_PART * len(chosen.spots):
        shown = f"{', '.join(given[:10])}{' ...' * (len(given) > 10)}"
        raise GaitError(
            f"its markers ({shown}) are of no known set ({', '.join(SETS)}); --map OWN=NAME maps names, "
            "--markers SET.toml gives a set of one's own, --model SUBJECT.osim a model's"
        )
    if wants:
        others = f"other names can be mapped; known sets: {', '.join(SETS)}"
        raise GaitError(f"marker set {chosen.name}: {'; '.join(wants)} ({others})")


def gaps(chosen: MarkerSet, found: Iterable[str]) -> Iterator[str]:
    """Which markers segments lack.

    Args:
        chosen: The set.
        found: Markers of the set that are there.
    """
    there = set(found)
    segments: dict[str, list[str]] = {"pelvis": []}
    for side in SIDES:
        segments |= {f"{side} {segment}": [] for segment in ("thigh", "shank", "foot")}
    for marker, spot in chosen.spots.items():
        segments[f"{spot.side} {spot.segment}" if spot.side else spot.segment].append(marker)
    for name, markers in segments.items():
        needed = next(count for segment, count in FEWEST.items() if name.endswith(segment))
        gone = [marker for marker in markers if marker not in there]
        if len(markers) - len(gone) < needed:
            has = f"{name} has {len(markers) - len(gone)} of the {needed} markers that it needs"
            yield f"{has}, missing: {', '.join(gone) or 'the set has no more'}"


def _unscaled(chosen: MarkerSet, found: Mapping[str, str]) -> Iterator[str]:
    """Which markers of the pelvis's scale are not there; a model has its own scale."""
    if chosen.sizes is not None:
        return
    fronts = [marker for marker in chosen.marking("asis") if marker not in found]
    if fronts or len(chosen.marking("asis")) < 2:
        names = ", ".join(fronts) or "asis of both sides"
        yield f"{names} missing, which give{'s' * (len(fronts) == 1)} the scale"
    backs = [marker for mark in ("psis", "sacrum") for marker in chosen.marking(mark)]
    middle = [marker for marker in chosen.marking("sacrum") if marker in found]
    pair = [marker for marker in chosen.marking("psis") if marker in found]
    if not middle and len(pair) < 2 and isinstance(chosen.hips, str):
        names = " or ".join(backs) or "sacrum, or psis of both sides"
        yield f"{names} missing, which give the pelvis's depth"
