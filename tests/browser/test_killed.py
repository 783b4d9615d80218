"""Commands with a browser, stopped in every way: no process and no file of theirs is left."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import pytest

from exo_pin import cache
from exo_pin.viewer.film.chromium import Chromium

SOON = 2.0  # [s]: what the end of a killed run may take
PATIENCE = 90.0  # [s]: what a busy machine may take to start the browser
COMMANDS = {
    "film": ["film", "--quality", "low", "--fps", "60", "-o", "{}/out.gif"],
    "picture": ["picture", "-o", "{}/out.png"],
    "reproduce": ["reproduce", "-o", "{}/new/out"],
}


@pytest.fixture
def place(tmp_path, chromium_path):
    for name in ("tmp", "cache", "out", "home"):
        (tmp_path / name).mkdir()
    return tmp_path


def processes(place):
    """Processes that name the place in their arguments, zombies left out."""
    found = []
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            words = (folder / "cmdline").read_bytes()
        except OSError:
            continue
        if os.fsencode(place) in words and int(folder.name) != os.getpid():
            found.append(words.decode(errors="replace")[:200])
    return found


def until(condition, seconds):
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            return False
        time.sleep(0.02)
    return True


def begin(place, name):
    command = [sys.executable, "-m", "exo_pin", *(word.format(place / "out") for word in COMMANDS[name])]
    places = {"TMPDIR": "tmp", cache.VARIABLE: "cache", "HOME": "home"}
    environment = os.environ | {variable: str(place / folder) for variable, folder in places.items()}
    return subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=environment,
        preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_DFL),  # not ignored as under nohup
    )


def page_is_there(place):
    return list((place / "tmp").glob("*/page.html"))


@pytest.mark.skipif(sys.platform != "linux", reason="needs /proc")
@pytest.mark.parametrize("name", COMMANDS)
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP, signal.SIGINT, signal.SIGKILL])
def test_a_stopped_run_leaves_nothing(place, name, number):
    with begin(place, name) as process:
        assert until(lambda: page_is_there(place), PATIENCE), process.stderr.read()
        assert processes(place / "tmp")
        process.send_signal(number)
        _, said = process.communicate(timeout=PATIENCE)
    assert process.returncode == (-number if number == signal.SIGKILL else 128 + number)
    assert "Traceback" not in said
    assert until(lambda: not processes(place), SOON), processes(place)
    assert until(lambda: list((place / "tmp").iterdir()) == [], SOON)
    assert list((place / "out").iterdir()) == []
    assert not (place / "home" / ".config" / "chromium").exists()


def sockets(pid):
    for link in Path(f"/proc/{pid}/fd").glob("*"):
        try:
            yield os.readlink(link)
        except OSError:
            continue


@pytest.mark.skipif(sys.platform != "linux", reason="needs /proc")
def test_the_browser_opens_no_port_and_ignores_proxies(chromium_path, monkeypatch):
    with socket.create_server(("127.0.0.1", 0)) as proxy:
        for name in ("http_proxy", "HTTPS_PROXY", "all_proxy"):
            monkeypatch.setenv(name, f"http://127.0.0.1:{proxy.getsockname()[1]}")
        with Chromium((300, 200)) as browser:
            browser.open_page("<script>window.exo = { firstPicture: 1 }</script>")
            folder = os.fsencode(browser._browser.folder)
            own = set()
            for process in Path("/proc").glob("[0-9]*"):
                if folder in (process / "cmdline").read_bytes():
                    own |= set(sockets(process.name))
                    assert b"_proxy=" not in (process / "environ").read_bytes()
            assert own
            for table in ("tcp", "tcp6"):
                for line in Path(f"/proc/net/{table}").read_text().splitlines()[1:]:
                    fields = line.split()
                    assert f"socket:[{fields[9]}]" not in own, f"a TCP socket: {line}"


def test_a_browser_that_hangs_is_given_up_in_time(monkeypatch, tmp_path):
    from exo_pin.errors import ExoPinError

    deaf = tmp_path / "chromium"
    deaf.write_text("#!/bin/sh\nexec sleep 60\n")
    deaf.chmod(0o755)
    monkeypatch.setenv("EXO_PIN_CHROMIUM", str(deaf))
    start = time.monotonic()
    with pytest.raises(ExoPinError, match="did not answer within 1 s"):
        Chromium(timeout=1.0)
    assert time.monotonic() - start < 6
