"""Everyday adjustments of a walk: time, amplitude, stride and clearance, sides, blends, ramps, smoothing."""

from exo_pin.edit.blend import blended, transitioned
from exo_pin.edit.check import Recheck, recheck
from exo_pin.edit.feet import strided
from exo_pin.edit.joints import filtered, mirrored, ramped, retimed, scaled, symmetrised

__all__ = [
    "Recheck",
    "blended",
    "filtered",
    "mirrored",
    "ramped",
    "recheck",
    "retimed",
    "scaled",
    "strided",
    "symmetrised",
    "transitioned",
]
