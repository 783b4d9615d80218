from __future__ import annotations

import numpy as np
import pytest

from exo_pin.errors import DescriptionError
from exo_pin.kinematics import poses
from exo_pin.retarget import TARGETS, load
from exo_pin.robot import load_robot
from exo_pin.viewer.scenes.link_nodes import linkage

ROUNDING = 1e-12  # a dozen products of rotations in double precision

URDF = """<robot name="r"><material name="m"><color rgba="0.1 0.2 0.3 1"/></material>
<link name="a"><visual><geometry><box size="1 2 3"/></geometry><material name="m"/></visual>
<visual><geometry><mesh filename="x.stl"/></geometry></visual></link>
<link name="b/c"><visual><geometry><sphere radius="0.1"/></geometry></visual></link>
<joint name="j" type="prismatic"><parent link="a"/><child link="b/c"/><axis xyz="0 0 2"/></joint></robot>"""


def nested_pose(tree, path, q):
    """The pose that the page will find: the product of the placements and rotations along a node's path."""
    placed = {
        c["path"]: np.reshape(c["matrix"], (4, 4)).T for c in tree.commands if c["type"] == "set_transform"
    }
    turned = {joint.path: joint for joint in tree.joints}
    T = np.eye(4)
    names = path.removeprefix(tree.root).split("/")
    for k in range(1, len(names)):
        node = tree.root + "/".join(names[: k + 1])
        T = T @ placed.get(node, np.eye(4))
        if node in turned:
            T = T @ rotation(np.array(turned[node].axis), q[turned[node].name])
    return T


def rotation(axis, angle):
    T = np.eye(4)
    K = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    T[:3, :3] += np.sin(angle) * K + (1 - np.cos(angle)) * K @ K
    return T


@pytest.mark.parametrize("hip_order", ["clinical", "yaw_roll_pitch"])
def test_nested_nodes_are_where_pinocchio_has_the_links(rng, hip_order):
    robot = load_robot(hip_order=hip_order)
    tree = linkage(robot.urdf, "/exo")
    for q in rng.uniform(robot.lower, robot.upper, size=(5, 12)):
        expected = np.linalg.inv(robot.placement) @ poses(robot, q, robot.frames)
        named = dict(zip(robot.joints, q, strict=True))
        found = [nested_pose(tree, tree.links[name], named) for name in robot.frames]
        assert np.abs(found - expected).max() < ROUNDING


def test_every_link_of_the_robot_has_a_node_of_its_own():
    robot = load_robot()
    tree = linkage(robot.urdf, "/exo")
    assert set(tree.links) == set(robot.frames)
    assert len(set(tree.links.values())) == len(tree.links)
    assert {joint.name for joint in tree.joints} == set(robot.joints)


def test_colours_stay_those_of_the_urdf():
    tree = linkage(URDF, "/x")
    (material,) = [
        c["object"]["materials"][0] for c in tree.commands if c["path"] == "/x/look/0" and "object" in c
    ]
    assert material["color"] == round(0.1 * 255) << 16 | round(0.2 * 255) << 8 | round(0.3 * 255)


def test_meshes_are_counted_not_silently_dropped():
    assert linkage(URDF, "/x").skipped == 1


def test_names_with_slashes_do_not_break_the_tree():
    assert linkage(URDF, "/x").links["b/c"] == "/x/b_c/turn"


def test_axes_are_normalised_and_sliding_joints_known():
    (joint,) = linkage(URDF, "/x").joints
    assert (joint.kind, joint.axis) == ("prismatic", (0.0, 0.0, 1.0))


@pytest.mark.parametrize(
    "text", ["", "<robot", "<robot><link name='a'/><link name='b'/></robot>", "<robot/>"]
)
def test_what_is_no_urdf_is_refused(text):
    with pytest.raises(DescriptionError):
        linkage(text, "/x")


@pytest.mark.parametrize("name", TARGETS)
def test_nested_nodes_of_other_robots_are_where_pinocchio_has_their_links(rng, name):
    robot = load(name).robot
    tree = linkage(robot.urdf, "/exo")
    low, high = (np.clip(limit, -3.0, 3.0) for limit in (robot.lower, robot.upper))
    q = rng.uniform(low, high)
    expected = poses(robot, q, robot.frames)
    named = dict(zip(robot.joints, q, strict=True))
    found = [nested_pose(tree, tree.links[link], named) for link in robot.frames]
    assert np.abs(found - expected).max() < 1e-9  # axes and rpy in files have some ten digits
