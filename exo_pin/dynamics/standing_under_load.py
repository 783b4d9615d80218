"""Force plates against the motion of the feet: a plate that bears a load has a standing foot on it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from exo_pin.anatomy import SIDES
from exo_pin.arrays import Array, Mask
from exo_pin.errors import GaitError
from exo_pin.gait import Event, Gait
from exo_pin.gait.foot_velocity import slopes
from exo_pin.gait.spatiotemporal import ground_velocity
from exo_pin.kinematics import PlateStep
from exo_pin.kinematics.plate_contacts import FARTHEST, LOADED_PART
from exo_pin.kinematics.sole_points import heels_and_balls

NO_FOOT = "no foot is there"
"""Why a contact belongs to no foot, where nothing under the feet can be missing because of it."""

ON_THE_SPOT = 0.3
"""A walk whose pelvis stays within this length [m] is on a treadmill."""

_MOVES = 0.5
"""Speed over the ground [m/s] of the slowest corner of a sole from which the foot swings: a standing
one rolls with less, and one in mid-swing has 2 m/s and more at a usual speed."""

_HALF = 0.02
"""Speeds are slopes of lines fitted over this much [s] before and after."""

_WIDEST = 0.1
"""So far [m] a force may act beside the middle of the foot, in the mean of a contact: some 0.03 at
hand, and half a shoe's width is 0.05."""

_LONGEST = 0.06
"""So long [s] a plate may bear a load while no foot stands on it: events of kinematics are 5 to 30 ms off."""


def check_standing(gait: Gait, corners: Array, steps: Sequence[PlateStep], events: Sequence[Event]) -> None:
    """Refuse plates that bear a load while no foot stands on them, or beside the foot, by the feet's motion.

    A contact that is far from both feet for most of its time is not the walker's, and left out.

    Args:
        gait: The walk, its pelvis in the world.
        corners: `(n, 8, 3)` positions of `CORNERS` [m].
        steps: Contacts with plates.
        events: Heel strikes and toe-offs of the motion, which tell the speed of a treadmill.

    Raises:
        GaitError: With the plate, the time, and for how long, or how far beside the foot.
    """
    assert gait.base is not None
    pelvis = gait.base[:, :2, 3]
    soles = heels_and_balls(corners)
    if not events and np.ptp(pelvis, axis=0).max() < ON_THE_SPOT:
        return  # the ground's velocity is not known
    moves = _moves(gait, corners, ground_velocity(gait.time, soles[:, :, 0], events, pelvis))
    for step in steps:
        if step.side is None and step.why in ("", NO_FOOT):
            continue
        load = _load(gait, step)
        empty = float(np.median(np.diff(step.plate.time)) * (~_borne(load, soles, moves)).sum())
        if empty > _LONGEST:
            raise GaitError(
                f"{step.when} is loaded for {1e3 * empty:.0f} ms while no foot stands on it by the motion of "
                "the feet: plates of another clock or trial? Those of the same clock are accepted"
            )
        beside = 0.0 if step.side is None else _beside(load, soles[:, SIDES.index(step.side)])
        if beside > _WIDEST:
            raise GaitError(
                f"{step.when}: the force acts {100 * beside:.0f} cm beside the middle of the {step.side} "
                "foot: plates of another clock, trial or place? Those under the feet are accepted"
            )


class _Load(NamedTuple):
    """The loaded part of a contact: `(k,)` nearest samples of the walk, `(k, 2)` points of the force [m]."""

    samples: NDArray[np.intp]
    points: Array


def _load(gait: Gait, step: PlateStep) -> _Load:
    rows = slice(step.contact.start, step.contact.stop)
    t, force = step.plate.time[rows], step.plate.force[rows, 2]
    seen = (force >= LOADED_PART * force.max()) & (t >= gait.time[0]) & (t <= gait.time[-1])
    nearest = np.searchsorted((gait.time[1:] + gait.time[:-1]) / 2, t[seen])
    return _Load(nearest, step.plate.point[rows, :2][seen])


def _moves(gait: Gait, corners: Array, ground: Array) -> Mask:
    """`(n, 2)` whether each foot swings."""
    flat = corners[..., :2].reshape(len(gait), -1)
    time, rates = slopes(gait.time, flat, _HALF)
    speeds = np.linalg.norm(rates.reshape(len(time), 2, 4, 2) - ground, axis=-1).min(axis=2)
    return np.stack([np.interp(gait.time, time, speed) for speed in speeds.T], axis=1) > _MOVES


def _borne(load: _Load, soles: Array, moves: Mask) -> Mask:
    """`(k,)` whether both feet stand, or one of them at the force; a point that is not known is no reason."""
    middles = soles.mean(axis=2)[load.samples, :, :2]
    stands, away = ~moves[load.samples], np.linalg.norm(middles - load.points[:, None], axis=2)
    return np.asarray(stands.all(axis=1) | (stands & ~(away > FARTHEST)).any(axis=1))


def _beside(load: _Load, sole: Array) -> float:
    """Distance of the mean point from the line through heel and ball `(n, 2, 3)` of one foot, level [m]."""
    heel, ball = sole[load.samples, 0, :2], sole[load.samples, 1, :2]
    along, arm = ball - heel, load.points - heel
    across = (arm[:, 1] * along[:, 0] - arm[:, 0] * along[:, 1]) / np.linalg.norm(along, axis=1)
    known = across[np.isfinite(across)]
    return float(abs(known.mean())) if len(known) else 0.0
