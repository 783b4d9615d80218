"""Dragged feet: which requests of the page are understood, and whether the answers are true."""

from __future__ import annotations

import json
import time

import numpy as np
import pinocchio as pin
import pytest

from exo_pin import viewer
from exo_pin.compare import compare, dressed
from exo_pin.gait import normative_gait
from exo_pin.kinematics import poses
from exo_pin.robot import load_urdf
from exo_pin.viewer.live import messages
from exo_pin.viewer.live.foot_drag import ROTATION_WEIGHT, TOLERANCE, reach_solver

FEET = ("left_foot", "right_foot")
EXACT = 1e-6  # [m, rad]: what "reached" promises
QUICK = 0.1  # [s] of a processor; measured 1 to 10 ms


@pytest.fixture(scope="module")
def scene(robot):
    return viewer.scene(robot, normative_gait(), wearer=False)


@pytest.fixture(scope="module")
def names(scene):
    return [joint.name for joint in scene.facts.chains[0].joints]


def chain_q(robot, names, q):
    return [float(q[robot.column(name)]) for name in names]


def robot_q(robot, names, values):
    q = robot.neutral
    for name, value in zip(names, values, strict=True):
        q[robot.column(name)] = value
    return q


def request(robot, names, T_world_feet, q, number=3):
    T = np.linalg.inv(robot.placement) @ T_world_feet
    feet = {name: pin.SE3ToXYZQUAT(pin.SE3(pose)).tolist() for name, pose in zip(FEET, T, strict=True)}
    return {"type": "reach", "id": number, "feet": feet, "q": chain_q(robot, names, q)}


def answered(robot, scene, names, content):
    found = messages.reach_request(messages.read(json.dumps(content)), scene.facts)
    assert found is not None
    return reach_solver(robot, names)(found)


def test_the_feet_reach_their_targets(robot, scene, names, rng):
    gait_q = robot.from_gait(normative_gait())
    for k in range(40):
        targets = poses(robot, rng.uniform(robot.lower, robot.upper))
        answer = answered(robot, scene, names, request(robot, names, targets, gait_q[k], number=k))
        assert answer.id == k
        assert answer.misses == {"left_foot": (0, 0), "right_foot": (0, 0)}
        found = robot_q(robot, names, answer.q)
        assert poses(robot, found) == pytest.approx(targets, abs=EXACT)
        assert not robot.outside(found).any()


def test_a_foot_out_of_reach_goes_as_near_as_it_can_and_its_miss_is_measured(robot, scene, names, rng):
    q = robot.from_gait(normative_gait())[20]
    feet = poses(robot, q)
    for shift in ([0.9, 0, 0], [0, 0.6, 0.3], [0, 0, -0.2]):
        targets = feet.copy()
        targets[0, :3, 3] += shift
        answer = answered(robot, scene, names, request(robot, names, targets, q))
        found = robot_q(robot, names, answer.q)
        assert not robot.outside(found).any()
        reached = poses(robot, found)
        distance = np.linalg.norm(reached[0, :3, 3] - targets[0, :3, 3])
        angle = np.linalg.norm(pin.log3(reached[0, :3, :3].T @ targets[0, :3, :3]))
        assert answer.misses["left_foot"] == pytest.approx((distance, angle), abs=1e-9)
        assert distance + angle > TOLERANCE
        assert answer.misses["right_foot"] == (0, 0)  # the other foot stays
        assert reached[1] == pytest.approx(feet[1], abs=EXACT)
        for _ in range(30):  # no neighbour within the limits is nearer
            near = np.clip(found + rng.normal(0, 0.02, robot.nq), robot.lower, robot.upper)
            T = poses(robot, near)[0]
            turn = np.linalg.norm(pin.log3(T[:3, :3].T @ targets[0, :3, :3]))
            other = np.hypot(np.linalg.norm(T[:3, 3] - targets[0, :3, 3]), ROTATION_WEIGHT * turn)
            assert other > np.hypot(distance, ROTATION_WEIGHT * angle) - EXACT


def test_a_nearly_reached_foot_does_not_jump(robot, scene, names):
    q = robot.from_gait(normative_gait())[40]
    targets = poses(robot, q)
    before = np.array(chain_q(robot, names, q))
    for _ in range(60):  # from within reach to far outside, 1 cm at a time
        targets[0, 2, 3] -= 0.01
        answer = answered(robot, scene, names, request(robot, names, targets, robot_q(robot, names, before)))
        now = np.array(answer.q)
        assert np.abs(now - before).max() < 0.6  # the knee straightens fast near the end of its reach
        before = now


def test_an_answer_comes_quickly(robot, scene, names):
    q = robot.from_gait(normative_gait())[20]
    targets = poses(robot, q)
    targets[0, :3, 3] += [0.3, 0.2, 0.9]
    content = messages.reach_request(request(robot, names, targets, q), scene.facts)
    solve = reach_solver(robot, names)

    def cost():
        start = time.process_time()  # not by the wall clock: the machine may be busy
        solve(content)
        return time.process_time() - start

    assert min(cost() for _ in range(3)) < QUICK


@pytest.mark.parametrize("device", ["lokomat", "lopes8", "h2"])
def test_devices_with_fewer_joints_answer_too(device):
    gait = normative_gait()
    motion = compare(gait, [device]).best[0].motion
    robot = dressed(motion.robot)
    scene = viewer.scene(robot, motion.gait, wearer=False)
    names = [joint.name for joint in scene.facts.chains[0].joints]
    own = load_urdf(robot.urdf, placement=robot.placement)
    q = 0.5 * (own.lower + own.upper)
    answer = answered(own, scene, names, request(own, names, poses(own, q), q))
    assert poses(own, robot_q(own, names, answer.q)) == pytest.approx(poses(own, q), abs=EXACT)


def valid(scene):
    return {
        "type": "reach",
        "id": 1,
        "feet": {"left_foot": [0, 0.1, -0.8, 0, 0, 0, 1]},
        "q": [0.0] * len(scene.facts.chains[0].joints),
    }


@pytest.mark.parametrize(
    "change",
    [
        {"type": "grab"},
        {"id": -1},
        {"id": 2**40},
        {"id": True},
        {"id": "1"},
        {"feet": {}},
        {"feet": []},
        {"feet": None},
        {"feet": {"left_hand": [0, 0, 0, 0, 0, 0, 1]}},
        {"feet": {"left_foot": [0, 0, 0, 0, 0, 0]}},
        {"feet": {"left_foot": [0, 0, 0, 0, 0, 0, 0]}},
        {"feet": {"left_foot": [0, 0, 1e9, 0, 0, 0, 1]}},
        {"feet": {"left_foot": [0, 0, float("nan"), 0, 0, 0, 1]}},
        {"feet": {"left_foot": [0, 0, float("inf"), 0, 0, 0, 1]}},
        {"feet": {"left_foot": [0, 0, 10**400, 0, 0, 0, 1]}},
        {"feet": {"left_foot": [0, 0, True, 0, 0, 0, 1]}},
        {"feet": {"left_foot": [0, 0, "0", 0, 0, 0, 1]}},
        {"feet": {"left_foot": {"x": 0}}},
        {"q": [0.0]},
        {"q": [0.0] * 500},
        {"q": [float("nan")] * 12},
        {"q": None},
    ],
)
def test_what_is_not_well_formed_is_not_understood(scene, change):
    assert messages.reach_request(valid(scene), scene.facts) is not None
    content = messages.read(json.dumps(valid(scene) | change))
    assert messages.reach_request(content, scene.facts) is None


def test_brackets_without_end_are_not_understood():
    assert messages.read("[" * 60_000) is None
    assert messages.read('{"a":' * 20_000) is None
    assert messages.read("[1, 2]") is None


def test_joints_beyond_their_limits_are_brought_back(robot, scene, names):
    content = request(robot, names, poses(robot, robot.neutral), robot.neutral)
    content["q"] = [1e6] * len(names)
    answer = answered(robot, scene, names, content)
    assert not robot.outside(robot_q(robot, names, answer.q)).any()
