"""Long arrays worked on in chunks that stay in a core's cache."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from exo_pin.arrays import is_remote

CHUNK = 6000
"""Samples worked on at once on a CPU: what stays in a core's cache."""
_REMOTE_CHUNK = 8_000_000  # on an accelerator: some 200 temporaries of 8 bytes a sample stay below 16 GB


def for_chunks(n: int, like: Any, work: Callable[[slice], None]) -> None:
    """Do a work chunk by chunk.

    Two threads do not pay: the arrays of a chunk are so short that both wait for Python's lock (measured
    with two cores at hand: 0.74 of the speed of one thread).

    Args:
        n: Number of samples.
        like: An array of the work: one chunk holds more where it lives on an accelerator.
        work: Takes the samples of one chunk.
    """
    size = _REMOTE_CHUNK if is_remote(like) else CHUNK
    for a in range(0, n, size):
        work(slice(a, min(a + size, n)))
