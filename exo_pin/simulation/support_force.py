"""Force of balance support and pushes on the pelvis, in plain floats: arrays of three cost ten times more."""

from __future__ import annotations

import math
from collections.abc import Sequence

from exo_pin.arrays import Array
from exo_pin.robot.floating_base import base_coordinates
from exo_pin.simulation.pelvis_support import PelvisSupport
from exo_pin.simulation.reference_motion import ReferenceMotion

Quaternion = tuple[float, float, float, float]
"""Real part first, as MuJoCo has it."""

Vector = tuple[float, float, float]


class SupportForce:
    """Spring, damper and unloading between the pelvis and where the walk carries it, and pushes.

    Args:
        support: Stiffness and damping, world axes.
        walk: The walk.
        unloading: Constant upward force at mid-hip [N].
        pushes: `(N, 2)` horizontal force at mid-hip in each step [N].
    """

    def __init__(
        self, support: PelvisSupport, walk: ReferenceMotion, unloading: float, pushes: Array
    ) -> None:
        self._stiffness, self._damping, self._unloading = support.stiffness, support.damping, unloading
        coordinates = base_coordinates(walk.base)
        self._places: list[list[float]] = coordinates[:, :3].tolist()
        self._attitudes: list[list[float]] = coordinates[:, [6, 3, 4, 5]].tolist()
        self._pushes = {k: push for k, push in enumerate(pushes.tolist()) if any(push)}
        self._velocities: list[list[float]] = walk.base_velocity.tolist()

    def at(self, k: int, qpos: Sequence[float], qvel: Sequence[float]) -> tuple[list[float], list[float]]:
        """Force and moment about mid-hip in step k.

        Args:
            k: The step.
            qpos: MuJoCo's positions: place, quaternion, joints.
            qvel: MuJoCo's velocities: linear in world axes, angular in the pelvis's.

        Returns:
            Six numbers in world axes, and the same as MuJoCo takes them: moment in the pelvis's axes.
        """
        place, speed = self._places[k], self._velocities[k]
        attitude: Quaternion = (qpos[3], qpos[4], qpos[5], qpos[6])
        turn = _turn(self._attitudes[k], attitude)
        spin = rotated(attitude, (qvel[3], qvel[4], qvel[5]))
        off = (place[0] - qpos[0], place[1] - qpos[1], place[2] - qpos[2], *turn)
        rate = (qvel[0], qvel[1], qvel[2], *spin)
        world = [
            stiff * x + damp * (v - u)
            for stiff, x, damp, v, u in zip(self._stiffness, off, self._damping, speed, rate, strict=True)
        ]
        world[2] += self._unloading
        if k in self._pushes:
            push = self._pushes[k]
            world[0], world[1] = world[0] + push[0], world[1] + push[1]
        w, x, y, z = attitude
        moment = rotated((w, -x, -y, -z), (world[3], world[4], world[5]))
        return world, [*world[:3], *moment]


def rotated(q: Quaternion, v: Vector) -> Vector:
    """A vector turned by a unit quaternion: v + 2 w (u x v) + 2 u x (u x v)."""
    w, x, y, z = q
    a, b, c = v
    tx, ty, tz = 2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)
    return (
        a + w * tx + y * tz - z * ty,
        b + w * ty + z * tx - x * tz,
        c + w * tz + x * ty - y * tx,
    )


def _turn(target: Sequence[float], q: Quaternion) -> Vector:
    """Rotation vector, world axes, that turns the attitude q into the target [rad]."""
    a, b, c, d = target
    w, x, y, z = q[0], -q[1], -q[2], -q[3]
    real = a * w - b * x - c * y - d * z
    i = a * x + b * w + c * z - d * y
    j = a * y - b * z + c * w + d * x
    k = a * z + b * y - c * x + d * w
    if real < 0.0:  # the same attitude, by the shorter way
        real, i, j, k = -real, -i, -j, -k
    length = math.sqrt(i * i + j * j + k * k)
    scale = 2.0 * math.atan2(length, real) / length if length > 1e-12 else 2.0
    return scale * i, scale * j, scale * k
