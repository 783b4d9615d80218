from __future__ import annotations

import pytest

from exo_pin.viewer.film import chromium


@pytest.fixture(scope="module")
def plain(file, chromium_path):
    with chromium.Chromium((900, 700), flags=["--disable-3d-apis"]) as browser:
        browser.open(file)
        yield browser


def test_the_page_says_that_pictures_are_missing(plain):
    assert plain.evaluate("document.getElementById('no-webgl').hidden") is False
    assert plain.evaluate("document.getElementById('no-webgl').offsetHeight") > 20
    assert plain.evaluate("document.getElementById('cameras').offsetHeight") == 0, "nothing to look at"


def test_plots_time_and_keys_live_on(plain):
    plain.evaluate("exo.seek(0.5)")
    plain.press("ArrowRight")
    assert plain.evaluate("exo.clock.time") > 0.5
    label = "document.querySelector('#plots canvas').getAttribute('aria-label')"
    before = plain.evaluate(label)
    plain.evaluate("exo.seek(0.8)")
    plain.wait(f"{label} !== {before!r}")
