"""The live viewer's routes: one page, one WebSocket, and 404 for all else."""

from __future__ import annotations

from typing import Any, Protocol

from tornado.httputil import HTTPServerRequest
from tornado.web import Application, HTTPError, RequestHandler
from tornado.websocket import WebSocketClosedError, WebSocketHandler

from exo_pin.viewer.page.page import policy


class PageServer(Protocol):
    """What the handlers need of the server."""

    def allows(self, host: str) -> bool:
        """Whether a request with this Host header is answered."""

    def page(self, host: str) -> str:
        """The page for a browser that requested it from this host."""

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
        log_function=lambda _: None,  # requests are not logged
        websocket_max_message_size=65_536,
    )


def _check_host(server: PageServer, request: HTTPServerRequest) -> None:
    """Refuse requests that were addressed to another name (DNS rebinding) with 404."""
    if not server.allows(request.host):
        raise HTTPError(404)


class NotFound(RequestHandler):
    """Every other address."""

    def prepare(self) -> None:
        """Answer 404."""
        raise HTTPError(404)


class Page(RequestHandler):
    """The viewer's page."""

    def initialize(self, server: PageServer) -> None:
        """Remember the server."""
        self.viewer = server

    def prepare(self) -> None:
        """Refuse foreign hosts."""
        _check_host(self.viewer, self.request)

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

    def initialize(self, server: PageServer) -> None:
        """Remember the server."""
        self.viewer = server

    def prepare(self) -> None:
        """Refuse foreign hosts."""
        _check_host(self.viewer, self.request)

    def open(self, *_: Any, **__: Any) -> None:
        """A page is connected."""
        self.viewer.opened(self)

    def on_message(self, message: str | bytes) -> None:
        """Pass a message on."""
        self.viewer.received(self, message)

    def on_close(self) -> None:
        """The page is gone."""
        self.viewer.closed(self)

    def send(self, message: str | bytes) -> None:
        """Send, unless the page has just gone."""
        try:
            self.write_message(message, binary=isinstance(message, bytes))
        except WebSocketClosedError:
            self.viewer.closed(self)
