"""Stride and clearance, scaled where they are made: at the feet, the joint angles found anew."""

from __future__ import annotations

import dataclasses

import numpy as np
import numpy.typing as npt

from exo_pin import ik
from exo_pin.anatomy import CORNERS, FEET
from exo_pin.errors import ConvergenceError, GaitError
from exo_pin.gait import Gait
from exo_pin.kinematics import poses
from exo_pin.robot import Robot

Array = npt.NDArray[np.float64]

LARGEST = 3.0
"""Scale beyond which it is another walk."""

RESTING = 0.04
"""Over this height above its lowest [m] a sole's motion becomes a swing, wholly so above it."""

DEEPEST = 0.10
"""The pelvis is lowered no further than this [m] to let the legs reach a longer stride."""

SLACK = 0.01
"""What the legs keep of their reach [m], or as little as they had: close to it a knee jerks."""

ENOUGH = 1e-4
"""Lowering by less than this [m] is not worth another round."""

REACH = 0.005
"""A foot that misses its scaled path by more [m] is reported."""


def strided(
    robot: Robot, gait: Gait, *, stride: float = 1.0, clearance: float = 1.0
) -> tuple[Gait, ik.Track]:
    """Scale the feet's paths against the pelvis, and find the joint angles by inverse kinematics.

    Forward and backward of each foot's mean place, the path is scaled by `stride`; the height of the sole
    over the ground by `clearance`, where it is off the ground: standing feet stay on it. The feet's attitude
    stays; a walk that gets along goes `stride` times as far. Where the legs are too short for a longer
    stride, the pelvis is lowered evenly, up to 10 cm, and the source says how much.

    Args:
        robot: The robot, with a fixed base.
        gait: The walk.
        stride: Factor of the stride's length.
        clearance: Factor of the foot's height in swing.

    Returns:
        The new walk, and the solver's account of it.

    Raises:
        GaitError: A factor is negative or beyond 3, or the base of the robot floats.
        ConvergenceError: The legs cannot follow: some foot misses its path by more than 5 mm.
    """
    for name, factor in (("stride", stride), ("clearance", clearance)):
        if not 0 <= factor <= LARGEST:
            raise GaitError(f"{name} times {factor}: 0 to {LARGEST:g} is accepted")
    if robot.base != "fixed":
        raise GaitError("strided needs a robot with a fixed base; the gait carries the pelvis's motion")
    old = np.broadcast_to(robot.placement, (len(gait), 4, 4)) if gait.base is None else gait.base
    q = robot.from_gait(gait)
    feet = poses(robot, q, FEET, base=old)
    lift = _lift(robot, q, old)
    forward = _heading(old)
    new = old.copy()
    drift = _drift(old, gait.time) if not gait.periodic else np.zeros((len(gait), 3))
    new[:, :3, 3] += (stride - 1) * drift
    targets = feet.copy()
    for k in range(len(FEET)):
        ahead = np.einsum("ni,ni->n", feet[:, k, :3, 3] - old[:, :3, 3], forward)
        shift = (stride - 1) * (ahead - ahead.mean())
        targets[:, k, :3, 3] += shift[:, None] * forward + (stride - 1) * drift
        targets[:, k, 2, 3] += (clearance - 1) * lift[:, k]
    asked = [{foot: T[:, k] for k, foot in enumerate(FEET)} for T in (feet, targets)]
    slack = float(np.nanmin(ik.track(robot, asked[0], q, base=old).reach_slack))
    track, lowered = _reached(robot, asked[1], q, new, min(slack, SLACK))
    return _answer(robot, gait, track, new, f"stride x{stride:g}, clearance x{clearance:g}", lowered), track


def _reached(
    robot: Robot, paths: dict[str, Array], q: Array, base: Array, slack: float
) -> tuple[ik.Track, float]:
    """Joint angles for the feet's paths, the base lowered in place until the legs have that slack."""
    lowered = 0.0
    while True:
        track = ik.track(robot, paths, q, base=base)
        short = slack - float(np.nanmin(track.reach_slack))
        step = min(short, DEEPEST - lowered)
        if step < ENOUGH:
            return track, lowered
        base[:, 2, 3] -= step
        lowered += step


def _answer(robot: Robot, gait: Gait, track: ik.Track, base: Array, what: str, lowered: float) -> Gait:
    worst = np.unravel_index(np.nanargmax(track.position_error), track.position_error.shape)
    miss = float(track.position_error[worst])
    if miss > REACH:
        bad = int((track.position_error > REACH).any(axis=1).sum())
        raise ConvergenceError(
            f"{what}: the legs cannot follow in {bad} frames; "
            f"{track.frames[worst[1]]} misses by {miss * 1e3:.0f} mm in frame {worst[0]}; ask for less",
            track[int(worst[0])],
        )
    words = f"{what} at the feet" + (f", pelvis lowered by {lowered * 1e3:.0f} mm" if lowered else "")
    source = f"{gait.source}; {words}" if gait.source else words
    moved = gait.base is not None or lowered > 0
    like = dataclasses.replace(gait, base=base) if moved else gait
    return dataclasses.replace(robot.to_gait(track.q, like), source=source)


def _lift(robot: Robot, q: Array, base: Array) -> Array:
    """`(n, 2)` how far each sole is off the ground [m]; 0 while it stands."""
    height = poses(robot, q, CORNERS, base=base)[..., 2, 3].reshape(len(q), len(FEET), -1).min(axis=2)
    ground = np.percentile(height, 5, axis=0)
    above = np.maximum(height - ground, 0.0)
    part = np.minimum(above / RESTING, 1.0)
    return np.asarray(above * part**2 * (3 - 2 * part))  # grows in smoothly, so the foot does not jerk


def _heading(base: Array) -> Array:
    """`(n, 3)` where the pelvis looks, level."""
    forward = base[:, :3, 0] * [1.0, 1.0, 0.0]
    return np.asarray(forward / np.maximum(np.linalg.norm(forward, axis=1, keepdims=True), 1e-9))


def _drift(base: Array, time: Array) -> Array:
    """`(n, 3)` the even part of the pelvis's level motion: how far the walk has got [m]."""
    t = time - time.mean()
    speed = (t @ (base[:, :3, 3] - base[:, :3, 3].mean(axis=0))) / (t @ t)
    return np.asarray((time - time[0])[:, None] * speed * [1.0, 1.0, 0.0])
