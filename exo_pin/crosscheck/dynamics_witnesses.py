"""Inverse dynamics four ways: the paper's recursion, MuJoCo and OpenSim against Pinocchio."""

from __future__ import annotations

import importlib.util
from collections.abc import Callable

import numpy as np

from exo_pin import description, dh
from exo_pin.anatomy import FEET
from exo_pin.anatomy.inertia import Inertial
from exo_pin.arguments import LARGEST_SEED, count
from exo_pin.arrays import Array
from exo_pin.crosscheck import mujoco_inverse, opensim_inverse
from exo_pin.crosscheck.random_states import States, random_states
from exo_pin.dynamics import Motion, floating_robot, generalized_forces, in_pelvis_axes, in_world_axes
from exo_pin.errors import DescriptionError
from exo_pin.robot import Robot
from exo_pin.robot.floating_base import base_coordinates

DYNAMICS_TOLERANCE = 1e-10
"""Largest difference between two ways of inverse dynamics, as a part of the state's largest force."""

_MOST_STATES = 10_000
_STATES = 1000
_LINK = "_link_mass"


def inverse_dynamics(robot: Robot, n: int = _STATES, *, seed: int = 0) -> dict[str, float]:
    """Largest relative difference to Pinocchio of each witness, over random states.

    Args:
        robot: An exoskeleton of this package; its masses are used.
        n: How many states, with wrenches at the feet and a moving pelvis.
        seed: Of the random numbers.

    Returns:
        `recursion`, and `mujoco` and `opensim` where they are installed: forces and moments on the pelvis
        [N, N m] and joint torques [N m], as a part of the largest of the state.

    Raises:
        DescriptionError: The robot is not an exoskeleton of this package, or a number is not accepted.
    """
    n, seed = count("n", n, 1, _MOST_STATES), count("seed", seed, 0, LARGEST_SEED)
    if robot.body is None or robot.device is None:
        raise DescriptionError("the witnesses of dynamics need a robot that load_robot made")
    model = floating_robot(robot, robot.masses)
    states = random_states(model, n, seed=seed)
    ours = by_pinocchio(model, states)
    witnesses: dict[str, Callable[[Robot, States], Array]] = {"recursion": by_recursion}
    witnesses |= {name: way for name, way in _INSTALLED.items() if importlib.util.find_spec(name)}
    scale = np.abs(ours).max(axis=1)
    return {
        name: float((np.abs(witness(model, states) - ours).max(axis=1) / scale).max())
        for name, witness in witnesses.items()
    }


def by_pinocchio(robot: Robot, states: States) -> Array:
    """`(n, 6 + J)` force and moment on the pelvis in world axes, then joint torques, as by `dynamics`."""
    v, a = in_pelvis_axes(states.base, states.velocity, states.acceleration)
    q = np.hstack([base_coordinates(states.base), states.q])
    moving = Motion(q, np.hstack([v, states.dq]), np.hstack([a, states.ddq]), states.base, "random")
    tau = generalized_forces(robot, moving, states.wrench)
    return np.hstack([in_world_axes(states.base, tau), tau[:, 6:]])


def by_recursion(robot: Robot, states: States) -> Array:
    """The same by the recursion of `dh`."""
    assert robot.body is not None
    assert robot.device is not None
    columns = zip(robot.joints, states.q.T, states.dq.T, states.ddq.T, strict=True)
    needed = dh.inverse_dynamics(
        robot.body,
        link_inertials(robot),
        dh.PelvisState(states.base, states.velocity, states.acceleration),
        {name: dh.JointState(*values) for name, *values in columns},
        dict(zip(FEET, np.swapaxes(states.wrench, 0, 1), strict=True)),
        hip_order=robot.hip_order,
        toes=robot.device.toes,
    )
    return np.column_stack([needed.pelvis, *(needed.joints[name] for name in robot.joints)])


def by_opensim(robot: Robot, states: States) -> Array:
    """The same by OpenSim."""
    return opensim_inverse.generalized_forces(robot, states, link_inertials(robot))


_INSTALLED: dict[str, Callable[[Robot, States], Array]] = {
    "mujoco": mujoco_inverse.generalized_forces,
    "opensim": by_opensim,
}
"""Package -> what it answers, where it is installed."""


def link_inertials(robot: Robot) -> dict[str, Inertial]:
    """Mass, centre and inertia of each link as the URDF states them, to its decimals."""
    assert robot.body is not None
    assert robot.device is not None
    given = description.arguments(
        robot.body, device=robot.device, hip_order=robot.hip_order, masses=robot.masses
    )
    links = [name.removesuffix(_LINK) for name in given if name.endswith(_LINK)]
    return {link: _inertial(given, link) for link in links}


def _inertial(given: dict[str, str], link: str) -> Inertial:
    inertia = np.zeros((3, 3))
    inertia[np.triu_indices(3)] = [float(x) for x in given[f"{link}_inertia"].split()]
    inertia = inertia + np.triu(inertia, 1).T
    centre = np.array([float(x) for x in given[f"{link}_com"].split()])
    return Inertial(float(given[f"{link}{_LINK}"]), centre, inertia)
