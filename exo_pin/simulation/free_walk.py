"""Numbers of a run with nothing at the pelvis: whether it stands, its path, its slip, the ZMP of its plan."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exo_pin.anatomy import CORNERS, FEET, SIDES
from exo_pin.arrays import Array
from exo_pin.dynamics import Dynamics, generalized_forces, in_world_axes
from exo_pin.dynamics.free_reaction import zero_moment_point
from exo_pin.gait import Gait
from exo_pin.gait.time_series import runs
from exo_pin.ground.stance import standing_at_samples
from exo_pin.kinematics import poses
from exo_pin.simulation.engine_forces import corner_forces
from exo_pin.simulation.simulated_walk import SimulatedWalk
from exo_pin.walking import convex_hull, margin

_LOADED = 20.0
"""A foot stands from this vertical force on [N]."""


@dataclass(frozen=True)
class FreeNumbers:
    """A run with a free pelvis, over its whole time.

    Attributes:
        pelvis_off_path_max_mm: Largest horizontal distance of the pelvis from where the walk has it then.
        slip_max_mm: Largest way of a loaded sole over the floor: its corners' mean, by their force.
        zmp_margin_min_mm: How far the walk's ZMP is inside the standing soles; negative outside; no ground
            force at all counts as infinitely far.
        zmp_outside_percent: Time for which it is outside.
    """

    pelvis_off_path_max_mm: float
    slip_max_mm: float
    zmp_margin_min_mm: float
    zmp_outside_percent: float


def free_numbers(run: SimulatedWalk) -> FreeNumbers:
    """The numbers of a run; the ZMP is that of the walk to follow."""
    off = run.base[:, :2, 3] - run.reference.base[: len(run.base), :2, 3]
    inside = zmp_margins(run.gait, run.required)
    return FreeNumbers(
        pelvis_off_path_max_mm=1e3 * float(np.linalg.norm(off, axis=1).max()),
        slip_max_mm=1e3 * _slip(run.record.sensed),
        zmp_margin_min_mm=1e3 * float(inside.min()),
        zmp_outside_percent=100.0 * float((inside < 0.0).mean()),
    )


def zmp_margins(gait: Gait, required: Dynamics) -> Array:
    """`(n,)` how far the ZMP of a walk is inside its standing soles [m]; -inf where no foot stands.

    Args:
        gait: The walk as given.
        required: Its inverse dynamics.
    """
    needed = in_world_axes(required.motion.base, generalized_forces(required.robot, required.motion))
    needed[:, 2] -= required.support_force
    zmp = zero_moment_point(required.motion.base, needed)
    corners = poses(required.robot, required.motion.q, CORNERS)[..., :3, 3]
    stands = standing_at_samples(gait, corners)
    soles = corners[..., :2].reshape(len(gait), len(FEET), -1, 2)
    return np.array(
        [
            margin(convex_hull(sole[feet].reshape(-1, 2)), at[None])[0]
            if feet.any() and np.isfinite(at).all()
            else -np.inf
            for sole, feet, at in zip(soles, stands, zmp, strict=True)
        ]
    )


def _slip(sensed: Array) -> float:
    """Largest way of a loaded sole [m]."""
    forces, places = corner_forces(sensed)
    force, place = forces[..., 2], places[..., :2]
    both = np.minimum(force[1:], force[:-1])  # a corner that has just landed has not moved yet
    moved = (both[..., None] * np.diff(place, axis=0)).sum(axis=2) / np.maximum(both.sum(axis=2), 1.0)[
        ..., None
    ]
    way = 0.0
    for foot in range(len(SIDES)):
        for a, b in runs(both[:, foot].sum(axis=1) > _LOADED):
            path = np.cumsum(moved[a:b, foot], axis=0)
            way = max(way, float(np.linalg.norm(path, axis=1).max()))
    return way
