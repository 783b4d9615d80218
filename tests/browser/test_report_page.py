"""The report in a real browser: no message, no request, and the player inside it walks."""

from __future__ import annotations

import io
import time

import numpy as np
import pytest
from PIL import Image

from exo_pin import report, viewer

PATIENCE = 20  # [s] for the first picture in software rendering on a busy machine
PHONE = 390  # [px]


@pytest.fixture(scope="module")
def address(robot, gait, scene, tmp_path_factory):
    info = report.ReportInfo(title="<script>document.title = 'broken'</script>")
    document = report.walk(robot, gait, info=info, player=viewer.html(scene))
    path = tmp_path_factory.mktemp("report") / "report.html"
    path.write_text(report.html(document), "utf-8")
    return path.as_uri()


def coloured(browser):
    """Shares of reddish and bluish pixels in the upper left of the player, where the legs are."""
    x, y, w, h = map(
        round,
        browser.evaluate(
            "(r => [r.x, r.y, r.width, r.height])(document.querySelector('iframe').getBoundingClientRect())"
        ),
    )
    image = np.asarray(Image.open(io.BytesIO(browser.screenshot())).convert("RGB")).astype(float)
    red, _, blue = np.moveaxis(image[y + 100 : y + h - 150, x : x + int(0.6 * w)], -1, 0)
    return np.mean(red > 1.7 * blue), np.mean((blue > 1.7 * red) & (blue > 100))


def test_the_report_opens_without_a_message_or_a_request_and_its_player_draws(browser, address):
    browser.resize(1200, 900)
    browser.open(address, until="document.readyState === 'complete'")
    browser.evaluate("document.querySelector('iframe').scrollIntoView()")
    end = time.monotonic() + PATIENCE
    while min(coloured(browser)) < 1e-3 and time.monotonic() < end:
        time.sleep(0.3)
    red, blue = coloured(browser)
    assert red > 1e-3
    assert blue > 1e-3
    assert browser.evaluate("document.title") == "<script>document.title = 'broken'</script>"
    assert browser.console == []
    assert browser.requests == [address]


def test_the_report_fits_a_phone_and_every_chart_has_a_size(browser, address):
    browser.resize(PHONE, 800)
    browser.open(address, until="document.readyState === 'complete'")
    assert browser.evaluate("document.documentElement.scrollWidth") <= PHONE
    charts = (
        "[...document.querySelectorAll('svg')].filter(s => !/^Key/.test(s.textContent))"  # legends are low
    )
    heights = browser.evaluate(f"{charts}.map(s => s.getBoundingClientRect().height)")
    assert len(heights) > 20
    assert min(heights) > 60
