"""Run a study: cases in parallel by joblib; finished rows are kept, so that it can be continued."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import chain, zip_longest
from pathlib import Path

from exo_pin.errors import FormatError
from exo_pin.short_repr import short_repr
from exo_pin.study import study_table
from exo_pin.study.case import Case, Outcome, solve
from exo_pin.study.earlier_rows import Earlier, earlier
from exo_pin.study.study_table import MOTIONS, Row
from exo_pin.study.workers import appending, check_jobs, one_thread, part, solved, workers

Progress = Callable[[Iterable[Outcome], int], Iterable[Outcome]]
"""Wraps the outcomes as they arrive; its second argument is their number."""


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

    __repr__ = short_repr

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
    check_jobs(jobs)
    cases, failed = _readable(cases)
    before = Earlier({}) if path is None else earlier(Path(path), cases, restart=restart)
    done = dict(before.rows)
    kept, failures = len(done) * len(MOTIONS), {}
    todo = [rest for case in cases if (rest := case.without(done)).parts]
    kept_rows = [row for rows in done.values() for row in rows.values()]
    with one_thread(), appending(path, study_table.TABLE, kept_rows) as append:
        outcomes = solved(list(_in_turns(todo, workers(jobs))), solve, jobs)
        for outcome in progress(chain(failed, outcomes), len(failed) + len(todo)):
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
