"""A stride that the recording does not hold whole: estimated from the best that its events tell, and said."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from exo_pin.gait import Event, Gait, leg_cycles, normative_gait, stride_estimate, walk_estimate
from exo_pin.kinematics import walk_numbers

WALK = normative_gait("free").repeated(3)
T = WALK.duration / 3
SAMPLE = T / 100


def part(start, end, kinds=("heel_strike", "toe_off")):
    """The walk between two moments in strides, its clock kept."""
    keep = (WALK.time >= start * T - 1e-9) & (WALK.time <= end * T + 1e-9)
    time = WALK.time[keep]
    events = [e for e in WALK.events if time[0] <= e.time <= time[-1] and e.kind in kinds]
    return Gait(time, WALK.q[keep], base=WALK.base[keep], events=events, source="a part")


def test_from_toe_off_to_toe_off_is_a_stride():
    """Left toe-off at 0.59 and 1.59 strides, one strike of each foot between them."""
    estimate = walk_estimate(part(0.55, 1.65))
    assert "toe-off to toe-off" in estimate.by
    assert estimate.side == "left"
    assert estimate.strike == pytest.approx(T)
    assert estimate.duration == pytest.approx(T, abs=SAMPLE)


def test_without_toe_offs_the_step_is_doubled():
    estimate = walk_estimate(part(0.55, 1.65, kinds=("heel_strike",)))
    assert "twice the step time" in estimate.by
    assert estimate.duration == pytest.approx(T, abs=2 * SAMPLE)


def test_a_whole_stride_of_one_foot_is_no_estimate_of_the_walk_but_one_of_the_other_foot():
    walk = part(0.9, 2.1)  # left strikes at 1 and 2, right at 1.5 only
    assert walk_estimate(walk) is None
    assert stride_estimate(walk, "right").by == "the left foot's stride"


@given(st.floats(0.0, 1.9), st.floats(0.05, 1.0))
def test_the_estimated_cycles_cover_the_recording_and_meet_at_the_strike(start, length):
    walk = part(start, start + length) if length * 100 > 3 else part(start, start + 0.05)
    estimate = walk_estimate(walk)
    if estimate is None:
        return
    spans = estimate.cycles(float(walk.time[0]), float(walk.time[-1]))
    assert spans[0][0] <= walk.time[0] + 1e-9
    assert spans[-1][1] >= walk.time[-1] - 1e-9
    assert all(b[0] == a[1] for a, b in pairwise(spans))
    assert min(abs(t - estimate.strike) for span in spans for t in span) < 1e-9


def test_spans_that_are_no_strides_are_not_replaced_by_an_estimate():
    """Half a turn of the pelvis in every stride: the person turns on the spot."""
    walk = part(0.9, 2.1)
    base = np.array(walk.base)
    angle = np.linspace(0, np.pi, len(base))
    base[:, 0, 0], base[:, 0, 1] = np.cos(angle), -np.sin(angle)
    base[:, 1, 0], base[:, 1, 1] = np.sin(angle), np.cos(angle)
    base[:, :2, 2] = base[:, 2, :2] = 0.0
    base[:, 2, 2] = 1.0
    turning = replace(walk, base=base)
    assert walk_estimate(turning) is None
    assert leg_cycles(turning) == ()


def test_steps_that_no_person_takes_give_no_estimate():
    events = [Event(T, "heel_strike", "left"), Event(T + 0.02, "heel_strike", "right")]
    assert walk_estimate(replace(part(0.9, 1.3), events=events)) is None


def test_numbers_of_an_estimated_stride_are_those_of_the_whole_walk(robot):
    """The same walk whole is the independent path; events lie on samples, a hundredth of the stride apart."""
    whole, half = walk_numbers(robot, WALK), walk_numbers(robot, part(0.55, 1.65))
    assert (whole.estimate, half.missing) == (None, "")
    assert half.estimate is not None
    assert half.cycles == {"left": 0, "right": 0}
    for name in ("cadence", "speed", "stride_time", "stride_length", "left_stance", "right_step_time"):
        assert half.numbers[name].mean == pytest.approx(whole.numbers[name].mean, rel=0.02), name


@pytest.mark.parametrize("turn", [0.0, 2.0])
def test_a_doubled_step_has_length_and_speed_along_the_heading(robot, turn):
    """The normal walk's steps are equal, so its whole strides are the truth."""
    assert "speed" not in walk_numbers(robot, part(0.95, 1.55)).numbers  # no whole stance: a treadmill?
    half = part(0.95, 1.62)
    assert "twice the step time" in walk_estimate(half).by
    base = np.array(half.base)
    c, s = np.cos(turn), np.sin(turn)
    R = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    base[:, :3, 3] = base[:, :3, 3] @ R.T
    base[:, :3, :3] = R @ base[:, :3, :3]
    whole, found = walk_numbers(robot, WALK).numbers, walk_numbers(robot, replace(half, base=base)).numbers
    assert found["speed"].mean == pytest.approx(whole["speed"].mean, rel=0.05)
    assert found["right_step_length"].mean == pytest.approx(whole["right_step_length"].mean, rel=0.05)


def test_a_half_stride_of_a_laboratory_is_alike_in_report_player_and_numbers(robot, shared):
    """Lai-Arnold subject 6: left toe-offs at 0.12 and 1.31 s by its force plates, one strike of each foot."""
    from exo_pin.formats import load_forces, load_gait
    from exo_pin.kinematics import with_plates
    from exo_pin.viewer.scenes.compiler import phase_cycles

    folder = shared.parent / "trials" / "lai_arnold_walk"
    gait = load_gait(folder / "walking1_ik.mot")
    gait = with_plates(robot, gait, load_forces(folder / "walking1_forces.mot"))
    estimate = walk_numbers(robot, gait).estimate
    assert estimate.duration == pytest.approx(1.185, abs=0.01)  # one frame of 100 Hz
    assert phase_cycles(gait).estimate == str(estimate)
    left = leg_cycles(gait)[0]
    assert str(estimate) in left.note
