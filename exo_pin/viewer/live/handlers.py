"""What the live viewer's server answers: one page, one WebSocket, and 404 to all else."""

from __future__ import annotations

from typing import Any, Protocol

from tornado.httputil import HTTPServerRequest
from tornado.web import Application, HTTPError, RequestHandler
from tornado.websocket import WebSocketClosedError, WebSocketHandler

from exo_pin.viewer.page.page import policy


class Desk(Protocol):
    """What the handlers ask of the server that they answer for."""

    def allows(self, host: str) -> bool:
        """Whether a request with this Host header is answered."""

    def page(self, host: str) -> str:
        """The page for a browser that asked this host."""

    def joined(self, client: Live) -> None:
        """A page opened its connection."""

    def heard(self, client: Live, message: str | bytes) -> None:
        """A page said something."""

    def left(self, client: Live) -> None:
        """A page closed its connection."""


def application(server: Desk) -> Application:
    """The routes of the server."""
    known = {"server": server}
    return Application(
        [("/", Page, known), ("/live", Live, known)],
        default_handler_class=Nothing,
        log_function=lambda _: None,  # requests are nobody's news
        websocket_max_message_size=65_536,
    )


def check_host(server: Desk, request: HTTPServerRequest) -> None:
    """Refuse requests that were addressed to another name (DNS rebinding) with 404."""
    if not server.allows(request.host):
        raise HTTPError(404)


class Nothing(RequestHandler):
    """Every other address."""

    def prepare(self) -> None:
        """Answer 404."""
        raise HTTPError(404)


class Page(RequestHandler):
    """The viewer's page."""

    def initialize(self, server: Desk) -> None:
        """Remember the server."""
        self.viewer = server

    def prepare(self) -> None:
        """Refuse foreign hosts."""
        check_host(self.viewer, self.request)

    def get(self) -> None:
        """Send the page."""
        host = self.request.host
        self.set_header("Content-Type", "text/html; charset=utf-8")
        self.set_header("Cache-Control", "no-store")
        self.set_header("X-Content-Type-Options", "nosniff")
        self.set_header("Referrer-Policy", "no-referrer")
        self.set_header("Content-Security-Policy", f"{policy(f'ws://{host}')}; frame-ancestors 'none'")
        self.finish(self.viewer.page(host))


class Live(WebSocketHandler):
    """The page's connection; tornado itself refuses an Origin that is not the Host."""

    def initialize(self, server: Desk) -> None:
        """Remember the server."""
        self.viewer = server

    def prepare(self) -> None:
        """Refuse foreign hosts."""
        check_host(self.viewer, self.request)

    def open(self, *_: Any, **__: Any) -> None:
        """A page is there."""
        self.viewer.joined(self)

    def on_message(self, message: str | bytes) -> None:
        """A page said something."""
        self.viewer.heard(self, message)

    def on_close(self) -> None:
        """The page is gone."""
        self.viewer.left(self)

    def send(self, message: str | bytes) -> None:
        """Send, unless the page has just gone."""
        try:
            self.write_message(message, binary=isinstance(message, bytes))
        except WebSocketClosedError:
            self.viewer.left(self)
