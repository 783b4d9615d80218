"""Robots of one's own: a URDF by itself, a TOML record of it, and what is refused in them."""

import math
import re
import xml.etree.ElementTree as ET

import numpy as np
import pytest

from exo_pin.cli import main
from exo_pin.errors import DescriptionError, ExoPinError, FormatError, UnknownNameError
from exo_pin.gait import normative_gait
from exo_pin.gait.rigid_poses import about
from exo_pin.kinematics import poses
from exo_pin.retarget import TARGETS, load, retarget
from exo_pin.retarget.axes import angles_about, nearest_axis, unit_vector
from exo_pin.robot import load_urdf

GAIT = normative_gait().resampled(10)
ROUNDING = 1e-12


def text(name):
    return load(name).robot.path.read_text("utf-8")


@pytest.mark.parametrize("name", [name for name in TARGETS if name != "simple_humanoid"])
def test_a_file_alone_walks_as_the_record_of_the_same_robot(name, tmp_path):
    path = tmp_path / "mine.urdf"
    path.write_text(text(name), "utf-8")
    alone, known = load(path), load(name)
    assert [leg.joints for leg in alone.legs] == [leg.joints for leg in known.legs]
    assert alone.rotation == pytest.approx(known.rotation)
    assert alone.robot.path == path


def test_a_robot_that_is_loaded_already_walks_wherever_it_stands():
    robot = load_urdf(load("talos").robot.path, base="floating")
    assert retarget(GAIT, robot).q == pytest.approx(retarget(GAIT, "talos").q, abs=ROUNDING)


def test_a_record_says_feet_front_stand_and_limits(tmp_path):
    (tmp_path / "mine.urdf").write_text(text("simple_humanoid"), "utf-8")
    record = tmp_path / "mine.toml"
    record.write_text(
        'urdf = "mine.urdf"\nname = "mine"\ntitle = "My robot"\nfeet = ["l_ankle", "r_ankle"]\n'
        'forward = "x"\nup = "z"\nremarks = "seen"\n'
        "[limits_deg]\nLLEG_KNEE = [0, 150]\nRLEG_KNEE = [-1.5, 90]\n[stand_deg]\nLARM_ELBOW = -20\n",
        "utf-8",
    )
    biped = load(record)
    robot = biped.robot
    assert np.degrees(robot.upper[robot.joints.index("LLEG_KNEE")]) == pytest.approx(150)
    assert np.degrees(robot.lower[robot.joints.index("RLEG_KNEE")]) == pytest.approx(-1.5)
    result = retarget(GAIT, record)
    assert np.degrees(result.q[:, robot.column("LARM_ELBOW")]) == pytest.approx(-20)
    assert result.target.title == "My robot"
    assert result.target.remarks == "seen"


def test_a_robot_whose_zero_is_not_its_stand_walks_all_the_same(tmp_path):
    """The knees' zero moved by 30 degrees, and said so in the record: the feet do the same."""
    legs = ("leg_left_4_joint", "leg_right_4_joint")
    tree = ET.fromstring(text("talos"))
    for joint in tree.findall("joint"):
        if joint.get("name") in legs:
            joint.find("origin").set("rpy", f"0 {math.radians(-30)!r} 0")
    shifted = ET.tostring(tree, encoding="unicode")
    robot, known = load_urdf(shifted), load("talos").robot
    feet = ("leg_left_6_link", "leg_right_6_link")
    straight = robot.q(dict.fromkeys(legs, math.radians(30)))
    assert poses(robot, straight, feet) == pytest.approx(poses(known, known.neutral, feet), abs=1e-9)
    (tmp_path / "mine.urdf").write_text(shifted, "utf-8")
    record = tmp_path / "mine.toml"
    lines = "".join(f"{joint} = 30\n" for joint in legs)
    ranges = "".join(f"{joint} = [30, 180]\n" for joint in legs)
    record.write_text(f'urdf = "mine.urdf"\n[stand_deg]\n{lines}[limits_deg]\n{ranges}', "utf-8")
    mine, own = retarget(GAIT, record), retarget(GAIT, "talos")
    assert poses(mine.robot, mine.q, feet) == pytest.approx(poses(known, own.q, feet), abs=1e-5)


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        ('feet = ["a", "b"]', "urdf is missing"),
        ('urdf = "x.urdf"\nhands = 2', "unknown entry"),
        ('urdf = "x.urdf"\nfeet = ["a"]', "feet is"),
        ('urdf = "x.urdf"\nfeet = ["a", "a"]', "feet is"),
        ('urdf = "x.urdf"\nforward = "north"', "one of x, -x"),
        ('urdf = "x.urdf"\n[limits_deg]\nknee = [1, 0]', "lower, upper"),
        ('urdf = "x.urdf"\n[stand_deg]\nknee = "bent"', "joint = angle"),
        ('urdf = "x.urdf"\n[stand_deg]\nknee = nan', "stand_deg.knee is no finite number"),
        ("urdf = ", "is not TOML"),
        ('urdf = "nowhere.urdf"', "no such file"),
    ],
)
def test_records_that_are_wrong_are_refused_with_what_would_be_accepted(tmp_path, lines, said):
    record = tmp_path / "mine.toml"
    record.write_text(lines, "utf-8")
    with pytest.raises(FormatError, match=re.escape(said)):
        load(record)


@pytest.mark.parametrize(
    ("record", "kind"),
    [
        ('feet = ["left", "r_ankle"]', UnknownNameError),
        ('forward = "z"\nup = "z"', DescriptionError),
        ("[limits_deg]\nknee = [0, 1]", UnknownNameError),
        ("[stand_deg]\nknee = 1", UnknownNameError),
        ('feet = ["l_ankle", "l_ankle_2"]', DescriptionError),
        ('feet = ["LLEG_LINK5", "r_ankle"]', DescriptionError),
    ],
)
def test_records_that_do_not_fit_the_robot_are_refused(tmp_path, record, kind):
    (tmp_path / "mine.urdf").write_text(text("simple_humanoid"), "utf-8")
    path = tmp_path / "mine.toml"
    path.write_text(f'urdf = "mine.urdf"\n{record}', "utf-8")
    with pytest.raises(kind):
        load(path)


PENDULUM = """<robot name="pendulum"><link name="a"/><link name="b"/>
<joint name="j" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 1 0"/></joint></robot>"""


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("", "no element found"),
        ("\0", "zero bytes"),
        ("walk", "syntax error"),
        ("<sdf/>", "root element is <sdf>"),
        ("<robot/>", "no <link>"),
        ("<robot name='a'><link name='b'/></robot>", "no joints"),
        (PENDULUM, "no pair of limbs"),
    ],
)
def test_files_that_are_no_robot_with_two_legs_get_one_clear_line(tmp_path, capsys, content, said):
    path = tmp_path / "mine.urdf"
    path.write_text(content, "utf-8")
    assert main(["retarget", "--robot", str(path)]) == 2
    error = capsys.readouterr().err
    assert said in error
    assert len(error.splitlines()) == 1


@pytest.mark.parametrize("name", ["go2.urdf", "pr2.urdf", "panda.urdf", "iris_simple.urdf", "tiago.urdf"])
def test_quadrupeds_arms_wheels_and_flying_robots_are_no_walkers(name):
    from importlib.metadata import distribution

    paths = [file.locate() for file in distribution("example-robot-data").files if file.name == name]
    if not paths:
        pytest.skip(f"this example-robot-data has no {name}")
    try:
        result = retarget(GAIT, paths[0])
    except ExoPinError:
        return
    assert result.missed.all()  # PR2's arms hang down like legs, and cannot do what legs do


AXES = {
    "pitch roll yaw": [[0, 1, 0], [1, 0, 0], [0, 0, 1]],
    "yaw roll pitch, signs turned": [[0, 0, -1], [1, 0, 0], [0, -1, 0]],
    "inclined": [[0, 1, 0], [0.985, 0, 0.174], [-0.174, 0, 0.985]],
    "oblique": [[0, 1, 0], [0.9, 0.3, 0], [0.1, 0.2, 0.95]],
    "roll pitch": [[1, 0, 0], [0, 1, 0]],
    "pitch": [[0, 1, 0]],
}


@pytest.mark.parametrize("axes", AXES.values(), ids=AXES)
def test_turns_give_back_the_angles_of_a_product_of_turns(axes, rng):
    axes = np.array(axes, dtype=float)
    axes /= np.linalg.norm(axes, axis=1)[:, None]
    q = rng.uniform(-1.0, 1.0, (50, len(axes)))
    R = np.tile(np.eye(3), (50, 1, 1))
    for k, axis in enumerate(axes):
        R = R @ about(axis, q[:, k])
    assert angles_about(axes, R) == pytest.approx(q, abs=1e-7)


def test_axes_in_a_plane_are_no_hip():
    with pytest.raises(DescriptionError, match="plane"):
        angles_about([[0, 1, 0], [1, 0, 0], [0, 1, 0]], np.eye(3)[None])


def test_directions_have_names_and_back():
    for name in ("x", "-x", "y", "-y", "z", "-z"):
        assert nearest_axis(unit_vector(name)) == name


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (r'<limit[^>]*"\s*/>', "", "does not specify limits"),
        ('<axis xyz="1 0 0"', '<axis xyz="a b c"', "xyz of <axis> is 'a b c'"),
        ('<robot name="[^"]*"', "<robot", "No name given"),
        ("<mesh ", '<mesh scale="1 x 1" ', "scale of <mesh> is '1 x 1'"),
        ("<mesh ", '<mesh scale="1 1" ', "scale of <mesh> is '1 1'"),
        ('<axis xyz="1 0 0"', '<axis xyz="0 0 0"', "a direction"),
    ],
)
def test_what_is_wrong_in_a_urdf_is_said_in_one_line_and_no_page_is_written(tmp_path, capfd, old, new, said):
    path, page = tmp_path / "mine.urdf", tmp_path / "mine.html"
    wrong = re.sub(old, new, text("bolt"))
    assert wrong != text("bolt")
    path.write_text(wrong, "utf-8")
    assert main(["replay", "--robot", str(path), "--html", str(page)]) == 2
    (error,) = capfd.readouterr().err.splitlines()  # of the process: Pinocchio's parser writes there too
    assert said in error
    assert not page.exists()
