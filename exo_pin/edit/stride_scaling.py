"""Stride length and foot clearance scaled: paths of the feet, then joint angles by inverse kinematics."""

from __future__ import annotations

import dataclasses
from itertools import pairwise

import numpy as np

from exo_pin import ik
from exo_pin.anatomy import CORNERS, FEET, SIDES
from exo_pin.anatomy.names import Side
from exo_pin.arguments import number
from exo_pin.arrays import Array, Mask
from exo_pin.demand import ACCELERATION_LIMIT
from exo_pin.edit.pelvis_drop import drop, smoothed
from exo_pin.errors import ConvergenceError, GaitError
from exo_pin.gait import Gait
from exo_pin.gait.heading import headings
from exo_pin.gait.time_series import runs
from exo_pin.kinematics import events, poses
from exo_pin.kinematics.resting_stance import travel
from exo_pin.robot import Robot

_LARGEST_FACTOR = 3.0
"""A walk scaled by more would be another walk."""

_SLACKS = (0.003, 0.006, 0.010, 0.015, 0.020, 0.030)
"""Reserves of a leg's reach that are tried [m]: knees bent by 10 to 30 degrees."""

_SWING_HEIGHT = 0.005
"""Without events, a sole higher than this swings [m] ..."""

_SHORTEST_SWING = 0.15
"""... if it stays higher for longer than this [s]."""

_AT_LIMIT = 1e-6
"""A joint this close to its limit counts as on it [rad]."""

_LARGEST_MISS = 0.002
"""A foot further from its scaled path than this [m] is an error."""


def strided(
    robot: Robot, gait: Gait, *, stride: float = 1.0, clearance: float = 1.0
) -> tuple[Gait, ik.Track]:
    """Scale the paths of the feet relative to the pelvis, and find the joint angles by inverse kinematics.

    Forward and backward of each foot's mean place, the path is scaled by `stride`. The height of the sole
    over the ground is scaled by `clearance` in mid swing, and less towards the ends of the swing: standing
    feet keep their place. The feet keep their attitude; a walk over ground goes `stride` times as far.

    Where a leg would be longer than before and nearly straight, the pelvis is lowered smoothly, by up to
    10 cm. How far the knee stays bent is chosen so that no joint exceeds `exo_pin.demand.ACCELERATION_LIMIT`,
    where that is possible. The source of the new walk states how far the pelvis was lowered.

    Args:
        robot: The robot, with a fixed base.
        gait: The walk.
        stride: Factor on the stride length.
        clearance: Factor on the foot's height in mid swing.

    Returns:
        The new walk, and the solution of the inverse kinematics.

    Raises:
        GaitError: A factor is negative or beyond 3, or the base of the robot floats.
        ConvergenceError: Some foot misses its path by more than 2 mm: the legs cannot follow it.
    """
    for name, factor in (("stride", stride), ("clearance", clearance)):
        number(f"factor on {name}", factor, least=0.0, most=_LARGEST_FACTOR, error=GaitError)
    if robot.base != "fixed":
        raise GaitError("strided needs a robot with a fixed base; the gait carries the pelvis's motion")
    old = robot.pelvis_poses(gait)
    q = robot.from_gait(gait)
    feet = poses(robot, q, FEET, base=old)
    drift = (stride - 1) * (_drift(old, gait.time) if not gait.periodic else np.zeros((len(gait), 3)))
    new, targets = old.copy(), feet.copy()
    new[:, :3, 3] += drift
    heading, lift = headings(old), _lift(robot, gait, q, old)
    for k in range(len(FEET)):
        ahead = np.einsum("ni,ni->n", feet[:, k, :2, 3] - old[:, :2, 3], heading)
        targets[:, k, :2, 3] += (stride - 1) * (ahead - ahead.mean())[:, None] * heading + drift[:, :2]
        targets[:, k, 2, 3] += (clearance - 1) * lift[:, k]
    what = f"stride x{stride:g}, clearance x{clearance:g}"
    return _least_bent(robot, gait, q, (feet, targets), (old, new), what)


def _least_bent(
    robot: Robot,
    gait: Gait,
    q: Array,
    feet: tuple[Array, Array],
    base: tuple[Array, Array],
    what: str,
) -> tuple[Gait, ik.Track]:
    """The walk along the feet's paths with the smallest slack whose accelerations stay within the limit."""
    paths = {foot: feet[1][:, k] for k, foot in enumerate(FEET)}
    step = gait.duration / (len(gait) - (not gait.periodic))
    allowed = max(ACCELERATION_LIMIT, float(np.abs(gait.ddq).max()))
    tried: list[tuple[float, Gait, ik.Track]] = []
    misses: list[float] = []
    for slack in _SLACKS:
        down = smoothed(drop(robot, feet, base, slack), step, gait.periodic)
        under = base[1].copy()
        under[:, 2, 3] -= down
        track = ik.track(robot, paths, q, base=under)
        walk = _as_walk(robot, gait, track, under, what, down)
        tried.append((float(np.abs(walk.ddq).max()), walk, track))
        misses.append(float(np.nanmax(track.position_error)))
        # a joint limit, not the reach, keeps the foot away: a lower pelvis is no help
        no_better = len(misses) > 1 and misses[-1] >= misses[-2] > _LARGEST_MISS
        if tried[-1][0] <= allowed or not down.any() or no_better:
            break
    reached = [x for x in tried if np.nanmax(x[2].position_error) <= _LARGEST_MISS] or tried[:1]
    _, walk, track = min(reached, key=lambda x: x[0])
    _check_reached(robot, track, what)
    return walk, track


def _check_reached(robot: Robot, track: ik.Track, what: str) -> None:
    """Raises `ConvergenceError` if a foot misses its path."""
    worst = np.unravel_index(np.nanargmax(track.position_error), track.position_error.shape)
    miss = float(track.position_error[worst])
    if miss > _LARGEST_MISS:
        limits = _at_limits(robot, track.q[worst[0]])
        bad = int((track.position_error > _LARGEST_MISS).any(axis=1).sum())
        raise ConvergenceError(
            f"{what}: the legs cannot follow in {bad} frames; {track.frames[worst[1]]} misses by "
            f"{miss * 1e3:.0f} mm in frame {worst[0]}{limits}; ask for less",
            track[int(worst[0])],
        )


def _at_limits(robot: Robot, q: Array) -> str:
    """Which joints are at their limits, in words."""
    angles = robot.angles(q)
    ends = np.minimum(angles - robot.lower, robot.upper - angles) < _AT_LIMIT
    names = [joint for joint, end in zip(robot.joints, ends, strict=True) if end]
    return f" with {', '.join(names)} at the limit" if names else ""


def _as_walk(robot: Robot, gait: Gait, track: ik.Track, base: Array, what: str, down: Array) -> Gait:
    """The solution as a walk; its source records the adjustment."""
    lowered = f", pelvis lowered by up to {1e3 * down.max():.0f} mm, {1e3 * down.mean():.0f} in the mean"
    words = f"{what} at the feet" + (lowered if down.max() > _SWING_HEIGHT / 10 else "")
    source = f"{gait.source}; {words}" if gait.source else words
    moved = gait.base is not None or down.any()
    like = dataclasses.replace(gait, base=base) if moved else gait
    return dataclasses.replace(robot.to_gait(track.q, like), source=source)


def _lift(robot: Robot, gait: Gait, q: Array, base: Array) -> Array:
    """`(n, 2)` a smooth bump over each swing, as high as the sole is over the ground in mid swing [m]."""
    height = poses(robot, q, CORNERS, base=base)[..., 2, 3].reshape(len(q), len(FEET), -1).min(axis=2)
    above = np.maximum(height - np.percentile(height, 5, axis=0), 0.0)
    lift: Array = np.zeros(above.shape)
    swings = _swings(robot, gait, above)
    for k, side in enumerate(SIDES):
        for start, end in swings[side]:
            since, middle = gait.time - start, (start + end) / 2
            if gait.periodic:  # around the end
                since, middle = since % gait.duration, middle % gait.duration
            share = (since / (end - start)).clip(0, 1)
            high = np.interp(middle, gait.time, above[:, k])
            lift[:, k] += high * 64 * (share * (1 - share)) ** 3  # two derivatives are zero at both ends
    return lift


def _swings(robot: Robot, gait: Gait, above: Array) -> dict[Side, list[tuple[float, float]]]:
    """Start and end of every swing by side [s]: by the events, or else by the height of the soles."""
    try:
        known = gait.events or events(robot, gait)
    except GaitError:
        known = ()
    swings: dict[Side, list[tuple[float, float]]] = {side: [] for side in SIDES}
    for k, side in enumerate(SIDES):
        mine = [event for event in known if event.side == side]
        if gait.periodic and mine:
            mine.append(dataclasses.replace(mine[0], time=mine[0].time + gait.duration))
        swings[side] = [
            (a.time, b.time) for a, b in pairwise(mine) if (a.kind, b.kind) == ("toe_off", "heel_strike")
        ]
        if not swings[side]:
            swings[side] = _off_ground(gait.time, above[:, k] > _SWING_HEIGHT)
    return swings


def _off_ground(time: Array, off: Mask) -> list[tuple[float, float]]:
    """Intervals in which a foot is off the ground [s], without short ones."""
    spans = ((float(time[a]), float(time[b - 1])) for a, b in runs(off))
    return [(a, b) for a, b in spans if b - a > _SHORTEST_SWING]


def _drift(base: Array, time: Array) -> Array:
    """`(n, 3)` progression of the walk: the pelvis's motion at constant velocity along the ground [m]."""
    even = travel(time, base[:, :3, 3], periodic=False)
    return np.asarray(even - even[0])
