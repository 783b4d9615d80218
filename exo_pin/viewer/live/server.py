"""The live viewer: a small web server in a thread of this process, for this machine only.

It serves its own page alone, to those who have the token of its address. Requests without it, for other hosts
(DNS rebinding) and from other origins get 403; messages that are not understood are ignored. There is no
ZMQ port as in meshcat's own server.
"""

from __future__ import annotations

import asyncio
import atexit
import hmac
import ipaddress
import json
import secrets
import threading
from collections.abc import Callable, Coroutine
from contextlib import ExitStack
from functools import cached_property
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

from exo_pin.viewer.live import messages
from exo_pin.viewer.live.address import is_allowed, listen, page_url
from exo_pin.viewer.live.watchers import Watchers

if TYPE_CHECKING:
    import numpy.typing as npt

    from exo_pin.viewer.live.connections import CappedServer
    from exo_pin.viewer.live.handlers import Live
    from exo_pin.viewer.page.page import PageTemplate
    from exo_pin.viewer.scenes.scene import Scene

_BUNDLE, _POSE = b"\0", b"\1"
"""First byte of a binary message to the page: a packed scene, or one pose."""

_TOKEN_BYTES = 24
"""Random bytes of a token: far more than can be tried."""


def serve(
    scene: Scene | None = None,
    *,
    host: str = "127.0.0.1",
    port: int = 7000,
    token: str | None = None,
    open_browser: bool = False,
) -> Server:
    """Show a scene at an address of this machine until `close()`.

    Args:
        scene: What to show; it can follow later with `Server.show`, so that the server starts at once.
        host: Address to listen on. At anything but a loopback address other machines can connect,
            unencrypted: the token alone keeps them out.
        port: Wanted port; if it is taken, the next free one is used (see `Server.port`). 0: any free port.
        token: What the page's address must hold; a new random one if left out. Empty: none is needed, and
            every user of this machine can watch.
        open_browser: Whether to open the system's browser there.

    Returns:
        The running server, which is also a context manager.

    Raises:
        ExoPinError: The host is not an address of this machine, or no port is free.
    """
    server = Server(host, port, token=token)
    if scene is not None:
        server.show(scene)
    if open_browser:
        server.open_browser()
    return server


class Server:
    """A running viewer.

    Attributes:
        host: Address that it listens on.
        port: Port that it listens on.
        wanted: Port that the caller wanted.
        token: What requests must hold; empty: nothing.
        url: Where to look; it holds the token.
    """

    def __init__(self, host: str = "127.0.0.1", port: int = 7000, *, token: str | None = None) -> None:
        self.host, self.wanted = host, port
        self.token = secrets.token_urlsafe(_TOKEN_BYTES) if token is None else token
        self._bundle = b""
        self._title = "exo_pin"
        self._state: messages.PlaybackState | None = None
        self._scene: Scene | None = None
        self._rendered: tuple[str, str, bytes] | None = None
        self._ends = ExitStack()
        self._socket = listen(host, port)
        self._address, self.port = self._socket.getsockname()[:2]
        begun = threading.Event()
        self._thread = threading.Thread(target=self._work, args=(begun,), name="exo_pin viewer", daemon=True)
        self._thread.start()
        begun.wait()
        self._http: CappedServer = self._run(self._start())

    @property
    def url(self) -> str:
        """The page's address."""
        return page_url(self.host, self.port, self.token)

    @property
    def loopback(self) -> bool:
        """Whether only this machine can reach it."""
        return ipaddress.ip_address(self._address).is_loopback

    @property
    def clients(self) -> int:
        """Number of pages that are looking."""
        return len(self._watchers)

    @property
    def state(self) -> dict[str, Any] | None:
        """Where a page last was: `time` [s], `playing`, `speed`, `loop`, `view`. A new page resumes there."""
        return None if self._state is None else self._state.to_json()

    def show(self, scene: Scene) -> bytes:
        """Show another scene in all pages, now and later; returns it packed."""
        from exo_pin.viewer.page.packing import bundle

        packed = bundle(scene)
        self._loop.call_soon_threadsafe(self._install, packed, scene)
        if scene.robot is not None:
            from exo_pin.viewer.live.foot_drag import reach_solver

            joints = [joint.name for joint in scene.facts.chains[0].joints]
            solver = reach_solver(scene.robot, joints)  # here, where it delays no page
            self._loop.call_soon_threadsafe(self._install_solver, scene, solver)
        return packed

    def preview(self, packed: bytes) -> None:
        """Show a scene that was packed in an earlier run, until `show` brings this run's."""
        self._loop.call_soon_threadsafe(self._install, packed, None)

    def pose(self, q: npt.ArrayLike, base: npt.ArrayLike) -> None:
        """Show one pose in all pages that are open, and halt their playback.

        Args:
            q: Joint values in the order of the scene's first chain [rad].
            base: T_world_pelvis (4, 4) [m].

        Raises:
            DescriptionError: A number is not finite, or `base` is no (4, 4).
        """
        import numpy as np

        from exo_pin.arguments import real
        from exo_pin.robot.floating_base import base_coordinates

        pelvis = base_coordinates(real("base", base, (4, 4)))
        numbers = np.concatenate([pelvis, real("q", q, ("J",))]).astype("<f4")
        self._loop.call_soon_threadsafe(self._watchers.send, _POSE + numbers.tobytes())

    def open_browser(self) -> None:
        """Open the system's browser at the page."""
        from exo_pin.viewer.live.redirect import opened

        atexit.register(self._ends.close)
        self._ends.enter_context(opened(self.url))

    def close(self) -> None:
        """Stop listening, close all pages' connections and end the thread; may be called twice."""
        if self._loop.is_closed():
            return
        self._ends.close()
        atexit.unregister(self._ends.close)
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

    def knows(self, token: bytes) -> bool:
        """Whether a request with this token is answered; takes the same time however much of it is right."""
        return not self.token or hmac.compare_digest(token, self.token.encode())

    def allows(self, host: str) -> bool:
        """Whether a request with this Host header is answered."""
        return is_allowed(host, host=self.host, loopback=self.loopback)

    def _work(self, begun: threading.Event) -> None:
        """Make the loop and run it; a signal, which the main thread gets, finds it whole or not at all."""
        self._loop = asyncio.new_event_loop()
        self._watchers = Watchers(self._loop, self._greet)
        asyncio.set_event_loop(self._loop)
        begun.set()
        self._loop.run_forever()

    def _run(self, work: Coroutine[Any, Any, Any]) -> Any:
        return asyncio.run_coroutine_threadsafe(work, self._loop).result(10)

    async def _start(self) -> CappedServer:
        from exo_pin.viewer.live.connections import CappedServer, FewRecords
        from exo_pin.viewer.live.handlers import application

        records = FewRecords(self._thread.ident)
        records.install()
        self._ends.callback(records.remove)
        http = CappedServer(application(self))
        self._socket.setblocking(False)
        http.add_socket(self._socket)
        return http

    async def _stop(self) -> None:
        self._http.stop()
        self._watchers.close(1001, "the program has stopped")
        await self._http.close_all_connections()
        await asyncio.sleep(0)
        for task in asyncio.all_tasks() - {asyncio.current_task()}:
            task.cancel()
        await asyncio.sleep(0)

    def _install(self, packed: bytes, scene: Scene | None) -> None:
        self._scene = scene
        self._watchers.forget_requests()
        self._watchers.answer = None
        self._title = self._title if scene is None else scene.title
        if packed != self._bundle:
            self._bundle, self._state = packed, None
            self._watchers.send(_BUNDLE + packed)

    def _install_solver(
        self, scene: Scene, solver: Callable[[messages.ReachRequest], messages.Reached]
    ) -> None:
        if self._scene is scene:
            self._watchers.answer = solver

    @cached_property
    def _template(self) -> PageTemplate:
        from exo_pin.viewer.page.page import PageTemplate

        return PageTemplate.load()

    # What the handlers call, in the server's own thread:

    def opened(self, client: Live) -> None:
        """A page opened its connection: it gets the scene, and the state where another page was."""
        if self._watchers.add(client):
            self._http.keep(client.stream)

    def _greet(self, client: Live) -> None:
        if self._bundle:
            client.send(_BUNDLE + self._bundle)
        if self._state is not None:
            client.send(json.dumps({"type": "state", **self._state.to_json()}))

    def closed(self, client: Live) -> None:
        """A page closed its connection."""
        self._watchers.remove(client)

    def received(self, client: Live, message: str | bytes) -> None:
        """A page sent a message; only a well-formed state or request counts, and of requests the latest.

        A state counts from our own page alone: others do not say where they come from.
        """
        content = messages.read(message)
        if content is None:
            return
        state = messages.playback_state(content)
        if state is not None and client.origin is not None:
            self._state = state
            self._watchers.reported(client)
        request = None if self._scene is None else messages.reach_request(content, self._scene.facts)
        if request is not None:
            self._watchers.request(client, request)

    def page(self, host: str) -> bytes:
        """The page, which may connect back to where it came from and nowhere else."""
        if self._rendered is None or self._rendered[:2] != (self._title, host):
            text = self._template.page(self._title, connect=_back(host))
            self._rendered = (self._title, host, text.encode())
        return self._rendered[2]

    def policy(self, host: str) -> str:
        """The Content-Security-Policy of the page."""
        return self._template.policy(_back(host))


def _back(host: str) -> str:
    """Where the page may connect to: the host that it came from."""
    return f"ws://{host}"
