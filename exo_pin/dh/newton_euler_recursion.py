"""Reference inverse dynamics: the paper's recursion, Eq. (1) to (6), carried on to accelerations and forces.

Outwards from the pelvis, each link's rotation and origin (Eq. 1 to 3), angular velocity, angular acceleration
and acceleration of its origin; inwards, the force and moment that each link takes (Newton, Euler).
All vectors are in world axes, all samples are worked on at once: NumPy alone.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from exo_pin.anatomy import FEET
from exo_pin.anatomy.body import Body
from exo_pin.anatomy.inertia import Inertial
from exo_pin.anatomy.names import HipOrder
from exo_pin.arguments import real, table, word
from exo_pin.arrays import Array
from exo_pin.dh.leg_chain import chain
from exo_pin.dh.moving_links import PELVIS, links_with_toes, moving_masses
from exo_pin.dh.recursion import Link, joint_pose
from exo_pin.errors import DescriptionError
from exo_pin.physics import GRAVITY
from exo_pin.short_repr import short_repr

_LIFT = np.array([0.0, 0.0, GRAVITY])
"""Acceleration that stands for the weight [m/s^2]."""


class PelvisState(NamedTuple):
    """Motion of the pelvis in n samples, world axes.

    Attributes:
        pose: `(n, 4, 4)`.
        velocity: `(n, 6)` of its origin, then angular [m/s, rad/s].
        acceleration: `(n, 6)` of its origin (classical), then angular [m/s^2, rad/s^2].
    """

    pose: Array
    velocity: Array
    acceleration: Array

    def __repr__(self) -> str:
        return short_repr(self)


class JointState(NamedTuple):
    """Motion of one joint in n samples: `(n,)` angle, velocity, acceleration [rad, rad/s, rad/s^2]."""

    q: Array
    dq: Array
    ddq: Array

    def __repr__(self) -> str:
        return short_repr(self)


class Needed(NamedTuple):
    """What inverse dynamics answers.

    Attributes:
        pelvis: `(n, 6)` force on the pelvis, then moment about its origin, world axes [N, N m].
        joints: `(n,)` torque by joint name [N m].
    """

    pelvis: Array
    joints: dict[str, Array]

    def __repr__(self) -> str:
        return short_repr(self)


class _LinkMotion(NamedTuple):
    """Of a link in world axes: rotation, origin, angular velocity and acceleration, origin's acceleration."""

    R: Array
    p: Array
    w: Array
    dw: Array
    a: Array


def inverse_dynamics(
    body: Body,
    inertias: Mapping[str, Inertial],
    pelvis: PelvisState,
    joints: Mapping[str, JointState],
    wrenches: Mapping[str, Array],
    *,
    hip_order: HipOrder = "clinical",
    toes: bool = False,
) -> Needed:
    """Forces on the pelvis and torques of all joints, locked ones too.

    Args:
        body: Sizes.
        inertias: Mass, centre and inertia by name of the URDF's link.
        pelvis: Its motion.
        joints: Motion by joint name; a joint that is left out is locked at zero.
        wrenches: By `left_foot`, `right_foot`: `(n, 6)` of the ground on the foot, force, then moment about
            the world's origin [N, N m].
        hip_order: Order of the hip joints.
        toes: Whether the feet have toe joints.

    Raises:
        DescriptionError: A shape differs, or a number is not finite.
        UnknownNameError: There is no such foot, joint or order of the hip joints, or a link has no inertia.
    """
    links = links_with_toes(body, hip_order, toes=toes)
    _check([link.name for link in links], pelvis, joints, wrenches)
    for name, inertia in table("inertias", inertias).items():
        if not isinstance(inertia, Inertial):
            raise DescriptionError(f"the inertia of {name} is no Inertial; one is accepted")
    masses = moving_masses(body, inertias, hip_order, toes=toes)
    still = np.zeros(len(pelvis.pose))
    motions = {PELVIS: _of_pelvis(pelvis)}
    for link in links:
        state = joints.get(link.name, JointState(still, still, still))
        motions[link.name] = _outwards(link, motions[link.mother], state)
    needed = {name: _taken(masses[name], motion) for name, motion in motions.items()}
    for foot, wrench in wrenches.items():
        ankle = f"{foot.removesuffix('_foot')}_{chain(hip_order)[-1]}"
        needed[ankle] = needed[ankle] - wrench
    torques = {}
    for link in reversed(links):  # all moments about the world's origin: they add up
        force, moment = needed[link.name][:, :3], needed[link.name][:, 3:]
        motion = motions[link.name]
        about_joint = moment - np.cross(motion.p, force)
        torques[link.name] = np.einsum("ni,ni->n", motion.R @ link.axis, about_joint)
        needed[link.mother] = needed[link.mother] + needed[link.name]
    force, moment = needed[PELVIS][:, :3], needed[PELVIS][:, 3:]
    return Needed(np.hstack([force, moment - np.cross(pelvis.pose[:, :3, 3], force)]), torques)


def _check(
    known: Sequence[str], pelvis: PelvisState, joints: Mapping[str, JointState], wrenches: Mapping[str, Array]
) -> None:
    """Refuse arrays of other shapes, and numbers that are not finite.

    Args:
        known: Names of the joints.
        pelvis: Its motion.
        joints: Motion by joint name.
        wrenches: By foot.
    """
    n = len(real("pose of the pelvis", pelvis.pose, ("n", 4, 4)))
    for what, values in (("velocity", pelvis.velocity), ("acceleration", pelvis.acceleration)):
        real(f"{what} of the pelvis", values, (n, 6))
    for name, state in table("joints", joints).items():
        word("joint", name, known)
        if not isinstance(state, JointState):
            raise DescriptionError(f"the motion of {name} is no JointState; one is accepted")
        for what, values in state._asdict().items():
            real(f"{what} of {name}", values, (n,))
    for foot, wrench in table("wrenches", wrenches).items():
        real(f"wrench on the {word('foot', foot, FEET)}", wrench, (n, 6))


def _of_pelvis(pelvis: PelvisState) -> _LinkMotion:
    T, v, a = pelvis
    return _LinkMotion(T[:, :3, :3], T[:, :3, 3], v[:, 3:], a[:, 3:], a[:, :3])


def _outwards(link: Link, mother: _LinkMotion, state: JointState) -> _LinkMotion:
    """The motion of a link from its mother's: Eq. 3, then its derivatives."""
    own = joint_pose(link, state.q)  # Eq. 1
    R = mother.R @ own[:, :3, :3]
    arm = mother.R @ link.offset
    axis = R @ link.axis
    turn = axis * state.dq[:, None]
    dw = mother.dw + axis * state.ddq[:, None] + np.cross(mother.w, turn)
    a = mother.a + np.cross(mother.dw, arm) + np.cross(mother.w, np.cross(mother.w, arm))
    return _LinkMotion(R, mother.p + arm, mother.w + turn, dw, a)


def _taken(part: Inertial, motion: _LinkMotion) -> Array:
    """`(n, 6)` force and moment about the world's origin that a link's motion takes, its weight included."""
    R, p, w, dw, a = motion
    arm = R @ part.centre
    centre = a + np.cross(dw, arm) + np.cross(w, np.cross(w, arm))
    force = part.mass * (centre + _LIFT)
    inertia = R @ part.inertia @ np.swapaxes(R, 1, 2)
    spin = np.einsum("nij,nj->ni", inertia, w)
    moment = np.einsum("nij,nj->ni", inertia, dw) + np.cross(w, spin)
    return np.hstack([force, moment + np.cross(p + arm, force)])
