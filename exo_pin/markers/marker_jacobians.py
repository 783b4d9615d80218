"""Places of markers in the world, and how they move with the pose and with the sizes of the body."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from exo_pin.arrays import Array
from exo_pin.markers.body_priors import FIRST_PLACE, SIZE_NAMES, Parameters
from exo_pin.robot import Robot


class MarkerJacobians(NamedTuple):
    """n poses of k markers, linearised.

    Attributes:
        position: `(n, k, 3)` in the world [m].
        by_pose: `(n, k, 3, nv)` derivative by the robot's velocity.
        by_parameter: `(n, k, 3, p)` derivative by the entries of `Parameters`.
    """

    position: Array
    by_pose: Array
    by_parameter: Array


def linearised(robot: Robot, q: Array, now: Parameters) -> MarkerJacobians:
    """Positions of the markers and their derivatives.

    Args:
        robot: Of these sizes, with a floating base.
        q: `(n, nq)` its configurations.
        now: Sizes and places.
    """
    links = list(dict.fromkeys(now.links))
    T, J = _frames(robot, q, links)
    place = np.array([links.index(link) for link in now.links])
    local = np.array([now.places[name] for name in now.names])
    R = T[:, place, :3, :3]
    arm = np.einsum("nkij,kj->nki", R, local)
    v, w = J[:, place, :3], J[:, place, 3:]
    by_pose = v + np.cross(w.swapaxes(2, 3), arm[:, :, None, :]).swapaxes(2, 3)
    by_parameter = np.zeros((*arm.shape, FIRST_PLACE + 3 * len(now.names)))
    for k in range(len(now.names)):
        by_parameter[:, k, :, FIRST_PLACE + 3 * k : FIRST_PLACE + 3 * k + 3] = R[:, k]
    _by_sizes(by_parameter, now, {link: T[:, i, :3, :3] for i, link in enumerate(links)})
    return MarkerJacobians(T[:, place][..., :3, 3] + arm, by_pose, by_parameter)


def _by_sizes(out: Array, now: Parameters, R: dict[str, Array]) -> None:
    """A longer segment shifts every marker beyond it; a wider pelvis those of the legs."""
    for k, link in enumerate(now.links):
        side, _, part = link.partition("_")
        if not part:
            continue
        s = 1 if side == "left" else -1
        out[:, k, :, SIZE_NAMES.index("hip_width")] = s / 2 * R["pelvis"][:, :, 1]
        if part != "thigh":
            out[:, k, :, SIZE_NAMES.index(f"{side}_thigh")] = -R[f"{side}_thigh"][:, :, 2]
        if part == "sole_plate":
            out[:, k, :, SIZE_NAMES.index(f"{side}_shank")] = -R[f"{side}_shank"][:, :, 2]


def _frames(robot: Robot, q: Array, links: list[str]) -> tuple[Array, Array]:
    """Poses `(n, L, 4, 4)` and Jacobians `(n, L, 6, nv)` of links, at their origins, in world axes."""
    import pinocchio as pin

    model, data = robot.model, robot.model.createData()
    ids = [model.getFrameId(link) for link in links]
    T = np.zeros((len(q), len(ids), 4, 4))
    J = np.zeros((len(q), len(ids), 6, model.nv))
    for n, pose in enumerate(q):
        pin.computeJointJacobians(model, data, pose)
        pin.updateFramePlacements(model, data)
        for i, frame in enumerate(ids):
            T[n, i] = data.oMf[frame].homogeneous
            J[n, i] = pin.getFrameJacobian(model, data, frame, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED)
    return T, J


def moved(robot: Robot, q: Array, dq: Array) -> Array:
    """`(n, nq)` configurations after steps `(n, nv)`."""
    import pinocchio as pin

    return np.array([pin.integrate(robot.model, a, b) for a, b in zip(q, dq, strict=True)])
