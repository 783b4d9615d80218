"""`plan_walk`: footsteps become a walk of the whole body, its ZMP and its forces, or are refused."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from exo_pin.arguments import MOST_SAMPLES, count, number
from exo_pin.arrays import Array
from exo_pin.demand import JointDemand, joint_demands
from exo_pin.dynamics import Dynamics, floating_robot
from exo_pin.errors import GaitError
from exo_pin.gait import Gait
from exo_pin.kinematics import center_of_mass
from exo_pin.robot import Robot
from exo_pin.walking import feasible_steps
from exo_pin.walking.course import Course, course
from exo_pin.walking.footsteps import Footsteps
from exo_pin.walking.pelvis_height import LegRoom, best_height
from exo_pin.walking.pendulum import com_of_zmp
from exo_pin.walking.planned_forces import planned_dynamics
from exo_pin.walking.sole_shape import on_soles, soles
from exo_pin.walking.support_polygon import zmp_margins
from exo_pin.walking.whole_body import WholeBody, filtered, pelvis_poses

PITCH = math.radians(20.0)
"""Of the swinging foot in mid-swing, toes down: ankles keep within 30 deg in steps of 0.33 m (a choice)."""

LEAST_ROOM = math.radians(0.5)
"""To the nearest joint limit: the dynamics filter moves the pelvis after the height is chosen [rad]."""

_COARSE = 25.0  # samples a second [Hz] at which reach and limits are looked at first


@dataclass(frozen=True, eq=False, repr=False)
class Plan:
    """A planned walk: from standing over its steps to standing, without anything that holds the pelvis.

    Attributes:
        robot: Who walks, with a fixed pelvis.
        floating: The same with a free one, whose dynamics are planned.
        footsteps: The steps.
        course: Times, phases, feet, shares of the weight and the ZMP that is asked for.
        gait: Joint angles, pelvis and events: a walk as any other.
        zmp: `(n, 2)` zero-moment point of the whole moving body [m].
        pelvis_height: Of mid-hip above the ground [m].
        body: The walk of the whole body, and how the inverse kinematics met the feet.
        generation_time: CPU time from the footsteps to the gait [s].
    """

    robot: Robot
    floating: Robot
    footsteps: Footsteps
    course: Course
    gait: Gait
    zmp: Array
    pelvis_height: float
    body: WholeBody
    generation_time: float

    def __repr__(self) -> str:
        return f"<Plan of {len(self.footsteps.steps)} steps, {self.gait!r}>"

    @property
    def missed_frames(self) -> int:
        """Frames whose feet the inverse kinematics missed; `plan_walk` hands on no plan that has any."""
        return int((~self.body.track.converged).sum())

    @property
    def zmp_rms(self) -> tuple[float, float]:
        """Of the ZMP off its path, along the pelvis's heading and across [m]."""
        base, off = self.body.motion.base, self.zmp - self.course.zmp
        seen = np.einsum("nji,nj->ni", base[:, :2, :2], off)
        forward, sideways = np.sqrt((seen**2).mean(axis=0)).tolist()
        return forward, sideways

    @cached_property
    def margins(self) -> Array:
        """`(n,)` how far the ZMP is inside the support polygon; negative outside [m]."""
        corners = on_soles(self.course.paths.feet, soles(self.robot).corners)
        return zmp_margins(self.footsteps, self.course.parts, corners, self.zmp)

    @cached_property
    def com(self) -> Array:
        """`(n, 3)` centre of mass of wearer and device [m]."""
        return center_of_mass(self.floating, self.body.motion.q).position

    @cached_property
    def dynamics(self) -> Dynamics:
        """Ground forces and joint torques."""
        return planned_dynamics(self.floating, self.course, self.body)

    @cached_property
    def demands(self) -> tuple[JointDemand, ...]:
        """What the walk requires of each joint: range, speed, acceleration, torque."""
        return joint_demands(self.robot, self.gait, torques=self.dynamics.to_torques())

    @property
    def reasons(self) -> tuple[str, ...]:
        """Why the plan is not good, a sentence each; none if it is."""
        found = [f"{demand.joint}: {_exceeded(demand)}" for demand in self.demands if not demand.ok]
        least = int(self.margins.argmin())
        if self.margins[least] < 0.0:
            outside = f"the ZMP leaves the soles by {-1e3 * self.margins[least]:.0f} mm"
            found.append(f"{outside} at {self.gait.time[least]:.2f} s")
        return tuple(found)

    @property
    def words(self) -> str:
        """The steps, in words."""
        return self.footsteps.words

    def facts(self) -> dict[str, Any]:
        """Plain values for JSON; units as the keys say, limits in degrees as `exo-pin check` has them."""
        forward, sideways = self.zmp_rms
        return {
            "frames": len(self.gait),
            "missed_frames": self.missed_frames,
            "duration_s": self.gait.duration,
            "steps": len(self.footsteps.steps),
            "zmp_rms_mm": {"forward": 1e3 * forward, "sideways": 1e3 * sideways},
            "polygon_margin_min_mm": 1e3 * float(self.margins.min()),
            "pelvis_height_m": self.pelvis_height,
            "generation_s": self.generation_time,
            "limits": {demand.joint: _limit_facts(demand) for demand in self.demands},
            "ok": self.ok,
            "reasons": list(self.reasons),
        }

    @property
    def ok(self) -> bool:
        """Whether every joint keeps its limits and the ZMP stays inside the soles."""
        return not self.reasons


def plan_walk(
    robot: Robot,
    walk: Footsteps,
    *,
    rate: float = 200.0,
    rest: float = 0.7,
    pitch: float = PITCH,
    passes: int = 2,
) -> Plan:
    """Plan a walk over footsteps.

    Args:
        robot: Who walks: a fixed pelvis, two legs of six joints with a closed form.
        walk: The footsteps.
        rate: Samples a second [Hz].
        rest: Time of standing still before and after [s].
        pitch: Of the swinging foot in mid-swing, toes down [rad].
        passes: Of the dynamics filter.

    Raises:
        GaitError: Feet touch or cross, the steps are too quick, or out of reach; the message says which step
            and what fits.
        DescriptionError: A number is not accepted, or a leg has no closed form.
        UnknownNameError: The robot has no feet.
    """
    started = time.process_time()
    rate = number("rate", rate, least=50.0, most=2000.0)
    rest = number("rest", rest, least=0.1, most=60.0)
    pitch = number("pitch [rad]", pitch, least=0.0, most=math.radians(45.0))
    passes = count("passes", passes, 0, 10)
    feasible_steps.check_time(walk, float(robot.placement[2, 3]), rate)
    if (len(walk.steps) + 2) * walk.step_time * rate > MOST_SAMPLES:
        raise GaitError(f"{len(walk.steps)} steps at {rate:g} Hz are more than {MOST_SAMPLES} samples")
    sole, floating, com = soles(robot), floating_robot(robot), _standing_com(robot)
    style = {"height": com[2] + robot.placement[2, 3], "rest": rest, "pitch": pitch}

    def coarse(steps: Footsteps) -> tuple[Course, LegRoom]:
        plan = course(steps, sole, rate=_COARSE, **style)
        return plan, best_height(robot, plan.paths.feet, _pelvis(robot, plan, 1.0))

    plan, tight = coarse(walk)
    feasible_steps.check_feet_apart(walk, plan, sole)
    feasible_steps.check_reach(walk, plan, tight, LEAST_ROOM, lambda steps: coarse(steps)[1].room)
    plan = course(walk, sole, rate=rate, **style)
    body = filtered(robot, floating, plan, _pelvis(robot, plan, tight.height), rest=rest, passes=passes)
    _check_met(walk, plan, body)
    gait = replace(body.gait, source=f"planned walk: {walk.words}")
    taken = time.process_time() - started
    return Plan(robot, floating, walk, plan, gait, body.zmp, tight.height, body, taken)


def _pelvis(robot: Robot, plan: Course, height: float) -> Array:
    """`(n, 4, 4)` the pelvis over the pendulum's path, as far behind the centre of mass as in standing."""
    own = _standing_com(robot)
    com = com_of_zmp(plan.zmp, float(plan.time[1]), float(robot.placement[2, 3] + own[2]))
    base = pelvis_poses(com, height, plan.paths.heading.mean(axis=1))
    base[:, :2, 3] -= base[:, :2, :2] @ own[:2]
    return base


def _standing_com(robot: Robot) -> Array:
    """`(3,)` the centre of mass on straight legs, as the pelvis sees it [m]."""
    return center_of_mass(robot, robot.neutral).position - robot.placement[:3, 3]


def _check_met(walk: Footsteps, plan: Course, body: WholeBody) -> None:
    missed = np.flatnonzero(~body.track.converged)
    if missed.size:
        step = feasible_steps.step_words(walk, plan, int(missed[0]))
        raise GaitError(
            f"{step} is at the edge of reach: {missed.size} of {len(plan.time)} frames miss a foot at "
            f"{plan.time[missed[0]]:.2f} s; take shorter steps"
        )


def _limit_facts(demand: JointDemand) -> dict[str, Any]:
    """Range, speed and torque of a joint; the first three keys as in `exo-pin check`."""
    return {
        "min": math.degrees(demand.position.lowest),
        "max": math.degrees(demand.position.highest),
        "violated_frames": demand.position.samples_outside,
        "peak_deg_s": math.degrees(demand.speed.peak),
        "peak_Nm": None if demand.torque is None else demand.torque.peak,
    }


def _exceeded(demand: JointDemand) -> str:
    """Which of its limits a joint exceeds."""
    if demand.position.outside.any():
        return f"{math.degrees(-demand.position.margin):.1f} deg beyond its range"
    peaks = {
        "rad/s": demand.speed,
        "rad/s^2": demand.acceleration,
        "N m": demand.torque,
    }
    return ", ".join(
        f"{peak.peak:.0f} {unit} of {peak.available:g}"
        for unit, peak in peaks.items()
        if peak is not None and peak.exceeded.any()
    )
