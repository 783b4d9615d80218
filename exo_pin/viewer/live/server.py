"""The live viewer: a small web server in a thread of this process, for this machine only.

It speaks to its own page alone: other Host headers get 404 (DNS rebinding), other Origins no WebSocket, and
messages that are not understood are ignored. There is no ZMQ port as in meshcat's own server.
"""

from __future__ import annotations

import asyncio
import contextlib
import ipaddress
import json
import re
import socket
import threading
import webbrowser
from collections.abc import Callable, Coroutine
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

from exo_pin.viewer.live import messages
from exo_pin.viewer.live.port import listen

if TYPE_CHECKING:
    import numpy.typing as npt
    from tornado.httpserver import HTTPServer

    from exo_pin.viewer.live.handlers import Live
    from exo_pin.viewer.scenes.scene import Scene

BUNDLE, POSE = b"\0", b"\1"
"""First byte of a binary message to the page: a packed scene, or one pose."""

PACE = 0.004
"""A page's wishes are gathered for so long [s] before the latest is answered: a flood costs no more."""


def serve(
    scene: Scene | None = None, *, host: str = "127.0.0.1", port: int = 7000, open_browser: bool = False
) -> Server:
    """Show a scene at an address of this machine until `close()`.

    Args:
        scene: What to show; it can follow later with `Server.show`, so that the server starts at once.
        host: Address to listen on. Anything but a loopback address lets others in: there is no password.
        port: Wanted port; if it is taken, the next free one is used (see `Server.port`). 0: any free port.
        open_browser: Whether to open the system's browser there.

    Returns:
        The running server, which is also a context manager.

    Raises:
        ExoPinError: The host is not an address of this machine, or no port is free.
    """
    server = Server(host, port)
    if scene is not None:
        server.show(scene)
    if open_browser:
        threading.Thread(target=webbrowser.open, args=(server.url,), daemon=True).start()  # may block
    return server


class Server:
    """A running viewer.

    Attributes:
        host: Address that it listens on.
        port: Port that it listens on.
        wanted: Port that was asked for.
        url: Where to look.
    """

    def __init__(self, host: str = "127.0.0.1", port: int = 7000) -> None:
        self.host, self.wanted = host, port
        self._bundle = b""
        self._title = "exo_pin"
        self._state: dict[str, Any] | None = None
        self._clients: set[Live] = set()
        self._wishes: dict[Live, messages.Wish] = {}
        self._scene: Scene | None = None
        self._reach: Callable[[messages.Wish], dict[str, Any]] | None = None
        self._socket = listen(host, port)
        self._address, self.port = self._socket.getsockname()[:2]
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._work, name="exo_pin viewer", daemon=True)
        self._thread.start()
        self._http: HTTPServer = self._run(self._start())

    @property
    def url(self) -> str:
        """The page's address."""
        host = "127.0.0.1" if self.host in ("0.0.0.0", "::", "") else self.host
        return f"http://{f'[{host}]' if ':' in host else host}:{self.port}/"

    @property
    def loopback(self) -> bool:
        """Whether only this machine can reach it."""
        return ipaddress.ip_address(self._address).is_loopback

    @property
    def clients(self) -> int:
        """Number of pages that are looking."""
        return len(self._clients)

    @property
    def state(self) -> dict[str, Any] | None:
        """Where a page last was: `time` [s], `playing`, `speed`, `loop`, `view`. A new page resumes there."""
        return None if self._state is None else dict(self._state)

    def show(self, scene: Scene) -> bytes:
        """Show another scene in all pages, now and later; returns it packed."""
        from exo_pin.viewer.page.bundle import bundle

        packed = bundle(scene)
        self._loop.call_soon_threadsafe(self._install, packed, scene)
        return packed

    def preview(self, packed: bytes) -> None:
        """Show a scene that was packed in an earlier run, until `show` brings this run's."""
        self._loop.call_soon_threadsafe(self._install, packed, None)

    def pose(self, q: npt.ArrayLike, base: npt.ArrayLike) -> None:
        """Show one pose in all pages that are open, and halt their playback.

        Args:
            q: Joint values in the order of the scene's first chain [rad].
            base: `(7,)` pose of the pelvis: x y z [m], quaternion x y z w.
        """
        import numpy as np

        numbers = np.concatenate([np.asarray(base, "<f4"), np.asarray(q, "<f4")])
        self._broadcast(POSE + numbers.tobytes())

    def close(self) -> None:
        """Stop listening, close all pages' connections and end the thread; may be called twice."""
        if self._loop.is_closed():
            return
        self._run(self._stop())
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()
        self._loop.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def allows(self, host: str) -> bool:
        """Whether a request with this Host header is answered.

        On loopback only loopback names are; else also literal addresses and this machine's own name, which a
        foreign web site cannot make its own.
        """
        name = re.sub(r":\d+$", "", host).strip("[]").lower()
        if name in ("localhost", "127.0.0.1", "::1", self.host.lower()):
            return True
        if self.loopback:
            return False
        with contextlib.suppress(ValueError):
            return bool(ipaddress.ip_address(name))
        return name == socket.gethostname().lower()

    def _work(self) -> None:
        asyncio.set_event_loop(self._loop)
        self._loop.run_forever()

    def _run(self, work: Coroutine[Any, Any, Any]) -> Any:
        return asyncio.run_coroutine_threadsafe(work, self._loop).result(10)

    async def _start(self) -> HTTPServer:
        from tornado.httpserver import HTTPServer

        from exo_pin.viewer.live.handlers import application

        http = HTTPServer(application(self), max_header_size=16_384, max_body_size=65_536)
        self._socket.setblocking(False)
        http.add_socket(self._socket)
        return http

    async def _stop(self) -> None:
        self._http.stop()
        for client in list(self._clients):
            client.close(1001, "the program has stopped")
        await self._http.close_all_connections()
        await asyncio.sleep(0)
        for task in asyncio.all_tasks() - {asyncio.current_task()}:
            task.cancel()
        await asyncio.sleep(0)

    def _broadcast(self, message: bytes) -> None:
        self._loop.call_soon_threadsafe(self._send, message)

    def _send(self, message: bytes) -> None:
        for client in list(self._clients):
            client.send(message)

    def _install(self, packed: bytes, scene: Scene | None) -> None:
        self._scene, self._reach = scene, None
        self._wishes.clear()
        self._title = self._title if scene is None else scene.title
        if packed != self._bundle:
            self._bundle, self._state = packed, None
            self._send(BUNDLE + packed)

    def _fulfil(self, client: Live) -> None:
        """Answer a page's latest wish."""
        wish, scene = self._wishes.pop(client, None), self._scene
        if wish is None or scene is None or scene.robot is None:
            return
        if self._reach is None:
            from exo_pin.viewer.live.foot_drag import reacher

            self._reach = reacher(scene.robot, [joint.name for joint in scene.facts.chains[0].joints])
        client.send(json.dumps(self._reach(wish)))

    # What the handlers call, in the server's own thread:

    def joined(self, client: Live) -> None:
        """A page opened its connection: it gets the scene, and the state where another page was."""
        self._clients.add(client)
        if self._bundle:
            client.send(BUNDLE + self._bundle)
        if self._state is not None:
            client.send(json.dumps({"type": "state", **self._state}))

    def left(self, client: Live) -> None:
        """A page closed its connection."""
        self._clients.discard(client)
        self._wishes.pop(client, None)

    def heard(self, client: Live, message: str | bytes) -> None:
        """A page said something; only a well-formed state or wish counts, and of wishes the latest."""
        said = messages.read(message)
        if said is None:
            return
        self._state = messages.state(said) or self._state
        wish = None if self._scene is None else messages.wish(said, self._scene.facts)
        if wish is not None:
            if client not in self._wishes:
                self._loop.call_later(PACE, self._fulfil, client)
            self._wishes[client] = wish

    def page(self, host: str) -> str:
        """The page, which may connect back to where it came from and nowhere else."""
        from exo_pin.viewer.page.page import page

        return page(self._title, connect=f"ws://{host}")
