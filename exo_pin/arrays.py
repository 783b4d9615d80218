"""The types of arrays that signatures name, and arrays that live outside the host's memory (CuPy)."""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
"""Numbers; the shape and the unit stand in the docstring."""
Mask = NDArray[np.bool_]
"""Truth values, one for each sample or element."""
Index = NDArray[np.int64]
"""Positions in another array."""

Entry = TypeVar("Entry", bound=np.generic)
_FLOAT = np.dtype(np.float64)
_REAL = "fiub"  # NumPy's kinds of numbers without an imaginary part, and truth values
_CPU = 1  # DLPack's number of the host (dlpack.h, DLDeviceType)


def is_remote(values: Any) -> bool:
    """Whether an array lives on an accelerator and takes NumPy's functions there (CuPy's arrays do)."""
    if isinstance(values, np.ndarray) or not hasattr(values, "__array_function__"):
        return False
    return hasattr(values, "__dlpack_device__") and values.__dlpack_device__()[0] != _CPU


def as_floats(values: ArrayLike) -> Array:
    """Real numbers in double precision, left where they live.

    NumPy's own conversion would drop imaginary parts and masks, and read texts as numbers.

    Raises:
        TypeError: The values are complex, masked or no numbers.
        ValueError: The rows have different lengths.
    """
    if type(values) is np.ndarray and values.dtype == _FLOAT:
        return values
    array: Any = values if is_remote(values) else np.asarray(values)
    if array.dtype.kind not in _REAL or (isinstance(values, np.ma.MaskedArray) and np.ma.is_masked(values)):
        raise TypeError(f"{array.dtype} is no kind of real numbers, or some are masked")
    return np.asarray(array, dtype=float, like=array)


def beside(values: NDArray[Entry], other: Any) -> NDArray[Entry]:
    """An array where another one lives: the same array if it is there already, else a copy."""
    if is_remote(other):
        return values if is_remote(values) else np.asarray(values, like=other)
    return to_host(values)


def filled(shape: int | tuple[int, ...], value: float, *, like: Array) -> Array:
    """One number many times, where another array lives.

    `np.full(..., like=...)` cannot: CuPy's `full` does not take all arguments that NumPy's hands on.

    Args:
        shape: Of the result.
        value: The number.
        like: The other array.
    """
    out = np.empty(shape, like=like)
    out[...] = value
    return out


def to_host(values: NDArray[Entry]) -> NDArray[Entry]:
    """An array in the host's memory: the same one for NumPy, a copy from an accelerator."""
    remote: Any = values
    return remote.get() if is_remote(values) else values


def json_numbers(values: Array) -> list[Any]:
    """An array as lists for JSON, with None for what is not finite."""
    plain = values.astype(object)
    plain[~np.isfinite(values)] = None
    return list(plain.tolist())
