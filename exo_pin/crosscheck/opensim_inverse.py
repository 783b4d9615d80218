"""Inverse dynamics by OpenSim: the exoskeleton rebuilt through its API, solved by Simbody."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from exo_pin.anatomy import FEET
from exo_pin.anatomy.inertia import Inertial
from exo_pin.arrays import Array
from exo_pin.crosscheck.random_states import States
from exo_pin.dh import Link, chain
from exo_pin.dh.moving_links import PELVIS, links_with_toes, moving_masses
from exo_pin.formats.opensim.pelvis_axes import body_fixed_xyz
from exo_pin.physics import GRAVITY
from exo_pin.robot import Robot

_FREE = 6


@dataclass(frozen=True, eq=False)
class _Model:
    """The exoskeleton in OpenSim, and where its parts stand in Simbody's vectors."""

    opensim: Any
    model: Any
    state: Any
    bodies: dict[str, Any]
    masses: Mapping[str, Inertial]
    columns: list[int]
    feet: list[str]


def generalized_forces(robot: Robot, states: States, inertias: Mapping[str, Inertial]) -> Array:
    """`(n, 6 + J)` force and moment on the pelvis in world axes, then joint torques [N, N m].

    Args:
        robot: A floating robot of this package.
        states: n states.
        inertias: Mass, centre and inertia by name of the URDF's link.
    """
    built = _built(robot, inertias)
    return np.array([_solved(built, States(*(values[k] for values in states))) for k in range(len(states.q))])


def _built(robot: Robot, inertias: Mapping[str, Inertial]) -> _Model:
    import opensim  # seconds, and optional

    assert robot.body is not None
    assert robot.device is not None
    toes = robot.device.toes
    masses = moving_masses(robot.body, inertias, robot.hip_order, toes=toes)
    links = links_with_toes(robot.body, robot.hip_order, toes=toes)
    model = opensim.Model()
    model.setGravity(opensim.Vec3(0.0))  # given with the forces, body by body
    bodies = {name: _body(opensim, model, name, masses[name]) for name in (PELVIS, *(n.name for n in links))}
    model.addJoint(opensim.FreeJoint("free", model.getGround(), bodies[PELVIS]))
    for link in links:
        model.addJoint(_joint(opensim, link, bodies))
    state = model.initSystem()  # numbers the bodies in an order of its own, the ground first
    feet = [f"{foot.removesuffix('_foot')}_{chain(robot.hip_order)[-1]}" for foot in FEET]
    columns = [_FREE + int(bodies[name].getMobilizedBodyIndex()) - 2 for name in robot.joints]
    return _Model(opensim, model, state, bodies, masses, columns, feet)


def _body(opensim: Any, model: Any, name: str, part: Inertial) -> Any:
    i = part.inertia
    inertia = opensim.Inertia(*(float(x) for x in (i[0, 0], i[1, 1], i[2, 2], i[0, 1], i[0, 2], i[1, 2])))
    body = opensim.Body(name, float(part.mass), _vec3(opensim, part.centre), inertia)
    model.addBody(body)
    return body


def _joint(opensim: Any, link: Link, bodies: Mapping[str, Any]) -> Any:
    """A hinge, which turns about the z of its frames: these are turned so that z is the link's axis."""
    x, y, z = (float(part) for part in link.axis)
    upright = 0.0 if z > 0 else np.pi
    turn = opensim.Vec3(upright, 0.0, 0.0) if z else opensim.Vec3(-y * np.pi / 2, x * np.pi / 2, 0.0)
    at, still = _vec3(opensim, link.offset), opensim.Vec3(0.0)
    return opensim.PinJoint(f"j_{link.name}", bodies[link.mother], at, turn, bodies[link.name], still, turn)


def _solved(built: _Model, one: States) -> Array:
    """Of one state."""
    opensim, state = built.opensim, built.state
    matter = built.model.getMatterSubsystem()
    q, u, du = (np.zeros(state.getNQ()), np.zeros(state.getNU()), np.zeros(state.getNU()))
    q[:3], q[3:_FREE] = body_fixed_xyz(one.base[:3, :3]), one.base[:3, 3]
    q[np.array(built.columns) + 1] = one.q  # behind seven places for the pelvis, of which angles use six
    for values, pelvis, joints in ((u, one.velocity, one.dq), (du, one.acceleration, one.ddq)):
        values[:3], values[3:_FREE] = pelvis[3:], pelvis[:3]  # rotations first
        values[built.columns] = joints
    state.setQ(opensim.Vector(q.tolist()))
    state.setU(opensim.Vector(u.tolist()))
    built.model.realizeVelocity(state)
    forces = _applied(built, one.wrench)
    tau = opensim.Vector()
    matter.calcResidualForceIgnoringConstraints(
        state, opensim.Vector(state.getNU(), 0.0), forces, opensim.Vector(du.tolist()), tau
    )
    found = np.array([tau.get(k) for k in range(tau.size())])
    return np.concatenate([found[3:_FREE], found[:3], found[built.columns]])


def _applied(built: _Model, wrench: Array) -> Any:
    """Weight of each body and wrenches at the feet, as Simbody takes them: about each body's origin."""
    opensim = built.opensim
    zero = opensim.SpatialVec(opensim.Vec3(0.0), opensim.Vec3(0.0))
    forces = opensim.VectorOfSpatialVec(len(built.bodies) + 1, zero)
    on_feet = dict(zip(built.feet, wrench, strict=True))
    for name, body in built.bodies.items():
        T = body.getTransformInGround(built.state)
        R = np.array([[T.R().get(i, j) for j in range(3)] for i in range(3)])
        p = np.array([T.p().get(i) for i in range(3)])
        force = np.array([0.0, 0.0, -GRAVITY * built.masses[name].mass])
        moment = np.cross(R @ built.masses[name].centre, force)
        if name in on_feet:
            force = force + on_feet[name][:3]
            moment = moment + on_feet[name][3:] - np.cross(p, on_feet[name][:3])
        both = opensim.SpatialVec(_vec3(opensim, moment), _vec3(opensim, force))
        forces.set(body.getMobilizedBodyIndex(), both)
    return forces


def _vec3(opensim: Any, values: Array) -> Any:
    return opensim.Vec3(*map(float, values))
