"""The URDF: from xacro, deterministic, valid, the same in every reader."""

import io
import logging
import re
import runpy
import subprocess
import sys
import warnings
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest

from exo_pin import description, devices
from exo_pin.anatomy import CORNERS, FEET, HIP_ORDERS, JOINTS, Body
from exo_pin.errors import DescriptionError, UnknownNameError

ROOT = Path(__file__).resolve().parents[1]
BODY = Body.from_stature()


@pytest.fixture(scope="module")
def urdf():
    return description.urdf(BODY)


def test_the_same_body_gives_the_same_bytes_in_a_fresh_process(urdf):
    code = "from exo_pin import description as d, anatomy; print(d.urdf(anatomy.Body.from_stature()), end='')"
    fresh = subprocess.run([sys.executable, "-c", code], capture_output=True, check=True).stdout
    assert fresh.decode() == urdf


def test_no_local_path_mesh_or_negative_zero_is_in_the_text(urdf):
    assert "mesh" not in urdf
    assert "/" not in urdf.replace("/>", "").replace("</", "")
    assert not re.search(r"-0\.0(?!\d)", urdf)


def test_xacro_defaults_are_the_default_body():
    expected = runpy.run_path(str(ROOT / "scripts" / "xacro_defaults"))["text"]()
    assert (ROOT / "urdf" / "arguments.xacro").read_text() == expected, "run scripts/xacro_defaults"


def test_the_plain_xacro_command_makes_the_same_robot(urdf):
    command = Path(sys.executable).with_name("xacro")
    made = subprocess.run([command, ROOT / "urdf" / "exo12.urdf.xacro"], capture_output=True, check=True)
    strip = [" ".join((element.text or "").split()) for element in ET.fromstring(made.stdout).iter()]
    assert [element.attrib for element in ET.fromstring(made.stdout).iter()] == [
        element.attrib for element in ET.fromstring(urdf).iter()
    ]
    assert not any(strip)


@pytest.mark.parametrize("hip_order", HIP_ORDERS)
def test_every_name_is_in_the_urdf(hip_order):
    tree = ET.fromstring(description.urdf(BODY, hip_order=hip_order))
    joints = {j.get("name") for j in tree.findall("joint") if j.get("type") == "revolute"}
    links = {link.get("name") for link in tree.findall("link")}
    assert joints == set(JOINTS)
    assert {"pelvis", *FEET, *CORNERS} <= links


def test_every_joint_has_limits_effort_and_velocity_of_body_and_device(urdf):
    for joint in ET.fromstring(urdf).findall("joint[@type='revolute']"):
        limit = joint.find("limit")
        actuator = devices.EXO12.actuators[joint.get("name").split("_", 1)[1]]
        assert (float(limit.get("lower")), float(limit.get("upper"))) == BODY.limits[joint.get("name")]
        assert (float(limit.get("effort")), float(limit.get("velocity"))) == actuator[:2]


def test_yourdfpy_reads_it_without_a_warning(urdf, caplog):
    import yourdfpy

    with warnings.catch_warnings(), caplog.at_level(logging.WARNING):
        warnings.simplefilter("error")
        robot = yourdfpy.URDF.load(io.BytesIO(urdf.encode()), load_meshes=False)
        assert robot.validate()
    assert not caplog.records


def test_pinocchio_reads_it_without_a_word(urdf, capfd):
    import pinocchio as pin

    model = pin.buildModelFromXML(urdf)
    for kind in (pin.GeometryType.VISUAL, pin.GeometryType.COLLISION):
        pin.buildGeomFromUrdfString(model, urdf, kind)
    out, err = capfd.readouterr()
    assert (out, err) == ("", "")


def test_the_collision_library_loads_capsules_and_boxes_that_do_not_touch_when_standing(urdf):
    import coal
    import pinocchio as pin

    model = pin.buildModelFromXML(urdf)
    geometry = pin.buildGeomFromUrdfString(model, urdf, pin.GeometryType.COLLISION)
    kinds = [type(item.geometry) for item in geometry.geometryObjects]
    assert kinds.count(coal.Capsule) == 4  # two thighs, two shanks
    assert kinds.count(coal.Box) == 3  # waist and two feet
    names = [item.name for item in geometry.geometryObjects]
    left = [k for k, name in enumerate(names) if name.startswith("left")]
    right = [k for k, name in enumerate(names) if name.startswith("right")]
    for a in left:
        for b in right:
            geometry.addCollisionPair(pin.CollisionPair(a, b))
    assert not pin.computeCollisions(
        model, model.createData(), geometry, geometry.createData(), np.zeros(12), False
    )


def test_sizes_are_placed_where_they_belong():
    body = Body.from_stature(left_thigh=0.40, right_shank=0.39, hip_width=0.2, left_ankle_height=0.09)
    tree = ET.fromstring(description.urdf(body))

    def origin(name):
        return [float(x) for x in tree.find(f"joint[@name='{name}']/origin").get("xyz").split()]

    assert origin("left_hip_flexion") == [0, 0.1, 0]
    assert origin("right_hip_flexion") == [0, -0.1, 0]
    assert origin("left_knee_flexion") == [0, 0, -0.40]
    assert origin("right_ankle_dorsiflexion") == [0, 0, -0.39]
    assert origin("left_foot_fixed") == [0, 0, -0.09]
    assert origin("left_ball_lateral_fixed") == [body.left_ball, body.left_foot_width / 2, -0.09]


def test_waist_width_moves_the_ring_and_not_the_hips():
    wide = ET.fromstring(description.urdf(Body.from_stature(waist_width=0.5)))
    normal = ET.fromstring(description.urdf(BODY))
    hip = "joint[@name='left_hip_flexion']/origin"
    assert wide.find(hip).get("xyz") == normal.find(hip).get("xyz")
    ring = "link[@name='pelvis']/visual/origin"
    assert [o.get("xyz") for o in wide.findall(ring)] != [o.get("xyz") for o in normal.findall(ring)]


def test_a_heavier_wearer_has_wider_cuffs_and_bodies_that_grow_outwards():
    def thigh(mass):
        tree = ET.fromstring(description.urdf(Body.from_stature(mass=mass)))
        body = tree.find("link[@name='left_thigh']/collision")
        radius = float(body.find("geometry/cylinder").get("radius"))
        cuff = max(
            float(o.get("xyz").split()[0]) for o in tree.findall("link[@name='left_thigh']/visual/origin")
        )
        return radius, radius - float(body.find("origin").get("xyz").split()[1]), cuff

    light, heavy = thigh(70.0), thigh(110.0)
    growth = np.sqrt(110.0 / 70.0)
    assert heavy[0] == pytest.approx(growth * light[0], abs=2e-6)
    assert heavy[1] == pytest.approx(light[1], abs=2e-6)  # the side towards the other leg stays
    assert heavy[2] > 1.15 * light[2]


def test_single_arguments_can_be_overridden():
    text = description.urdf(BODY, left_knee_flexion_upper="1.5", left_shank_link_mass="9.5")
    tree = ET.fromstring(text)
    assert tree.find("joint[@name='left_knee_flexion']/limit").get("upper") == "1.5"
    assert tree.find("link[@name='left_shank']/inertial/mass").get("value") == "9.5"


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("left_thigh", "-0.4"),
        ("left_thigh", "40"),
        ("left_thigh", "nan"),
        ("left_thigh", "${1/0}"),
        ("left_knee_flexion_upper", "130"),
        ("left_knee_flexion_effort", "0"),
        ("left_shank_link_mass", "0"),
        ("left_shank_link_mass", "1e9"),
        ("left_shank_com", "5 5 5"),
        ("left_knee_flexion_upper", "-1"),  # below its lower limit
        ("left_shank_com", "1 2"),
        ("left_shank_inertia", "1 0 0 1 0 3"),
    ],
)
def test_absurd_arguments_are_refused(name, value):
    with pytest.raises(DescriptionError, match=name):
        description.urdf(BODY, **{name: value})


@pytest.mark.parametrize(
    "words", [{"device": "exo13"}, {"hip_order": "xyz"}, {"left_tigh": "0.4"}], ids=lambda w: next(iter(w))
)
def test_unknown_names_are_refused(words):
    with pytest.raises(UnknownNameError):
        description.urdf(BODY, **words)


@pytest.mark.parametrize("hips", [0.10, 0.25])
@pytest.mark.parametrize("device", ["exo12", "lopes8", "planar9"])
def test_parts_of_narrow_and_wide_hips_have_positive_sizes(hips, device):
    body = Body.from_stature(1.75, hip_width=hips)
    for box in ET.fromstring(description.urdf(body, device=device)).iter("box"):
        assert min(float(size) for size in box.get("size").split()) > 0
