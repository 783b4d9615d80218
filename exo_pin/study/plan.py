"""The plan of a study: speeds times statures times conditions, and the recordings of a folder."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

from exo_pin import devices as known
from exo_pin.anatomy import Body
from exo_pin.anatomy.human import usual_mass
from exo_pin.anatomy.names import Sex, SignPreset
from exo_pin.compare import Conditions
from exo_pin.devices import Device
from exo_pin.errors import DescriptionError, FormatError, UnknownNameError
from exo_pin.formats import FORMATS, MARKER_FORMATS
from exo_pin.gait import SPEEDS
from exo_pin.study.case import Case

STATURES = (1.50, 1.95)
"""Least and largest stature [m] of a study: about the 5th woman and the 97th man of a hundred."""

STEP = 0.05
"""Between two statures [m]."""

GRANTED = (Conditions("recorded"), Conditions("device"))
"""Both readings of the pelvis."""

_MOST = 1000

_MAPPED = {".txt", ".tsv"}
"""Tables that only a mapping of their columns can read, which a study of many files has not."""


def statures(low: float = STATURES[0], high: float = STATURES[1], step: float = STEP) -> tuple[float, ...]:
    """Statures from low to high [m], the end included where the steps meet it.

    Raises:
        DescriptionError: They are not in order, or more than 1000.
    """
    if not (0 < low <= high and step > 0 and (high - low) / step < _MOST):
        raise DescriptionError(
            f"statures from {low:g} to {high:g} m in steps of {step:g} m: low <= high, a step above 0 and at "
            f"most {_MOST} of them are accepted"
        )
    count = int((high - low) / step + 1e-6) + 1
    return tuple(round(low + k * step, 6) for k in range(count))


def plan(
    speeds: Iterable[str] = SPEEDS,
    of: Iterable[float] | None = None,
    devices: Iterable[str | Device] = tuple(known.DEVICES),
    *,
    conditions: Sequence[Conditions] = GRANTED,
    mass: float | None = None,
    sex: Sex = "male",
) -> list[Case]:
    """The normative walk: every speed on every stature, body by body.

    Args:
        speeds: Of the normative walk.
        of: Statures [m]; `statures()` if left out.
        devices: Names, device files or records.
        conditions: What the devices are granted.
        mass: Of every person [kg]; by `exo_pin.anatomy.human.usual_mass` if left out.
        sex: Of every person.

    Raises:
        UnknownNameError: A speed, device or sex is unknown.
        DescriptionError: A body is not plausible.
    """
    speeds, parts = tuple(speeds), _parts(conditions, devices)
    for speed in speeds:
        if speed not in SPEEDS:
            raise UnknownNameError("speed", speed, SPEEDS)
    return [
        Case(gait=speed, body=body, parts=parts)
        for body in bodies(statures() if of is None else of, mass=mass, sex=sex)
        for speed in speeds
    ]


def bodies(of: Iterable[float], *, mass: float | None = None, sex: Sex = "male") -> list[Body]:
    """People of average proportions.

    Args:
        of: Their statures [m].
        mass: Of each [kg]; by `exo_pin.anatomy.human.usual_mass` if left out.
        sex: Of each.
    """
    return [
        Body.from_stature(stature, mass=round(usual_mass(stature), 3) if mass is None else mass, sex=sex)
        for stature in of
    ]


def recordings(
    folder: str | Path,
    on: Sequence[Body | None] = (None,),
    devices: Iterable[str | Device] = tuple(known.DEVICES),
    *,
    conditions: Sequence[Conditions] = GRANTED,
    preset: SignPreset | None = None,
) -> list[Case]:
    """Every file of a folder and the folders in it whose ending is that of a walk or a marker trial.

    Hidden files are passed by, and tables that need a mapping (.txt, .tsv). Whether a file can be read is
    found when it is its turn.

    Args:
        folder: Where the recordings are.
        on: Bodies that each is put on; None: the one that a marker trial is solved on, else the default.
        devices: Names, device files or records.
        conditions: What the devices are granted.
        preset: Sign convention of files that do not tell it.

    Raises:
        FormatError: It is no folder, or holds no such file.
    """
    folder, parts = Path(folder), _parts(conditions, devices)
    if not folder.is_dir():
        raise FormatError(folder, "not a folder" if folder.exists() else "no such folder")
    endings = sorted({*FORMATS, *MARKER_FORMATS} - _MAPPED)
    names = sorted(
        path.relative_to(folder).as_posix()
        for path in folder.rglob("*")
        if path.suffix.lower() in endings and path.is_file() and not _hidden(path.relative_to(folder))
    )
    if not names:
        raise FormatError(folder, f"holds no recording; one ends in {', '.join(endings)}")
    return [
        Case(gait=name, path=str(folder / name), body=body, parts=parts, preset=preset)
        for name in names
        for body in on
    ]


def _parts(
    conditions: Iterable[Conditions], devices: Iterable[str | Device]
) -> tuple[tuple[Conditions, Device], ...]:
    """Every device under every condition.

    Raises:
        DescriptionError: There is none, or two have the same name.
    """
    found = tuple(map(known.find, devices))
    names = [device.name for device in found]
    if len(set(names)) < len(names) or not names:
        given = ", ".join(names) or "none"
        raise DescriptionError(f"devices of a study, each with a name of its own, are needed; given: {given}")
    return tuple((granted, device) for granted in conditions for device in found)


def _hidden(path: Path) -> bool:
    return any(part.startswith(".") for part in path.parts)
