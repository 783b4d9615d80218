"""Run a study: cases in parallel by joblib; finished rows are kept, so that it can be continued."""

from __future__ import annotations

import contextlib
import importlib
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import chain, zip_longest
from pathlib import Path

from exo_pin.errors import DescriptionError, FormatError
from exo_pin.files import write_text
from exo_pin.study import study_table
from exo_pin.study.case import Case, Outcome, solve
from exo_pin.study.earlier_rows import Earlier, earlier, part
from exo_pin.study.study_table import MOTIONS, Row

Progress = Callable[[Iterable[Outcome], int], Iterable[Outcome]]
"""Wraps the outcomes as they arrive; its second argument is their number."""

_JOBS_PER_CORE = 32
"""More workers than that only cost memory: each takes some 200 MB."""

_AT_ONCE = 32
"""Cases between two writes, for a back end that cannot return results one by one."""


@dataclass(frozen=True, eq=False)
class Study:
    """The result of a study.

    Attributes:
        rows: In the order of the plan: case by case, device by device, the best motion and the plain copy.
        failures: By name of the recording (or speed): why it has no rows.
        computed: Rows of this run.
        kept: Rows of earlier runs.
        remarks: Which rows of earlier runs were not used, a plain sentence each.
    """

    rows: tuple[Row, ...]
    failures: dict[str, str]
    computed: int
    kept: int
    remarks: tuple[str, ...] = ()

    @property
    def walks(self) -> int:
        """How many walks there are; one on two bodies counts twice."""
        return len({(row.gait, row.stature_m) for row in self.rows})

    @property
    def devices(self) -> int:
        """How many devices there are."""
        return len({row.device for row in self.rows})


def run(
    cases: Sequence[Case],
    path: str | Path | None = None,
    *,
    jobs: int | None = None,
    restart: bool = False,
    progress: Progress = lambda outcomes, _: outcomes,
) -> Study:
    """Run a study, or continue it.

    Finished cases are appended to `PATH.part` at once; when all are done the table is written to `path`, in
    the order of the plan, and the part is removed. Rows in either file are not computed again, unless they
    were edited, or come from another exo_pin, device or recording than those of the plan.

    Args:
        cases: The plan.
        path: The table (.csv); None: write nothing.
        jobs: Workers; -1: one per core. None: one, or what `joblib.parallel_config` says, which also names
            the back end.
        restart: Discard the rows of an earlier study of this name.
        progress: Wraps the outcomes, e.g. in a progress bar.

    Raises:
        DescriptionError: The table holds rows of another plan, or there cannot be so many workers.
        FormatError: The file is not the table of a study, or cannot be written.
    """
    _check_jobs(jobs)
    cases, failed = _readable(cases)
    before = Earlier({}) if path is None else earlier(Path(path), cases, restart=restart)
    done = dict(before.rows)
    kept, failures = len(done) * len(MOTIONS), {}
    todo = [rest for case in cases if (rest := case.without(done)).parts]
    with _one_thread(), _appending(path, done) as append:
        for outcome in progress(chain(failed, _solved(todo, jobs)), len(failed) + len(todo)):
            if outcome.failure:
                failures[outcome.case.gait] = outcome.failure
            append(outcome.rows)
            for row in outcome.rows:
                done.setdefault(row.inputs, {})[row.motion] = row
    marks = [mark for case in cases for mark in case.fingerprints if mark in done]
    rows = tuple(done[mark][motion] for mark in marks for motion in MOTIONS)
    if path is not None:
        if rows:
            study_table.save(rows, path)
        part(path).unlink(missing_ok=True)
    return Study(rows, dict(sorted(failures.items())), len(rows) - kept, kept, before.remarks)


def _check_jobs(jobs: int | None) -> None:
    """Raise `DescriptionError` for a number of workers that there cannot be."""
    most = _JOBS_PER_CORE * (os.cpu_count() or 1)
    if jobs is None or (isinstance(jobs, int) and (jobs == -1 or 1 <= jobs <= most)):
        return
    raise DescriptionError(
        f"jobs is {str(jobs)[:40]}; a number of processes from 1 to {most}, or -1 for one per core, "
        "is accepted"
    )


def _readable(cases: Iterable[Case]) -> tuple[list[Case], list[Outcome]]:
    """Cases whose file can be read, and the outcomes of the others."""
    readable, failed = [], []
    for case in cases:
        try:
            _ = case.fingerprints
        except FormatError as error:
            failed.append(Outcome(case, failure=str(error)))
        else:
            readable.append(case)
    return readable, failed


@contextlib.contextmanager
def _appending(
    path: str | Path | None, done: dict[str, dict[str, Row]]
) -> Iterator[Callable[[Sequence[Row]], None]]:
    """A function that appends rows to the part, which begins with the rows that are done.

    Raises:
        FormatError: It cannot be written.
    """
    if path is None:
        yield lambda rows: None
        return
    file = part(path)
    write_text(file, study_table.text(row for rows in done.values() for row in rows.values()))

    def append(rows: Sequence[Row]) -> None:
        try:
            with file.open("a", encoding="utf-8") as lines:
                lines.write(study_table.text(rows, heading=False))
        except OSError as error:
            raise FormatError(file, f"cannot be written: {error.strerror}") from error

    yield append


def _solved(cases: Sequence[Case], jobs: int | None) -> Iterator[Outcome]:
    """The outcomes as they become ready, in any order."""
    from joblib import Parallel, delayed, effective_n_jobs

    tasks = [delayed(_on_one_thread)(case) for case in _in_turns(cases, effective_n_jobs(jobs))]
    try:
        parallel = Parallel(n_jobs=jobs, return_as="generator_unordered")
    except ValueError:  # a back end that returns all results at once
        parallel = Parallel(n_jobs=jobs)
        for k in range(0, len(tasks), _AT_ONCE):
            yield from parallel(tasks[k : k + _AT_ONCE])
        return
    with contextlib.closing(parallel(tasks)) as outcomes:  # an interrupted study stops its workers
        yield from outcomes


@contextlib.contextmanager
def _one_thread() -> Iterator[None]:
    """Linear algebra on one thread: its sums round alike in every worker.

    The limit holds for a whole process. A worker that is a process of its own sets it for each case; workers
    that are threads share the one of the run, which none of them lifts before the others are done.
    """
    from threadpoolctl import threadpool_limits

    importlib.import_module("scipy.linalg")  # its own library of linear algebra must be there to be limited
    with threadpool_limits(limits=1):
        yield


def _on_one_thread(case: Case) -> Outcome:
    """The outcome of a case."""
    with _one_thread():
        return solve(case)


def _in_turns(cases: Sequence[Case], workers: int) -> Iterator[Case]:
    """The cases of as many bodies in turn as there are workers.

    xacro takes 0.2 s to describe a device on a body, and the description is kept for all workers. So each
    worker begins with a body of its own and finds the descriptions of the others.
    """
    groups: list[list[Case]] = []
    for case in cases:
        if groups and case.body is not None and case.body is groups[-1][0].body:
            groups[-1].append(case)
        else:
            groups.append([case])
    for k in range(0, len(groups), workers):
        for turn in zip_longest(*groups[k : k + workers]):
            yield from (case for case in turn if case is not None)
