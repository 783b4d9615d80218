"""A headless Chromium driven over its DevTools protocol: for pictures, films and tests.

The browser is the system's own, driven over pipes.
"""

from __future__ import annotations

import base64
import time
from collections.abc import Sequence
from types import TracebackType
from typing import Any, Self

from exo_pin.errors import ExoPinError
from exo_pin.viewer.film.devtools import BrowserEndedError, DevTools
from exo_pin.viewer.film.guarded_browser import GuardedBrowser
from exo_pin.viewer.film.guarded_browser import find as find


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
        self.timeout = timeout
        self._browser = GuardedBrowser(flags)
        self._tools = DevTools(self._browser.commands, self._browser.answers, timeout)
        try:
            self._tools.connect()
            self.resize(*size)
        except BrowserEndedError:
            self.close()
            raise ExoPinError("Chromium ended at once instead of starting") from None
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

    def open_page(self, page: str, fragment: str = "") -> None:
        """Load a page from its text, which nobody else can read.

        Args:
            page: HTML.
            fragment: What follows `#` in its address.
        """
        file = self._browser.folder / "page.html"
        file.write_text(page, encoding="utf-8")
        self.open(f"{file.as_uri()}#{fragment}")

    def wait(self, expression: str) -> None:
        """Wait until a JavaScript expression is true in the page.

        Raises:
            ExoPinError: Not true in time; the message holds the page's console.
        """
        end = time.monotonic() + self.timeout
        while not self.evaluate(f"Boolean({expression})"):
            if time.monotonic() > end:
                raise ExoPinError(
                    f"the page is not ready within {self.timeout:g} s ({expression}); errors: {self.console}"
                )
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
        """End the browser and remove what it wrote; may be called twice."""
        self._browser.close()
