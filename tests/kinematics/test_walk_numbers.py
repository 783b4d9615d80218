"""Numbers of a walk on a robot: joint rates, local frames, spatiotemporal numbers, outliers."""

from dataclasses import replace

import numpy as np
import pytest

from exo_pin.anatomy import JOINTS, MOVEMENTS
from exo_pin.gait import Gait
from exo_pin.kinematics import (
    curve_outliers,
    deviation_from_parallel,
    joint_frames,
    joint_rates,
    spatiotemporal,
    walk_numbers,
    walking_speed,
)


@pytest.fixture(scope="module")
def recording(gait):
    """Two and a half cycles that do not repeat."""
    walk = gait.repeated(3)
    keep = walk.time <= 2.5 * gait.duration
    return Gait(walk.time[keep], walk.q[keep], base=walk.base[keep])


def test_rounded_times_do_not_keep_the_filter_from_its_work(robot, recording):
    times = recording.time, np.round(recording.time, 3)
    even, rounded = (joint_rates(robot, replace(recording, time=t, events=()), cutoff=6.0) for t in times)
    assert "on an even grid" in rounded.how
    assert "on an even grid" not in even.how
    np.testing.assert_allclose(rounded.dq, even.dq, atol=0.2)
    assert np.abs(rounded.ddq).max() < 1.3 * np.abs(even.ddq).max()


def test_the_joint_frames_are_parallel_and_turn_about_their_axes(robot):
    frames = joint_frames(robot)
    assert [name for name, _, _ in frames] == ["body", *JOINTS]
    assert deviation_from_parallel(robot) < 1e-15
    axes = {name: axis for name, _, axis in frames[1:]}
    for movement, mirrored in zip(MOVEMENTS, (1, -1, -1, 1, 1, -1), strict=True):
        np.testing.assert_allclose(axes[f"left_{movement}"], mirrored * axes[f"right_{movement}"], atol=1e-12)


def test_the_numbers_are_judged_by_the_ranges_that_are_cited(robot, gait):
    found = walk_numbers(robot, gait)
    expected = spatiotemporal(robot, gait)
    assert {name: x.mean for name, x in found.numbers.items()} == {
        name: x.mean for name, x in expected.items()
    }
    assert found.cycles == {"left": 1, "right": 1}
    assert found.left_out == ()
    assert found.usual.keys() == found.verdicts.keys() <= found.numbers.keys()
    assert {usual.source for usual in found.usual.values()} == set(found.citations)
    for name, usual in found.usual.items():
        inside = usual.low <= found.numbers[name].mean <= usual.high
        assert inside == (found.verdicts[name] == "within")


def test_a_walk_without_cycles_has_a_reason_instead_of_numbers(robot, gait):
    found = walk_numbers(robot, Gait(gait.time[:20], gait.q[:20]))
    assert found.missing
    assert (found.numbers, found.cycles, found.left_out, found.citations) == ({}, {}, (), {})


def test_an_outlier_is_found_in_the_curve_at_the_time_and_with_the_size_that_it_has(recording):
    q, base = recording.q.copy(), recording.base.copy()
    q[40, JOINTS.index("right_knee_flexion")] += np.radians(8.0)
    base[60, 2, 3] += 0.05
    assert curve_outliers(recording) == ()
    knee, height = curve_outliers(replace(recording, q=q, base=base))
    assert (knee.curve, knee.time, knee.unit) == ("right_knee_flexion", recording.time[40], "deg")
    assert (height.curve, height.time, height.unit) == ("pelvis_z", recording.time[60], "mm")
    assert knee.off == pytest.approx(8.0, abs=0.1)
    assert height.off == pytest.approx(50.0, abs=0.5)


def test_a_part_of_a_cycle_has_one_speed_for_all_who_need_it(robot, gait):
    """No foot has a whole cycle in 1.3 of them: a stride is estimated. A sixth does not show the speed."""
    walk = gait.repeated(3)

    def part(share):
        keep = walk.time <= share * gait.duration
        return Gait(walk.time[keep], walk.q[keep], base=walk.base[keep])

    found = walk_numbers(robot, part(1.3))
    assert found.estimate is not None
    speed = walking_speed(robot, part(1.3))
    assert speed == found.numbers["speed"].mean
    assert speed == pytest.approx(walking_speed(robot, gait), rel=0.05)  # other events
    assert np.isnan(walking_speed(robot, part(1 / 6)))
