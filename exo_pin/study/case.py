"""A case: one walk on one body, to be put through devices under conditions; what a worker is given."""

from __future__ import annotations

import dataclasses
import functools
import hashlib
import math
from collections.abc import Container, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from exo_pin import version
from exo_pin.anatomy import Body
from exo_pin.anatomy.names import SignPreset
from exo_pin.compare import PHASES, Conditions, Loss, compare
from exo_pin.description import sources
from exo_pin.devices import Device
from exo_pin.errors import ExoPinError
from exo_pin.files import read_bytes
from exo_pin.formats import load_gait, open_trial
from exo_pin.gait import Gait, implausibilities, normative_gait
from exo_pin.study.study_table import MOTIONS, Row, phase_column

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

_DIGITS = 16
"""Hexadecimal digits of a fingerprint: a collision among a million rows is a matter of 1 in 10 million."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Case:
    """One walk on one body.

    Attributes:
        gait: A speed of the normative walk, or what a recording is called.
        path: File of the recording; empty for a speed.
        body: Who walks; None: the body that a marker trial is solved on, else `Body.from_stature()`.
        parts: The devices to be put through the walk, each with what it is granted.
        preset: Sign convention of a recording that does not tell it; None: find out.
        version: Of the exo_pin that made the plan, which a worker must have too.
    """

    gait: str
    body: Body | None
    parts: tuple[tuple[Conditions, Device], ...]
    path: str = ""
    preset: SignPreset | None = None
    version: str = field(default_factory=lambda: version.__version__)

    @functools.cached_property
    def fingerprints(self) -> tuple[str, ...]:
        """One for each part: equal if and only if everything that its rows depend on is equal.

        Raises:
            FormatError: The recording cannot be read.
        """
        walk = hashlib.sha256(read_bytes(self.path)).hexdigest() if self.path else ""
        body = None if self.body is None else _plain(self.body)
        shared = (self.version, _code(), self.gait, walk, self.preset, body)
        return tuple(
            hashlib.sha256(repr((shared, _plain(granted), _plain(device))).encode()).hexdigest()[:_DIGITS]
            for granted, device in self.parts
        )

    def without(self, done: Container[str]) -> Case:
        """The same case without the parts of these fingerprints."""
        pairs = zip(self.parts, self.fingerprints, strict=True)
        left = [(part, mark) for part, mark in pairs if mark not in done]
        rest = dataclasses.replace(self, parts=tuple(part for part, _ in left))
        # the plan's are carried to the worker, and the recording is not read again for them
        vars(rest)["fingerprints"] = tuple(mark for _, mark in left)
        return rest


@dataclass(frozen=True)
class Outcome:
    """What became of a case.

    Attributes:
        case: The case.
        rows: Two for each device, the best motion and the plain copy; none if it failed.
        failure: Why it failed, in one line; empty if it did not.
    """

    case: Case
    rows: tuple[Row, ...] = ()
    failure: str = ""


def solve(case: Case) -> Outcome:
    """Put the devices through the walk.

    Whatever goes wrong with a recording is told in the outcome, so that one bad file does not stop the rest.
    """
    if case.version != version.__version__:
        return Outcome(case, failure=_line(case, f"the worker has exo_pin {version.__version__}"))
    try:
        gait, body = _walk(case)
        rows = [
            row
            for granted in dict.fromkeys(c for c, _ in case.parts)
            for row in _rows(case, gait, body, granted)
        ]
    except ExoPinError as error:
        return Outcome(case, failure=_line(case, str(error)))
    except Exception as error:  # a reader's bug: it shall cost this file, not the night's work
        return Outcome(case, failure=_line(case, f"unexpected {type(error).__name__}: {error}"))
    return Outcome(case, tuple(rows))


def _walk(case: Case) -> tuple[Gait, Body]:
    """The walk and who walks."""
    if not case.path:
        body = case.body or Body.from_stature()
        return normative_gait(case.gait, leg_length=body.leg_length), body
    file = open_trial(case.path)
    if file.needs_inverse_kinematics:
        from exo_pin.markers import load_walk

        trial = load_walk(file)
        return trial.gait, case.body or trial.body
    return load_gait(file, preset=case.preset), case.body or Body.from_stature()


def _rows(case: Case, gait: Gait, body: Body, granted: Conditions) -> Iterator[Row]:
    """The rows of all devices under one set of conditions."""
    parts = zip(case.parts, case.fingerprints, strict=True)
    devices = {device: mark for (conditions, device), mark in parts if conditions == granted}
    compared = compare(gait, devices, body, conditions=granted)
    doubtful = "; ".join(implausibilities(gait))
    for pair in zip(compared.best, compared.projected, strict=True):
        for motion, loss in zip(MOTIONS, pair, strict=True):
            yield _row(case, loss, motion, granted, doubtful, devices[loss.device])


def _row(case: Case, loss: Loss, motion: str, granted: Conditions, doubtful: str, inputs: str) -> Row:
    body = loss.walk.robot.body
    assert body is not None  # compare made it
    gait, facts = loss.walk.gait, loss.facts()
    phases = {phase_column(phase): _nan(facts["sole_error_by_phase_mm"][phase]) for phase in PHASES}
    return Row(
        gait=case.gait,
        source=gait.source,
        samples=len(gait),
        duration_s=float(gait.duration),
        stature_m=body.stature,
        mass_kg=body.mass,
        sex=body.sex,
        device=loss.device.name,
        motors=loss.device.motors,
        pelvis=granted.pelvis,
        passive=granted.passive,
        motion=motion,
        sole_rms_mm=facts["sole_error_mm"]["rms"],
        sole_max_mm=facts["sole_error_mm"]["max"],
        foot_rms_mm=facts["position_error_mm"]["rms"],
        foot_max_mm=facts["position_error_mm"]["max"],
        foot_rms_deg=facts["rotation_error_deg"]["rms"],
        foot_max_deg=facts["rotation_error_deg"]["max"],
        **phases,
        step_width_mm=_nan(facts["step_width_mm"]),
        step_width_lost_mm=_nan(facts["step_width_lost_mm"]),
        clearance_mm=_nan(facts["clearance_mm"]),
        clearance_lost_mm=_nan(facts["clearance_lost_mm"]),
        hip_change_deg=facts["angle_change_deg"]["hip_flexion"],
        knee_change_deg=facts["angle_change_deg"]["knee_flexion"],
        com_rms_mm=facts["com_error_mm"],
        doubts=doubtful,
        version=case.version,
        inputs=inputs,
    )


@functools.cache
def _code() -> str:
    """Digest of what the numbers follow from: this package, without the rooms that only show them."""
    package = Path(__file__).parents[1]
    shown = {package / room for room in ("cli", "report", "viewer")}
    files = sorted(file for file in package.rglob("*.py") if not shown & set(file.parents))
    files += sorted(sources().glob("*.xacro"))
    return hashlib.sha256(b"".join(file.read_bytes() for file in files)).hexdigest()


def _plain(record: DataclassInstance) -> dict[str, Any]:
    """A record's fields as values whose text is the same in every process."""
    values = {field.name: getattr(record, field.name) for field in dataclasses.fields(record)}
    return {name: dict(value) if isinstance(value, Mapping) else value for name, value in values.items()}


def _nan(value: float | None) -> float:
    return math.nan if value is None else value


def _line(case: Case, words: str) -> str:
    """The words in one line that names the walk."""
    name, line = case.path or case.gait, " ".join(words.split())
    return line if name in line else f"{name}: {line}"
