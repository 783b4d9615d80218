"""Attacks on the live page, for real on loopback: other users, strangers without the token, floods."""

from __future__ import annotations

import asyncio
import gc
import http.client
import json
import os
import resource
import shutil
import signal
import socket
import subprocess
import sys
import time

import numpy as np
import pytest
from tornado.httpclient import HTTPClientError, HTTPRequest
from tornado.websocket import websocket_connect

from exo_pin import cache, viewer
from tests.other_user import NOBODY, reachable

PATIENCE = 30.0  # [s]: what a busy machine may take
AT_ONCE = 1.0  # [s]
SOCKETS, CLIENTS, WISHES = 1150, 200, 20
STRANGER = """
import os, socket, sys
port, top = int(sys.argv[1]), sys.argv[2]
print("user", os.geteuid())
for request in ("GET / HTTP/1.1", "GET /live HTTP/1.1", "GET /?token= HTTP/1.1", "POST / HTTP/1.1"):
    with socket.create_connection(("127.0.0.1", port), 10) as s:
        s.sendall((request + "\\r\\nHost: localhost\\r\\nContent-Length: 0\\r\\n\\r\\n").encode())
        print("answer", s.recv(100).split()[1].decode())
for process in filter(str.isdigit, os.listdir("/proc")):
    try:
        print("words", open(f"/proc/{process}/cmdline").read())
    except OSError:
        pass
for folder, _, files in os.walk(top):
    for name in files:
        try:
            print("read", name, open(os.path.join(folder, name), errors="replace").read())
        except OSError:
            pass
"""


FLOOD = """
import asyncio, sys
from tornado.websocket import websocket_connect
url, wish, clients, wishes = sys.argv[1], open(sys.argv[2]).read(), int(sys.argv[3]), int(sys.argv[4])
async def client():
    try:
        page = await websocket_connect(url)
        for _ in range(wishes):
            await page.write_message(wish)
        await asyncio.sleep(1)
        page.close()
    except Exception:
        pass  # it costs those clients
async def run():
    await asyncio.gather(*(client() for _ in range(clients)))
asyncio.run(run())
"""


def status(server, path="/", method="GET", **headers):
    connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=PATIENCE)
    try:
        connection.request(method, path, headers=headers)
        return connection.getresponse().status
    finally:
        connection.close()


def seconds_of_page(server):
    """How long the page takes for who has its address."""
    start = time.perf_counter()
    assert status(server, f"/?token={server.token}") == 200
    return time.perf_counter() - start


def live(server, token=None):
    return f"ws://127.0.0.1:{server.port}/live?token={server.token if token is None else token}"


@pytest.mark.parametrize(
    "path", ["/", "/live", "/nothing", "/?token=", "/?token=x", "/live?token=x", "/favicon.ico"]
)
@pytest.mark.parametrize("method", ["GET", "HEAD", "POST", "PUT", "DELETE", "OPTIONS"])
def test_without_the_token_every_path_is_refused(server, path, method):
    assert status(server, path, method) == 403


def test_a_part_of_the_token_or_another_server_s_is_none(server, scene):
    with viewer.serve(scene, port=0) as other:
        for wrong in (
            server.token[:-1],
            server.token + "x",
            server.token.swapcase(),
            other.token,
            "%ff",
            "%00",
        ):
            assert status(server, f"/?token={wrong}") == 403
            with pytest.raises(HTTPClientError, match="403"):
                asyncio.run(websocket(live(server, wrong)))
    assert status(server, f"/?token={server.token}") == 200
    assert status(server, f"/nothing?token={server.token}") == 404


async def websocket(url):
    (await websocket_connect(url)).close()


def test_a_server_without_a_token_is_one_that_was_wanted(scene):
    with viewer.serve(scene, port=0, token="") as server:
        assert server.url == f"http://127.0.0.1:{server.port}/"
        assert status(server) == 200


def test_no_state_is_taken_from_who_does_not_say_where_it_comes_from(server):
    state = json.dumps(
        {"type": "state", "time": 0.5, "playing": False, "speed": 0.5, "loop": True, "view": "left"}
    )

    async def tell(**headers):
        socket = await websocket_connect(HTTPRequest(live(server), headers=headers))
        await asyncio.wait_for(socket.read_message(), PATIENCE)
        await socket.write_message(state)
        await asyncio.sleep(0.2)
        socket.close()
        while await asyncio.wait_for(socket.read_message(), PATIENCE) is not None:
            pass

    asyncio.run(tell())
    assert server.state is None
    asyncio.run(tell(Origin=f"http://127.0.0.1:{server.port}"))
    assert server.state["view"] == "left"


@pytest.mark.skipif(
    not hasattr(os, "geteuid") or os.geteuid() != 0, reason="needs root, to become another user"
)
def test_another_user_reads_nothing(tmp_path):
    """The replay opens a browser, which is a program that stays; its arguments are there for all to read."""
    python = shutil.which("python3", path="/usr/bin")
    if python is None:
        pytest.skip("needs a Python that other users may run")
    for name in ("tmp", "cache"):
        (tmp_path / name).mkdir()
    browser = tmp_path / "browser"
    lines = (
        "#!/bin/sh",
        f"cd {tmp_path}",
        "echo $$ > pid",
        'echo "$1" > part',
        "mv part opened",
        "exec sleep 60",
    )
    browser.write_text("\n".join(lines))
    browser.chmod(0o755)
    changed = {"BROWSER": f"{browser} %s", "DISPLAY": ":9", "TMPDIR": str(tmp_path / "tmp")}
    environment = os.environ | changed | {cache.VARIABLE: str(tmp_path / "cache")}
    reachable(tmp_path)
    command = [sys.executable, "-m", "exo_pin", "replay", "--port", "0", "--no-wearer"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment) as process:
        try:
            url = process.stdout.readline().split()[0]
            token, port = url.partition("token=")[2], url.split(":")[2].split("/")[0]
            end = time.monotonic() + PATIENCE
            while not (tmp_path / "opened").exists():
                assert time.monotonic() < end
                time.sleep(0.02)
            opened = (tmp_path / "opened").read_text().strip()
            assert opened.startswith("file://")
            file = opened.removeprefix("file://")
            assert os.stat(file).st_mode & 0o777 == 0o600
            with open(file) as page:
                assert token in page.read()
            done = subprocess.run(
                [python, "-I", "-c", STRANGER, port, str(tmp_path)],
                user=NOBODY, group=NOBODY, extra_groups=[], capture_output=True, text=True, check=True,
            )  # fmt: skip
        finally:
            process.terminate()
            process.wait(PATIENCE)
            os.kill(int((tmp_path / "pid").read_text()), signal.SIGKILL)
    said = done.stdout
    assert f"user {NOBODY}" in said
    assert said.count("answer 403") == 4
    assert token not in said
    assert "words" in said
    assert list((tmp_path / "tmp").iterdir()) == []


def test_half_open_sockets_cost_the_page_nothing(server, capfd):
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (min(hard, 4 * SOCKETS), hard))
    held, slowest = [], 0.0
    try:
        for k in range(SOCKETS):
            held.append(socket.create_connection(("127.0.0.1", server.port), PATIENCE))
            held[-1].sendall((b"", b"GET / HT", b"\x16\x03\x01")[k % 3])
            if k % 230 == 0:
                slowest = max(slowest, seconds_of_page(server))
        slowest = max(slowest, seconds_of_page(server))
    finally:
        for each in held:
            each.close()
        resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))
    assert slowest < AT_ONCE
    assert len(capfd.readouterr().err.splitlines()) <= 10


def test_an_honest_page_is_served_amid_clients_with_wishes(server, scene, tmp_path, capfd):
    far = {"left_foot": [2.0, 0.1, -0.3, 0.0, 0.0, 0.0, 1.0]}  # out of reach: the dearest wish
    q = [float(value) for value in scene.arrays["q"][0]]
    wish = tmp_path / "wish.json"
    wish.write_text(json.dumps({"type": "reach", "id": 1, "feet": far, "q": q}))
    command = [sys.executable, "-c", FLOOD, live(server), str(wish), str(CLIENTS), str(WISHES)]
    times, most = [], 0
    with subprocess.Popen(command) as attack:
        while attack.poll() is None:
            times.append(seconds_of_page(server))
            most = max(most, server.clients)
            time.sleep(0.05)
    assert attack.returncode == 0
    assert 1 < most <= 32
    assert max(times) < AT_ONCE
    assert len(capfd.readouterr().err.splitlines()) <= 10


def test_pages_that_vanish_while_they_are_sent_to_make_no_noise(server, capfd):
    for _ in range(20):
        raw = socket.create_connection(("127.0.0.1", server.port), PATIENCE)
        raw.sendall(
            f"GET /live?token={server.token} HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\n"
            "Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
            "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n".encode()
        )
        raw.recv(100)
        server.pose(np.zeros(12), np.eye(4))
        raw.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, b"\1\0\0\0\0\0\0\0")  # close by reset
        raw.close()
        server.pose(np.zeros(12), np.eye(4))
    end = time.monotonic() + PATIENCE
    while server.clients and time.monotonic() < end:
        time.sleep(0.02)
    assert server.clients == 0
    gc.collect()
    assert capfd.readouterr().err == ""
