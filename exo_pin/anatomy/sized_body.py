"""The body of a person: sizes that are known, the rest by stature and mass; each with its origin."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from exo_pin.anatomy.anthropometry import BALL_FRACTION, HEEL_FRACTION
from exo_pin.anatomy.body import Body, both_sides
from exo_pin.anatomy.human import DEFAULT_MASS, DEFAULT_STATURE, usual_mass
from exo_pin.anatomy.names import OTHER_SIDE, SIDES, Sex, SizeOrigin
from exo_pin.anatomy.person import LEG_PART, Measure, Person
from exo_pin.anatomy.sizes import LEG_SIZES, SIZES


@dataclass(frozen=True, eq=False)
class SizedBody:
    """A body, and where each of its sizes comes from.

    Attributes:
        body: The body.
        measures: By the names of `SIZES`; the values are those of the body.
        person: What was known of the person.
    """

    body: Body
    measures: Mapping[str, Measure]
    person: Person = field(default_factory=Person)

    @property
    def own_legs(self) -> bool:
        """Whether the lengths of the legs are this person's: measured, stated, or by their stature."""
        return self.measures["stature"].origin != "default"


def sized_body(person: Person, *, sex: Sex = "male", given: Mapping[str, Any] | None = None) -> SizedBody:
    """The body of a person; what is given wins over what is known of them.

    A stature that is given describes another person, so lengths that are known are left out then; the mass
    stays. A stature that is not known follows from the length of the legs, and a leg of which nothing is
    known is as long as the other.

    Args:
        person: What is known.
        sex: Whose segment masses.
        given: Fields of `Body` by the user, both sides at once without the side's name (`thigh`).

    Raises:
        DescriptionError: A value is not plausible.
        UnknownNameError: A name in `given` is no field of `Body`.
    """
    fields = both_sides(given or {})
    known = dict(Person(_both_legs(person.sizes)).sizes)
    if "stature" in fields:
        known = {name: measure for name, measure in known.items() if name == "mass"}
    known |= _parts_of_feet(known)
    values: dict[str, Any] = (
        {"sex": sex} | {name: round(measure.value, 6) for name, measure in known.items()} | fields
    )
    values.setdefault("stature", round(_stature(known).value, 4))
    values.setdefault("mass", round(_mass(known).value, 3))
    body = Body.from_stature(**values)
    stated = {name: Measure(getattr(body, name), "command line") for name in fields if name in SIZES}
    return SizedBody(body, _measures(body, known, stated), person)


def body_of_file(body: Body, path: str, given: Mapping[str, Any] | None = None) -> SizedBody:
    """A body that a file of its own holds, with fields that the user changes.

    Args:
        body: As the file has it.
        path: The file.
        given: Fields of `Body` by the user, both sides at once without the side's name (`thigh`).

    Raises:
        DescriptionError: A value is not plausible.
        UnknownNameError: A name in `given` is no field of `Body`.
    """
    fields = both_sides(given or {})
    changed = replace(body, **fields)
    origins: dict[str, tuple[SizeOrigin, str]] = dict.fromkeys(fields, ("command line", ""))
    measures = {
        name: Measure(getattr(changed, name), *origins.get(name, ("body file", path))) for name in SIZES
    }
    return SizedBody(changed, measures)


def _both_legs(sizes: Mapping[str, Measure]) -> dict[str, Measure]:
    """The sizes, and those of a leg that only the other one has."""
    out = dict(sizes)
    for side in SIDES:
        for name in LEG_SIZES:
            other = sizes.get(f"{OTHER_SIDE[side]}_{name}")
            if f"{side}_{name}" not in sizes and other is not None:
                detail = f"as the {OTHER_SIDE[side]} one" + (f": {other.detail}" if other.detail else "")
                out[f"{side}_{name}"] = other._replace(detail=detail)
    return out


def _parts_of_feet(known: Mapping[str, Measure]) -> dict[str, Measure]:
    """Heel and ball of a foot whose length is known, as shares of it."""
    shares = {"heel": HEEL_FRACTION, "ball": BALL_FRACTION}
    return {
        f"{side}_{name}": Measure(share * foot.value, foot.origin, f"{share:g} of the foot's length")
        for side in SIDES
        if (foot := known.get(f"{side}_foot_length"))
        for name, share in shares.items()
        if f"{side}_{name}" not in known
    }


def _stature(known: Mapping[str, Measure]) -> Measure:
    if "stature" in known:
        return known["stature"]
    leg = Person(known).hip_to_ankle
    if leg is None:
        return Measure(DEFAULT_STATURE, "default", "nothing states it")
    detail = "by the legs from hip to ankle (Drillis & Contini 1966)"
    thigh = next(known[name] for name in ("left_thigh", "right_thigh") if name in known)
    return Measure(leg / LEG_PART, thigh.origin, detail)


def _mass(known: Mapping[str, Measure]) -> Measure:
    if "mass" in known:
        return known["mass"]
    stature = _stature(known)
    if stature.origin == "default":
        return Measure(DEFAULT_MASS, "default", "nothing states it")
    return Measure(usual_mass(stature.value), "stature table", "usual for the stature")


def _measures(body: Body, known: Mapping[str, Measure], stated: Mapping[str, Measure]) -> dict[str, Measure]:
    """The origin of every size of a body.

    Args:
        body: The body.
        known: What is known of the person and used; a stature or mass that it lacks follows from it alone.
        stated: What the user gave.
    """
    known = {"stature": _stature(known), "mass": _mass(known), **known, **stated}
    origins = {name: known.get(name) or _by_table(name, known) for name in SIZES}
    return {name: origin._replace(value=getattr(body, name)) for name, origin in origins.items()}


def _by_table(name: str, known: Mapping[str, Measure]) -> Measure:
    """The origin of a size that follows from stature or mass, or from nothing."""
    if name.endswith("_hardware"):
        return Measure(0.0, "default", "of the device")
    if SIZES[name].unit == "kg":
        default = known["mass"].origin == "default"
        return Measure(0.0, "default" if default else "mass table", "share of the mass (de Leva 1996)")
    if name == "waist_width":
        default = known["mass"].origin == "default"
        return Measure(0.0, "default" if default else "mass table", "breadth over the hips by the mass")
    default = known["stature"].origin == "default"
    return Measure(0.0, "default" if default else "stature table", "share of the stature")
