"""Cross-checks: forward kinematics four ways, inverse against forward kinematics, joint limits, a verdict."""

from exo_pin.crosscheck.convergence import errors_by_step
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
    "FK_TOLERANCE",
    "IK_TOLERANCE",
    "Check",
    "Recovery",
    "check",
    "errors_by_step",
    "forward",
    "recover",
    "recover_noisy",
]
