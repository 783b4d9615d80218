"""A case of a study: one walk on one body, compared on devices under conditions; the input of a worker."""

from __future__ import annotations

import dataclasses
import functools
import hashlib
import math
from collections.abc import Container, Iterator
from dataclasses import dataclass, field

from exo_pin import version
from exo_pin.anatomy import Body
from exo_pin.anatomy.names import SignPreset
from exo_pin.compare import PHASES, Conditions, Loss, compare
from exo_pin.devices import Device
from exo_pin.errors import ExoPinError
from exo_pin.files import read_bytes
from exo_pin.formats import load_gait, open_trial
from exo_pin.gait import Gait, normative_gait, speed_named
from exo_pin.kinematics import plausibility
from exo_pin.short_repr import short_repr
from exo_pin.study.fingerprint import code_digest, fingerprint, plain
from exo_pin.study.study_table import MOTIONS, MotionKind, Row, phase_column


@dataclass(frozen=True, eq=False, kw_only=True)
class Case:
    """One walk on one body.

    Attributes:
        gait: A speed of the normative walk, or the name of a recording.
        path: File of the recording; empty for a speed.
        body: The body that walks; None: that of a marker trial, else `Body.from_stature()`.
        parts: The devices to compare, each with its conditions.
        preset: Sign convention of a recording that does not state it; None: find out.
        version: Of the exo_pin that made the plan; a worker must have the same.
        code: Digest of its code (`fingerprint.code_digest`).
    """

    gait: str
    body: Body | None
    parts: tuple[tuple[Conditions, Device], ...]
    path: str = ""
    preset: SignPreset | None = None
    version: str = field(default_factory=lambda: version.__version__)
    code: str = field(default_factory=code_digest)

    __repr__ = short_repr

    @functools.cached_property
    def fingerprints(self) -> tuple[str, ...]:
        """Of each part: equal if and only if everything that its rows depend on is equal.

        Raises:
            FormatError: The recording cannot be read.
        """
        walk = hashlib.sha256(read_bytes(self.path)).hexdigest() if self.path else ""
        body = None if self.body is None else plain(self.body)
        shared = (self.version, self.code, self.gait, walk, self.preset, body)
        return tuple(
            fingerprint(shared, plain(conditions), plain(device)) for conditions, device in self.parts
        )

    def without(self, done: Container[str]) -> Case:
        """The same case without the parts of these fingerprints."""
        pairs = zip(self.parts, self.fingerprints, strict=True)
        left = [(part, mark) for part, mark in pairs if mark not in done]
        rest = dataclasses.replace(self, parts=tuple(part for part, _ in left))
        # the worker gets the plan's fingerprints, so that it does not read the recording for them again
        vars(rest)["fingerprints"] = tuple(mark for _, mark in left)
        return rest


@dataclass(frozen=True)
class Outcome:
    """The result of a case.

    Attributes:
        case: The case.
        rows: Two for each device, the best motion and the plain copy; empty if it failed.
        failure: Why it failed, in one line; empty if it did not.
    """

    case: Case
    rows: tuple[Row, ...] = ()
    failure: str = ""


def solve(case: Case) -> Outcome:
    """Compare the devices on the walk.

    The outcome holds whatever goes wrong with a recording, so that one bad file does not stop the others.
    """
    if case.version != version.__version__:
        return Outcome(case, failure=_line(case, f"the worker has exo_pin {version.__version__}"))
    try:
        gait, body, doubts = _walk(case)
        rows = [
            row
            for conditions in dict.fromkeys(c for c, _ in case.parts)
            for row in _rows(case, gait, body, doubts, conditions)
        ]
    except ExoPinError as error:
        return Outcome(case, failure=_line(case, str(error)))
    except Exception as error:  # a bug in a reader costs its file, not the whole study
        return Outcome(case, failure=_line(case, f"unexpected {type(error).__name__}: {error}"))
    return Outcome(case, tuple(rows))


def _walk(case: Case) -> tuple[Gait, Body, tuple[str, ...]]:
    """The walk, the body that walks, and how markers speak against it."""
    if not case.path:
        body = case.body or Body.from_stature()
        return normative_gait(speed_named(case.gait), leg_length=body.leg_length), body, ()
    from exo_pin.markers import load_walk
    from exo_pin.markers.trial_person import trial_body

    file = open_trial(case.path)
    trial = load_walk(file) if file.needs_inverse_kinematics else None
    gait = trial.gait if trial else load_gait(file, preset=case.preset)
    return gait, case.body or trial_body(file, trial).body, trial.doubts if trial else ()


def _rows(
    case: Case, gait: Gait, body: Body, doubts: tuple[str, ...], conditions: Conditions
) -> Iterator[Row]:
    """The rows of all devices under one set of conditions."""
    parts = zip(case.parts, case.fingerprints, strict=True)
    devices = {device: mark for (its, device), mark in parts if its == conditions}
    compared = compare(gait, devices, body, conditions=conditions)
    warnings = "; ".join(plausibility(compared.walk.robot, gait, more=doubts).reasons)
    for pair in zip(compared.best, compared.projected, strict=True):
        for motion, loss in zip(MOTIONS, pair, strict=True):
            yield _row(case, loss, motion, conditions, warnings, devices[loss.device])


def _row(
    case: Case, loss: Loss, motion: MotionKind, conditions: Conditions, warnings: str, inputs: str
) -> Row:
    body = loss.walk.robot.body
    assert body is not None  # compare made it
    gait = loss.walk.gait
    phases = {phase_column(phase): 1e3 * loss.by_phase[phase] for phase in PHASES}
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
        pelvis=conditions.pelvis,
        passive=conditions.passive,
        motion=motion,
        sole_rms_mm=1e3 * loss.sole_spread.rms,
        sole_max_mm=1e3 * loss.sole_spread.max,
        foot_rms_mm=1e3 * loss.position_spread.rms,
        foot_max_mm=1e3 * loss.position_spread.max,
        foot_rms_deg=math.degrees(loss.rotation_spread.rms),
        foot_max_deg=math.degrees(loss.rotation_spread.max),
        **phases,
        step_width_mm=1e3 * loss.step_width,
        step_width_lost_mm=1e3 * loss.step_width_lost,
        clearance_mm=1e3 * loss.clearance,
        clearance_lost_mm=1e3 * loss.clearance_lost,
        hip_change_deg=math.degrees(loss.angle_change["hip_flexion"]),
        knee_change_deg=math.degrees(loss.angle_change["knee_flexion"]),
        com_rms_mm=1e3 * loss.com_error,
        doubts=warnings,
        version=case.version,
        inputs=inputs,
    )


def _line(case: Case, words: str) -> str:
    """The words on one line that names the walk."""
    name, line = case.path or case.gait, " ".join(words.split())
    return line if name in line else f"{name}: {line}"
