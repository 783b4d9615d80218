from __future__ import annotations

import asyncio
import math
import os
import signal
import threading
import time

import pytest

from exo_pin.errors import ExoPinError
from exo_pin.viewer.film import chromium
from exo_pin.viewer.film.chromium import Chromium

SOON = 10.0  # [s]: far below the driver's own patience


def test_values_come_back_as_they_are(browser):
    browser.open("data:text/html,<p>hello", until="true")
    assert browser.evaluate("[1, 'a', null, {x: [true]}]") == [1, "a", None, {"x": [True]}]
    assert math.copysign(1, browser.evaluate("-0")) == -1
    assert math.isnan(browser.evaluate("NaN"))
    assert browser.evaluate("Promise.resolve(7)") == 7


def test_errors_of_the_page_are_raised_with_their_words(browser):
    with pytest.raises(ExoPinError, match="no such thing"):
        browser.evaluate("(() => { throw new Error('no such thing'); })()")


def test_it_works_inside_a_running_event_loop(browser):
    async def inside():
        return browser.evaluate("6 * 7")

    assert asyncio.run(inside()) == 42


def test_without_a_browser_it_says_how_to_get_one(monkeypatch):
    monkeypatch.setenv("PATH", "")
    monkeypatch.delenv("EXO_PIN_CHROMIUM", raising=False)
    assert chromium.find() is None
    with pytest.raises(ExoPinError, match="apt install chromium"):
        Chromium()


def test_what_is_no_browser_is_noticed(monkeypatch):
    monkeypatch.setenv("EXO_PIN_CHROMIUM", "true")
    with pytest.raises(ExoPinError, match="ended at once"):
        Chromium()


def test_a_browser_that_dies_is_noticed_and_leaves_nothing(browser):
    before = set(threading.enumerate())
    with Chromium((300, 200)) as second:
        folder = second._browser.folder
        pid = int(os.readlink(folder / "profile" / "SingletonLock").rpartition("-")[2])
        threading.Timer(0.3, os.kill, (pid, signal.SIGKILL)).start()
        start = time.monotonic()
        with pytest.raises(ExoPinError):
            second.evaluate("new Promise(() => {})")
        assert time.monotonic() - start < SOON
    assert not folder.exists()
    assert set(threading.enumerate()) <= before
