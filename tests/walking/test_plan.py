"""Planned walks: feet where they belong, a ZMP that a second path confirms, forces that leave nothing."""

import dataclasses
import math

import numpy as np
import pinocchio as pin
import pytest

from exo_pin.anatomy import CORNERS, FEET, Body
from exo_pin.errors import GaitError
from exo_pin.formats import load_gait, save_gait
from exo_pin.kinematics import poses
from exo_pin.robot import load_robot
from exo_pin.walking import Footsteps, footsteps, plan_walk


def momenta(plan):
    """Centre of mass, and angular momentum about it, by Pinocchio's centroidal map at every sample."""
    model, moving = plan.floating.model, plan.body.motion
    data = model.createData()
    com, angular = np.empty((2, len(moving.q), 3))
    for k, (q, v) in enumerate(zip(moving.q, moving.v, strict=True)):
        momentum = pin.computeCentroidalMomentum(model, data, q, v)
        com[k], angular[k] = data.com[0], momentum.angular
    return com, angular


def test_the_zmp_is_that_of_the_momenta_of_the_whole_body(plan):
    com, angular = momenta(plan)
    dt, mass = plan.gait.time[1], plan.dynamics.mass
    acceleration = np.gradient(np.gradient(com, dt, axis=0), dt, axis=0)
    change = np.gradient(angular, dt, axis=0)
    fz = mass * (acceleration[:, 2] + 9.81)
    x = com[:, 0] - (mass * com[:, 2] * acceleration[:, 0] + change[:, 1]) / fz
    y = com[:, 1] - (mass * com[:, 2] * acceleration[:, 1] - change[:, 0]) / fz
    off = np.abs(np.stack([x, y], axis=1) - plan.zmp)
    # derivatives over 10 ms instead of 5 differ where a phase begins; elsewhere they agree
    assert np.quantile(off, 0.9) < 1e-3
    assert off.max() < 0.02


def test_the_zmp_follows_the_path_that_is_asked_for(plan):
    forward, sideways = plan.zmp_rms
    assert forward < 0.003
    assert sideways < 0.0015
    assert plan.missed_frames == 0


def test_a_good_plan_has_its_zmp_inside_the_soles_and_its_joints_within_their_limits(plan):
    assert plan.ok
    assert plan.reasons == ()
    assert plan.margins.min() > 0.02
    assert not any(demand.position.outside.any() for demand in plan.demands)


def test_standing_feet_do_not_move_and_no_sole_goes_below_the_ground(plan):
    gait, robot = plan.gait, plan.robot
    corners = poses(robot, robot.from_gait(gait), CORNERS, base=gait.base)[..., :3, 3].reshape(-1, 2, 4, 3)
    assert corners[..., 2].min() > -1e-9
    for k, side in enumerate(("left", "right")):
        down = gait.stance(side)
        both = down[1:] & down[:-1]
        assert np.abs(np.diff(corners[:, k], axis=0)[both]).max() < 1e-9
        assert np.abs(corners[down, k, :, 2]).max() < 1e-9


def test_the_feet_land_on_their_footsteps(plan):
    reached = poses(plan.robot, plan.robot.from_gait(plan.gait), FEET, base=plan.gait.base)
    for step, event in zip(
        plan.footsteps.steps, [e for e in plan.gait.events if e.kind == "heel_strike"], strict=True
    ):
        k = int(np.searchsorted(plan.gait.time, event.time))
        place = reached[k, ("left", "right").index(step.side), :2, 3]
        assert event.side == step.side
        assert np.hypot(*(place - [step.x, step.y])) < 1e-9


def test_the_ground_forces_leave_nothing_for_a_support_of_the_pelvis(plan):
    found = plan.dynamics
    assert np.abs(found.support_wrench).max() < 1e-8 * found.weight_force
    assert found.ground.force[..., 2].min() >= 0.0  # the ground does not pull
    assert np.abs(found.ground.force.sum(axis=1)[0] - [0, 0, found.weight_force]).max() < 0.05  # N


def test_from_rest_to_rest_the_ground_gives_no_momentum(plan):
    force = plan.dynamics.ground.force.sum(axis=1) - [0.0, 0.0, plan.dynamics.weight_force]
    impulse = np.trapezoid(force, plan.gait.time, axis=0)
    assert np.abs(impulse).max() < 1e-3 * plan.dynamics.mass  # 1 mm/s
    assert np.abs(plan.gait.dq[[0, -1]]).max() < 1e-3


def test_mirrored_steps_give_the_mirrored_walk(robot, plan):
    other = plan_walk(robot, plan.footsteps.mirrored())
    mirrored = plan.gait.mirrored()
    assert np.abs(other.gait.q - mirrored.q).max() < 1e-9
    assert np.abs(other.gait.base - mirrored.base).max() < 1e-9
    assert [(e.time, e.side) for e in other.gait.events] == [(e.time, e.side) for e in mirrored.events]


def turned(walk, angle):
    c, s = math.cos(angle), math.sin(angle)

    def moved(foot):
        return dataclasses.replace(
            foot,
            x=c * foot.x - s * foot.y + 1.0,
            y=s * foot.x + c * foot.y - 2.0,
            heading=foot.heading + angle,
        )

    left, right = map(moved, walk.start)
    return dataclasses.replace(walk, start=(left, right), steps=tuple(map(moved, walk.steps)))


def test_turning_the_world_turns_the_plan(robot, plan):
    other = plan_walk(robot, turned(plan.footsteps, 2.5))
    assert np.abs(other.gait.q - plan.gait.q).max() < 1e-7
    assert np.abs(other.dynamics.torque - plan.dynamics.torque).max() < 1e-3


@pytest.mark.parametrize(
    ("stature", "length", "turn"), [(1.55, 0.27, 0.0), (1.75, 0.25, math.radians(10.0)), (1.95, 0.33, 0.0)]
)
def test_bodies_and_steps_of_the_table_fit_the_default_limits(stature, length, turn):
    robot = load_robot(Body.from_stature(stature))
    found = plan_walk(robot, footsteps(8, length, turn=turn, width=robot.body.hip_width))
    assert found.missed_frames == 0
    assert found.ok, found.reasons
    assert found.zmp_rms[0] < 0.003
    assert found.zmp_rms[1] < 0.0015


def test_the_written_walk_is_the_walk(plan, tmp_path):
    save_gait(plan.gait, tmp_path / "walk.csv")
    read = load_gait(tmp_path / "walk.csv")
    assert np.abs(read.q - plan.gait.q).max() < 1e-9
    assert np.abs(read.base - plan.gait.base).max() < 1e-9
    assert read.events == plan.gait.events


@pytest.mark.parametrize(
    ("steps", "said"),
    [
        ({"length": 0.6}, "steps up to 0.3"),
        ({"clearance": 0.4}, "not even steps on the spot fit"),
        ({"width": 0.05}, "too close"),
        ({"step_time": 0.2}, "step time is 0.2 s; at least 0.30"),
        ({"length": 1.5, "step_time": 0.4}, "at least 0.50"),
        ({"double_support": 0.01}, "double support lasts 8 ms"),
        ({"double_support": 0.99}, "single support lasts 8 ms"),
    ],
)
def test_steps_that_cannot_be_taken_are_refused_in_words(robot, steps, said):
    with pytest.raises(GaitError, match=said):
        plan_walk(robot, footsteps(3, **({"width": robot.body.hip_width} | steps)))


def test_the_length_that_fits_does_fit(robot):
    with pytest.raises(GaitError, match=r"steps up to (0\.\d\d) m ahead fit") as refusal:
        plan_walk(robot, footsteps(3, 0.5, width=robot.body.hip_width))
    length = float(str(refusal.value).split("steps up to ")[1].split(" ")[0])
    assert plan_walk(robot, footsteps(3, length, width=robot.body.hip_width)).missed_frames == 0


def test_crossing_feet_are_refused_by_their_step(robot):
    walk = footsteps(3, 0.2, width=robot.body.hip_width)
    crossed = dataclasses.replace(walk.steps[1], y=0.1)
    steps = (walk.steps[0], crossed, *walk.steps[2:])
    with pytest.raises(GaitError, match=r"step 2 \(right foot\)"):
        plan_walk(robot, Footsteps(walk.start, steps))
