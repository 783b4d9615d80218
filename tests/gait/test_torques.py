"""Joint torques: data, files, signs, and how they reach the plots."""

from __future__ import annotations

import dataclasses

import numpy as np
import pinocchio as pin
import pytest

from exo_pin import signals, viewer
from exo_pin.anatomy import JOINTS, SIDES, Body
from exo_pin.errors import FormatError, GaitError, UnknownNameError
from exo_pin.formats import knee_preset, load_gait, load_torques, open_trial, save_gait
from exo_pin.formats.c3d import C3dFile
from exo_pin.gait import Torques, normative_gait
from exo_pin.robot import load_robot

SWING = (0.80, 1.23)  # [s] subject01's left foot is in the air: its force plates say 0.788 .. 1.247
ALIKE = 0.8  # correlation: another body's masses, but the same movement
SAME, SCALE = 0.95, 0.25  # Plug-in Gait's powers take the whole angular velocity: the ankle's differ by 18 %
KNEE, ANKLE = JOINTS.index("left_knee_flexion"), JOINTS.index("left_ankle_dorsiflexion")


@pytest.fixture
def walk(shared):
    return shared / "opensim_subject01_walk"


def some(n=11, end=1.0):
    return Torques(np.linspace(0, end, n), np.outer(np.linspace(0, 10, n), np.arange(1, 13)), source="made")


def table(path, header, *rows):
    path.write_text("\n".join([header, *rows]) + "\n")
    return path


def swing(walk, robot, torques):
    """Torques of the left leg in swing: by Newton and Euler on our model, and those of the file."""
    gait = load_gait(walk / "subject01_walk1_ik.mot")
    gait = dataclasses.replace(gait, q=signals.lowpass(gait.time, gait.q, cutoff=6.0))
    q, step = robot.from_gait(gait), np.mean(np.diff(gait.time))
    v = [pin.difference(robot.model, a, b) / (2 * step) for a, b in zip(q, q[2:], strict=False)]
    a = [(b - a) / (2 * step) for a, b in zip(v, v[2:], strict=False)]
    data = robot.model.createData()
    tau = np.array([pin.rnea(robot.model, data, *qva) for qva in zip(q[2:-2], v[1:-1], a, strict=True)])
    inside = (gait.time[2:-2] > SWING[0]) & (gait.time[2:-2] < SWING[1])
    return tau[inside, 6:], torques.at(gait.time[2:-2])[inside]


def test_opensims_moments_drive_the_swinging_leg_as_our_model_does(walk):
    robot = load_robot(Body.from_stature(1.80, mass=72.6), base="floating")
    told = load_torques(walk / "subject01_walk1_id.sto", preset="opensim-gait2392")
    tau, given = swing(walk, robot, told)
    for joint in ("left_hip_flexion", "left_knee_flexion", "left_ankle_dorsiflexion"):
        k = JOINTS.index(joint)
        assert np.corrcoef(tau[:, k], given[:, k])[0, 1] > ALIKE
    wrong = load_torques(walk / "subject01_walk1_id.sto", preset="opensim-rajagopal")
    assert np.array_equal(wrong.tau[:, KNEE], -told.tau[:, KNEE])


def test_push_off_is_a_plantarflexors_and_gives_power(walk):
    gait = load_gait(walk / "subject01_walk1_ik.mot")
    torques = load_torques(
        walk / "subject01_walk1_id.sto", preset=knee_preset(walk / "subject01_walk1_ik.mot")
    )
    ankle = torques.at(gait.time)[:, ANKLE]
    hardest = ankle.argmin()
    assert ankle[hardest] < -50
    power = ankle * gait.dq[:, ANKLE]
    assert power[hardest : hardest + 12].max() > 50  # [W] in the fifth of a second after


def test_plug_in_gaits_moments_give_the_powers_that_it_computed(shared):
    path = shared / "c3d_pig_walk_HC036A" / "HC036A10_walk.c3d"
    torques, gait = load_torques(path), load_gait(path)
    power = torques.at(gait.time) * gait.dq
    names = {
        f"{side[0].upper()}{part}Power": (side, part) for side in SIDES for part in ("Hip", "Knee", "Ankle")
    }
    file = open_trial(path)
    assert isinstance(file, C3dFile)
    content, mass = file.content, file.person().mass
    for name, (side, part) in names.items():
        mine = [k for k, joint in enumerate(JOINTS) if joint.startswith(f"{side}_{part.lower()}")]
        ours, theirs = np.nansum(power[:, mine], axis=1), mass * content.output(name)[:, 2]
        both = np.isfinite(power[:, mine[0]]) & np.isfinite(theirs)
        assert both.sum() > 100
        assert np.corrcoef(ours[both], theirs[both])[0, 1] > SAME
        assert np.polyfit(theirs[both], ours[both], 1)[0] == pytest.approx(1, abs=SCALE)
    assert load_torques(path, mass=66).tau[100] == pytest.approx(2 * torques.tau[100], nan_ok=True)
    assert np.isnan(torques.tau[:, JOINTS.index("left_ankle_inversion")]).all()


def test_a_trial_without_moments_is_refused(tmp_path):
    save_gait(normative_gait(), tmp_path / "angles.c3d")
    with pytest.raises(FormatError, match="no joint moments"):
        load_torques(tmp_path / "angles.c3d")


def test_a_knee_whose_sign_nobody_tells_is_refused(walk):
    with pytest.raises(FormatError, match="sign of the model's knee"):
        load_torques(walk / "subject01_walk1_id.sto")
    with pytest.raises(UnknownNameError):
        load_torques(walk / "subject01_walk1_id.sto", preset="opensim")


def test_angles_are_not_taken_for_torques(walk):
    with pytest.raises(FormatError, match="no joint moments"):
        load_torques(walk / "subject01_walk1_ik.mot", preset="opensim-gait2392")


def test_our_table_may_know_some_joints_only(tmp_path):
    path = table(tmp_path / "t.csv", "time_s,right_knee_flexion_torque_nm", "0,1.5", "0.5,-2", "1,0")
    torques = load_torques(path)
    assert torques.joints == ("right_knee_flexion",)
    assert torques.at([0.25])[0, JOINTS.index("right_knee_flexion")] == pytest.approx(-0.25)
    assert torques.source == "t.csv"


@pytest.mark.parametrize(
    ("header", "row", "said"),
    [
        ("time_s,left_knee_torque_nm", "1", "did you mean 'left_knee_flexion_torque_nm'"),
        ("time_s", "1", "no torques"),
        ("time_s,left_knee_flexion_torque_nm", "nan", "finite"),
        ("time_s,left_knee_flexion_torque_nm", "40000", "N mm"),
    ],
)
def test_bad_tables_are_refused_with_a_reason(tmp_path, header, row, said):
    columns = header.count(",")
    rows = [",".join([str(t), *[row] * columns]) for t in (0, 1)]
    with pytest.raises(FormatError, match=said):
        load_torques(table(tmp_path / "bad.csv", header, *rows))
    with pytest.raises(FormatError, match="unknown kind of file"):
        load_torques(tmp_path / "bad.xlsx")


def test_torques_are_linear_between_samples_and_unknown_outside():
    torques = some()
    assert torques.at([0.25])[0] == pytest.approx(2.5 * np.arange(1, 13))
    assert np.isnan(torques.at([0.5, 1.5])[1]).all()
    with pytest.raises(GaitError, match="share a clock"):
        torques.at([2.0, 3.0])


def test_unusable_torques_are_refused():
    time, tau = np.linspace(0, 1, 4), np.zeros((4, 12))
    for bad, said in (
        (tau[:, :6], "shape"),
        (tau + np.inf, "N mm"),
        (np.full_like(tau, np.nan), "no torque"),
        (tau + 1e6, "N mm"),
    ):
        with pytest.raises(GaitError, match=said):
            Torques(time, bad)
    with pytest.raises(ValueError, match="read-only"):
        some().tau[0, 0] = 1


def test_the_scene_has_a_tab_of_torques_with_the_actuators_limits():
    robot, gait = load_robot(), normative_gait()
    scene = viewer.scene(robot, gait, torques=some(end=2.0))
    (tab,) = [group for group in scene.facts.plots if group.title == "Torques"]
    knee = next(plot for plot in tab.plots if plot.title == "Knee flexion")
    effort = robot.effort[robot.joints.index("left_knee_flexion")]
    assert [(s.lower, s.upper) for s in knee.series] == [(-effort, effort)] * 2
    assert knee.factor == 1
    np.testing.assert_allclose(scene.arrays["torques"], some(end=2.0).at(gait.time), rtol=1e-6)
    assert any("Torques (made)" in note for note in scene.facts.notes)
    assert [group.title for group in viewer.scene(robot, gait).facts.plots] == [
        "Angles",
        "Velocities",
        "Pelvis",
    ]
