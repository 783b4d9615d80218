"""Feet dragged in a real browser: by mouse and keys, answered by Python or by the page itself."""

from __future__ import annotations

import json

import numpy as np
import pinocchio as pin
import pytest

from exo_pin import viewer
from exo_pin.anatomy import FEET
from exo_pin.kinematics import poses
from exo_pin.viewer.live import messages
from exo_pin.viewer.live.foot_drag import ROTATION_WEIGHT, reach_solver

SINGLE = 1e-6  # [m]: the page's base is float32
EXACT = 2e-6  # [m, rad]: twice what "reached" promises, for each of the two
NEAREST = 1e-4  # [m]: how well two iterative solvers agree on what remains out of reach
LATENCY = 250.0  # [ms] from the request to the answer; measured 8 ms, but the browser draws in software
SETTLED = "new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))"
HANDLE = (
    "(r => [r.x + r.width / 2, r.y + r.height / 2])"
    "(document.querySelector('#handles button.{}').getBoundingClientRect())"
)
STATUS = "document.getElementById('reach').textContent"
LEFT = "exo.chains[0].matrices().left_foot"


@pytest.fixture(scope="module")
def live(scene):
    with viewer.serve(scene, port=0) as running:
        yield running


@pytest.fixture(params=["live", "offline"], scope="module")
def address(request, file, live):
    return live.url if request.param == "live" else file


@pytest.fixture
def still(browser, address):
    """The live or the offline page, standing still in mid-stance, seen from the left."""
    if browser.evaluate("location.href") != address:
        browser.resize(1000, 680)
        browser.open(address)
    browser.evaluate("exo.seek(0.3); exo.apply(); exo.look('left')")
    browser.evaluate(SETTLED)
    return browser


def pose(browser, foot="left_foot"):
    return np.array(browser.evaluate(f"exo.chains[0].matrices().{foot}")).reshape(4, 4).T


def drag_foot(browser, *steps, shift=False):
    """Take the left foot with the mouse and move it by pixels; it stays in the hand."""
    x, y = browser.evaluate(HANDLE.format("left"))
    down = {"button": "left", "buttons": 1, "modifiers": 8 if shift else 0}
    browser.call("Input.dispatchMouseEvent", type="mousePressed", x=x, y=y, clickCount=1, **down)
    for dx, dy in steps:
        browser.call("Input.dispatchMouseEvent", type="mouseMoved", x=x + dx, y=y + dy, **down)
        browser.evaluate(SETTLED)
    browser.wait("!document.getElementById('reach').hidden")
    browser.wait("!exo.transport.pending")
    return x + steps[-1][0], y + steps[-1][1]


def release(browser, x, y):
    browser.call("Input.dispatchMouseEvent", type="mouseReleased", x=x, y=y, button="left", clickCount=1)


def test_a_foot_follows_the_mouse_and_keeps_its_attitude(still):
    before, other = pose(still), pose(still, "right_foot")
    x, y = drag_foot(still, (3, -4), (8, -10), (12, -16))
    after = pose(still)
    handle = still.evaluate(HANDLE.format("left"))
    release(still, x, y)
    assert still.evaluate(STATUS) == "left foot reached"
    assert handle == pytest.approx([x, y], abs=1.5)  # pixels
    assert after[:3, :3] == pytest.approx(before[:3, :3], abs=EXACT)
    moved = after[:3, 3] - before[:3, 3]
    assert moved[0] < -0.03  # seen from the left, forward is left in the picture
    assert moved[2] > 0.03
    assert moved[1] == pytest.approx(0, abs=0.02)  # the picture's plane is nearly upright
    assert pose(still, "right_foot") == pytest.approx(other, abs=EXACT)
    assert still.evaluate("exo.clock.playing") is False
    assert still.console == []


def test_with_shift_a_foot_goes_along_the_ground(still):
    still.evaluate("exo.look('iso')")
    still.evaluate(SETTLED)
    before = pose(still)
    release(still, *drag_foot(still, (3, 1), (10, 5), shift=True))
    moved = pose(still)[:3, 3] - before[:3, 3]
    assert moved[2] == pytest.approx(0, abs=EXACT)
    assert np.linalg.norm(moved) > 0.03


def test_out_of_reach_the_nearest_pose_is_shown_with_what_is_missing(still):
    x, y = drag_foot(still, (-60, -20), (-150, -60), (-240, -90))
    content = still.evaluate(STATUS)
    place = still.evaluate("exo.handles.held.target.place.toArray()")  # y up in there
    target = np.array([place[0], -place[2], place[1]])
    missing = np.linalg.norm(pose(still)[:3, 3] - target)
    assert "out of reach" in content
    assert f"{1000 * missing:.0f} mm" in content
    assert still.evaluate("document.querySelector('#handles button.left').classList.contains('short')")
    assert (
        still.evaluate("document.querySelector('#handles div.left').offsetWidth") > 20
    )  # the line between them
    release(still, x, y)


def test_the_keyboard_moves_a_foot_by_a_centimetre_and_escape_lets_go(still):
    start = pose(still)
    still.evaluate("document.querySelector('#handles button.left').focus()")
    for count in (1, 2, 3):
        still.press("ArrowUp")
        still.wait(f"Math.abs({LEFT}[14] - {start[2, 3]} - {0.01 * count}) < 1e-3")
    assert still.evaluate("exo.clock.time") == pytest.approx(0.3)  # arrows step no frames here
    still.press("Escape")
    assert pose(still) == pytest.approx(start, abs=SINGLE)
    assert still.evaluate("document.getElementById('reach').hidden") is True


def test_playing_resumes_the_walk(still):
    release(still, *drag_foot(still, (30, -30)))
    assert still.evaluate("exo.byHand") is True
    aside = "document.getElementById('plots').classList.contains('aside')"
    assert still.evaluate(aside) is True  # the curves are not what is shown
    still.evaluate("exo.toggle()")
    still.wait("!exo.byHand")
    still.evaluate("exo.seek(0.3), exo.apply()")
    assert still.evaluate("exo.marks.com.visible") is True
    assert still.evaluate(aside) is False
    assert still.evaluate("document.getElementById('reach').hidden") is True


def test_the_hand_starts_from_the_pose_of_the_sliders_and_moves_them(still):
    still.evaluate("[...document.querySelectorAll('#tabs button')].at(-1).click()")
    knee = "exo.sliders.rows.find(row => exo.chains[0].spec.joints[row.k].name === '{}_knee_flexion').range"
    right, left = knee.format("right"), knee.format("left")
    still.evaluate(f"(r => {{ r.value = 1; r.dispatchEvent(new Event('input')); }})({right})")
    still.evaluate(SETTLED)
    before = still.evaluate(f"Number({left}.value)")
    release(still, *drag_foot(still, (0, -40)))
    assert still.evaluate(f"Number({right}.value)") == pytest.approx(1, abs=EXACT * 100)
    assert still.evaluate(f"Number({left}.value)") > before + 0.05
    still.evaluate("document.querySelectorAll('#tabs button')[0].click()")


def test_python_answers_the_live_page_soon(browser, live):
    browser.open(live.url)
    browser.evaluate("exo.seek(0.3)")
    browser.evaluate(SETTLED)
    release(browser, *drag_foot(browser, (10, -10), (20, -20)))
    assert browser.evaluate("exo.transport.count") > 0  # a request was sent
    assert browser.evaluate("exo.transport.latency") < LATENCY


def test_the_page_answers_itself_where_python_is_gone(browser, scene):
    with viewer.serve(scene, port=0) as server:
        browser.open(server.url)
        browser.evaluate("exo.seek(0.3)")
        browser.evaluate(SETTLED)
    browser.wait("!exo.transport.open")
    release(browser, *drag_foot(browser, (5, -10)))
    assert browser.evaluate(STATUS) == "left foot reached"


def test_the_pages_inverse_kinematics_is_pythons(page, robot, gait, scene, rng):
    names = [joint.name for joint in scene.facts.chains[0].joints]
    answer = reach_solver(robot, names)
    gait_q = robot.from_gait(gait)
    far = 0
    for k in range(0, 100, 4):
        T = np.linalg.inv(robot.placement) @ poses(robot, gait_q[k])
        T[0, :3, 3] += rng.normal(0, 0.12, 3)
        feet = {foot: pin.SE3ToXYZQUAT(pin.SE3(M)).tolist() for foot, M in zip(FEET, T, strict=True)}
        q = [float(gait_q[k][robot.column(name)]) for name in names]
        content = {"type": "reach", "id": 0, "feet": feet, "q": q}
        mine = page.evaluate(f"(exo.apply(), exo.reach.answer({json.dumps(content)}))")
        python = answer(messages.reach_request(content, scene.facts))
        assert np.shape(mine["q"]) == np.shape(python.q)
        misses = np.array([[each[foot] for foot in feet] for each in (mine["misses"], python.misses)])
        mine_off, python_off = np.hypot(misses[..., 0], ROTATION_WEIGHT * misses[..., 1])
        assert mine_off == pytest.approx(python_off, abs=NEAREST)
        if misses.any():
            far += 1
        else:
            assert mine["q"] == pytest.approx(python.q, abs=1e-4)
    assert 3 < far < 22  # both kinds were tried
