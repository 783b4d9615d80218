"""A client of the DevTools protocol, in a thread of its own: callers may have a running event loop."""

from __future__ import annotations

import asyncio
import json
import threading
import urllib.request
from collections.abc import Callable, Coroutine
from typing import Any

from exo_pin.errors import ExoPinError

_Params = dict[str, Any]


class DevTools:
    """A connection to the first page of a browser.

    Args:
        timeout: Longest wait for an answer [s].

    Attributes:
        console: Errors and warnings of the page.
        requests: Addresses that the page requested.
    """

    def __init__(self, timeout: float) -> None:
        self.timeout = timeout
        self.console: list[str] = []
        self.requests: list[str] = []
        self._answers: dict[int, asyncio.Future[dict[str, Any]]] = {}
        self._count = 0
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, name="exo_pin devtools", daemon=True)
        self._thread.start()

    @property
    def closed(self) -> bool:
        """Whether `close` was called."""
        return self._loop.is_closed()

    def connect(self, port: int) -> None:
        """Connect to the page of the browser that listens on a local port."""
        self._run(self._connect(port))

    def call(self, method: str, **params: Any) -> dict[str, Any]:
        """Call one method and wait for its answer.

        Raises:
            ExoPinError: The browser refuses, does not answer in time, or has ended.
        """
        answer: dict[str, Any] = self._run(self._send(method, params))
        return answer

    def close(self) -> None:
        """Hang up and end the thread."""
        self._run(self._hang_up())
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()
        self._loop.close()

    def _run(self, work: Coroutine[Any, Any, Any]) -> Any:
        try:
            return asyncio.run_coroutine_threadsafe(work, self._loop).result(self.timeout)
        except TimeoutError:
            raise ExoPinError(f"Chromium did not answer within {self.timeout:g} s") from None

    async def _connect(self, port: int) -> None:
        from tornado.websocket import websocket_connect  # meshcat brings tornado

        with urllib.request.urlopen(f"http://127.0.0.1:{port}/json") as answer:
            pages = [target for target in json.load(answer) if target["type"] == "page"]
        self._socket = await websocket_connect(pages[0]["webSocketDebuggerUrl"], max_message_size=1 << 28)
        self._reader = asyncio.ensure_future(self._read())
        for domain in ("Page", "Runtime", "Log", "Network"):
            await self._send(f"{domain}.enable", {})

    async def _send(self, method: str, params: _Params) -> dict[str, Any]:
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
        for waiting in self._answers.values():
            waiting.set_result({"error": {"message": "the browser has ended"}})
        self._answers.clear()

    async def _hang_up(self) -> None:
        if hasattr(self, "_socket"):
            self._socket.close()
            self._reader.cancel()
            await asyncio.gather(self._reader, return_exceptions=True)
        await asyncio.sleep(0)


def _note_console(tools: DevTools, params: _Params) -> None:
    if params["type"] in ("error", "warning", "assert"):
        values = (arg.get("value", arg.get("description")) for arg in params["args"])
        tools.console.append(" ".join(map(str, values)))


def _note_exception(tools: DevTools, params: _Params) -> None:
    details = params["exceptionDetails"]
    tools.console.append(details.get("exception", {}).get("description", details["text"]))


def _note_log(tools: DevTools, params: _Params) -> None:
    if params["entry"]["level"] in ("error", "warning"):
        tools.console.append(params["entry"]["text"])


def _note_request(tools: DevTools, params: _Params) -> None:
    tools.requests.append(params["request"]["url"])


def _note_socket(tools: DevTools, params: _Params) -> None:
    tools.requests.append(params["url"])


_NOTES: dict[str, Callable[[DevTools, _Params], None]] = {
    "Runtime.consoleAPICalled": _note_console,
    "Runtime.exceptionThrown": _note_exception,
    "Log.entryAdded": _note_log,
    "Network.requestWillBeSent": _note_request,
    "Network.webSocketCreated": _note_socket,
}
