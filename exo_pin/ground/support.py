"""How the balance support carries the pelvis, so that the walk stands on its ground.

Joint angles say nothing of the pelvis's path. `carried` derives it from the feet: the lowest sole corners are
kept on the ground, and the corner that bears the weight goes straight back with the belt, so that the pelvis
sways towards the standing leg as people's does; `still` holds the pelvis as in the paper and only lifts or
lowers the walk as a whole. Neither touches the pelvis's rotation.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.names import SupportStyle
from exo_pin.arguments import real, word
from exo_pin.arrays import Array
from exo_pin.gait import Gait
from exo_pin.gait.time_series import low_harmonics
from exo_pin.ground.misfit import ahead, in_mm, misfit
from exo_pin.ground.stance import Intervals, lowest_corners, standing
from exo_pin.short_repr import short_repr

_SOFTNESS = 0.003
"""Height difference [m] over which the weight goes from one corner to the next: bounds the sinking."""

_BEARING = 0.006
"""The same for the corners that go with the belt: a rolling foot passes its weight on from heel to ball."""

_HARMONICS = 8
"""The pelvis's path keeps so many harmonics of the cycle: a support does not jerk (a choice)."""

_BANDWIDTH = 7.0
"""The same for recordings, and the least for long cycles [Hz]."""

DEEPEST_SINK = 0.003
"""No sole corner may sink further into the ground than this [m]."""

_OVERGROUND = 0.6
"""A pelvis that travels further than this [m] walks over ground; else it walks on a treadmill."""


@dataclass(frozen=True, eq=False)
class Support:
    """The pelvis as shown, and what does not fit.

    Attributes:
        base: `(n, 4, 4)` pose of the pelvis.
        belt_speed: Of the treadmill, backwards [m/s]; 0 over ground.
        overground: Whether the walk goes through the room.
        sink: How deep a sole corner gets below the ground [m].
        hover: How far the standing foot is above the ground in single support [m].
        gap: How far the higher foot is above the ground in double support [m].
        slide: Largest path of a bearing heel or ball over belt or ground during one single support, sideways,
            of the feet as shown [m].
        slide_along: The same fore and aft [m].
        note: All that in words.
    """

    base: Array
    belt_speed: float
    overground: bool
    sink: float
    hover: float
    gap: float
    slide: float
    slide_along: float
    note: str

    __repr__ = short_repr


def support(
    style: SupportStyle, gait: Gait, base: Array, corners: Array, stance: Intervals, subject: str
) -> Support:
    """Carry the pelvis.

    Args:
        style: `"carried"` or `"still"`.
        gait: The walk.
        base: `(n, 4, 4)` pose of the pelvis as given.
        corners: `(n, 8, 3)` positions of `CORNERS` with that base [m].
        stance: Side -> intervals on the ground.
        subject: What is carried, and by what: the note's first words.

    Raises:
        UnknownNameError: There is no such style.
        DescriptionError: A shape does not fit the walk's n samples, or a number is not finite.
    """
    word("support", style, STYLES)
    base, corners = real("base", base, (len(gait), 4, 4)), real("corners", corners, (len(gait), 8, 3))
    overground = _goes_through_the_room(base)
    shift, motion = STYLES[style](gait, corners, stance, overground)
    shown, feet = base.copy(), corners + shift[:, None]
    shown[:, :3, 3] += shift
    speed = belt_speed(gait, base, feet)
    rest = misfit(gait, ahead(feet, base) if overground else feet, stance, speed)
    note = f"{subject} {motion} {rest.words('the ground' if overground else 'the belt')}"
    return Support(shown, speed, overground, *rest, note)


def belt_speed(gait: Gait, base: Array, corners: Array) -> float:
    """Speed of the treadmill under a walk, backwards [m/s]: that of the corners which bear it; 0 over ground.

    Args:
        gait: The walk.
        base: `(n, 4, 4)` pose of the pelvis.
        corners: `(n, 8, 3)` positions of `CORNERS` with that base, or shifted by a path that comes back [m].

    Raises:
        DescriptionError: A shape does not fit the walk's n samples, or a number is not finite.
    """
    base, corners = real("base", base, (len(gait), 4, 4)), real("corners", corners, (len(gait), 8, 3))
    if _goes_through_the_room(base):
        return 0.0
    return max(-float(_bearing_velocity(gait, corners)[:, 0].mean()), 0.0)


def _goes_through_the_room(base: Array) -> bool:
    return bool(np.linalg.norm(base[-1, :2, 3] - base[0, :2, 3]) > _OVERGROUND)


def _carried(gait: Gait, corners: Array, stance: Intervals, overground: bool) -> tuple[Array, str]:
    z = _smooth(gait, -np.sum(_weights(corners, _SOFTNESS) * corners[..., 2], axis=1))
    z += max(-float((corners[..., 2] + z[:, None]).min()) - DEEPEST_SINK, 0.0)
    rise = f"raised and lowered by {in_mm(np.ptp(corners[..., 2].min(axis=1)))}"
    if overground:
        still = np.zeros(len(z))
        motion = f"is {rise} so that the soles stay on the ground."
        return np.stack([still, still, z], axis=1), motion
    drift = _bearing_velocity(gait, corners)[:, :2]
    path = [_smooth(gait, _integral(gait, rate.mean() - rate)) for rate in drift.T]
    x, y = (line - line.mean() for line in path)
    motion = (
        f"is {rise}, moved fore and aft by {in_mm(np.ptp(x))} and sideways by "
        f"{in_mm(np.ptp(y))}, so that the standing foot stays on the belt, which runs at "
        f"{round(-drift[:, 0].mean(), 2) + 0.0:.2f} m/s."
    )
    return np.stack([x, y, z], axis=1), motion


def _still(gait: Gait, corners: Array, stance: Intervals, overground: bool) -> tuple[Array, str]:
    heights, time = lowest_corners(corners), gait.time - gait.time[0]
    low = [heights[side][standing(stance, side, time)].min(initial=np.inf) for side in SIDES]
    shift = -min(low) if np.isfinite(min(low)) else -float(corners[..., 2].min())
    motion = (
        f"moves as given, shifted by {1000 * shift:+.1f} mm up as a whole so "
        "that the lowest standing sole corner is on the ground."
    )
    return np.tile([0.0, 0.0, shift], (len(gait), 1)), motion


STYLES: dict[SupportStyle, Callable[[Gait, Array, Intervals, bool], tuple[Array, str]]] = {
    "carried": _carried,
    "still": _still,
}
"""Name -> how the pelvis is moved: its shift `(n, 3)` [m], and the predicate of the note."""


def _weights(corners: Array, softness: float) -> Array:
    """`(n, 8)` shares of the corners in bearing the weight: the lowest ones, passing smoothly."""
    height = corners[..., 2] - corners[..., 2].min(axis=1, keepdims=True)
    share = np.exp(-height / softness)
    weights: Array = share / share.sum(axis=1, keepdims=True)
    return weights


def _bearing_velocity(gait: Gait, corners: Array) -> Array:
    """`(n, 3)` velocity of the corners that bear the weight [m/s]."""
    flat = corners.reshape(len(gait), -1)
    if gait.periodic:
        velocity = (np.roll(flat, -1, axis=0) - np.roll(flat, 1, axis=0)) * len(gait) / (2 * gait.duration)
    else:
        velocity = np.asarray(np.gradient(flat, gait.time, axis=0))
    bearing: Array = np.einsum("nc,nck->nk", _weights(corners, _BEARING), velocity.reshape(corners.shape))
    return bearing


def _integral(gait: Gait, rate: Array) -> Array:
    """`(n,)` integral over time from 0; a periodic rate without mean comes back to 0."""
    steps = np.diff(gait.time) * (rate[1:] + rate[:-1]) / 2
    return np.concatenate([[0.0], np.cumsum(steps)])


def _smooth(gait: Gait, values: Array) -> Array:
    """The low harmonics of a cycle, or of a recording continued by its point reflections at both ends."""
    if gait.periodic:
        cycles = sum((event.side, event.kind) == ("left", "heel_strike") for event in gait.events)
        return low_harmonics(values, max(_HARMONICS * cycles, _HARMONICS, round(_BANDWIDTH * gait.duration)))
    line = np.linspace(values[0], values[-1], len(values))
    odd = np.concatenate([values - line, -(values - line)[-2:0:-1]])
    return line + low_harmonics(odd, max(round(2 * _BANDWIDTH * gait.duration), 1))[: len(values)]
