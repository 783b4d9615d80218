"""Ground reaction of a walk that nothing else holds: the ground gives all that the motion takes.

The whole force acts at the zero-moment point (Vukobratovic and Borovac 2004, Int J Humanoid Robotics 1:157).
In double support it moves from an anchor point of the foot that leaves to one of the foot that has struck;
the anchors stay where they are, the shares move. No centre of pressure leaves its sole; what a ground cannot
give for that reason stays in the residual, and says that the walk falls.
"""

from __future__ import annotations

import numpy as np

from exo_pin.anatomy import CORNERS, FEET
from exo_pin.arrays import Array, Mask
from exo_pin.dynamics.base_motion import Motion
from exo_pin.dynamics.ground_forces import GroundForces
from exo_pin.dynamics.weight_shift import double_supports, standing_feet
from exo_pin.gait import Gait
from exo_pin.ground import Intervals
from exo_pin.kinematics import poses
from exo_pin.robot import Robot

FREE_CUTOFF = 20.0
"""Low-pass of such a walk [Hz]: a plan's accelerations at its steps are part of its balance; the usual one of
recordings would take them off."""

_ENDS = 1e-9
"""A double support that begins or ends this close [s] to an end of the walk is cut off by it."""


def free_reaction(robot: Robot, gait: Gait, motion: Motion, needed: Array, stance: Intervals) -> GroundForces:
    """Ground forces of a walk on level ground (z = 0) that carry it alone.

    Args:
        robot: A floating robot with the corners of its soles.
        gait: The walk, n samples.
        motion: Its motion.
        needed: `(n, 6)` force, and moment about mid-hip, that the motion takes, world axes [N, N m].
        stance: Side -> intervals on the ground [s].
    """
    soles = poses(robot, motion.q, CORNERS)[..., :2, 3].reshape(len(motion.q), len(FEET), 2, 2, 2)
    zmp = zero_moment_point(motion.base, needed)
    share, point = _shared(gait, stance, soles, zmp)
    force = np.where(needed[:, 2:3] > 0.0, needed[:, :3], 0.0)[:, None] * share[..., None]
    at = np.zeros((*point.shape[:2], 3))
    at[..., :2] = np.nan_to_num(point)
    about = needed[:, 3:] + np.cross(motion.base[:, :3, 3], needed[:, :3])  # the world's origin
    turning = about[:, 2] - np.cross(at, force)[..., 2].sum(axis=1)
    moment = np.zeros_like(force)
    moment[..., 2] = turning[:, None] * share * (needed[:, 2:3] > 0.0)
    loaded = (share > 0.0)[..., None]
    return GroundForces(force, np.where(loaded, at, np.nan), moment)


def zero_moment_point(base: Array, needed: Array) -> Array:
    """`(n, 2)` where the whole ground reaction acts on the ground z = 0 [m]; NaN where nothing presses on it.

    Args:
        base: `(n, 4, 4)` pose of the pelvis.
        needed: `(n, 6)` force, and moment about mid-hip, that the motion takes, world axes [N, N m].
    """
    about = needed[:, 3:] + np.cross(base[:, :3, 3], needed[:, :3])
    vertical = np.where(needed[:, 2] > 0.0, needed[:, 2], np.nan)
    return np.stack([-about[:, 1], about[:, 0]], axis=1) / vertical[:, None]


def _shared(gait: Gait, stance: Intervals, soles: Array, zmp: Array) -> tuple[Array, Array]:
    """Share `(n, 2)` and centre of pressure `(n, 2, 2)` of each foot."""
    share = standing_feet(gait, stance).astype(float)
    target = np.repeat(np.nan_to_num(zmp)[:, None], len(FEET), axis=1)
    local = np.stack([_on_sole(soles[:, foot], target[:, foot]) for foot in range(len(FEET))], axis=1)
    alone = (share > 0.0) & (share.sum(axis=1, keepdims=True) == 1.0)
    usual = np.array([_usual(alone, local, foot) for foot in range(len(FEET))])
    time = gait.time - gait.time[0]
    for a, b, late in double_supports(gait, stance):
        rows = np.flatnonzero((time >= a) & (time <= b))
        if not len(rows):
            continue
        anchor = usual.copy()
        if gait.periodic or a > _ENDS:
            anchor[1 - late] = local[rows[0], 1 - late]
        if gait.periodic or b < time[-1] - _ENDS:
            anchor[late] = local[rows[-1], late]
        start, end = (_in_world(soles[rows, foot], anchor[foot]) for foot in (1 - late, late))
        along = end - start
        s = np.clip(((target[rows, 0] - start) * along).sum(axis=1) / (along**2).sum(axis=1), 0.0, 1.0)
        share[rows, late], share[rows, 1 - late] = s, 1.0 - s
        off = target[rows, 0] - start - s[:, None] * along
        target[rows, 1 - late], target[rows, late] = start + off, end + off
    point = [_in_world(soles[:, k], _on_sole(soles[:, k], target[:, k])) for k in range(len(FEET))]
    return share, np.stack(point, axis=1)


def _usual(alone: Mask, local: Array, foot: int) -> Array:
    """`(2,)` place on a sole where the walk stands on that foot alone, else on the other; else its middle."""
    for k in (foot, 1 - foot):
        if alone[:, k].any():
            return np.asarray(local[alone[:, k], k].mean(axis=0))
    return np.full(2, 0.5)


def _axes(sole: Array) -> tuple[Array, Array, Array, Array]:
    """Heels' midpoint, direction and length to the balls' midpoint, direction from medial to lateral."""
    heel, ball = sole[:, 0].mean(axis=1), sole[:, 1].mean(axis=1)
    length = np.linalg.norm(ball - heel, axis=1, keepdims=True)
    ahead = (ball - heel) / length
    across = np.stack([-ahead[:, 1], ahead[:, 0]], axis=1)
    outward = np.sign(((sole[:, 1, 1] - sole[:, 1, 0]) * across).sum(axis=1, keepdims=True))
    return heel, ahead, length, across * outward


def _edges(sole: Array, along: Array) -> tuple[Array, Array]:
    """Medial and lateral edge of a sole, across its middle line, at parts of its length [m]."""
    heel, _, _, across = _axes(sole)
    edges = ((sole - heel[:, None, None]) * across[:, None, None]).sum(axis=-1)  # (n, heel or ball, edge)
    medial, lateral = (edges[:, 0, k] + along * (edges[:, 1, k] - edges[:, 0, k]) for k in (0, 1))
    return medial, lateral


def _on_sole(sole: Array, point: Array) -> Array:
    """The nearest place on a sole, as parts `(n, 2)`: from heel to ball, from medial to lateral.

    Args:
        sole: `(n, 2, 2, 2)` corners: heel and ball, medial and lateral [m].
        point: `(n, 2)` on the ground [m].
    """
    heel, ahead, length, across = _axes(sole)
    along = np.clip(((point - heel) * ahead).sum(axis=1) / length[:, 0], 0.0, 1.0)
    medial, lateral = _edges(sole, along)
    wide = np.clip((((point - heel) * across).sum(axis=1) - medial) / (lateral - medial), 0.0, 1.0)
    return np.stack([along, wide], axis=1)


def _in_world(sole: Array, place: Array) -> Array:
    """`(n, 2)` points [m] of places `(2,)` or `(n, 2)` on a sole."""
    heel, ahead, length, across = _axes(sole)
    along = np.broadcast_to(place[..., 0], len(sole))
    medial, lateral = _edges(sole, along)
    off = medial + place[..., 1] * (lateral - medial)
    out: Array = heel + (along * length[:, 0])[:, None] * ahead + off[:, None] * across
    return out
