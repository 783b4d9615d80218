"""Contacts of a foot with a force plate, from the vertical ground reaction force."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from exo_pin.arrays import Array
from exo_pin.errors import GaitError
from exo_pin.gait.time_series import runs
from exo_pin.gait.validation import check_time, frozen

FORCE_PLATE = "force plate"
_THRESHOLD = 20.0
"""Vertical force of a contact [N]: the laboratories' usual value."""

_SHORTEST_CONTACT = 0.05
"""A contact, or a gap between contacts, that is shorter [s] is noise of the plate."""


_SHORTEST_CUT_CONTACT = 0.02
"""Of a contact that the recording's start or end cuts off [s]: its rest is not known."""


class Contact(NamedTuple):
    """One contact with a plate; None where it began before or ended after the recording.

    Attributes:
        strike: When the force rises above the threshold [s].
        off: When it falls below [s].
        start: First sample in contact.
        stop: Sample after the last one in contact.
    """

    strike: float | None
    off: float | None
    start: int
    stop: int


def contacts(time: ArrayLike, vertical: ArrayLike, *, threshold: float = _THRESHOLD) -> tuple[Contact, ...]:
    """Contacts with a force plate.

    Args:
        time: `(m,)` [s].
        vertical: `(m,)` vertical ground reaction force, upwards positive [N].
        threshold: Force of a contact [N].

    Returns:
        The contacts in order; the times are interpolated between samples.

    Raises:
        GaitError: Unusable arrays.
    """
    t, force = frozen(time, "time"), frozen(vertical, "vertical force")
    check_time(t, periodic=False)
    if force.shape != t.shape or not np.isfinite(force).all():
        raise GaitError(f"vertical force: expected finite numbers ({len(t)},) [N], not {force.shape}")
    loaded = _joined(t, runs(force > threshold))
    loaded = [run for run in loaded if t[run[1] - 1] - t[run[0]] >= _shortest(*run, len(t))]
    return tuple(
        Contact(
            _crossing(t, force, start, threshold) if start else None,
            _crossing(t, force, stop, threshold) if stop < len(t) else None,
            start,
            stop,
        )
        for start, stop in loaded
    )


def _shortest(start: int, stop: int, n: int) -> float:
    return _SHORTEST_CONTACT if start > 0 and stop < n else _SHORTEST_CUT_CONTACT


def _joined(time: Array, spans: list[tuple[int, int]]) -> list[tuple[int, int]]:
    """Spans with too short a gap between them are one."""
    out: list[tuple[int, int]] = []
    for start, stop in spans:
        if out and time[start] - time[out[-1][1] - 1] < _SHORTEST_CONTACT:
            out[-1] = (out[-1][0], stop)
        else:
            out.append((start, stop))
    return out


def _crossing(time: Array, force: Array, k: int, threshold: float) -> float:
    """When the force passes the threshold between the samples k - 1 and k."""
    before, after = force[k - 1], force[k]
    return float(time[k - 1] + (time[k] - time[k - 1]) * (threshold - before) / (after - before))
