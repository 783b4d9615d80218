"""A scene packed for transport: as one compressed binary, or as one offline HTML page around it."""

from __future__ import annotations

import gzip
import hashlib
import json
import struct
from dataclasses import asdict
from typing import Any

import numpy as np
from numpy.typing import NDArray

from exo_pin.viewer.page.page import PageTemplate
from exo_pin.viewer.scenes.scene import Scene

_LEVELS = 2**15 - 1
"""Steps of a curve each way from the middle of its range; one more down stands for NaN."""


def bundle(scene: Scene) -> bytes:
    """Pack a scene: gzip of chunks (u32 length, bytes): JSON header, meshcat commands, arrays.

    Times are float64, what poses figures is float32, and curves are rounded to 1/65534 of their range. But
    for times, columns follow each other, each number less the one before it, first bytes first: so they
    compress to half. Equal arrays are sent once. The same scene gives the same bytes.

    Args:
        scene: What to pack.

    Returns:
        The compressed bytes.
    """
    import umsgpack  # comes with meshcat

    commands = [umsgpack.packb(command) for command in scene.commands]
    exact = _pose_arrays(scene)
    chunks: dict[bytes, int] = {}
    specs = []
    for name, values in scene.arrays.items():
        spec, data = _packed(values.reshape(len(values), -1), exact=name in exact)
        specs.append({"name": name, **spec, "chunk": chunks.setdefault(data, len(chunks))})
    body = b"".join(_chunk(part) for part in (*commands, *chunks))
    facts = asdict(scene.facts) | {"commands": len(commands), "arrays": specs}
    facts["id"] = hashlib.sha256(json.dumps(facts).encode() + body).hexdigest()[:16]
    header = json.dumps(facts, allow_nan=False).encode()
    return gzip.compress(_chunk(header) + body, compresslevel=6, mtime=0)  # 9: 1 % smaller, 0.1 s slower


def html(scene: Scene) -> str:
    """The scene as a self-contained page: write it to a file and open it anywhere.

    Args:
        scene: What `viewer.scene` made.

    Returns:
        HTML. Everything is inside and compressed; the page's own policy forbids any request.
    """
    return PageTemplate.load().page(scene.title, bundle(scene))


def _chunk(data: bytes) -> bytes:
    return struct.pack("<I", len(data)) + data


def _pose_arrays(scene: Scene) -> set[str]:
    """Names of the arrays that pose figures."""
    return {name for chain in scene.facts.chains for name in (chain.q, chain.base)} | {"com"}


def _packed(rows: NDArray[np.floating], *, exact: bool) -> tuple[dict[str, Any], bytes]:
    """What the page must know of an array `(n, width)`, and its bytes."""
    width = {"width": rows.shape[1]}
    if rows.dtype.itemsize == 8:
        return {"type": "f8", **width}, np.ascontiguousarray(rows, "<f8").tobytes()
    if exact:
        return {"type": "f4", **width}, _shuffled(np.ascontiguousarray(rows.T, "<f4").view("<u4"))
    return _rounded(rows.astype(np.float64), width)


def _rounded(rows: NDArray[np.float64], width: dict[str, int]) -> tuple[dict[str, Any], bytes]:
    """As `_packed`, in 65535 steps over the range of each column."""
    known = np.isfinite(rows)
    some = known.any(axis=0)  # a column of NaN has no range
    low = np.where(some, np.where(known, rows, np.inf).min(axis=0, initial=np.inf), 0.0)
    high = np.where(some, np.where(known, rows, -np.inf).max(axis=0, initial=-np.inf), 0.0)
    middle = (low + high) / 2
    step = np.where(low < high, (high - low) / (2 * _LEVELS), 1.0)
    steps = np.where(known, np.round((np.where(known, rows, middle) - middle) / step), -_LEVELS - 1)
    spec = {"type": "i2", **width, "middle": middle.tolist(), "step": step.tolist()}
    return spec, _shuffled(np.ascontiguousarray(steps.T).astype("<i2").view("<u2"))


def _shuffled(columns: NDArray[np.unsignedinteger]) -> bytes:
    """Columns `(width, n)` as differences that wrap around, the first bytes of all numbers first."""
    changes = np.diff(columns, axis=1, prepend=np.zeros((len(columns), 1), columns.dtype))
    return changes.reshape(-1).view(np.uint8).reshape(-1, columns.dtype.itemsize).T.tobytes()
