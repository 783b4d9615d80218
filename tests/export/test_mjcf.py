"""The MuJoCo scene against the URDF that it was made from, read by Pinocchio."""

from xml.etree import ElementTree

import mujoco
import numpy as np
import pinocchio as pin
import pytest

from exo_pin import Body, load_robot, normative_gait
from exo_pin.devices import DEVICES
from exo_pin.errors import UnknownNameError
from exo_pin.export import mjcf
from exo_pin.gait.time_series import at_phase
from exo_pin.ground import belt_speed, place_walk

EXACT = 1e-12
"""Numbers are written in full digits; principal axes of inertia are turned once."""

LAG = 4.0
"""A servo whose target has no speed trails the walk by some degrees [deg]; one that falls is off by 30."""

ODD = Body.from_stature(stature=1.7133, mass=63.217, left_thigh=0.4011, right_shank=0.4173)
WALK = normative_gait("slow")


@pytest.fixture(scope="module", params=["exo12", "lokomat", "lopes8"])
def pair(request):
    robot = load_robot(ODD, device=request.param)
    return robot, mujoco.MjModel.from_xml_string(mjcf(robot, WALK))


def test_links_have_the_masses_and_inertias_of_the_urdf(pair):
    robot, scene = pair
    for link in ElementTree.fromstring(robot.urdf).iter("link"):
        inertial, body = link.find("inertial"), scene.body(link.get("name"))
        if inertial is None:
            continue
        R, entry = np.empty(9), inertial.find("inertia").get
        mujoco.mju_quat2Mat(R, body.iquat)
        turned = R.reshape(3, 3) @ np.diag(body.inertia) @ R.reshape(3, 3).T
        wanted = [[float(entry("i" + "".join(sorted(a + b)))) for b in "xyz"] for a in "xyz"]
        assert body.mass[0] == float(inertial.find("mass").get("value"))
        np.testing.assert_allclose(
            body.ipos, np.array(inertial.find("origin").get("xyz").split(), float), atol=EXACT
        )
        np.testing.assert_allclose(turned, wanted, atol=EXACT)


def test_links_stand_where_pinocchio_has_them(pair):
    robot, scene = pair
    data, rng = mujoco.MjData(scene), np.random.default_rng(1)
    q = robot.neutral
    for name, lower, upper in zip(robot.joints, robot.lower, robot.upper, strict=True):
        q[robot.column(name)] = rng.uniform(lower, upper)
        data.qpos[scene.joint(name).qposadr[0]] = q[robot.column(name)]
    if scene.nq > len(robot.joints):
        data.qpos[:7] = [*robot.placement[:3, 3], 1.0, 0.0, 0.0, 0.0]
    mujoco.mj_kinematics(scene, data)
    places = robot.model.createData()
    pin.framesForwardKinematics(robot.model, places, q)
    for name in robot.frames:
        T = places.oMf[robot.frame(name)]
        np.testing.assert_allclose(data.body(name).xpos, T.translation, atol=EXACT)
        np.testing.assert_allclose(data.body(name).xmat.reshape(3, 3), T.rotation, atol=EXACT)


def test_limits_are_those_of_the_urdf(pair):
    robot, scene = pair
    for name, *limits, effort in zip(robot.joints, robot.lower, robot.upper, robot.effort, strict=True):
        assert scene.joint(name).range.tolist() == limits
        if effort > 0.0:
            assert scene.actuator(name).forcerange.tolist() == [-effort, effort]


def test_keyframes_put_the_standing_foot_on_the_floor():
    scene = mujoco.MjModel.from_xml_string(mjcf(load_robot(ODD), WALK))
    data = mujoco.MjData(scene)
    for key in range(scene.nkey):
        mujoco.mj_resetDataKeyframe(scene, data, key)
        mujoco.mj_kinematics(scene, data)
        lowest = min(data.geom(k).xpos[2] for k in range(scene.ngeom) if scene.geom_contype[k])
        assert lowest - scene.geom("left_heel_medial").size[0] == pytest.approx(0.0, abs=0.02)


@pytest.mark.parametrize("device", DEVICES)
def test_every_device_stands_in_its_support_by_servos(device):
    scene = mujoco.MjModel.from_xml_string(mjcf(load_robot(device=device), actuators="servo", support=True))
    data = mujoco.MjData(scene)
    mujoco.mj_resetDataKeyframe(scene, data, 0)
    mujoco.mj_forward(scene, data)
    height = float(data.body("pelvis").xpos[2])
    for _ in range(300):
        mujoco.mj_step(scene, data)
    assert data.body("pelvis").xpos[2] == pytest.approx(height, abs=0.02)
    assert np.isfinite(data.sensordata).all()


def test_a_kind_of_actuator_that_does_not_exist_is_refused():
    with pytest.raises(UnknownNameError):
        mjcf(load_robot(), actuators="spring")


def test_its_own_servos_and_support_walk():
    """As docs/exports.md shows it: controls follow the walk's angles, the mocap body the pelvis."""
    robot = load_robot()
    placed = place_walk(robot, WALK)
    scene = mujoco.MjModel.from_xml_string(mjcf(robot, WALK, actuators="servo", support=True))
    data, speed = mujoco.MjData(scene), belt_speed(WALK, placed.base, placed.corners)
    mujoco.mj_resetDataKeyframe(scene, data, scene.key("walk_0").id)
    columns = [robot.joints.index(scene.actuator(k).name) for k in range(scene.nu)]
    wrong = []
    for _ in range(1500):
        phase = data.time / WALK.duration % 1.0
        q = at_phase(placed.q, np.array([phase]))[0][columns]
        data.ctrl[:] = q
        data.mocap_pos[0] = at_phase(placed.base[:, :3, 3], np.array([phase]))[0] + [speed * data.time, 0, 0]
        mujoco.mj_step(scene, data)
        wrong.append(data.actuator_length - q)
    assert np.degrees(np.sqrt(np.mean(np.square(wrong)))) < LAG
    assert data.body("pelvis").xpos[2] == pytest.approx(robot.placement[2, 3], abs=0.05)
