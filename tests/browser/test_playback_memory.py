"""A minute of playback, frame by frame on a clock of our own, leaves nothing behind in the browser."""

from __future__ import annotations

import pytest

RATE = 60  # frames per second of the page's clock
WARM_UP = 10  # [s] of playback in which the browser compiles and fills its caches
MINUTE = 60  # [s]
GROWTH = 150_000  # [bytes]: keeping the twelve angles of each frame, in single precision, would be 173 000
PLAY = """
window.playFor = async (seconds) => {  // the player's own frames; of these every 60th is drawn
  const next = window.requestAnimationFrame;
  window.requestAnimationFrame = () => 0;
  const { viewer } = exo.stage;
  const { render } = viewer;
  const skip = () => { viewer.needs_render = false; };
  for (let k = 0; k < seconds * %d; k++) {
    viewer.render = k %% 60 ? skip : render;
    exo.frame((window.simulated += 1000 / %d));
    if (k %% 60 === 0) await new Promise((done) => setTimeout(done));
  }
  Object.assign(viewer, { render });
  window.requestAnimationFrame = next;
};
window.simulated = performance.now();
"""


@pytest.fixture
def small(browser, file):
    browser.resize(480, 400)
    browser.open(file)
    browser.evaluate(PLAY % (RATE, RATE))
    yield browser
    browser.resize(1000, 680)
    browser.open("about:blank", until="true")


def test_a_minute_of_playback_does_not_grow(small):
    def play(seconds):
        for _ in range(0, seconds, 5):
            small.evaluate("playFor(5)")
        small.call("HeapProfiler.collectGarbage")
        nodes = small.call("Memory.getDOMCounters")
        graphics = small.evaluate("exo.stage.renderer.info.memory")
        return small.call("Runtime.getHeapUsage")["usedSize"], nodes, graphics

    small.evaluate("exo.clock.play()")
    start = small.evaluate("exo.clock.time")
    before, nodes, graphics = play(WARM_UP)
    after, nodes_after, graphics_after = play(MINUTE)
    assert small.evaluate("exo.clock.time") != start  # it did play
    assert after - before < GROWTH
    assert nodes_after == nodes
    assert graphics_after == graphics
