"""Normative moments and powers against the table that they were fitted to."""

from __future__ import annotations

import csv

import numpy as np
import pytest

from exo_pin.anatomy import JOINTS
from exo_pin.gait import SPEEDS
from exo_pin.gait.normative_kinetics import normative_moments, normative_powers

COLUMNS = {
    "hip_flexion": ("hip_extensor_moment", -1, "hip_power"),
    "hip_adduction": ("hip_abductor_moment", -1, ""),
    "knee_flexion": ("knee_extensor_moment", -1, "knee_power"),
    "ankle_dorsiflexion": ("ankle_plantarflexor_moment", -1, "ankle_power"),
}
FIT = 0.12  # of a curve's range, but for 4 % around heel strike, where it jumps more than harmonics follow


@pytest.mark.parametrize("speed", SPEEDS)
def test_moments_and_powers_follow_the_source(shared, speed):
    with (shared / "normative_kinetics.csv").open() as file:
        rows = [r for r in csv.DictReader(file) if (r["source"], r["condition"]) == ("schwartz2008", speed)]
    rows = [row for row in rows if 4 <= float(row["percent"]) <= 96]
    at = [int(float(row["percent"])) for row in rows]
    moments, powers = normative_moments(speed).mean, normative_powers(speed).mean
    for movement, (moment, sign, power) in COLUMNS.items():
        column = JOINTS.index(f"left_{movement}")
        for mine, name, s in ((moments, moment, sign), (powers, power, 1)):
            if name:
                theirs = s * np.array([float(row[f"{name}_mean"]) for row in rows])
                error = mine[at, column] - theirs
                assert np.abs(error).max() < FIT * np.ptp(theirs), name
                assert np.corrcoef(mine[at, column], theirs)[0, 1] > 0.995, name


def test_push_off_is_plantarflexion_that_gives_energy():
    moment, power = normative_moments().mean, normative_powers().mean
    ankle = JOINTS.index("left_ankle_dorsiflexion")
    push = slice(45, 56)  # percent of the cycle
    assert moment[push, ankle].min() < -0.8  # [N m/kg]
    assert power[push, ankle].max() > 1.5  # [W/kg]


def test_joints_without_a_curve_are_not_known():
    rotation = JOINTS.index("left_hip_rotation")
    assert np.isnan(normative_moments().mean[:, rotation]).all()
    assert np.isnan(normative_powers().mean[:, JOINTS.index("left_hip_adduction")]).all()
