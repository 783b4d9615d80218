"""The recorded walk of OpenSim's subject01, its feet reached by inverse kinematics on a scaled body."""

from __future__ import annotations

import csv

import numpy as np
import pytest

from exo_pin import ik
from exo_pin.anatomy import JOINTS, Body
from exo_pin.formats import load_gait
from exo_pin.formats.opensim.pelvis_axes import FROM_OPENSIM
from exo_pin.gait.quaternions import rotations
from exo_pin.kinematics import poses
from exo_pin.robot import load_robot

DISTANCE, TURN = 1e-4, np.radians(0.01)  # [m, rad] what the issue asks for
MODEL = {"hip_flexion": 2.8, "knee_flexion": 6.3, "ankle_dorsiflexion": 3.5}  # [deg] rms, DOMAIN section 6.8
HIPS = np.array([-0.0724376, -0.0677245, 0.0])  # midway between the hips in the scaled model's pelvis [m]
LIMITS = {f"{s}_knee_flexion": (np.radians(-10), np.radians(130)) for s in ("left", "right")}


@pytest.fixture(scope="module")
def recorded(shared):
    """Positions (n, 3) and rotations (n, 3, 3) of OpenSim's bodies, in our axes."""
    folder = shared / "opensim_subject01_walk"
    with (folder / "subject01_walk1_body_poses_full.csv").open() as file:
        rows = list(csv.DictReader(file))
    out = {}
    for body in ("pelvis", "talus_l", "talus_r", "femur_l", "femur_r"):
        p = np.array([[float(row[f"{body}_p{c}"]) for c in "xyz"] for row in rows])
        q = np.array([[float(row[f"{body}_q{c}"]) for c in "wxyz"] for row in rows])
        R = rotations(q / np.linalg.norm(q, axis=1, keepdims=True))
        out[body] = (p @ FROM_OPENSIM.T, FROM_OPENSIM @ R @ FROM_OPENSIM.T)
    return out, load_gait(folder / "subject01_walk1_ik_full_opensim46.mot")


def frames(position, rotation):
    T = np.tile(np.eye(4), (len(position), 1, 1))
    T[:, :3, :3], T[:, :3, 3] = rotation, position
    return T


def test_the_feet_are_reached_and_the_angles_agree_as_far_as_models_do(recorded):
    bodies, gait = recorded
    p, R = bodies["pelvis"]
    base = frames(p + R @ (FROM_OPENSIM @ HIPS), R)
    reach = max(np.linalg.norm(bodies[f"femur_{s}"][0] - bodies[f"talus_{s}"][0], axis=1).max() for s in "lr")
    thigh = reach - 0.425065 + 1e-3  # the model's shank, and a thigh that lets the longest reach be reached
    body = Body.from_stature(1.8, mass=72.6, hip_width=0.1711044, thigh=thigh, shank=0.425065, limits=LIMITS)
    robot = load_robot(body)
    targets = {f"{side}_sole_plate": frames(*bodies[f"talus_{side[0]}"]) for side in ("left", "right")}
    track = ik.track(robot, targets, base=base)
    reached = track.reach_slack >= 0
    assert reached.all()
    assert track.position_error.max() <= DISTANCE
    assert track.rotation_error.max() <= TURN
    feet = poses(robot, track.q, tuple(targets), base=base)
    for k, T in enumerate(targets.values()):  # not the solver's own word
        np.testing.assert_allclose(feet[:, k], T, atol=DISTANCE)
    difference = np.degrees(robot.to_gait(track.q, gait).q - gait.q)
    rms = np.sqrt((difference**2).mean(axis=0))
    for movement, tolerance in MODEL.items():
        for side in ("left", "right"):
            assert rms[JOINTS.index(f"{side}_{movement}")] <= tolerance, movement


def test_the_pelvis_of_the_file_is_that_of_opensims_kinematics(recorded):
    bodies, gait = recorded
    np.testing.assert_allclose(
        gait.base[:, :3, :3], bodies["pelvis"][1], atol=2e-7
    )  # eight digits in the file
