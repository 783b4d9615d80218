"""Device files: a device of one's own in TOML."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from exo_pin.anatomy.names import JOINTS, MOVEMENTS, SIDES
from exo_pin.devices.actuator import DEFAULT_ACTUATORS, Actuator
from exo_pin.devices.device import Device
from exo_pin.errors import DescriptionError, ExoPinError, FormatError, UnknownNameError
from exo_pin.safe import toml_file

_TEXT, _NAMES = "a text", "a list of names"
_KINDS: Mapping[str, tuple[str, Callable[[object], bool]]] = {
    "name": (_TEXT, lambda x: isinstance(x, str)),
    "title": (_TEXT, lambda x: isinstance(x, str)),
    "source": (_TEXT, lambda x: isinstance(x, str)),
    "joints": (_NAMES, lambda x: _is_names(x)),
    "passive": (_NAMES, lambda x: _is_names(x)),
    "pelvis": ('"held", "free" or a list of slides', lambda x: isinstance(x, str) or _is_names(x)),
    "toes": ("true or false", lambda x: isinstance(x, bool)),
    "remarks": ("a list of texts", lambda x: _is_names(x)),
    "treadmill_km_h": ("two numbers [slowest, fastest]", lambda x: _is_pair(x)),
    "statures_m": ("two numbers [shortest, tallest]", lambda x: _is_pair(x)),
    "masses_kg": ("two numbers [lightest, heaviest]", lambda x: _is_pair(x)),
    "thighs_m": ("two numbers [shortest, longest]", lambda x: _is_pair(x)),
    "shanks_m": ("two numbers [shortest, longest]", lambda x: _is_pair(x)),
    "hip_breadths_m": ("two numbers [least, largest]", lambda x: _is_pair(x)),
    "actuators": ("tables [actuators.<movement>]", lambda x: isinstance(x, dict)),
    "ranges_deg": ("a table of movement = [lower, upper]", lambda x: isinstance(x, dict)),
    "ranges_m": ("a table of slide = [lower, upper]", lambda x: isinstance(x, dict)),
}
"""What a device file may hold, and of which kind each entry is."""


def load(path: str | Path) -> Device:
    """Read a device file.

    `name`, `joints` and `source` are needed; a joint without its side means both. Torques are `effort_nm`
    [N m], `velocity_rad_s` [rad/s] and `acceleration_rad_s2` [rad/s^2] (slides: `effort_n`, `velocity_m_s`,
    `acceleration_m_s2`); what is left out is the choice of `exo_pin.devices.actuator`.

    Raises:
        FormatError: The file is no TOML, or a name or value in it is not accepted.
    """
    values = toml_file.read(path)
    try:
        return _device(values)
    except ExoPinError as error:
        raise FormatError(path, str(error)) from None


def _device(values: dict[str, Any]) -> Device:
    _check(values)
    actuators = {m: _actuator(m, numbers) for m, numbers in values.pop("actuators", {}).items()}
    ranges = _pairs(values.pop("ranges_deg", {}), math.radians) | _pairs(values.pop("ranges_m", {}), float)
    for name in {"joints", "passive"} & set(values):
        values[name] = _with_sides(values[name])
    for name in {"pelvis", "remarks"} & set(values):
        values[name] = values[name] if isinstance(values[name], str) else tuple(values[name])
    values["treadmill"] = _scaled(values.pop("treadmill_km_h", None), 1 / 3.6)
    for name in ("statures_m", "masses_kg", "thighs_m", "shanks_m", "hip_breadths_m"):
        values[name.rpartition("_")[0]] = _scaled(values.pop(name, None), 1.0)
    device = Device(actuators=actuators, ranges=ranges, **values)
    _check_movements(device, (*actuators, *ranges))
    return device


def _check(values: dict[str, Any]) -> None:
    """Refuse names that are unknown, values of another kind, and files that leave out what is needed."""
    for name, value in values.items():
        if name not in _KINDS:
            raise UnknownNameError("entry of a device file", name, _KINDS)
        kind, fits = _KINDS[name]
        if not fits(value):
            raise DescriptionError(f"{name} is {value!r}; {kind} is accepted")
    for name in ("name", "joints", "source"):
        if name not in values:
            raise DescriptionError(f"{name} is missing")
    if not values["source"].strip():
        raise DescriptionError("source is empty; where the joints and numbers come from is asked")


def _check_movements(device: Device, named: tuple[str, ...]) -> None:
    """Refuse numbers of slides and toes that the device does not have."""
    for movement in named:
        if movement not in device.actuators:
            raise DescriptionError(f"{movement} has numbers, but the device has no such joint (pelvis, toes)")


def _is_pair(value: object) -> bool:
    return isinstance(value, list) and len(value) == 2 and all(type(x) in (int, float) for x in value)


def _scaled(pair: list[float] | None, scale: float) -> tuple[float, float] | None:
    return None if pair is None else (scale * pair[0], scale * pair[1])


def _is_names(value: object) -> bool:
    return isinstance(value, list) and all(isinstance(x, str) for x in value)


def _with_sides(names: list[str]) -> tuple[str, ...]:
    """`knee_flexion` means both sides."""
    spread = []
    for name in names:
        if name not in MOVEMENTS and name not in JOINTS:
            raise UnknownNameError("joint", name, (*MOVEMENTS, *JOINTS))
        spread += [f"{side}_{name}" for side in SIDES] if name in MOVEMENTS else [name]
    return tuple(spread)


def _actuator(movement: str, numbers: object) -> Actuator:
    if movement not in DEFAULT_ACTUATORS:
        raise UnknownNameError("movement", movement, DEFAULT_ACTUATORS)
    slides = movement.startswith("pelvis_")
    names = (
        ("effort_n", "velocity_m_s", "acceleration_m_s2")
        if slides
        else ("effort_nm", "velocity_rad_s", "acceleration_rad_s2")
    )
    if not isinstance(numbers, dict) or not set(numbers) <= set(names):
        raise DescriptionError(f"actuators.{movement}: {', '.join(names)} are accepted")
    if not all(type(x) in (int, float) for x in numbers.values()):
        raise DescriptionError(f"actuators.{movement}: {numbers} must be numbers")
    own = DEFAULT_ACTUATORS[movement]
    effort, velocity = numbers.get(names[0], own.effort), numbers.get(names[1], own.velocity)
    return Actuator(float(effort), float(velocity), numbers.get(names[2]))


def _pairs(table: dict[str, Any], unit: Callable[[float], float]) -> dict[str, tuple[float, float]]:
    pairs = {}
    for name, pair in table.items():
        if name.startswith("pelvis_") != (unit is float):
            raise DescriptionError(f"range of {name}: joints belong in ranges_deg, slides in ranges_m")
        if not _is_pair(pair):
            raise DescriptionError(f"range of {name} is {pair!r}; two numbers [lower, upper] are accepted")
        pairs[name] = (unit(pair[0]), unit(pair[1]))
    return pairs
