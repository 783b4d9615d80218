"""Pictures and films: a headless browser shows the offline page moment by moment.

PNG and GIF need Chromium alone; MP4 needs ffmpeg besides; WebM takes ffmpeg where it is found and else the
browser's own recorder. The handles of the feet are left out.
"""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Literal, get_args

from exo_pin.errors import DescriptionError, ExoPinError, UnknownNameError
from exo_pin.viewer.film.chromium import Chromium
from exo_pin.viewer.film.encode import FILMS
from exo_pin.viewer.page.packing import html
from exo_pin.viewer.scenes.scene import Scene

CameraName = Literal["iso", "left", "right", "front", "back", "top", "feet"]
"""A clinical view, as in the page."""

Quality = Literal["high", "low"]
"""With studio light and shadows, or plain shading."""

_CAMERAS: tuple[CameraName, ...] = get_args(CameraName)
_QUALITIES: tuple[Quality, ...] = get_args(Quality)

_SMALLEST, _LARGEST = 16, 8192
"""Side of a picture [px]."""

TIMEOUT = 60.0
"""Longest wait for the browser [s]: enough for 8192 px a side in software."""

_LONGEST_TIMEOUT = 3600.0  # [s]

_NO_HANDLES = "#handles { display: none !important }"
_ALONE = """
header, #side, #controls, #cameras, #show, #notice { display: none !important }
#app { display: block !important } #view { position: fixed !important; inset: 0 }
#pane { inset: 0 !important }
"""


def picture(
    scene: Scene,
    *,
    phase: float = 0.0,
    camera: CameraName = "iso",
    size: tuple[int, int] = (1920, 1080),
    curves: bool = False,
    quality: Quality = "high",
    timeout: float = TIMEOUT,
) -> bytes:
    """One moment as PNG.

    Args:
        scene: What to show.
        phase: Share of the walk's duration, 0 .. 1.
        camera: A clinical view.
        size: Width and height [px].
        curves: The whole page with its curves, not the 3-D picture alone.
        quality: `"high"`: studio light and shadows, seconds to load without a graphics card; `"low"`: plain.
        timeout: Longest wait for the browser: for its start, for the page, for each picture [s].

    Raises:
        DescriptionError: A size or phase is out of range.
        UnknownNameError: There is no such camera or quality.
        ExoPinError: There is no Chromium.
    """
    look: dict[str, Any] = {"camera": camera, "size": size, "curves": curves, "quality": quality}
    return pictures(scene, [phase], **look, timeout=timeout)[0]


def pictures(
    scene: Scene,
    phases: Sequence[float],
    *,
    camera: CameraName = "iso",
    size: tuple[int, int] = (1920, 1080),
    curves: bool = False,
    quality: Quality = "high",
    legend: bool = True,
    timeout: float = TIMEOUT,
) -> list[bytes]:
    """Several moments as PNG, by one browser; errors as of `picture`.

    Args:
        scene: What to show.
        phases: Shares of the walk's duration, 0 .. 1.
        camera: A clinical view.
        size: Width and height [px].
        curves: The whole page with its curves, not the 3-D picture alone.
        quality: `"high"`: studio light and shadows; `"low"`: plain.
        legend: Whether to draw the legend of colours.
        timeout: Longest wait for the browser: for its start, for the page, for each picture [s].
    """
    for phase in phases:
        if not 0 <= phase <= 1:
            raise DescriptionError(f"phase is {phase:g}; 0 .. 1 is accepted")
    with _page(scene, camera, size, curves, quality, timeout) as browser:
        browser.evaluate(f"document.getElementById('legend').hidden = {'false' if legend else 'true'}")
        return list(_shots(browser, phases))


def film(
    scene: Scene,
    path: Path,
    *,
    camera: CameraName = "iso",
    size: tuple[int, int] = (960, 720),
    fps: float = 30.0,
    curves: bool = False,
    quality: Quality = "high",
    timeout: float = TIMEOUT,
    progress: Callable[[Sequence[float]], Iterable[float]] = lambda phases: phases,
) -> bytes:
    """The whole walk, at the scene's playback speed, as the bytes of a GIF, WebM or MP4.

    Args:
        scene: What to show.
        path: Its ending chooses the format: one of `FILMS`.
        camera: A clinical view.
        size: Width and height [px].
        fps: Frames per second.
        curves: The whole page with its curves, not the 3-D picture alone.
        quality: `"high"` or `"low"`.
        timeout: Longest wait for the browser: for its start, for the page, for each picture [s].
        progress: Wraps the phases that are shown one after the other, e.g. in a progress bar.

    Raises:
        DescriptionError: Unknown ending, or a size or frame rate out of range.
        ExoPinError: Chromium or ffmpeg is missing.
    """
    kind = path.suffix.lower()
    if kind not in FILMS:
        raise DescriptionError(f"{path}: a film ends in {', '.join(FILMS)}")
    if kind == ".mp4" and not shutil.which("ffmpeg"):
        raise ExoPinError("an MP4 needs ffmpeg (e.g. `apt install ffmpeg`); .webm and .gif do without")
    if not 1 <= fps <= 60:
        raise DescriptionError(f"fps is {fps:g}; 1 .. 60 is accepted")
    count = max(2, round(scene.facts.duration / scene.facts.speed * fps))
    phases = progress([k / count for k in range(count)])
    with _page(scene, camera, size, curves, quality, timeout) as browser:
        return FILMS[kind](_shots(browser, phases), fps, browser)


@contextmanager
def _page(
    scene: Scene, camera: CameraName, size: tuple[int, int], curves: bool, quality: Quality, timeout: float
) -> Iterator[Chromium]:
    """The offline page in a browser, standing still."""
    if quality not in _QUALITIES:
        raise UnknownNameError("quality", quality, _QUALITIES)
    if camera not in _CAMERAS:
        raise UnknownNameError("camera", camera, _CAMERAS)
    if not all(_SMALLEST <= side <= _LARGEST for side in size):
        raise DescriptionError(
            f"size is {size[0]}x{size[1]}; {_SMALLEST} .. {_LARGEST} px a side is accepted"
        )
    if not 1 <= timeout <= _LONGEST_TIMEOUT:
        raise DescriptionError(f"timeout is {timeout:g} s; 1 .. {_LONGEST_TIMEOUT:g} is accepted")
    with Chromium(size, timeout=timeout) as browser:
        browser.open_page(html(scene), f"quality={quality}")
        if not browser.evaluate("exo.stage !== null"):
            raise ExoPinError("this Chromium shows no 3-D pictures (WebGL is off or missing)")
        browser.evaluate(
            f"document.head.append(Object.assign(document.createElement('style'), "
            f"{{ textContent: `{_NO_HANDLES if curves else _NO_HANDLES + _ALONE}` }}))"
        )
        browser.evaluate("exo.clock.play(false)")
        browser.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
        browser.evaluate(f"exo.look('{camera}')")
        yield browser


def _show(browser: Chromium, phase: float) -> None:
    browser.evaluate(
        f"exo.seek({phase!r} * exo.clock.duration); exo.apply(); exo.controls.show(exo); exo.stage.draw()"
    )


def _shots(browser: Chromium, phases: Iterable[float]) -> Iterator[bytes]:
    for phase in phases:
        _show(browser, phase)
        yield browser.screenshot()
