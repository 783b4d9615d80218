"""Lengths, widths and clearance at heel and toe markers: against the file's own points, and made ones."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.sized_body import sized_body
from exo_pin.formats import load_gait, load_markers, open_trial
from exo_pin.gait import Event
from exo_pin.gait.toe_clearance import toe_clearances
from exo_pin.gait.trial import Markers, to_z_up
from exo_pin.kinematics import foot_markers, walk_numbers
from exo_pin.kinematics.sole_points import sole_points
from exo_pin.kinematics.walk_numbers import ON_THE_MODEL
from exo_pin.robot import load_robot

WALK = "c3d_pig_walk_HC036A/HC036A10_walk.c3d"
LENGTHS = ("speed", "stride_length", "step_width", "left_step_length", "right_step_length")


@pytest.fixture(scope="module")
def trial(shared):
    """Robot of the person, walk and markers of a recording."""
    file = open_trial(shared / WALK)
    return load_robot(sized_body(file.person()).body), load_gait(file), load_markers(file)


@pytest.fixture(scope="module")
def points(shared):
    """Heel markers `(n, 2, 3)` [m] and times [s] as ezc3d reads them, without this package."""
    import ezc3d

    file = ezc3d.c3d(str(shared / WALK))
    labels = file["parameters"]["POINT"]["LABELS"]["value"]
    heels = [file["data"]["points"][:3, labels.index(name)].T / 1000 for name in ("LHEE", "RHEE")]
    first = file["header"]["points"]["first_frame"]
    return (first + np.arange(len(heels[0]))) / 100, np.stack(heels, axis=1)


def test_steps_and_width_are_those_of_the_files_heel_markers_at_its_own_events(trial, points):
    robot, gait, markers = trial
    found = walk_numbers(robot, gait, foot_markers(markers, robot, gait))
    time, heels = points
    strikes = sorted((e.time, SIDES.index(e.side)) for e in gait.events if e.kind == "heel_strike")
    at = [np.array([np.interp(t, time, heels[:, k, x]) for x in range(2)]) for t, k in strikes]
    course = heels[-1, :, :2].mean(axis=0) - heels[0, :, :2].mean(axis=0)  # the child walks straight on
    forward = course / np.linalg.norm(course)
    steps = [b - a for a, b in itertools.pairwise(at)]
    width = np.mean([abs(step[0] * forward[1] - step[1] * forward[0]) for step in steps])
    lengths = {
        side: np.mean([s @ forward for s, (_, k) in zip(steps, strikes[1:], strict=True) if k == side])
        for side in (0, 1)
    }
    assert found.numbers["step_width"].mean == pytest.approx(width, abs=0.01)
    assert found.numbers["left_step_length"].mean == pytest.approx(lengths[0], abs=0.01)
    assert found.numbers["right_step_length"].mean == pytest.approx(lengths[1], abs=0.01)
    assert {found.measured[name] for name in LENGTHS} == {"markers LHEE, RHEE"}
    assert found.measured["left_toe_clearance"] == "markers LTOE, RTOE"


def test_a_childs_numbers_are_within_the_ranges_of_its_own_leg(trial):
    robot, gait, markers = trial
    for feet in (None, foot_markers(markers, robot, gait)):
        verdicts = walk_numbers(robot, gait, feet).verdicts
        for name in ("cadence", "stride_length", "left_step_length", "right_step_length"):
            assert verdicts[name] == "within"


def test_without_markers_lengths_are_the_models_and_that_is_said(trial):
    robot, gait, markers = trial
    without = replace(markers, names=tuple(f"x{name}" for name in markers.names))
    assert foot_markers(without, robot, gait) is None
    assert set(walk_numbers(robot, gait).measured.values()) == {ON_THE_MODEL}


def test_a_heel_that_is_hidden_at_a_strike_leaves_that_step_out_and_one_never_seen_the_model(trial):
    robot, gait, markers = trial
    feet = foot_markers(markers, robot, gait)
    whole = walk_numbers(robot, gait, feet).numbers["step_width"].n
    last = max(e.time for e in gait.events if (e.side, e.kind) == ("left", "heel_strike"))
    hidden = np.where((feet.time > last - 0.3)[:, None, None], np.nan, feet.heels)
    part = walk_numbers(robot, gait, replace(feet, heels=hidden))
    assert 0 < part.numbers["step_width"].n < whole
    never = walk_numbers(robot, gait, replace(feet, heels=np.full_like(feet.heels, np.nan)))
    assert never.measured["step_width"] == ON_THE_MODEL
    assert np.isfinite(never.numbers["step_width"].mean)


@pytest.mark.parametrize("up", ["+y", "-x", "+z"])
def test_a_vertical_that_the_file_does_not_state_is_found_at_the_walks_feet(trial, up):
    robot, gait, markers = trial
    turned = replace(markers, position=markers.position @ to_z_up(up), up="")
    known, found = (foot_markers(x, robot, gait) for x in (markers, turned))
    np.testing.assert_allclose(found.heels, known.heels, atol=1e-9)


def test_markers_of_another_world_are_not_used(trial):
    robot, gait, markers = trial
    assert foot_markers(replace(markers, position=markers.position + 1.0), robot, gait) is None


@pytest.mark.parametrize(
    "names",
    [
        ("LHEE", "RHEE"),
        ("L.Heel", "R.Heel"),
        ("l_calc", "r_calc"),
        ("L_calc_study", "r_calc_study"),
        ("Anna:LCAL", "Anna:RCAL"),
        ("LCA", "RCA"),
        ("LeftHeel", "RightHeel"),
    ],
)
def test_heels_are_found_by_the_names_of_many_laboratories(trial, names):
    robot, gait, _ = trial
    heels = sole_points(robot, gait)[:, :, 0]
    feet = foot_markers(Markers(gait.time, names, heels, up="+z"), robot, gait)
    assert feet.heel_names == names
    assert feet.toe_names == ()
    numbers, model = walk_numbers(robot, gait, feet), walk_numbers(robot, gait)
    for name in LENGTHS:  # markers on the model's own heels measure what the model does
        assert numbers.numbers[name].mean == pytest.approx(model.numbers[name].mean, abs=1e-9)


def test_clearance_counts_from_the_resting_toes_own_height():
    time = np.linspace(0, 2, 401)
    height = np.where(time > 0.6, 0.05 + 0.04 * np.cos(2 * np.pi * (time - 0.6) / 0.4) ** 2, 0.03)
    toes = np.zeros((len(time), 2, 3))
    toes[:, 0, 2] = height
    kinds = [(0.0, "heel_strike"), (0.6, "toe_off"), (1.0, "heel_strike")]
    events = [Event(t, kind, "left") for t, kind in kinds]
    found = toe_clearances(time, toes, events)
    assert set(found) == {"left_toe_clearance"}
    # the height is lowest, 50 mm, at a quarter and three quarters of the swing; the toe rested at 30 mm
    assert found["left_toe_clearance"].mean == pytest.approx(0.020, abs=1e-4)
    toes[:, 0, 2] += 1.0
    assert toe_clearances(time, toes, events)["left_toe_clearance"].mean == pytest.approx(0.020, abs=1e-4)
    toes[150, 0, 2] = np.nan
    assert toe_clearances(time, toes, events) == {}
