"""A client of the DevTools protocol over two pipes: JSON messages, each with a zero byte at its end.

It has no thread and no event loop: the caller waits, and a signal ends the wait at once.
"""

from __future__ import annotations

import json
import os
import selectors
import time
from collections.abc import Callable
from typing import IO, Any

from exo_pin.errors import ExoPinError

_Params = dict[str, Any]

_END = b"\0"
_MOST_BYTES = 1 << 20  # read or written at once


class BrowserEndedError(ExoPinError):
    """The browser has closed its pipe."""


class DevTools:
    """A connection to the first page of a browser; for one thread at a time.

    Args:
        commands: Pipe that the browser reads.
        answers: Pipe that the browser writes.
        timeout: Longest wait for an answer [s].

    Attributes:
        console: Errors and warnings of the page.
        requests: Addresses that the page requested.
    """

    def __init__(self, commands: IO[bytes], answers: IO[bytes], timeout: float) -> None:
        self.timeout = timeout
        self.console: list[str] = []
        self.requests: list[str] = []
        self._commands, self._answers = commands, answers
        self._outgoing, self._incoming = b"", bytearray()
        self._results: dict[int, _Params] = {}
        self._count = 0
        self._session: _Params = {}
        for pipe in (commands, answers):
            os.set_blocking(pipe.fileno(), False)

    def connect(self) -> None:
        """Connect to the browser's page, as soon as it has one.

        Raises:
            ExoPinError: The browser does not start in time.
        """
        end = time.monotonic() + self.timeout
        while not (pages := self._pages()):
            if time.monotonic() > end:
                raise ExoPinError(f"Chromium did not start within {self.timeout:g} s")
            time.sleep(0.02)
        attached = self.call("Target.attachToTarget", targetId=pages[0], flatten=True)
        self._session = {"sessionId": attached["sessionId"]}
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")

    def call(self, method: str, **params: Any) -> dict[str, Any]:
        """Call one method and wait for its answer.

        Raises:
            BrowserEndedError: The browser has ended.
            ExoPinError: The browser refuses, or does not answer in time.
        """
        self._count += 1
        number, end = self._count, time.monotonic() + self.timeout
        message = {"id": number, "method": method, "params": params, **self._session}
        self._outgoing += json.dumps(message).encode() + _END
        while number not in self._results:
            self._exchange(end)
        answer = self._results.pop(number)
        if "error" in answer:
            raise ExoPinError(f"Chromium refuses {method}: {answer['error'].get('message')}")
        result: dict[str, Any] = answer["result"]
        return result

    def _pages(self) -> list[str]:
        targets = self.call("Target.getTargets")["targetInfos"]
        return [target["targetId"] for target in targets if target["type"] == "page"]

    def _exchange(self, end: float) -> None:
        """Wait until a pipe is ready, and write or read what it takes or has."""
        with selectors.DefaultSelector() as pipes:
            pipes.register(self._answers, selectors.EVENT_READ)
            if self._outgoing:
                pipes.register(self._commands, selectors.EVENT_WRITE)
            ready = [key.fileobj for key, _ in pipes.select(max(0.0, end - time.monotonic()))]
        if not ready:
            raise ExoPinError(f"Chromium did not answer within {self.timeout:g} s")
        if self._answers in ready:
            self._read()
        else:
            self._write()

    def _write(self) -> None:
        try:
            self._outgoing = self._outgoing[os.write(self._commands.fileno(), self._outgoing[:_MOST_BYTES]) :]
        except BrokenPipeError:
            raise BrowserEndedError("Chromium has ended") from None

    def _read(self) -> None:
        data = os.read(self._answers.fileno(), _MOST_BYTES)
        if not data:
            raise BrowserEndedError("Chromium has ended")
        self._incoming += data
        if _END in data:
            *messages, rest = self._incoming.split(_END)
            self._incoming = rest
            for message in messages:
                self._take(json.loads(message))

    def _take(self, message: _Params) -> None:
        if "id" in message:
            self._results[message["id"]] = message
        elif note := _NOTES.get(message["method"]):
            note(self, message["params"])


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
