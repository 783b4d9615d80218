"""Arguments of public functions, checked on entry: real finite numbers of a shape, counts, words, names."""

from __future__ import annotations

import math
import numbers
from collections.abc import Iterable, Mapping
from types import EllipsisType
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from exo_pin.arrays import Array, as_floats
from exo_pin.errors import DescriptionError, ExoPinError, UnknownNameError, shortened

MOST_SAMPLES = 1_000_000
"""Of one walk that a function makes: 1.2 GB with its poses."""

LARGEST_SEED = 2**63 - 1
"""Of random numbers: what a file of 64-bit integers holds."""

Shape = tuple[int | str | EllipsisType, ...]
"""A length for each axis; a letter is a length of any size; `...` in front: any further axes."""

ANY: Shape = (...,)
"""Every shape."""

Word = TypeVar("Word", bound=str)
Key = TypeVar("Key", bound=str)
Entry = TypeVar("Entry")
_LONGEST = 60  # characters of a wrong value in a message


def real(
    name: str,
    values: ArrayLike,
    shape: Shape = ANY,
    *,
    gaps: bool = False,
    error: type[ExoPinError] = DescriptionError,
) -> Array:
    """Finite real numbers in double precision, left where they live (CuPy).

    Args:
        name: Of the argument, for the message.
        values: What was given.
        shape: The shape that is accepted.
        gaps: Whether NaN is accepted, for what was not measured.
        error: Class of the error.

    Raises:
        ExoPinError: Of the class `error`: the values are complex, masked or no numbers, the shape does not
            fit, or a number is not finite; the message names its place.
    """
    try:
        array = as_floats(values)
    except (TypeError, ValueError, OverflowError):
        raise error(f"{name} is {_shown(values)}; an array of real numbers is accepted") from None
    if shape is not ANY and not _fits(array.shape, shape):
        raise error(f"{name} has shape {array.shape}; {_in_words(shape)} is accepted")
    right = ~np.isinf(array) if gaps else np.isfinite(array)
    if not right.all():
        place = np.unravel_index(int(right.argmin()), array.shape)
        where = f" at [{', '.join(str(int(k)) for k in place)}]" if array.ndim else ""
        accepted = "a finite number, or NaN where nothing was measured," if gaps else "a finite number"
        raise error(f"{name} is {float(array[place]):g}{where}; {accepted} is accepted")
    return array


def number(
    name: str,
    value: float,
    *,
    least: float = -math.inf,
    most: float = math.inf,
    above: float = -math.inf,
    error: type[ExoPinError] = DescriptionError,
) -> float:
    """One finite real number within bounds.

    Args:
        name: Of the argument, for the message.
        value: What was given.
        least: Smallest number that is accepted.
        most: Largest number that is accepted.
        above: All accepted numbers are larger.
        error: Class of the error.

    Raises:
        ExoPinError: Of the class `error`: it is no such number.
    """
    found = _as_float(value)
    if not (math.isfinite(found) and least <= found <= most and found > above):
        bounds = _bounds(least, most, above)
        raise error(f"{name} is {_shown(value)}; a finite number{bounds} is accepted")
    return found


def count(
    name: str, value: float, least: int, most: int, *, error: type[ExoPinError] = DescriptionError
) -> int:
    """A whole number within bounds.

    Args:
        name: Of the argument, for the message.
        value: What was given.
        least: Smallest number that is accepted.
        most: Largest number that is accepted.
        error: Class of the error.

    Raises:
        ExoPinError: Of the class `error`: it is no such number.
    """
    found = _as_float(value)
    if not (least <= found <= most and found == int(found)):
        raise error(f"{name} is {_shown(value)}; a whole number from {least} to {most} is accepted")
    return int(value)


def word(kind: str, value: object, known: Iterable[Word]) -> Word:
    """A word of a closed vocabulary.

    Args:
        kind: What it says, for the message.
        value: What was given.
        known: The vocabulary.

    Raises:
        UnknownNameError: It is none of them.
    """
    words = tuple(known)
    if isinstance(value, str):
        for one in words:
            if one == value:
                return one
    raise UnknownNameError(kind, _shown(value), words)


def text(name: str, value: object, *, error: type[ExoPinError] = DescriptionError) -> str:
    """A text.

    Args:
        name: Of the argument, for the message.
        value: What was given.
        error: Class of the error.

    Raises:
        ExoPinError: Of the class `error`: it is no text.
    """
    if not isinstance(value, str):
        raise error(f"{name} is {_shown(value)}; a text is accepted")
    return value


def several(
    name: str, values: Iterable[Entry], *, error: type[ExoPinError] = DescriptionError
) -> tuple[Entry, ...]:
    """The members of a sequence, which is not a single text.

    Args:
        name: Of the argument, for the message.
        values: What was given.
        error: Class of the error.

    Raises:
        ExoPinError: Of the class `error`: it is no sequence.
    """
    if not isinstance(values, Iterable) or isinstance(values, str | bytes):
        raise error(f"{name} is {_shown(values)}; a sequence is accepted")
    return tuple(values)


def names(
    name: str, values: Iterable[str], *, error: type[ExoPinError] = DescriptionError
) -> tuple[str, ...]:
    """Names, more than one or none: not a single text, whose letters would be taken for names.

    Args:
        name: Of the argument, for the message.
        values: What was given.
        error: Class of the error.

    Raises:
        ExoPinError: Of the class `error`: it is no sequence of texts.
    """
    found = several(name, values, error=error)
    if not all(isinstance(one, str) for one in found):
        raise error(f"{name} is {_shown(values)}; a sequence of names is accepted, e.g. ('left', 'right')")
    return found


def table(
    name: str, values: Mapping[Key, Entry], *, error: type[ExoPinError] = DescriptionError
) -> Mapping[Key, Entry]:
    """A mapping whose keys are names.

    Args:
        name: Of the argument, for the message.
        values: What was given.
        error: Class of the error.

    Raises:
        ExoPinError: Of the class `error`: it is no such mapping.
    """
    if not isinstance(values, Mapping) or not all(isinstance(key, str) for key in values):
        raise error(f"{name} is {_shown(values)}; a mapping of names is accepted")
    return values


def _as_float(value: Any) -> float:
    """A real number as float; NaN for anything else, truth values and texts among it."""
    if type(value) is float:
        return value
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        return math.nan
    try:
        return float(value)
    except OverflowError:
        return math.inf


def _bounds(least: float, most: float, above: float) -> str:
    if above > -math.inf:
        return f" above {above:g}" + (f" and up to {most:g}" if most < math.inf else "")
    if least > -math.inf and most < math.inf:
        return f" from {least:g} to {most:g}"
    return f" from {least:g} on" if least > -math.inf else f" up to {most:g}" if most < math.inf else ""


def _fits(found: tuple[int, ...], shape: Shape) -> bool:
    if shape and shape[0] is ...:
        shape = shape[1:]
        found = found[-len(shape) :] if shape else ()
    if found == shape:
        return True
    if len(found) != len(shape):
        return False
    pairs = zip(found, shape, strict=True)
    return all(isinstance(wanted, str) or length == wanted for length, wanted in pairs)


def _in_words(shape: Shape) -> str:
    inside = ", ".join("..." if length is ... else str(length) for length in shape)
    return f"({inside},)" if len(shape) == 1 else f"({inside})"


def _shown(value: object) -> str:
    """A wrong value in a message: an array by its kind and shape, anything else by its text."""
    if isinstance(value, np.ma.MaskedArray) and np.ma.is_masked(value):
        return f"a masked array of shape {value.shape}"
    if isinstance(value, np.ndarray):
        return f"an array of {value.dtype} of shape {value.shape}"
    if isinstance(value, int) and abs(value) > 1e15:
        return "a number beyond 1e15"
    if isinstance(value, str):
        return shortened(value, _LONGEST)
    return shortened(f"{value!r}", _LONGEST)
