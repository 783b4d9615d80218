"""The pages that watch: a capped number, served alike, their requests answered in turn."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Callable
from typing import TYPE_CHECKING

from exo_pin.viewer.live.messages import Reached, ReachRequest

if TYPE_CHECKING:
    from exo_pin.viewer.live.handlers import Live

_MOST = 32
"""So many pages watch at once."""

_TRY_AGAIN = 1013  # registered with IANA: the server is overloaded

_GATHERING = 0.004
"""Requests are gathered for so long [s] before the latest of each page is answered: a flood costs no more."""


class Watchers:
    """The connections of open pages, in the order in which they came; used in the server's thread alone.

    Args:
        loop: The server's event loop.
        greet: Sends a new page what is shown; many that come at once are greeted one after the other.

    Attributes:
        answer: Answers a request, or None while there is nothing to answer it.
    """

    def __init__(self, loop: asyncio.AbstractEventLoop, greet: Callable[[Live], None]) -> None:
        self.answer: Callable[[ReachRequest], Reached] | None = None
        self._loop, self._greet = loop, greet
        self._new: dict[Live, None] = {}
        self._reported: dict[Live, bool] = {}
        self._requests: dict[Live, ReachRequest] = {}
        self._busy = False

    def __len__(self) -> int:
        return len(self._reported)

    def add(self, client: Live) -> bool:
        """Let a page watch; whether it may.

        Where all places are taken, it takes that of the oldest connection that never reported its playback,
        as pages do when they play.
        """
        if len(self) >= _MOST:
            silent = next((other for other, reported in self._reported.items() if not reported), None)
            (silent or client).close(_TRY_AGAIN, "too many pages")
            if silent is None:
                return False
            self.remove(silent)
        self._reported[client] = False
        self._new[client] = None
        self._begin(0.0)
        return True

    def remove(self, client: Live) -> None:
        """A page is gone."""
        self._reported.pop(client, None)
        self._requests.pop(client, None)
        self._new.pop(client, None)

    def reported(self, client: Live) -> None:
        """A page reported its playback."""
        if client in self._reported:
            self._reported[client] = True

    def send(self, message: bytes) -> None:
        """Send a message to all pages."""
        for client in list(self._reported):
            if client not in self._new:
                client.send(message)

    def close(self, code: int, reason: str) -> None:
        """Close all connections."""
        for client in list(self._reported):
            client.close(code, reason)

    def forget_requests(self) -> None:
        """Answer nothing that is still waiting."""
        self._requests.clear()

    def request(self, client: Live, request: ReachRequest) -> None:
        """Answer a page's request soon, unless a later one of that page comes first."""
        if client not in self._reported:
            return
        self._requests[client] = request
        self._begin(_GATHERING)

    def _begin(self, delay: float) -> None:
        if not self._busy:
            self._busy = True
            self._loop.call_later(delay, self._serve_next)

    def _serve_next(self) -> None:
        """Greet or answer one page; the loop serves connections before it comes to the next one."""
        self._busy = bool(self._new or self._requests)
        if not self._busy:
            return
        self._loop.call_soon(self._serve_next)
        if self._new:
            client = next(iter(self._new))
            del self._new[client]
            self._greet(client)
            return
        client = next(iter(self._requests))
        request = self._requests.pop(client)
        if self.answer is not None:
            client.send(json.dumps(self.answer(request).to_json()))
