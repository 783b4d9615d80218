"""Numbers, vectors and axes in the XML of an OpenSim model."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple
from xml.etree.ElementTree import Element

import numpy as np

from exo_pin.errors import FormatError
from exo_pin.formats.opensim.osim_joint import Axis, Vector

_FUNCTIONS = (
    *("LinearFunction", "Constant", "MultiplierFunction", "PolynomialFunction"),
    *("SimmSpline", "NaturalCubicSpline", "PiecewiseLinearFunction", "GCVSpline"),
)
"""Functions that are read; of a curve the mean slope, which gives its direction, and its knots."""

_WIDEST, _POINTS = 3.0, 241
"""Ends of the coordinate [rad] and points at which a polynomial is taken."""


class _Function(NamedTuple):
    """A function of one coordinate: a line, or a curve by its knots and mean slope."""

    slope: float
    start: float
    linear: bool = True
    curve: tuple[tuple[float, float], ...] = ()


def axis_of(path: Path, element: Element) -> tuple[Axis, bool]:
    """An axis of a CustomJoint, and whether it is one of rotation."""
    vector = vector_of(path, element, "axis")
    length = math.hypot(*vector)
    names = (element.findtext("coordinates") or "").split()
    found = _Function(1.0 if names else 0.0, 0.0, len(names) < 2)
    for inner in (*element, *element.findall("function/*")):
        if inner.tag in _FUNCTIONS:
            found = _function(path, inner)
    x, y, z = (part / length for part in vector) if length else vector
    coordinate = names[0] if names and (found.slope or not found.linear) else ""
    rotates = element.get("name", "").startswith("rotation")
    linear, curve = found.linear and len(names) < 2, found.curve if len(names) == 1 else ()
    return Axis((x, y, z), coordinate, found.slope, found.start, linear, curve), rotates


def _function(path: Path, element: Element) -> _Function:
    if element.tag == "Constant":
        return _Function(0.0, number_of(path, element.findtext("value", "0")))
    if element.tag == "MultiplierFunction":
        inner = next((e for e in element.findall("function/*") if e.tag in _FUNCTIONS), None)
        scale = number_of(path, element.findtext("scale", "1"))
        of = _Function(0.0, 0.0, False) if inner is None else _function(path, inner)
        curve = tuple((x, scale * y) for x, y in of.curve)
        return _Function(scale * of.slope, scale * of.start, of.linear, curve)
    if element.tag in ("LinearFunction", "PolynomialFunction"):
        numbers = [0.0, 0.0, *_numbers(path, element.findtext("coefficients", "1 0"))]
        linear = not any(numbers[:-2])
        return _Function(numbers[-2], numbers[-1], linear, () if linear else _polynomial(numbers))
    x, y = (_numbers(path, element.findtext(name, "")) for name in "xy")
    if len(x) < 2 or len(x) != len(y) or x[0] == x[-1]:
        return _Function(0.0, 0.0, False)
    slope = (y[-1] - y[0]) / (x[-1] - x[0])
    return _Function(slope, y[0] - slope * x[0], False, tuple(sorted(zip(x, y, strict=True))))


def _polynomial(coefficients: Sequence[float]) -> tuple[tuple[float, float], ...]:
    """A polynomial at points so close that straight lines between them serve."""
    x = np.linspace(-_WIDEST, _WIDEST, _POINTS)
    return tuple(zip(x.tolist(), np.polyval(coefficients, x).tolist(), strict=True))


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
