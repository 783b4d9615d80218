"""Run a robustness study: simulated conditions with their seeds in parallel; it can be continued."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from exo_pin.errors import DescriptionError
from exo_pin.study.earlier_rows import computed_again, rows_of
from exo_pin.study.simulated_case import SimulatedCase, SimulatedOutcome, simulate_case
from exo_pin.study.simulated_table import SIMULATED_TABLE, SimulatedRow, condition
from exo_pin.study.workers import appending, check_jobs, one_thread, part, solved

_TASK = 5
"""Runs of one condition that a worker does in one go: they share robot and walk."""


@dataclass(frozen=True, eq=False)
class SimulatedStudy:
    """The result of a robustness study.

    Attributes:
        rows: In the order of the plan: condition by condition, seed by seed.
        failures: Why conditions have no rows, a line each.
        computed: Rows of this run.
        kept: Rows of earlier runs.
        remarks: Which rows of earlier runs were not used, a plain sentence each.
    """

    rows: tuple[SimulatedRow, ...]
    failures: tuple[str, ...]
    computed: int
    kept: int
    remarks: tuple[str, ...] = ()


Progress = Callable[[Iterable[SimulatedOutcome], int], Iterable[SimulatedOutcome]]
"""Wraps the outcomes as they arrive; its second argument is their number."""


def run_simulations(
    cases: Sequence[SimulatedCase],
    path: str | Path | None = None,
    *,
    jobs: int | None = None,
    restart: bool = False,
    progress: Progress = lambda outcomes, _: outcomes,
) -> SimulatedStudy:
    """Run a robustness study, or continue it, as `exo_pin.study.run` does its own.

    Args:
        cases: The plan.
        path: The table (.csv); None: write nothing.
        jobs: Workers; -1: one per core. None: one, or what `joblib.parallel_config` says.
        restart: Discard the rows of an earlier study of this name.
        progress: Wraps the outcomes, e.g. in a progress bar.

    Raises:
        DescriptionError: The table holds rows of another plan, or there cannot be so many workers.
        FormatError: The file is not the table of such a study, or cannot be written.
    """
    check_jobs(jobs)
    done, remarks = ({}, list[str]()) if path is None else _earlier(Path(path), cases, restart=restart)
    kept, failures = len(done), list[str]()
    tasks = [task for case in cases for task in case.without(done).split(_TASK)]
    with one_thread(), appending(path, SIMULATED_TABLE, done.values()) as append:
        for outcome in progress(solved(tasks, simulate_case, jobs), len(tasks)):
            failures += [outcome.failure] if outcome.failure else []
            append(outcome.rows)
            done |= {row.inputs: row for row in outcome.rows}
    rows = tuple(done[mark] for case in cases for mark in case.fingerprints if mark in done)
    if path is not None:
        if rows:
            SIMULATED_TABLE.save(rows, path)
        part(path).unlink(missing_ok=True)
    return SimulatedStudy(rows, tuple(sorted(set(failures))), len(rows) - kept, kept, tuple(remarks))


def _earlier(
    path: Path, cases: Sequence[SimulatedCase], *, restart: bool
) -> tuple[dict[str, SimulatedRow], list[str]]:
    """Rows of earlier runs that may be kept, by fingerprint, and remarks on the others."""
    rows, remarks = rows_of(path, SIMULATED_TABLE, restart=restart)
    wanted = {mark for case in cases for mark in case.fingerprints}
    planned = {(tuple(case.conditions.values()), seed) for case in cases for seed in case.seeds}
    other = [row for row in rows if row.inputs not in wanted]
    for row in other:
        if (condition(row), row.seed) not in planned:
            raise DescriptionError(
                f"{path} holds another study ({row.gait}, {row.device}, {row.controller}, seed {row.seed}); "
                "to continue it repeat its options, else choose another file, or discard its rows (--restart)"
            )
    if other:
        versions = [row.version for row in other]
        remarks.append(computed_again(path, versions, "a device, a controller's or a patient's file"))
    return {row.inputs: row for row in rows if row.inputs in wanted}, remarks
