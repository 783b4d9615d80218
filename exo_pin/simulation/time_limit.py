"""A time limit on each step of a simulation, so that a controller which never answers is ended."""

from __future__ import annotations

import contextlib
import signal
import threading
from collections.abc import Iterator

from exo_pin.errors import DescriptionError

LONGEST_ANSWER = 10.0
"""Of a controller [s]; a step takes less than a millisecond."""


class _Progress:
    """Counts the steps that are done."""

    def __init__(self) -> None:
        self.steps, self._seen = 0, -1

    def stuck(self) -> bool:
        """Whether no step was done since the last question."""
        still, self._seen = self.steps == self._seen, self.steps
        return still


@contextlib.contextmanager
def time_limit(seconds: float | None = None) -> Iterator[_Progress]:
    """Raise where no step ends within the time, on the main thread of POSIX; elsewhere nothing is done.

    Args:
        seconds: For one step; `LONGEST_ANSWER` if left out.

    Raises:
        DescriptionError: The controller does not answer.
    """
    limit = LONGEST_ANSWER if seconds is None else seconds
    progress = _Progress()
    if not hasattr(signal, "setitimer") or threading.current_thread() is not threading.main_thread():
        yield progress
        return

    def look(signum: int, frame: object) -> None:
        if progress.stuck():
            raise DescriptionError(
                f"the controller does not answer within {limit:g} s in step {progress.steps}; "
                "it is called once a step and returns 12 torques"
            )

    before = signal.signal(signal.SIGALRM, look)
    signal.setitimer(signal.ITIMER_REAL, limit, limit)
    try:
        yield progress
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
