"""The support polygon: the convex hull of the standing soles, and how far inside it the ZMP is."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from exo_pin.anatomy import SIDES
from exo_pin.arguments import real
from exo_pin.arrays import Array
from exo_pin.errors import DescriptionError
from exo_pin.walking.footsteps import Footsteps
from exo_pin.walking.schedule import PhaseSamples

_DECIMALS = 6
"""Points are taken to a micrometre: of those on one line but for rounding any could come first."""

_TURNS = 1e-12
"""Three points whose triangle is smaller lie on a line [m^2]."""


def convex_hull(points: npt.ArrayLike) -> Array:
    """Corners `(k, 2)` of the convex hull of points `(n, 2)`, counter-clockwise (Andrew's monotone chain).

    Points [m] are rounded to a micrometre.

    Raises:
        DescriptionError: The points lie on a line, their shape does not fit, or a number is not finite.
    """
    rounded = np.round(real("points", points, ("n", 2)), _DECIMALS)
    ordered = sorted(set(map(tuple, rounded.tolist())))
    lower, upper = _chain(ordered), _chain(ordered[::-1])
    if len(lower) + len(upper) < 5:
        raise DescriptionError("points lie on a line; three that do not are accepted")
    return np.array(lower[:-1] + upper[:-1])


def margin(polygon: npt.ArrayLike, point: npt.ArrayLike) -> Array:
    """How far points are inside a convex polygon: distance from the nearest edge's line; negative outside.

    Args:
        polygon: Corners `(k, 2)`, counter-clockwise [m].
        point: `(n, 2)` [m].

    Returns:
        `(n,)` [m].

    Raises:
        DescriptionError: A shape does not fit, or a number is not finite.
    """
    corners, p = real("polygon", polygon, ("k", 2)), real("point", point, ("n", 2))
    if len(corners) < 3:
        raise DescriptionError(f"polygon has {len(corners)} corners; at least 3 are accepted")
    edge = np.roll(corners, -1, axis=0) - corners
    inward = np.stack([-edge[:, 1], edge[:, 0]], axis=1) / np.linalg.norm(edge, axis=1)[:, None]
    away = np.einsum("nkj,kj->nk", p[:, None] - corners, inward)
    return np.asarray(away.min(axis=1))


def zmp_margins(walk: Footsteps, parts: list[PhaseSamples], corners: Array, zmp: Array) -> Array:
    """`(n,)` how far the ZMP is inside the support polygon of every sample of a walk [m].

    Args:
        walk: The footsteps.
        parts: The samples of each phase.
        corners: `(n, 2, 4, 3)` of both soles [m].
        zmp: `(n, 2)` [m].
    """
    out = np.empty(len(zmp))
    for part in parts:
        if part.samples.start < part.samples.stop:
            feet = standing(walk, part)
            soles = corners[part.samples.start, feet, :, :2].reshape(-1, 2)
            out[part.samples] = margin(convex_hull(soles), zmp[part.samples])
    return out


def standing(walk: Footsteps, part: PhaseSamples) -> list[int]:
    """The feet on the ground during a phase: 0 left, 1 right."""
    if part.phase.step is None:
        return [0, 1]
    return [1 - SIDES.index(walk.steps[part.phase.step].side)]


def _chain(points: list[tuple[float, ...]]) -> list[tuple[float, ...]]:
    """The convex chain along points in order."""
    out: list[tuple[float, ...]] = []
    for p in points:
        while len(out) > 1 and _turn(out[-2], out[-1], p) <= _TURNS:
            out.pop()
        out.append(p)
    return out


def _turn(a: tuple[float, ...], b: tuple[float, ...], c: tuple[float, ...]) -> float:
    """Twice the area of a triangle, positive if counter-clockwise."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
