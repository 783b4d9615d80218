"""The witness against Pinocchio and yourdfpy, and the published table."""

import dataclasses
import math

import numpy as np
import pytest

from exo_pin import crosscheck, dh
from exo_pin.anatomy import HIP_ORDERS, Body
from exo_pin.robot import load_robot

BODIES = {
    "average": Body.from_stature(),
    "tall woman": Body.from_stature(1.95, mass=80.0, sex="female"),
    "child": Body.from_stature(1.2, mass=25.0),
    "left differs from right": Body.from_stature(
        left_thigh=0.39, right_shank=0.40, left_ankle_height=0.09, right_foot_length=0.3, hip_width=0.21
    ),
}
AGREEMENT = 1e-12  # chains of seven products of doubles of size one


@pytest.mark.parametrize("hip_order", HIP_ORDERS)
@pytest.mark.parametrize("name", BODIES)
def test_four_ways_of_forward_kinematics_agree(name, hip_order, rng):
    robot = load_robot(BODIES[name], hip_order=hip_order)
    q = rng.uniform(robot.lower, robot.upper, (1000, 12))
    differences = crosscheck.forward(robot, q)
    assert set(differences) == {"recursion", "dh", "yourdfpy"}
    assert max(differences.values()) <= AGREEMENT


def test_all_thousand_configurations_agree_with_yourdfpy(rng):
    robot = load_robot(BODIES["left differs from right"])
    q = rng.uniform(robot.lower, robot.upper, (1000, 12))
    parts = [crosscheck.forward(robot, part)["yourdfpy"] for part in np.split(q, 5)]
    assert max(parts) <= AGREEMENT


def test_the_check_notices_a_robot_that_is_not_its_body_s(rng):
    robot = load_robot(Body.from_stature())
    longer = dataclasses.replace(robot, body=Body.from_stature(left_thigh=robot.body.left_thigh + 1e-6))
    q = rng.uniform(robot.lower, robot.upper, (10, 12))
    differences = crosscheck.forward(longer, q)
    assert min(differences["recursion"], differences["dh"]) > 1e-7
    assert differences["yourdfpy"] <= AGREEMENT  # it reads the same URDF


def test_rows_are_those_of_the_published_table():
    body = Body.from_stature()
    rows = dh.table(body, "right")
    assert [row.joint for row in rows] == [f"right_{movement}" for movement in dh.chain()]
    assert [round(math.degrees(row.alpha)) for row in rows] == [0, 90, 90, 90, 180, 90]
    assert [round(math.degrees(row.offset)) for row in rows] == [0, 90, -90, -90, 180, 0]
    assert [row.d for row in rows] == [0, 0, -body.right_thigh, 0, 0, 0]
    assert [row.a for row in rows] == [0, 0, 0, 0, body.right_shank, 0]


@pytest.mark.parametrize("hip_order", HIP_ORDERS)
@pytest.mark.parametrize("side", ["left", "right"])
def test_base_and_tool_complete_the_table(side, hip_order, rng):
    body = BODIES["left differs from right"]
    q = rng.uniform(-0.5, 0.5, 12)
    base, tool = dh.ends(body, side, hip_order=hip_order)
    T = base
    angles = q[:6] if side == "left" else q[6:]
    for row, angle in zip(dh.table(body, side, hip_order=hip_order), angles, strict=True):
        T = T @ _turned("x", row.alpha, row.a) @ _turned("z", angle + row.offset, row.d)
    foot = dh.recursion(body, q, hip_order=hip_order)[f"{side}_foot"]
    assert pytest.approx(foot, abs=AGREEMENT) == T @ tool


def _turned(axis, angle, shift):
    """A turn about an axis and a shift along it."""
    c, s = math.cos(angle), math.sin(angle)
    if axis == "x":
        return np.array([[1, 0, 0, shift], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1]])
    return np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, shift], [0, 0, 0, 1]])


def test_one_sample_and_many_are_the_same(rng):
    body = Body.from_stature()
    q = rng.uniform(-0.5, 0.5, (4, 3, 12))
    for way in (dh.recursion, dh.modified_dh):
        many = way(body, q)["left_foot"]
        assert many.shape == (4, 3, 4, 4)
        assert way(body, q[2, 1])["left_foot"] == pytest.approx(many[2, 1], abs=1e-15)
