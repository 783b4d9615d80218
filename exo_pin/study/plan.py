"""The plan of a study: speeds times statures times conditions, and the recordings of a folder."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

from exo_pin import devices as known
from exo_pin.anatomy import Body
from exo_pin.anatomy.human import usual_mass
from exo_pin.anatomy.names import Sex, SignPreset, Speed
from exo_pin.arguments import number, several, word
from exo_pin.compare import Conditions
from exo_pin.devices import Device
from exo_pin.errors import DescriptionError, FormatError
from exo_pin.formats import FORMATS, MARKER_FORMATS
from exo_pin.gait import SPEEDS
from exo_pin.study.case import Case
from exo_pin.study.fingerprint import code_digest

STATURE_RANGE = (1.50, 1.95)
"""Least and largest stature [m] of a study: about the 5th woman and the 97th man of a hundred."""

STATURE_STEP = 0.05
"""Between two statures [m]."""

BOTH_PELVIS_MOTIONS = (Conditions("recorded"), Conditions("device"))
"""The pelvis moves as recorded, or as the device allows."""

_MOST_STATURES = 1000

_MAPPED = {".txt", ".tsv"}
"""Tables that need a mapping of their columns, which a study of many files does not have."""


def statures(
    low: float = STATURE_RANGE[0], high: float = STATURE_RANGE[1], step: float = STATURE_STEP
) -> tuple[float, ...]:
    """Statures from low to high [m].

    Args:
        low: The first [m].
        high: The last [m], included where the steps meet it.
        step: Between two of them [m].

    Raises:
        DescriptionError: They are not in order, or more than 1000.
    """
    for name, value in (("low", low), ("high", high), ("step", step)):
        number(f"{name} of the statures", value, above=0.0)
    if not (low <= high and (high - low) / step < _MOST_STATURES):
        raise DescriptionError(
            f"statures from {low:g} to {high:g} m in steps of {step:g} m: low <= high, a step above 0 and at "
            f"most {_MOST_STATURES} of them are accepted"
        )
    count = int((high - low) / step + 1e-6) + 1
    return tuple(round(low + k * step, 6) for k in range(count))


def plan(
    speeds: Iterable[Speed] = SPEEDS,
    of: Iterable[float] | None = None,
    devices: Iterable[str | Device] = tuple(known.DEVICES),
    *,
    conditions: Sequence[Conditions] = BOTH_PELVIS_MOTIONS,
    mass: float | None = None,
    sex: Sex = "male",
) -> list[Case]:
    """The normative walk: every speed on every stature, body by body.

    Args:
        speeds: Of the normative walk.
        of: Statures [m]; `statures()` if left out.
        devices: Names, device files or records.
        conditions: Under which the devices are compared.
        mass: Of every person [kg]; by `exo_pin.anatomy.human.usual_mass` if left out.
        sex: Of every person.

    Raises:
        UnknownNameError: A speed, device or sex is unknown.
        DescriptionError: A body is not plausible.
    """
    speeds, parts = (
        tuple(word("speed", speed, SPEEDS) for speed in several("speeds", speeds)),
        _parts(conditions, devices),
    )
    code = code_digest()
    return [
        Case(gait=speed, body=body, parts=parts, code=code)
        for body in bodies(statures() if of is None else of, mass=mass, sex=sex)
        for speed in speeds
    ]


def bodies(of: Iterable[float], *, mass: float | None = None, sex: Sex = "male") -> list[Body]:
    """People of average proportions.

    Args:
        of: Their statures [m].
        mass: Of each [kg]; by `exo_pin.anatomy.human.usual_mass` if left out.
        sex: Of each.

    Raises:
        UnknownNameError: The sex is unknown.
        DescriptionError: A body is not plausible.
    """
    return [
        Body.from_stature(stature, mass=round(usual_mass(stature), 3) if mass is None else mass, sex=sex)
        for stature in several("of", of)
    ]


def recordings(
    folder: str | Path,
    on: Sequence[Body | None] = (None,),
    devices: Iterable[str | Device] = tuple(known.DEVICES),
    *,
    conditions: Sequence[Conditions] = BOTH_PELVIS_MOTIONS,
    preset: SignPreset | None = None,
) -> list[Case]:
    """Every file of a folder and the folders in it whose ending is that of a walk or a marker trial.

    Hidden files are left out, and so are tables that need a mapping (.txt, .tsv). Whether a file can be read
    is found out when the study reaches it.

    Args:
        folder: Where the recordings are.
        on: Bodies that walk each recording; None: that of a marker trial, else the default.
        devices: Names, device files or records.
        conditions: Under which the devices are compared.
        preset: Sign convention of files that do not state it.

    Raises:
        FormatError: The folder does not exist, cannot be searched, or holds no such file.
    """
    folder, parts = Path(folder), _parts(conditions, devices)
    if not folder.is_dir():
        raise FormatError(folder, "not a folder" if folder.exists() else "no such folder")
    endings = sorted({*FORMATS, *MARKER_FORMATS} - _MAPPED)
    try:
        names = sorted(
            path.relative_to(folder).as_posix()
            for path in folder.rglob("*")
            if path.suffix.lower() in endings and path.is_file() and not _hidden(path.relative_to(folder))
        )
    except OSError as error:  # a folder in it that vanishes, or that cannot be read
        raise FormatError(folder, f"cannot be searched: {error.strerror}") from None
    if not names:
        raise FormatError(folder, f"holds no recording; one ends in {', '.join(endings)}")
    code = code_digest()
    return [
        Case(gait=name, path=str(folder / name), body=body, parts=parts, preset=preset, code=code)
        for name in names
        for body in on
    ]


def _parts(
    conditions: Iterable[Conditions], devices: Iterable[str | Device]
) -> tuple[tuple[Conditions, Device], ...]:
    """Every device under every condition.

    Raises:
        DescriptionError: The list is empty, or two devices have the same name.
    """
    found = tuple(map(known.find, several("devices", devices)))
    names = [device.name for device in found]
    if len(set(names)) < len(names) or not names:
        given = ", ".join(names) or "none"
        raise DescriptionError(f"devices of a study, each with a name of its own, are needed; given: {given}")
    return tuple((each, device) for each in conditions for device in found)


def _hidden(path: Path) -> bool:
    return any(part.startswith(".") for part in path.parts)
