from __future__ import annotations

import io
from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest
from PIL import Image

from exo_pin import viewer
from exo_pin.gait import Gait
from exo_pin.kinematics import poses

SINGLE = 1e-6  # [m]: the page computes from float32 angles and poses
ROUNDED = 1.1e-5  # [rad] half of 1/65534 of the knee's range
FIRST_PICTURE = 3000  # [ms] at low quality in software rendering; two cores, shared
SETTLED = "new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))"


def picture(page):
    page.evaluate(SETTLED)
    return np.asarray(Image.open(io.BytesIO(page.screenshot())).convert("RGB")).astype(float)


def rectangle(page, element):
    return page.evaluate(f"(r => [r.x, r.y, r.width, r.height])({element}.getBoundingClientRect())")


def in_view(page, image):
    """The part of a screenshot that holds the 3-D view."""
    x, y, w, h = map(round, rectangle(page, "document.getElementById('pane')"))
    return image[y + 60 : y + h - 50, x : x + w]  # without buttons and legend


def reddish(image):
    return np.mean(
        (image[..., 0] > 100) & (image[..., 0] > 1.7 * image[..., 1]) & (image[..., 0] > 1.7 * image[..., 2])
    )


def bluish(image):
    return np.mean(
        (image[..., 2] > 100) & (image[..., 2] > 1.7 * image[..., 0]) & (image[..., 2] > 1.2 * image[..., 1])
    )


def greenish(image):
    return np.mean(
        (image[..., 1] > 90) & (image[..., 1] > 1.6 * image[..., 0]) & (image[..., 1] > 1.6 * image[..., 2])
    )


def test_the_page_loads_without_a_message_and_without_a_request(browser, file):
    browser.open(file)
    browser.evaluate("new Promise(done => setTimeout(done, 700))")
    assert browser.console == []
    assert browser.requests == [file]


def test_the_policy_of_the_page_blocks_requests(page):
    blocked = page.evaluate(
        "fetch('http://127.0.0.1:1/').then(() => 'sent', error => error.name + error.message)"
    )
    assert blocked.startswith("TypeError")
    assert any("Content Security Policy" in line for line in page.console)


def test_the_first_picture_comes_soon(page):
    assert page.evaluate("exo.stage.quality") == "low"
    assert page.evaluate("exo.firstPicture") < FIRST_PICTURE


def test_both_legs_and_the_contact_are_in_the_picture(page):
    page.evaluate("exo.look('left'); exo.seek(0.05 * exo.clock.duration)")
    image = in_view(page, picture(page))
    assert image.std() > 20
    assert reddish(image) > 0.002
    assert bluish(image) > 0.002
    assert greenish(image) > 0.0003


@pytest.mark.parametrize("camera", ["iso", "left", "right", "front", "back", "top", "feet"])
def test_every_camera_shows_the_exoskeleton_and_leaves_room_around_it(page, camera):
    page.evaluate(f"exo.look('{camera}'); exo.stage.show('/exo_pin/treadmill', false)")
    image = in_view(page, picture(page))
    coloured = (np.ptp(image, axis=2) > 70) & ~((image[..., 2] > 200) & (image[..., 0] > 200))
    columns = np.nonzero(coloured)[1]
    width = coloured.shape[1]
    assert len(columns) > 0.001 * coloured.size
    if camera != "feet":
        assert columns.min() > 0
        assert columns.max() < width - 1
        assert abs((columns.min() + columns.max()) / 2 / width - 0.5) < 0.25


def test_playing_moves_the_walk(page):
    page.evaluate("exo.clock.play()")
    for _ in range(2):
        page.wait(f"exo.clock.time !== {page.evaluate('exo.clock.time')}")
    page.evaluate("exo.clock.play(false)")


def test_time_goes_by_the_wall_clock_and_not_by_frames(page):
    run = "(c => (c.play(), c.last = 0, {0}.forEach(now => c.tick(now)), c.time))(new Clock(10))"
    assert page.evaluate(run.format("[16, 33, 50]")) == pytest.approx(0.05)
    assert page.evaluate(run.format("[400, 1000, 1900]")) == pytest.approx(1.9)
    assert page.evaluate(run.format("[60000]")) == pytest.approx(1.0)  # a tab that slept does not jump


def test_half_speed_is_half_as_far(page):
    clock = "(c => (c.play(), c.speed = {0}, c.last = 1000, c.tick(1200), c.time))(new Clock(1))"
    assert page.evaluate(clock.format(1)) == pytest.approx(0.2)
    assert page.evaluate(clock.format(0.5)) == pytest.approx(0.1)


def test_the_loop_closes_or_the_walk_halts_at_its_end(page):
    run = (
        "(c => {{ c.loop = {0}; c.seek(c.duration - 0.01); c.play(); c.tick(0); c.tick(100);"
        " return [c.time, c.playing]; }})(exo.clock)"
    )
    time, playing = page.evaluate(run.format("true"))
    assert playing
    assert time == pytest.approx(0.09, abs=0.03)
    time, playing = page.evaluate(run.format("false"))
    page.evaluate("exo.setLoop(true)")
    assert not playing
    assert time == page.evaluate("exo.clock.duration")


def test_the_pages_forward_kinematics_is_pinocchios(page, robot, gait, scene):
    q = robot.from_gait(gait)
    names = page.evaluate("Object.keys(exo.chains[0].links)")
    base = [pin.XYZQUATToSE3(row.astype(float)).homogeneous for row in scene.arrays["base"]]
    expected = poses(robot, q, names, base=np.array(base))
    found = page.evaluate(
        "[...exo.motion.time].map(t => (exo.seek(t), exo.apply(), Object.values(exo.chains[0].matrices())))"
    )
    T = np.array(found).reshape(len(gait), -1, 4, 4).swapaxes(2, 3)
    assert np.abs(T - expected).max() < SINGLE


def test_between_two_frames_the_angles_are_between_theirs(page, gait):
    t = (gait.time[10] + gait.time[11]) / 2
    found = page.evaluate(f"exo.motion.row('angles', exo.motion.at({t}))")
    assert found == pytest.approx((gait.q[10] + gait.q[11]) / 2, abs=ROUNDED)


def test_the_last_frame_of_a_cycle_leads_back_to_the_first(page, gait):
    t = (gait.time[-1] + gait.duration) / 2
    found = page.evaluate(f"exo.motion.row('angles', exo.motion.at({t}))")
    assert found == pytest.approx((gait.q[-1] + gait.q[0]) / 2, abs=ROUNDED)


def test_the_read_out_tells_phase_and_seconds(page, gait):
    page.evaluate("exo.seek(0.25 * exo.clock.duration)")
    page.evaluate(SETTLED)
    said = page.evaluate("document.getElementById('time').innerText")
    assert "25.0 %" in said
    assert f"{0.25 * gait.duration:.2f}" in said
    label = page.evaluate("document.querySelector('#plots canvas').getAttribute('aria-label')")
    angle = np.degrees(np.interp(0.25 * gait.duration, gait.time, gait.q[:, 0]))
    assert f"left {angle:.1f}".replace("-", "\u2212") in label


def test_the_keyboard_alone_plays_steps_and_turns(page, gait):
    def time():
        return page.evaluate("exo.clock.time")

    step = gait.duration / len(gait)
    page.evaluate("document.activeElement.blur()")
    page.press("ArrowRight")
    assert time() == pytest.approx(step, abs=SINGLE)
    page.press("ArrowLeft")
    page.press("ArrowLeft")
    assert time() == pytest.approx(gait.duration - step, abs=SINGLE)
    page.press("Home")
    assert time() == 0
    page.press("3")
    assert page.evaluate("exo.view") == "right"
    page.press("-")
    assert page.evaluate("exo.clock.speed") == 0.5
    page.press("+")
    page.press("l")
    assert page.evaluate("exo.clock.loop") is False
    page.press(" ")
    assert page.evaluate("exo.clock.playing") is True
    page.press(" ")
    assert page.evaluate("exo.clock.playing") is False


def test_every_control_can_be_reached_by_the_tabulator_and_has_a_name(page):
    nameless = page.evaluate(
        "[...document.querySelectorAll('button, input, select, summary')]"
        ".filter(e => !(e.ariaLabel || e.textContent.trim() || e.labels?.length)).map(e => e.outerHTML)"
    )
    assert nameless == []
    assert page.evaluate(
        "[...document.querySelectorAll('button, input, select')].every(e => e.tabIndex >= 0)"
    )


def test_a_drag_in_a_plot_seeks_in_all(page):
    x, y, w, h = rectangle(page, "document.querySelectorAll('#plots canvas')[1]")
    page.evaluate("exo.clock.play()")
    page.drag((x + 0.3 * w, y + h / 2), (x + 0.6 * w, y + h / 2))
    page.evaluate(SETTLED)
    expected = (0.6 * w - 38) / (w - 48)  # the margins of a plot
    assert page.evaluate("exo.clock.time / exo.clock.duration") == pytest.approx(expected, abs=0.01)
    assert page.evaluate("exo.clock.playing") is False


def test_the_slider_seeks(page):
    page.evaluate(
        "(s => { s.value = 0.7; s.dispatchEvent(new Event('input')); })(document.getElementById('seek'))"
    )
    assert page.evaluate("exo.clock.time / exo.clock.duration") == pytest.approx(0.7, abs=1e-3)


def test_soles_are_green_exactly_while_the_foot_stands(page, gait):
    for k in range(0, len(gait), 7):
        t = gait.time[k] + 1e-4
        shown = page.evaluate(
            f"(exo.seek({t}), exo.apply(), ['left', 'right'].map("
            "side => exo.stage.node(exo.header.marks.contact[side]).visible))"
        )
        assert shown == [bool(gait.stance(side)[k]) for side in ("left", "right")]


def test_the_centre_of_mass_hangs_over_its_projection(page, scene):
    for t in (0.0, 0.31, 0.77):
        ball, disc = page.evaluate(
            f"(exo.seek({t}), exo.apply(), [exo.marks.com, exo.marks.ground].map(n => n.position.toArray()))"
        )
        assert ball[:2] == disc[:2]
        assert 0.5 < ball[2] < 1.3


def test_the_belt_runs_backwards_under_the_walk(page, scene):
    belt = scene.facts.marks.belt
    assert 0.8 < belt.speed < 1.6  # free walking of an adult
    where = [
        page.evaluate(f"(exo.seek({t}), exo.apply(), exo.marks.belts[0].position.x)") for t in (0.0, 0.05)
    ]
    assert where[0] - where[1] == pytest.approx(0.05 * belt.speed, abs=1e-6)


def test_what_is_switched_off_is_not_shown(page):
    page.evaluate("exo.look('left'); exo.seek(0.4)")
    before = reddish(in_view(page, picture(page)))
    page.evaluate("document.querySelector('#toggles input').click()")
    after = reddish(in_view(page, picture(page)))
    assert after < 0.7 * before  # the paths are red as well
    page.evaluate("document.querySelector('#toggles input').click()")


def test_the_tabs_show_angles_or_velocities(page, gait):
    label = "document.querySelector('#plots canvas').getAttribute('aria-label')"
    page.evaluate("document.querySelectorAll('#tabs button')[1].click()")
    page.evaluate(SETTLED)
    assert "\u00b0/s" in page.evaluate(label)
    page.evaluate("document.querySelectorAll('#tabs button')[0].click()")
    page.evaluate(SETTLED)
    assert "\u00b0/s" not in page.evaluate(label)


def test_the_dashed_reference_is_drawn_and_named(page, browser, robot, gait, tmp_path):
    assert page.evaluate("document.getElementById('key').innerText").count("four fifths") == 1
    plots = "[...document.querySelectorAll('#plots canvas')].map(c => c.toDataURL()).join('')"
    with_reference = page.evaluate(plots)
    path = tmp_path / "plain.html"
    path.write_text(viewer.html(viewer.scene(robot, gait)), "utf-8")
    browser.open(path.as_uri())
    browser.evaluate("exo.seek(0)")
    browser.evaluate(SETTLED)
    assert browser.evaluate("document.getElementById('dashed').hidden") is True
    assert browser.evaluate(plots) != with_reference


@pytest.mark.parametrize("width", [360, 800, 1400, 2560])
def test_nothing_sticks_out_at_any_width(page, width):
    page.resize(width, 800)
    page.evaluate(SETTLED)
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    boxes = page.evaluate(
        "[...document.querySelectorAll('button, input, select, canvas, #legend')].filter(e => e.offsetParent)"
        ".map(e => e.getBoundingClientRect()).map(r => [r.left, r.right])"
    )
    assert all(left >= -1 and right <= width + 1 for left, right in boxes)
    assert page.evaluate("document.getElementById('pane').clientHeight") > 200
    assert page.evaluate("document.querySelector('#plots canvas').clientHeight") >= 80
    canvas = page.evaluate("(c => c.clientWidth / c.clientHeight)(document.querySelector('#pane canvas'))")
    assert canvas == pytest.approx(page.evaluate("exo.stage.viewer.camera.aspect"), rel=0.01)


def test_hostile_names_appear_as_text(browser, scene, tmp_path):
    evil = "<script>window.hacked = 1</script><img src=x onerror=window.hacked=2>"
    facts = replace(scene.facts, title=evil, subtitle=evil, notes=(evil,), reference=evil)
    path = tmp_path / "evil.html"
    path.write_text(viewer.html(replace(scene, facts=facts)), "utf-8")
    browser.open(path.as_uri())
    browser.evaluate("new Promise(done => setTimeout(done, 200))")
    assert browser.evaluate("window.hacked") is None
    assert browser.evaluate("document.title") == evil
    for part in ("title", "subtitle", "notes", "dashed-title"):
        assert browser.evaluate(f"document.getElementById('{part}').textContent") == evil
    assert browser.console == []


def test_reduced_motion_starts_at_rest(browser, file):
    browser.call(
        "Emulation.setEmulatedMedia", features=[{"name": "prefers-reduced-motion", "value": "reduce"}]
    )
    try:
        browser.open(file)
        assert browser.evaluate("exo.clock.playing") is False
    finally:
        browser.call("Emulation.setEmulatedMedia", features=[])
    browser.open(file)
    assert browser.evaluate("exo.clock.playing") is True


def test_a_standing_picture_is_not_drawn_again(page):
    page.evaluate(SETTLED)
    drawn = page.evaluate(
        "new Promise(done => { const n = exo.stage.renderer.info.render.frame;"
        " setTimeout(() => done(exo.stage.renderer.info.render.frame - n), 300); })"
    )
    assert drawn == 0


def test_the_frame_of_a_notebook_shows_the_page(browser, robot, gait, tmp_path):
    path = tmp_path / "notebook.html"
    path.write_text(f"<!DOCTYPE html><body>{viewer.view(robot, gait)._repr_html_()}</body>", "utf-8")
    browser.open(path.as_uri(), until="document.readyState === 'complete'")
    browser.evaluate("new Promise(done => setTimeout(done, 2500))")
    image = np.asarray(Image.open(io.BytesIO(browser.screenshot())).convert("RGB")).astype(float)
    assert reddish(image) > 0.001
    assert bluish(image) > 0.001


def test_sliders_pose_the_exoskeleton_as_pinocchio_does(page, robot, rng, scene):
    page.evaluate("[...document.querySelectorAll('#tabs button')].at(-1).click()")
    assert page.evaluate("document.getElementById('plots').hidden") is True
    q = rng.uniform(robot.lower, robot.upper)
    joints = [turn.name for turn in scene.facts.chains[0].joints]
    for k, name in enumerate(joints):
        page.evaluate(
            f"(r => {{ r.value = {q[robot.joints.index(name)]}; r.dispatchEvent(new Event('input')); }})"
            f"(exo.sliders.rows[{k}].range)"
        )
    found = np.array(page.evaluate("exo.chains[0].matrices().left_foot")).reshape(4, 4).T
    base = pin.XYZQUATToSE3(scene.arrays["base"][0].astype(float)).homogeneous
    assert found == pytest.approx(poses(robot, q, base=base)[0], abs=SINGLE)
    page.evaluate("document.querySelectorAll('#tabs button')[0].click()")


def test_sliders_end_at_the_joints_limits(page, robot, scene):
    for turn in scene.facts.chains[0].joints:
        k = robot.joints.index(turn.name)
        assert turn.limits == pytest.approx((robot.lower[k], robot.upper[k]))
    low, high = page.evaluate("[exo.sliders.rows[3].range.min, exo.sliders.rows[3].range.max].map(Number)")
    assert (low, high) == pytest.approx(scene.facts.chains[0].joints[3].limits)


def test_the_picture_and_a_film_can_be_saved(page):
    page.evaluate(
        "window.saved = []; HTMLAnchorElement.prototype.click = function () { saved.push(this.download); }"
    )
    page.evaluate("document.getElementById('png').click()")
    page.wait("saved.length === 1")
    page.evaluate("document.getElementById('webm').click()")
    page.evaluate("new Promise(done => setTimeout(done, 800))")
    page.wait(
        f"exo.stage.renderer.info.render.frame > {page.evaluate('exo.stage.renderer.info.render.frame')} + 8"
    )
    page.evaluate("document.getElementById('webm').click()")
    page.wait("saved.length === 2")
    assert page.evaluate("saved") == ["12-DoF-exoskeleton-gait.png", "12-DoF-exoskeleton-gait.webm"]
    assert page.evaluate("exo.recorder.last.size") > 1000
    head = page.evaluate("exo.recorder.last.slice(0, 4).arrayBuffer().then(b => [...new Uint8Array(b)])")
    assert head == [0x1A, 0x45, 0xDF, 0xA3]  # a Matroska file


def test_the_ghost_walks_on_its_own_angles(browser, robot, gait, tmp_path):
    path = tmp_path / "ghost.html"
    weaker = replace(gait, q=0.7 * gait.q)
    path.write_text(viewer.html(viewer.scene(robot, gait, compare=weaker, compare_title="weaker")), "utf-8")
    browser.open(path.as_uri())
    knees = browser.evaluate(
        "(exo.seek(0.3), exo.apply(), ['exo', 'ghost'].map("
        "name => exo.chains.find(c => c.spec.name === name))"
        ".map(c => 2 * Math.asin(c.joints[3].node.quaternion.y)))"
    )
    assert knees[1] == pytest.approx(0.7 * knees[0], rel=1e-4)
    assert "weaker" in browser.evaluate("document.getElementById('toggles').textContent")
    assert "weaker" in browser.evaluate("document.getElementById('dotted').innerText")
    knee = "exo.plots.plots[1]"
    same = f"{knee}.source.reference = {knee}.source.compared, {knee}.source.compared = ''"
    painted = f"({knee}.paint(), {knee}.backdrop.toDataURL())"
    assert browser.evaluate(f"{painted} !== ({same}, {painted})"), "dots, not dashes"
    assert browser.evaluate(f"{painted} !== ({knee}.source.reference = '', {painted})"), "a curve is drawn"
    assert browser.console == []


def test_the_cameras_follow_a_walk_through_the_room(browser, robot, gait, tmp_path):
    base = gait.base.copy()
    base[:, 0, 3] += 1.3 * gait.time
    base[:, 1, 3] -= 0.4 * gait.time
    path = tmp_path / "away.html"
    away = Gait(gait.time, gait.q, base=base, events=gait.events)
    path.write_text(viewer.html(viewer.scene(robot, away)), "utf-8")
    browser.open(path.as_uri())
    target = "(exo.seek({0}), exo.apply(), exo.look('{1}'), exo.stage.viewer.controls.target.toArray())"
    start = browser.evaluate(target.format(0, "left"))
    for view in ("left", "feet", "left"):
        end = browser.evaluate(target.format(float(gait.time[-1]), view))
    moved = np.subtract(end, start)
    assert moved == pytest.approx([1.3 * gait.time[-1], 0, 0.4 * gait.time[-1]], abs=1e-3)  # y up in there
    browser.evaluate("exo.seek(0), exo.apply()")
    assert browser.evaluate("exo.stage.viewer.controls.target.toArray()") == pytest.approx(start, abs=1e-3)
