"""`Body`: sizes, masses and joint ranges of the wearer and the device, left and right apart."""

from __future__ import annotations

import dataclasses
import functools
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

from exo_pin.anatomy import anthropometry
from exo_pin.anatomy.human import DEFAULT_MASS, DEFAULT_STATURE
from exo_pin.anatomy.names import SIDES, Sex, Side
from exo_pin.anatomy.sizes import LEG_SIZES, SIZES, checked, checked_limits
from exo_pin.errors import DescriptionError, ExoPinError, FormatError, UnknownNameError
from exo_pin.frozen_fields import set_fields
from exo_pin.safe import toml_file
from exo_pin.short_repr import short_repr

_LONGEST_LEG = 0.75  # of the stature; 0.53 is average


class Leg(NamedTuple):
    """Sizes [m] and the wearer's masses [kg] of one leg; `LEG_SIZES` says what each one measures."""

    thigh: float
    shank: float
    ankle_height: float
    foot_length: float
    foot_width: float
    heel: float
    ball: float
    thigh_mass: float
    shank_mass: float
    foot_mass: float

    @property
    def length(self) -> float:
        """Hip centre to sole [m]."""
        return self.thigh + self.shank + self.ankle_height


@dataclass(frozen=True, kw_only=True)
class Body:
    """Sizes [m], masses [kg] and joint ranges [rad] of the wearer and the device.

    `Body.from_stature()` fills every field from anthropometric tables; any field can be overridden there or
    with `dataclasses.replace`. `exo_pin.anatomy.sizes.SIZES` says what each number measures and which range
    is plausible; a value outside raises `DescriptionError`.

    Attributes:
        sex: `"male"` or `"female"`: which of de Leva's tables gives centres of mass and radii of gyration.
        wearer: False for the bare device: sizes stay, the wearer's masses do not count.
        limits: Lower and upper limit [rad] by joint name; joints left out get the default.
    """

    stature: float
    mass: float
    hip_width: float
    waist_width: float
    left_thigh: float
    left_shank: float
    left_ankle_height: float
    left_foot_length: float
    left_foot_width: float
    left_heel: float
    left_ball: float
    left_thigh_mass: float
    left_shank_mass: float
    left_foot_mass: float
    right_thigh: float
    right_shank: float
    right_ankle_height: float
    right_foot_length: float
    right_foot_width: float
    right_heel: float
    right_ball: float
    right_thigh_mass: float
    right_shank_mass: float
    right_foot_mass: float
    pelvis_hardware: float = anthropometry.HARDWARE_MASSES["pelvis_hardware"]
    hip_hardware: float = anthropometry.HARDWARE_MASSES["hip_hardware"]
    thigh_hardware: float = anthropometry.HARDWARE_MASSES["thigh_hardware"]
    shank_hardware: float = anthropometry.HARDWARE_MASSES["shank_hardware"]
    ankle_hardware: float = anthropometry.HARDWARE_MASSES["ankle_hardware"]
    foot_hardware: float = anthropometry.HARDWARE_MASSES["foot_hardware"]
    sex: Sex = "male"
    wearer: bool = True
    limits: Mapping[str, tuple[float, float]] = field(default_factory=dict)

    __repr__ = short_repr

    @classmethod
    def from_stature(
        cls,
        stature: float = DEFAULT_STATURE,
        *,
        mass: float = DEFAULT_MASS,
        sex: Sex = "male",
        **overrides: Any,
    ) -> Body:
        """The body of average proportions; `exo_pin.anatomy.anthropometry` names the sources.

        Args:
            stature: Height of the person [m].
            mass: Mass of the person [kg].
            sex: `"male"` or `"female"`.
            **overrides: Any field of `Body`; a name without side (`thigh`, `foot_mass`) sets both legs.

        Raises:
            DescriptionError: A value is implausible.
            UnknownNameError: An override or the sex is unknown.
        """
        _check_sex(sex)
        average = anthropometry.average_sizes(checked("stature", stature), checked("mass", mass), sex)
        return cls(stature=stature, mass=mass, sex=sex, **(both_sides(average) | both_sides(overrides)))

    @classmethod
    def load(cls, path: str | Path) -> Body:
        """Read a body file; sizes left out follow from its `stature`, `mass` and `sex`.

        Raises:
            FormatError: The file is no TOML, or a name or value in it is not accepted.
        """
        values = toml_file.read(path)
        try:
            if "limits" in values:
                raise DescriptionError("joint ranges go into the table [limits_deg], in degrees")
            values["limits"] = _radians(values.pop("limits_deg", {}))
            return cls.from_stature(**values)
        except ExoPinError as error:
            raise FormatError(path, str(error)) from None

    def save(self, path: str | Path) -> None:
        """Write the body as TOML, joint ranges in degrees; replaces a file of that name whole or not at all.

        Raises:
            FormatError: The file cannot be written.
        """
        values = {f.name: getattr(self, f.name) for f in dataclasses.fields(self) if f.name != "limits"}
        degrees = {name: [round(math.degrees(x), 12) for x in pair] for name, pair in self.limits.items()}
        toml_file.write(
            path,
            "A body for exo_pin: lengths in metres, masses in kilograms, joint ranges in degrees.\n"
            "A size that is deleted follows from stature, mass and sex; one that stands here does not.",
            values,
            comments={name: f"{size.unit}, {size.what}" for name, size in SIZES.items()},
            tables={"limits_deg": degrees},
        )

    def __post_init__(self) -> None:
        set_fields(self, **{name: checked(name, getattr(self, name)) for name in SIZES})
        _check_sex(self.sex)
        if not isinstance(self.wearer, bool):
            raise DescriptionError(f"wearer is {self.wearer!r}; true or false is accepted")
        self._check_proportions()
        set_fields(self, limits=MappingProxyType(checked_limits(self.limits)))

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickled by its fields, since a read-only mapping cannot be: for work in other processes."""
        values = {f.name: getattr(self, f.name) for f in dataclasses.fields(self)}
        return functools.partial(type(self), **(values | {"limits": dict(self.limits)})), ()

    def _check_proportions(self) -> None:
        for side, leg in zip(SIDES, self.legs, strict=True):
            if leg.heel + leg.ball > leg.foot_length:
                raise DescriptionError(
                    f"{side}_heel + {side}_ball = {leg.heel + leg.ball:.3f} m is more than "
                    f"{side}_foot_length = {leg.foot_length:.3f} m"
                )
        if self.leg_length > self.stature * _LONGEST_LEG:
            raise DescriptionError(
                f"a leg of {self.leg_length:.2f} m (thigh + shank + ankle_height) does not go with "
                f"stature = {self.stature:.2f} m"
            )
        if self.waist_width <= self.hip_width:
            raise DescriptionError(
                f"waist_width = {self.waist_width:.3f} m must be more than hip_width = {self.hip_width:.3f} m"
            )
        if self.upper_mass <= 0:
            raise DescriptionError(
                f"the legs' masses leave nothing of mass = {self.mass:.1f} kg for the upper body"
            )

    def leg(self, side: Side) -> Leg:
        """Sizes and masses of the leg of `side` (`"left"` or `"right"`)."""
        if side not in SIDES:
            raise UnknownNameError("side", side, SIDES)
        return Leg(*(getattr(self, f"{side}_{name}") for name in Leg._fields))

    @property
    def legs(self) -> tuple[Leg, ...]:
        """Left and right leg."""
        return tuple(map(self.leg, SIDES))

    @property
    def leg_length(self) -> float:
        """Hip centre to sole of the longer leg [m]: the height of the standing pelvis."""
        return max(leg.length for leg in self.legs)

    @property
    def girth(self) -> float:
        """Breadth and depth / those of a person of the same stature and the usual mass."""
        return anthropometry.girth(self.stature, self.mass)

    @property
    def hip_breadth(self) -> float:
        """Breadth over the hips, with soft tissue [m]: the waist ring's inner width without its padding."""
        return self.waist_width - anthropometry.WAIST_CLEARANCE

    @property
    def upper_mass(self) -> float:
        """The wearer's head, arms and trunk [kg], lumped in the pelvis."""
        return self.mass - sum(leg.thigh_mass + leg.shank_mass + leg.foot_mass for leg in self.legs)

    @property
    def hardware_mass(self) -> float:
        """The bare device [kg]."""
        leg = self.thigh_hardware + self.shank_hardware + self.ankle_hardware + self.foot_hardware
        return self.pelvis_hardware + 2 * (2 * self.hip_hardware + leg)

    @property
    def total_mass(self) -> float:
        """Wearer (if any) and hardware [kg]."""
        return self.hardware_mass + (self.mass if self.wearer else 0.0)


def both_sides(values: Mapping[str, Any]) -> dict[str, Any]:
    """Spread names without side (`thigh`) over both legs; a name with its side wins.

    Raises:
        UnknownNameError: A name is no field of `Body`.
    """
    known = [f.name for f in dataclasses.fields(Body)]
    for name in values:
        if name not in known and name not in LEG_SIZES:
            raise UnknownNameError("size of the body", name, [*known, *LEG_SIZES])
    spread = {f"{side}_{name}": v for name, v in values.items() if name in LEG_SIZES for side in SIDES}
    return spread | {name: v for name, v in values.items() if name in known}


def _check_sex(sex: object) -> None:
    if not isinstance(sex, str) or sex not in anthropometry.DE_LEVA:
        raise UnknownNameError("sex", str(sex), anthropometry.DE_LEVA)


def _radians(degrees: object) -> dict[str, tuple[float, float]]:
    """The table `limits_deg` of a body file in radians."""
    if not isinstance(degrees, dict):
        raise DescriptionError("limits_deg must be a table of joint = [lower, upper]")
    limits = {}
    for name, pair in degrees.items():
        if not (isinstance(pair, list) and len(pair) == 2 and all(type(x) in (int, float) for x in pair)):
            raise DescriptionError(f"limits_deg.{name} is {pair!r}; two numbers [lower, upper] are accepted")
        limits[name] = (math.radians(pair[0]), math.radians(pair[1]))
    return limits
