"""`Device`: one exoskeleton as a frozen record, checked when it is made."""

from __future__ import annotations

import dataclasses
import functools
import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

from exo_pin.anatomy.names import JOINTS, MOVEMENTS, SIDES
from exo_pin.arguments import names, number, real, table, word
from exo_pin.devices.actuator import (
    ADDED_JOINT_RANGES,
    DEFAULT_ACCELERATIONS,
    DEFAULT_ACTUATORS,
    Actuator,
)
from exo_pin.errors import DescriptionError, UnknownNameError
from exo_pin.frozen_fields import set_fields
from exo_pin.short_repr import short_repr

SLIDES = ("pelvis_forward", "pelvis_left", "pelvis_up")
"""Slides that may carry the pelvis, from the stand outwards; the name is the positive direction."""

TOES = ("left_toe_dorsiflexion", "right_toe_dorsiflexion")
"""Joints across the balls of the feet, of devices whose soles end there; toes up is positive."""

_CARRIED = ("held", "free")
_NAME = re.compile(r"[a-z][a-z0-9_]{0,39}")


@dataclass(frozen=True, eq=False, kw_only=True)
class Device:
    """One exoskeleton, or a planar model of a walker.

    Every joint of `JOINTS` is driven, passive (it moves, without a motor) or locked at zero. A passive joint
    is held at zero too unless the device is asked to let it go (`released`).

    Attributes:
        name: What `load_robot(device=...)` calls it: lower-case letters, digits and `_`.
        title: What people call it.
        joints: The joints that it drives, names of `JOINTS` in their order.
        passive: Joints that move without a motor.
        pelvis: How the device carries the pelvis: `"held"` still; `"free"`, with the person; or slides along
            `SLIDES`, which move the pelvis upright and without turning it.
        toes: Whether the soles end at the balls of the feet, with driven toes in front.
        actuators: By movement (of `MOVEMENTS`, `SLIDES` or `"toe_dorsiflexion"`), the same left and right.
        ranges: By movement, the device's own range (lower, upper) [rad] (slides: [m]); a joint's range is
            what the device and the body both allow.
        treadmill: Slowest and fastest speed of its belt [m/s]; None: it has none, or no source tells.
        statures: Shortest and tallest person whom it fits [m]; None: no source tells.
        masses: Lightest and heaviest person [kg], likewise; 0 where a source has the heaviest alone.
        thighs: Shortest and longest thigh, hip centre to knee [m], likewise.
        shanks: Shortest and longest shank, knee to ankle [m], likewise.
        hip_breadths: Least and largest breadth over the hips, with soft tissue [m], likewise.
        source: Where the joints and every number come from.
        remarks: Where sources differ, and what the record leaves out.

    Raises:
        DescriptionError: The parts contradict each other, or a number is not plausible.
        UnknownNameError: A joint or movement is unknown.
    """

    name: str
    joints: tuple[str, ...]
    source: str
    title: str = ""
    passive: tuple[str, ...] = ()
    pelvis: str | tuple[str, ...] = "held"
    toes: bool = False
    actuators: Mapping[str, Actuator] = field(default_factory=dict)
    ranges: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    treadmill: tuple[float, float] | None = None
    statures: tuple[float, float] | None = None
    masses: tuple[float, float] | None = None
    thighs: tuple[float, float] | None = None
    shanks: tuple[float, float] | None = None
    hip_breadths: tuple[float, float] | None = None
    remarks: tuple[str, ...] = ()

    __repr__ = short_repr

    def __post_init__(self) -> None:
        if not _NAME.fullmatch(self.name):
            raise DescriptionError(
                f"device name {self.name!r}: lower-case letters, digits and _ are accepted"
            )
        set_fields(self, joints=_in_order("joints", self.joints), passive=_in_order("passive", self.passive))
        both = set(self.joints) & set(self.passive)
        if both:
            raise DescriptionError(f"device {self.name}: {min(both)} is driven and passive at once")
        if not self.joints:
            raise DescriptionError(f"device {self.name} drives no joint")
        self._check_pelvis()
        set_fields(self, **{name: _span(name, getattr(self, name), most) for name, most in _SPANS.items()})
        complete = {movement: _actuator(movement, self.actuators) for movement in self._movements}
        set_fields(
            self,
            actuators=MappingProxyType(complete),
            ranges=MappingProxyType(_checked_ranges(self.ranges)),
        )

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickled by its fields, since a read-only mapping cannot be: for work in other processes."""
        values = {f.name: getattr(self, f.name) for f in dataclasses.fields(self)}
        plain = {name: dict(values[name]) for name in ("actuators", "ranges")}
        return functools.partial(type(self), **(values | plain)), ()

    def _check_pelvis(self) -> None:
        if isinstance(self.pelvis, str):
            if self.pelvis not in _CARRIED:
                raise DescriptionError(f"device {self.name}: pelvis is {self.pelvis!r}; held, free or slides")
            return
        for name in self.pelvis:
            if name not in SLIDES:
                raise UnknownNameError("slide", name, SLIDES)
        set_fields(self, pelvis=tuple(name for name in SLIDES if name in self.pelvis))

    @property
    def _movements(self) -> tuple[str, ...]:
        extra = ("toe_dorsiflexion",) if self.toes else ()
        return (*MOVEMENTS, *self.slides, *extra)

    @property
    def slides(self) -> tuple[str, ...]:
        """The slides that carry the pelvis."""
        return () if isinstance(self.pelvis, str) else self.pelvis

    @property
    def stand(self) -> tuple[str, ...]:
        """Links that carry the pelvis: the stand, and a carriage for each slide but the last."""
        return ("stand", *(f"{slide}_carriage" for slide in self.slides[:-1])) if self.slides else ()

    @property
    def added(self) -> tuple[str, ...]:
        """Joints that the 12-joint exoskeleton does not have."""
        return (*self.slides, *(TOES if self.toes else ()))

    @property
    def locked(self) -> tuple[str, ...]:
        """Joints of `JOINTS` that stand at zero: neither driven nor released."""
        return tuple(joint for joint in JOINTS if joint not in self.joints)

    @property
    def motors(self) -> int:
        """Number of driven joints, slides and toes: what moves without torque does not count."""
        return sum(self.actuators[movement_of(joint)].effort > 0 for joint in (*self.joints, *self.added))

    def released(self) -> Device:
        """The same device with its passive joints let go: they move, without torque."""
        if not self.passive:
            return self
        free = {movement_of(joint) for joint in self.passive}
        if free & {movement_of(joint) for joint in self.joints}:
            raise DescriptionError(f"device {self.name}: driven on one side, passive on the other")
        actuators = {
            movement: actuator._replace(effort=0.0) if movement in free else actuator
            for movement, actuator in self.actuators.items()
        }
        joints = (*self.joints, *self.passive)
        return dataclasses.replace(self, joints=joints, passive=(), actuators=actuators)

    def carried(self) -> Device:
        """The same device on a pelvis that somebody else moves: without its slides."""
        return dataclasses.replace(self, pelvis="free") if self.slides else self

    def range_of(self, joint: str, own: tuple[float, float]) -> tuple[float, float]:
        """What device and body (`own` range) both allow [rad].

        Raises:
            DescriptionError: They have nothing in common, or `own` is no pair of finite numbers.
            UnknownNameError: The joint is unknown.
        """
        word("joint", joint, (*JOINTS, *SLIDES, *TOES))
        real("own", own, (2,))
        lower, upper = self.ranges.get(movement_of(joint), own)
        both = max(lower, own[0]), min(upper, own[1])
        if not both[0] < both[1]:
            raise DescriptionError(
                f"{joint}: the ranges of the device {self.name} and of the body do not meet"
            )
        return both


def movement_of(joint: str) -> str:
    """A joint's name without its side: `left_knee_flexion` -> `knee_flexion`; other names stay.

    Raises:
        DescriptionError: The name is no text.
    """
    if not isinstance(joint, str):
        raise DescriptionError(f"joint is {joint!r}; a joint's name is accepted, e.g. 'left_knee_flexion'")
    side, _, movement = joint.partition("_")
    return movement if side in SIDES else joint


def both(*movements: str) -> tuple[str, ...]:
    """Joints of both sides, in the order of `JOINTS`.

    Raises:
        UnknownNameError: A movement is unknown.
    """
    for movement in movements:
        word("movement", movement, MOVEMENTS)
    return tuple(joint for joint in JOINTS if movement_of(joint) in movements)


def subset(movements: Iterable[str], *, name: str = "subset") -> Device:
    """The 12-joint exoskeleton with only these movements driven on both sides, the others locked.

    Raises:
        UnknownNameError: A movement is unknown.
        DescriptionError: None is given.
    """
    return Device(
        name=name,
        joints=both(*names("movements", movements)),
        source="A part of the 12 joints, for comparison.",
    )


def _in_order(name: str, joints: Iterable[str]) -> tuple[str, ...]:
    given = names(name, joints)
    for joint in given:
        word("joint", joint, JOINTS)
    return tuple(joint for joint in JOINTS if joint in given)


def _actuator(movement: str, given: Mapping[str, Actuator]) -> Actuator:
    for name in table("actuators", given):
        word("movement", name, DEFAULT_ACTUATORS)
    found = given.get(movement, DEFAULT_ACTUATORS[movement])
    if not isinstance(found, tuple) or len(found) != len(Actuator._fields):
        raise DescriptionError(f"actuator of {movement} is {found!r}; an Actuator is accepted")
    effort, velocity, own = found
    return Actuator(
        number(f"effort of {movement}", effort, least=0.0),
        number(f"velocity of {movement}", velocity, above=0.0),
        _acceleration(movement, own),
    )


def _acceleration(movement: str, own: float | None) -> float:
    """The largest acceleration of a movement; infinite where there is no limit."""
    found = DEFAULT_ACCELERATIONS[movement] if own is None else own
    return math.inf if found == math.inf else number(f"acceleration of {movement}", found, above=0.0)


_SPANS = {
    "treadmill": 10.0,
    "statures": 10.0,
    "masses": 500.0,
    "thighs": 10.0,
    "shanks": 10.0,
    "hip_breadths": 10.0,
}
"""Entries that are a range, and the largest value that is accepted [m/s, m, kg]."""


def _span(what: str, pair: tuple[float, float] | None, most: float) -> tuple[float, float] | None:
    if pair is None:
        return None
    low, high = real(what, pair, (2,)).tolist()
    if not 0.0 <= low < high <= most:
        raise DescriptionError(
            f"{what} is {low:g} .. {high:g}; lower < upper, from 0 to {most:g}, is accepted"
        )
    return low, high


def _checked_ranges(given: Mapping[str, tuple[float, float]]) -> dict[str, tuple[float, float]]:
    known = {*MOVEMENTS, *ADDED_JOINT_RANGES}
    ranges = dict(ADDED_JOINT_RANGES)
    for name, pair in table("ranges", given).items():
        word("movement", name, sorted(known))
        lower, upper = real(f"range of {name}", pair, (2,)).tolist()
        if not -math.pi <= lower < upper <= math.pi:
            raise DescriptionError(f"range of {name}: lower < upper, within half a turn or 3 m, is accepted")
        ranges[name] = (lower, upper)
    return ranges
