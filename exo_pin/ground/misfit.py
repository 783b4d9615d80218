"""What remains between the shown feet and their ground: sinking, hovering, and slides over the belt."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.names import Side
from exo_pin.arrays import Array, Mask
from exo_pin.gait import Gait
from exo_pin.ground.stance import Intervals, lowest_corners, standing
from exo_pin.kinematics.sole_points import heels_and_balls
from exo_pin.kinematics.stance_slide import sole_slide


class Misfit(NamedTuple):
    """What remains [m]; `exo_pin.ground.Support` names each number."""

    sink: float
    hover: float
    gap: float
    slide: float
    slide_along: float

    def words(self, ground: str) -> str:
        """All of them in a sentence; `ground` is what the foot slides over."""
        return (
            f"What remains: sole corners sink by up to {in_mm(self.sink)}, the standing foot is up to "
            f"{in_mm(self.hover)} above the ground, the higher one in double support up to {in_mm(self.gap)} "
            f"(the sole has no toes: near toe-off a person's still touch); in single support a heel or ball "
            f"that bears slides over {ground} by up to {in_mm(self.slide)} sideways and "
            f"{in_mm(self.slide_along)} along."
        )


def misfit(gait: Gait, feet: Array, stance: Intervals, belt_speed: float) -> Misfit:
    """Measure the shown feet against their ground.

    Args:
        gait: The walk.
        feet: `(n, 8, 3)` positions of `CORNERS` as shown, of a walk along x [m].
        stance: Side -> intervals on the ground.
        belt_speed: Of the treadmill, backwards [m/s]; 0 over ground.
    """
    time = gait.time - gait.time[0]
    stands = np.stack([standing(stance, side, time) for side in SIDES], axis=1)
    along, sideways = _slide(gait, feet, stands & ~stands[:, ::-1], belt_speed)
    left, right = stands.T
    low = lowest_corners(feet)
    single: dict[Side, Mask] = {"left": left & ~right, "right": right & ~left}
    hover = max(low[side][single[side]].max(initial=0.0) for side in SIDES)
    higher = np.maximum(low["left"], low["right"])
    return Misfit(
        max(-float(feet[..., 2].min()), 0.0),
        float(hover),
        float(higher[left & right].max(initial=0.0)),
        sideways,
        along,
    )


def ahead(feet: Array, base: Array) -> Array:
    """Corners `(n, 8, 3)` of a walk through the room, turned so that the way of its pelvis is along x."""
    way = base[-1, :2, 3] - base[0, :2, 3]
    x, y = way / np.linalg.norm(way)
    turned: Array = feet @ np.array([[x, -y, 0.0], [y, x, 0.0], [0.0, 0.0, 1.0]])
    return turned


def in_mm(metres: float) -> str:
    """A length in words."""
    return f"{round(1000 * metres, 1) + 0.0:.1f} mm"  # no minus before a zero


def _slide(gait: Gait, feet: Array, alone: Mask, belt_speed: float) -> tuple[float, float]:
    """Slides over the belt of the feet that stand alone `(n, 2)`, along and sideways [m]."""
    time, points = gait.time, heels_and_balls(feet)
    if gait.periodic:  # a single support may go on in the next cycle
        time = np.concatenate([time, time + gait.duration])
        points, alone = np.concatenate([points, points]), np.concatenate([alone, alone])
    return sole_slide(time, points, alone, np.array([-belt_speed, 0.0]))
