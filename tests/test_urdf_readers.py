"""Every URDF stands alone: Pinocchio, yourdfpy, MuJoCo and PyBullet read it without a word, and agree."""

import io
import itertools
import logging
import warnings
import xml.etree.ElementTree as ET

import numpy as np
import pinocchio as pin
import pytest

from exo_pin import description
from exo_pin.anatomy import HIP_ORDERS, Body
from exo_pin.devices import DEVICES

BODIES = {
    "default": Body.from_stature(),
    "uneven": Body.from_stature(1.58, mass=52, sex="female", left_thigh=0.37, right_shank=0.36),
    "bare": Body.from_stature(1.9, mass=110, wearer=False),
}
READ = 1e-9  # m and cosines: double precision all through
SINGLE = 1e-6  # PyBullet keeps inertial frames in single precision


@pytest.fixture(params=itertools.product(DEVICES, BODIES, HIP_ORDERS), ids="-".join, scope="module")
def case(request):
    """The URDF text of a device on a body, and that body."""
    device, body, hip_order = request.param
    return description.urdf(BODIES[body], device=device, hip_order=hip_order), BODIES[body]


@pytest.fixture(scope="module")
def posture(case):
    """Values of all moving joints within their limits, and where Pinocchio puts every link."""
    model = pin.buildModelFromXML(case[0])
    q = np.random.default_rng(3).uniform(model.lowerPositionLimit, model.upperPositionLimit)
    data = model.createData()
    pin.framesForwardKinematics(model, data, q)
    links = {
        frame.name: data.oMf[k].homogeneous
        for k, frame in enumerate(model.frames)
        if frame.type == pin.FrameType.BODY and frame.name != "universe"
    }
    return dict(zip(list(model.names)[1:], q, strict=True)), links


def masses(text):
    links = ET.fromstring(text).findall("link")
    return {link.get("name"): float(link.find("inertial/mass").get("value")) for link in links}


def test_every_link_has_a_mass_and_all_of_them_together_the_body_s(case):
    text, body = case
    found = masses(text)
    assert sum(found.values()) == pytest.approx(body.total_mass, abs=1e-6)  # 9 digits each
    assert min(found.values()) > 0


def test_a_carriage_weighs_some_hundred_grams_that_the_pelvis_lacks():
    plain, slid = (masses(description.urdf(BODIES["default"], device=d)) for d in ("exo12", "lopes8"))
    carriages = [mass for name, mass in slid.items() if name.endswith("_carriage")]
    assert len(carriages) == 2
    assert all(0.1 < mass < 1.0 for mass in carriages)
    lost = sum(carriages) + slid["stand"]
    assert slid["stand"] < 0.01
    assert slid["pelvis"] == pytest.approx(plain["pelvis"] - lost, abs=1e-8)


def test_every_link_has_the_inertia_of_a_real_body(case):
    for inertia in ET.fromstring(case[0]).iter("inertia"):
        x = {name: float(value) for name, value in inertia.attrib.items()}
        a, b, c = np.linalg.eigvalsh(
            [[x["ixx"], x["ixy"], x["ixz"]], [x["ixy"], x["iyy"], x["iyz"]], [x["ixz"], x["iyz"], x["izz"]]]
        )
        assert a > 0
        assert a + b >= c * (1 - 1e-6)


def test_pinocchio_weighs_what_moves_and_says_nothing(case, capfd):
    text, body = case
    model = pin.buildModelFromXML(text, pin.JointModelFreeFlyer())
    assert pin.computeTotalMass(model) == pytest.approx(body.total_mass, abs=1e-6)
    assert capfd.readouterr() == ("", "")


def test_yourdfpy_agrees(case, posture, caplog, capfd):
    import yourdfpy

    values, links = posture
    with warnings.catch_warnings(), caplog.at_level(logging.WARNING):
        warnings.simplefilter("error")
        robot = yourdfpy.URDF.load(io.BytesIO(case[0].encode()), load_meshes=False)
        robot.update_cfg(values)
    for name, T in links.items():
        np.testing.assert_allclose(robot.get_transform(name), T, atol=READ, err_msg=name)
    assert not caplog.records
    assert capfd.readouterr() == ("", "")


def test_mujoco_agrees(case, posture, capfd):
    mujoco = pytest.importorskip("mujoco", reason="MuJoCo is not installed (extra `oracle`)")
    values, links = posture
    said = []
    mujoco.set_mju_user_warning(said.append)
    spec = mujoco.MjSpec.from_string(case[0])
    model = spec.compile()  # as it is given: links on fixed joints become part of their parents
    spec = mujoco.MjSpec.from_string(case[0])
    spec.compiler.fusestatic = False
    whole = spec.compile()
    mujoco.set_mju_user_warning(None)
    assert not said
    assert capfd.readouterr() == ("", "")
    assert (model.njnt, model.nq) == (len(values), len(values))
    data = mujoco.MjData(whole)
    for name, value in values.items():
        data.joint(name).qpos = value
    mujoco.mj_kinematics(whole, data)
    assert whole.nbody == len(links) + 1  # and MuJoCo's world
    for name in links:
        body = data.body(name)
        np.testing.assert_allclose(body.xpos, links[name][:3, 3], atol=READ, err_msg=name)
        np.testing.assert_allclose(body.xmat.reshape(3, 3), links[name][:3, :3], atol=READ, err_msg=name)


def test_pybullet_agrees(case, posture, capfd, tmp_path):
    bullet = pytest.importorskip("pybullet", reason="PyBullet is not installed (extra `oracle`)")
    values, links = posture
    file = tmp_path / "exo.urdf"
    file.write_text(case[0])
    world = bullet.connect(bullet.DIRECT)
    try:
        capfd.readouterr()  # what it says of itself
        robot = bullet.loadURDF(str(file), useFixedBase=True, flags=bullet.URDF_USE_INERTIA_FROM_FILE)
        assert capfd.readouterr() == ("", "")
        rows = [bullet.getJointInfo(robot, k) for k in range(bullet.getNumJoints(robot))]
        for k, row in enumerate(rows):
            bullet.resetJointState(robot, k, values.get(row[1].decode(), 0.0))
        found = {
            row[12].decode(): bullet.getLinkState(robot, k, computeForwardKinematics=True)[4:6]
            for k, row in enumerate(rows)
        }
        weights = {row[12].decode(): bullet.getDynamicsInfo(robot, k)[0] for k, row in enumerate(rows)}
    finally:
        bullet.disconnect(world)
    root = next(iter(links))
    assert {root: masses(case[0])[root]} | weights == pytest.approx(masses(case[0]), abs=1e-9)
    for name, (place, turn) in found.items():
        np.testing.assert_allclose(place, links[name][:3, 3], atol=SINGLE, err_msg=name)
        R = np.reshape(bullet.getMatrixFromQuaternion(turn), (3, 3))
        np.testing.assert_allclose(R, links[name][:3, :3], atol=SINGLE, err_msg=name)
