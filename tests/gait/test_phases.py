"""Phases of the cycle: divided at the own toe-off of each stride; one estimated or assumed is named."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from exo_pin.gait import Event, Gait
from exo_pin.gait.phases import PHASES, division, masks, percent, toe_off

TIME = np.linspace(0, 3, 301)


def walk(*events):
    made = tuple(Event(t, "heel_strike" if kind == "s" else "toe_off", "left") for t, kind in events)
    return Gait(TIME, np.zeros((301, 12)), events=made)


@given(st.floats(0.2, 0.8), st.floats(0.2, 0.8))
def test_each_stride_is_divided_at_its_own_toe_off(first, second):
    """Two strides of 1 s, as of a run and of a walk: percent is the time in each of them."""
    gait = walk((0.5, "s"), (0.5 + first, "o"), (1.5, "s"), (1.5 + second, "o"), (2.5, "s"))
    inside = (TIME > 0.505) & (TIME < 2.495)
    np.testing.assert_allclose(percent(gait, "left")[inside], 100 * ((TIME[inside] - 0.5) % 1), atol=1e-6)
    found = masks(gait, "left")
    stance = sum(found[name].astype(int) for name in list(PHASES)[:4]).astype(bool)
    late = np.where(TIME < 1.5, 0.5 + first, 1.5 + second)
    on_time = np.where(TIME < 1.5, 0.5, 1.5)
    near = np.abs(TIME - late) < 1e-6
    assert np.array_equal(stance[inside & ~near], ((on_time <= TIME) & (late > TIME))[inside & ~near])
    assert sum(mask[inside].astype(int) for mask in found.values()).min() == 1
    assert toe_off(gait, "left") == (pytest.approx(50 * (first + second)), "events")


def test_a_stance_whose_stride_is_cut_ends_at_the_usual_toe_off():
    gait = walk((0.5, "s"), (0.9, "o"), (1.5, "s"), (1.9, "o"))
    assert percent(gait, "left")[189] == pytest.approx(39.0)


def test_without_toe_offs_perry_s_is_assumed_and_said():
    gait = walk((0.5, "s"), (1.5, "s"), (2.5, "s"))
    assert toe_off(gait, "left") == (62.0, "assumed")
    assert "62 % (left, assumed)" in division(gait)
    assert masks(gait, "left")["initial swing"][115]
    assert masks(gait, "left")["pre-swing"][110]


def test_a_half_stride_is_divided_by_the_estimated_one():
    """Toe-off to toe-off 1.0 s, stance 0.4 s."""
    gait = walk((0.3, "o"), (0.9, "s"), (1.3, "o"))
    assert toe_off(gait, "left") == (pytest.approx(40.0), "estimated stride")
    assert percent(gait, "left")[100] == pytest.approx(10.0)
    assert percent(gait, "left")[60] == pytest.approx(70.0)
