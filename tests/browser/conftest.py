"""One headless browser for all tests of the viewer; without a browser they are skipped."""

from __future__ import annotations

import os
from dataclasses import replace

import pytest

from exo_pin import viewer
from exo_pin.gait import normative_gait
from exo_pin.robot import load_robot
from exo_pin.viewer.film import chromium


@pytest.fixture(scope="session")
def chromium_path():
    """Path of the browser; without one the test is skipped, or fails where a browser is demanded (CI)."""
    if chromium.find() is None:
        assert "EXO_PIN_REQUIRE_BROWSER" not in os.environ, "CI must test in a browser"
        pytest.skip("needs Chromium (e.g. `apt install chromium`), or its path in EXO_PIN_CHROMIUM")
    return chromium.find()


@pytest.fixture(scope="session")
def browser(chromium_path):
    with chromium.Chromium((1000, 680)) as running:
        yield running


@pytest.fixture(scope="session")
def robot():
    return load_robot()


@pytest.fixture(scope="session")
def gait():
    return normative_gait()


@pytest.fixture(scope="session")
def scene(robot, gait):
    weaker = replace(gait, q=0.8 * gait.q)
    return viewer.scene(robot, gait, reference=weaker, reference_title="four fifths")


@pytest.fixture(scope="session")
def saved(tmp_path_factory):
    """Saves the page of a scene and returns its address."""

    def save(scene):
        path = tmp_path_factory.mktemp("page") / "walk.html"
        path.write_text(viewer.html(scene), "utf-8")
        return path.as_uri()

    return save


@pytest.fixture(scope="session")
def file(scene, saved):
    return saved(scene)


@pytest.fixture(scope="module")
def opened(browser, address):
    """The page at a module's own address, loaded once."""
    browser.resize(1000, 680)
    browser.open(address)
    return browser


@pytest.fixture
def page(browser, file):
    """The offline page, freshly loaded and standing still at its first frame."""
    browser.resize(1000, 680)
    browser.open(file)
    browser.evaluate("exo.seek(0)")
    return browser
