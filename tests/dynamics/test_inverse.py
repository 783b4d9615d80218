"""Inverse dynamics: signs, weight, symmetry, masses, and the published torques of a recorded walk."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from exo_pin import dynamics
from exo_pin.anatomy import CORNERS, JOINTS, SIDES
from exo_pin.errors import DescriptionError, GaitError, UnknownNameError
from exo_pin.gait import Gait
from exo_pin.gait.trial import ForcePlate
from exo_pin.kinematics import poses
from exo_pin.physics import GRAVITY
from exo_pin.robot import load_robot

_ROUNDING = 1e-9  # of sums of some hundred newtons
_N = 40


def column(name):
    return JOINTS.index(name)


@pytest.fixture(scope="module")
def wearer(robot):
    return dynamics.floating_robot(robot, "wearer")


def posture(robot, **angles):
    """A walk that does not move: `_N` samples of one posture of both legs, the lower sole on the ground."""
    q = np.zeros((_N, len(JOINTS)))
    for name, angle in angles.items():
        q[:, [column(f"{side}_{name}") for side in SIDES]] = angle
    gait = Gait(np.arange(_N) / 100.0, q, base=np.tile(robot.placement, (_N, 1, 1)))
    base = np.array(gait.base)
    base[:, 2, 3] -= poses(robot, robot.from_gait(gait)[0], CORNERS)[:, 2, 3].min()
    return dataclasses.replace(gait, base=base)


def plate(gait, *, point, force, moment=(0.0, 0.0, 0.0), name="plate"):
    """A force plate that measures the same all the time."""
    rows = (np.tile(x, (len(gait), 1)) for x in (force, point, moment))
    return ForcePlate(name, gait.time, *rows)


def standing(robot, gait, left=0.5, x=0.04):
    """Two plates that bear the wearer's weight under the soles."""
    weight = dynamics.mass_of(robot) * GRAVITY
    width = robot.body.hip_width / 2
    shares = (("left", left, width), ("right", 1 - left, -width))
    return tuple(
        plate(gait, point=(x, y, 0.0), force=(0.0, 0.0, part * weight), name=name) for name, part, y in shares
    )


def test_at_rest_support_and_ground_bear_the_weight(robot):
    for masses in ("wearer", "both", "device"):
        model = dynamics.floating_robot(robot, masses)
        gait = posture(model, hip_flexion=0.4, knee_flexion=0.7)
        moving = dynamics.motion(model, gait, cutoff=None)
        wrench = np.zeros((_N, 2, 6))
        wrench[:, 0, 2] = 100.0
        world = dynamics.in_world_axes(moving.base, dynamics.generalized_forces(model, moving, wrench))
        total = world[:, :3] + [0.0, 0.0, 100.0]
        weight = dynamics.mass_of(model) * GRAVITY
        assert np.abs(total - [0.0, 0.0, weight]).max() <= _ROUNDING


def test_without_gravity_and_motion_nothing_needs_a_torque(wearer):
    model = wearer.model.copy()
    model.gravity.linear = np.zeros(3)
    still = dataclasses.replace(wearer, model=model)
    moving = dynamics.motion(still, posture(wearer, knee_flexion=0.6), cutoff=None)
    assert np.abs(dynamics.generalized_forces(still, moving)).max() <= _ROUNDING


def test_a_mirrored_walk_has_mirrored_torques(robot, gait):
    one = dynamics.torques(robot, gait)
    other = dynamics.torques(robot, gait.mirrored())
    swapped = np.roll(other.torque, 6, axis=1)
    assert np.abs(one.torque - swapped).max() <= _ROUNDING
    assert np.abs(one.ground.force - other.ground.force[:, ::-1] * [1, -1, 1]).max() <= _ROUNDING


@pytest.mark.parametrize("side", ["left", "right"])
def test_directions_of_torques_of_a_standing_person(wearer, side):
    """Weight behind or in front of a joint tells which way its muscles must act."""
    gait = posture(wearer)
    ahead = dynamics.torques(wearer, gait, forces=standing(wearer, gait, x=0.10))
    assert (ahead.torque[:, column(f"{side}_ankle_dorsiflexion")] < -10).all()  # the calf holds
    bent = posture(wearer, hip_flexion=0.3, knee_flexion=0.6, ankle_dorsiflexion=0.3)
    squat = dynamics.torques(wearer, bent, forces=standing(wearer, bent))
    assert (squat.torque[:, column(f"{side}_knee_flexion")] < -10).all()  # the quadriceps hold
    plates = list(standing(wearer, gait))
    k = SIDES.index(side)
    point = plates[k].point - np.array([0.0, 0.04 if side == "left" else -0.04, 0.0])
    plates[k] = dataclasses.replace(plates[k], point=point)
    inside = dynamics.torques(wearer, gait, forces=plates)
    assert (inside.torque[:, column(f"{side}_hip_adduction")] < -10).all()  # the abductors hold


@pytest.mark.parametrize(("side", "sign"), [("left", 1.0), ("right", -1.0)])
def test_a_turning_ground_and_a_sideways_force_act_on_rotation_and_inversion(wearer, side, sign):
    gait = posture(wearer)
    plates = list(standing(wearer, gait))
    k = SIDES.index(side)
    turned = plates.copy()
    turned[k] = dataclasses.replace(plates[k], moment=np.tile([0.0, 0.0, 5.0], (_N, 1)))
    change = (
        dynamics.torques(wearer, gait, forces=turned).torque
        - dynamics.torques(wearer, gait, forces=plates).torque
    )
    # the ground turns the foot to the left: inwards on the right side, so the left hip must rotate inwards
    assert change[:, column(f"{side}_hip_rotation")] == pytest.approx(sign * 5.0)
    outward = plates.copy()
    point = plates[k].point + np.array([0.0, sign * 0.02, 0.0])
    outward[k] = dataclasses.replace(plates[k], point=point)
    change = (
        dynamics.torques(wearer, gait, forces=outward).torque
        - dynamics.torques(wearer, gait, forces=plates).torque
    )
    # under the outer edge the force turns the foot's outer edge up (eversion), so the muscles invert
    assert (change[:, column(f"{side}_ankle_inversion")] > 1.0).all()


def test_without_plates_the_reaction_is_called_predicted_and_bears_the_weight(robot, gait):
    found = dynamics.torques(robot, gait)
    assert (found.reaction, found.masses) == ("predicted", "both")
    assert "predicted" in found.source
    weight = robot.body.total_mass * GRAVITY
    assert found.ground.force[..., 2].sum(axis=1).mean() == pytest.approx(weight, rel=1e-9)
    for support in (0.3, 0.5):
        less = dynamics.torques(robot, gait, body_weight_support=support)
        assert less.ground.force[..., 2].sum(axis=1).mean() == pytest.approx((1 - support) * weight, rel=1e-9)
        assert less.support_force == pytest.approx(support * weight)
        assert less.support_wrench[:, 2] == pytest.approx(support * weight)
        assert np.abs(less.residual.wrench[:, 2]).max() <= 1e-6


def test_the_predicted_force_of_a_foot_in_the_air_is_zero(robot, gait):
    found = dynamics.torques(robot, gait)
    for k, side in enumerate(("left", "right")):
        assert (found.ground.force[~gait.stance(side), k] == 0.0).all()
        assert (found.ground.force[:, k, 2] >= 0.0).all()


@pytest.mark.parametrize("support", [-0.1, 1.1, float("nan")])
def test_a_support_outside_0_to_1_is_refused(robot, gait, support):
    with pytest.raises(GaitError, match="0 to 1"):
        dynamics.torques(robot, gait, body_weight_support=support)


def test_masses_are_those_of_wearer_device_or_both(robot):
    body = robot.body
    for masses, mass in (("wearer", body.mass), ("device", body.hardware_mass), ("both", body.total_mass)):
        assert dynamics.mass_of(dynamics.floating_robot(robot, masses)) == pytest.approx(mass, abs=1e-6)


def test_masses_that_are_not_known_are_refused(robot):
    with pytest.raises(UnknownNameError, match="wearer"):
        dynamics.floating_robot(robot, "person")
    bare = load_robot(dataclasses.replace(robot.body, wearer=False))
    with pytest.raises(DescriptionError, match="bare device"):
        dynamics.floating_robot(bare, "wearer")


def test_json_holds_no_number_where_a_frame_is_not_valid(wearer):
    gait = posture(wearer)
    plates = standing(wearer, gait)
    late = [
        dataclasses.replace(p, **{n: getattr(p, n)[10:] for n in ("time", "force", "point", "moment")})
        for p in plates
    ]
    found = dynamics.torques(wearer, gait, forces=late)
    assert found.valid.tolist() == [False] * 10 + [True] * (_N - 10)
    data = found.to_json()
    assert data["torque_Nm"]["left_knee_flexion"][:10] == [None] * 10
    assert None not in data["torque_Nm"]["left_knee_flexion"][10:]
    assert data["valid_frames"] == _N - 10
    assert any("10 of 40 frames are not valid" in remark for remark in found.remarks)
