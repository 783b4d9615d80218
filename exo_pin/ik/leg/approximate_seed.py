"""The closed form of the nearest ideal leg as a start for a leg whose axes are calibrated.

The true leg misses the target by a motion that hardly changes with the angles, so the formula is asked again
for the target moved by what was missed. Each round leaves about a 25th of the error for axes off by 2 degrees
and 10 mm; damped least squares does the rest.
"""

from __future__ import annotations

import numpy as np

from exo_pin.arrays import Array
from exo_pin.ik.leg import closed_form, forward
from exo_pin.ik.leg.constants import IdealLeg
from exo_pin.ik.leg.forward import Matrix, Number
from exo_pin.robot.leg_axes import LegAxes

ROUNDS = 4
BENT = 0.06
"""The knee starts bent by this at least [rad]: from a straight leg the iteration would only creep."""


def angles(leg: LegAxes, ideal: IdealLeg, R: Matrix, p: list[Number]) -> Array:
    """Joint angles (6, m), the best of a few rounds; neither exact nor within the limits."""
    R_asked, p_asked = R, p
    best, least = np.empty((6, np.size(p[0]))), np.full(np.size(p[0]), np.inf)
    for k in range(ROUNDS):
        q = closed_form.angles(ideal, R_asked, p_asked)
        tip = forward.forward(leg, q)
        distance, angle = forward.errors(tip, R, p)
        better = distance + angle < least
        best, least = np.where(better, q, best), np.where(better, distance + angle, least)
        if k + 1 < ROUNDS:
            R_asked, p_asked = _moved(R, p, tip, R_asked, p_asked)
    knee = ideal.bend * (best[3] - ideal.offset[3])
    best[3] = ideal.offset[3] + ideal.bend * np.maximum(knee, BENT)
    return best


def _moved(
    R: Matrix, p: list[Number], tip: forward.Tip, R_asked: Matrix, p_asked: list[Number]
) -> tuple[Matrix, list[Number]]:
    """Target times inverse of what was reached times what was asked."""
    back = forward.transposed(tip.R)
    turn = [[_dot(row, column) for column in zip(*R_asked, strict=True)] for row in back]
    shift = [_dot(row, [a - b for a, b in zip(p_asked, tip.p, strict=True)]) for row in back]
    R_next = [[_dot(row, column) for column in zip(*turn, strict=True)] for row in R]
    return R_next, [x + _dot(row, shift) for x, row in zip(p, R, strict=True)]


def _dot(a: list[Number] | tuple[Number, ...], b: list[Number] | tuple[Number, ...]) -> Number:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
