"""Worst case: it is the largest of its cases, and heavier, faster, unsupported walks load more."""

import pytest

from exo_pin.anatomy import Body
from exo_pin.gait import SPEEDS
from exo_pin.sizing import QUANTITIES, find_motor, geared, worst_cases
from exo_pin.sizing.worst_case import SUPPORTS


@pytest.fixture(scope="module")
def found():
    motor = find_motor("maxon-ec-90-flat-48v")
    return {
        worst.movement: worst for worst in worst_cases("lokomat", motor=motor, people=[Body.from_stature()])
    }


def test_every_driven_movement_has_all_cases(found):
    assert set(found) == {"hip_flexion", "knee_flexion"}
    for worst in found.values():
        assert len(worst.loads) == len(SPEEDS) * len(SUPPORTS)


def test_the_worst_is_at_full_weight_and_the_highest_speed(found):
    value, case = found["hip_flexion"].worst("peak_torque")
    assert (case.speed, case.support) == ("very_fast", 0.0)
    assert all(load.peak_torque <= value for _, load in found["hip_flexion"].loads)


def test_facts_name_every_quantity_with_its_case(found):
    facts = found["knee_flexion"].facts()
    for name in QUANTITIES:
        assert facts[name]["value"] > 0.0
        assert facts[name]["case"]["speed"] in SPEEDS


def test_the_ratio_that_comes_nearest_is_the_best_for_the_worst_walk(found):
    worst, motor = found["hip_flexion"], find_motor("maxon-ec-90-flat-48v")
    loads = [load for _, load in worst.loads]
    assert not worst.fits  # 90 W do not drive a very fast hip
    best = worst.ratios.best
    for ratio in (0.8 * best.ratio, 1.25 * best.ratio):
        assert geared(loads, motor, ratio).worst >= best.worst


def test_the_map_has_the_largest_torque_of_every_speed_and_support(found):
    from exo_pin.report.draw.worst_case_map import worst_case_map

    svg = worst_case_map(list(found.values()), "lokomat").svg
    assert svg.count("hip flexion") == 1
    value, _ = found["hip_flexion"].worst("peak_torque")
    assert f">{100 * value / found['hip_flexion'].effort:.0f}<" in svg
