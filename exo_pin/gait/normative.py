"""The normative walk at five speeds: periodic Fourier series of joint angles and pelvis rotation."""

from __future__ import annotations

import math

import numpy as np

from exo_pin.anatomy import MOVEMENTS, Body
from exo_pin.anatomy.names import CLINICAL_ANGLES, ClinicalAngle, EventKind, Side, Speed
from exo_pin.arguments import MOST_SAMPLES, count, number, word
from exo_pin.arrays import Array
from exo_pin.errors import GaitError, UnknownNameError, same_name
from exo_pin.gait.event import Event
from exo_pin.gait.gait import Gait
from exo_pin.gait.schwartz2008 import MEAN_ANGLES, MEAN_ANKLE_INVERSION, MEAN_HARMONICS, TIMING
from exo_pin.gait.schwartz2008_sd import SD_ANGLES, SD_ANKLE_INVERSION
from exo_pin.physics import GRAVITY

SPEEDS: tuple[Speed, ...] = ("very_slow", "slow", "free", "fast", "very_fast")
"""Speeds as the children of the source were asked to walk."""

_SOURCE = "Schwartz 2008"
_LEG_LENGTHS = (0.1, 2.5)
"""Shortest and longest leg [m] that a stride time is given for: what a `Body` can be."""


def speed_named(name: str) -> Speed:
    """The speed of that name, in any capitals.

    Raises:
        UnknownNameError: There is no such speed.
    """
    for speed in SPEEDS:
        if speed == same_name(name, SPEEDS):
            return speed
    raise UnknownNameError("speed", name, SPEEDS)


def normative_gait(speed: Speed = "free", *, leg_length: float | None = None, samples: int = 100) -> Gait:
    """The mean walk of typically developing children, with the left heel strike at time 0.

    Angles, contact events and cadence are those of Schwartz, Rozumalski and Trost, J Biomech 41 (2008)
    1639-1650; the right leg walks half a cycle after the left. The pelvis's tilt, obliquity and rotation are
    the orientation of `base`, because the hip angles were measured against that tilted pelvis: on an upright
    pelvis the feet would not meet the ground. In a walk whose halves mirror each other the tilt has only even
    harmonics, obliquity and rotation only odd ones and no mean; they were fitted so. The pelvis's centre
    stays at (0, 0, leg_length): its path is not in the source. Events are the source's own: the right foot's
    are those of the opposite foot, rounded to a percent of the cycle and not exactly half a cycle late.

    Weak channels: ankle inversion (Oxford foot model, one curve for all speeds, subjects not documented),
    hip rotation and the level of the pelvis's tilt, on which sources disagree.

    Args:
        speed: One of `SPEEDS`.
        leg_length: Hip centre to sole [m], sets stride time and pelvis height; default: the default body's.
        samples: Number of samples in the cycle, at least 17, so that all eight harmonics are kept, and at
            most a million.

    Returns:
        A periodic gait with base and events. The stride time is 2 / (c sqrt(g / leg_length)), with c the
        dimensionless cadence (steps per time) of the source.

    Raises:
        UnknownNameError: If there is no such speed.
        GaitError: If the leg length is implausible or there are too few or too many samples.
    """
    speed = speed_named(speed)
    length = Body.from_stature().leg_length
    if leg_length is not None:
        length = number("leg_length", leg_length, error=GaitError)
    if not _LEG_LENGTHS[0] <= length <= _LEG_LENGTHS[1]:
        raise GaitError(f"leg_length = {length} m: expected {_LEG_LENGTHS[0]} to {_LEG_LENGTHS[1]} m")
    samples = count("samples", samples, 2 * MEAN_HARMONICS + 1, MOST_SAMPLES, error=GaitError)
    stride = 2 / (TIMING[speed]["cadence"] * math.sqrt(GRAVITY / length))
    phase = np.arange(samples) / samples
    return Gait(
        stride * phase,
        np.hstack([_leg(speed, phase), _leg(speed, phase - 0.5)]),
        base=_pelvis(speed, phase, length),
        events=_events(speed, stride),
        periodic=True,
        source=f"{_SOURCE}, {speed}; ankle inversion: Oxford foot model",
    )


def normative_sd(speed: Speed = "free", *, samples: int = 100) -> Array:
    """Standard deviation of the joint angles between the children of `normative_gait`.

    Source and weak channels as there. Four Fourier harmonics follow the published spreads of five speeds
    within 1.1 degrees; the right leg's are the left leg's half a cycle later.

    Args:
        speed: One of `SPEEDS`.
        samples: Number of samples in the cycle.

    Returns:
        `(samples, 12)` in the order of `JOINTS`, at the same phases as `normative_gait(..., samples=samples)`
        [rad].

    Raises:
        UnknownNameError: If there is no such speed.
        GaitError: If there is no sample, or more than a million.
    """
    speed = speed_named(speed)
    samples = count("samples", samples, 1, MOST_SAMPLES, error=GaitError)
    curves = {**SD_ANGLES[speed], "ankle_inversion": SD_ANKLE_INVERSION}
    phase = np.arange(samples) / samples
    legs = [_series(curves[movement], phase - late) for late in (0.0, 0.5) for movement in MOVEMENTS]
    return np.stack(legs, axis=1)


def speed_of(gait: Gait) -> Speed | None:
    """The speed whose normal walk has the joint angles of a walk, at any cadence; None: it is another."""
    if not gait.periodic or len(gait) <= 2 * MEAN_HARMONICS:
        return None
    phase = np.arange(len(gait)) / len(gait)
    for speed in SPEEDS:
        if np.allclose(gait.q, np.hstack([_leg(speed, phase), _leg(speed, phase - 0.5)]), rtol=0, atol=1e-9):
            return speed
    return None


def nearest_speed(stride_time: float, leg_length: float) -> Speed:
    """The speed of the source whose cadence, for the length of the leg, is nearest to that of a walk.

    Args:
        stride_time: From one heel strike of a foot to its next [s].
        leg_length: Hip centre to sole [m].
    """
    cadence = 2 / (stride_time * math.sqrt(GRAVITY / leg_length))
    return min(SPEEDS, key=lambda speed: abs(TIMING[speed]["cadence"] - cadence))


def published_curve(speed: Speed, angle: ClinicalAngle) -> tuple[Array, Array]:
    """Mean and standard deviation `(101,)` [rad] of an angle over a side's cycle, heel strike at both ends.

    Of the children of `normative_gait`; ankle inversion as there.

    Raises:
        UnknownNameError: There is no such speed or angle.
    """
    speed, angle = speed_named(speed), word("angle", angle, CLINICAL_ANGLES)
    phase = np.linspace(0.0, 1.0, 101)
    means = {**MEAN_ANGLES[speed], "ankle_inversion": MEAN_ANKLE_INVERSION}
    spreads = {**SD_ANGLES[speed], "ankle_inversion": SD_ANKLE_INVERSION}
    return _series(means[angle], phase), _series(spreads[angle], phase)


def series(coefficients: tuple[float, ...], phase: Array) -> Array:
    """`(n,)` values of a Fourier series: mean, cosines, sines, at phases of the cycle (1 is a full cycle)."""
    harmonics = len(coefficients) // 2
    mean, cosines, sines = np.split(np.array(coefficients), [1, 1 + harmonics])
    angle = 2 * np.pi * np.outer(phase, np.arange(1, harmonics + 1))
    return np.asarray(mean + np.cos(angle) @ cosines + np.sin(angle) @ sines)


def _series(coefficients: tuple[float, ...], phase: Array) -> Array:
    """`(n,)` angle [rad] of a series in degrees."""
    return np.radians(series(coefficients, phase))


def _leg(speed: Speed, phase: Array) -> Array:
    """`(n, 6)` joint angles of a leg that strikes the ground at phase 0."""
    curves = {**MEAN_ANGLES[speed], "ankle_inversion": MEAN_ANKLE_INVERSION}
    return np.stack([_series(curves[movement], phase) for movement in MOVEMENTS], axis=1)


def _pelvis(speed: Speed, phase: Array, height: float) -> Array:
    """`(n, 4, 4)` poses: tilt forward about y, then left side up about x, then left side forward about -z."""
    tilt, obliquity, rotation = (
        _series(MEAN_ANGLES[speed][f"pelvis_{name}"], phase) for name in ("tilt", "obliquity", "rotation")
    )
    base = np.tile(np.eye(4), (len(phase), 1, 1))
    base[:, :3, :3] = _turns(1, tilt) @ _turns(0, obliquity) @ _turns(2, -rotation)
    base[:, 2, 3] = height
    return base


def _turns(axis: int, angle: Array) -> Array:
    """`(n, 3, 3)` rotations about a coordinate axis."""
    i, j = (axis + 1) % 3, (axis + 2) % 3
    R = np.tile(np.eye(3), (len(angle), 1, 1))
    R[:, i, i] = R[:, j, j] = np.cos(angle)
    R[:, j, i] = np.sin(angle)
    R[:, i, j] = -R[:, j, i]
    return R


def _events(speed: Speed, stride: float) -> tuple[Event, ...]:
    at = TIMING[speed]
    moments: tuple[tuple[float, EventKind, Side], ...] = (
        (0.0, "heel_strike", "left"),
        (at["opposite_off"], "toe_off", "right"),
        (at["opposite_contact"], "heel_strike", "right"),
        (at["foot_off"], "toe_off", "left"),
    )
    return tuple(Event(stride * percent / 100, kind, side, _SOURCE) for percent, kind, side in moments)
