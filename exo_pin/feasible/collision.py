"""Self-collision: smallest distance between the parts of a device, computed by coal."""

from __future__ import annotations

from itertools import combinations
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
import pinocchio as pin

from exo_pin.arguments import real
from exo_pin.arrays import Array
from exo_pin.errors import DescriptionError
from exo_pin.robot import Robot
from exo_pin.short_repr import short_repr

_CHAIN = ("pelvis", "thigh", "shank", "sole_plate", "toe_plate")
"""The links with a shape, from the pelvis outwards; neighbours share a hip or ankle and may touch."""


class Nearest(NamedTuple):
    """The nearest pair of parts at each sample.

    Attributes:
        distance: Between the two nearest parts (n,) [m]; negative: penetration depth.
        pairs: Links of the two nearest parts, at each sample.
    """

    distance: Array
    pairs: list[tuple[str, str]]

    def __repr__(self) -> str:
        return short_repr(self)


def nearest(robot: Robot, q: npt.ArrayLike) -> Nearest:
    """The smallest distance between parts that are not neighbours.

    Args:
        robot: A device of this package; its collision shapes are capsules and boxes.
        q: Configurations (n, nq) [rad].

    Raises:
        DescriptionError: The robot is none of this package's devices, the shape of q does not fit, or a
            number is not finite.
    """
    if robot.device is None:
        raise DescriptionError(f"{robot.name} is no device of this package, whose parts are known")
    rows = real("q", q, ("n", robot.nq))
    if not len(rows):
        raise DescriptionError("q holds no configuration")
    geometry = pin.buildGeomFromUrdfString(robot.model, robot.urdf, pin.GeometryType.COLLISION)
    links = [item.name.rsplit("_", 1)[0] for item in geometry.geometryObjects]  # "left_thigh_0"
    pairs = [
        pair for pair in combinations(range(len(links)), 2) if not _neighbours(*(links[i] for i in pair))
    ]
    for pair in pairs:
        geometry.addCollisionPair(pin.CollisionPair(*pair))
    model, data, found = robot.model, robot.model.createData(), geometry.createData()
    distances = np.array([_distances(model, data, geometry, found, row) for row in rows])
    worst = distances.argmin(axis=1)
    return Nearest(
        distances[np.arange(len(distances)), worst], [(links[pairs[k][0]], links[pairs[k][1]]) for k in worst]
    )


def _distances(model: Any, data: Any, geometry: Any, found: Any, q: Array) -> list[float]:
    pin.computeDistances(model, data, geometry, found, q)
    return [float(result.min_distance) for result in found.distanceResults]


def _neighbours(a: str, b: str) -> bool:
    """Whether two links follow each other in one leg (or are the pelvis and a thigh)."""
    (side_a, part_a), (side_b, part_b) = map(_part, (a, b))
    if side_a and side_b and side_a != side_b:
        return False
    return abs(_CHAIN.index(part_a) - _CHAIN.index(part_b)) <= 1


def _part(name: str) -> tuple[str, str]:
    side, _, part = name.partition("_")
    return (side, part) if side in ("left", "right") else ("", name)
