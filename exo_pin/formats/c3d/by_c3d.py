"""C3D content by the package c3d (Python): a module of the child process, without imports of this package."""

from __future__ import annotations

import contextlib
from typing import Any

import numpy as np

_TEXT, _BYTE, _INTEGER, _REAL = -1, 1, 2, 4
"""Types of parameters by the bytes of a value."""


def load(path: str) -> dict[str, Any]:
    """Points, analog signals, rate, header events and parameters of a file, as `by_ezc3d.load` has them."""
    import c3d

    with open(path, "rb") as handle:
        file = c3d.Reader(handle)
        frames = list(file.read_frames(check_nan=False))
    points = np.stack([points.T for _, points, _ in frames], axis=-1)
    xyz = points[:3].astype(float)
    xyz[:, points[3] < 0] = np.nan  # not seen
    signals = [analog for _, _, analog in frames if analog.size]
    header = file.header
    events = list(zip(header.event_timings, header.event_labels, strict=True))
    return {
        "points": xyz,
        "analog": np.concatenate(signals, axis=1) if signals else np.zeros((0, 0)),
        "rate": float(header.frame_rate),
        "event_times": [float(time) for time, _ in events],
        "event_labels": [str(label) for _, label in events],
        "parameters": _parameters(file),
    }


def _parameters(file: Any) -> dict[str, list[str] | np.ndarray]:
    """`GROUP:NAME` in capitals -> texts, or numbers in the file's own order of dimensions."""
    out: dict[str, list[str] | np.ndarray] = {}
    for group, entry in file.group_items():
        for name, parameter in entry.param_items():
            with contextlib.suppress(ValueError, AssertionError):  # one that is damaged is left out
                out[f"{group}:{name}".upper()] = _value(parameter)
    return out


def _value(parameter: Any) -> list[str] | np.ndarray:
    """The value; the first dimension changes fastest in the file, of texts it is their length."""
    kind, sizes = parameter.bytes_per_element, list(parameter.dimensions)
    if kind == _TEXT:
        return _texts(parameter.bytes, sizes or [1])
    if 0 in sizes:
        return np.zeros(sizes)
    types = parameter._dtypes
    dtype = {_BYTE: np.dtype(np.uint8), _INTEGER: types.int16, _REAL: types.float32}[kind]
    if kind == _REAL and types.is_dec:
        values = parameter.float_array if sizes else np.array(parameter.float_value)
        return np.asarray(values, dtype=float).reshape(sizes[::-1] or [1]).T
    values = np.frombuffer(parameter.bytes, dtype=dtype).astype(float)
    return values.reshape(sizes[::-1] or [1]).T


def _texts(raw: bytes, sizes: list[int]) -> list[str]:
    length, count = sizes[0], int(np.prod(sizes[1:])) if sizes != [0] else 0
    cells = [raw[k * length : (k + 1) * length] for k in range(count)]
    return [cell.decode("utf-8", "replace").strip("\0 ") for cell in cells]
