"""A headless Chromium driven over its DevTools protocol: for pictures, films and tests.

The browser is the system's own; tornado, which meshcat brings, is the only client needed.
"""

from __future__ import annotations

import asyncio
import base64
import json
import os
import shutil
import subprocess
import tempfile
import threading
import time
import urllib.request
from collections.abc import Callable, Coroutine, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from exo_pin.errors import ExoPinError

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
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
    asked = os.environ.get("EXO_PIN_CHROMIUM")
    return next((path for name in (asked, *NAMES) if name and (path := shutil.which(name))), None)


class Chromium:
    """One browser with one page; a context manager that leaves no process and no file.

    Args:
        size: Width and height of the page [px].
        flags: Further command-line flags.
        timeout: Longest wait for anything [s].

    Attributes:
        console: Errors and warnings of the page since the last `open`.
        requests: Addresses that the page asked for since the last `open`, its own first.

    Raises:
        ExoPinError: If no browser is installed, it does not start, or the page does not answer in time.
    """

    def __init__(
        self, size: tuple[int, int] = (1400, 860), *, flags: Sequence[str] = (), timeout: float = 60.0
    ) -> None:
        command = find()
        if command is None:
            raise ExoPinError(
                f"no Chromium found (looked for {', '.join(NAMES)}); install it, e.g. "
                "`apt install chromium`, or name it in EXO_PIN_CHROMIUM"
            )
        self.timeout = timeout
        self.console: list[str] = []
        self.requests: list[str] = []
        self._answers: dict[int, asyncio.Future[dict[str, Any]]] = {}
        self._count = 0
        self._folder = tempfile.mkdtemp(prefix="exo_pin-chromium-")
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, name="exo_pin chromium", daemon=True)
        self._thread.start()
        root = ["--no-sandbox"] if hasattr(os, "geteuid") and os.geteuid() == 0 else []
        self._process = subprocess.Popen(
            [command, *_FLAGS, *root, *flags, f"--user-data-dir={self._folder}", "about:blank"],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        try:
            self._run(self._connect())
            self.resize(*size)
        except BaseException:
            self.close()
            raise

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
        """Set the page's size [px] and its pixel ratio."""
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
        answer: dict[str, Any] = self._run(self._ask(method, params))
        return answer

    def close(self) -> None:
        """End the browser and remove what it wrote."""
        if self._loop.is_closed():
            return
        self._process.terminate()
        try:
            self._process.wait(5)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._run(self._hang_up())
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()
        self._loop.close()
        _remove(Path(self._folder))

    def _run(self, work: Coroutine[Any, Any, Any]) -> Any:
        """Run a coroutine in the client's own thread, so that callers may have a running loop themselves."""
        try:
            return asyncio.run_coroutine_threadsafe(work, self._loop).result(self.timeout)
        except TimeoutError:
            raise ExoPinError(f"Chromium did not answer within {self.timeout:g} s") from None

    async def _connect(self) -> None:
        from tornado.websocket import websocket_connect  # meshcat brings tornado

        port = await self._port()
        with urllib.request.urlopen(f"http://127.0.0.1:{port}/json") as answer:
            pages = [target for target in json.load(answer) if target["type"] == "page"]
        self._socket = await websocket_connect(pages[0]["webSocketDebuggerUrl"], max_message_size=1 << 28)
        self._reader = asyncio.ensure_future(self._read())
        for domain in ("Page", "Runtime", "Log", "Network"):
            await self._ask(f"{domain}.enable", {})

    async def _port(self) -> int:
        file = Path(self._folder) / "DevToolsActivePort"
        while not (file.exists() and file.read_text().count("\n")):
            if self._process.poll() is not None:
                raise ExoPinError(f"Chromium ended at once with code {self._process.returncode}")
            await asyncio.sleep(0.02)
        return int(file.read_text().split()[0])

    async def _ask(self, method: str, params: dict[str, Any]) -> dict[str, Any]:
        self._count += 1
        number = self._count
        waiting = self._answers[number] = asyncio.get_running_loop().create_future()
        await self._socket.write_message(json.dumps({"id": number, "method": method, "params": params}))
        answer = await waiting
        if "error" in answer:
            raise ExoPinError(f"{method}: {answer['error'].get('message')}")
        result: dict[str, Any] = answer["result"]
        return result

    async def _read(self) -> None:
        while (text := await self._socket.read_message()) is not None:
            message = json.loads(text)
            if "id" in message:
                if waiting := self._answers.pop(message["id"], None):
                    waiting.set_result(message)
            elif note := _NOTES.get(message["method"]):
                note(self, message["params"])

    async def _hang_up(self) -> None:
        if hasattr(self, "_socket"):
            self._socket.close()
            self._reader.cancel()
            await asyncio.gather(self._reader, return_exceptions=True)
        await asyncio.sleep(0)


def _note_console(browser: Chromium, params: dict[str, Any]) -> None:
    if params["type"] in ("error", "warning", "assert"):
        browser.console.append(
            " ".join(str(arg.get("value", arg.get("description"))) for arg in params["args"])
        )


def _note_exception(browser: Chromium, params: dict[str, Any]) -> None:
    details = params["exceptionDetails"]
    browser.console.append(details.get("exception", {}).get("description", details["text"]))


def _note_log(browser: Chromium, params: dict[str, Any]) -> None:
    if params["entry"]["level"] in ("error", "warning"):
        browser.console.append(params["entry"]["text"])


def _note_request(browser: Chromium, params: dict[str, Any]) -> None:
    browser.requests.append(params["request"]["url"])


def _note_socket(browser: Chromium, params: dict[str, Any]) -> None:
    browser.requests.append(params["url"])


_NOTES: dict[str, Callable[[Chromium, dict[str, Any]], None]] = {
    "Runtime.consoleAPICalled": _note_console,
    "Runtime.exceptionThrown": _note_exception,
    "Log.entryAdded": _note_log,
    "Network.requestWillBeSent": _note_request,
    "Network.webSocketCreated": _note_socket,
}


def _remove(folder: Path) -> None:
    for _ in range(50):  # the browser's helpers may still write for a moment
        shutil.rmtree(folder, ignore_errors=True)
        if not folder.exists():
            return
        time.sleep(0.05)
