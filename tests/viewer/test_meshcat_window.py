"""A robot in a window of the meshcat package: nodes, live poses and animations, and meshcat's own server."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from exo_pin import viewer
from exo_pin.anatomy import FEET
from exo_pin.errors import DescriptionError
from exo_pin.gait import Gait
from exo_pin.kinematics import poses
from exo_pin.robot import Robot, load_robot

with warnings.catch_warnings():  # meshcat imports a module that pyzmq calls old
    warnings.simplefilter("ignore", DeprecationWarning)
    import meshcat
    from meshcat.servers.tree import SceneTree, find_node

EXACT = 1e-12  # [m]: both chains are products of the same matrices in double precision
SINGLE = 1e-6  # [m]: a scene's samples are single precision


class Window:
    """Takes the place of meshcat's window: it keeps commands in meshcat's own tree, as its server does."""

    def __init__(self) -> None:
        self.tree: Any = SceneTree()
        self.animations: list[dict[str, Any]] = []
        self.objects: list[str] = []

    def send(self, command: Any) -> None:
        data = command.lower()
        if data["type"] == "set_animation":
            self.animations = data["animations"]
        elif data["type"] == "set_transform":
            find_node(self.tree, _parts(data["path"])).transform = data["matrix"]
        elif data["type"] == "set_object":
            self.objects.append(data["path"])

    def pose(self, path: str) -> Any:
        """Pose of a node in the window's world (4, 4)."""
        T, parts = np.eye(4), _parts(path)
        for k in range(len(parts)):
            matrix = find_node(self.tree, parts[: k + 1]).transform
            T = T if matrix is None else T @ np.reshape(matrix, (4, 4)).T
        return T

    def play(self, time: float) -> None:
        """Put the nodes where the animation has them, as three.js does."""
        for entry in self.animations:
            T = np.eye(4)
            for track in entry["clip"]["tracks"]:
                times = np.array([key["time"] for key in track["keys"]]) / entry["clip"]["fps"]
                values = np.array([key["value"] for key in track["keys"]])
                assert np.all(np.diff(times) > 0.0)
                value = [np.interp(time, times, column) for column in values.T]
                if track["name"] == ".position":
                    T[:3, 3] = value
                else:
                    T[:3, :3] = Rotation.from_quat(value).as_matrix()
            find_node(self.tree, _parts(entry["path"])).transform = T.T.ravel().tolist()


def _parts(path: str) -> list[str]:
    return [part for part in path.split("/") if part]


@pytest.fixture
def window() -> Window:
    return Window()


@pytest.fixture
def vis(window: Window) -> meshcat.Visualizer:
    return meshcat.Visualizer(window=window)


def _feet(window: Window, drawn: viewer.MeshcatRobot, root: str) -> Any:
    links = drawn.chains[0].links
    return np.stack([window.pose(root + links[foot].removeprefix("/exo_pin")) for foot in FEET])


@pytest.mark.parametrize("device", ["exo12", "lokomat", "planar9"])
def test_a_pose_that_is_set_is_the_one_of_forward_kinematics(
    window: Window, vis: meshcat.Visualizer, device: str
) -> None:
    robot = load_robot(device=device)
    drawn = viewer.draw(vis["lab"], robot, path="first", wearer=False)
    rng = np.random.default_rng(20260101)
    q, base = rng.uniform(robot.lower, robot.upper), np.eye(4)
    base[:3, :3], base[:3, 3] = Rotation.from_rotvec([0.1, 0.2, 0.3]).as_matrix(), (1.0, 2.0, 0.9)
    drawn.set(q, base)
    found = _feet(window, drawn, "/meshcat/lab/first")
    np.testing.assert_allclose(found, poses(robot, q, base=base), atol=EXACT)
    drawn.set(0 * q)
    found = _feet(window, drawn, "/meshcat/lab/first")
    np.testing.assert_allclose(found, poses(robot, 0 * q, base=base), atol=EXACT)


def test_an_animation_is_the_walk_of_the_scene_and_closes(
    window: Window, vis: meshcat.Visualizer, robot: Robot, gait: Gait, scene: viewer.Scene
) -> None:
    drawn = viewer.draw(vis, robot, gait, belt=True, traces=True)
    drawn.animate()
    base = np.eye(4)
    for k in (0, 40, 77):
        window.play(gait.time[k] - gait.time[0])
        row = scene.arrays["base"][k].astype(float)
        base[:3, :3], base[:3, 3] = Rotation.from_quat(row[3:]).as_matrix(), row[:3]
        found = _feet(window, drawn, "/meshcat/exo")
        np.testing.assert_allclose(found, poses(robot, gait.q[k], base=base), atol=SINGLE)
    window.play(gait.duration)
    closed = _feet(window, drawn, "/meshcat/exo")
    window.play(0.0)
    np.testing.assert_allclose(closed, _feet(window, drawn, "/meshcat/exo"), atol=SINGLE)
    assert any("/treadmill/slats/" in path for path in window.objects)
    assert any("/traces/left" in path for path in window.objects)
    assert any("/right_thigh" in path and path.endswith("/wearer") for path in window.objects)  # a twin
    assert not any("/contact/" in path for path in window.objects)


def test_robots_side_by_side_share_one_animation(
    window: Window, vis: meshcat.Visualizer, robot: Robot, gait: Gait
) -> None:
    one = viewer.draw(vis, robot, path="one", wearer=False)
    two = viewer.draw(vis, load_robot(device="h2"), gait, path="two", wearer=False)
    two.animate(into=one.animate(gait))
    roots = {_parts(entry["path"])[1] for entry in window.animations}
    assert roots == {"one", "two"}
    assert not any("treadmill" in path for path in window.objects)


def test_the_trunk_of_the_wearer_goes_with_the_pelvis(
    window: Window, vis: meshcat.Visualizer, robot: Robot
) -> None:
    drawn = viewer.draw(vis, robot)
    moved = robot.placement.copy()
    moved[0, 3] += 0.5
    drawn.set(np.zeros(12), robot.placement)
    before = window.pose("/meshcat/exo/wearer")
    drawn.set(np.zeros(12), moved)
    np.testing.assert_allclose(
        window.pose("/meshcat/exo/wearer")[:3, 3] - before[:3, 3], [0.5, 0, 0], atol=EXACT
    )


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"vis": 3}, "vis is a int; a meshcat.Visualizer is accepted"),
        ({"path": "/"}, "path is empty"),
        ({"belt": True}, "give a gait"),
    ],
)
def test_what_cannot_be_drawn_is_refused(
    vis: meshcat.Visualizer, robot: Robot, options: dict[str, Any], said: str
) -> None:
    with pytest.raises(DescriptionError, match=said):
        viewer.draw(**({"vis": vis, "robot": robot} | options))


def test_a_pose_of_another_shape_is_refused(vis: meshcat.Visualizer, robot: Robot) -> None:
    drawn = viewer.draw(vis, robot, wearer=False)
    with pytest.raises(DescriptionError, match=r"q has shape \(3,\)"):
        drawn.set(np.zeros(3))
    with pytest.raises(DescriptionError, match=r"base has shape \(7,\)"):
        drawn.set(np.zeros(12), np.zeros(7))
    with pytest.raises(DescriptionError, match="give a gait"):
        drawn.animate()


@pytest.fixture
def real_window() -> Iterator[meshcat.Visualizer]:
    """A window on meshcat's own server."""
    vis = meshcat.Visualizer()
    yield vis
    vis.window.zmq_socket.close(linger=0)
    vis.window.server_proc.terminate()
    vis.window.server_proc.wait()


def test_the_server_of_meshcat_takes_the_robot(
    real_window: meshcat.Visualizer, robot: Robot, gait: Gait
) -> None:
    drawn = viewer.draw(real_window, robot, gait, wearer=False)
    drawn.set(gait.q[0])
    drawn.animate()
    page = real_window.static_html()  # what the server holds, by its own words
    assert page.count("fetch(") >= len(drawn.chains[0].joints)
