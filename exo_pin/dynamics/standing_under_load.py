"""Force plates against the motion of the feet: a plate that bears a load has a standing foot on it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from exo_pin.arrays import Array, Mask
from exo_pin.errors import GaitError
from exo_pin.gait import Event, Gait
from exo_pin.gait.foot_velocity import slopes
from exo_pin.gait.spatiotemporal import ground_velocity
from exo_pin.kinematics import PlateStep
from exo_pin.kinematics.plate_contacts import FARTHEST, LOADED_PART
from exo_pin.kinematics.sole_points import heels_and_balls

NOBODY = "no foot is there"
"""Why a contact belongs to no foot, where nothing under the feet can be missing because of it."""

ON_THE_SPOT = 0.3
"""A walk whose pelvis stays within this length [m] is on a treadmill."""

_MOVES = 0.5
"""Speed over the ground [m/s] of the slowest corner of a sole from which the foot swings: a standing
one rolls with less, and one in mid-swing has 2 m/s and more at a usual speed."""

_HALF = 0.02
"""Speeds are slopes of lines fitted over this much [s] before and after."""

_LONGEST = 0.06
"""So long [s] a plate may bear a load while no foot stands on it: events of kinematics are 5 to 30 ms off."""


def check_standing(gait: Gait, corners: Array, steps: Sequence[PlateStep], events: Sequence[Event]) -> None:
    """Refuse plates that bear a load while no foot stands on them, by the motion of the feet.

    A contact that is far from both feet for most of its time is not the walker's, and left out.

    Args:
        gait: The walk, its pelvis in the world.
        corners: `(n, 8, 3)` positions of `CORNERS` [m].
        steps: Contacts with plates.
        events: Heel strikes and toe-offs of the motion, which tell the speed of a treadmill.

    Raises:
        GaitError: With the plate, the time, and for how long.
    """
    assert gait.base is not None
    pelvis = gait.base[:, :2, 3]
    soles = heels_and_balls(corners)
    if not events and np.ptp(pelvis, axis=0).max() < ON_THE_SPOT:
        return  # the ground's velocity is not known
    moves = _moves(gait, corners, ground_velocity(gait.time, soles[:, :, 0], events, pelvis))
    for step in steps:
        if step.side is None and step.why in ("", NOBODY):
            continue
        empty = _empty(gait, soles.mean(axis=2)[..., :2], moves, step)
        if empty > _LONGEST:
            raise GaitError(
                f"{step.when} is loaded for {1e3 * empty:.0f} ms while no foot stands on it by the motion of "
                "the feet: plates of another clock or trial? Those of the same clock are accepted"
            )


def _moves(gait: Gait, corners: Array, ground: Array) -> Mask:
    """`(n, 2)` whether each foot swings."""
    flat = corners[..., :2].reshape(len(gait), -1)
    time, rates = slopes(gait.time, flat, _HALF)
    speeds = np.linalg.norm(rates.reshape(len(time), 2, 4, 2) - ground, axis=-1).min(axis=2)
    return np.stack([np.interp(gait.time, time, speed) for speed in speeds.T], axis=1) > _MOVES


def _empty(gait: Gait, soles: Array, moves: Mask, step: PlateStep) -> float:
    """How long a plate is loaded while neither both feet stand, nor one of them at the force [s]."""
    rows = slice(step.contact.start, step.contact.stop)
    t, point, force = step.plate.time[rows], step.plate.point[rows, :2], step.plate.force[rows, 2]
    seen = (force >= LOADED_PART * force.max()) & (t >= gait.time[0]) & (t <= gait.time[-1])
    t, point = t[seen], point[seen]
    nearest = np.searchsorted((gait.time[1:] + gait.time[:-1]) / 2, t)
    stands, away = ~moves[nearest], np.linalg.norm(soles[nearest] - point[:, None], axis=2)
    borne = stands.all(axis=1) | (stands & ~(away > FARTHEST)).any(axis=1)
    return float(np.median(np.diff(step.plate.time)) * (~borne).sum())
