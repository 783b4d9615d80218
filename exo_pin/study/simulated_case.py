"""A case of a robustness study: one condition simulated with several seeds; the input of a worker."""

from __future__ import annotations

import dataclasses
import functools
import hashlib
from collections.abc import Container, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from exo_pin import version
from exo_pin.anatomy import Body
from exo_pin.anatomy.names import Speed
from exo_pin.devices import Device
from exo_pin.errors import ExoPinError
from exo_pin.files import read_bytes
from exo_pin.gait import normative_gait
from exo_pin.robot import load_robot
from exo_pin.study.fingerprint import code_digest, fingerprint, plain
from exo_pin.study.simulated_table import SimulatedRow

if TYPE_CHECKING:
    from exo_pin.simulation import Plant, Run
    from exo_pin.simulation.pelvis_support import SupportName

NOBODY = "none"
"""The patient of runs in which the motors do it all."""

_MASS, _LENGTH, _FRICTION, _JOINT_FRICTION, _NOISE = 0.05, 0.01, 0.25, 2.0, 2e-4
"""How far the machines of the runs differ (a choice): mass, length, friction of the floor (parts, both ways),
the joints' friction (from 0 on [N m]), noise of the encoders [rad]."""

_ROUGHEST = 2.0
"""Largest friction of a floor."""


@dataclass(frozen=True, eq=False, kw_only=True)
class SimulatedCase:
    """One condition with its seeds.

    Attributes:
        gait: A speed of the normative walk.
        body: The body that walks.
        device: What it wears.
        support: Of the pelvis.
        body_weight_support: Part of the weight of wearer and device.
        controller: Name, or `file.py:Class`.
        patient: Name or TOML file; `none`: the motors do it all.
        delay: From measurement to torque [s].
        floor_friction: Coulomb coefficient, of which the runs differ.
        mass_error: The machines are heavier by this part, of which the runs differ.
        cycles: How often the walk is walked.
        timestep: [s].
        spread: Scales how far the machines of the runs differ; 0: they are all alike.
        seeds: One run each.
        version: Of the exo_pin that made the plan; a worker must have the same.
        code: Digest of its code (`fingerprint.code_digest`).
    """

    gait: Speed
    body: Body
    device: Device
    support: SupportName = "soft"
    body_weight_support: float = 0.0
    controller: str = "pd"
    patient: str = NOBODY
    delay: float = 0.0
    floor_friction: float = 0.8
    mass_error: float = 0.0
    cycles: int = 10
    timestep: float = 0.001
    spread: float = 1.0
    seeds: tuple[int, ...] = (0,)
    version: str = field(default_factory=lambda: version.__version__)
    code: str = field(default_factory=code_digest)

    @property
    def conditions(self) -> dict[str, Any]:
        """Cells of the table that all runs of the case share."""
        return {
            "gait": self.gait,
            "device": self.device.name,
            "stature_m": self.body.stature,
            "mass_kg": self.body.mass,
            "support": self.support,
            "body_weight_support": self.body_weight_support,
            "controller": self.controller,
            "patient": self.patient,
            "delay_s": self.delay,
            "floor_friction": self.floor_friction,
            "mass_error": self.mass_error,
            "cycles": self.cycles,
            "timestep_s": self.timestep,
            "spread": self.spread,
        }

    @functools.cached_property
    def fingerprints(self) -> tuple[str, ...]:
        """Of each seed: equal if and only if everything that its row depends on is equal.

        Raises:
            FormatError: A controller's or patient's file cannot be read.
        """
        files = [_digest(self.controller.rpartition(":")[0] or self.controller), _digest(self.patient)]
        shared = (self.version, self.code, plain(self.body), plain(self.device), self.conditions, files)
        return tuple(fingerprint(shared, seed) for seed in self.seeds)

    def without(self, done: Container[str]) -> SimulatedCase:
        """The same case without the seeds of these fingerprints."""
        pairs = zip(self.seeds, self.fingerprints, strict=True)
        return dataclasses.replace(self, seeds=tuple(seed for seed, mark in pairs if mark not in done))

    def split(self, size: int) -> Iterator[SimulatedCase]:
        """The same condition in tasks of at most `size` runs."""
        for k in range(0, len(self.seeds), size):
            yield dataclasses.replace(self, seeds=self.seeds[k : k + size])

    def plant(self, seed: int) -> Plant:
        """The machine of a run: equal seeds differ alike in all conditions, which makes them comparable."""
        from exo_pin.simulation import Plant

        spread = self.spread
        mass, length, floor, joints = np.random.default_rng(seed).uniform(-1.0, 1.0, 4).tolist()
        return Plant(
            mass_error=self.mass_error + _MASS * spread * mass,
            length_error=_LENGTH * spread * length,
            floor_friction=min(self.floor_friction * (1.0 + _FRICTION * spread * floor), _ROUGHEST),
            joint_friction=_JOINT_FRICTION * spread * (1.0 + joints) / 2.0,
            noise=_NOISE * spread,
            delay=self.delay,
        )


@dataclass(frozen=True)
class SimulatedOutcome:
    """The result of a case.

    Attributes:
        case: The case.
        rows: One for each seed; empty if it failed.
        failure: Why it failed, in one line; empty if it did not.
    """

    case: SimulatedCase
    rows: tuple[SimulatedRow, ...] = ()
    failure: str = ""


def simulate_case(case: SimulatedCase) -> SimulatedOutcome:
    """Simulate all seeds of a case; the outcome holds what goes wrong."""
    if case.version != version.__version__:
        return SimulatedOutcome(case, failure=f"the worker has exo_pin {version.__version__}")
    try:
        robot = load_robot(case.body, device=case.device)
        return SimulatedOutcome(case, tuple(_rows(case, robot)))
    except ExoPinError as error:
        words = " ".join(str(error).split())
        return SimulatedOutcome(case, failure=f"{case.gait}, {case.device.name}, {case.controller}: {words}")


def _rows(case: SimulatedCase, robot: Any) -> Iterator[SimulatedRow]:
    from exo_pin.simulation import simulate

    gait = normative_gait(case.gait, leg_length=case.body.leg_length)
    for seed, mark in zip(case.seeds, case.fingerprints, strict=True):
        run = simulate(
            robot,
            gait,
            case.controller,
            patient=None if case.patient == NOBODY else case.patient,
            support=case.support,
            body_weight_support=case.body_weight_support,
            cycles=case.cycles,
            timestep=case.timestep,
            plant=case.plant(seed),
            seed=seed,
        )
        yield _row(case, run, seed, mark)


def _row(case: SimulatedCase, run: Run, seed: int, mark: str) -> SimulatedRow:
    found, plant = run.numbers, run.plant
    return SimulatedRow(
        **case.conditions,
        seed=seed,
        run_mass_error=plant.mass_error,
        run_length_error=plant.length_error,
        run_floor_friction=plant.floor_friction,
        run_joint_friction_Nm=plant.joint_friction,
        verdict=run.verdict.word,
        why=run.verdict.why,
        time_end_s=float(run.time[-1]),
        tracking_rms_deg=found.tracking_rms_deg,
        tracking_max_deg=found.tracking_max_deg,
        swing_contact_percent=max(found.swing_contact_percent.values()),
        vertical_force_mean_bw=found.vertical_force_mean_bw,
        motor_rms_Nm=max(found.motor_rms.values()),
        motor_share=found.motor_share,
        saturated_percent=max(found.saturated.values(), default=0.0),
        version=case.version,
        inputs=mark,
    )


def _digest(name: str) -> str:
    """Of a file's content; empty for a name that is none."""
    return hashlib.sha256(read_bytes(name)).hexdigest() if Path(name).is_file() else ""
