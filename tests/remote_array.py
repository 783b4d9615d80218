"""An array that behaves as CuPy's: NumPy's functions work on it; nothing leaves it without a copy."""

from __future__ import annotations

import functools
from typing import Any

import numpy as np
from numpy.lib.mixins import NDArrayOperatorsMixin

CUDA = 2  # DLPack's number of a CUDA device


class RemoteArray(NDArrayOperatorsMixin):
    """A NumPy array behind CuPy's rules, which counts the numbers that are copied to the host."""

    copied = 0

    def __init__(self, values: Any) -> None:
        self.values = np.asarray(values)

    def __dlpack_device__(self) -> tuple[int, int]:
        return CUDA, 0

    def __array__(self, *_: Any, **__: Any) -> Any:
        raise TypeError("implicit conversion to NumPy")

    def __array_ufunc__(self, ufunc: Any, method: str, *args: Any, out: Any = None, **known: Any) -> Any:
        _no_array_of_the_host(args)
        if out is not None:
            known["out"] = tuple(x.values for x in out)
        result = getattr(ufunc, method)(*_opened(args), **_opened(known))
        return out[0] if out is not None else _closed(result)

    def __array_function__(self, function: Any, _: Any, args: Any, known: Any) -> Any:
        if function is not np.asarray:
            _no_array_of_the_host(args)
        return _closed(function(*_opened(args), **_opened(known)))

    def __getitem__(self, key: Any) -> Any:
        return _closed(self.values[_opened(key)])

    def __setitem__(self, key: Any, value: Any) -> None:
        _no_array_of_the_host([value])
        self.values[_opened(key)] = _opened(value)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)  # NumPy would read the values through its array interface
        attribute = getattr(self.values, name)
        if not callable(attribute):
            return _closed(attribute)
        return functools.wraps(attribute)(lambda *a, **k: _closed(attribute(*_opened(a), **_opened(k))))

    def __len__(self) -> int:
        return len(self.values)

    def __float__(self) -> float:
        return float(self.get())

    def __int__(self) -> int:
        return int(self.get())

    def __bool__(self) -> bool:
        return bool(self.get())

    def get(self) -> Any:
        """The values on the host, counted."""
        RemoteArray.copied += self.values.size
        return self.values.copy()


def _closed(result: Any) -> Any:
    if isinstance(result, np.ndarray | np.generic):
        return RemoteArray(result)
    arrays = isinstance(result, tuple) and _holds_arrays(result)
    return tuple(_closed(x) for x in result) if arrays else result


def _holds_arrays(values: tuple[Any, ...]) -> bool:
    return any(isinstance(x, np.ndarray) for x in values)


def _opened(value: Any) -> Any:
    if isinstance(value, RemoteArray):
        return value.values
    if isinstance(value, list | tuple):
        return type(value)(_opened(x) for x in value)
    return {k: _opened(v) for k, v in value.items()} if isinstance(value, dict) else value


def _no_array_of_the_host(args: Any) -> None:
    for x in args:
        if isinstance(x, np.ndarray) and x.ndim:
            raise TypeError("an array of NumPy meets one of the accelerator")
        if isinstance(x, list | tuple):
            _no_array_of_the_host(x)
