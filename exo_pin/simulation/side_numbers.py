"""Tracking and effort of each leg: who of motors and person does how much on which side."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exo_pin.anatomy import JOINTS, SIDES
from exo_pin.anatomy.names import Side
from exo_pin.simulation.simulated_walk import SimulatedWalk
from exo_pin.simulation.walk_verdict import counted, driven_joints


@dataclass(frozen=True)
class SideNumbers:
    """Numbers of one leg: its driven joints together, on the steps that count.

    Attributes:
        tracking_rms_deg: Joint angles against the walk.
        motor_rms: Torque of the motors [N m].
        motor_share: Of motors in the torques of motors and person.
    """

    tracking_rms_deg: float
    motor_rms: float
    motor_share: float

    def facts(self) -> dict[str, float]:
        """Plain values for JSON; NaN where neither gives a torque."""
        return {
            "tracking_rms_deg": self.tracking_rms_deg,
            "motor_rms_Nm": self.motor_rms,
            "motor_share": self.motor_share,
        }


def by_side(run: SimulatedWalk) -> dict[Side, SideNumbers]:
    """The numbers of the left and the right leg."""
    rows, driven = counted(run), driven_joints(run)
    error = np.degrees(run.q - run.reference.q[: len(run.q)])[rows]
    motor, person = run.motor[rows], run.person[rows]
    found = {}
    for side in SIDES:
        columns = driven & np.array([name.startswith(side) for name in JOINTS])
        motors, persons = (np.abs(x[:, columns]).sum() for x in (motor, person))
        both = float(motors + persons)
        found[side] = SideNumbers(
            tracking_rms_deg=float(np.sqrt(np.mean(error[:, columns] ** 2))),
            motor_rms=float(np.sqrt(np.mean(motor[:, columns] ** 2))),
            motor_share=float(motors) / both if both else float("nan"),
        )
    return found
