"""Run a study: cases in parallel by joblib; finished rows are kept, so that it can be continued."""

from __future__ import annotations

import contextlib
import importlib
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import chain, zip_longest
from pathlib import Path

from exo_pin.errors import DescriptionError, FormatError
from exo_pin.files import write_text
from exo_pin.study import study_table
from exo_pin.study.case import Case, Outcome, solve
from exo_pin.study.study_table import MOTIONS, Row

Progress = Callable[[Iterable[Outcome], int], Iterable[Outcome]]
"""Wraps the outcomes as they arrive; its second argument is their number."""

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
    """

    rows: tuple[Row, ...]
    failures: dict[str, str]
    computed: int
    kept: int

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
    the order of the plan, and the part is removed. Rows in either file are not computed again.

    Args:
        cases: The plan.
        path: The table (.csv); None: write nothing.
        jobs: Workers, as joblib counts them (-1: one per core). None: one, or what
            `joblib.parallel_config` says, which also names the back end.
        restart: Discard the rows of an earlier study of this name.
        progress: Wraps the outcomes, e.g. in a progress bar.

    Raises:
        DescriptionError: The table holds rows of another plan or version.
        FormatError: The file is not the table of a study, or cannot be written.
    """
    cases, failed = _readable(cases)
    wanted = {mark for case in cases for mark in case.fingerprints}
    done = {} if path is None else _kept(Path(path), wanted, restart)
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
    return Study(rows, dict(sorted(failures.items())), len(rows) - kept, kept)


def part(path: str | Path) -> Path:
    """The file of the rows of an unfinished study."""
    return Path(f"{path}.part")


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


def _kept(path: Path, wanted: set[str], restart: bool) -> dict[str, dict[str, Row]]:
    """Rows of earlier runs, by fingerprint and motion; only where both motions are there."""
    rows = [
        row
        for file in (path, part(path))
        if file.exists()
        for row in study_table.load(file, unfinished=file != path)
    ]
    if restart:
        return {}
    found: dict[str, dict[str, Row]] = {}
    for row in rows:
        if row.inputs not in wanted:
            raise DescriptionError(
                f"{path} holds another study, or one of another exo_pin ({row.version}: {row.device}, "
                f"{row.gait}, {row.stature_m:g} m, pelvis {row.pelvis}, passive {row.passive}); to continue "
                "it repeat its options, else choose another file, or discard its rows (--restart)"
            )
        found.setdefault(row.inputs, {})[row.motion] = row
    return {mark: rows for mark, rows in found.items() if len(rows) == len(MOTIONS)}


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
    """Linear algebra on one thread: its sums round alike whoever solves a case.

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
