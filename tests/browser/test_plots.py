"""The plots in a browser: torques, phase by cycles, and the window that follows the cursor."""

from __future__ import annotations

import numpy as np
import pytest

from exo_pin import viewer
from exo_pin.gait import Gait, Torques

CYCLES = 30  # 3000 frames
SINGLE = 1e-5  # [deg, N m] float32
FRAME = 16.0  # [ms] of a screen with 60 pictures a second
SETTLED = "new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))"


@pytest.fixture(scope="module")
def recording(gait):
    walk = gait.repeated(CYCLES)
    return Gait(walk.time, walk.q, base=walk.base, events=walk.events, source="thirty cycles")


@pytest.fixture(scope="module")
def torques(recording):
    time = recording.time[500:2500]
    return Torques(time, np.outer(np.sin(time), np.arange(1.0, 13.0)), source="<b>made</b>")


@pytest.fixture(scope="module")
def address(robot, recording, torques, saved):
    return saved(viewer.scene(robot, recording, torques=torques, wearer=False))


@pytest.fixture
def page(opened):
    opened.evaluate(
        "exo.plots.choose(0); exo.plots.window.zoom(5 / exo.plots.window.span, 0); exo.plots.moved();"
        "exo.seek(0)"
    )
    return opened


def window(page):
    page.evaluate(SETTLED)
    return page.evaluate("[exo.plots.window.start, exo.plots.window.end]")


def test_the_torques_have_a_tab_with_values_and_gaps(page, torques):
    page.evaluate(
        "[...document.querySelectorAll('#tabs button')].find(b => b.textContent === 'Torques').click()"
    )
    inside, outside = float(torques.time[700]), 1.0
    said = []
    for t in (inside, outside):
        page.evaluate(f"exo.seek({t})")
        page.evaluate(SETTLED)
        said.append(page.evaluate("document.querySelectorAll('#plots canvas')[1].getAttribute('aria-label')"))
    knee = torques.at([inside])[0, [3, 9]]
    assert said[0] == "Knee flexion: " + ", ".join(
        f"{side} {x:.0f} N m".replace("-", "\u2212") for side, x in zip(("left", "right"), knee, strict=True)
    )
    assert said[1] == "Knee flexion: left \u2013, right \u2013"
    assert "<b>made</b>" in page.evaluate("document.getElementById('notes').textContent")
    assert page.console == []


def test_the_phase_is_that_of_the_gait_cycle(page, gait):
    page.evaluate(f"exo.seek({4.25 * gait.duration})")
    page.evaluate(SETTLED)
    said = page.evaluate("document.getElementById('time').innerText")
    assert "25.0 %" in said
    assert f"left cycle 5 of {CYCLES - 1}" in said
    page.evaluate(f"exo.seek({(CYCLES - 0.5) * gait.duration})")  # no strike ends the last one
    page.evaluate(SETTLED)
    assert "outside the left cycles" in page.evaluate("document.getElementById('time').innerText")


def test_the_keys_go_from_heel_strike_to_heel_strike(page, gait):
    page.evaluate("document.activeElement.blur()")
    for _ in range(3):
        page.press("PageDown")
    assert page.evaluate("exo.clock.time") == pytest.approx(3 * gait.duration, abs=1e-4)
    page.press("PageUp")
    assert page.evaluate("exo.clock.time") == pytest.approx(2 * gait.duration, abs=1e-4)


def test_the_window_follows_the_cursor_and_never_leaves_the_recording(page, recording):
    end = recording.duration
    assert window(page) == [0, pytest.approx(5)]
    for t in (2.0, 4.9, 8.0, 20.0, end, 17.0, 0.0):
        page.evaluate(f"exo.seek({t})")
        low, high = window(page)
        assert 0 <= low <= t <= high <= end + 1e-9
        assert high - low == pytest.approx(5)
        x, left, right = page.evaluate(f"(p => [p.x.of({t}), p.x.from, p.x.to])(exo.plots.plots[0])")
        assert left <= x <= right


def test_a_drag_inside_the_window_seeks_within_it(page):
    page.evaluate("exo.seek(15)")
    low, high = window(page)
    canvas = "document.querySelector('#plots canvas')"
    x, y, w, h = page.evaluate(f"(r => [r.x, r.y, r.width, r.height])({canvas}.getBoundingClientRect())")
    page.drag((x + 0.4 * w, y + h / 2), (x + 0.7 * w, y + h / 2))
    left, right = page.evaluate("[exo.plots.plots[0].x.from, exo.plots.plots[0].x.to]")
    share = (0.7 * w - left) / (right - left)
    assert page.evaluate("exo.clock.time") == pytest.approx(low + share * (high - low), abs=0.02)
    assert window(page) == [low, high]


def test_the_window_narrows_widens_and_shows_all_at_one_click(page, recording):
    page.evaluate("exo.seek(10)")
    low, high = window(page)
    page.press("[")
    assert page.evaluate("exo.plots.window.span") < high - low
    page.evaluate("document.getElementById('wider').click()")
    assert page.evaluate("exo.plots.window.span") == pytest.approx(high - low)
    page.evaluate("document.getElementById('whole').click()")
    assert window(page) == [0, pytest.approx(recording.duration)]
    assert page.evaluate("document.getElementById('stretch').textContent") == "all"
    page.press("w")
    assert page.evaluate("exo.plots.window.span") == pytest.approx(5)


def test_with_reduced_motion_the_window_turns_over_instead_of_sliding(page):
    times = "[1, 4.4, 4.6, 4.8, 5, 8.4]"
    starts = f"(w => (w.span = 5, {times}.map(t => (w.follow(t), w.start))))(new TimeWindow(60, {{0}}))"
    sliding = page.evaluate(starts.format("false"))
    calm = page.evaluate(starts.format("true"))
    assert len(set(sliding)) == 5
    assert len(set(calm)) == 2
    assert calm == sorted(calm)


def test_a_long_curve_is_thinned_without_losing_its_peaks(page):
    rows = page.evaluate(
        "(() => { const d = new Float32Array(10000); d[7777] = 9; d[1234] = -9;"
        " return extremes(d, 1, 0, 0, 10000, 200); })()"
    )
    assert {7777, 1234} <= set(rows)
    assert len(rows) <= 2 * 201
    assert rows == sorted(rows)


def test_the_cursor_does_not_stutter_in_a_recording_of_thousands_of_frames(page):
    cost = page.evaluate(
        "[...Array(150).keys()].map(k => { const t = 10 + k / 60, at = exo.motion.at(t);"
        " const start = performance.now(); exo.plots.draw(t, at); return performance.now() - start; })"
    )
    assert np.median(cost) < FRAME / 2  # the window slides: all six plots are painted each time
