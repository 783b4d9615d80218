"""Everyday adjustments of a walk: time, amplitude, stride and clearance, sides, blends, ramps, smoothing."""

from exo_pin.edit.blend import blended, transitioned
from exo_pin.edit.joint_curves import filtered, lasting, mirrored, ramped, retimed, scaled, symmetrised
from exo_pin.edit.recheck import Recheck, recheck
from exo_pin.edit.stride_scaling import strided

__all__ = [
    "Recheck",
    "blended",
    "filtered",
    "lasting",
    "mirrored",
    "ramped",
    "recheck",
    "retimed",
    "scaled",
    "strided",
    "symmetrised",
    "transitioned",
]
