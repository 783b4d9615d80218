"""URDF description: from a `Body` and a device to the URDF text, through the xacro sources in urdf/."""

from __future__ import annotations

import contextlib
import io
import math
import re
from collections.abc import Mapping
from importlib import metadata
from pathlib import Path

import numpy as np

from exo_pin import cache, devices
from exo_pin.anatomy import HIP_ORDERS, JOINTS, SIDES, Body
from exo_pin.anatomy.inertia import Inertial, link_inertias
from exo_pin.anatomy.names import HipOrder, Masses
from exo_pin.anatomy.sizes import LEG_SIZES, SIZES, checked
from exo_pin.arguments import table, text, word
from exo_pin.devices import Device
from exo_pin.errors import DescriptionError, UnknownNameError
from exo_pin.safe import plain_numbers

__all__ = ["MAIN", "XACRO", "arguments", "arguments_xacro", "expand", "sources", "urdf"]

MAIN = "exo12.urdf.xacro"
"""The xacro that includes the others."""
XACRO = "http://www.ros.org/wiki/xacro"
"""The namespace of xacro's elements."""

_SIZES = [
    "hip_width",
    "waist_width",
    *(f"{side}_{name}" for side in SIDES for name, size in LEG_SIZES.items() if size.unit == "m"),
]
"""The sizes of a `Body` that xacro places."""
_STRUCTURE = ("hip_order", "locked", "slides", "toes")


_BOUNDS = {
    "girth": (0.3, 3.0),  # of cuffs and bodies / those of a person of the usual mass
    "_effort": (1e-3, 1e4),  # [N m]
    "_velocity": (1e-3, 1e3),  # [rad/s]
    "_lower": (-math.pi, math.pi),  # [rad]: degrees are noticed
    "_upper": (-math.pi, math.pi),
    "_link_mass": (1e-6, 500.0),  # [kg]
    "_com": (-2.0, 2.0),  # [m] from the link's joint
}
"""Plausible range of a single argument, by the end of its name."""


def sources() -> Path:
    """The folder of the xacro sources: inside the installed package, or beside it in a checkout."""
    package = Path(__file__).resolve().parent
    for folder in (package / "urdf", package.parent / "urdf"):
        if (folder / MAIN).is_file():
            return folder
    raise DescriptionError(f"the xacro sources ({MAIN}) are missing beside {package}; reinstall exo_pin")


def arguments(
    body: Body,
    *,
    device: str | Device = "exo12",
    hip_order: HipOrder = "clinical",
    masses: Masses = "both",
    **overrides: str,
) -> dict[str, str]:
    """Every xacro argument as text, in the order of urdf/arguments.xacro.

    Args:
        body: Sizes, masses and joint ranges.
        device: A device, its name, or a TOML file that holds one.
        hip_order: `"clinical"` or `"yaw_roll_pitch"`.
        masses: Whose masses the links have: `"wearer"`, `"device"` or `"both"`.
        **overrides: Single arguments, e.g. `left_thigh_link_mass="12.5"`.

    Raises:
        UnknownNameError: Device, hip order or an override is unknown.
        DescriptionError: An override is no plausible number, or an inertia is not physical.
    """
    word("hip order", hip_order, HIP_ORDERS)
    found = devices.find(device)
    sizes = {name: _text(getattr(body, name)) for name in _SIZES}
    values = _structure(found, hip_order) | sizes | {"girth": _text(body.girth)}
    for link, part in link_inertias(body, toes=found.toes, stand=found.stand, masses=masses).items():
        values |= _inertial(link, part)
    for joint in (*JOINTS, *found.added):
        values |= _limits(body, found, joint)
    for name, value in overrides.items():
        if name not in values:
            raise UnknownNameError("argument", name, values)
        values[name] = _plausible(name, value, like=values[name])
    _check_limits(values, overrides)
    _check_inertias(values)
    return values


def arguments_xacro(values: Mapping[str, str], comment: str) -> str:
    """The arguments as a xacro file whose defaults they are, in place of urdf/arguments.xacro.

    Args:
        values: Of `arguments`.
        comment: The comment above them.

    Raises:
        DescriptionError: A value is no text.
    """
    for name, value in table("values", values).items():
        text(name, value)
    rows = (f'  <xacro:arg name="{name}" default="{value}"/>\n' for name, value in values.items())
    head = f'<?xml version="1.0"?>\n<!-- {comment} -->\n<robot xmlns:xacro="{XACRO}">\n'
    return f"{head}{''.join(rows)}</robot>\n"


def urdf(
    body: Body,
    *,
    device: str | Device = "exo12",
    hip_order: HipOrder = "clinical",
    masses: Masses = "both",
    **overrides: str,
) -> str:
    """The URDF text of the exoskeleton for this body: the same bytes for the same arguments everywhere.

    Args:
        body: Sizes, masses and joint ranges.
        device: A device, its name, or a TOML file that holds one.
        hip_order: `"clinical"` or `"yaw_roll_pitch"`.
        masses: Whose masses the links have: `"wearer"`, `"device"` or `"both"`.
        **overrides: Single xacro arguments, e.g. `left_thigh_link_mass="12.5"`.

    Raises:
        UnknownNameError: Device, hip order or an override is unknown.
        DescriptionError: An override is no plausible number, an inertia is not physical, or xacro fails.
    """
    found = devices.find(device)
    values = arguments(body, device=found, hip_order=hip_order, masses=masses, **overrides)
    return expand(values, name=found.name)


def expand(values: Mapping[str, str], *, name: str = "exo12") -> str:
    """Run xacro on the sources with these arguments; `name` becomes the robot's.

    The text is kept in the cache folder, under everything that it follows from: xacro takes 0.2 s.

    Raises:
        DescriptionError: A value is no text, or xacro refuses the sources.
    """
    if not all(isinstance(value, str) for value in table("values", values).values()):
        raise DescriptionError("values holds something that is no text; those of `arguments` are accepted")
    known = cache.key((*_makers(), name, *(part for pair in values.items() for part in pair)))
    kept = cache.recall("urdf", known)
    if kept is not None:
        return kept.decode()
    text = _by_xacro(values, name)
    cache.keep("urdf", known, text.encode())
    return text


def _makers() -> tuple[str | bytes, ...]:
    """Everything that turns arguments into a URDF: xacro, its sources, and this module."""
    files = (Path(__file__), *sorted(sources().glob("*.xacro")))
    return metadata.version("xacro"), *(file.read_bytes() for file in files)


def _by_xacro(values: Mapping[str, str], name: str) -> str:
    import xacro  # 30 ms that only a description needs

    noise = io.StringIO()  # xacro reports its errors on stderr before it raises
    try:
        with contextlib.redirect_stderr(noise):
            document = xacro.process_file(str(sources() / MAIN), mappings=dict(values))
    except Exception as error:  # xacro lets ZeroDivisionError, XMLSyntaxError and others pass
        raise DescriptionError(f"xacro cannot expand {MAIN}: {error}") from error
    element = document.documentElement  # not the document, whose banner holds a local path
    element.setAttribute("name", name)  # xacro reads it before it knows the arguments
    text: str = element.toprettyxml(indent="  ")
    lines = (line for line in re.sub(r"<!--.*?-->", "", text, flags=re.DOTALL).splitlines() if line.strip())
    return '<?xml version="1.0"?>\n' + "\n".join(lines) + "\n"


def _inertial(link: str, part: Inertial) -> dict[str, str]:
    upper = part.inertia[np.triu_indices(3)]  # ixx ixy ixz iyy iyz izz
    return {
        f"{link}_link_mass": _rounded(part.mass),
        f"{link}_com": " ".join(map(_rounded, part.centre)),
        f"{link}_inertia": " ".join(map(_rounded, upper)),
    }


def _structure(device: Device, hip_order: HipOrder) -> dict[str, str]:
    """Which joints there are; lists of names, or "none"."""
    return {
        "hip_order": hip_order,
        "locked": " ".join(device.locked) or "none",
        "slides": " ".join(device.slides) or "none",
        "toes": str(device.toes),
    }


def _limits(body: Body, device: Device, joint: str) -> dict[str, str]:
    movement = devices.movement_of(joint)
    lower, upper = device.range_of(joint, body.limits[joint]) if joint in JOINTS else device.ranges[movement]
    actuator = device.actuators[movement]
    if joint in device.locked:
        actuator = actuator._replace(effort=0.0)  # what has no torque is drawn without a motor
    numbers = {"lower": lower, "upper": upper, "effort": actuator.effort, "velocity": actuator.velocity}
    return {f"{joint}_{name}": _text(value) for name, value in numbers.items()}


def _text(value: float) -> str:
    """The shortest text that reads back as the same number."""
    return repr(float(value))


def _rounded(value: float) -> str:
    """Inertial numbers to 1e-9, so that the last bit of a sum does not change the text."""
    return repr(round(float(value), 9) + 0.0)


def _plausible(name: str, text: str, *, like: str) -> str:
    """An override as text, checked: sizes by their range, other numbers by being finite."""
    if name in _STRUCTURE:
        raise DescriptionError(f"{name} follows from the device and the hip order; it is not given alone")
    try:
        numbers = [plain_numbers.number(part) for part in str(text).split()]
    except ValueError:
        raise DescriptionError(f"{name}:={text} is no number like 12.5") from None
    if len(numbers) != len(like.split()) or not all(map(math.isfinite, numbers)):
        raise DescriptionError(f"{name}:={text} must be {len(like.split())} finite number(s)")
    if name in SIZES:
        checked(name, numbers[0])
    for ending, (low, high) in _BOUNDS.items():
        if name.endswith(ending) and not all(low <= number <= high for number in numbers):
            raise DescriptionError(f"{name}:={text} is not plausible; {low:g} .. {high:g} is accepted")
    return " ".join(map(_text, numbers))


def _check_limits(values: Mapping[str, str], given: Mapping[str, str]) -> None:
    """Limits that were given singly must still be a range."""
    for name in given:
        joint, _, end = name.rpartition("_")
        if end in ("lower", "upper") and float(values[f"{joint}_lower"]) >= float(values[f"{joint}_upper"]):
            lower, upper = values[f"{joint}_lower"], values[f"{joint}_upper"]
            raise DescriptionError(f"{name}:={values[name]}: {joint} would range from {lower} to {upper} rad")


def _check_inertias(values: Mapping[str, str]) -> None:
    """Positive masses, and principal inertias that a real body can have (triangle inequality)."""
    for name in values:
        if not name.endswith("_link_mass"):
            continue
        link = name.removesuffix("_link_mass")
        if float(values[name]) <= 0:
            raise DescriptionError(f"{name}:={values[name]} must be positive")
        matrix = np.zeros((3, 3))
        matrix[np.triu_indices(3)] = [float(x) for x in values[f"{link}_inertia"].split()]
        principal = np.linalg.eigvalsh(matrix, UPLO="U")
        if principal[0] <= 0 or principal[2] > (principal[0] + principal[1]) * (1 + 1e-9):
            raise DescriptionError(
                f"{link}_inertia:={values[f'{link}_inertia']} is not the inertia of a real body"
            )
