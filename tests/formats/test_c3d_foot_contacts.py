"""Foot contacts of C3D files are understood in the words of several laboratories, and nothing else is."""

from __future__ import annotations

import numpy as np
import pytest

from exo_pin.formats.c3d.foot_contacts import foot_events

SPAN = (0.0, 100.0)


def understood(label, context):
    events = foot_events(np.array([[1.0], [5.5]]), [label], [context], SPAN)
    return [(event.time, event.side, event.kind) for event in events]


@pytest.mark.parametrize(
    ("label", "context", "side", "kind"),
    [
        ("Foot Strike", "Left", "left", "heel_strike"),
        ("FOOT OFF", "right", "right", "toe_off"),
        ("Heel_Strike", "R", "right", "heel_strike"),
        ("LHS", "General", "left", "heel_strike"),
        ("R_TO", "", "right", "toe_off"),
        ("right toe-off", "", "right", "toe_off"),
        ("Left Initial Contact", "Left", "left", "heel_strike"),
        ("FO", "Left", "left", "toe_off"),
    ],
)
def test_strikes_and_offs_are_understood(label, context, side, kind):
    assert understood(label, context) == [(65.5, side, kind)]


@pytest.mark.parametrize(("left", "right"), [("Left", "Right"), ("l", "r"), ("L", "RIGHT")])
@pytest.mark.parametrize("label", ["{}HS", "{} foot strike", "{}_IC"])
def test_the_side_is_the_contexts_then_the_labels(label, left, right):
    """A context that names a side decides, whatever the label says; without one the label's side counts."""
    for own, other, side in ((left, right, "left"), (right, left, "right")):
        letter = own[0] if label.endswith(("HS", "IC")) else own
        opposite = other[0] if label.endswith(("HS", "IC")) else other
        for context in ("", "General", "Subject"):
            assert understood(label.format(letter), context) == [(65.5, side, "heel_strike")]
        assert understood(label.format(opposite), own) == [(65.5, side, "heel_strike")]


@pytest.mark.parametrize(
    ("label", "context"),
    [("Event", "Left"), ("Foot Strike", "General"), ("", ""), ("left", "Left"), ("R", "R")],
)
def test_other_events_are_left_out(label, context):
    assert understood(label, context) == []


def test_events_are_sorted_and_those_outside_the_trial_left_out():
    times = np.array([[0, 0, 2.0], [3, 1, 0]])
    found = foot_events(times, ["Foot Strike"] * 3, ["Left"] * 3, SPAN)
    assert [event.time for event in found] == [1, 3]
    assert foot_events(times[:1], ["Foot Strike"] * 3, ["Left"] * 3, SPAN) == ()
