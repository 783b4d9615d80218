"""The inverted pendulum of a walk in the picture: a line from the zero-moment point to the centre of mass."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from exo_pin.arrays import Array
from exo_pin.ground import PlacedWalk
from exo_pin.viewer.scenes.kinetics import Kinetics
from exo_pin.viewer.scenes.scene import ROOT, Arrow, Group, Key

_GOLD = "#b8860b"
"""That of the centre of mass."""


class PendulumMark(NamedTuple):
    """The pendulum as the page draws it: arrow, samples, switch, and entries of the legend."""

    arrow: Arrow
    arrays: dict[str, Array]
    group: Group
    keys: tuple[Key, ...]


def pendulum_mark(kinetics: Kinetics, walk: PlacedWalk, length: float) -> PendulumMark | None:
    """The mass on its leg; at first shown of planned walks alone, which are made from it.

    The green plates under standing feet show what the zero-moment point must stay in.

    Args:
        kinetics: Ground forces on the samples of the walk.
        walk: Where feet and centre of mass are shown.
        length: Of an arrow [m/N].

    Returns:
        None where no centre of mass is known.
    """
    if walk.com is None:
        return None
    zmp = zero_moment_point(kinetics.force[..., 2], kinetics.points(walk.feet))
    planned = kinetics.origin == "planned"
    key = Key(
        "inverted pendulum",
        _GOLD,
        "From the zero-moment point to the centre of mass, as planned.",
    )
    return PendulumMark(
        Arrow(f"{ROOT}/forces/pendulum", "pendulum", "pendulum_at", _GOLD),
        {"pendulum": (walk.com - zmp) / length, "pendulum_at": zmp},
        Group("Inverted pendulum: ZMP to centre of mass", (f"{ROOT}/forces/pendulum",), shown=planned),
        (key,) if planned else (),
    )


def zero_moment_point(vertical: Array, points: Array) -> Array:
    """`(n, 3)` mean of the centres of pressure, weighted by the vertical forces; NaN where nobody stands [m].

    Args:
        vertical: `(n, 2)` vertical force of each foot [N].
        points: `(n, 2, 3)` centre of pressure of each foot; NaN where it is not loaded [m].
    """
    known = np.isfinite(points).all(axis=-1)
    load = np.where(known, np.nan_to_num(vertical), 0.0)
    whole = load.sum(axis=1)
    whole = np.where(whole > 0.0, whole, np.nan)
    return np.asarray(np.einsum("nf,nfk->nk", load, np.nan_to_num(points)) / whole[:, None])
