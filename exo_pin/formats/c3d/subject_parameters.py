"""Sizes of the person among the parameters of a C3D file, as Vicon and others name them."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from typing import NamedTuple

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.anthropometry import LENGTHS
from exo_pin.anatomy.davis_hip import hip_to_ankle
from exo_pin.anatomy.person import LEG_PART, Measure, Person
from exo_pin.formats.c3d.parameters import C3dParameters

GROUPS = ("PROCESSING", "SUBJECTS", "SUBJECT", "PATIENT", "ANTHROPOMETRY")
"""Groups of parameters that are looked through; a size of an earlier one wins."""

_THIGH_PART = LENGTHS["thigh"] / LEG_PART


class _Quantity(NamedTuple):
    """A quantity of a person in a file's parameters.

    Attributes:
        words: How files call it, in capitals without marks.
        low: Least value of any person [m or kg]; no unit of length but one makes a value lie between both.
        high: Largest one.
        unit: `"m"` or `"kg"`.
    """

    words: tuple[str, ...]
    low: float
    high: float
    unit: str = "m"


_WHOLE = {
    "stature": _Quantity(("HEIGHT", "BODYHEIGHT", "SUBJECTHEIGHT", "STATURE"), 0.45, 2.6),
    "mass": _Quantity(("BODYMASS", "MASS", "SUBJECTMASS", "BODYWEIGHT", "WEIGHT"), 2.0, 400.0, "kg"),
}
_OF_A_LEG = {
    "leg_length": _Quantity(("LEGLENGTH",), 0.15, 1.4),
    "thigh": _Quantity(("FEMURLENGTH", "THIGHLENGTH"), 0.07, 0.65),
    "shank": _Quantity(("TIBIALENGTH", "SHANKLENGTH"), 0.07, 0.65),
    "knee_width": _Quantity(("KNEEWIDTH",), 0.03, 0.25),
    "ankle_width": _Quantity(("ANKLEWIDTH",), 0.02, 0.15),
}
_LENGTH_UNITS = {"mm": 1e-3, "cm": 1e-2, "m": 1.0}
"""Vicon's unit first."""

_SIDE = "L|R|LEFT|RIGHT"


def stated_person(parameters: C3dParameters) -> Person:
    """The person by a file's parameters: height, mass, lengths of the legs, widths of knees and ankles.

    Vicon writes millimetres and kilograms, and 0 for what nobody measured. Lengths of femur and tibia are
    joint centre to joint centre; without them the clinical length of the leg gives both.

    Args:
        parameters: Of the file; of several subjects a parameter has one number each.
    """
    found, remarks = dict[str, Measure](), list[str]()
    for group, name, value in _first_values(parameters):
        for key, quantity in _matching(name):
            if key not in found:
                detail, measure = f"{group}:{_shown(name)} {value:g}", _measure(value, quantity)
                if measure is None:
                    accepted = f"{quantity.low:g} .. {quantity.high:g} {quantity.unit} is accepted"
                    remarks.append(f"{detail} is no person's and is not used; {accepted}")
                    continue
                found[key] = Measure(measure[0], "file's header", f"{detail} {measure[1]}")
                if measure[1] not in ("mm", "kg"):
                    remarks.append(f"{detail} is taken as {measure[1]}; in mm it would be no person's")
    subjects = int(parameters.number("SUBJECTS:USED") or 1)
    if subjects > 1 and found:
        remarks.append(f"{subjects} subjects are in the file; sizes of the body are the first one's")
    for side in SIDES:
        _add_segments(found, side)
    own = {name: x for name, x in found.items() if not name.endswith(("_width", "_length"))}
    return Person(own, {name: x for name, x in found.items() if name not in own}, tuple(remarks))


def _first_values(parameters: C3dParameters) -> Iterator[tuple[str, str, float]]:
    """Group, name and first value of each parameter that states something, in the order of `GROUPS`."""
    for wanted in GROUPS:
        for place in (*parameters.numbers, *parameters.texts):
            group, _, name = place.partition(":")
            value = _number(parameters, place) if group == wanted else None
            if value:
                yield wanted, name, value


def _number(parameters: C3dParameters, place: str) -> float | None:
    """The first number of a parameter; some writers have it as a text."""
    try:
        value = float(parameters.text(place) or "") if place in parameters.texts else parameters.number(place)
    except ValueError:
        return None
    return value if value is not None and math.isfinite(value) else None


def _matching(name: str) -> Iterator[tuple[str, _Quantity]]:
    """Our names of what a parameter states: of one leg, of both where it names no side, or of the whole."""
    plain = re.sub(r"[^A-Z]", "", name.rpartition(":")[2].upper())
    yield from ((key, quantity) for key, quantity in _WHOLE.items() if plain in quantity.words)
    for key, quantity in _OF_A_LEG.items():
        hit = re.fullmatch(rf"({_SIDE})?({'|'.join(quantity.words)})({_SIDE})?", plain)
        if hit:
            marks = (hit[1] or hit[3])[:1] if hit[1] or hit[3] else "LR"
            yield from ((f"{side}_{key}", quantity) for side in SIDES if side[0].upper() in marks)


def _measure(value: float, quantity: _Quantity) -> tuple[float, str] | None:
    """The value in metres or kilograms with its unit; None where no unit makes it a person's."""
    units = {"kg": 1.0} if quantity.unit == "kg" else _LENGTH_UNITS
    fitting = ((value * factor, unit) for unit, factor in units.items())
    return next((x for x in fitting if quantity.low <= x[0] <= quantity.high), None)


def _add_segments(found: dict[str, Measure], side: str) -> None:
    """Thigh and shank of a leg by its clinical length, where they are not both stated."""
    clinical = found.get(f"{side}_leg_length")
    if clinical is None or {f"{side}_thigh", f"{side}_shank"} <= set(found):
        return
    whole = hip_to_ankle(clinical.value)
    for name, part in (("thigh", _THIGH_PART), ("shank", 1 - _THIGH_PART)):
        detail = (
            f"{clinical.detail} from front spine to malleolus, less the hip's depth (Davis 1991), "
            f"{100 * part:.1f} % of it (Drillis & Contini 1966)"
        )
        found[f"{side}_{name}"] = clinical._replace(value=part * whole, detail=detail)


def _shown(name: str) -> str:
    """A parameter's name, fit to be printed."""
    return "".join(mark for mark in name if mark.isprintable())[:40]
