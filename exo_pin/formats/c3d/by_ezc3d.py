"""C3D content by the package ezc3d (C++): a module of the child process, without imports of this package."""

from __future__ import annotations

from typing import Any

import numpy as np


def load(path: str) -> dict[str, Any]:
    """Points, analog signals, rate, header events and parameters of a file, as `by_c3d.load` has them."""
    import ezc3d

    file = ezc3d.c3d(path)
    header = file["header"]
    events = header["events"]
    return {
        "points": file["data"]["points"][:3],
        "analog": file["data"]["analogs"][0],
        "rate": float(header["points"]["frame_rate"]),
        "event_times": list(events["events_time"]),
        "event_labels": list(events["events_label"]),
        "parameters": _parameters(file["parameters"]),
    }


def _parameters(groups: Any) -> dict[str, list[str] | np.ndarray]:
    """`GROUP:NAME` in capitals -> texts, or numbers in the file's own order of dimensions."""
    return {
        f"{group}:{name}".upper(): _value(entry)
        for group, entries in groups.items()
        for name, entry in entries.items()
        if "value" in entry
    }


def _value(entry: Any) -> list[str] | np.ndarray:
    value = entry["value"]
    if isinstance(value, list):
        return [str(text) for text in value]
    return np.asarray(value, dtype=float)
