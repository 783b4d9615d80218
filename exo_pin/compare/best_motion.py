"""A device put through a walk: the best it can do for the feet, and the plain copy of its joints.

The best motion minimises, sample by sample, the sum of squared distances of the four sole corners of each
foot from where the recorded feet have them: weighted least squares over position and rotation, with weights
that need no choosing, because both are distances of points on the sole. It keeps the device's joint limits;
where the best of each sample would need joints faster than the device's, the best of the whole motion is
taken that keeps its speeds, too.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from exo_pin import ik
from exo_pin.anatomy import FEET, JOINTS, SIDES, Body
from exo_pin.anatomy.hip import hip_angles
from exo_pin.arrays import Array
from exo_pin.devices import Device
from exo_pin.errors import UnknownNameError
from exo_pin.gait import Gait
from exo_pin.ik.least_squares.velocity_limited import paced
from exo_pin.kinematics import center_of_mass, poses
from exo_pin.kinematics.resting_stance import stand
from exo_pin.robot import Robot, load_robot

SETTINGS = ik.Dls(tolerance=1e-10, restarts=0, warm_start=False)
"""Every sample starts from the plain copy, then from its neighbours' answers; no other starts are tried."""

SWEEPS = 10
"""At most so many times through all samples, each asking its neighbours."""

BETTER = 1e-10
"""A squared error that falls by less does so by rounding [m^2]."""

CONDITIONS = {"pelvis": ("recorded", "device"), "passive": ("held", "released")}
"""What may be granted to a device, by name."""


@dataclass(frozen=True)
class Conditions:
    """What a device is granted.

    Attributes:
        pelvis: `"recorded"`: the pelvis moves as the walker's, whatever the device; `"device"`: it is held
            upright at its mean place (moving evenly with a walk over ground) and moves only along the
            device's slides. A device whose pelvis goes with the person has the recorded one either way.
        passive: `"held"`: passive joints stand at zero; `"released"`: they move as it suits the feet.

    Raises:
        UnknownNameError: A word is unknown.
    """

    pelvis: Literal["recorded", "device"] = "recorded"
    passive: Literal["held", "released"] = "held"

    def __post_init__(self) -> None:
        for name, known in CONDITIONS.items():
            if getattr(self, name) not in known:
                raise UnknownNameError(f"condition for {name}", getattr(self, name), known)


GRANTED = Conditions()
"""What devices are granted unless something else is said."""


@dataclass(frozen=True, eq=False)
class Walk:
    """The recorded walk on the full exoskeleton: what every device is measured against.

    Attributes:
        gait: The walk.
        robot: The 12-joint exoskeleton for the body.
        base: T_world_pelvis (n, 4, 4).
        feet: T_world_foot (n, 2, 4, 4), left and right.
        corners: Sole corners (n, 2, 4, 3) in the world [m]: heel medial, lateral, ball medial, lateral.
        com: Centre of mass (n, 3) [m].
    """

    gait: Gait
    robot: Robot
    base: Array
    feet: Array
    corners: Array
    com: Array


@dataclass(frozen=True, eq=False)
class Motion:
    """A device's motion.

    Attributes:
        robot: The device as it was put through the walk.
        q: Configurations (n, nq) [rad], slides [m].
        gait: The same as a gait: locked joints zero, its base the pelvis with the slides in it.
        feet: T_world_foot (n, 2, 4, 4).
        corners: Sole corners (n, 2, 4, 3) [m].
        com: Centre of mass (n, 3) [m].
        asked: The recorded angles (n, 12) as seen from the device's pelvis [rad]: the gait's own where the
            pelvis moves as recorded; where it is held, the hips take over what the pelvis turned.
    """

    robot: Robot
    q: Array
    gait: Gait
    feet: Array
    corners: Array
    com: Array
    asked: Array


def walk(gait: Gait, body: Body | None = None) -> Walk:
    """Put the full exoskeleton through the gait."""
    robot = load_robot(body)
    q = robot.from_gait(gait)
    base = np.tile(robot.placement, (len(gait), 1, 1)) if gait.base is None else np.array(gait.base)
    feet = poses(robot, q, FEET, base=base)
    com = center_of_mass(robot, q, base=base).position
    return Walk(gait, robot, base, feet, corners(robot, feet), com)


def robot_for(device: Device, body: Body, conditions: Conditions) -> Robot:
    """The device under these conditions."""
    if conditions.passive == "released":
        device = device.released()
    return load_robot(body, device=device.carried() if conditions.pelvis == "recorded" else device)


def projected(recorded: Walk, robot: Robot, conditions: Conditions = GRANTED) -> Motion:
    """The plain copy: the device's joints as asked, within its limits; the others dropped."""
    base = _stand(recorded, robot, conditions)
    asked = _asked(recorded, base)
    return _motion(recorded, robot, _copy(recorded, robot, asked), base, asked)


def best(
    recorded: Walk, robot: Robot, conditions: Conditions = GRANTED, *, settings: ik.Dls = SETTINGS
) -> Motion:
    """The device's best motion towards the recorded feet, within its joint limits and speeds."""
    base = _stand(recorded, robot, conditions)
    asked = _asked(recorded, base)
    start = _copy(recorded, robot, asked)
    targets = sole_targets(robot, recorded.corners)

    def solved(seed: Array) -> tuple[Array, Array]:
        q = ik.track(robot, targets, seed, base=base, settings=settings).q
        missed = corners(robot, poses(robot, q, FEET, base=base)) - recorded.corners
        return q, (missed**2).sum(axis=(1, 2, 3))

    q = _agreed(solved, start)
    q = paced(robot, targets, q, pace(recorded.gait, robot), base=base)
    return _motion(recorded, robot, q, base, asked)


def _agreed(solved: Callable[[Array], tuple[Array, Array]], start: Array) -> Array:
    """Answers that no neighbour's answer, as another start, improves: fewer samples stay in poor minima."""
    q, cost = solved(start)
    for _ in range(SWEEPS):
        before = cost
        for shift in (1, -1):
            other, price = solved(np.roll(q, shift, axis=0))
            better = price < cost - BETTER
            q, cost = np.where(better[:, None], other, q), np.where(better, price, cost)
        if np.array_equal(cost, before):
            break
    return q


def pace(gait: Gait, robot: Robot) -> Array:
    """How far each joint can move between samples: (n - 1, nq), of a periodic gait (n, nq) [rad, m]."""
    end = [gait.time[0] + gait.duration] if gait.periodic else []
    return np.asarray(np.diff(gait.time, append=end)[:, None] * robot.velocity)


def corners(robot: Robot, feet: Array) -> Array:
    """Sole corners (..., 2, 4, 3) in the world of feet (..., 2, 4, 4) [m]."""
    local = _soles(robot)
    return np.asarray(local @ feet[..., :3, :3].swapaxes(-1, -2) + feet[..., None, :3, 3])


def sole_targets(robot: Robot, wanted: Array) -> dict[str, ik.Points]:
    """Where the feet's sole corners shall be (n, 2, 4, 3), as targets for inverse kinematics."""
    return {foot: ik.Points(_soles(robot)[k], wanted[:, k]) for k, foot in enumerate(FEET)}


def _soles(robot: Robot) -> Array:
    """Sole corners (2, 4, 3) in the axes of the foot frames, in the order of `exo_pin.anatomy.CORNERS`."""
    assert robot.body is not None  # load_robot made it
    rows = []
    for side, s in zip(SIDES, (1.0, -1.0), strict=True):
        leg = robot.body.leg(side)
        medial, lateral = -s * leg.foot_width / 2, s * leg.foot_width / 2
        rows.append([[x, y, 0.0] for x in (-leg.heel, leg.ball) for y in (medial, lateral)])
    return np.array(rows)


def _copy(recorded: Walk, robot: Robot, asked: Array) -> Array:
    q = robot.from_gait(dataclasses.replace(recorded.gait, q=asked))
    return np.clip(q, robot.lower, robot.upper)


def _asked(recorded: Walk, base: Array) -> Array:
    """The gait's angles with the hips seen from another pelvis: the thighs keep their attitude."""
    asked = np.array(recorded.gait.q)
    if base is recorded.base:
        return asked
    q = recorded.robot.from_gait(recorded.gait)
    thighs = poses(recorded.robot, q, [f"{side}_thigh" for side in SIDES], base=recorded.base)
    R = base[:, None, :3, :3].swapaxes(-1, -2) @ thighs[..., :3, :3]
    for k, side in enumerate(SIDES):
        first = JOINTS.index(f"{side}_hip_flexion")  # flexion, adduction, rotation stand in a row
        asked[:, first : first + 3] = hip_angles(R[:, k], side)
    return asked


def _stand(recorded: Walk, robot: Robot, conditions: Conditions) -> Array:
    """T_world_stand (n, 4, 4): what the pelvis, or its slides, rest on."""
    if conditions.pelvis == "recorded" or (robot.device is not None and robot.device.pelvis == "free"):
        return recorded.base
    return stand(recorded.gait.time, recorded.base, periodic=recorded.gait.periodic)


def _motion(recorded: Walk, robot: Robot, q: Array, base: Array, asked: Array) -> Motion:
    feet = poses(robot, q, FEET, base=base)
    like = Gait(
        recorded.gait.time,
        recorded.gait.q,
        base=base,
        events=recorded.gait.events,
        periodic=recorded.gait.periodic,
        source=f"{robot.name} after {recorded.gait.source or 'a gait'}",
    )
    com = center_of_mass(robot, q, base=base).position
    return Motion(robot, q, robot.to_gait(q, like), feet, corners(robot, feet), com, asked)


def dressed(robot: Robot) -> Robot:
    """The full 12-joint model with a device's looks: for the viewer, which plots all twelve joints.

    A gait with the locked joints at zero puts both in the same pose.
    """
    return dataclasses.replace(load_robot(robot.body), urdf=robot.urdf)
