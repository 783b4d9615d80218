"""Angles of segments: the pelvis against the laboratory, the feet against the way of the walk."""

from __future__ import annotations

import numpy as np

from exo_pin.anatomy import FEET, SIDES
from exo_pin.anatomy.names import ClinicalAngle, Side
from exo_pin.arrays import Array
from exo_pin.gait import Gait, time_series
from exo_pin.gait.heading import mean_heading
from exo_pin.gait.marked_feet import FootMarkers
from exo_pin.gait.rigid_poses import nearest_pose
from exo_pin.gait.spatiotemporal import ground_velocity
from exo_pin.gait.strides import unrolled
from exo_pin.kinematics import poses
from exo_pin.kinematics.sole_points import sole_points
from exo_pin.robot import Robot

_SHORTEST_WAY = 0.2
"""A pelvis that gets along less in a stride [m] is on a treadmill; a stride shorter over the ground than this
has no direction."""


def ways(robot: Robot, gait: Gait, times: Array) -> Array:
    """`(k,)` the direction in which the person goes over the ground in each cycle, from x about z [rad].

    The pelvis's own way; on a treadmill that against the ground, whose velocity is the resting feet's; on the
    spot the pelvis's mean heading.

    Args:
        robot: Whose feet they are.
        gait: The walk, with events and a moving pelvis.
        times: `(k, m)` of its cycles [s].
    """
    walk = unrolled(gait)
    pelvis = _base(walk)[:, :2, 3]
    ground = ground_velocity(walk.time, sole_points(robot, walk)[:, :, 0], walk.events, pelvis)
    out = []
    for cycle in times:
        ends = np.stack([np.interp(cycle[[0, -1]], walk.time, pelvis[:, axis]) for axis in range(2)], axis=1)
        way = ends[1] - ends[0]
        if np.linalg.norm(way) < _SHORTEST_WAY:
            way = way - ground * (cycle[-1] - cycle[0])
        if np.linalg.norm(way) < _SHORTEST_WAY:
            way = mean_heading(_poses_at(walk, cycle))
        out.append(np.arctan2(way[1], way[0]))
    return np.array(out)


def pelvis_angles(gait: Gait, side: Side, times: Array, way: Array) -> dict[ClinicalAngle, Array]:
    """Tilt, obliquity and rotation `(k, m)` [rad] of the pelvis in each cycle.

    Cardan angles about the laboratory's transverse axis, the axis forward, and the pelvis's own vertical, as
    in Plug-in Gait; obliquity and rotation are positive where this side is up and forward.

    Args:
        gait: The walk, its pelvis moving.
        side: Whose obliquity and rotation.
        times: `(k, m)` of its cycles [s].
        way: `(k,)` of `ways` [rad].
    """
    walk = unrolled(gait)
    R = np.stack([_ahead(_poses_at(walk, cycle)[:, :3, :3], w) for cycle, w in zip(times, way, strict=True)])
    sign = 1.0 if side == "left" else -1.0
    return {
        "pelvis_tilt": np.arctan2(R[..., 0, 2], R[..., 2, 2]),
        "pelvis_obliquity": sign * np.arcsin(np.clip(-R[..., 1, 2], -1.0, 1.0)),
        "pelvis_rotation": -sign * np.arctan2(R[..., 1, 0], R[..., 1, 1]),
    }


def foot_progression(robot: Robot, gait: Gait, side: Side, times: Array, way: Array) -> Array:
    """`(k, m)` angle of the model's foot out of the plane of the way; positive: toe-in [rad].

    The arc sine of the sideways part of the foot's long axis, as in Plug-in Gait: unlike a heading seen from
    above it stays small while the foot points downwards.

    Args:
        robot: Whose feet they are.
        gait: The walk, its pelvis moving.
        side: Which foot.
        times: `(k, m)` of its cycles [s].
        way: `(k,)` of `ways` [rad].
    """
    walk = unrolled(gait)
    foot = poses(robot, robot.from_gait(walk), (FEET[SIDES.index(side)],), base=robot.base_of(walk))[:, 0]
    return _out_of_the_way(walk.time, foot[:, :3, 0], side, times, way)


def marked_progression(feet: FootMarkers, side: Side, times: Array, way: Array) -> Array:
    """The same of the line from heel marker to toe marker; NaN where one was not seen.

    Args:
        feet: The markers.
        side: Which foot.
        times: `(k, m)` of the cycles [s].
        way: `(k,)` of `ways` [rad].
    """
    line = (feet.toes - feet.heels)[:, SIDES.index(side)]
    long = line / np.maximum(np.linalg.norm(line, axis=1, keepdims=True), 1e-9)
    return _out_of_the_way(feet.time, long, side, times, way)


def _out_of_the_way(time: Array, axis: Array, side: Side, times: Array, way: Array) -> Array:
    """`(k, m)` arc sine of the sideways part of unit vectors `(n, 3)`, positive towards the other side."""
    x, y = (np.interp(times, time, axis[:, k]) for k in range(2))
    left = np.cos(way)[:, None] * y - np.sin(way)[:, None] * x
    return np.asarray(np.arcsin(np.clip(-left if side == "left" else left, -1.0, 1.0)))


def _base(gait: Gait) -> Array:
    assert gait.base is not None  # the callers ask for it
    return gait.base


def _poses_at(walk: Gait, times: Array) -> Array:
    """`(m, 4, 4)` the pelvis at times within the walk."""
    flat = time_series.resampled(walk.time, _base(walk).reshape(-1, 16), times, periodic=False)
    return nearest_pose(flat.reshape(-1, 4, 4))


def _ahead(R: Array, way: float) -> Array:
    """Rotations `(m, 3, 3)` in axes with x along the way."""
    c, s = np.cos(way), np.sin(way)
    return np.asarray(np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]) @ R)
