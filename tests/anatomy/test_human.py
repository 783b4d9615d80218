"""Human limits and averages: ranges hold those of the device, masses grow as people's do."""

import math

import pytest

from exo_pin.anatomy import JOINTS, SIDES, Body
from exo_pin.anatomy.anthropometry import DE_LEVA
from exo_pin.anatomy.human import EXTREME_RANGES, HYPEREXTENDED_KNEE, usual_mass
from exo_pin.anatomy.sizes import DEFAULT_LIMITS

ROUNDED = 2e-4  # the table's masses have four digits


def test_extreme_ranges_hold_the_default_limits_of_every_joint():
    assert tuple(EXTREME_RANGES) == JOINTS
    for joint, (lower, upper) in EXTREME_RANGES.items():
        assert lower < DEFAULT_LIMITS[joint][0] < DEFAULT_LIMITS[joint][1] < upper


def test_both_sides_have_the_same_ranges():
    for joint in JOINTS[:6]:
        assert EXTREME_RANGES[joint] == EXTREME_RANGES[joint.replace("left", "right")]


def test_a_knee_may_hyperextend_but_not_for_long():
    for side in SIDES:
        assert EXTREME_RANGES[f"{side}_knee_flexion"][0] < HYPEREXTENDED_KNEE < math.radians(-5)


def test_mass_grows_with_the_square_of_the_stature_from_the_default_person():
    default = Body.from_stature()
    assert usual_mass(default.stature) == pytest.approx(default.mass)
    assert usual_mass(2 * default.stature) == pytest.approx(4 * default.mass)


@pytest.mark.parametrize("sex", ["male", "female"])
def test_the_segments_of_the_table_make_a_whole_person(sex):
    table = DE_LEVA[sex]
    twice = sum(segment.mass for name, segment in table.items() if name not in ("head", "trunk"))
    assert table["head"].mass + table["trunk"].mass + 2 * twice == pytest.approx(1.0, abs=ROUNDED)


@pytest.mark.parametrize("sex", ["male", "female"])
def test_every_segment_is_thinner_than_long_and_weighs_within_its_ends(sex):
    for segment in DE_LEVA[sex].values():
        sagittal, transverse, longitudinal = segment.gyration
        assert longitudinal < min(sagittal, transverse) < 0.5
        assert 0.3 < segment.centre < 0.6
