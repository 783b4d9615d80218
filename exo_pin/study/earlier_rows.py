"""Rows of earlier runs of a study: which are kept, which are computed again, and why."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Sequence
from pathlib import Path

from exo_pin.errors import DescriptionError
from exo_pin.files import read_bytes
from exo_pin.study import study_table
from exo_pin.study.case import Case
from exo_pin.study.record_table import Record, RecordTable
from exo_pin.study.study_table import MOTIONS, Row
from exo_pin.study.workers import part

_NAMED = 5  # lines that a remark names


@dataclasses.dataclass(frozen=True, eq=False)
class Earlier:
    """What is left of earlier runs.

    Attributes:
        rows: By fingerprint and motion; both motions are there.
        remarks: Which rows are not used, a plain sentence each.
    """

    rows: dict[str, dict[str, Row]]
    remarks: tuple[str, ...] = ()


def earlier(path: Path, cases: Sequence[Case], *, restart: bool) -> Earlier:
    """The rows of earlier runs that may be kept.

    A row is kept where its checksum is right and its fingerprint is one of the plan's. Rows of the plan with
    another fingerprint come from another state of exo_pin, of a device or of a recording: they are computed
    again, and so is what an edited or damaged row held.

    Args:
        path: The table of the study; its part is read too.
        cases: The plan.
        restart: Keep none.

    Raises:
        DescriptionError: A row is of another plan, and would be lost.
        FormatError: A file is not the table of a study.
    """
    rows, remarks = rows_of(path, study_table.TABLE, restart=restart)
    wanted = {mark for case in cases for mark in case.fingerprints}
    found: dict[str, dict[str, Row]] = {}
    other = [row for row in rows if row.inputs not in wanted]
    for row in rows:
        if row.inputs in wanted:
            found.setdefault(row.inputs, {})[row.motion] = row
    _refuse_another_plan(path, other, cases)
    if other:
        remarks.append(computed_again(path, [row.version for row in other], "a device or of a recording"))
    whole = {mark: rows for mark, rows in found.items() if len(rows) == len(MOTIONS)}
    return Earlier(whole, tuple(remarks))


def rows_of(path: Path, table: RecordTable[Record], *, restart: bool) -> tuple[list[Record], list[str]]:
    """The rows of a table and of its part, and remarks on lines that are edited or damaged.

    Args:
        path: The table.
        table: Its kind.
        restart: None is wanted: the files are looked at, for no other file is to be overwritten.

    Raises:
        FormatError: A file is no such table.
    """
    found, remarks = list[Record](), list[str]()
    for file in filter(Path.exists, (path, part(path))):
        content = _content(file, unfinished=file != path)
        table.check_heading(file, content)
        if restart:
            continue
        rows, unusable = table.rows_and_unusable_lines(file, content)
        found += rows
        if unusable:
            lines = ", ".join(map(str, unusable[:_NAMED])) + ", ..." * (len(unusable) > _NAMED)
            remarks.append(f"{file}: edited or damaged and not used: line {lines}")
    return found, remarks


def computed_again(path: Path, versions: Sequence[str], of: str) -> str:
    """The remark on rows that are computed again.

    Args:
        path: The table.
        versions: Of exo_pin, of each row.
        of: What else may have changed.
    """
    theirs = ", ".join(sorted(set(versions))[:_NAMED])
    return (
        f"{path}: {len(versions)} rows of another state of exo_pin (theirs: {theirs}), of {of} are computed "
        "again"
    )


def _content(file: Path, *, unfinished: bool) -> str:
    """The text of a table; what is no text makes its line unusable, and so does the end of a cut one."""
    content = read_bytes(file).decode("utf-8-sig", "replace").replace("\r\n", "\n")
    return content[: content.rfind("\n") + 1] if unfinished else content


def _refuse_another_plan(path: Path, rows: Iterable[Row], cases: Sequence[Case]) -> None:
    plan = {
        (case.gait, device.name, conditions.pelvis, conditions.passive, body)
        for case in cases
        for conditions, device in case.parts
        for body in [case.body and (case.body.stature, case.body.mass, case.body.sex)]
    }
    for row in rows:
        key = (row.gait, row.device, row.pelvis, row.passive)
        # a recording without a body of its own may have been walked by any
        if (*key, None) not in plan and (*key, (row.stature_m, row.mass_kg, row.sex)) not in plan:
            whose = f"{row.version}: {row.device}, {row.gait}, {row.stature_m:g} m, pelvis {row.pelvis}"
            raise DescriptionError(
                f"{path} holds another study ({whose}, passive {row.passive}); to continue it repeat its "
                "options, else choose another file, or discard its rows (--restart)"
            )
