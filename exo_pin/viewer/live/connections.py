"""Connections of the live server: capped, with time-outs; those that never finish a request leave first."""

from __future__ import annotations

import logging
from typing import Any
from weakref import WeakSet

from tornado.httpserver import HTTPServer
from tornado.iostream import IOStream

_MOST = 128
"""So many connections are open at once; fewer where the system allows few files."""

_SHARE = 4
"""At most one in so many of the files that this process may open is a connection."""

_SECONDS = 10.0
"""So long a client may take for its request, and for its body [s]."""

_MOST_RECORDS = 3
"""So many errors of a server are logged."""

_LOGGERS = ("tornado.general", "tornado.application", "tornado.access", "asyncio")


class CappedServer(HTTPServer):
    """An HTTP server for a few clients, which a flood of connections does not stop.

    Where all places are taken, a new connection takes that of the oldest one that was not kept.
    """

    def initialize(self, *application: Any, **options: Any) -> None:  # tornado's constructor
        """Set the caps and time-outs."""
        limits: dict[str, Any] = {"max_header_size": 16_384, "max_body_size": 65_536}
        limits |= {"idle_connection_timeout": _SECONDS, "body_timeout": _SECONDS}
        super().initialize(*application, **(options | limits))
        self._most = most_connections()
        self._open: list[IOStream] = []
        self._kept: WeakSet[IOStream] = WeakSet()

    def keep(self, stream: IOStream) -> None:
        """Leave a connection its place until it is closed."""
        self._kept.add(stream)

    def handle_stream(self, stream: IOStream, address: Any) -> None:
        """Serve a new connection, if there is a place for it."""
        self._open = [other for other in self._open if not other.closed()]
        if len(self._open) >= self._most:
            next((other for other in self._open if other not in self._kept), stream).close()
        if not stream.closed():
            self._open.append(stream)
            super().handle_stream(stream, address)


def most_connections() -> int:
    """How many connections are open at once, by the number of files that this process may open."""
    try:
        import resource
    except ImportError:  # Windows
        return _MOST
    files, _ = resource.getrlimit(resource.RLIMIT_NOFILE)
    return _MOST if files == resource.RLIM_INFINITY else max(8, min(_MOST, files // _SHARE))


class FewRecords(logging.Filter):
    """What a server's thread logs: nothing about its clients' mistakes, and the first errors of its own.

    Args:
        thread: Identifier of the thread.
    """

    def __init__(self, thread: int | None) -> None:
        super().__init__()
        self._thread, self._left = thread, _MOST_RECORDS

    def filter(self, record: logging.LogRecord) -> bool:
        """Whether a record is logged."""
        if record.thread != self._thread:
            return True
        if record.levelno < logging.ERROR or not self._left:
            return False
        self._left -= 1
        return True

    def install(self) -> None:
        """Begin to filter."""
        for name in _LOGGERS:
            logging.getLogger(name).addFilter(self)

    def remove(self) -> None:
        """Filter no more."""
        for name in _LOGGERS:
            logging.getLogger(name).removeFilter(self)
