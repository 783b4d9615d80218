"""Target records from TOML files: a robot of one's own."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from pathlib import Path
from types import MappingProxyType

from exo_pin.errors import FormatError, UnknownNameError
from exo_pin.retarget.axes import SIGNED_AXES
from exo_pin.retarget.target_robots import Target
from exo_pin.safe import toml_file

_TEXT, _AXIS = "a text", f"one of {', '.join(SIGNED_AXES)}"
_KINDS: Mapping[str, tuple[str, Callable[[object], bool]]] = {
    "name": (_TEXT, lambda x: isinstance(x, str)),
    "urdf": ("a path, seen from this file", lambda x: isinstance(x, str) and bool(x)),
    "feet": ("two names of links, left and right", lambda x: _is_pair(x, str) and x[0] != x[1]),  # type: ignore[index]
    "forward": (_AXIS, lambda x: x in SIGNED_AXES),
    "up": (_AXIS, lambda x: x in SIGNED_AXES),
    "stand_deg": ("a table of joint = angle", lambda x: _is_table(x, _is_number)),
    "limits_deg": ("a table of joint = [lower, upper]", lambda x: _is_table(x, _is_range)),
    "locked": ("a list of names of joints", lambda x: _is_list(x, str)),
    "title": (_TEXT, lambda x: isinstance(x, str)),
    "remarks": (_TEXT, lambda x: isinstance(x, str)),
}
"""Accepted entries of a robot's record, and the kind of each."""


def load(path: str | Path) -> Target:
    """Read a robot's record; only `urdf` is needed.

    Raises:
        FormatError: The file is no TOML, or a name or value in it is not accepted.
    """
    values = toml_file.read(path)
    for name, value in values.items():
        if name not in _KINDS:
            raise FormatError(path, str(UnknownNameError("entry of a robot's record", name, _KINDS)))
        kind, fits = _KINDS[name]
        if not fits(value):
            raise FormatError(path, f"{name} is {value!r}; {kind} is accepted")
    if "urdf" not in values:
        raise FormatError(path, "urdf is missing: the path of the robot's URDF, seen from this file")
    stand = {joint: math.radians(angle) for joint, angle in values.get("stand_deg", {}).items()}
    ranges = values.get("limits_deg", {}).items()
    limits = {joint: (math.radians(low), math.radians(high)) for joint, (low, high) in ranges}
    return Target(
        name=values.get("name", Path(path).stem),
        file=Path(path).parent / values["urdf"],
        feet=tuple(values.get("feet", ())),
        forward=values.get("forward", ""),
        up=values.get("up", ""),
        stand=MappingProxyType(stand),
        limits=MappingProxyType(limits),
        locked=tuple(values.get("locked", ())),
        title=values.get("title", ""),
        remarks=values.get("remarks", ""),
    )


def _is_number(x: object) -> bool:
    return type(x) in (int, float) and math.isfinite(x)  # type: ignore[arg-type]


def _is_pair(x: object, kind: type) -> bool:
    return isinstance(x, list) and len(x) == 2 and all(isinstance(part, kind) for part in x)


def _is_list(x: object, kind: type) -> bool:
    return isinstance(x, list) and all(isinstance(part, kind) for part in x)


def _is_range(x: object) -> bool:
    return isinstance(x, list) and len(x) == 2 and all(map(_is_number, x)) and x[0] < x[1]


def _is_table(x: object, fits: Callable[[object], bool]) -> bool:
    return isinstance(x, dict) and all(map(fits, x.values()))
