"""Films from pictures: GIF by Pillow, WebM by ffmpeg or else by the browser's own recorder, MP4 by ffmpeg."""

from __future__ import annotations

import base64
import io
import shutil
import subprocess
import time
from collections.abc import Callable, Iterator, Sequence
from itertools import chain

from exo_pin.errors import ExoPinError
from exo_pin.viewer.film.chromium import Chromium

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


def gif(shots: Iterator[bytes], fps: float, _browser: Chromium) -> bytes:
    """PNGs as a GIF that repeats.

    Args:
        shots: Pictures of one size.
        fps: Frames per second.
        _browser: Not needed.
    """
    from PIL import Image

    octree = Image.Quantize.FASTOCTREE  # keeps the small coloured parts, which the others average away
    pictures = (Image.open(io.BytesIO(shot)).convert("RGB") for shot in shots)
    first, *others = [picture.quantize(160, method=octree) for picture in pictures]
    file = io.BytesIO()
    step = max(20, round(100 / fps) * 10)  # GIF counts hundredths of a second; browsers play none below 20 ms
    first.save(file, "GIF", save_all=True, append_images=others, duration=step, loop=0)
    return file.getvalue()


def webm(shots: Iterator[bytes], fps: float, browser: Chromium) -> bytes:
    """PNGs as a WebM, by ffmpeg or else by the browser's own recorder.

    Args:
        shots: Pictures of one size.
        fps: Frames per second.
        browser: Has the recorder.

    Raises:
        ExoPinError: ffmpeg fails, or the recorder writes in an unknown way.
    """
    if shutil.which("ffmpeg"):
        return _encoded(shots, fps, ["-c:v", "libvpx-vp9", "-b:v", "0", "-crf", "30", "-f", "webm"])
    return _recorded(shots, fps, browser)


def mp4(shots: Iterator[bytes], fps: float, _browser: Chromium) -> bytes:
    """PNGs as an MP4, by ffmpeg.

    Args:
        shots: Pictures of one size.
        fps: Frames per second.
        _browser: Not needed.

    Raises:
        ExoPinError: ffmpeg fails.
    """
    options = ["-c:v", "libx264", "-crf", "20", "-movflags", "frag_keyframe+empty_moov", "-f", "mp4"]
    return _encoded(shots, fps, options)


def _encoded(shots: Iterator[bytes], fps: float, options: Sequence[str]) -> bytes:
    """Frames through ffmpeg; its picture sides must be even."""
    even = ["-vf", "crop=trunc(iw/2)*2:trunc(ih/2)*2", "-pix_fmt", "yuv420p"]
    command = ["ffmpeg", "-loglevel", "error", "-f", "image2pipe", "-framerate", f"{fps:g}", "-i", "-"]
    frames = b"".join(shots)
    done = subprocess.run([*command, *even, *options, "-"], input=frames, capture_output=True, check=False)
    if done.returncode:
        raise ExoPinError(f"ffmpeg failed: {done.stderr.decode(errors='replace').strip()[-300:]}")
    return done.stdout


def _recorded(shots: Iterator[bytes], fps: float, browser: Chromium) -> bytes:
    """Frames through the browser's recorder, which goes by the wall clock.

    So every frame gets a slot that is long enough to draw it, and afterwards the file's unit of time is made
    shorter by the same factor.
    """
    start = time.monotonic()
    first = next(shots)
    slot = max(_SHORTEST_SLOT, 2 * (time.monotonic() - start))
    browser.evaluate(_RECORDER)
    begin = time.monotonic()
    for k, shot in enumerate(chain([first], shots)):
        time.sleep(max(0.0, begin + k * slot - time.monotonic()))
        browser.evaluate(f"film.frame('{base64.b64encode(shot).decode()}')")
    time.sleep(_LONGEST_DELAY)
    data = base64.b64decode(browser.evaluate("film.end()"))
    if data.count(_MILLISECONDS, 0, 4096) != 1:
        raise ExoPinError("this Chromium's recorder writes WebM in an unknown way; install ffmpeg instead")
    unit = round(1e6 / (slot * fps))
    return data.replace(_MILLISECONDS, _MILLISECONDS[:4] + unit.to_bytes(3, "big"), 1)


FILMS: dict[str, Callable[[Iterator[bytes], float, Chromium], bytes]] = {
    ".gif": gif,
    ".webm": webm,
    ".mp4": mp4,
}
"""Ending of a file name -> encoder of pictures at a frame rate."""
