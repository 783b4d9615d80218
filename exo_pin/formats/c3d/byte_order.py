"""Number formats of Intel, DEC and MIPS processors in C3D files."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

INTEL, DEC, MIPS = 84, 85, 86
PROCESSORS = {INTEL: "<", DEC: "<", MIPS: ">"}
"""Processor that wrote the numbers -> byte order of its integers."""


def integers(raw: bytes, processor: int) -> NDArray[np.uint16]:
    """Unsigned integers of 16 bits."""
    return np.frombuffer(raw, f"{PROCESSORS[processor]}u2").astype(np.uint16)


def floats(raw: bytes, processor: int) -> NDArray[np.float32]:
    """Floating-point numbers of 32 bits.

    DEC's are VAX F_floating: the halves exchanged, an exponent that is larger by 2 than in IEEE 754, and 0
    wherever the exponent is 0 (VAX Architecture Reference Manual). What is too small for IEEE is 0.
    """
    if processor != DEC:
        return np.frombuffer(raw, f"{PROCESSORS[processor]}f4").astype(np.float32)
    high, low = np.frombuffer(raw, "<u2").reshape(-1, 2).astype(np.uint32).T
    bits = (high << 16) | low
    tiny = ((bits >> 23) & 0xFF) <= 2
    return np.where(tiny, np.uint32(0), bits - np.uint32(2 << 23)).astype(np.uint32).view(np.float32)
