"""Damage to files: a few places overwritten, cut out or filled in with what hurts readers."""

from __future__ import annotations

import os

from hypothesis import strategies as st

FILES = int(os.environ.get("EXO_PIN_MUTATIONS", "40"))  # damaged files of each kind: CI has minutes
SLOWEST = 5.0  # [s] of this process


def files_of_processes(share, default):
    """How many damaged files of a kind that costs a process each: a share of `FILES`, or CI's default."""
    return FILES // share if "EXO_PIN_MUTATIONS" in os.environ else default


@st.composite
def damaged(draw, text, pieces, whole=1):
    """The file with a few places changed; one in `whole + 1` is cut in half besides."""
    data = bytearray(text)
    for _ in range(draw(st.integers(1, 3))):
        start = draw(st.integers(0, len(data)))
        length = draw(st.sampled_from([0, 1, 2, 5, 20, 200]))
        data[start : start + length] = draw(st.sampled_from(pieces) | st.binary(max_size=4))
    return bytes(data[: draw(st.sampled_from([*whole * [len(data)], len(data) // 2]))])
