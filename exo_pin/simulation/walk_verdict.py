"""The verdict on a run: it walks, stumbles, falls or diverges; and the numbers behind it."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any, Literal

import numpy as np

from exo_pin.anatomy import JOINTS, SIDES
from exo_pin.arrays import Array, Mask
from exo_pin.errors import GaitError
from exo_pin.robot.gait_columns import in_joint_order
from exo_pin.simulation.simulated_walk import SimulatedWalk

VerdictWord = Literal["walks", "stumbles", "falls", "diverges"]

CONTACT_FORCE = 20.0
"""A foot touches the floor from this vertical force on [N]."""

_SWING_CONTACT, _CARRIED, _TRACKING, _SATURATED = 2.0, 0.85, 20.0, 30.0
"""Largest contact in swing [% of it], least weight on the legs [part], largest error [deg], longest time of a
motor at its limit [%]."""

_HANGS, _LOW, _TILTED = 0.5, 0.6, 45.0
"""Falls: the legs carry less of the weight; a free pelvis is lower than this part of its planned height, or
tilted by more [deg]."""


@dataclass(frozen=True)
class Verdict:
    """The verdict on a run.

    Attributes:
        word: `"walks"`, `"stumbles"`, `"falls"` or `"diverges"`.
        why: The reason in words; what holds for a walk.
    """

    word: VerdictWord
    why: str


@dataclass(frozen=True)
class Numbers:
    """Numbers of a run, on whole cycles from the second on (a free pelvis: the whole run).

    Attributes:
        tracking_rms_deg: Joint angles against the walk, all driven joints together.
        tracking_max_deg: The largest of them.
        swing_contact_percent: By side, time of contact during the walk's swing.
        vertical_force_mean_bw: On both feet, in weights of the robot.
        peak_torque: By joint, of its motor [N m].
        motor_rms: By joint [N m].
        saturated: By joint, percent of steps at the motor's limit; those above 0 alone.
        motor_share: Of motors in the torques of motors and person.
    """

    tracking_rms_deg: float
    tracking_max_deg: float
    swing_contact_percent: dict[str, float]
    vertical_force_mean_bw: float
    peak_torque: dict[str, float]
    motor_rms: dict[str, float]
    saturated: dict[str, float]
    motor_share: float

    def facts(self) -> dict[str, Any]:
        """Plain values for JSON; NaN where a run has no such number."""
        return {_KEYS.get(name, name): value for name, value in asdict(self).items()}


_KEYS = {"peak_torque": "peak_torque_Nm", "motor_rms": "motor_rms_Nm"}
"""Names in JSON of what has a unit."""


def numbers(run: SimulatedWalk) -> Numbers:
    """The numbers of a run."""
    rows = counted(run)
    driven = driven_joints(run)
    error = np.degrees(run.q - run.reference.q[: len(run.q)])[rows][:, driven]
    motor, person = run.motor[rows][:, driven], run.person[rows][:, driven]
    names = [JOINTS[k] for k in np.flatnonzero(driven)]
    effort = np.array([run.robot.effort[run.robot.joints.index(name)] for name in names])
    at_limit = 100.0 * (np.abs(motor) >= effort).mean(axis=0) if run.plant.limits else np.zeros(len(names))
    both = np.abs(motor).sum() + np.abs(person).sum()
    return Numbers(
        tracking_rms_deg=float(np.sqrt(np.mean(error**2))),
        tracking_max_deg=float(np.abs(error).max()),
        swing_contact_percent={
            side: float(max(_swing_contact(run, k, rows), default=np.nan)) for k, side in enumerate(SIDES)
        },
        vertical_force_mean_bw=float(run.floor.force[rows, :, 2].sum(axis=1).mean() / run.weight),
        peak_torque=dict(zip(names, np.abs(motor).max(axis=0).tolist(), strict=True)),
        motor_rms=dict(zip(names, np.sqrt(np.mean(motor**2, axis=0)).tolist(), strict=True)),
        saturated={name: float(p) for name, p in zip(names, at_limit, strict=True) if p > 0.0},
        motor_share=float(np.abs(motor).sum() / both) if both else float("nan"),
    )


def verdict(run: SimulatedWalk, found: Numbers) -> Verdict:
    """The verdict on a run with these numbers."""
    if run.ended:
        return Verdict("diverges", f"{run.ended} at {run.time[-1]:.2f} s")
    fallen = _fallen(run)
    if fallen:
        return Verdict("falls", fallen)
    wanted = 1.0 - run.body_weight_support
    contact = max(found.swing_contact_percent.items(), key=lambda pair: pair[1])
    most = max(found.saturated.items(), key=lambda pair: pair[1], default=("", 0.0))
    reasons = []
    if contact[1] > _SWING_CONTACT:
        reasons.append(f"the {contact[0]} foot scuffs in {contact[1]:.1f} % of its swing")
    if found.vertical_force_mean_bw < _CARRIED * wanted:
        reasons.append(f"the legs carry {found.vertical_force_mean_bw:.2f} of {wanted:.2f} weights")
    if found.tracking_max_deg > _TRACKING:
        reasons.append(f"a joint is {found.tracking_max_deg:.0f} deg off the walk")
    if most[1] > _SATURATED:
        reasons.append(f"the motor of {most[0]} is at its limit in {most[1]:.0f} % of the time")
    if reasons:
        return Verdict("stumbles", "; ".join(reasons))
    return Verdict(
        "walks",
        f"{found.tracking_rms_deg:.2f} deg rms off the walk, the legs carry "
        f"{found.vertical_force_mean_bw:.2f} of {wanted:.2f} weights, swing contact {contact[1]:.1f} %",
    )


def counted(run: SimulatedWalk) -> slice:
    """The steps that count: from the second cycle on, all of a recording and of a free pelvis."""
    if not run.gait.periodic or run.support.free:
        return slice(None)
    cycle = round(run.gait.duration / run.timestep)
    return slice(cycle if len(run.time) > cycle + 1 else 0, None)


def driven_joints(run: SimulatedWalk) -> Mask:
    """`(12,)` which joints have a motor."""
    return np.asarray(in_joint_order(run.robot.joints, run.robot.effort) > 0.0)


def _swing_contact(run: SimulatedWalk, foot: int, rows: slice) -> list[float]:
    """Percent of each cycle's swing in which the foot touches the floor."""
    time, touching = run.time[rows], run.floor.force[rows, foot, 2] > CONTACT_FORCE
    try:
        stance = run.gait.stance(SIDES[foot])
    except GaitError:
        return []
    walk = run.gait
    within = time % walk.duration if walk.periodic else time
    sample = np.searchsorted(walk.time - walk.time[0], within + 1e-9, side="right") - 1
    swing = ~stance[sample]
    cycle = (time / walk.duration + 1e-9).astype(int) if walk.periodic else np.zeros(len(time), dtype=int)
    return [
        100.0 * float(touching[swing & (cycle == k)].mean())
        for k in np.unique(cycle)
        if (swing & (cycle == k)).any()
    ]


def _fallen(run: SimulatedWalk) -> str:
    """Why the run counts as a fall; empty if it does not."""
    if run.support.free:
        return _down(run)
    weight = (1.0 - run.body_weight_support) * run.weight
    for k, carried in enumerate(_by_cycle(run, run.floor.force[:, :, 2].sum(axis=1))):
        if carried < _HANGS * weight:
            return (
                f"in cycle {k + 1} the legs carry {carried / run.weight:.2f} weights: it hangs in its support"
            )
    return ""


def _down(run: SimulatedWalk) -> str:
    """When a free pelvis is down."""
    planned = run.reference.base[: len(run.time), 2, 3]
    low = run.base[:, 2, 3] < _LOW * planned
    tilted = run.base[:, 2, 2] < np.cos(np.radians(_TILTED))
    for what, mask in (("the pelvis is down", low), ("the pelvis tilts over", tilted)):
        if mask.any():
            return f"{what} at {run.time[np.argmax(mask)]:.2f} s"
    return ""


def _by_cycle(run: SimulatedWalk, values: Array) -> list[float]:
    """Means over whole cycles; over the whole of a recording."""
    if not run.gait.periodic:
        return [float(values.mean())]
    cycle = round(run.gait.duration / run.timestep)
    return [float(values[k : k + cycle].mean()) for k in range(0, len(values) - cycle + 1, cycle)]
