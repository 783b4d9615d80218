"""A headless Chromium driven over its DevTools protocol: for pictures, films and tests.

The browser is the system's own; tornado, which meshcat brings, is the only client needed.
"""

from __future__ import annotations

import base64
import os
import shutil
import subprocess
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from exo_pin.errors import ExoPinError
from exo_pin.viewer.film.devtools import DevTools

_NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
"""Commands under which the browser is known; `EXO_PIN_CHROMIUM` names another."""

_FLAGS = (
    "--headless=new",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-dev-shm-usage",
    "--hide-scrollbars",
    "--remote-debugging-port=0",
)


def find() -> str | None:
    """Path of the installed browser, or None."""
    chosen = os.environ.get("EXO_PIN_CHROMIUM")
    return next((path for name in (chosen, *_NAMES) if name and (path := shutil.which(name))), None)


class Chromium:
    """One browser with one page; a context manager that leaves no process and no file.

    Args:
        size: Width and height of the page [px].
        flags: Further command-line flags.
        timeout: Longest wait for anything [s].

    Raises:
        ExoPinError: If no browser is installed, it does not start, or the page does not answer in time.
    """

    def __init__(
        self, size: tuple[int, int] = (1400, 860), *, flags: Sequence[str] = (), timeout: float = 60.0
    ) -> None:
        command = find()
        if command is None:
            raise ExoPinError(
                f"no Chromium found (looked for {', '.join(_NAMES)}); install it, e.g. "
                "`apt install chromium`, or name it in EXO_PIN_CHROMIUM"
            )
        self.timeout = timeout
        self._tools = DevTools(timeout)
        self._folder = Path(tempfile.mkdtemp(prefix="exo_pin-chromium-"))
        root = ["--no-sandbox"] if hasattr(os, "geteuid") and os.geteuid() == 0 else []
        self._process = subprocess.Popen(
            [command, *_FLAGS, *root, *flags, f"--user-data-dir={self._folder}", "about:blank"],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        try:
            self._tools.connect(self._port())
            self.resize(*size)
        except BaseException:
            self.close()
            raise

    @property
    def console(self) -> list[str]:
        """Errors and warnings of the page since the last `open`."""
        return self._tools.console

    @property
    def requests(self) -> list[str]:
        """Addresses that the page requested since the last `open`, its own first."""
        return self._tools.requests

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def open(self, url: str, *, until: str = "window.exo && window.exo.firstPicture > 0") -> None:
        """Load a page and wait until a JavaScript expression is true."""
        self.console.clear()
        self.requests.clear()
        self.call("Page.navigate", url=url)
        self.wait(until)

    def wait(self, expression: str) -> None:
        """Wait until a JavaScript expression is true in the page.

        Raises:
            ExoPinError: Not true in time; the message holds the page's console.
        """
        end = time.monotonic() + self.timeout
        while not self.evaluate(f"Boolean({expression})"):
            if time.monotonic() > end:
                raise ExoPinError(f"the page never reached {expression!r}; console: {self.console}")
            time.sleep(0.02)

    def evaluate(self, expression: str) -> Any:
        """Value of a JavaScript expression in the page, as JSON; promises are awaited.

        Raises:
            ExoPinError: The expression throws.
        """
        answer = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            details = answer["exceptionDetails"]
            raise ExoPinError(details.get("exception", {}).get("description", details["text"]))
        result = answer["result"]
        if "unserializableValue" in result:  # NaN, Infinity, -0: JSON has none of them
            return float(result["unserializableValue"])
        return result.get("value")

    def screenshot(self) -> bytes:
        """The page as PNG."""
        return base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"])

    def resize(self, width: int, height: int, *, scale: float = 1.0) -> None:
        """Set the page's size.

        Args:
            width: [px].
            height: [px].
            scale: Device pixels per pixel.
        """
        self.call(
            "Emulation.setDeviceMetricsOverride",
            width=width,
            height=height,
            deviceScaleFactor=scale,
            mobile=False,
        )

    def press(self, key: str) -> None:
        """Press and release a key, e.g. `"ArrowRight"` or `" "`."""
        text = {"text": key} if len(key) == 1 else {}
        self.call("Input.dispatchKeyEvent", type="keyDown", key=key, **text)
        self.call("Input.dispatchKeyEvent", type="keyUp", key=key)

    def drag(self, *points: tuple[float, float]) -> None:
        """Press the mouse at the first point [px], move through the others, and let go at the last."""
        for kind, (x, y) in [("mousePressed", points[0]), *(("mouseMoved", p) for p in points[1:])]:
            self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", buttons=1, clickCount=1)
        x, y = points[-1]
        self.call("Input.dispatchMouseEvent", type="mouseReleased", x=x, y=y, button="left", clickCount=1)

    def call(self, method: str, **params: Any) -> dict[str, Any]:
        """Call one DevTools method and wait for its answer."""
        return self._tools.call(method, **params)

    def close(self) -> None:
        """End the browser and remove what it wrote."""
        if self._tools.closed:
            return
        self._process.terminate()
        try:
            self._process.wait(5)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._tools.close()
        _remove(self._folder)

    def _port(self) -> int:
        """The port that the browser chose for DevTools."""
        file, end = self._folder / "DevToolsActivePort", time.monotonic() + self.timeout
        while not (file.exists() and file.read_text().count("\n")):
            if self._process.poll() is not None:
                raise ExoPinError(f"Chromium ended at once with code {self._process.returncode}")
            if time.monotonic() > end:
                raise ExoPinError(f"Chromium did not start within {self.timeout:g} s")
            time.sleep(0.02)
        return int(file.read_text().split()[0])


def _remove(folder: Path) -> None:
    for _ in range(50):  # the browser's helpers may still write for a moment
        shutil.rmtree(folder, ignore_errors=True)
        if not folder.exists():
            return
        time.sleep(0.05)
