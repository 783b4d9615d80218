"""Pictures and films, made small so that a software renderer keeps up."""

import base64
import io
import shutil

import pytest
from PIL import Image

from exo_pin.errors import DescriptionError, ExoPinError, UnknownNameError
from exo_pin.viewer.film import chromium, shots

SMALL = {"size": (320, 240), "quality": "low"}


@pytest.fixture(autouse=True)
def _needs_a_browser(browser):
    """Skips, or fails in CI, where there is none."""


def colours(image):
    """How many pixels are clearly red, clearly blue."""
    red, blue = 0, 0
    for r, g, b in image.convert("RGB").get_flattened_data():
        red += r > 1.6 * max(g, b) and r > 60
        blue += b > 1.35 * g and b > 1.8 * r and b > 60
    return red, blue


def test_a_picture_has_the_size_that_was_asked_for_and_both_legs(scene):
    image = Image.open(io.BytesIO(shots.picture(scene, phase=0.3, **SMALL)))
    assert image.size == SMALL["size"]
    red, blue = colours(image)
    assert red > 20
    assert blue > 20


def test_cameras_and_phases_make_other_pictures(scene):
    early, late = shots.pictures(scene, [0, 0.4], **SMALL, camera="left", legend=False)
    assert len({early, late, shots.picture(scene, **SMALL)}) == 3


def test_a_gif_shows_the_walk_once_in_its_own_time(scene, tmp_path):
    seen = []

    def progress(phases):
        for phase in phases:
            seen.append(phase)
            yield phase

    data = shots.film(scene, tmp_path / "walk.gif", **SMALL, fps=4, progress=progress)
    gif = Image.open(io.BytesIO(data))
    assert getattr(gif, "n_frames", 0) == len(seen) == round(scene.facts.duration * 4)
    assert gif.info["duration"] == 250
    assert gif.info["loop"] == 0


@pytest.mark.parametrize("curves", [False, True])
def test_a_webm_of_the_browser_s_own_plays_in_the_walk_s_time(scene, tmp_path, browser, monkeypatch, curves):
    path = chromium.find()
    monkeypatch.setattr(shutil, "which", lambda name: path if name == path else None)  # no ffmpeg
    monkeypatch.setenv("EXO_PIN_CHROMIUM", path)
    data = shots.film(scene, tmp_path / "walk.webm", **SMALL, fps=5, curves=curves)
    assert data.startswith(bytes.fromhex("1a45dfa3"))
    source = base64.b64encode(data).decode()
    browser.open("about:blank", until="true")
    length, *size = browser.evaluate(
        "new Promise((done) => { const v = document.createElement('video');"
        "v.onloadedmetadata = () => done([v.duration, v.videoWidth, v.videoHeight]);"
        f"v.src = 'data:video/webm;base64,{source}' }})"
    )
    assert tuple(size) == SMALL["size"]
    assert length == pytest.approx(scene.facts.duration, rel=0.5)  # the last frame's length is the recorder's


def test_an_mp4_without_ffmpeg_says_what_is_missing(scene, tmp_path, monkeypatch):
    monkeypatch.setattr(shutil, "which", lambda name: None)
    with pytest.raises(ExoPinError, match="ffmpeg"):
        shots.film(scene, tmp_path / "walk.mp4")


def test_what_is_out_of_range_is_refused(scene, tmp_path):
    with pytest.raises(UnknownNameError):
        shots.picture(scene, camera="up")
    for wrong in ({"phase": 2}, {"size": (5, 5)}):
        with pytest.raises(DescriptionError):
            shots.picture(scene, **wrong)
    with pytest.raises(DescriptionError):
        shots.pictures(scene, [0.5, -0.1])
    for name, fps in (("walk.avi", 10), ("walk.gif", 0)):
        with pytest.raises(DescriptionError):
            shots.film(scene, tmp_path / name, fps=fps)
