"""Signals that stop a command: one handler for all of them, which lets every `finally` run.

A signal raises `Stopped` wherever the command is, except while a module is being imported: extension modules
turn an exception there into errors of their own, so the handler waits until the import is done.
"""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

_CLEANING = 5.0
"""So long after a signal others are ignored [s]: what runs then cleans up."""

_LONGEST_IMPORT = 20.0
"""An import that takes longer is interrupted [s]."""

_PAUSE = 0.02
"""Between two looks at whether an import is done [s]."""

_HANG_UP, _ALARM = (int(getattr(signal, name, 0)) for name in ("SIGHUP", "SIGALRM"))
"""Numbers of signals that Windows does not have (0)."""


class Stopped(KeyboardInterrupt):
    """A signal has stopped the command.

    Args:
        number: Of the signal.
    """

    def __init__(self, number: int) -> None:
        super().__init__(number)
        self.number = number


def exit_code(stop: KeyboardInterrupt) -> int:
    """Exit code of a stopped command, as shells form it."""
    return 128 + (stop.number if isinstance(stop, Stopped) else signal.SIGINT)


class _Handler:
    """The handler of the signals, and of the alarm by which it waits for the end of an import.

    Attributes:
        number: The first signal that came; 0: none.
    """

    def __init__(self) -> None:
        self.number = 0
        self._patient_until = self._deaf_until = 0.0

    def __call__(self, number: int, frame: FrameType | None) -> None:
        now = time.monotonic()
        if not self.number and number != _ALARM:
            self.number, self._patient_until = number, now + _LONGEST_IMPORT
        if not self.number or now < self._deaf_until:
            return
        if _ALARM and now < self._patient_until and _importing(frame):
            signal.setitimer(signal.ITIMER_REAL, _PAUSE)
            return
        self._deaf_until = now + _CLEANING
        raise Stopped(self.number)


@contextmanager
def stoppable() -> Iterator[None]:
    """SIGINT, SIGTERM and SIGHUP stop what is inside; only in the main thread, where handlers can be set.

    A SIGHUP that is ignored (`nohup`) stays so; a SIGINT does not, which shells ignore behind a `&`.

    Raises:
        Stopped: A signal came, also where another exception came of it.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    handler, before = _Handler(), {}
    for number in _numbers():
        before[number] = signal.signal(number, handler)
    try:
        yield
    except Exception:
        if not handler.number:
            raise
        raise Stopped(handler.number) from None
    finally:
        for number, old in before.items():
            signal.signal(number, old)


def _numbers() -> list[int]:
    """The signals to handle: those that this system has."""
    numbers = [signal.SIGINT, signal.SIGTERM, _HANG_UP, _ALARM]
    if _HANG_UP and signal.getsignal(_HANG_UP) == signal.SIG_IGN:
        numbers.remove(_HANG_UP)
    return [number for number in numbers if number]


def _importing(frame: FrameType | None) -> bool:
    """Whether a frame, or one that called it, imports a module."""
    while frame is not None:
        if frame.f_code.co_filename.startswith("<frozen importlib"):
            return True
        frame = frame.f_back
    return False
