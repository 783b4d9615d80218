"""Comparison of devices: what is exact comes out exact, and what is lost has the right size and sign."""

import dataclasses
import json

import numpy as np
import pytest

from exo_pin import ik
from exo_pin.anatomy import FEET, JOINTS, Body
from exo_pin.anatomy.hip_cardan_angles import hip_angles
from exo_pin.cli import main
from exo_pin.compare import (
    PHASES,
    Conditions,
    best,
    compare,
    comparison_table,
    dressed,
    projected,
    robot_for,
    walk,
)
from exo_pin.compare.best_motion import SOLVER
from exo_pin.compare.recorded_walk import corners
from exo_pin.devices import DEVICES, find, subset
from exo_pin.errors import UnknownNameError
from exo_pin.formats import load_gait
from exo_pin.gait import Gait, Torques, normative_gait
from exo_pin.gait.phases import masks, percent, toe_off
from exo_pin.kinematics import poses
from exo_pin.robot import load_robot

GAIT = normative_gait().resampled(16)
BODY = Body.from_stature()
EXACT = 1e-8  # ten times what the solver is asked for, in metres
SETTLED = 1e-6  # metres: two ways to one smooth minimum, at a speed limit perhaps


@pytest.fixture(scope="module")
def held():
    return compare(GAIT)


def _loss(comparison, name, which="best"):
    return next(loss for loss in getattr(comparison, which) if loss.device.name == name)


def test_twelve_joints_lose_nothing(held):
    loss = held.best[0]
    assert loss.device.name == "exo12"
    assert max(loss.sole_error.max(), loss.position_error.max()) <= EXACT
    assert loss.rotation_error.max() <= EXACT
    assert loss.step_width_lost == pytest.approx(0, abs=EXACT)
    assert loss.clearance_lost == pytest.approx(0, abs=EXACT)
    assert loss.com_error <= EXACT


def test_twelve_joints_find_the_feet_from_another_start(rng):
    recorded = walk(GAIT)
    robot = recorded.robot
    start = np.clip(robot.from_gait(GAIT) + rng.normal(0, 0.1, (16, 12)), robot.lower, robot.upper)
    local = (
        np.linalg.inv(recorded.feet[0])
        @ np.pad(recorded.corners[0], ((0, 0), (0, 0), (0, 1)), constant_values=1).swapaxes(-1, -2)
    ).swapaxes(-1, -2)[..., :3]
    targets = {foot: ik.Points(local[k], recorded.corners[:, k]) for k, foot in enumerate(FEET)}
    track = ik.track(robot, targets, start, base=recorded.base, settings=SOLVER)
    reached = corners(robot, poses(robot, track.q, FEET, base=recorded.base))
    assert np.abs(reached - recorded.corners).max() <= EXACT


def test_the_corners_are_those_of_the_model():
    from exo_pin.anatomy import CORNERS

    recorded = walk(GAIT, Body.from_stature(1.6, left_ball=0.09))
    frames = poses(recorded.robot, recorded.robot.from_gait(GAIT), CORNERS, base=recorded.base)
    assert recorded.corners.reshape(16, 8, 3) == pytest.approx(frames[..., :3, 3], abs=1e-12)


@pytest.mark.parametrize("pelvis", ["recorded", "device"])
def test_the_best_motion_is_never_worse_than_the_plain_copy(pelvis):
    comparison = compare(GAIT, ["lokomat", "lopes8", "h2"], conditions=Conditions(pelvis))
    for better, plain in zip(comparison.best, comparison.projected, strict=True):
        assert np.all((better.sole_error**2).sum(axis=1) <= (plain.sole_error**2).sum(axis=1) + EXACT)


def test_a_better_motion_cannot_be_found_by_shaking_it(rng):
    recorded = walk(GAIT)
    robot = robot_for(find("lopes7"), BODY, Conditions())
    found = best(recorded, robot)
    cost = ((found.corners - recorded.corners) ** 2).sum(axis=(1, 2, 3))
    for size in (1e-2, 1e-4):
        shaken = np.clip(found.q + rng.normal(0, size, found.q.shape), robot.lower, robot.upper)
        feet = poses(robot, shaken, FEET, base=recorded.base)
        assert np.all(((corners(robot, feet) - recorded.corners) ** 2).sum(axis=(1, 2, 3)) >= cost - 1e-12)


def test_motions_keep_the_joint_limits(held):
    for loss in (*held.best, *held.projected):
        loss.motion.robot.check_limits(loss.motion.q)


def test_more_joints_never_lose_more():
    order = ("hip_flexion", "knee_flexion", "hip_adduction", "ankle_dorsiflexion", "hip_rotation")
    names = [subset(order[: k + 2], name=f"s{k}") for k in range(4)]
    losses = {loss.device.name: loss.rms for loss in compare(GAIT, names).best}
    assert all(losses[f"s{k + 1}"] <= losses[f"s{k}"] + EXACT for k in range(3))


def test_devices_of_the_same_joints_lose_the_same_under_the_recorded_pelvis(held):
    same = [_loss(held, name).rms for name in ("lokomat", "hk4", "planar5")]
    assert same == pytest.approx([same[0]] * 3, abs=EXACT)


def test_a_planar_gait_is_exact_on_a_planar_device():
    q = np.array(GAIT.q)
    for side in ("left", "right"):
        for movement in ("hip_adduction", "hip_rotation", "ankle_inversion"):
            q[:, JOINTS.index(f"{side}_{movement}")] = 0.0
    flat = dataclasses.replace(GAIT, q=q)
    assert compare(flat, ["planar7"]).best[0].rms <= EXACT


def test_the_error_of_a_planar_device_is_the_sideways_one(held):
    gap = _loss(held, "planar7").motion.feet[..., :3, 3] - held.walk.feet[..., :3, 3]
    sideways, total = np.abs(gap[..., 1]), np.linalg.norm(gap, axis=-1)
    assert sideways.mean() > 0.9 * total.mean()


def test_a_held_pelvis_stands_still_upright_and_slides_move_it():
    comparison = compare(GAIT, ["exo12", "lokomat", "h2"], conditions=Conditions("device"))
    still = _loss(comparison, "exo12").motion.gait.base
    assert np.array_equal(still, np.tile(still[:1], (16, 1, 1)))
    assert still[0, 2, :3] == pytest.approx([0, 0, 1])
    slid = _loss(comparison, "lokomat").motion.gait.base[:, :3, 3]
    assert np.ptp(slid, axis=0)[:2] == pytest.approx([0, 0], abs=1e-12)
    assert np.ptp(slid[:, 2]) > 1e-3
    assert np.array_equal(_loss(comparison, "h2").motion.gait.base, GAIT.base)  # it goes with the person


def test_on_a_held_pelvis_the_plain_copy_keeps_the_thighs_attitude():
    recorded, conditions = walk(GAIT), Conditions("device")
    copied = projected(recorded, robot_for(find("exo12"), BODY, conditions), conditions)
    gap = copied.feet[..., :3, :3] - recorded.feet[..., :3, :3]
    assert np.abs(gap).max() < 1e-9


def test_a_walk_over_ground_takes_the_stand_along():
    base = np.array(GAIT.base)
    base[:, 0, 3] += 1.3 * GAIT.time
    over = Gait(GAIT.time, GAIT.q, base=base)
    loss = compare(over, ["exo12"], conditions=Conditions("device")).best[0]
    assert loss.motion.gait.base[:, 0, 3] == pytest.approx(1.3 * GAIT.time, abs=1e-3)
    assert loss.rms < 0.005


def test_hip_angles_undo_the_hip_joints(rng):
    robot = load_robot()
    q = rng.uniform(robot.lower, robot.upper, (50, 12))
    R = poses(robot, q, ("left_thigh", "right_thigh"), base=np.eye(4))[..., :3, :3]
    assert hip_angles(R[:, 0], "left") == pytest.approx(q[:, 0:3], abs=1e-9)
    assert hip_angles(R[:, 1], "right") == pytest.approx(q[:, 6:9], abs=1e-9)


def test_released_joints_lose_less_than_held_ones(held):
    released = compare(GAIT, ["lokomat", "h2"], conditions=Conditions(passive="released"))
    for loss in released.best:
        assert loss.rms < _loss(held, loss.device.name).rms


def test_phases_cover_the_cycle_once():
    gait = normative_gait()
    for side in ("left", "right"):
        assert sum(mask.astype(int) for mask in masks(gait, side).values()).tolist() == [1] * 100
        stance = gait.stance(side)
        assert np.array_equal(percent(gait, side) < toe_off(gait, side).percent, stance)


def test_phases_of_a_recording_shorter_than_a_stride(shared):
    gait = load_gait(shared / "opensim_subject01_walk" / "subject01_walk1_ik.mot")
    loss = compare(gait, ["lokomat"]).best[0]
    assert set(loss.by_phase) == set(PHASES)
    assert np.isfinite(list(loss.by_phase.values())).all()
    assert np.isfinite([loss.clearance_lost, loss.step_width_lost]).all()


def test_without_events_phases_are_unknown_and_errors_are_not():
    gait = Gait(GAIT.time[:5], GAIT.q[:5])
    loss = compare(gait, ["lokomat"]).best[0]
    assert np.isnan(list(loss.by_phase.values())).all()
    assert np.isnan(loss.clearance)
    assert np.isfinite(loss.rms)
    json.dumps(loss.facts(), allow_nan=False)


def test_the_table_has_every_device_least_loss_first(held):
    rows = comparison_table.rows(held)
    assert {row[0] for row in rows} == set(DEVICES)
    losses = [float(row[2]) for row in rows]
    assert losses == sorted(losses)
    assert all(len(row) == len(comparison_table.LOSS_COLUMNS) for row in rows)


def test_unknown_conditions_are_refused():
    with pytest.raises(UnknownNameError, match="pelvis"):
        Conditions(pelvis="flying")


def test_the_command_prints_json_and_writes_tables(tmp_path, capsys):
    words = ["compare", "slow", "--devices", "exo12", "hk4", "--json"]
    assert main([*words, "-o", str(tmp_path / "t.csv")]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert [d["device"] for d in facts["best"]] == ["exo12", "hk4"]
    lines = (tmp_path / "t.csv").read_text().splitlines()
    assert [line.split(",")[0] for line in lines] == ["device", "exo12", "hk4"]


@pytest.mark.parametrize("words", [["--devices", "hal"], ["-o", "t.docx"], ["none.mot"]])
def test_the_command_refuses_what_it_does_not_know(words, capsys):
    assert main(["compare", *words]) == 2
    assert capsys.readouterr().err.startswith("exo-pin: ")


@pytest.mark.parametrize("name", DEVICES)
def test_every_device_walks_in_the_viewer_in_its_own_looks(name):
    from exo_pin import viewer

    recorded = walk(GAIT)
    motion = projected(recorded, robot_for(find(name), BODY, Conditions()))
    robot = dressed(motion.robot)
    feet = poses(robot, robot.from_gait(motion.gait), FEET, base=motion.gait.base)
    assert feet == pytest.approx(motion.feet, abs=1e-12)
    scene = viewer.scene(robot, motion.gait, reference=GAIT)
    turns = {turn.name for chain in scene.facts.chains for turn in chain.joints}
    assert turns & set(JOINTS) == set(find(name).joints)


def test_replay_shows_a_device_and_tells_what_it_misses(tmp_path, capsys):
    page = tmp_path / "w.html"
    assert main(["replay", "--device", "hk4", "--html", str(page)]) == 0
    said = capsys.readouterr().out
    assert "powered orthosis" in said
    assert "mm rms" in said
    assert page.stat().st_size > 100_000
    assert main(["replay", "--device", "hk4", "--hip-order", "yaw_roll_pitch", "--html", str(page)]) == 2


def test_losses_do_not_depend_on_where_the_walk_goes():
    turn, there = np.radians(130), np.eye(4)
    there[:2, :2] = [[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]
    there[:3, 3] = 3.0, -2.0, 0.0
    elsewhere = dataclasses.replace(GAIT, base=there @ GAIT.base)
    for pelvis in ("recorded", "device"):
        here, away = (
            compare(gait, ["lopes8"], conditions=Conditions(pelvis)).best[0] for gait in (GAIT, elsewhere)
        )
        assert away.sole_error == pytest.approx(here.sole_error, abs=SETTLED)
        assert away.com_shift == pytest.approx(here.com_shift, abs=SETTLED)
        assert away.step_width == pytest.approx(here.step_width, abs=SETTLED)
        assert away.clearance == pytest.approx(here.clearance, abs=SETTLED)


def _moved(loss, *, feet=(0.0, 0.0, 0.0), com=(0.0, 0.0, 0.0), turn=0.0):
    """The recorded walk with the left foot and the centre of mass moved by hand, as a loss."""
    recorded = loss.walk
    T = np.array(recorded.feet)
    T[:, 0, :3, 3] += feet
    c, s = np.cos(turn), np.sin(turn)
    T[:, 0, :3, :3] = T[:, 0, :3, :3] @ [[c, -s, 0], [s, c, 0], [0, 0, 1]]
    motion = dataclasses.replace(
        loss.motion, feet=T, corners=corners(recorded.robot, T), com=recorded.com + np.array(com)
    )
    return dataclasses.replace(loss, motion=motion)


def test_errors_are_those_of_feet_moved_by_hand(held):
    loss = held.best[0]
    aside = _moved(loss, feet=(0.0, 0.01, 0.0))
    assert aside.position_error == pytest.approx(np.tile([0.01, 0.0], (16, 1)))
    assert aside.rms == pytest.approx(0.01 / np.sqrt(2))
    assert aside.rotation_error == pytest.approx(0, abs=EXACT)
    assert aside.step_width_lost == pytest.approx(-0.01)  # the left foot went left: a wider walk
    assert aside.clearance_lost == pytest.approx(0, abs=EXACT)
    turned = _moved(loss, turn=0.2)
    assert turned.rotation_error == pytest.approx(np.tile([0.2, 0.0], (16, 1)))
    assert turned.position_error == pytest.approx(0, abs=EXACT)
    assert _moved(loss, com=(0.0, 0.0, 0.003)).com_shift == pytest.approx(np.tile([0, 0, 0.003], (16, 1)))
    assert _moved(loss, com=(0.01, 0.0, 0.02)).com_error == pytest.approx(np.sqrt(5) / 100)


def test_a_foot_that_swings_lower_loses_clearance(held):
    loss = held.best[0]
    left, right = (loss.walk.corners[..., 2].min(axis=-1)[:, k] for k in range(2))
    swing = masks(loss.walk.gait, "left")["mid swing"]
    other = masks(loss.walk.gait, "right")["mid swing"]
    by_hand = min((left - 0.005 - right)[swing].min(), (right - left + 0.005)[other].min())
    assert _moved(loss, feet=(0.0, 0.0, -0.005)).clearance == pytest.approx(by_hand)


def test_phases_hold_the_errors_of_their_samples(held):
    loss = _loss(held, "lokomat")
    for errors in (loss.sole_error, loss.position_error, loss.rotation_error):
        squares, count = 0.0, 0
        for name, value in loss.in_phases(errors).items():
            samples = sum(int(masks(loss.walk.gait, side)[name].sum()) for side in ("left", "right"))
            squares, count = squares + samples * value**2, count + samples
        assert count == 32
        assert squares / count == pytest.approx(np.mean(errors**2))


def test_angle_change_and_ranges_are_those_of_the_motion(held):
    loss = _loss(held, "lopes7")
    knees = [loss.walk.gait.q[:, JOINTS.index(f"{s}_knee_flexion")] for s in ("left", "right")]
    mine = [loss.motion.q[:, loss.motion.robot.column(f"{s}_knee_flexion")] for s in ("left", "right")]
    assert loss.angle_change["knee_flexion"] == pytest.approx(np.abs(np.array(mine) - knees).max())
    knee = loss.ranges["left_knee_flexion"]
    assert (knee.lowest, knee.highest) == (mine[0].min(), mine[0].max())
    assert knee.samples_at_limit == (mine[0] < 1e-9).sum()


@pytest.fixture(scope="module")
def strong_walk():
    """A walk of which the hip needs 166 N m, and nothing else much."""
    gait = normative_gait().resampled(40)
    tau = np.full((len(gait), len(JOINTS)), 5.0)
    tau[7, JOINTS.index("left_hip_flexion")] = -166.0
    tau[:, JOINTS.index("right_ankle_inversion")] = np.nan
    return gait, Torques(gait.time, tau, source="a test")


def test_motors_are_judged_by_the_torques_of_the_walk_and_their_power_by_the_motion(strong_walk):
    gait, torques = strong_walk
    found = compare(gait, ["exo12", "lokomat"], BODY, torques=torques)
    assert [m.device for m in found.motors] == [loss.device for loss in found.best]
    for motor in found.motors:
        assert motor.failures == ("left hip flexion torque: 166 of 150 N m",)
        assert motor.hardest.joint == "left_hip_flexion"
        speed = abs(gait.dq[7, JOINTS.index("left_hip_flexion")])
        assert motor.peak_power >= 166.0 * speed * 0.9  # a copy's speeds are of its own samples
        assert {d.joint for d in motor.joints} <= set(motor.device.joints) - {"right_ankle_inversion"}
    facts = found.facts()
    assert facts["torques"] == "a test"
    assert facts["motors"][0]["joints"]["left_hip_flexion"]["torque_use"] == pytest.approx(166 / 150)
    assert not facts["motors"][0]["ok"]


def test_without_torques_a_comparison_says_nothing_of_motors(held):
    assert held.motors is None
    assert not {"motors", "torques"} & set(held.facts())
    assert comparison_table.motor_rows(held) == []


def test_the_command_judges_the_walk_s_own_torques(capsys, tmp_path):
    path = tmp_path / "table.csv"
    words = ["compare", "very_fast", "--devices", "exo12", "planar5", "--torques", "own", "-o", str(path)]
    assert main(words) == 0
    out = capsys.readouterr().out
    assert "ground reaction predicted" in out
    assert "NOT OK exo12, right hip flexion torque: 189 of 150 N m" in out
    head, *rows = (line.split(",") for line in path.read_text().splitlines())
    assert head[-1] == "too_weak"
    assert all("right hip flexion torque: 189 of 150 N m" in row[-1] for row in rows)
