"""Forces in the picture: where they act, what they are, and how they are named."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from exo_pin import viewer
from exo_pin.anatomy import CORNERS, JOINTS, SIDES
from exo_pin.dynamics import torques
from exo_pin.errors import GaitError
from exo_pin.gait.heading import turned
from exo_pin.gait.normative_kinetics import normative_moments
from exo_pin.kinematics import poses
from exo_pin.viewer.scenes.actor import flat_poses

SINGLE = 1e-4  # [N, N m] float32 keeps seven digits of numbers near 1000
TOLERANCE = 0.01  # [m] a sole rolls: the centre of pressure may lie outside its four corners by so little


@pytest.fixture(scope="module")
def found(robot, gait):
    return torques(robot, gait)


@pytest.fixture(scope="module")
def shown(robot, gait, found):
    return viewer.scene(robot, gait, kinetics=viewer.Kinetics.of_dynamics(found), wearer=False)


def test_arrows_carry_the_forces_of_the_inverse_dynamics(shown, found):
    for foot, side in enumerate(SIDES):
        force = shown.arrays[f"{side}_ground_reaction"]
        assert np.abs(force - found.ground.force[:, foot]).max() < SINGLE
    assert np.abs(shown.arrays["torque"] - found.torque).max() < SINGLE
    assert shown.facts.forces.length * found.weight_force == pytest.approx(0.6)


def test_arrows_stand_on_the_ground_under_their_own_sole(shown, robot, gait):
    base = shown.arrays["base"].astype(float)
    T = np.tile(np.eye(4), (len(base), 1, 1))
    T[:, :3, :3], T[:, :3, 3] = Rotation.from_quat(base[:, 3:]).as_matrix(), base[:, :3]
    corners = poses(robot, robot.from_gait(gait), CORNERS, base=T)[..., :3, 3]
    for side in SIDES:
        point = shown.arrays[f"{side}_ground_reaction_at"]
        mine = corners[:, [k for k, name in enumerate(CORNERS) if name.startswith(side)], :2]
        loaded = np.isfinite(point[:, 0])
        assert loaded.mean() == pytest.approx(gait.stance(side).mean(), abs=0.03)
        assert np.all(point[loaded, 2] == 0.0)
        assert np.all(point[loaded, :2] > mine.min(axis=1)[loaded] - TOLERANCE)
        assert np.all(point[loaded, :2] < mine.max(axis=1)[loaded] + TOLERANCE)


def test_a_walk_that_is_turned_to_the_cameras_takes_its_forces_along(robot, gait, shown):
    away = turned(gait, np.radians(120))
    other = viewer.scene(
        robot, away, kinetics=viewer.Kinetics.of_dynamics(torques(robot, away)), wearer=False
    )
    for name in ("left_ground_reaction", "right_ground_reaction_at", "support"):
        same = np.isclose(other.arrays[name], shown.arrays[name], atol=1e-3, equal_nan=True)
        assert same.all(), name


def test_forces_of_another_clock_are_refused(robot, gait, found):
    late = replace(viewer.Kinetics.of_dynamics(found), time=found.time + 0.5)
    with pytest.raises(GaitError, match="clock"):
        viewer.scene(robot, gait, kinetics=late)


def test_a_predicted_ground_reaction_is_called_so_wherever_it_is_shown(shown):
    facts = shown.facts
    assert any("predicted" in key.title for key in facts.keys)
    assert any("predicted" in group.title for group in facts.groups)
    assert any("predicted" in note for note in facts.notes)


def test_tabs_hold_forces_torques_and_powers(shown, found):
    titles = [tab.title for tab in shown.facts.plots]
    assert titles == ["Angles", "Velocities", "Pelvis", "Forces", "Torques", "Power"]
    assert np.abs(shown.arrays["power"] - found.torque * found.velocity).max() < SINGLE
    assert [len(tab.plots) for tab in shown.facts.plots][-2:] == [len(JOINTS) // 2] * 2


def test_the_pelvis_tab_turns_back_into_the_pelvis_that_is_shown(shown):
    tilt, obliquity, rotation = shown.arrays["pelvis"].astype(float).T[:3]
    R = Rotation.from_euler("YXZ", np.stack([tilt, obliquity, -rotation], axis=1)).as_matrix()
    T = np.tile(np.eye(4), (len(R), 1, 1))
    T[:, :3, :3], T[:, :3, 3] = R, shown.arrays["base"][:, :3]
    apart = np.abs(flat_poses(T) - shown.arrays["base"])
    assert apart.max() < 1e-6


def test_the_band_lies_around_the_normal_walk_itself(shown, gait):
    low, high = shown.arrays["angles_low"], shown.arrays["angles_high"]
    assert np.abs((low + high) / 2 - gait.q).max() < np.radians(
        0.4
    )  # the right leg walks 0.5 % later or sooner
    assert np.all(high - low > 0.0)


def test_the_band_of_torques_is_the_sources_times_the_persons_mass(shown, robot):
    mean, sd = normative_moments("free")
    column = shown.facts.plots[4].plots[2].series[0].column  # the left ankle
    ankle = JOINTS.index("left_ankle_dorsiflexion")
    high = shown.arrays["torques_high"][:, column]
    assert np.abs(high - robot.body.mass * (mean + sd)[:, ankle]).max() < 1e-3
    assert any("children" in note for note in shown.facts.notes)
