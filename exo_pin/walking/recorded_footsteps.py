"""The footsteps of a recorded walk: where its feet stood flat, and how quickly they took turns."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from exo_pin.anatomy import FEET, SIDES
from exo_pin.anatomy.names import Side
from exo_pin.arrays import Array
from exo_pin.errors import GaitError
from exo_pin.gait import Gait
from exo_pin.gait.event import FOOT_FLAT
from exo_pin.gait.time_series import runs
from exo_pin.kinematics import poses
from exo_pin.robot import Robot
from exo_pin.walking.footsteps import Footstep, Footsteps

_TRAVEL = 0.2
"""A pelvis that ends less than this from where it began walked on the spot or on a treadmill [m]."""


class _Stance(NamedTuple):
    """A foot on the ground: from and to [s], and which one; the recording may cut either end."""

    start: float
    end: float
    side: Side


def recorded_footsteps(robot: Robot, gait: Gait, *, clearance: float = 0.05) -> Footsteps:
    """The footsteps of a walk over ground, at its mean step time and double support, on level ground.

    Args:
        robot: Whose feet walked.
        gait: The walk, with the motion of its pelvis and its events.
        clearance: Height of the swinging foot's ball over the ground in mid-swing [m].

    Raises:
        GaitError: The walk has no pelvis in the room or no events, it walks on the spot, or its feet do not
            take turns.
    """
    if gait.base is None:
        raise GaitError("the walk has no motion of its pelvis, so where its feet stand is not known")
    if np.linalg.norm(gait.base[-1, :2, 3] - gait.base[0, :2, 3]) < _TRAVEL:
        raise GaitError("the walk stays on the spot, as on a treadmill: it has no footsteps over ground")
    stances = sorted(stance for side in SIDES for stance in _stances(gait, side))
    if len(stances) < 3:
        raise GaitError(f"the walk has {len(stances)} stances of its feet; at least 3 are accepted")
    feet = poses(robot, robot.from_gait(gait), FEET, base=robot.base_of(gait))
    steps = [_place(gait, feet[:, SIDES.index(stance.side)], stance) for stance in stances]
    if steps[0].side == steps[1].side:
        raise GaitError("the walk's first two stances are of the same foot; left and right take turns")
    left, right = sorted(steps[:2], key=lambda foot: SIDES.index(foot.side))
    return Footsteps((left, right), tuple(steps[2:]), *_times(gait, stances), clearance)


def _stances(gait: Gait, side: Side) -> list[_Stance]:
    """The stances of a foot, those that the recording cuts as far as they are seen."""
    time, down = gait.time, gait.stance(side)
    return [_Stance(float(time[a]), float(time[b - 1]), side) for a, b in runs(down) if b - a > 1]


def _place(gait: Gait, T: Array, stance: _Stance) -> Footstep:
    """Where the foot was flat: the mean over the middle of its stance."""
    inside = [stance.start + part * (stance.end - stance.start) for part in FOOT_FLAT]
    a, b = np.searchsorted(gait.time, inside)
    seen = T[int(a) : max(int(b), int(a) + 1)]
    ahead = seen[:, :2, 0].mean(axis=0)
    x, y = seen[:, :2, 3].mean(axis=0).tolist()
    return Footstep(stance.side, x, y, math.atan2(ahead[1], ahead[0]))


def _times(gait: Gait, stances: list[_Stance]) -> tuple[float, float]:
    """Mean step time [s], and share of it in double support; of landings that the recording holds."""
    landed = [k for k, stance in enumerate(stances) if stance.start > gait.time[0]]
    if len(landed) < 2:
        raise GaitError("the walk holds fewer than two landings, so its step time is not known")
    strikes = [stances[k].start for k in landed]
    step_time = (strikes[-1] - strikes[0]) / (len(strikes) - 1)
    whole = [k for k in landed if k and stances[k - 1].end < gait.time[-1]]
    overlaps = [max(stances[k - 1].end - stances[k].start, 0.0) for k in whole]
    if not overlaps:
        raise GaitError("the walk holds no whole double support")
    return step_time, float(np.clip(np.mean(overlaps) / step_time, 0.05, 0.9))
