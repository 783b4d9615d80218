"""Mass, centre of mass and inertia of every link: the wearer's segments and the device's hardware.

Link names are those of the URDF. A link's inertia is the sum of its parts, each an `Inertial` placed in the
link's frame (x forward, y left, z up at q = 0; origin at the link's joint), brought together by the
parallel-axis theorem.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Sequence
from typing import NamedTuple, get_args

import numpy as np

from exo_pin.anatomy import anthropometry
from exo_pin.anatomy.body import Body, Leg
from exo_pin.anatomy.names import CORNERS, FEET, SIDES, Masses, Sex
from exo_pin.arrays import Array
from exo_pin.errors import DescriptionError, UnknownNameError


class Inertial(NamedTuple):
    """A rigid part of a link.

    Attributes:
        mass: [kg].
        centre: Centre of mass in the link's frame (3,) [m].
        inertia: About the centre of mass, in the link's axes (3, 3) [kg m^2].
    """

    mass: float
    centre: Array
    inertia: Array


FRAME = Inertial(0.001, np.zeros(3), 1e-7 * np.eye(3))
"""A point of interest on the sole, 1 g: readers of a URDF give a link without mass 1 kg, or refuse it."""

_CARRIAGE = 0.05
"""Share of each carriage of a stand in `Body.pelvis_hardware`, a design choice: 0.3 kg of 6 kg."""


def total(parts: Iterable[Inertial]) -> Inertial:
    """The parts as one body (parallel-axis theorem)."""
    parts = list(parts)
    mass = sum(part.mass for part in parts)
    centre = np.sum([part.mass * part.centre for part in parts], axis=0) / mass
    inertia = np.zeros((3, 3))
    for part in parts:
        d = part.centre - centre
        inertia += part.inertia + part.mass * (d @ d * np.eye(3) - np.outer(d, d))
    return Inertial(mass, centre, inertia)


def link_inertias(
    body: Body, *, toes: bool = False, stand: Sequence[str] = (), masses: Masses = "both"
) -> dict[str, Inertial]:
    """Mass, centre and inertia of each link by link name: carriages, pelvis, six links a leg, frames.

    The masses sum up to `Body.total_mass`: frames take theirs from foot plates, the stand from the pelvis. Of
    the wearer alone they sum up to `Body.mass`: links that are hardware only weigh as little as a frame,
    which the upper body gives.

    Args:
        body: Sizes and masses.
        toes: Whether the foot plate is two links, `sole_plate` and in front of the ball `toe_plate`; the
            wearer's foot then stays with the sole plate.
        stand: Names of the links that carry the pelvis, all in its place at q = 0: the stand itself, which is
            fixed and weighs as little as a frame, then its carriages.
        masses: Whose masses: the wearer's, the device's, or both as far as `body.wearer` has them.

    Raises:
        DescriptionError: The wearer's masses of a bare device.
        UnknownNameError: There are no such masses.
    """
    if masses not in get_args(Masses):
        raise UnknownNameError("masses", str(masses), get_args(Masses))
    if masses == "wearer":
        return _wearer_links(body, toes=toes, stand=stand)
    if masses == "device":
        body = dataclasses.replace(body, wearer=False)
    return _worn_links(body, toes=toes, stand=stand)


def _worn_links(body: Body, *, toes: bool, stand: Sequence[str]) -> dict[str, Inertial]:
    """The device's links, with the wearer's masses unless the body is the bare device's."""
    masses = {name: _CARRIAGE * body.pelvis_hardware if k else FRAME.mass for k, name in enumerate(stand)}
    links = {name: _bracket(mass) for name, mass in masses.items()}
    upper = _upper_body(body, body.upper_mass) if body.wearer else []
    links["pelvis"] = total([*upper, _waist(body, body.pelvis_hardware - sum(masses.values()))])
    for side, s in zip(SIDES, (1.0, -1.0), strict=True):
        leg = body.leg(side)
        for name, parts in _leg(body, leg, s).items():
            links[f"{side}_{name}"] = total(parts)
        if toes:
            back, front = _plates(body, leg)
            worn = _wearer_leg(body, leg)["sole_plate"] if body.wearer else []
            links |= {f"{side}_sole_plate": total([back, *worn]), f"{side}_toe_plate": front}
    return links | dict.fromkeys((*FEET, *CORNERS), FRAME)


def _wearer_links(body: Body, *, toes: bool, stand: Sequence[str]) -> dict[str, Inertial]:
    """The same links with the wearer's masses alone."""
    if not body.wearer:
        raise DescriptionError("the body is a bare device's (wearer = false): it has no wearer's masses")
    toe_plates = [f"{side}_toe_plate" for side in SIDES] if toes else []
    links = dict.fromkeys((*stand, *toe_plates, *FEET, *CORNERS), FRAME)
    for side in SIDES:
        worn = _wearer_leg(body, body.leg(side))
        for name in ("hip_1", "hip_2", "thigh", "shank", "ankle", "sole_plate"):
            links[f"{side}_{name}"] = total(worn.get(name, [FRAME]))
    given = FRAME.mass * sum(part.mass == FRAME.mass for part in links.values())
    return links | {"pelvis": total(_upper_body(body, body.upper_mass - given))}


def _plate_mass(body: Body) -> float:
    """A foot plate without its five frames: the sole's and its corners'."""
    return body.foot_hardware - FRAME.mass * len((*FEET, *CORNERS)) / len(SIDES)


def _plates(body: Body, leg: Leg) -> tuple[Inertial, Inertial]:
    """The foot plate cut at the ball: behind it, seen from the ankle; in front of it, seen from the ball."""
    share, toe = (leg.heel + leg.ball) / leg.foot_length, leg.foot_length - leg.heel - leg.ball
    height = 0.006 - leg.ankle_height
    back = _box(
        share * _plate_mass(body),
        ((leg.ball - leg.heel) / 2, 0.0, height),
        (leg.heel + leg.ball, leg.foot_width, 0.012),
    )
    front = _box((1 - share) * _plate_mass(body), (toe / 2, 0.0, 0.006), (toe, leg.foot_width, 0.012))
    return back, front


def _leg(body: Body, leg: Leg, s: float) -> dict[str, list[Inertial]]:
    """Parts of a leg's links; `s` is +1 on the left. The hardware runs beside the leg, at the waist ring."""
    y = s * ((body.waist_width - body.hip_width) / 2 + 0.015)
    wearer = _wearer_leg(body, leg) if body.wearer else {}
    hardware = {
        "hip_1": _box(body.hip_hardware, (-0.03, y, 0.0), (0.10, 0.06, 0.10)),
        "hip_2": _box(body.hip_hardware, (-0.03, y, 0.0), (0.10, 0.06, 0.10)),
        "thigh": _box(body.thigh_hardware, (0.0, y, -leg.thigh / 2), (0.05, 0.03, leg.thigh)),
        "shank": _box(body.shank_hardware, (0.0, y, -leg.shank / 2), (0.05, 0.03, leg.shank)),
        "ankle": _box(body.ankle_hardware, (0.0, y, 0.0), (0.06, 0.05, 0.06)),
        "sole_plate": _box(
            _plate_mass(body),
            (leg.foot_length / 2 - leg.heel, 0.0, 0.006 - leg.ankle_height),
            (leg.foot_length, leg.foot_width, 0.012),
        ),
    }
    return {name: [part, *wearer.get(name, [])] for name, part in hardware.items()}


def _wearer_leg(body: Body, leg: Leg) -> dict[str, list[Inertial]]:
    table = anthropometry.DE_LEVA[body.sex]
    along = table["foot"].centre * leg.foot_length - leg.heel
    foot = _segment("foot", body.sex, leg.foot_mass, leg.foot_length, (along, 0.0, -leg.ankle_height / 2))
    sagittal, transverse, longitudinal = np.diag(foot.inertia)  # the foot's long axis lies forward
    foot = foot._replace(inertia=np.diag([longitudinal, transverse, sagittal]))
    down = {name: -table[name].centre * getattr(leg, name) for name in ("thigh", "shank")}
    return {
        "thigh": [_segment("thigh", body.sex, leg.thigh_mass, leg.thigh, (0.0, 0.0, down["thigh"]))],
        "shank": [_segment("shank", body.sex, leg.shank_mass, leg.shank, (0.0, 0.0, down["shank"]))],
        "sole_plate": [foot],
    }


def _upper_body(body: Body, mass: float) -> list[Inertial]:
    """Head, trunk and hanging arms above the hips, scaled to a mass [kg]."""
    table = anthropometry.DE_LEVA[body.sex]
    size = {name: fraction * body.stature for name, fraction in anthropometry.DESIGN_LENGTHS.items()}
    top = size["trunk"]  # shoulder line above the mid-hip
    head = top + (1 - table["head"].centre) * size["head"]
    heights = {"trunk": top * (1 - table["trunk"].centre), "head": head}
    places = [("trunk", 0.0, heights["trunk"]), ("head", 0.0, heights["head"])]
    for s in (1.0, -1.0):
        z = top
        for name in ("upper_arm", "forearm", "hand"):
            places.append((name, s * size["shoulder"], z - table[name].centre * size[name]))
            z -= size[name]
    scale = mass / sum(table[name].mass for name, _, _ in places)
    return [_segment(n, body.sex, scale * table[n].mass, size[n], (0.0, y, z)) for n, y, z in places]


def _waist(body: Body, mass: float) -> Inertial:
    """Waist ring and bracket as a box behind and around the body."""
    return _box(mass, (-0.08, 0.0, 0.10), (0.30, body.waist_width, 0.12))


def _bracket(mass: float) -> Inertial:
    """A stand's link as a box where the waist's centre is, so that the whole keeps its centre of mass."""
    return _box(mass, (-0.08, 0.0, 0.10), (0.08, 0.20, 0.06))


def _segment(name: str, sex: Sex, mass: float, length: float, centre: tuple[float, float, float]) -> Inertial:
    """A segment of de Leva's table: principal inertias mass * (radius of gyration * length)^2."""
    radii = np.array(anthropometry.DE_LEVA[sex][name].gyration) * length
    return Inertial(mass, np.array(centre), np.diag(mass * radii**2))


def _box(mass: float, centre: tuple[float, float, float], size: tuple[float, float, float]) -> Inertial:
    """A solid box: I_xx = m (y^2 + z^2) / 12 and so on."""
    squares = np.array(size) ** 2
    return Inertial(mass, np.array(centre), np.diag(mass / 12 * (squares.sum() - squares)))
