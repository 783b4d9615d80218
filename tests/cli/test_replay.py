"""`exo-pin replay` as a process: its first frame, its warnings, and what it leaves behind."""

from __future__ import annotations

import asyncio
import os
import signal
import socket
import subprocess
import sys
import time
from contextlib import contextmanager

import pytest
from tornado.websocket import websocket_connect

from exo_pin import cache, viewer
from exo_pin.cli import last_picture
from exo_pin.gait import normative_gait
from exo_pin.robot import load_robot

PATIENCE = 30.0  # [s]: what a busy machine may take


def words(*more):
    return ["replay", "--no-open", *more]


@contextmanager
def replaying(folder, *more):
    """A running `exo-pin replay`; its temporary files and its cache are in the folder."""
    for name in ("tmp", "cache"):
        (folder / name).mkdir(exist_ok=True)
    environment = os.environ | {"TMPDIR": str(folder / "tmp"), cache.VARIABLE: str(folder / "cache")}
    command = [sys.executable, "-m", "exo_pin", *words(*more)]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    with subprocess.Popen(command, text=True, env=environment, **pipes) as process:
        try:
            yield process
        finally:
            process.kill()


def said(process):
    """What it prints until it serves."""
    lines = [process.stdout.readline()]
    while "Ctrl-C ends it" not in lines[-1]:
        assert lines[-1], process.stderr.read()
        lines.append(process.stdout.readline())
    return "".join(lines)


def address(text):
    """The page's address in what was printed."""
    return next(word for word in text.split() if word.startswith("http://"))


def first_messages(url, count):
    async def run():
        page = await websocket_connect(url.replace("http:", "ws:").replace("/?", "/live?"))
        heard = [await asyncio.wait_for(page.read_message(), PATIENCE) for _ in range(count)]
        page.close()
        await page.read_message()
        return heard

    return asyncio.run(run())


@pytest.fixture
def free_port():
    with socket.create_server(("127.0.0.1", 0)) as probe:
        return probe.getsockname()[1]


def test_last_times_picture_comes_first_and_this_runs_own_replaces_it(tmp_path, monkeypatch, free_port):
    monkeypatch.setenv(cache.VARIABLE, str(tmp_path / "cache"))
    mine = ("--port", str(free_port), "--no-wearer")
    older = viewer.bundle(viewer.scene(load_robot(), normative_gait("slow"), wearer=False))
    last_picture.keep(words(*mine), older)
    with replaying(tmp_path, *mine) as process:
        url = address(said(process))
        assert f":{free_port}/?token=" in url
        first, second = first_messages(url, 2)
        assert first == b"\0" + older
        assert second[1:] != older
        end = time.monotonic() + PATIENCE
        while last_picture.recall(words(*mine)) != second[1:]:
            assert time.monotonic() < end
            time.sleep(0.01)


def test_other_words_and_changed_files_have_no_last_time(tmp_path, monkeypatch):
    monkeypatch.setenv(cache.VARIABLE, str(tmp_path / "cache"))
    body = tmp_path / "body.toml"
    body.write_text("stature = 1.7\n")
    for given in (["--body", str(body)], [f"--body={body}"]):
        last_picture.keep(words(*given), b"picture")
        assert last_picture.recall(words(*given)) == b"picture"
        assert last_picture.recall(words(*given, "slow")) is None
    body.write_text("stature = 1.71\n")
    assert last_picture.recall(words("--body", str(body))) is None
    assert last_picture.recall(words(f"--body={body}")) is None


def test_the_last_picture_needs_neither_numpy_nor_pinocchio(tmp_path):
    code = (
        "import sys; from exo_pin.cli import last_picture; "
        "last_picture.keep(['replay', '--port=0', '--no-open'], b'x'); "
        "s = last_picture.serve(['replay', '--port=0', '--no-open']); s.close(); "
        "bad = {'numpy', 'pinocchio', 'xacro'} & set(sys.modules); sys.exit(str(bad) if bad else 0)"
    )
    environment = os.environ | {cache.VARIABLE: str(tmp_path)}
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, env=environment, check=False)
    assert done.returncode == 0, done.stderr


def test_a_taken_port_and_an_open_door_are_said_and_nothing_is_left(tmp_path):
    with socket.create_server(("0.0.0.0", 0)) as taken:
        port = taken.getsockname()[1]
        with replaying(tmp_path, "--port", str(port), "--host", "0.0.0.0", "--no-wearer") as process:
            text = said(process)
            assert f":{port}/" not in text
            process.send_signal(signal.SIGTERM)
            assert process.wait(PATIENCE) == 0
            warnings = process.stderr.read()
    assert f"port {port} is in use" in warnings
    assert "lets other machines connect" in warnings
    assert list((tmp_path / "tmp").iterdir()) == []
    assert not [file for file in (tmp_path / "cache").iterdir() if file.name.startswith(".")]


def test_bad_input_is_said_before_anything_is_served(tmp_path):
    with replaying(tmp_path, "--port", "0", "no_such_file.csv") as process:
        assert process.wait(PATIENCE) == 2
        assert "http" not in process.stdout.read()
        assert "no_such_file.csv" in process.stderr.read()
