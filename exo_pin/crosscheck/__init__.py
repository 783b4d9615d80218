"""Cross-checks: forward kinematics and inverse dynamics four ways, inverse kinematics, limits, a verdict."""

from exo_pin.crosscheck.convergence import errors_by_step
from exo_pin.crosscheck.dynamics_witnesses import DYNAMICS_TOLERANCE, inverse_dynamics
from exo_pin.crosscheck.recovery import (
    ANGLE_TOLERANCE,
    BENT_KNEE,
    IK_TOLERANCE,
    Recovery,
    recover,
    recover_noisy,
)
from exo_pin.crosscheck.verdict import Check, check
from exo_pin.crosscheck.witnesses import FK_TOLERANCE, forward

__all__ = [
    "ANGLE_TOLERANCE",
    "BENT_KNEE",
    "DYNAMICS_TOLERANCE",
    "FK_TOLERANCE",
    "IK_TOLERANCE",
    "Check",
    "Recovery",
    "check",
    "errors_by_step",
    "forward",
    "inverse_dynamics",
    "recover",
    "recover_noisy",
]
