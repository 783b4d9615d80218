"""Poses of frames on legs of six joints: formulas on whole arrays instead of a loop over the samples."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from exo_pin.arrays import Array
from exo_pin.chunks import for_chunks
from exo_pin.robot import Robot, leg_forward
from exo_pin.robot.leg_axes import LegAxes
from exo_pin.robot.leg_forward import Tip


def legs_of(robot: Robot, frames: Sequence[str]) -> dict[int, LegAxes]:
    """The leg that carries each frame, by the frame's place in the list; other frames are left out.

    A floating base moves its legs, so that no frame is on a leg alone there.

    Args:
        robot: The robot.
        frames: Names of links, point frames or joints.

    Raises:
        UnknownNameError: A frame is unknown.
    """
    if robot.base == "floating":
        return {}
    found = ((k, robot.leg(name)) for k, name in enumerate(frames))
    return {k: leg for k, leg in found if leg is not None}


def write_leg_poses(legs: dict[int, LegAxes], q: Array, out: Array) -> None:
    """Write T_world_frame of every frame on a leg, the robot at its own placement.

    Args:
        legs: As of `legs_of`.
        q: Configurations (n, nq) [rad].
        out: `(n, F, 4, 4)`; other frames in it are left as they are.
    """
    by_joints: dict[tuple[int, ...], list[int]] = {}
    for k, leg in legs.items():
        by_joints.setdefault(tuple(leg.columns.tolist()), []).append(k)

    def of_chunk(part: slice) -> None:
        for places in by_joints.values():
            _for_tips({k: legs[k] for k in places}, q[part], lambda k, tip: _write(tip, out[part, k]))

    for_chunks(len(q), q, of_chunk)


def _for_tips(legs: dict[int, LegAxes], q: Array, write: Callable[[int, Tip], None]) -> None:
    """Hand on the poses of frames that the same joints carry: of the first one, the others fixed to it."""
    first = next(iter(legs.values()))
    tip = leg_forward.pose(first, np.ascontiguousarray(q[:, first.columns].T, like=q))
    back = np.linalg.inv(first.tip)
    for k, leg in legs.items():
        offset = back @ leg.tip
        along = [float(x) for x in offset[:3, 3]]
        p = [x + leg_forward.mix(row, along) for x, row in zip(tip.p, tip.R, strict=True)]
        write(k, tip if leg is first else Tip(leg_forward.times(tip.R, offset[:3, :3]), p))


def _write(tip: Tip, out: Array) -> None:
    """Poses component by component into `(n, 4, 4)`."""
    for i in range(3):
        for j in range(3):
            out[:, i, j] = tip.R[i][j]
        out[:, i, 3] = tip.p[i]
    out[:, 3, :3] = 0.0
    out[:, 3, 3] = 1.0
