"""Forward kinematics: directions, derivatives against the witness, centre of mass, contact."""

import numpy as np
import pytest

from exo_pin import dh
from exo_pin.anatomy import CORNERS, FEET, JOINTS, SIDES, Body
from exo_pin.errors import DescriptionError, UnknownNameError
from exo_pin.gait import Gait, normative_gait
from exo_pin.kinematics import (
    accelerations,
    attitude,
    center_of_mass,
    contacts,
    events,
    jacobian,
    poses,
    velocities,
)
from exo_pin.robot import load_robot

ROBOT = load_robot()
STEP = 1e-4  # of finite differences [s]
FIRST = 1e-6  # central differences err by STEP^2, about 1e-8, and by rounding / STEP, about 1e-12
SECOND = 1e-5  # of second differences: rounding / STEP^2, about 1e-8, times the sizes of a swinging leg


def _moved(joint, angle=0.3, frame="foot"):
    """How a point of the leg moves when one joint turns from zero."""
    name = f"{joint.split('_')[0]}_{frame}"
    before, after = (poses(ROBOT, q, (name,))[0] for q in (ROBOT.q(), ROBOT.q({joint: angle})))
    return after[:3, 3] - before[:3, 3]


@pytest.mark.parametrize("side", SIDES)
class TestAPositiveAngleDoesWhatItsNameSays:
    def inward(self, side):
        return -1 if side == "left" else 1

    def test_hip_flexion_brings_the_foot_forward_and_up(self, side):
        x, y, z = _moved(f"{side}_hip_flexion")
        assert x > 0.2
        assert z > 0.02
        assert y == pytest.approx(0, abs=1e-12)

    def test_hip_adduction_brings_the_foot_to_the_midline(self, side):
        x, y, _ = _moved(f"{side}_hip_adduction")
        assert y * self.inward(side) > 0.2
        assert x == pytest.approx(0, abs=1e-12)

    def test_internal_hip_rotation_turns_the_toes_inward(self, side):
        y = _moved(f"{side}_hip_rotation", frame="ball_medial")[1]
        assert y * self.inward(side) > 0.02

    def test_knee_flexion_brings_the_heel_backward_and_up(self, side):
        x, _, z = _moved(f"{side}_knee_flexion")
        assert x < -0.1
        assert z > 0.01

    def test_dorsiflexion_raises_the_toes(self, side):
        assert _moved(f"{side}_ankle_dorsiflexion", frame="ball_medial")[2] > 0.02
        assert _moved(f"{side}_ankle_dorsiflexion", frame="heel_medial")[2] < -0.01

    def test_inversion_raises_the_inner_edge_of_the_sole(self, side):
        assert _moved(f"{side}_ankle_inversion", frame="ball_medial")[2] > 0.01
        assert _moved(f"{side}_ankle_inversion", frame="ball_lateral")[2] < -0.005


def test_mirrored_angles_give_mirrored_feet(rng):
    q = rng.uniform(ROBOT.lower, ROBOT.upper, (50, 12))
    swapped = np.hstack([q[:, 6:], q[:, :6]])
    flip = np.diag([1.0, -1.0, 1.0, 1.0])
    left, right = np.moveaxis(poses(ROBOT, q), 1, 0)
    mirrored = poses(ROBOT, swapped)
    assert flip @ right @ flip == pytest.approx(mirrored[:, 0], abs=1e-12)
    assert flip @ left @ flip == pytest.approx(mirrored[:, 1], abs=1e-12)


def test_one_sample_and_many_are_the_same(rng):
    q = rng.uniform(ROBOT.lower, ROBOT.upper, (3, 4, 12))
    many = poses(ROBOT, q)
    assert many.shape == (3, 4, 2, 4, 4)
    assert poses(ROBOT, q[1, 2]) == pytest.approx(many[1, 2], abs=0)


def test_the_base_carries_every_frame(rng):
    base = np.eye(4)
    base[:3, :3] = dh.recursion(ROBOT.body, rng.uniform(-1, 1, 12))["left_foot"][:3, :3]
    base[:3, 3] = rng.uniform(-1, 1, 3)
    q = rng.uniform(ROBOT.lower, ROBOT.upper, (5, 12))
    relative = poses(ROBOT, q, JOINTS, base=np.eye(4))
    assert poses(ROBOT, q, JOINTS, base=base) == pytest.approx(base @ relative, abs=1e-12)
    each = np.tile(base, (5, 1, 1))
    assert poses(ROBOT, q, JOINTS, base=each) == pytest.approx(base @ relative, abs=1e-12)


def _motion(rng):
    """A smooth motion q(t), and its derivatives, at t = 0."""
    mid, amplitude = (ROBOT.lower + ROBOT.upper) / 2, (ROBOT.upper - ROBOT.lower) / 6
    rate, phase = rng.uniform(1, 4, 12), rng.uniform(0, 6, 12)
    position = lambda t: mid + amplitude * np.sin(rate * t + phase)  # noqa: E731  # a formula
    return position, amplitude * rate * np.cos(phase), -amplitude * rate**2 * np.sin(phase)


def _turning(T_before, T_after):
    """Angular velocity in world axes from two rotation matrices 2 STEP apart."""
    W = (T_after[:3, :3] @ T_before[:3, :3].T - T_before[:3, :3] @ T_after[:3, :3].T) / (4 * STEP)
    return np.array([W[2, 1], W[0, 2], W[1, 0]])


def test_velocities_are_the_derivatives_of_the_witness(rng):
    q, dq, _ = _motion(rng)
    before, after = (dh.recursion(ROBOT.body, q(t)) for t in (-STEP, STEP))
    for k, foot in enumerate(FEET):
        measured = velocities(ROBOT, q(0), dq)[k]
        linear = (after[foot][:3, 3] - before[foot][:3, 3]) / (2 * STEP)
        assert measured[:3] == pytest.approx(linear, abs=FIRST)
        assert measured[3:] == pytest.approx(_turning(before[foot], after[foot]), abs=FIRST)


def test_accelerations_are_the_second_derivatives_of_the_witness(rng):
    q, dq, ddq = _motion(rng)
    at = [dh.modified_dh(ROBOT.body, q(t)) for t in (-STEP, 0.0, STEP)]
    turning = [
        velocities(ROBOT, q(t), (q(t + STEP) - q(t - STEP)) / (2 * STEP))[:, 3:] for t in (-STEP, STEP)
    ]
    measured = accelerations(ROBOT, q(0), dq, ddq)
    for k, foot in enumerate(FEET):
        p = [T[foot][:3, 3] for T in at]
        assert measured[k, :3] == pytest.approx((p[0] - 2 * p[1] + p[2]) / STEP**2, abs=SECOND)
        assert measured[k, 3:] == pytest.approx((turning[1][k] - turning[0][k]) / (2 * STEP), abs=SECOND)


@pytest.mark.parametrize("base", [None, "turned"])
def test_the_jacobian_makes_velocities(rng, base):
    q, dq, _ = _motion(rng)
    if base:
        base = np.eye(4)
        base[:3, :3] = dh.recursion(ROBOT.body, rng.uniform(-1, 1, 12))["left_foot"][:3, :3]
    J = jacobian(ROBOT, q(0), "left_foot", base=base)
    assert J @ dq == pytest.approx(velocities(ROBOT, q(0), dq, base=base)[0], abs=1e-12)


def test_attitude_between_neighbouring_joints_is_the_joint_s_own_rotation():
    R = attitude(ROBOT, ROBOT.q({"left_knee_flexion": 0.4}), "left_shank", relative_to="left_thigh")
    c, s = np.cos(0.4), np.sin(0.4)
    assert pytest.approx(np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]), abs=1e-15) == R


@pytest.mark.parametrize("wearer", [True, False])
def test_center_of_mass_is_the_mean_of_the_links(rng, wearer):
    from exo_pin.anatomy.inertia import link_inertias

    robot = load_robot(Body.from_stature(wearer=wearer))
    q = rng.uniform(robot.lower, robot.upper, (20, 12))
    parts = link_inertias(robot.body)
    T = poses(robot, q, tuple(parts))
    centres = np.stack([part.centre for part in parts.values()])
    masses = np.array([part.mass for part in parts.values()])
    places = (T[..., :3, :3] @ centres[..., None])[..., 0] + T[..., :3, 3]
    mean = (places * masses[:, None]).sum(axis=1) / masses.sum()
    assert center_of_mass(robot, q).position == pytest.approx(mean, abs=1e-8)  # the URDF has 9 digits


def test_center_of_mass_of_a_fixed_and_a_floating_robot_agree_and_move_alike(rng):
    floating = load_robot(base="floating")
    q, dq, ddq = _motion(rng)
    free = np.concatenate([floating.neutral[:7], q(0)])
    fixed = center_of_mass(ROBOT, q(0), dq, ddq)
    other = center_of_mass(floating, free, np.r_[np.zeros(6), dq], np.r_[np.zeros(6), ddq])
    for a, b in zip(fixed, other, strict=True):
        assert a == pytest.approx(b, abs=1e-12)
    p = [center_of_mass(ROBOT, q(t)).position for t in (-STEP, 0, STEP)]
    assert fixed.velocity == pytest.approx((p[2] - p[0]) / (2 * STEP), abs=FIRST)
    assert fixed.acceleration == pytest.approx((p[0] - 2 * p[1] + p[2]) / STEP**2, abs=SECOND)


def test_standing_touches_with_all_corners_and_a_lifted_foot_does_not():
    standing = contacts(ROBOT, ROBOT.q())
    assert standing.corners == CORNERS
    assert standing.touching.all()
    lifted = contacts(ROBOT, ROBOT.q({"left_knee_flexion": 1.0, "left_hip_flexion": 0.5}))
    assert lifted.feet.tolist() == [False, True]
    assert lifted.height[:4].min() > 0.05


def test_a_raised_heel_touches_with_the_ball():
    tiptoe = contacts(ROBOT, ROBOT.q({"left_ankle_dorsiflexion": -0.2}), ground=-0.04, tolerance=0.03)
    touching = dict(zip(CORNERS, tiptoe.touching, strict=True))
    assert touching["left_ball_medial"]
    assert not touching["left_heel_medial"]


@pytest.mark.parametrize("speed", ["slow", "free", "fast"])
def test_events_from_kinematics_are_near_the_source_s_own(speed):
    gait = normative_gait(speed)
    found = events(ROBOT, gait)
    assert {(e.kind, e.side) for e in found} == {(e.kind, e.side) for e in gait.events}
    for event in found:
        own = [e.time for e in gait.events if (e.kind, e.side) == (event.kind, event.side)]
        apart = (np.array(own) - event.time + gait.duration / 2) % gait.duration - gait.duration / 2
        assert np.abs(apart).min() < 0.06 * gait.duration  # children's events, an adult's proportions


def test_events_do_not_depend_on_the_direction_of_the_walk():
    gait = normative_gait()
    turn = np.diag([-1.0, -1.0, 1.0, 1.0])
    import dataclasses

    back = dataclasses.replace(gait, base=turn @ gait.base)
    assert [e.time for e in events(ROBOT, back)] == pytest.approx([e.time for e in events(ROBOT, gait)])


def test_wrong_shapes_and_names_are_refused():
    with pytest.raises(DescriptionError, match="12"):
        poses(ROBOT, np.zeros(11))
    with pytest.raises(UnknownNameError):
        poses(ROBOT, ROBOT.q(), ("left_toe",))
    with pytest.raises(DescriptionError, match="base"):
        poses(ROBOT, np.zeros((3, 12)), base=np.zeros((2, 4, 4)))
    with pytest.raises(DescriptionError, match="dq"):
        velocities(ROBOT, np.zeros((3, 12)), np.zeros(12))


def test_an_empty_gait_of_poses_is_empty():
    assert poses(ROBOT, np.zeros((0, 12))).shape == (0, 2, 4, 4)
    assert Gait(np.arange(2) / 10, np.zeros((2, 12))).q.shape == (2, 12)
