"""A scene packed for transport: as one compressed binary, or as one offline HTML page around it."""

from __future__ import annotations

import gzip
import hashlib
import json
import struct
from dataclasses import asdict

import numpy as np
from numpy.typing import NDArray

from exo_pin.viewer.page.page import PageTemplate
from exo_pin.viewer.scenes.scene import Scene

_TYPES = {"float32": ("f4", "<f4"), "float64": ("f8", "<f8")}


def bundle(scene: Scene) -> bytes:
    """Pack a scene: gzip of chunks (u32 length, bytes): JSON header, meshcat commands, arrays.

    The same scene gives the same bytes.

    Args:
        scene: What to pack.

    Returns:
        The compressed bytes.
    """
    import umsgpack  # comes with meshcat

    commands = [umsgpack.packb(command) for command in scene.commands]
    arrays = [_rows(values) for values in scene.arrays.values()]
    body = b"".join(_chunk(part) for part in (*commands, *(data.tobytes() for data in arrays)))
    facts = asdict(scene.facts) | {
        "commands": len(commands),
        "arrays": [_spec(name, data) for name, data in zip(scene.arrays, arrays, strict=True)],
    }
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


def _rows(values: NDArray[np.floating]) -> NDArray[np.floating]:
    data = np.ascontiguousarray(values, dtype=_TYPES[values.dtype.name][1])
    return data.reshape(len(data), -1)


def _spec(name: str, data: NDArray[np.floating]) -> dict[str, str | int]:
    return {"name": name, "type": _TYPES[data.dtype.name][0], "width": data.shape[1]}
