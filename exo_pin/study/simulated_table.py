"""The table of simulated runs as CSV: one row for each seed of each condition."""

from __future__ import annotations

from dataclasses import dataclass

from exo_pin.study.record_table import RecordTable


@dataclass(frozen=True, kw_only=True)
class SimulatedRow:
    """One simulated run; the unit stands at the end of a name.

    Attributes:
        gait: Name of the speed.
        device: Name of the device.
        stature_m: Of the body.
        mass_kg: Of the body, without the device.
        support: Of the pelvis.
        body_weight_support: Part of the weight of wearer and device.
        controller: Name or file.
        patient: Name or file; `none`: nobody's torque.
        delay_s: From measurement to torque.
        floor_friction: Of the condition.
        mass_error: Of the condition, as a part.
        cycles: That the walk has.
        timestep_s: Of the simulation.
        spread: Of the machines of the runs; 1 is the usual one, 0 none.
        seed: Of this run.
        run_mass_error: Of this run's machine.
        run_length_error: Likewise.
        run_floor_friction: Likewise.
        run_joint_friction_Nm: Likewise.
        verdict: `walks`, `stumbles`, `falls` or `diverges`.
        why: Its reason.
        time_end_s: When the run ended.
        tracking_rms_deg: Joint angles against the walk.
        tracking_max_deg: The largest.
        swing_contact_percent: Of the worse side.
        vertical_force_mean_bw: On both feet, in weights of the robot.
        motor_rms_Nm: Of the motor with the largest.
        motor_share: Of motors in the torques of motors and person.
        saturated_percent: Of the motor that is longest at its limit.
        version: Of exo_pin.
        inputs: Fingerprint of all that the row depends on.
    """

    gait: str
    device: str
    stature_m: float
    mass_kg: float
    support: str
    body_weight_support: float
    controller: str
    patient: str
    delay_s: float
    floor_friction: float
    mass_error: float
    cycles: int
    timestep_s: float
    spread: float
    seed: int
    run_mass_error: float
    run_length_error: float
    run_floor_friction: float
    run_joint_friction_Nm: float  # noqa: N815  the unit stands at the end
    verdict: str
    why: str
    time_end_s: float
    tracking_rms_deg: float
    tracking_max_deg: float
    swing_contact_percent: float
    vertical_force_mean_bw: float
    motor_rms_Nm: float  # noqa: N815
    motor_share: float
    saturated_percent: float
    version: str
    inputs: str


CONDITIONS = (
    "gait",
    "device",
    "stature_m",
    "mass_kg",
    "support",
    "body_weight_support",
    "controller",
    "patient",
    "delay_s",
    "floor_friction",
    "mass_error",
    "cycles",
    "timestep_s",
    "spread",
)
"""Columns that tell one condition from another."""

SIMULATED_TABLE = RecordTable(SimulatedRow, {"gait", "device", "controller", "seed", "verdict", "inputs"})
"""The table of such rows."""


def condition(row: SimulatedRow) -> tuple[object, ...]:
    """The condition of a row, by `CONDITIONS`."""
    return tuple(getattr(row, name) for name in CONDITIONS)
