"""Foot contacts of C3D files are understood in the words of several laboratories, and nothing else is."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from exo_pin.formats.c3d.foot_contacts import foot_events

SPAN = (0.0, 100.0)
FRAME = 0.01


def understood(label, context):
    events = foot_events(np.array([[1.0], [5.5]]), [label], [context], SPAN, FRAME).events
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
        ("RON", "", "right", "heel_strike"),
        ("LOFF", "General", "left", "toe_off"),
        ("HS_L", "", "left", "heel_strike"),
        ("TO-R", "", "right", "toe_off"),
        ("LHeelStrike", "", "left", "heel_strike"),
        ("RightToeOff", "", "right", "toe_off"),
        ("RHS 2", "", "right", "heel_strike"),
        ("lft foot contact", "", "left", "heel_strike"),
        ("Foot Off Right", "", "right", "toe_off"),
        ("LIC", "", "left", "heel_strike"),
        ("Off", "Right", "right", "toe_off"),
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
def test_other_events_are_left_out_and_counted(label, context):
    found = foot_events(np.array([[1.0], [5.5]]), [label], [context], SPAN, FRAME)
    assert found.events == ()
    assert len(found.remarks) == 1
    assert found.remarks[0].startswith("1 event is not understood")


def test_events_are_sorted_those_outside_the_trial_counted_and_those_on_its_edge_kept():
    times = np.array([[0, 0, 2.0, 1], [3, 1, 0, 40.004]])
    found = foot_events(times, ["Foot Strike"] * 4, ["Left"] * 4, SPAN, FRAME)
    assert [event.time for event in found.events] == [1, 3, 100]
    assert found.remarks == ("1 event lies outside the trial, 0.00 .. 100.00 s, and cannot be used",)


def test_events_counted_from_the_first_frame_are_suspected():
    times = np.array([[0, 0, 0.0], [0.1, 1.2, 2.5]])
    found = foot_events(times, ["LHS", "RTO", "RHS"], [], (2.0, 5.2), FRAME)
    assert [event.time for event in found.events] == [2.5]
    assert "2 events lie outside" in found.remarks[0]
    assert "counted from the first frame?" in found.remarks[0]


@pytest.mark.parametrize(
    "layout",
    [
        lambda m, s: np.array([m, s]),
        lambda m, s: np.array([m, s]).T,
        lambda m, s: np.array([m, s]).T.ravel(),
        lambda m, s: np.array([m, s]).T.reshape(1, -1),
        lambda m, s: np.array([m, s]).ravel(),
        lambda m, s: 60 * m + s,
        lambda m, s: (60 * m + s)[None],
    ],
)
@given(st.lists(st.integers(1, 9_999), min_size=3, max_size=40, unique=True))
def test_times_are_read_in_every_layout(layout, hundredths):
    seconds = np.array(hundredths) / 100 + 0.003
    times = layout(seconds // 60, seconds % 60)
    labels = ["LHS", *["RTO"] * (len(seconds) - 1)]
    found = foot_events(times, labels, [], SPAN, FRAME)
    assert [e.time for e in found.events] == pytest.approx(sorted(seconds), abs=1e-6)
    assert [e.time for e in found.events if e.side == "left"] == pytest.approx([seconds[0]], abs=1e-6)
    assert found.remarks == ()


def test_short_contexts_leave_the_side_to_the_label_and_no_event_is_lost_in_silence():
    times = np.array([[0, 0, 0, 0.0], [1, 2, 3, 4]])
    found = foot_events(times, ["Foot Strike", "RTO", "Foot Off"], ["Left"], SPAN, FRAME)
    assert [(e.side, e.kind) for e in found.events] == [("left", "heel_strike"), ("right", "toe_off")]
    assert found.remarks[0].startswith("2 events are not understood")  # no side; no label
    assert foot_events(times[:, :2].ravel()[:3], ["LHS"] * 2, [], SPAN, FRAME).events == ()
    twice = foot_events(times[:, [0, 0]], ["LHS", "LHS"], [], SPAN, FRAME)
    assert len(twice.events) == 1
    assert "twice" in twice.remarks[0]


def test_a_label_brings_no_control_character_to_the_terminal():
    found = foot_events(np.array([[0.0], [1]]), ["\x1b[2J"], ["L"], SPAN, FRAME)
    assert found.remarks[0].isprintable()
