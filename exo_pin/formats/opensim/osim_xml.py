"""Numbers, vectors and axes in the XML of an OpenSim model."""

from __future__ import annotations

import math
from pathlib import Path
from xml.etree.ElementTree import Element

from exo_pin.errors import FormatError
from exo_pin.formats.opensim.osim_joint import Axis, Vector

_FUNCTIONS = (
    *("LinearFunction", "Constant", "MultiplierFunction", "PolynomialFunction"),
    *("SimmSpline", "NaturalCubicSpline", "PiecewiseLinearFunction", "GCVSpline"),
)
"""Functions that are read; of a curve the mean slope, which gives its direction."""


def axis_of(path: Path, element: Element) -> tuple[Axis, bool]:
    """An axis of a CustomJoint, and whether it is one of rotation."""
    vector = vector_of(path, element, "axis")
    length = math.hypot(*vector)
    names = (element.findtext("coordinates") or "").split()
    slope, start, linear = (1.0 if names else 0.0), 0.0, len(names) < 2
    for inner in (*element, *element.findall("function/*")):
        if inner.tag in _FUNCTIONS:
            slope, start, linear = _function(path, inner)
    x, y, z = (part / length for part in vector) if length else vector
    coordinate = names[0] if names and (slope or not linear) else ""
    rotates = element.get("name", "").startswith("rotation")
    return Axis((x, y, z), coordinate, slope, start, linear and len(names) < 2), rotates


def _function(path: Path, element: Element) -> tuple[float, float, bool]:
    """Slope, value at 0 and whether that is all."""
    if element.tag == "Constant":
        return 0.0, number_of(path, element.findtext("value", "0")), True
    if element.tag == "MultiplierFunction":
        inner = next((e for e in element.findall("function/*") if e.tag in _FUNCTIONS), None)
        scale = number_of(path, element.findtext("scale", "1"))
        slope, start, linear = (0.0, 0.0, False) if inner is None else _function(path, inner)
        return scale * slope, scale * start, linear
    if element.tag in ("LinearFunction", "PolynomialFunction"):
        numbers = [0.0, 0.0, *_numbers(path, element.findtext("coefficients", "1 0"))]
        return numbers[-2], numbers[-1], not any(numbers[:-2])
    x, y = (_numbers(path, element.findtext(name, "")) for name in "xy")
    if len(x) < 2 or len(x) != len(y) or x[0] == x[-1]:
        return 0.0, 0.0, False
    slope = (y[-1] - y[0]) / (x[-1] - x[0])
    return slope, y[0] - slope * x[0], False


def vector_of(path: Path, element: Element, name: str) -> Vector:
    """Three numbers of a child element; zeros where there is no such child.

    Args:
        path: The file, for messages.
        element: The parent.
        name: Tag of the child.

    Raises:
        FormatError: It does not hold three numbers.
    """
    numbers = _numbers(path, element.findtext(name) or "0 0 0")
    if len(numbers) != 3:
        raise FormatError(path, f"<{name}> holds {len(numbers)} numbers, expected 3")
    return numbers[0], numbers[1], numbers[2]


def _numbers(path: Path, text: str) -> list[float]:
    return [number_of(path, word) for word in text.split()]


def number_of(path: Path, text: str) -> float:
    """A length or an angle; raises `FormatError`."""
    try:
        number = float(text)
    except ValueError:
        raise FormatError(path, f"{text.strip()[:40]!r} is no number") from None
    if not abs(number) < 1e9:
        raise FormatError(path, f"{text.strip()[:40]} is no length or angle")
    return number
