"""A C3D file of a DEC or MIPS machine as the same file of an Intel machine, which ezc3d reads."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from exo_pin.formats.c3d.header import Layout, records
from exo_pin.formats.c3d.number_formats import INTEL, floats, integers

WHOLE, REAL = 2, 4
"""Kinds of parameters that hold numbers, and the bytes of one."""

HEADER = ((2, 12, WHOLE), (12, 16, REAL), (16, 20, WHOLE), (20, 24, REAL), (24, 304, WHOLE), (304, 376, REAL))
"""Numbers of the first block: from, to [byte], kind; what follows are flags and labels of events."""


def to_intel(path: Path, data: bytes, layout: Layout) -> bytes:
    """The file with Intel's numbers; the same bytes where they are that already.

    Args:
        path: The file, for messages.
        data: Its contents, found sound by `c3dheader.check`.
        layout: What that found.
    """
    if layout.processor == INTEL:
        return data
    out = bytearray(data)
    places = list(HEADER)
    for record in records(path, data, layout):
        places.append((record.next_at, record.next_at + 2, WHOLE))
        if record.kind in (WHOLE, REAL):
            places.append((record.at, record.at + record.size * record.kind, record.kind))
    places.append((layout.begin, layout.end, REAL if layout.real else WHOLE))
    for start, stop, kind in places:
        read, as_intel = (integers, "<u2") if kind == WHOLE else (floats, "<f4")
        out[start:stop] = np.asarray(read(data[start:stop], layout.processor)).astype(as_intel).tobytes()
    out[layout.parameters + 3] = INTEL
    return bytes(out)
