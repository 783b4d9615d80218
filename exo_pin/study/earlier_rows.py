"""Rows of earlier runs of a study: which are kept, which are computed again, and why."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Sequence
from pathlib import Path

from exo_pin.errors import DescriptionError
from exo_pin.files import read_bytes
from exo_pin.study import study_table
from exo_pin.study.case import Case
from exo_pin.study.study_table import MOTIONS, Row

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


def part(path: str | Path) -> Path:
    """The file of the rows of an unfinished study."""
    return Path(f"{path}.part")


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
    found: dict[str, dict[str, Row]] = {}
    wanted = {mark for case in cases for mark in case.fingerprints}
    other, remarks = list[Row](), list[str]()
    for file in filter(Path.exists, (path, part(path))):
        content = _content(file, unfinished=file != path)
        study_table.check_heading(file, content)
        if restart:
            continue
        rows, unusable = study_table.rows_and_unusable_lines(file, content)
        for row in rows:
            if row.inputs in wanted:
                found.setdefault(row.inputs, {})[row.motion] = row
            else:
                other.append(row)
        if unusable:
            lines = ", ".join(map(str, unusable[:_NAMED])) + ", ..." * (len(unusable) > _NAMED)
            remarks.append(f"{file}: edited or damaged and not used: line {lines}")
    _refuse_another_plan(path, other, cases)
    if other:
        versions = ", ".join(sorted({row.version for row in other})[:_NAMED])
        remarks.append(
            f"{path}: {len(other)} rows of another state of exo_pin (theirs: {versions}), of a device or "
            "of a recording are computed again"
        )
    whole = {mark: rows for mark, rows in found.items() if len(rows) == len(MOTIONS)}
    return Earlier(whole, tuple(remarks))


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
