"""Code of a user: what it raises becomes one line with its place, and what never ends is ended."""

from __future__ import annotations

import contextlib
import signal
import threading
import traceback
from collections.abc import Callable, Iterator
from pathlib import Path

from exo_pin.errors import ExoPinError

LONGEST_START = 60.0
"""Of a controller's file, its class and its `reset` [s]: heavy packages take some seconds to import."""

LONGEST_ANSWER = 10.0
"""Of a controller in a step [s]; a step takes less than a millisecond."""

_PACKAGE = Path(__file__).parents[1]
"""Frames in here are ours, not the user's."""


class Watched:
    """Counts the steps that are done."""

    def __init__(self) -> None:
        self.steps, self._seen = 0, 0

    def stuck(self) -> bool:
        """Whether no step was done since the last question."""
        still, self._seen = self.steps == self._seen, self.steps
        return still


class _TooLong(BaseException):
    """The time is over; no `except Exception` in a user's code catches it."""


@contextlib.contextmanager
def time_limit(seconds: float, refused: Callable[[int], ExoPinError]) -> Iterator[Watched]:
    """End what does no step within a time, on the main thread of POSIX; elsewhere nothing is done.

    Args:
        seconds: For one step.
        refused: The error to raise, given the steps that were done.
    """
    progress = Watched()
    if not hasattr(signal, "setitimer") or threading.current_thread() is not threading.main_thread():
        yield progress
        return

    def look(signum: int, frame: object) -> None:
        if progress.stuck():
            raise _TooLong

    before = signal.signal(signal.SIGALRM, look)
    signal.setitimer(signal.ITIMER_REAL, seconds, seconds)
    try:
        yield progress
    except _TooLong:
        raise refused(progress.steps) from None
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)


@contextlib.contextmanager
def users_code(refused: Callable[[str], ExoPinError]) -> Iterator[None]:
    """Run code of a user before the first step, within `LONGEST_START`.

    Args:
        refused: The error to raise, given the reason.
    """
    too_long = f"it does not end within {LONGEST_START:g} s"
    with time_limit(LONGEST_START, lambda steps: refused(too_long)):
        try:
            yield
        except ExoPinError:
            raise
        except (Exception, SystemExit) as error:  # whatever a user's code raises
            raise refused(raised_where(error)) from error


def raised_where(error: BaseException) -> str:
    """The line at which a user's code raised, and what it says, in one line."""
    frames = traceback.extract_tb(error.__traceback__)
    own = [frame for frame in frames if _users(frame.filename)]
    place = f"{Path(own[-1].filename).name}:{own[-1].lineno}: " if own else ""
    return f"{place}{type(error).__name__}: {error}"


def _users(filename: str) -> bool:
    """Whether a frame is neither ours nor Python's import of the file ("<frozen importlib...>")."""
    return not filename.startswith("<") and not Path(filename).is_relative_to(_PACKAGE)
