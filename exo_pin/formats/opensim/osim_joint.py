"""One joint of an OpenSim model: rotation and translation axes, coordinates, offsets, and its transform."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from exo_pin.arrays import Array
from exo_pin.gait.rigid_poses import about

Vector = tuple[float, float, float]

AXIS_X, AXIS_Y, AXIS_Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)


class Axis(NamedTuple):
    """A rotation about, or a translation along, one axis by `slope * coordinate + offset`.

    Attributes:
        vector: `(3,)` of length 1.
        coordinate: Name, or "" where the axis is at rest.
        slope: Per unit of the coordinate; of a curve its mean.
        offset: At coordinate 0 [rad or m].
        linear: False where the amount is a curve (a spline) and slope and offset are not the whole truth.
        curve: Coordinates and amounts at the knots of a curve of one coordinate; empty for other axes.
    """

    vector: Vector
    coordinate: str = ""
    slope: float = 1.0
    offset: float = 0.0
    linear: bool = True
    curve: tuple[tuple[float, float], ...] = ()

    def at(self, value: float) -> float:
        """The amount at a coordinate's value [rad or m]; between a curve's knots along straight lines."""
        if not self.curve:
            return self.slope * value + self.offset if self.coordinate else self.offset
        knots, amounts = np.transpose(self.curve)
        return float(np.interp(value, knots, amounts))


class Joint(NamedTuple):
    """A joint between two bodies.

    Attributes:
        name: In the model.
        parent: Body it hangs on; `ground` for the first.
        child: Body that it carries.
        in_parent: `(4, 4)` the joint's frame in the parent body.
        in_child: `(4, 4)` the joint's frame in the child body.
        rotations: One after the other, each about an axis of the frame that the ones before have rotated.
        translations: Along axes of the joint's frame in the parent, before all rotations.
    """

    name: str
    parent: str
    child: str
    in_parent: Array
    in_child: Array
    rotations: tuple[Axis, ...]
    translations: tuple[Axis, ...]

    @property
    def coordinates(self) -> tuple[str, ...]:
        """Names of what moves it, without repetition: rotations, then translations."""
        return tuple(
            dict.fromkeys(a.coordinate for a in (*self.rotations, *self.translations) if a.coordinate)
        )

    def frame_at(self, values: Mapping[str, float]) -> Array:
        """`(4, 4)` the joint's frame in the parent body, moved, at single values of coordinates [rad, m].

        Unlike `transform` it follows curves; coordinates without a value are at 0.
        """
        T = np.eye(4)
        for axis in self.translations:
            T[:3, 3] += axis.at(values.get(axis.coordinate, 0.0)) * np.array(axis.vector)
        for axis in self.rotations:
            T[:3, :3] = T[:3, :3] @ about(axis.vector, axis.at(values.get(axis.coordinate, 0.0)))
        return np.asarray(self.in_parent @ T)

    def transform(self, values: Mapping[str, Array]) -> Array:
        """T_parent_child `(n, 4, 4)` for coordinates `(n,)` [rad, m]."""
        n = len(next(iter(values.values())))
        T = np.tile(np.eye(4), (n, 1, 1))
        for axis in self.translations:
            T[:, :3, 3] += np.outer(_amount(axis, values, n), axis.vector)
        for axis in self.rotations:
            T[:, :3, :3] = T[:, :3, :3] @ about(axis.vector, _amount(axis, values, n))
        out = self.in_parent @ T @ np.linalg.inv(self.in_child)
        return np.asarray(out)


def _amount(axis: Axis, values: Mapping[str, Array], n: int) -> Array:
    moved = axis.slope * values[axis.coordinate] if axis.coordinate else np.zeros(n)
    return np.asarray(moved + axis.offset)


def body_pose(chain: Sequence[Joint], values: Mapping[str, float]) -> Array:
    """`(4, 4)` the last body of a chain of joints in the first one's parent; `values` as in `frame_at`."""
    T = np.eye(4)
    for link in chain:
        T = T @ link.frame_at(values) @ np.linalg.inv(link.in_child)
    return T


def joint_centre(chain: Sequence[Joint], values: Mapping[str, float]) -> Array:
    """`(3,)` centre of the last joint of a chain in the first one's parent [m]; `values` as in `frame_at`."""
    return np.asarray((body_pose(chain[:-1], values) @ chain[-1].frame_at(values))[:3, 3])


def offset(translation: Sequence[float], orientation: Sequence[float]) -> Array:
    """`(4, 4)` of an offset frame: translation [m], then rotations [rad] about its x, y and z."""
    T = np.eye(4)
    for axis, angle in zip((AXIS_X, AXIS_Y, AXIS_Z), orientation, strict=True):
        T[:3, :3] = T[:3, :3] @ about(axis, angle)
    T[:3, 3] = translation
    return T
