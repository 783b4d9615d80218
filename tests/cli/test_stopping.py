"""Signals: a command that is stopped at any moment leaves nothing and prints no traceback."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from importlib import import_module

import pytest

from exo_pin import cache
from exo_pin.cli import stopping

MOMENTS = 24
PATIENCE = 30.0  # [s]: what a busy machine may take


def environment(folder):
    for name in ("tmp", "cache"):
        (folder / name).mkdir(exist_ok=True)
    return os.environ | {"TMPDIR": str(folder / "tmp"), cache.VARIABLE: str(folder / "cache")}


def begin(folder, *words):
    """A command that is being started; it tells when Python itself has started and `run` has begun."""
    code = (
        "import os, signal, sys; signal.signal(signal.SIGINT, signal.SIG_DFL); "
        "signal.signal(signal.SIGHUP, signal.SIG_DFL); os.write(1, b'begun\\n'); "  # not as under nohup
        "from exo_pin.__main__ import run; sys.exit(run())"
    )
    command = [sys.executable, "-c", code, *map(str, words)]
    return subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment(folder)
    )


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_no_moment_of_the_start_has_a_traceback(tmp_path, number):
    with begin(tmp_path, "replay", "--no-open", "--port", "0") as process:
        assert process.stdout.readline() == "begun\n"
        start = time.monotonic()
        while "http" not in (line := process.stdout.readline()):
            assert line
        whole = time.monotonic() - start
        process.kill()
    codes = []
    for k in range(MOMENTS // 3):
        with begin(tmp_path, "replay", "--no-open", "--port", "0") as process:
            assert process.stdout.readline() == "begun\n"
            time.sleep(1.5 * whole * k / (MOMENTS // 3))
            process.send_signal(number)
            _, said = process.communicate(timeout=PATIENCE)
            assert "Traceback" not in said
            codes.append(process.returncode)
    assert set(codes) <= {-number, 128 + number, 0}
    assert list((tmp_path / "tmp").iterdir()) == []


def importing(name):
    import_module(name)
    time.sleep(PATIENCE)


def converting():
    try:
        signal.raise_signal(signal.SIGHUP)
    except KeyboardInterrupt:
        raise RuntimeError("what a library makes of it") from None


def cleaning(cleaned):
    try:
        signal.raise_signal(signal.SIGINT)
    finally:
        signal.raise_signal(signal.SIGINT)
        cleaned.append(True)


def test_a_signal_during_an_import_waits_for_its_end(tmp_path, monkeypatch):
    (tmp_path / "slow_to_import.py").write_text(
        "import os, signal\nos.kill(os.getpid(), signal.SIGTERM)\ntry:\n    sum(range(10**6))\n"
        "except BaseException:\n    raise ImportError('as NumPy does')\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(stopping.Stopped) as stop, stopping.stoppable():
        importing("slow_to_import")
    assert "slow_to_import" in sys.modules
    assert stopping.exit_code(stop.value) == 128 + signal.SIGTERM


def test_an_error_that_comes_of_a_signal_counts_as_the_signal():
    signal.signal(signal.SIGHUP, signal.SIG_DFL)  # nohup, under which it is ignored, is another test's
    with pytest.raises(stopping.Stopped), stopping.stoppable():
        converting()


def test_a_second_signal_does_not_disturb_the_cleaning_up():
    cleaned = []
    with pytest.raises(stopping.Stopped), stopping.stoppable():
        cleaning(cleaned)
    assert cleaned


def test_errors_without_a_signal_pass_and_handlers_are_put_back():
    before = [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)]
    with pytest.raises(ZeroDivisionError), stopping.stoppable():
        _ = 1 / 0
    after = [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)]
    assert before == after


def test_nohup_is_respected_and_other_threads_set_no_handlers():
    old = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with stopping.stoppable():
            signal.raise_signal(signal.SIGHUP)
    finally:
        signal.signal(signal.SIGHUP, old)
    done = []

    def elsewhere():
        with stopping.stoppable():
            done.append(True)

    thread = threading.Thread(target=elsewhere)
    thread.start()
    thread.join()
    assert done
