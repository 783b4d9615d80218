"""Noise of marker paths: how much they shake, and a low-pass filter for those of noisy cameras."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from exo_pin import signals
from exo_pin.arrays import Array

_NOISY = 0.0012
"""Markers that shake more than this along an axis [m] are filtered; infrared cameras have 0.1 to 0.5 mm."""

_SLOWEST = 30.0
"""Below this rate [Hz] motion itself looks like noise."""

_FOURTH_DIFFERENCE = np.sqrt(70.0)
"""Standard deviation of the fourth difference of white noise of 1."""

_MEDIAN_OF_NORMAL = 0.6745
"""Median of the magnitude of a normal variable of 1."""


class Calmed(NamedTuple):
    """Paths after the filter.

    Attributes:
        paths: Marker -> `(n, 3)` [m].
        remark: What was done, or "".
    """

    paths: dict[str, Array]
    remark: str


def calmed(time: Array, paths: Mapping[str, Array]) -> Calmed:
    """The paths, low-passed where they shake.

    Args:
        time: `(n,)` [s].
        paths: Marker -> `(n, 3)` [m]; NaN where it was not seen.
    """
    rate = (len(time) - 1) / (time[-1] - time[0]) if len(time) > 1 else 0.0
    shake = noise(paths) if rate >= _SLOWEST else 0.0
    if not shake > _NOISY:
        return Calmed(dict(paths), "")
    filtered = {name: _lowpassed(time, path) for name, path in paths.items()}
    how = f"low-passed at {signals.CUTOFF:g} Hz"
    remark = f"the markers shake by {1e3 * shake:.1f} mm along each axis and are {how}"
    return Calmed(filtered, remark)


def noise(paths: Mapping[str, Array]) -> float:
    """Standard deviation of the markers' noise along an axis [m], by fourth differences (median)."""
    differences = [np.diff(path, 4, axis=0).ravel() for path in paths.values() if len(path) > 4]
    every = np.abs(np.concatenate(differences)) if differences else np.zeros(0)
    every = every[~np.isnan(every)]
    return float(np.median(every) / _MEDIAN_OF_NORMAL / _FOURTH_DIFFERENCE) if len(every) else 0.0


def _lowpassed(time: Array, path: Array) -> Array:
    """Each run of frames in which a marker was seen, filtered for itself."""
    out, seen = path.copy(), ~np.isnan(path).any(axis=1)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], seen, [False]]).astype(int)))
    for start, stop in edges.reshape(-1, 2):
        if stop - start > _SHORTEST_RUN:
            out[start:stop] = signals.lowpass(time[start:stop], path[start:stop])
    return out


_SHORTEST_RUN = 15
"""Samples of a run that can be filtered."""
