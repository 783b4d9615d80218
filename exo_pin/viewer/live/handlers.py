"""The live viewer's routes: one page, one WebSocket; 403 without the token, 404 for all else."""

from __future__ import annotations

import asyncio
import time
from typing import Any, Protocol

from tornado.iostream import IOStream
from tornado.web import Application, HTTPError, RequestHandler
from tornado.websocket import WebSocketClosedError, WebSocketHandler

_MOST_MESSAGES = 1000
"""A client that sends more messages in a second is closed; the page sends some 70."""

_MOST_UNSENT = 64 * 2**20
"""A client that leaves more than this unread is closed [bytes]."""

_PING_EVERY = 30.0
"""A client that does not answer a ping is closed [s]."""

_POLICY_VIOLATION = 1008  # RFC 6455, 7.4.1

_REFUSED = "Refused: open the whole address that the program has printed, with its token.\n"


class PageServer(Protocol):
    """What the handlers need of the server."""

    def knows(self, token: bytes) -> bool:
        """Whether a request with this token is answered."""

    def allows(self, host: str) -> bool:
        """Whether a request with this Host header is answered."""

    def page(self, host: str) -> bytes:
        """The page for a browser that requested it from this host."""

    def policy(self, host: str) -> str:
        """The Content-Security-Policy of that page."""

    def opened(self, client: Live) -> None:
        """A page opened its connection."""

    def received(self, client: Live, message: str | bytes) -> None:
        """A page sent a message."""

    def closed(self, client: Live) -> None:
        """A page closed its connection."""


def application(server: PageServer) -> Application:
    """The routes of the server."""
    arguments = {"server": server}
    return Application(
        [("/", Page, arguments), ("/live", Live, arguments)],
        default_handler_class=NotFound,
        default_handler_args=arguments,
        log_function=lambda _: None,  # requests are not logged: their addresses hold the token
        websocket_max_message_size=65_536,
        websocket_ping_interval=_PING_EVERY,
    )


class _Guarded(RequestHandler):
    """A handler that refuses, with 403, requests without the token, from other pages and for other hosts."""

    def initialize(self, server: PageServer) -> None:
        """Remember the server."""
        self.viewer = server

    def set_default_headers(self) -> None:
        """Nothing is stored, and no address is passed on."""
        self.set_header("Cache-Control", "no-store")
        self.set_header("X-Content-Type-Options", "nosniff")
        self.set_header("Referrer-Policy", "no-referrer")

    def prepare(self) -> None:
        """Refuse strangers; a foreign host is a foreign site that has taken our address (DNS rebinding)."""
        given = self.request.query_arguments.get("token", [b""])[-1]
        if not self.viewer.knows(given) or not self.viewer.allows(self.request.host):
            raise HTTPError(403)
        if self.origin not in (None, f"http://{self.request.host.lower()}"):
            raise HTTPError(403)

    @property
    def origin(self) -> str | None:
        """Where the page came from that makes this request, if it says so."""
        found: str | None = self.request.headers.get("Origin")
        return None if found is None else found.lower()

    def write_error(self, status_code: int, **_: Any) -> None:
        """One line of text."""
        self.set_header("Content-Type", "text/plain; charset=utf-8")
        self.finish(_REFUSED if status_code == 403 else f"{status_code}\n")


class NotFound(_Guarded):
    """Every other address."""

    def prepare(self) -> None:
        """Answer 404, or 403 to strangers."""
        super().prepare()
        raise HTTPError(404)


class Page(_Guarded):
    """The viewer's page."""

    def get(self) -> None:
        """Send the page."""
        host = self.request.host
        self.set_header("Content-Type", "text/html; charset=utf-8")
        self.set_header("Content-Security-Policy", f"{self.viewer.policy(host)}; frame-ancestors 'none'")
        self.finish(self.viewer.page(host))


class Live(_Guarded, WebSocketHandler):
    """The page's connection."""

    def check_origin(self, origin: str) -> bool:
        """Whether the origin is our own; `prepare` has refused others already, by a stricter rule."""
        return origin.lower() == self.origin

    @property
    def stream(self) -> IOStream:
        """The connection's socket."""
        return self._stream

    def prepare(self) -> None:
        """Refuse strangers, and remember the socket, which the WebSocket takes over."""
        super().prepare()
        self._stream: IOStream = self.request.connection.stream  # type: ignore[union-attr]

    def open(self, *_: Any, **__: Any) -> None:
        """A page is connected."""
        self._since, self._messages, self._unsent = time.monotonic(), 0, 0
        self.viewer.opened(self)

    def on_message(self, message: str | bytes) -> None:
        """Pass a message on, or close the connection where there are too many."""
        now = time.monotonic()
        if now - self._since > 1:
            self._since, self._messages = now, 0
        self._messages += 1
        if self._messages > _MOST_MESSAGES:
            self.close(_POLICY_VIOLATION, "too many messages")
        else:
            self.viewer.received(self, message)

    def on_close(self) -> None:
        """The page is gone."""
        self.viewer.closed(self)

    def send(self, message: str | bytes) -> None:
        """Send, unless the page has just gone or reads nothing."""
        if self._unsent > _MOST_UNSENT:
            self.close(_POLICY_VIOLATION, "too much unread")
            return
        try:
            sent = self.write_message(message, binary=isinstance(message, bytes))
        except WebSocketClosedError:
            self.viewer.closed(self)
            return
        self._unsent += len(message)

        def done(written: asyncio.Future[None]) -> None:
            self._unsent -= len(message)
            written.cancelled() or written.exception()  # retrieved: a page may go before it has read all

        sent.add_done_callback(done)
