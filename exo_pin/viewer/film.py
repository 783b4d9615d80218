"""Pictures and films: a headless browser shows the offline page moment by moment.

PNG and GIF need Chromium alone; MP4 needs ffmpeg besides; WebM takes ffmpeg where it is found and else the
browser's own recorder. The handles of the feet are left out: nobody can take them in a picture.
"""

from __future__ import annotations

import base64
import io
import shutil
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from exo_pin.errors import DescriptionError, ExoPinError, UnknownNameError
from exo_pin.viewer.chromium import Chromium
from exo_pin.viewer.export import html
from exo_pin.viewer.facts import Scene

CAMERAS = ("iso", "left", "right", "front", "back", "top", "feet")
"""Names of the clinical views, as in the page."""

QUALITIES = ("high", "low")
"""With studio light and shadows, or plain shading."""

SIDES = (16, 8192)
"""Smallest and largest side of a picture [px]."""

_NO_HANDS = "#grips { display: none !important }"
_ALONE = """
header, #side, #controls, #cameras, #show, #notice { display: none !important }
#app { display: block !important } #view { position: fixed !important; inset: 0 }
"""
_RECORDER = """
(() => {
  const canvas = document.createElement("canvas"), parts = [];
  Object.assign(canvas, { width: innerWidth, height: innerHeight });
  const pen = canvas.getContext("2d"), stream = canvas.captureStream(0);
  const recorder = new MediaRecorder(stream, { mimeType: "video/webm", videoBitsPerSecond: 12e6 });
  recorder.ondataavailable = (event) => parts.push(event.data);
  recorder.start();
  window.film = {
    frame: async (png) => {
      const picture = Object.assign(new Image(), { src: `data:image/png;base64,${png}` });
      await picture.decode();
      pen.drawImage(picture, 0, 0, canvas.width, canvas.height);
      stream.getVideoTracks()[0].requestFrame();
    },
    end: async () => {
      const ended = new Promise((done) => (recorder.onstop = done));
      recorder.stop();
      await ended;
      const bytes = new Uint8Array(await new Blob(parts).arrayBuffer());
      let text = "";
      for (let k = 0; k < bytes.length; k += 4096)
        text += String.fromCharCode(...bytes.subarray(k, k + 4096));
      return btoa(text);
    },
  };
})()
"""
_SHORTEST_SLOT, _LONGEST_DELAY = 0.15, 0.6  # the recorder drops what comes faster, and lags behind [s]
_MILLISECONDS = bytes.fromhex("2ad7b1830f4240")  # WebM's TimestampScale: times count in 1 000 000 ns


def picture(
    scene: Scene,
    *,
    phase: float = 0.0,
    camera: str = "iso",
    size: tuple[int, int] = (1920, 1080),
    curves: bool = False,
    quality: str = "high",
) -> bytes:
    """One moment as PNG.

    Args:
        scene: What to show.
        phase: Share of the walk's duration, 0 .. 1.
        camera: One of `CAMERAS`.
        size: Width and height [px].
        curves: The whole page with its curves, not the 3-D picture alone.
        quality: `"high"`: studio light and shadows, seconds to load without a graphics card; `"low"`: plain.

    Raises:
        DescriptionError: A size or phase is out of range.
        UnknownNameError: There is no such camera.
        ExoPinError: There is no Chromium.
    """
    if not 0 <= phase <= 1:
        raise DescriptionError(f"phase is {phase:g}; 0 .. 1 is accepted")
    with _page(scene, camera, size, curves, quality) as browser:
        _show(browser, phase)
        return browser.screenshot()


def film(
    scene: Scene,
    path: Path,
    *,
    camera: str = "iso",
    size: tuple[int, int] = (960, 720),
    fps: float = 30.0,
    curves: bool = False,
    quality: str = "high",
    progress: Callable[[Sequence[float]], Iterable[float]] = lambda phases: phases,
) -> bytes:
    """The whole walk, at the scene's playback speed, as the bytes of a GIF, WebM or MP4.

    Args:
        scene: What to show.
        path: Its ending says the kind: one of `FILMS`.
        camera: One of `CAMERAS`.
        size: Width and height [px].
        fps: Frames per second.
        curves: The whole page with its curves, not the 3-D picture alone.
        quality: `"high"` or `"low"`.
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
    with _page(scene, camera, size, curves, quality) as browser:
        return FILMS[kind](browser, phases, fps)


@contextmanager
def _page(scene: Scene, camera: str, size: tuple[int, int], curves: bool, quality: str) -> Iterator[Chromium]:
    """The offline page in a browser, standing still."""
    if quality not in QUALITIES:
        raise UnknownNameError("quality", quality, QUALITIES)
    if camera not in CAMERAS:
        raise UnknownNameError("camera", camera, CAMERAS)
    if not all(SIDES[0] <= side <= SIDES[1] for side in size):
        raise DescriptionError(f"size is {size[0]}x{size[1]}; {SIDES[0]} .. {SIDES[1]} px a side is accepted")
    with tempfile.TemporaryDirectory(prefix="exo_pin-film-") as folder, Chromium(size) as browser:
        page = Path(folder) / "walk.html"
        page.write_text(html(scene), encoding="utf-8")
        browser.open(f"{page.as_uri()}#quality={quality}")
        if not browser.evaluate("exo.stage !== null"):
            raise ExoPinError("this Chromium shows no 3-D pictures (WebGL is off or missing)")
        browser.evaluate(
            f"document.head.append(Object.assign(document.createElement('style'), "
            f"{{ textContent: `{_NO_HANDS if curves else _NO_HANDS + _ALONE}` }}))"
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


def _gif(browser: Chromium, phases: Iterable[float], fps: float) -> bytes:
    from PIL import Image

    octree = Image.Quantize.FASTOCTREE  # keeps the small coloured parts, which the others average away
    shots = (Image.open(io.BytesIO(shot)).convert("RGB") for shot in _shots(browser, phases))
    first, *others = [shot.quantize(160, method=octree) for shot in shots]
    file = io.BytesIO()
    step = max(20, round(100 / fps) * 10)  # GIF counts hundredths of a second; browsers play none below 20 ms
    first.save(file, "GIF", save_all=True, append_images=others, duration=step, loop=0)
    return file.getvalue()


def _webm(browser: Chromium, phases: Iterable[float], fps: float) -> bytes:
    if shutil.which("ffmpeg"):
        return _encoded(browser, phases, fps, ["-c:v", "libvpx-vp9", "-b:v", "0", "-crf", "30", "-f", "webm"])
    return _recorded(browser, phases, fps)


def _mp4(browser: Chromium, phases: Iterable[float], fps: float) -> bytes:
    options = ["-c:v", "libx264", "-crf", "20", "-movflags", "frag_keyframe+empty_moov", "-f", "mp4"]
    return _encoded(browser, phases, fps, options)


def _encoded(browser: Chromium, phases: Iterable[float], fps: float, options: Sequence[str]) -> bytes:
    """Frames through ffmpeg; its picture sides must be even."""
    even = ["-vf", "crop=trunc(iw/2)*2:trunc(ih/2)*2", "-pix_fmt", "yuv420p"]
    command = ["ffmpeg", "-loglevel", "error", "-f", "image2pipe", "-framerate", f"{fps:g}", "-i", "-"]
    shots = b"".join(_shots(browser, phases))
    done = subprocess.run([*command, *even, *options, "-"], input=shots, capture_output=True, check=False)
    if done.returncode:
        raise ExoPinError(f"ffmpeg failed: {done.stderr.decode(errors='replace').strip()[-300:]}")
    return done.stdout


def _recorded(browser: Chromium, phases: Iterable[float], fps: float) -> bytes:
    """Frames through the browser's recorder, which goes by the wall clock.

    So every frame gets a slot that is long enough to draw it, and afterwards the file's unit of time is made
    shorter by the same factor.
    """
    start = time.monotonic()
    _show(browser, 0.0)
    browser.screenshot()
    slot = max(_SHORTEST_SLOT, 2 * (time.monotonic() - start))
    browser.evaluate(_RECORDER)
    begin = time.monotonic()
    for k, shot in enumerate(_shots(browser, phases)):
        time.sleep(max(0.0, begin + k * slot - time.monotonic()))
        browser.evaluate(f"film.frame('{base64.b64encode(shot).decode()}')")
    time.sleep(_LONGEST_DELAY)
    data = base64.b64decode(browser.evaluate("film.end()"))
    if data.count(_MILLISECONDS, 0, 4096) != 1:
        raise ExoPinError("this Chromium's recorder writes WebM in an unknown way; install ffmpeg instead")
    unit = round(1e6 / (slot * fps))
    return data.replace(_MILLISECONDS, _MILLISECONDS[:4] + unit.to_bytes(3, "big"), 1)


FILMS: dict[str, Callable[[Chromium, Iterable[float], float], bytes]] = {
    ".gif": _gif,
    ".webm": _webm,
    ".mp4": _mp4,
}
"""File name ending -> what makes the film."""
