"""Stride checks on feet drawn by hand: each refuses what it is for, and what is just within passes."""

from __future__ import annotations

import numpy as np
import pytest

from exo_pin.anatomy import SIDES
from exo_pin.errors import GaitError
from exo_pin.gait.stride_checks import Feet, candidate_strides
from exo_pin.gait.walking_bouts import walking_events
from exo_pin.gait.zeni_method import candidates

RATE = 100.0  # [Hz]
PERIOD, STANCE = 1.2, 0.6  # [s] a stride; the part of it in which the foot rests
SPEED = 1.0  # [m/s]
FOOT = 0.2  # [m] heel to toe


def walk(strides=5, lift=0.08, before=0.0, speed=SPEED):
    """A walk along x after a rest: feet that rest on the ground and swing by a cosine, `lift` high.

    `before`: seconds of standing. Every foot is furthest ahead as it lands, furthest behind as it leaves.
    """
    time = np.arange(round((before + strides * PERIOD) * RATE)) / RATE
    walked = np.maximum(time - before, 0.0)
    heel = np.zeros((len(time), 2, 3))
    for k, late in enumerate((0.0, 0.5)):
        phase = walked / PERIOD + late
        swing = np.clip((phase % 1 - STANCE) / (1 - STANCE), 0.0, 1.0)
        stride = PERIOD * speed
        ahead = (np.floor(phase) - late + (1 - np.cos(np.pi * swing)) / 2 + STANCE / 2) * stride
        heel[:, k] = np.stack(
            [ahead, np.full(len(time), 0.1 - 0.2 * k), lift * np.sin(np.pi * swing) ** 2], 1
        )
    pelvis = np.stack([speed * walked, np.zeros(len(time))], axis=1)
    heading = np.tile([1.0, 0.0], (len(time), 1))
    return Feet(time, heel, heel + np.array([FOOT, 0.0, 0.0]), pelvis, heading)


def test_a_walk_has_a_heel_strike_and_a_toe_off_of_each_foot_in_each_stride():
    events = walking_events(walk(strides=6))
    for side in SIDES:
        strikes = [e.time for e in events if (e.kind, e.side) == ("heel_strike", side)]
        assert len(strikes) >= 4
        np.testing.assert_allclose(np.diff(strikes), PERIOD, atol=2 / RATE)


def objections(feet):
    """Objections to the strides of both feet."""
    events = candidates(feet.time, feet.ahead(feet.heel), feet.ahead(feet.toe))
    return [stride.why for side in SIDES for stride in candidate_strides(feet, feet.heel, events, side)]


@pytest.mark.parametrize("lift", [0.08, -0.004])
def test_feet_may_drag_a_little(lift):
    """In averaged walks the swinging foot sinks by millimetres."""
    assert not any(objections(walk(lift=lift)))


def test_feet_that_swing_below_the_ground_do_not_walk_forward():
    found = objections(walk(lift=-0.05))
    assert found
    assert all("higher in stance than in swing" in why for why in found)


def test_steps_on_the_spot_are_no_walk():
    feet = walk()
    there = feet._replace(
        heel=feet.heel - np.pad(feet.pelvis, ((0, 0), (0, 1)))[:, None],
        toe=feet.toe - np.pad(feet.pelvis, ((0, 0), (0, 1)))[:, None],
        pelvis=0.0 * feet.pelvis,
    )
    assert walking_events(there)  # on a treadmill: the resting foot goes back with the belt
    still = walk(speed=0.05)
    with pytest.raises(GaitError):
        walking_events(still)


def leaning(feet, at, by):
    """The pelvis sways forward once at a time [s], over feet that stand: they turn behind it."""
    sway = by * np.exp(-(((feet.time - at) / 0.3) ** 2))
    return feet._replace(pelvis=feet.pelvis + sway[:, None] * [1.0, 0.0])


def test_a_sway_before_the_walk_is_its_first_toe_off_only_within_a_stride_and_a_half():
    """Standing feet fall behind a pelvis that sways forward: an extreme of their motion, as a toe-off is."""
    before = 8.0
    feet = walk(strides=6, before=before)
    for at, belongs in ((before - 1.0, True), (before - 6.0, False)):
        first = walking_events(leaning(feet, at, 0.2))[0]
        assert (abs(first.time - at) < 0.1) == belongs
        assert first.time > before - 1.5 * PERIOD
