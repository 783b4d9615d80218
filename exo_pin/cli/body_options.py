"""The body on the command line: whose it is, by options, a body file, or the person in the trial."""

from __future__ import annotations

import argparse
import contextlib
import sys
from typing import TYPE_CHECKING, Any

from exo_pin.anatomy import SIDES, Body
from exo_pin.anatomy.sized_body import SizedBody, body_of_file, sized_body
from exo_pin.anatomy.sizes import LEG_SIZES, SIZES
from exo_pin.cli import measures, show, trials
from exo_pin.errors import DescriptionError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from exo_pin.anatomy.person import Measure

_WHOLE = ("stature", "mass", "hip_width", "waist_width")
"""Sizes that are no leg's."""


def add(parser: argparse.ArgumentParser) -> None:
    """The body: a file, or a person's measures, or both (measures win)."""
    group = parser.add_argument_group("body (default: the person in the file, where it states or shows one)")
    group.add_argument("--body", metavar="FILE", help="body file, as `exo-pin body` writes it")
    group.add_argument(
        "--stature", type=measures.metres, metavar="M", help="height of the person [m] (default: 1.75)"
    )
    group.add_argument(
        "--mass", type=measures.kilograms, metavar="KG", help="mass of the person [kg] (default: 70)"
    )
    group.add_argument("--sex", choices=("male", "female"), help="whose segment masses (default: male)")
    group.add_argument(
        "--waist-width", type=measures.metres, metavar="M", help="inner width of the waist ring [m]"
    )
    group.add_argument(
        "--hip-width", type=measures.metres, metavar="M", help="between the hip joint centres [m]"
    )
    group.add_argument("--no-wearer", action="store_true", help="the bare device: nobody's mass in it")
    group.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="any other size, e.g. thigh=0.43 or left_thigh=0.42 (see `exo-pin body`)",
    )


def sized(args: argparse.Namespace) -> SizedBody:
    """The body of the arguments with the origin of every size.

    The command line wins over the trial's markers, these over joint centres, these over the file's header or
    model; what nobody states follows from stature and mass.

    Raises:
        DescriptionError: A measure is not plausible.
        FormatError: The trial or the model cannot be read.
    """
    measures = {name: getattr(args, name) for name in ("stature", "mass", "sex", "waist_width", "hip_width")}
    values: dict[str, Any] = {name: value for name, value in measures.items() if value is not None}
    values |= dict(map(assignment, args.set))
    if args.no_wearer:
        values["wearer"] = False
    if args.body is None:
        return sized_body(trials.person(args), sex=values.pop("sex", "male"), given=values)
    grown = {"stature", "mass", "sex"} & set(values)
    if grown:
        raise DescriptionError(
            f"--body holds every size already; --{sorted(grown)[0]} would contradict it (change the file)"
        )
    return body_of_file(Body.load(args.body), args.body, values)


def print_person(args: argparse.Namespace) -> None:
    """The body by the file's person, if it states or shows one, and what is not used; lines on stderr."""
    found = sized(args)
    if found.person.sizes:
        print(f"body: {words(found)}", file=sys.stderr)
    for remark in found.person.remarks:
        print(f"note: {show.plain(remark)}", file=sys.stderr)


def words(found: SizedBody) -> str:
    """Stature, mass and legs with their origins, in one line."""
    measures = found.measures
    whole = ", ".join(
        f"{measures[name].value:.{digits}f} {unit} ({_origin(measures[name])})"
        for name, digits, unit in (("stature", 2, "m"), ("mass", 0, "kg"))
    )
    legs = " and ".join(f"{leg.length:.3f}" for leg in found.body.legs)
    origins = dict.fromkeys(
        measures[f"{side}_{name}"].origin for side in SIDES for name in ("thigh", "shank")
    )
    return f"{whole}, legs left and right {legs} m from hip to sole ({', '.join(origins)})"


def to_json(found: SizedBody) -> dict[str, Any]:
    """Every size of the body, and what else is known of the person, with its origin."""
    return {
        "sizes": {name: _measure_to_json(x, name) for name, x in found.measures.items()},
        "also_stated": {name: _measure_to_json(x, name) for name, x in found.person.others.items()},
        "remarks": list(found.person.remarks),
    }


COLUMNS = ("size of the body", "left", "right", "unit", "by")
"""Headings of `rows`."""


def rows(found: SizedBody) -> list[list[str]]:
    """The person's sizes as rows of a table: name, values left and right (or of the whole), unit, origin."""
    out = [_row(name.replace("_", " "), [found.measures[name]], name) for name in _WHOLE]
    for name in LEG_SIZES:
        both = [found.measures[f"{side}_{name}"] for side in SIDES]
        out.append(_row(name.replace("_", " "), both, name))
    stated = found.person.others
    for name in dict.fromkeys(name.partition("_")[2] for name in stated):
        pair = [stated.get(f"{side}_{name}") for side in SIDES]
        out.append(_row(f"{name.replace('_', ' ')} (stated, not in the model)", pair, name))
    return out


def _row(title: str, measures: Sequence[Measure | None], name: str) -> list[str]:
    values = ["-" if x is None else f"{x.value:.{1 if _unit(name) == 'kg' else 3}f}" for x in measures]
    origins = " / ".join(dict.fromkeys(x.origin for x in measures if x))
    return [title, *values, *[""] * (2 - len(values)), _unit(name), origins]


def assignment(text: str, *, sign: str = "=") -> tuple[str, Any]:
    """`name=value` as a pair; numbers and true/false are read as such, a size with or without its unit.

    Raises:
        DescriptionError: There is no sign in it.
    """
    name, found, value = text.partition(sign)
    if not found or not name:
        raise DescriptionError(f"{text!r} is not of the form name{sign}value")
    if value in ("true", "false"):
        return name, value == "true"
    with contextlib.suppress(ValueError):
        return name, measures.number(value)
    size = SIZES.get(name) or LEG_SIZES.get(name)
    if size is not None:
        with contextlib.suppress(argparse.ArgumentTypeError):
            return name, (measures.metres if size.unit == "m" else measures.kilograms)(value)
    return name, value


def _measure_to_json(measure: Measure, name: str) -> dict[str, Any]:
    return {"value": measure.value, "unit": _unit(name), "origin": measure.origin, "said": measure.detail}


def _unit(name: str) -> str:
    return "kg" if "mass" in name or name.endswith("hardware") else "m"


def _origin(measure: Measure) -> str:
    """The origin, or that nothing states the size."""
    return "nothing states it: default" if measure.origin == "default" else measure.origin
