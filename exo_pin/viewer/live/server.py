"""The live viewer: a small web server in a thread of this process, for this machine only.

It serves its own page alone: other Host headers get 404 (DNS rebinding), other Origins no WebSocket, and
messages that are not understood are ignored. There is no ZMQ port as in meshcat's own server.
"""

from __future__ import annotations

import asyncio
import ipaddress
import json
import threading
import webbrowser
from collections.abc import Callable, Coroutine
from functools import cached_property
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

from exo_pin.viewer.live import messages
from exo_pin.viewer.live.address import is_allowed, listen, page_url

if TYPE_CHECKING:
    import numpy.typing as npt
    from tornado.httpserver import HTTPServer

    from exo_pin.viewer.live.handlers import Live
    from exo_pin.viewer.page.page import PageTemplate
    from exo_pin.viewer.scenes.scene import Scene

_BUNDLE, _POSE = b"\0", b"\1"
"""First byte of a binary message to the page: a packed scene, or one pose."""

_GATHERING = 0.004
"""A page's requests are gathered for so long [s] before the latest is answered: a flood costs no more."""


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
        wanted: Port that the caller wanted.
        url: Where to look.
    """

    def __init__(self, host: str = "127.0.0.1", port: int = 7000) -> None:
        self.host, self.wanted = host, port
        self._bundle = b""
        self._title = "exo_pin"
        self._state: messages.PlaybackState | None = None
        self._clients: set[Live] = set()
        self._requests: dict[Live, messages.ReachRequest] = {}
        self._scene: Scene | None = None
        self._reach: Callable[[messages.ReachRequest], messages.Reached] | None = None
        self._socket = listen(host, port)
        self._address, self.port = self._socket.getsockname()[:2]
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._work, name="exo_pin viewer", daemon=True)
        self._thread.start()
        self._http: HTTPServer = self._run(self._start())

    @property
    def url(self) -> str:
        """The page's address."""
        return page_url(self.host, self.port)

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
        return None if self._state is None else self._state.to_json()

    def show(self, scene: Scene) -> bytes:
        """Show another scene in all pages, now and later; returns it packed."""
        from exo_pin.viewer.page.export import bundle

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
        self._broadcast(_POSE + numbers.tobytes())

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
        """Whether a request with this Host header is answered."""
        return is_allowed(host, host=self.host, loopback=self.loopback)

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
        self._requests.clear()
        self._title = self._title if scene is None else scene.title
        if packed != self._bundle:
            self._bundle, self._state = packed, None
            self._send(_BUNDLE + packed)

    def _answer(self, client: Live) -> None:
        """Answer a page's latest request."""
        request, scene = self._requests.pop(client, None), self._scene
        if request is None or scene is None or scene.robot is None:
            return
        if self._reach is None:
            from exo_pin.viewer.live.foot_drag import reach_solver

            self._reach = reach_solver(scene.robot, [joint.name for joint in scene.facts.chains[0].joints])
        client.send(json.dumps(self._reach(request).to_json()))

    @cached_property
    def _template(self) -> PageTemplate:
        from exo_pin.viewer.page.page import PageTemplate

        return PageTemplate.load()

    # What the handlers call, in the server's own thread:

    def opened(self, client: Live) -> None:
        """A page opened its connection: it gets the scene, and the state where another page was."""
        self._clients.add(client)
        if self._bundle:
            client.send(_BUNDLE + self._bundle)
        if self._state is not None:
            client.send(json.dumps({"type": "state", **self._state.to_json()}))

    def closed(self, client: Live) -> None:
        """A page closed its connection."""
        self._clients.discard(client)
        self._requests.pop(client, None)

    def received(self, client: Live, message: str | bytes) -> None:
        """A page sent a message; only a well-formed state or request counts, and of requests the latest."""
        content = messages.read(message)
        if content is None:
            return
        self._state = messages.playback_state(content) or self._state
        request = None if self._scene is None else messages.reach_request(content, self._scene.facts)
        if request is not None:
            if client not in self._requests:
                self._loop.call_later(_GATHERING, self._answer, client)
            self._requests[client] = request

    def page(self, host: str) -> str:
        """The page, which may connect back to where it came from and nowhere else."""
        return self._template.page(self._title, connect=f"ws://{host}")
