"""Inverse dynamics of a walk: the torque of every joint, from motion, masses and ground reaction."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from exo_pin.anatomy.names import Masses, Reaction
from exo_pin.arguments import number, several
from exo_pin.arrays import Array, Mask
from exo_pin.dynamics import ground_reaction, weight_shift
from exo_pin.dynamics.base_motion import Motion, motion
from exo_pin.dynamics.carried_pelvis import carried
from exo_pin.dynamics.floating_robot import floating_robot, mass_of
from exo_pin.dynamics.free_reaction import free_reaction
from exo_pin.dynamics.ground_forces import GroundForces
from exo_pin.dynamics.newton_euler import generalized_forces, in_world_axes
from exo_pin.dynamics.plate_checks import NOTICED, WeightCheck, check_horizontal, check_weight
from exo_pin.dynamics.plate_wrenches import plate_forces
from exo_pin.dynamics.walk_dynamics import RIGID_TRUNK, Dynamics
from exo_pin.errors import GaitError
from exo_pin.gait import Gait
from exo_pin.gait.trial import ForcePlate
from exo_pin.ground import Intervals
from exo_pin.robot import Robot
from exo_pin.robot.gait_columns import in_joint_order
from exo_pin.signals import CUTOFF

_FREE = 6
"""Degrees of freedom of the pelvis, in front of the joints'."""


class _Ground(NamedTuple):
    """The ground reaction of a motion, and where it comes from."""

    forces: GroundForces
    known: Mask
    kind: Reaction
    how: str
    remarks: tuple[str, ...]
    weight: WeightCheck | None


def torques(
    robot: Robot,
    gait: Gait,
    *,
    forces: Iterable[ForcePlate] = (),
    body_weight_support: float = 0.0,
    masses: Masses | None = None,
    cutoff: float | None = CUTOFF,
    free: bool = False,
) -> Dynamics:
    """Joint torques of a walk by inverse dynamics (recursive Newton-Euler).

    With force plates the ground reaction is measured; frames in which a foot stands on no plate are not
    valid. Without them it is predicted, an assumption (`exo_pin.dynamics.ground_reaction`).

    Args:
        robot: Who walks. Any base; its model is loaded with a floating pelvis and the masses.
        gait: The walk; with plates in their world, with the motion of its pelvis.
        forces: Force plates of the same trial, z up.
        body_weight_support: Constant upward force at mid-hip as a part of the weight of the masses, 0 to 1.
        masses: `"wearer"`, `"device"` or `"both"`; None: the wearer's with plates, on which the bare person
            walked, and both without.
        cutoff: Low-pass of a recording's motion [Hz]; None: no filter.
        free: Whether nothing but the ground holds the walk: the predicted reaction is all that the motion
            takes, at its zero-moment point (`exo_pin.dynamics.free_reaction`). Not for plates.

    Raises:
        GaitError: Plates and walk do not belong together, the support is not 0 to 1, or their weights differ
            by 30 % or more.
        DescriptionError: The masses cannot be divided, or the cutoff is not positive.
        UnknownNameError: There are no such masses.
    """
    plates = several("forces", forces)
    number("body-weight support", body_weight_support, least=0.0, most=1.0, error=GaitError)
    chosen = _usual_masses(robot, plates) if masses is None else masses
    model = floating_robot(robot, chosen)
    walk, stance, words = (gait, None, "") if plates else carried(model, gait)
    moving = motion(model, walk, cutoff=cutoff)
    needed = in_world_axes(moving.base, generalized_forces(model, moving))
    weight = mass_of(model) * float(np.abs(model.model.gravity.linear[2]))
    if stance is None:
        support = np.array([0.0, 0.0, body_weight_support * weight])
        ground = _measured(model, gait, plates, needed[:, :3] - support)
    else:
        lifted = needed - np.array([0.0, 0.0, body_weight_support * weight, 0.0, 0.0, 0.0])
        ground = (_free if free else _supported)(model, walk, moving, lifted, stance, words)
    return _result(model, walk, moving, ground, chosen, body_weight_support)


def _supported(
    robot: Robot, walk: Gait, moving: Motion, needed: Array, stance: Intervals, words: str
) -> _Ground:
    """The prediction for a walk whose balance is the support's."""
    share = weight_shift.shares(walk, stance)
    reaction = ground_reaction.predicted(robot, moving, needed[:, 2], share)
    known = np.asarray(np.isfinite(share).all(axis=1))
    return _Ground(reaction, known, "predicted", words, _cut(known), None)


def _free(robot: Robot, walk: Gait, moving: Motion, needed: Array, stance: Intervals, words: str) -> _Ground:
    """The prediction for a walk that nothing but the ground holds."""
    reaction = free_reaction(robot, walk, moving, needed, stance)
    how = "ground reaction predicted (all that the motion takes, at its zero-moment point), not measured"
    return _Ground(reaction, np.ones(len(walk), dtype=bool), "predicted", how, (), None)


def _usual_masses(robot: Robot, plates: tuple[ForcePlate, ...]) -> Masses:
    """A recorded force belongs to the bare person, a predicted one to the wearer of the device."""
    return "wearer" if plates and robot.body is not None and robot.body.wearer else "both"


def _measured(robot: Robot, gait: Gait, plates: tuple[ForcePlate, ...], expected: Array) -> _Ground:
    """The plates' forces; `expected` is the force that the motion needs of them `(n, 3)` [N]."""
    found = plate_forces(robot, gait, plates)
    if not found.known.any():
        raise GaitError(
            f"no frame has the ground reaction of every standing foot: {'; '.join(found.remarks)}"
        )
    vertical = found.ground.force[:, :, 2].sum(axis=1)
    weight = check_weight(vertical[found.known], expected[found.known, 2])
    check_horizontal(found.ground.force.sum(axis=1)[found.known, :2], expected[found.known, :2])
    remarks = found.remarks
    if abs(weight.difference) >= NOTICED:
        remarks = (*remarks, f"{weight}")
    how = f"ground reaction measured by {len(plates)} force plate{'s' if len(plates) > 1 else ''}"
    return _Ground(found.ground, found.known, "measured", how, remarks, weight)


def _cut(known: Mask) -> tuple[str, ...]:
    missing = int((~known).sum())
    why = "a double support begins or ends outside the recording"
    return (f"{missing} of {len(known)} frames are not valid: {why}",) if missing else ()


def _result(
    robot: Robot, walk: Gait, moving: Motion, ground: _Ground, masses: Masses, support: float
) -> Dynamics:
    """The second recursion, with the ground's wrenches; unknown frames become NaN."""
    tau = generalized_forces(robot, moving, np.nan_to_num(ground.forces.wrench))
    tau[~ground.known] = np.nan
    forces = [np.where(ground.known[:, None, None], x, np.nan) for x in dataclasses.astuple(ground.forces)]
    mass = mass_of(robot)
    whose = {"wearer": "the wearer alone", "device": "the device alone", "both": "wearer and device"}[masses]
    return Dynamics(
        time=walk.time,
        torque=in_joint_order(robot.joints, tau[:, _FREE:], missing=np.nan),
        velocity=in_joint_order(robot.joints, moving.v[:, _FREE:], missing=np.nan),
        support_wrench=in_world_axes(moving.base, tau),
        ground=GroundForces(*forces),
        valid=ground.known,
        reaction=ground.kind,
        masses=masses,
        mass=mass,
        body_weight_support=support,
        robot=robot,
        motion=moving,
        weight=ground.weight,
        source=f"inverse dynamics of {walk.source or 'a walk'}; {ground.how}; {mass:.1f} kg of {whose}",
        remarks=(*ground.remarks, RIGID_TRUNK),
    )
