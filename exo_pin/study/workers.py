"""Workers of a study: tasks in parallel by joblib, each on one thread, their results as they become ready."""

from __future__ import annotations

import contextlib
import importlib
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import TypeVar

from exo_pin.errors import DescriptionError, FormatError
from exo_pin.files import write_text
from exo_pin.study.record_table import Record, RecordTable

Task = TypeVar("Task")
Result = TypeVar("Result")

_JOBS_PER_CORE = 32
"""More workers than that only cost memory: each takes some 200 MB."""

_AT_ONCE = 32
"""Tasks between two writes, for a back end that cannot return results one by one."""


def check_jobs(jobs: int | None) -> None:
    """Raise `DescriptionError` for a number of workers that there cannot be."""
    most = _JOBS_PER_CORE * (os.cpu_count() or 1)
    if jobs is None or (isinstance(jobs, int) and (jobs == -1 or 1 <= jobs <= most)):
        return
    raise DescriptionError(
        f"jobs is {str(jobs)[:40]}; a number of processes from 1 to {most}, or -1 for one per core, "
        "is accepted"
    )


@contextlib.contextmanager
def one_thread() -> Iterator[None]:
    """Linear algebra on one thread: its sums round alike in every worker.

    The limit holds for a whole process. A worker that is a process of its own sets it for each case; workers
    that are threads share the one of the run, which none of them lifts before the others are done.
    """
    from threadpoolctl import threadpool_limits

    importlib.import_module("scipy.linalg")  # its own library of linear algebra must be there to be limited
    with threadpool_limits(limits=1):
        yield


def solved(tasks: Sequence[Task], solve: Callable[[Task], Result], jobs: int | None) -> Iterator[Result]:
    """The results as they become ready, in any order.

    Args:
        tasks: What is to be done.
        solve: Does one, in a worker.
        jobs: Workers; None: one, or what `joblib.parallel_config` says.
    """
    from joblib import Parallel, delayed

    calls = [delayed(_on_one_thread)(solve, task) for task in tasks]
    try:
        parallel = Parallel(n_jobs=jobs, return_as="generator_unordered")
    except ValueError:  # a back end that returns all results at once
        parallel = Parallel(n_jobs=jobs)
        for k in range(0, len(calls), _AT_ONCE):
            yield from parallel(calls[k : k + _AT_ONCE])
        return
    with contextlib.closing(parallel(calls)) as results:  # an interrupted study stops its workers
        yield from results


def workers(jobs: int | None) -> int:
    """How many workers joblib makes of `jobs`."""
    from joblib import effective_n_jobs

    return int(effective_n_jobs(jobs))


def _on_one_thread(solve: Callable[[Task], Result], task: Task) -> Result:
    """The result of a task."""
    with one_thread():
        return solve(task)


def part(path: str | Path) -> Path:
    """The file of the rows of an unfinished study."""
    return Path(f"{path}.part")


@contextlib.contextmanager
def appending(
    path: str | Path | None, table: RecordTable[Record], done: Iterable[Record]
) -> Iterator[Callable[[Sequence[Record]], None]]:
    """A function that appends rows to the part of a table, which begins with the rows that are done.

    Args:
        path: The table; None: nothing is written.
        table: Its kind.
        done: Rows that are done.

    Raises:
        FormatError: It cannot be written.
    """
    if path is None:
        yield lambda rows: None
        return
    file = part(path)
    write_text(file, table.text(done))

    def append(rows: Sequence[Record]) -> None:
        try:
            with file.open("a", encoding="utf-8") as lines:
                lines.write(table.text(rows, heading=False))
        except OSError as error:
            raise FormatError(file, f"cannot be written: {error.strerror}") from error

    yield append
