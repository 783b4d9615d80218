from __future__ import annotations

import asyncio
import gc
import http.client
import json
import socket
import threading
import time
import tracemalloc
from contextlib import asynccontextmanager

import numpy as np
import pytest
from tornado.httpclient import HTTPClientError, HTTPRequest
from tornado.websocket import websocket_connect

from exo_pin import viewer
from exo_pin.errors import ExoPinError

PATIENCE = 10.0  # [s]: far beyond what a message on loopback needs
FLOOD = 400  # requests at once
WARM_UP, MINUTE, BATCH = 600, 3600, 60  # poses; a minute at 60 a second
GROWTH = 20_000  # [bytes]: a pose is 76 bytes long; keeping one byte in ten of each would show
UPRIGHT = np.eye(4)
"""A pelvis in the origin."""

POSE_COST = 0.15e-3  # [s] of Python per live pose
STATE = {"type": "state", "time": 0.5, "playing": False, "speed": 0.5, "loop": True, "view": "left"}


def query(server):
    return f"?token={server.token}" if server.token else ""


def get(server, path="/", **headers):
    """Status, headers and text of a path, requested with the token."""
    return request_bare(server, path + query(server), **headers)


def request_bare(server, path="/", method="GET", **headers):
    connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=PATIENCE)
    try:
        connection.request(method, path, headers=headers)
        answer = connection.getresponse()
        return answer.status, dict(answer.getheaders()), answer.read().decode()
    finally:
        connection.close()


def live(server):
    return f"ws://127.0.0.1:{server.port}/live{query(server)}"


def talk(server, *messages, wait_for=1, **headers):
    """Open the page's connection, send messages, return what came first."""

    headers = {"Origin": f"http://127.0.0.1:{server.port}"} | headers

    async def run():
        request = HTTPRequest(live(server), headers=headers)
        socket = await websocket_connect(request)
        received = [await asyncio.wait_for(socket.read_message(), PATIENCE) for _ in range(wait_for)]
        for message in messages:
            await socket.write_message(message, binary=isinstance(message, bytes))
        await socket.write_message(json.dumps(STATE))  # received after all others: order is kept
        end = time.monotonic() + PATIENCE
        while server.state is None and time.monotonic() < end:
            await asyncio.sleep(0.005)
        socket.close()
        await socket.read_message()
        return received

    return asyncio.run(run())


def test_the_page_is_served_with_its_own_policy(server):
    status, headers, body = get(server)
    assert status == 200
    assert f"connect-src ws://127.0.0.1:{server.port}" in headers["Content-Security-Policy"]
    assert headers["X-Content-Type-Options"] == "nosniff"
    assert "<title>" in body


@pytest.mark.parametrize("host", ["evil.example", "127.0.0.1.evil.example", "localhost.evil.example", ""])
def test_a_foreign_host_is_refused(server, host):
    assert get(server, Host=f"{host}:{server.port}")[0] == 403
    with pytest.raises(HTTPClientError, match="403"):
        talk(server, Host=f"{host}:{server.port}")


@pytest.mark.parametrize("host", ["localhost", "127.0.0.1", "[::1]"])
def test_every_loopback_name_is_answered(server, host):
    assert get(server, Host=f"{host}:{server.port}")[0] == 200


@pytest.mark.parametrize(
    "origin", ["http://evil.example", "null", "http://127.0.0.1:1", "https://127.0.0.1:{port}"]
)
def test_a_foreign_origin_gets_no_connection(server, origin):
    with pytest.raises(HTTPClientError, match="403"):
        talk(server, Origin=origin.format(port=server.port))


def test_the_pages_own_origin_gets_the_scene(server, scene):
    (first,) = talk(server, Origin=f"http://127.0.0.1:{server.port}")
    assert first == b"\0" + viewer.bundle(scene)


@pytest.mark.parametrize("path", ["/static/", "/main.min.js", "/../etc/passwd", "/%2e%2e/", "/favicon.ico"])
def test_nothing_else_is_there(server, path):
    assert get(server, path)[0] == 404


@pytest.mark.parametrize(
    "forged",
    [
        "not json",
        "[]",
        "null",
        '"state"',
        b"\xff\x00",
        '{"type": "img", "data": "data:image/png;base64,AAAA"}',
        '{"type": "state"}',
        '{"type": "state", "time": NaN, "speed": 1, "view": "iso"}',
        '{"type": "state", "time": 0, "speed": 1e9, "view": "iso"}',
        '{"type": "state", "time": "x", "speed": 1, "view": "iso"}',
        '{"type": "state", "time": 1' + "0" * 400 + ', "speed": 1, "view": "iso"}',
        '{"type": "state", "time": 0, "speed": 1, "view": {"a": 1}}',
        "[" * 60_000,
        '{"type": ["state"]}',
        '{"type": "reach"}',
        '{"type": "reach", "id": 1, "feet": {"left_foot": [NaN, 0, 0, 0, 0, 0, 1]}, "q": []}',
        '{"type": "reach", "id": 1, "feet": {"left_foot": [1e300, 0, 0, 0, 0, 0, 1]}, "q": []}',
    ],
)
def test_forged_messages_are_ignored_and_the_connection_lives_on(server, forged, capfd):
    talk(server, forged)
    assert server.state == {name: value for name, value in STATE.items() if name != "type"}
    assert capfd.readouterr().err == ""


@asynccontextmanager
async def connected(server):
    """A page's connection that has received the scene."""
    page = await websocket_connect(live(server))
    await asyncio.wait_for(page.read_message(), PATIENCE)
    yield page
    page.close()
    while await asyncio.wait_for(page.read_message(), PATIENCE) is not None:
        pass


def request(scene, number, height):
    q = [float(value) for value in scene.arrays["q"][0]]
    feet = {"left_foot": [0.0, 0.1, height, 0.0, 0.0, 0.0, 1.0]}
    return json.dumps({"type": "reach", "id": number, "feet": feet, "q": q})


def test_of_a_flood_of_requests_the_latest_is_answered_and_no_queue_grows(server, scene):
    async def run():
        answers = []
        async with connected(server) as page:
            for number in range(FLOOD):
                page.write_message(request(scene, number, -0.85 - 0.05 * number / FLOOD))
            while not answers or answers[-1]["id"] != FLOOD - 1:
                answers.append(json.loads(await asyncio.wait_for(page.read_message(), PATIENCE)))
        return answers

    answers = asyncio.run(run())
    numbers = [answer["id"] for answer in answers]
    assert numbers == sorted(numbers)
    assert len(numbers) < FLOOD / 2
    assert answers[-1]["misses"] == {"left_foot": [0, 0]}


def test_two_pages_get_each_their_own_answers(server, scene):
    async def run():
        async with connected(server) as one, connected(server) as other:
            await one.write_message(request(scene, 10, -0.85))
            await other.write_message(request(scene, 11, -0.8))
            return [
                json.loads(await asyncio.wait_for(page.read_message(), PATIENCE)) for page in (one, other)
            ]

    assert [answer["id"] for answer in asyncio.run(run())] == [10, 11]


def test_a_page_that_leaves_before_its_answer_harms_nobody(server, scene, capfd):
    async def run():
        async with connected(server) as page:
            await page.write_message(request(scene, 1, -0.85))

    asyncio.run(run())
    talk(server)
    assert capfd.readouterr().err == ""


def test_sixty_seconds_of_poses_leave_no_memory_behind(server):
    async def run():
        async with connected(server) as page:

            async def play(count):
                for _ in range(count // BATCH):
                    for k in range(BATCH):
                        server.pose(np.full(12, k / BATCH), UPRIGHT)
                    for _ in range(BATCH):
                        await asyncio.wait_for(page.read_message(), PATIENCE)
                gc.collect()
                return tracemalloc.get_traced_memory()[0]

            before = await play(WARM_UP)
            return await play(MINUTE) - before

    tracemalloc.start()
    try:
        assert asyncio.run(run()) < GROWTH
    finally:
        tracemalloc.stop()


def test_a_new_page_resumes_where_the_last_one_was(server):
    talk(server)
    _, second = talk(server, wait_for=2)
    assert json.loads(second) == STATE


def test_a_taken_port_moves_to_the_next_free_one(scene):
    with viewer.serve(scene, port=0) as first, viewer.serve(scene, port=first.port) as second:
        assert second.wanted == first.port
        assert second.port > first.port
        assert str(second.port) in second.url
        assert get(second)[0] == 200


def test_only_loopback_is_listened_on_unless_another_host_is_given(server):
    assert server.loopback
    with viewer.serve(host="0.0.0.0", port=0) as open_to_all:
        assert not open_to_all.loopback
        assert open_to_all.url.startswith("http://127.0.0.1:")
        assert get(open_to_all, Host="evil.example")[0] == 403
        assert get(open_to_all, Host="192.0.2.7:7000")[0] == 200


def test_a_host_of_another_machine_is_refused_clearly():
    with pytest.raises(ExoPinError, match="not an address"):
        viewer.serve(host="no-such-host.invalid", port=0)
    with pytest.raises(ExoPinError, match=r"cannot listen on 192\.0\.2\.1"):
        viewer.serve(host="192.0.2.1", port=0)


def test_closing_leaves_no_thread_and_no_port(scene):
    before = set(threading.enumerate())
    server = viewer.serve(scene, port=0)
    get(server)
    server.close()
    server.close()  # twice is once
    assert set(threading.enumerate()) <= before
    with socket.socket() as probe:
        assert probe.connect_ex(("127.0.0.1", server.port)) != 0


def test_a_scene_may_follow_the_server(scene):
    with viewer.serve(port=0) as server:
        assert get(server)[0] == 200
        server.show(scene)
        (first,) = talk(server)
        assert first == b"\0" + viewer.bundle(scene)


def test_a_live_pose_costs_next_to_nothing(server):
    q, base = np.zeros(12), UPRIGHT
    start = time.perf_counter()
    for _ in range(500):
        server.pose(q, base)
    assert (time.perf_counter() - start) / 500 < POSE_COST


def test_starting_a_server_needs_neither_pinocchio_nor_zmq():
    import subprocess
    import sys

    code = (
        "import sys; from exo_pin import viewer; s = viewer.serve(port=0); s.close(); "
        "bad = {'pinocchio', 'zmq', 'meshcat', 'numpy'} & set(sys.modules); sys.exit(str(bad) if bad else 0)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
