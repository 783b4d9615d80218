"""Movements of a person's leg that the joints of a robot's leg make, by their axes."""

from __future__ import annotations

from itertools import permutations

import numpy as np

from exo_pin.anatomy.names import Movement
from exo_pin.arrays import Array
from exo_pin.errors import DescriptionError

LATERAL = 1
"""Coordinate of the flexion axes: y, to the left."""

_HIP: tuple[Movement, ...] = ("hip_adduction", "hip_flexion", "hip_rotation")
"""Movement of a hip joint by the coordinate that its axis is nearest to."""

_ANKLE: tuple[Movement, ...] = ("ankle_inversion", "ankle_dorsiflexion")
"""The same below the knee; no ankle rotates about the vertical."""

_LATERAL_SHARE = 0.75
"""A joint flexes where its axis has more than this share along y: an axis half yaw, half pitch does not."""

_AT_THE_FOOT = 0.2
"""Toes, and all joints after them, are not lower than the ankle by more than this share of the leg."""


def movements(axes: Array, points: Array, joints: tuple[str, ...]) -> tuple[Movement, ...]:
    """The movement of each joint of a leg up to the ankle; those of toes, which come after it, are left out.

    Joints about the lateral axis are hip, knee and ankle flexion, in this order. Joints above the knee belong
    to the hip, joints below it to the ankle.

    Args:
        axes: Directions of the joints (k, 3) in the walker's axes.
        points: A point on each axis (k, 3) [m].
        joints: Their names, from the hip outwards.

    Raises:
        DescriptionError: There is no hip flexion and knee, or a movement has two joints.
    """
    main = np.argmax(np.abs(axes), axis=1)
    flexing = np.flatnonzero(np.abs(axes[:, LATERAL]) > _LATERAL_SHARE)
    if len(flexing) < 2:
        raise DescriptionError(
            f"the joints {', '.join(joints)} have no hip flexion and knee about the lateral axis"
        )
    knee = int(flexing[1])
    count = _up_to_the_ankle(main, points, knee)
    hip = _assigned(axes[:knee], joints[:knee], _HIP, "hip")
    ankle = _assigned(axes[knee + 1 : count], joints[knee + 1 : count], _ANKLE, "ankle")
    return (*hip, "knee_flexion", *ankle)


def _up_to_the_ankle(main: Array, points: Array, knee: int) -> int:
    """Number of joints without those of toes: what repeats a movement of the ankle at the foot."""
    for k in range(knee + 2, len(main)):
        repeats = main[k] in main[knee + 1 : k] or k > knee + 2
        drop = points[knee + 1, 2] - points[k:, 2].min()
        if repeats and drop < _AT_THE_FOOT * float(points[0, 2] - points[knee + 1, 2]):
            return k
    return len(main)


def _assigned(axes: Array, joints: tuple[str, ...], known: tuple[Movement, ...], part: str) -> list[Movement]:
    """One movement for each joint: of all ways the one whose axes are nearest to the joints' own."""
    fits = np.abs(axes[:, : len(known)])
    ways = permutations(range(len(known)), len(joints))
    best = max(ways, key=lambda way: float(sum(fits[k, c] for k, c in enumerate(way))), default=None)
    least = 0.0 if best is None or not joints else min(float(fits[k, c]) for k, c in enumerate(best))
    if best is None or (joints and least < 0.5):
        raise DescriptionError(_refusal(axes, joints, known, part))
    return [known[c] for c in best]


def _refusal(axes: Array, joints: tuple[str, ...], known: tuple[Movement, ...], part: str) -> str:
    """Which joints make the same movement, or one that a person's leg does not have."""
    main = [int(np.argmax(np.abs(axis))) for axis in axes]
    remedy = "; a leg has one joint for each movement: name those to be held in `locked` of a record"
    for c, movement in enumerate(known):
        same = [joint for joint, k in zip(joints, main, strict=True) if k == c]
        if len(same) > 1:
            return f"{' and '.join(same)} stand for {movement}{remedy} (docs/robots.md)"
    odd = [joint for joint, k in zip(joints, main, strict=True) if k >= len(known)]
    what = f"{' and '.join(odd or joints)}: no movement of a person's {part}, such as {', '.join(known)}"
    return f"{what}{remedy} (docs/robots.md)"
