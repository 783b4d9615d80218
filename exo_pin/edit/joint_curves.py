"""Adjustments of joint curves and time; the source of every new gait records the adjustment."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping

import numpy as np

from exo_pin import signals
from exo_pin.anatomy import JOINTS, MOVEMENTS
from exo_pin.arguments import number, table
from exo_pin.arrays import Array
from exo_pin.errors import GaitError, UnknownNameError
from exo_pin.gait import Event, Gait
from exo_pin.gait.rigid_poses import nearest_pose

_LONGEST_RAMP = 3600.0
"""[s]: a longer one is a slip, and would fill the memory."""

_RAMP_STEP = 0.01
"""Largest time between samples of a ramp [s]; the walk's own where that is smaller."""


def retimed(gait: Gait, *, duration: float | None = None, factor: float | None = None) -> Gait:
    """The same motion over another duration, given directly or by a factor.

    Args:
        gait: The walk.
        duration: The new duration [s].
        factor: New over old duration; above 1: slower.

    Raises:
        GaitError: Neither or both are given, or the value is not positive.
    """
    if (duration is None) == (factor is None):
        raise GaitError("retimed needs either a duration [s] or a factor")
    if factor is None:
        length = 0.0 if duration is None else duration
        ratio = number("duration", length, above=0.0, error=GaitError) / gait.duration
    else:
        ratio = number("factor", factor, above=0.0, error=GaitError)
    return _recorded(gait.slowed(ratio), f"retimed x{ratio:.4g}")


def scaled(gait: Gait, factors: Mapping[str, float]) -> Gait:
    """Joint amplitudes scaled by factors, about each joint's own mean over the walk.

    Args:
        gait: The walk.
        factors: Joint, or movement for both sides (`knee_flexion`) -> factor; 1 changes nothing.

    Raises:
        UnknownNameError: There is no such joint.
        GaitError: A factor is negative or not finite.
    """
    q = gait.q.copy()
    for name, factor in table("factors", factors, error=GaitError).items():
        number(f"factor on {name}", factor, least=0.0, error=GaitError)
        columns = [k for k, joint in enumerate(JOINTS) if name in (joint, joint.partition("_")[2])]
        if not columns:
            raise UnknownNameError("joint", name, (*JOINTS, *MOVEMENTS))
        mean = q[:, columns].mean(axis=0)
        q[:, columns] = mean + factor * (q[:, columns] - mean)
    words = ", ".join(f"{name} x{factor:g}" for name, factor in factors.items())
    return _recorded(dataclasses.replace(gait, q=q), f"amplitude {words}")


def mirrored(gait: Gait) -> Gait:
    """Left and right interchanged."""
    return _recorded(gait.mirrored(), "mirrored")


def symmetrised(gait: Gait) -> Gait:
    """Both sides alike, half a cycle apart: the mean of the walk and its mirror image half a cycle later.

    Raises:
        GaitError: The gait is not periodic (cut it into cycles and take their mean first).
    """
    if not gait.periodic:
        raise GaitError("only a periodic gait can be symmetrised: its cycles' mean is one (edit --cycle)")
    even = gait if len(gait) % 2 == 0 else gait.resampled(len(gait) + 1)
    half = len(even) // 2
    other = even.mirrored()
    base = None
    if even.base is not None:
        shifted = np.roll(_or_raise(other.base), half, axis=0)
        base = nearest_pose((even.base + shifted) / 2)
    q = (even.q + np.roll(other.q, half, axis=0)) / 2
    return _recorded(dataclasses.replace(even, q=q, base=base, events=_even_events(even)), "symmetrised")


def lasting(gait: Gait, seconds: float) -> Gait:
    """A gait that repeats, as a recording of that length at its own cadence.

    Args:
        gait: It repeats.
        seconds: How long it is walked [s].

    Raises:
        GaitError: It is a recording, or the length is not positive or more than an hour.
    """
    seconds = number("length [s]", seconds, above=0.0, most=_LONGEST_RAMP, error=GaitError)
    if not gait.periodic:
        raise GaitError("only a gait that repeats can be walked for any time; a recording has its own length")
    walk = _unrolled(gait, seconds)
    time = np.linspace(0.0, seconds, max(2, round(seconds / gait.time[1]) + 1))
    return _recorded(_along(walk, time, time), f"walked for {seconds:g} s")


def ramped(gait: Gait, *, start: float = 2.0, stop: float = 2.0, duration: float | None = None) -> Gait:
    """The walk with a slow start from rest and a slow stop; accelerations stay finite.

    The path of the angles stays the same; only the rate at which it is followed changes. A periodic gait is
    repeated for as many cycles as the ramps need, and one more; or for `duration` at its own cadence.

    Args:
        gait: The walk.
        start: Duration of the start from rest [s].
        stop: Duration of the stop [s].
        duration: Of the whole, ramps included [s]; a recording is followed faster or slower for it. None:
            what the walk needs.

    Raises:
        GaitError: A ramp is negative or longer than an hour, the recording is shorter than half of both
            ramps, or the duration is shorter than both ramps or longer than an hour.
    """
    for name, seconds in (("start", start), ("stop", stop)):
        number(f"{name} of the ramps [s]", seconds, least=0.0, most=_LONGEST_RAMP, error=GaitError)
    need = (start + stop) / 2  # a ramp follows the walk at half the rate on average
    walk = gait if duration is None else _of_length(gait, duration, start + stop, need)
    if walk.periodic:
        walk = walk.repeated(2 + int(np.ceil(need / walk.duration)))
    span = float(walk.time[-1] - walk.time[0])
    if span < need:
        raise GaitError(
            f"the recording lasts {span:.3g} s; ramps of {start:g} s and {stop:g} s need {need:g} s"
        )
    total = span + need
    n = max(2, round(total / min(_RAMP_STEP, span / (len(walk) - 1))) + 1)
    time = np.linspace(0, total, n)
    phase = walk.time[0] + np.clip(_ramped_time(time, start, total - stop, total), 0, span)
    return _recorded(_along(walk, time, phase), f"ramped {start:g} s up, {stop:g} s down")


def _of_length(gait: Gait, duration: float, ramps: float, need: float) -> Gait:
    """The walk that lasts `duration` with its ramps: cut from one that repeats, else followed otherwise."""
    number("duration [s]", duration, least=ramps, most=_LONGEST_RAMP, error=GaitError)
    span = number("duration less half of both ramps [s]", duration - need, above=0.0, error=GaitError)
    return lasting(gait, span) if gait.periodic else retimed(gait, duration=span)


def _unrolled(gait: Gait, seconds: float) -> Gait:
    """A periodic gait as a recording of at least that length."""
    many = gait.repeated(2 + int(np.ceil(seconds / gait.duration)))
    return dataclasses.replace(many, periodic=False)


def filtered(gait: Gait, *, cutoff: float = signals.CUTOFF, order: int = signals.ORDER) -> Gait:
    """Angles and pelvis low-pass filtered without lag (Butterworth); the source records order and cut-off.

    Args:
        gait: The walk; a periodic one is filtered as an endless repetition.
        cutoff: Cut-off frequency [Hz].
        order: Order of forward and backward pass together.

    Raises:
        GaitError: Uneven or too few samples, or a cut-off beyond half the sampling rate.
    """
    walk = gait.repeated(3) if gait.periodic else gait
    n = len(gait)
    rows = slice(n, 2 * n) if gait.periodic else slice(None)
    q = signals.lowpass(walk.time, walk.q, cutoff=cutoff, order=order)[rows]
    base = None
    if walk.base is not None:
        base = nearest_pose(signals.lowpass(walk.time, walk.base, cutoff=cutoff, order=order)[rows])
    words = f"zero-lag Butterworth, order {order} (forward and backward together), cut-off {cutoff:g} Hz"
    return _recorded(dataclasses.replace(gait, q=q, base=base), words)


def _ramped_time(t: Array, up: float, down: float, end: float) -> Array:
    """Time of the walk (n,) at times t (n,) of the ramped one [s]; its rate rises to 1 and falls again."""
    rise = t / 2 if up == 0 else _integral(t / up) * up
    passed = np.where(t < up, rise, up / 2 + (t - up))
    if end > down:
        rest = (end - t) / (end - down)
        full = up / 2 + (end - up) - (end - down) / 2
        passed = np.where(t > down, full - _integral(np.clip(rest, 0, 1)) * (end - down), passed)
    return np.asarray(passed)


def _integral(s: Array) -> Array:
    """Integral of the smooth step 3 s^2 - 2 s^3 from 0 to s; at 1 it is a half."""
    return np.asarray(s**3 - s**4 / 2)


def _along(walk: Gait, time: Array, phase: Array) -> Gait:
    """The walk followed at the times `phase` of its own clock (n,), its events moved along."""
    from scipy.interpolate import CubicSpline  # 0.3 s, needed here only

    q = CubicSpline(walk.time, walk.q)(phase)
    base = None
    if walk.base is not None:
        base = nearest_pose(CubicSpline(walk.time, walk.base)(phase))
    inside = [event for event in walk.events if phase[0] <= event.time <= phase[-1]]
    strictly = 1e-12 * np.arange(len(phase))  # so that it can be inverted
    grown = np.maximum.accumulate(phase + strictly)
    events = tuple(dataclasses.replace(e, time=float(np.interp(e.time, grown, time))) for e in inside)
    return Gait(time, q, base=base, events=events, source=walk.source, remarks=walk.remarks)


def _even_events(gait: Gait) -> tuple[Event, ...]:
    """Events of a symmetric walk: the left foot's, and the right foot's half a period later."""
    T = gait.duration
    left = [event for event in gait.events if event.side == "left"]
    right = [dataclasses.replace(e, side="right", time=(e.time + T / 2) % T) for e in left]
    return (*left, *right)


def _or_raise(base: Array | None) -> Array:
    if base is None:
        raise GaitError("the gait has no base")
    return base


def _recorded(gait: Gait, what: str) -> Gait:
    """The gait with the adjustment recorded in its source."""
    return dataclasses.replace(gait, source=f"{gait.source}; {what}" if gait.source else what)
