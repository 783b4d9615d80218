"""Sentences about a walk on a robot: joints that are held, feet that are missed, speeds beyond the file's."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from exo_pin.anatomy import JOINTS
from exo_pin.retarget.feet import fastest_turn
from exo_pin.retarget.leg_search import arm_joints
from exo_pin.retarget.retargeted import Retargeted
from exo_pin.retarget.robot_legs import RobotLeg

_SAID_PLACE = 1e-5
"""An ankle further from its place than this is said [m]."""

_SAID_TURN = math.radians(0.05)
"""A foot turned away from its attitude by more than this is said [rad]."""

_MOST_NAMES = 8
"""Names in one sentence; the others are counted."""


def findings(walk: Retargeted) -> tuple[str, ...]:
    """What to know about the robot's description and this walk on it, a sentence each."""
    biped = walk.biped
    return (
        *walk.robot.remarks,
        *_held(biped.legs, walk.robot.joints),
        *_shared(walk),
        *(said for leg in biped.legs for said in _of_leg(leg)),
        *_knees(walk),
        *_feet(walk),
        *_paths(walk),
        *_jumps(walk),
        *_speeds(walk),
    )


def _held(legs: Iterable[RobotLeg], known: Iterable[str]) -> list[str]:
    """Joints of the legs that stay as they stand, by reason."""
    by_reason: dict[str, list[str]] = {}
    for leg in legs:
        for name, why in leg.held.items():
            by_reason.setdefault(why, []).append(name)
    return [f"held as the robot stands: {_names(names)} ({why})" for why, names in by_reason.items()]


def _shared(walk: Retargeted) -> list[str]:
    """Joints that carry both legs."""
    robot, legs = walk.robot, walk.biped.legs
    paths = [set(robot.model.supports[robot.model.getJointId(leg.chain[0])]) for leg in legs]
    own = {robot.model.getJointId(name) for leg in legs for name in (*leg.chain, *leg.held)}
    shared = [str(robot.model.names[j]) for j in sorted(paths[0] & paths[1] - own - {0})]
    return [f"held as the robot stands: {_names(shared)} (both legs hang on it)"] if shared else []


def _of_leg(leg: RobotLeg) -> list[str]:
    """Followers of a leg's joints, and legs that are arms by their names."""
    found = []
    followers = [name for name in leg.chain if name not in leg.joints]
    if followers:
        found.append(f"{leg.side} leg: {_names(followers)} follows another joint, as its <mimic> says")
    arms = arm_joints((*leg.chain, *leg.held))
    if arms:
        found.append(f"{leg.side} leg: by their names its joints are an arm's ({_names(arms)})")
    return found


def _knees(walk: Retargeted) -> list[str]:
    """Knees that bend the other way, or less than the walk asks for."""
    legs, found = walk.biped.legs, []
    if all(leg.branch == "behind" for leg in legs):
        names = _names(leg.joints[leg.knee] for leg in legs)
        found.append(
            f"{names} bend forward only, as a bird's: the knees stay behind the line from hip to ankle"
        )
    for leg in legs:
        asked = float(walk.gait.q[:, JOINTS.index(f"{leg.side}_knee_flexion")].max())
        ratio = float(leg.drive[:, leg.knee].sum())
        bend = leg.knee_range[0 if leg.branch == "front" else 1] * abs(ratio)
        if bend < asked:
            found.append(
                f"{leg.joints[leg.knee]} bends by {math.degrees(bend):.0f} deg at most; "
                f"the person's knee by {math.degrees(asked):.0f}"
            )
    return found


def _feet(walk: Retargeted) -> list[str]:
    """By how much ankles miss their places and feet their attitudes."""
    found = []
    for k, leg in enumerate(walk.biped.legs):
        place, turn = walk.errors.position[:, k], walk.errors.rotation[:, k]
        if place.max() > _SAID_PLACE:
            found.append(
                f"{leg.side} ankle: up to {1e3 * place.max():.3g} mm off its place, "
                f"{_samples(place > _SAID_PLACE)}{_at_limits(walk, leg, place > _SAID_PLACE)}"
            )
        if turn.max() > _SAID_TURN:
            found.append(
                f"{leg.side} foot: up to {math.degrees(turn.max()):.1f} deg off the person's attitude, "
                f"{_samples(turn > _SAID_TURN)}{_lacking(walk, leg, turn > _SAID_TURN)}"
            )
    return found


def _lacking(walk: Retargeted, leg: RobotLeg, where: np.ndarray) -> str:
    """Why a foot lacks its attitude: too few joints, or limits."""
    if not leg.reaches_any_pose:
        return f" (its leg has {len(leg.joints)} joints; six give any attitude)"
    return _at_limits(walk, leg, where)


def _at_limits(walk: Retargeted, leg: RobotLeg, where: np.ndarray) -> str:
    """The joints of a leg that are at a limit in these samples."""
    columns = [walk.robot.column(name) for name in leg.joints]
    q = walk.q[where][:, columns] - walk.biped.stand[columns]
    lower, upper = leg.allowed.T
    stuck = ((q - lower < 1e-6) | (upper - q < 1e-6)).any(axis=0)
    names = [name for name, there in zip(leg.joints, stuck, strict=True) if there]
    return f" (at a limit: {_names(names)})" if names else ""


def _samples(where: np.ndarray) -> str:
    return f"in {int(where.sum())} of {len(where)} samples"


def _paths(walk: Retargeted) -> list[str]:
    """Whether the paths are smaller than the legs' reach allows."""
    body, legs = walk.body, walk.biped.legs
    size = body.leg(legs[0].side)
    share = walk.scale[0] * (size.thigh + size.shank) / legs[0].reach
    if share > 1 - 1e-6:
        return []
    return [
        f"the feet's paths are {share:.2f} of what the legs' reach allows: more, and the feet miss by more"
    ]


def _jumps(walk: Retargeted) -> list[str]:
    """Joints that turn too far between two samples."""
    return [
        f"{name} turns by {math.degrees(step):.1f} deg between two samples; the person's fastest joint by "
        f"{math.degrees(fastest_turn(walk.gait)):.1f}"
        for name, step, jump in zip(walk.joints, walk.largest_steps, walk.jumps, strict=True)
        if jump
    ]


def _speeds(walk: Retargeted) -> list[str]:
    """Joints that are asked beyond the speed that the file states."""
    beyond = [
        f"{name} {use.speed.peak:.2f} of {use.speed.available:.2f}"
        for name, use in walk.limit_use.items()
        if use.speed.exceeded.any()
    ]
    return [f"faster than the file's speed limits [rad/s]: {', '.join(beyond)}"] if beyond else []


def _names(names: Iterable[str]) -> str:
    every = list(names)
    more = f" and {len(every) - _MOST_NAMES} more" if len(every) > _MOST_NAMES else ""
    return ", ".join(every[:_MOST_NAMES]) + more
