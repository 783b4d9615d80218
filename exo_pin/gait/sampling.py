"""Sampling of a recording: whether its clock can be in seconds, and where samples are missing."""

from __future__ import annotations

import numpy as np

from exo_pin.arrays import Array

_SLOWEST = 0.5
"""Usual time between samples from which nothing of a step can be seen [s]: the clock is in another unit."""

_ENOUGH = 10
"""Samples that tell the usual time between them; fewer may be set points."""

_REGULAR = 0.8
"""Least share of the steps that are about the usual one where a clock is regular."""

_SHOWN = 3


def doubtful_unit(time: Array) -> str:
    """Why these times `(n,)` cannot be seconds; empty where they can."""
    if len(time) < _ENOUGH:
        return ""
    step = float(np.median(np.diff(time)))
    if step <= _SLOWEST:
        return ""
    whole = float(time[-1] - time[0])
    return f"samples lie {step:.3g} apart and {whole:.4g} in all, which no walk does in seconds"


def missing_samples(time: Array) -> str:
    """Where a regular recording at times `(n,)` [s] leaves samples out; empty where it does not."""
    steps = np.diff(time)
    if len(time) < _ENOUGH:
        return ""
    usual = float(np.median(steps))
    jumps = np.flatnonzero(steps > 1.5 * usual)
    if not jumps.size or np.mean(np.abs(steps - usual) < 0.1 * usual) < _REGULAR:
        return ""
    shown = ", ".join(
        f"{max(round(steps[k] / usual) - 1, 1)} after {time[k]:.3f} s" for k in jumps[:_SHOWN].tolist()
    )
    more = f" and at {len(jumps) - _SHOWN} more places" if len(jumps) > _SHOWN else ""
    return f"samples are missing: {shown}{more}; curves run straight across"
