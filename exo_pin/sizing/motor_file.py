"""Motor files: a motor of one's own in TOML, and the examples that come with the package."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from exo_pin.errors import DescriptionError, ExoPinError, FormatError, UnknownNameError, known_name
from exo_pin.safe import toml_file
from exo_pin.sizing.motor import Motor

_FOLDER = Path(__file__).with_name("motors")
"""The examples, each with its source."""

_SPEEDS: Mapping[str, float] = {"no_load_speed_rad_s": 1.0, "no_load_speed_rpm": math.pi / 30}
_NUMBERS: Mapping[str, str] = {
    "peak_torque_nm": "peak_torque",
    "continuous_torque_nm": "continuous_torque",
    "rotor_inertia_kgm2": "rotor_inertia",
    "efficiency": "efficiency",
}
_TEXTS = ("name", "source")
_ENTRIES = (*_TEXTS, *_SPEEDS, *_NUMBERS)


def example_motors() -> tuple[str, ...]:
    """Names of the motors that come with the package."""
    return tuple(sorted(path.stem for path in _FOLDER.glob("*.toml")))


def find_motor(motor: str | Path | Motor) -> Motor:
    """An example by name, a motor file, or the record itself.

    Raises:
        UnknownNameError: There is no such example (a file's name ends in .toml).
        FormatError: The file is not accepted.
    """
    if isinstance(motor, Motor):
        return motor
    if str(motor).lower().endswith(".toml"):
        return load_motor(motor)
    name = known_name("motor (an example, or a file that ends in .toml)", str(motor), example_motors())
    return load_motor(_FOLDER / f"{name}.toml")


def load_motor(path: str | Path) -> Motor:
    """Read a motor file; every entry is needed.

    `name`, `source`, `no_load_speed_rad_s` or `no_load_speed_rpm`, `peak_torque_nm`, `continuous_torque_nm`,
    `rotor_inertia_kgm2`, `efficiency`: of the motor without its gear.

    Raises:
        FormatError: The file is no TOML, an entry is missing or unknown, or a value is not accepted.
    """
    values = toml_file.read(path)
    try:
        return _motor(values)
    except ExoPinError as error:
        raise FormatError(path, str(error)) from None


def _motor(values: dict[str, Any]) -> Motor:
    for name in values:
        if name not in _ENTRIES:
            raise UnknownNameError("entry of a motor file", name, _ENTRIES)
    return Motor(
        name=_text(values, "name"),
        source=_text(values, "source"),
        no_load_speed=_speed(values),
        **{field: _number(values, name) for name, field in _NUMBERS.items()},
    )


def _speed(values: Mapping[str, Any]) -> float:
    given = [name for name in _SPEEDS if name in values]
    if len(given) != 1:
        found = "stand both there" if given else "are missing"
        raise DescriptionError(f"{' and '.join(_SPEEDS)} {found}; one of them is accepted")
    return _SPEEDS[given[0]] * _number(values, given[0])


def _number(values: Mapping[str, Any], name: str) -> float:
    if name not in values:
        raise DescriptionError(f"{name} is missing; a number is accepted")
    value = values[name]
    if type(value) not in (int, float):
        raise DescriptionError(f"{name} is {value!r}; a number is accepted")
    return float(value)


def _text(values: Mapping[str, Any], name: str) -> str:
    value = values.get(name, "")
    if not isinstance(value, str) or not value.strip():
        raise DescriptionError(f"{name} is {value!r}; a text is accepted" if value else f"{name} is missing")
    return value
