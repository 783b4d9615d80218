from __future__ import annotations

import time

import numpy as np
import pytest

from exo_pin import viewer
from exo_pin.gait.rigid_poses import about
from exo_pin.kinematics import poses
from exo_pin.viewer.scenes.link_nodes import linkage

SINGLE = 1e-6  # [m]: float32
PATIENCE = 10.0  # [s]: far beyond what a message on loopback needs


@pytest.fixture
def server(scene):
    with viewer.serve(scene, port=0) as running:
        yield running


def test_the_live_page_plays_and_asks_only_its_own_server(browser, server):
    browser.open(server.url)
    start = browser.evaluate("exo.clock.time")
    browser.wait(f"exo.clock.time !== {start}")
    assert server.clients == 1
    assert browser.console == []
    assert set(browser.requests) == {
        server.url,
        f"ws://127.0.0.1:{server.port}/live?token={server.token}",
        "data:,",
    } - (set() if "data:," in browser.requests else {"data:,"})


def test_the_live_page_has_the_same_forward_kinematics(browser, server, robot, gait, scene):
    browser.open(server.url)
    found = browser.evaluate("(exo.seek(0), exo.apply(), exo.chains[0].matrices())")
    T = np.array(found["left_foot"]).reshape(4, 4).T
    U = np.array(found["right_foot"]).reshape(4, 4).T
    expected = poses(robot, robot.from_gait(gait)[0])
    assert np.linalg.inv(T) @ U == pytest.approx(np.linalg.inv(expected[0]) @ expected[1], abs=SINGLE)


def test_a_pose_from_python_is_shown_at_once(browser, server, robot, rng):
    browser.open(server.url)
    q = rng.uniform(robot.lower, robot.upper)
    names = [joint.name for joint in linkage(robot.urdf, "/x").joints]
    stand = np.eye(4)
    stand[:3, :3], stand[:3, 3] = about([0.0, 0.0, 1.0], 0.4), [0.1, 0.2, 1.3]
    server.pose([q[robot.joints.index(name)] for name in names], stand)
    browser.wait("Math.abs(exo.chains[0].root.position.z - 1.3) < 1e-3")
    found = np.array(browser.evaluate("exo.chains[0].matrices().left_foot")).reshape(4, 4).T
    assert found == pytest.approx(poses(robot, q, base=stand)[0], abs=SINGLE)
    assert browser.evaluate("exo.clock.playing") is False


def test_another_scene_replaces_the_first(browser, server, robot, gait):
    browser.open(server.url)
    server.show(viewer.scene(robot, gait.slowed(2.0), title="slow"))
    browser.wait("exo.header.title === 'slow'")
    assert browser.evaluate("document.title") == "slow"
    assert browser.evaluate("exo.clock.duration") == pytest.approx(2 * gait.duration)
    assert (
        browser.evaluate("Object.keys(exo.stage.viewer.scene_tree.children.exo_pin.children)").count("exo")
        == 1
    )


def test_a_reopened_browser_resumes(browser, server):
    browser.open(server.url)
    browser.evaluate("exo.seek(0.4321); exo.setSpeed(0.25); exo.look('feet')")
    browser.wait("JSON.parse(exo.transport.reported || '{}').view === 'feet'")  # it reports twice a second
    end = time.monotonic() + PATIENCE
    while (server.state or {}).get("view") != "feet" and time.monotonic() < end:
        time.sleep(0.01)
    assert server.state["time"] == pytest.approx(0.4321)
    browser.open("about:blank", until="true")
    browser.open(server.url)
    browser.wait("exo.clock.speed === 0.25")
    assert browser.evaluate("exo.clock.time") == pytest.approx(0.4321)
    assert browser.evaluate("[exo.view, exo.clock.playing]") == ["feet", False]


def test_a_lost_server_is_said_and_its_return_noticed(browser, scene):
    server = viewer.serve(scene, port=0)
    browser.open(server.url)
    browser.evaluate("exo.seek(0.3)")
    server.close()
    browser.wait("!document.getElementById('notice').hidden")
    assert "stopped" in browser.evaluate("document.getElementById('notice').textContent")
    with viewer.serve(scene, port=server.port, token=server.token) as again:
        assert again.port == server.port
        browser.wait("document.getElementById('notice').hidden")
        assert browser.evaluate("exo.clock.time") == pytest.approx(0.3)  # the same walk goes on
        assert again.clients == 1


def test_a_foreign_page_cannot_connect(browser, server, file):
    browser.open("about:blank", until="true")
    tried = browser.evaluate(
        f"new Promise(done => {{ const s = new WebSocket('ws://127.0.0.1:{server.port}/live?token={server.token}');"
        " s.onopen = () => done('open'); s.onerror = () => done('refused'); })"
    )
    assert tried == "refused"
    assert server.clients == 0


def test_two_browsers_look_at_two_viewers(browser, server, scene):
    with viewer.serve(scene, port=server.port) as other:
        for each in (server, other):
            browser.open(each.url)
            assert each.clients == 1
