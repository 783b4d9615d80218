"""The ROS 2 package: every file parsed, every xacro expanded and compared with our URDF."""

import ast
from xml.etree import ElementTree

import numpy as np
import pytest
import xacro
import yaml

from exo_pin import Body, load_robot, normative_gait
from exo_pin.errors import DescriptionError, FormatError
from exo_pin.export import ros2
from exo_pin.formats import load_gait
from exo_pin.robot import load_urdf

BODY = Body.from_stature(1.62, mass=58, sex="female", left_thigh=0.39)
WALK = normative_gait("slow")


@pytest.fixture(scope="module", params=["exo12", "lokomat"])
def package(request, tmp_path_factory):
    folder = tmp_path_factory.mktemp("ros") / "exo_description"
    robot = load_robot(BODY, device=request.param)
    ros2(robot, WALK, folder)
    return robot, folder


def expanded(path):
    return xacro.process_file(str(path)).documentElement


def elements(root):
    """Tags, attributes and texts in their order, comments and blanks left out."""
    return [
        (e.tag, sorted(e.attrib.items()), (e.text or "").strip())
        for e in root.iter()
        if isinstance(e.tag, str)
    ]


def test_its_xacro_expands_to_the_robot(package):
    robot, folder = package
    found = ElementTree.fromstring(expanded(folder / "urdf/exo.urdf.xacro").toxml())
    assert elements(found) == elements(ElementTree.fromstring(robot.urdf))
    assert (folder / "urdf/exo.urdf").read_text() == robot.urdf


def test_ros2_control_adds_interfaces_within_the_motors_limits_and_nothing_else(package):
    robot, folder = package
    found = ElementTree.fromstring(expanded(folder / "urdf/exo.ros2_control.urdf.xacro").toxml())
    control = found.find("ros2_control")
    found.remove(control)
    assert elements(found) == elements(ElementTree.fromstring(robot.urdf))
    assert control.findtext("hardware/plugin").strip() == "mock_components/GenericSystem"
    driven = [name for name, effort in zip(robot.joints, robot.effort, strict=True) if effort > 0]
    assert [joint.get("name") for joint in control.findall("joint")] == driven
    for joint in control.findall("joint"):
        k = robot.joints.index(joint.get("name"))
        wanted = {"position": [robot.lower[k], robot.upper[k]], "effort": [-robot.effort[k], robot.effort[k]]}
        for command in joint.findall("command_interface"):
            assert [float(p.text) for p in command.findall("param")] == wanted[command.get("name")]


def test_its_other_files_parse(package):
    _, folder = package
    assert ElementTree.parse(folder / "package.xml").findtext("name") == "exo_description"
    assert "project(exo_description)" in (folder / "CMakeLists.txt").read_text()
    for launch in (folder / "launch").glob("*.py"):
        functions = [n.name for n in ast.parse(launch.read_text()).body if isinstance(n, ast.FunctionDef)]
        assert functions == ["generate_launch_description"]
    for path in (*folder.glob("config/*.yaml"), folder / "rviz/exo.rviz"):
        assert yaml.safe_load(path.read_text())
    assert not [path for path in folder.rglob("*") if path.is_file() and "@" in path.name]


def test_controllers_limits_and_trajectory_name_the_driven_joints(package):
    robot, folder = package
    driven = [name for name, effort in zip(robot.joints, robot.effort, strict=True) if effort > 0]
    loaded = yaml.safe_load((folder / "config/controllers.yaml").read_text())
    assert loaded["joint_trajectory_controller"]["ros__parameters"]["joints"] == driven
    limits = yaml.safe_load((folder / "config/joint_limits.yaml").read_text())["joint_limits"]
    assert [limits[name]["max_effort"] for name in driven] == robot.effort[robot.effort > 0].tolist()
    message = yaml.safe_load((folder / "trajectories/walk.yaml").read_text())
    assert message["joint_names"] == driven
    q = np.array([point["positions"] for point in message["points"]])
    columns = [robot.joints.index(name) for name in driven]
    np.testing.assert_array_equal(q, robot.angles(robot.from_gait(WALK))[:, columns])


def test_the_trajectory_of_twelve_joints_is_read_back_as_the_walk(tmp_path):
    ros2(load_robot(), WALK, tmp_path / "exo_description")
    back = load_gait(tmp_path / "exo_description/trajectories/walk.yaml")
    np.testing.assert_allclose(back.q, WALK.q, atol=1e-12)


def test_a_folder_that_holds_files_and_a_name_that_ros_refuses_are_not_written_to(tmp_path):
    (tmp_path / "mine.txt").write_text("kept")
    for folder, error in ((tmp_path, FormatError), (tmp_path / "Exo-1", DescriptionError)):
        with pytest.raises((error, DescriptionError)):
            ros2(load_robot(), WALK, folder)
    assert [path.name for path in tmp_path.iterdir()] == ["mine.txt"]


def test_a_urdf_from_elsewhere_has_its_own_description(tmp_path):
    with pytest.raises(DescriptionError, match="elsewhere"):
        ros2(load_urdf(load_robot().urdf), WALK, tmp_path / "exo_description")
