"""Devices: records that hold together, URDFs that are the full model with joints locked, own files."""

import dataclasses
import functools
import io
import json
import logging
import pickle
import warnings
import xml.etree.ElementTree as ET

import numpy as np
import pytest

from exo_pin import crosscheck, devices
from exo_pin.anatomy import HIP_ORDERS, JOINTS, MOVEMENTS, Body
from exo_pin.cli import main
from exo_pin.devices import DEVICES, Actuator, Device
from exo_pin.errors import DescriptionError, FormatError, UnknownNameError
from exo_pin.gait import normative_gait
from exo_pin.kinematics import center_of_mass, poses
from exo_pin.robot import load_robot

UNEVEN = Body.from_stature(1.68, left_thigh=0.40, right_ball=0.10, waist_width=0.41)
FULL = load_robot(UNEVEN)
robots = functools.cache(functools.partial(load_robot, UNEVEN))
EXACT = 1e-12  # the same arithmetic in another order
ROUNDED = 1e-9  # inertias are written to the URDF in steps of 1e-9
COUNTS = {"lokomat": 4, "lopes7": 7, "lopes8": 8, "h2": 6, "hk4": 4, "planar5": 4, "planar7": 6, "planar9": 8}
all_devices = pytest.mark.parametrize("name", DEVICES)


def test_the_motors_are_those_that_the_literature_counts():
    assert {name: DEVICES[name].motors for name in COUNTS} == COUNTS
    assert DEVICES["exo12"].motors == 12


@all_devices
def test_a_device_goes_to_another_process_whole(name):
    again = pickle.loads(pickle.dumps(DEVICES[name]))
    assert repr(again) == repr(DEVICES[name])


@all_devices
def test_every_joint_is_driven_or_locked_and_the_source_is_told(name):
    device = DEVICES[name]
    assert {*device.joints, *device.locked} == set(JOINTS)
    assert not set(device.joints) & set(device.locked)
    assert set(device.passive) <= set(device.locked)
    assert len(device.source) > 40
    assert device.title


@all_devices
@pytest.mark.parametrize("hip_order", HIP_ORDERS)
def test_the_device_is_the_full_model_with_its_locked_joints_at_zero(name, hip_order, rng):
    robot, full = (
        load_robot(UNEVEN, device=name, hip_order=hip_order),
        load_robot(UNEVEN, hip_order=hip_order),
    )
    q = rng.uniform(robot.lower, robot.upper, (20, robot.nq))
    whole = np.zeros((20, 12))
    for joint in set(robot.joints) & set(JOINTS):
        whole[:, full.column(joint)] = q[:, robot.column(joint)]
    shared = [frame for frame in full.frames if frame in robot.frames]
    assert set(shared) == set(full.frames)
    mine = poses(robot, q, shared, base=np.eye(4))
    theirs = robot.slid(q)[:, None] @ poses(full, whole, shared, base=np.eye(4))
    assert np.abs(mine - theirs).max() <= EXACT


@all_devices
@pytest.mark.parametrize("hip_order", HIP_ORDERS)
def test_three_witnesses_agree_on_every_device(name, hip_order, rng):
    robot = robots(device=name, hip_order=hip_order)
    q = rng.uniform(robot.lower, robot.upper, (30, robot.nq))
    assert max(crosscheck.forward(robot, q).values()) <= EXACT


@all_devices
def test_masses_and_the_standing_centre_of_mass_are_kept(name):
    robot = robots(device=name)
    assert sum(i.mass for i in robot.model.inertias) == pytest.approx(UNEVEN.total_mass, abs=ROUNDED)
    centre, whole = (center_of_mass(r, r.q()).position for r in (robot, FULL))
    assert centre == pytest.approx(whole, abs=ROUNDED)


@all_devices
def test_every_reader_takes_the_urdf_without_a_word(name, capfd, caplog):
    import pinocchio as pin
    import yourdfpy

    text = robots(device=name).urdf
    model = pin.buildModelFromXML(text)
    pin.buildGeomFromUrdfString(model, text, pin.GeometryType.COLLISION)
    with warnings.catch_warnings(), caplog.at_level(logging.WARNING):
        warnings.simplefilter("error")
        assert yourdfpy.URDF.load(io.BytesIO(text.encode()), load_meshes=False).validate()
    assert (*capfd.readouterr(), caplog.records) == ("", "", [])
    assert model.name == name


@all_devices
def test_motors_are_drawn_only_where_the_device_drives(name):
    device = DEVICES[name]
    tree = ET.fromstring(robots(device=name).urdf)
    discs = {
        joint: sum(
            visual.find("geometry/cylinder") is not None and visual.find("material").get("name") == side
            for visual in tree.findall(f"link[@name='{child}']/visual")
        )
        for side in ("left", "right")
        for joint, child in _children(tree, side).items()
    }
    drawn = {joint for joint, count in discs.items() if count}
    rails = {joint for joint in JOINTS if joint.endswith("hip_rotation")}  # a rail, not a round motor
    assert drawn == set(device.joints) - rails


def _children(tree, side):
    names = [f"{side}_{movement}" for movement in MOVEMENTS]
    return {name: tree.find(f"joint[@name='{name}']/child").get("link") for name in names}


@all_devices
@pytest.mark.parametrize("base", ["fixed", "floating"])
def test_a_gait_loses_the_locked_joints_and_nothing_else(name, base):
    gait = normative_gait()
    robot = robots(device=name, base=base)
    back = robot.to_gait(robot.from_gait(gait), gait)
    kept = np.isin(JOINTS, DEVICES[name].joints)
    assert np.array_equal(back.q[:, kept], gait.q[:, kept])
    assert not back.q[:, ~kept].any()
    assert back.base == pytest.approx(gait.base, abs=EXACT)


def test_slides_come_back_as_motion_of_the_pelvis():
    gait = normative_gait()
    robot = robots(device="lopes8")
    q = robot.from_gait(gait)
    q[:, robot.column("pelvis_left")] = 0.03
    back = robot.to_gait(q, dataclasses.replace(gait, base=None))
    assert back.base[:, :3, 3] == pytest.approx(np.tile(robot.placement[:3, 3] + [0.0, 0.03, 0.0], (100, 1)))
    straight = poses(FULL, back.q, base=back.base)
    assert straight == pytest.approx(poses(robot, q), abs=EXACT)


def test_a_floating_device_has_no_slides():
    assert not set(robots(device="lopes8", base="floating").joints) & set(devices.SLIDES)


def test_toes_move_only_the_toes(rng):
    robot = robots(device="planar9")
    q = robot.q({"left_toe_dorsiflexion": 0.5})
    before, after = (
        poses(robot, x, ("left_toe_plate", "left_foot", "left_ball_medial")) for x in (robot.q(), q)
    )
    assert np.array_equal(after[1:], before[1:])
    assert after[0, 2, 0] > 0  # the toes' forward axis now points up


def test_released_joints_move_without_torque():
    device = DEVICES["lokomat"].released()
    assert device.motors == DEVICES["lokomat"].motors
    robot = load_robot(device=device)
    assert robot.effort[robot.joints.index("left_ankle_dorsiflexion")] == 0


def test_a_joint_s_range_is_what_device_and_body_both_allow():
    robot = load_robot(device=DEVICES["h2"].released())
    k = robot.joints.index("left_hip_adduction")
    assert np.degrees([robot.lower[k], robot.upper[k]]) == pytest.approx([-20, 20])
    narrow = Body.from_stature(limits={"left_hip_adduction": (0.5, 0.6)})
    with pytest.raises(DescriptionError, match="do not meet"):
        load_robot(narrow, device=DEVICES["h2"])


@pytest.mark.parametrize(
    "wrong",
    [
        {"name": "Two words"},
        {"joints": ()},
        {"joints": ("left_wing",)},
        {"passive": ("left_knee_flexion",)},
        {"pelvis": "flying"},
        {"pelvis": ("pelvis_down",)},
        {"actuators": {"knee": Actuator(1, 1)}},
        {"actuators": {"knee_flexion": Actuator(-1, 1)}},
        {"actuators": {"knee_flexion": Actuator(1, float("nan"))}},
        {"ranges": {"knee_flexion": (1.0, 0.0)}},
        {"treadmill": (1.0, 0.5)},
        {"statures": (1.0, float("nan"))},
    ],
    ids=str,
)
def test_contradictory_records_are_refused(wrong):
    good = {"name": "mine", "joints": ("left_knee_flexion", "right_knee_flexion"), "source": "test"}
    Device(**good)
    with pytest.raises(DescriptionError):
        Device(**good | wrong)


MINE = """
name = "mine"
title = "Hip and knee, one ankle"
joints = ["hip_flexion", "knee_flexion", "left_ankle_dorsiflexion"]
passive = ["right_ankle_dorsiflexion"]
pelvis = ["pelvis_up"]
treadmill_km_h = [0.36, 3.6]
statures_m = [1.5, 1.9]
source = "our workshop"
[actuators.knee_flexion]
effort_nm = 35
[ranges_deg]
knee_flexion = [5, 100]
[ranges_m]
pelvis_up = [-0.02, 0.05]
"""


def test_a_device_of_one_s_own_is_a_file(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(MINE)
    robot = load_robot(device=str(path))
    assert (robot.name, robot.nq) == ("mine", 6)
    knee = robot.joints.index("left_knee_flexion")
    assert np.degrees([robot.lower[knee], robot.upper[knee]]) == pytest.approx([5, 100])
    assert robot.effort[knee] == 35
    assert robot.device.treadmill == pytest.approx((0.1, 1.0))
    assert robot.device.statures == (1.5, 1.9)
    assert (robot.lower[0], robot.upper[0]) == (-0.02, 0.05)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('name = "mine"', ""),
        ('"hip_flexion", ', '"hip_flexon", '),
        ("effort_nm", "torque"),
        ("35", '"35"'),
        ("[5, 100]", "[5]"),
        ("[0.36, 3.6]", "[3.6]"),
        ("[1.5, 1.9]", "[1.9, 1.5]"),
        ("[ranges_m]", "[ranges_deg2]"),
        ('["pelvis_up"]', "true"),
        ("[ranges_deg]\nknee_flexion", "[ranges_deg]\npelvis_up"),
        ("[ranges_m]\npelvis_up", "[ranges_m]\npelvis_left"),
        ("[actuators.knee_flexion]", "[actuators.toe_dorsiflexion]"),
        ('source = "', 'source = "" # "'),
        ('name = "mine"', 'name = "lokomat"'),
    ],
)
def test_a_wrong_device_file_is_refused_by_name(tmp_path, old, new):
    path = tmp_path / "mine.toml"
    assert old in MINE
    path.write_text(MINE.replace(old, new, 1))
    with pytest.raises(FormatError, match=r"mine\.toml"):
        devices.find(str(path))


def test_unknown_devices_are_refused_with_a_hint():
    with pytest.raises(UnknownNameError, match="lokomat"):
        devices.find("locomat")
    with pytest.raises(FormatError, match=r"walker\.urdf: a robot's description is no device"):
        devices.find("walker.urdf")


@pytest.mark.parametrize("name", ["lokomat", "lopes8", "planar9"])
def test_check_finds_all_is_well_on_a_device(name, capsys):
    assert main(["check", "slow", "--device", name, "--json"]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert max(facts["fk_max_difference"].values()) <= EXACT
    assert facts["ik"]["converged"] == facts["ik"]["frames"]
    assert facts["ik"]["max_angle_error_deg"] < 1e-3


def test_the_devices_are_listed_and_shown_with_their_sources(capsys):
    assert main(["devices"]) == 0
    listed = capsys.readouterr().out
    assert all(name in listed for name in DEVICES)
    assert main(["devices", "lopes8"]) == 0
    assert "Veneman" in capsys.readouterr().out
    assert main(["devices", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["lokomat"]["motors"] == 4
    assert all(set(d["ranges"]) <= set(d["actuators"]) for d in told.values())


def test_every_number_of_a_device_has_a_source_or_is_called_a_choice():
    for device in DEVICES.values():
        words = " ".join((device.source, *device.remarks))
        assert "design choice" in words
        assert ("slides: a design choice" in words) == bool(device.slides)
        assert ("Toe joint" in words) == device.toes
        if device.treadmill:
            assert all(f"{3.6 * speed:g}" in words for speed in device.treadmill)
        if device.statures:
            assert all(f"{stature:.2f}" in words for stature in device.statures)


def test_the_urdf_command_writes_a_device(capsys):
    assert main(["urdf", "device:=lokomat"]) == 0
    tree = ET.fromstring(capsys.readouterr().out)
    moving = {j.get("name") for j in tree.findall("joint") if j.get("type") != "fixed"}
    assert moving == {*DEVICES["lokomat"].joints, "pelvis_up"}


def test_what_the_device_leaves_free_is_let_go():
    for name in ("lopes7", "lopes8"):
        free = DEVICES[name].released()
        assert {"left_ankle_dorsiflexion", "right_ankle_inversion"} <= set(free.joints)
        assert free.motors == DEVICES[name].motors
        assert any("ankle is held" in remark for remark in DEVICES[name].remarks)
