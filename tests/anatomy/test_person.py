"""The person in a file and the body made of them: every size has its origin, and nonsense is left out."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from exo_pin.anatomy import SIDES, Body
from exo_pin.anatomy.davis_hip import from_front_spine, hip_to_ankle
from exo_pin.anatomy.person import LEG_PART, Measure, Person
from exo_pin.anatomy.sized_body import body_of_file, sized_body
from exo_pin.anatomy.sizes import SIZES
from exo_pin.errors import UnknownNameError

LEGS = ("left_thigh", "left_shank", "right_thigh", "right_shank")


def person(origin="file's header", **sizes):
    return Person({name: Measure(value, origin, f"{name} as tested") for name, value in sizes.items()})


def test_without_anything_known_the_body_is_the_default_one_and_says_so():
    found = sized_body(Person())
    assert found.body == Body.from_stature()
    assert {measure.origin for measure in found.measures.values()} == {"default"}
    assert not found.own_legs


def test_known_sizes_are_the_bodys_on_their_own_side_and_the_rest_follows_from_height_and_mass():
    sizes = {"left_thigh": 0.30, "left_shank": 0.33, "right_thigh": 0.29, "right_shank": 0.34}
    found = sized_body(person(stature=1.34, mass=33.0, **sizes))
    assert {name: getattr(found.body, name) for name in sizes} == sizes
    average = Body.from_stature(1.34, mass=33.0)
    assert (found.body.left_foot_length, found.body.right_thigh_mass) == (
        average.left_foot_length,
        average.right_thigh_mass,
    )
    origins = {name: found.measures[name].origin for name in ("stature", "left_thigh", "left_foot_length")}
    assert origins == {
        "stature": "file's header",
        "left_thigh": "file's header",
        "left_foot_length": "stature table",
    }
    assert found.measures["left_thigh_mass"].origin == "mass table"
    assert found.own_legs
    assert found.measures.keys() == SIZES.keys()
    assert all(found.measures[name].value == getattr(found.body, name) for name in SIZES)


def test_the_command_line_wins_size_by_size_and_a_stature_over_all_lengths():
    known = person(stature=1.34, mass=33.0, left_thigh=0.30, left_shank=0.33, hip_width=0.1)
    wider = sized_body(known, given={"hip_width": 0.12, "left_thigh": 0.31})
    assert (wider.body.hip_width, wider.body.left_thigh, wider.body.left_shank) == (0.12, 0.31, 0.33)
    assert wider.measures["hip_width"].origin == "command line"
    other = sized_body(known, given={"stature": 1.5})
    assert other.body == Body.from_stature(1.5, mass=33.0)
    assert other.measures["left_thigh"].origin == "stature table"
    assert sized_body(known, given={"mass": 40.0}).body.left_thigh == 0.30


def test_a_mass_beside_a_stature_of_the_command_line_is_the_default_one_and_says_so():
    found = sized_body(Person(), given={"stature": 1.9})
    assert found.body == Body.from_stature(1.9)
    assert found.measures["stature"].origin == "command line"
    assert {found.measures[name].origin for name in ("mass", "left_thigh_mass")} == {"default"}
    assert found.measures["left_thigh"].origin == "stature table"


def test_the_stature_follows_from_the_legs_and_the_mass_from_the_stature():
    found = sized_body(person("model", **dict.fromkeys(LEGS, 0.4)))
    assert found.body.stature == pytest.approx(0.8 / LEG_PART, abs=1e-4)
    assert found.measures["stature"].origin == "model"
    assert found.measures["mass"].origin == "stature table"
    assert found.body.mass == pytest.approx(
        70 * (found.body.stature / 1.75) ** 2, abs=0.005
    )  # the stature is rounded to 0.1 mm


def test_a_leg_of_which_nothing_is_known_is_as_long_as_the_other():
    found = sized_body(person(stature=1.7, left_thigh=0.45, left_shank=0.40))
    assert (found.body.right_thigh, found.body.right_shank) == (0.45, 0.40)
    assert found.measures["right_thigh"].detail.startswith("as the left one")


@pytest.mark.parametrize(
    ("sizes", "gone"),
    [
        ({"stature": 13.4}, {"stature"}),
        ({"stature": math.nan}, {"stature"}),
        ({"stature": 1.34, "mass": 330.0}, {"mass"}),
        ({"stature": 1.8, "left_thigh": 0.2, "left_shank": 0.2}, {"left_thigh", "left_shank"}),
        (
            {"left_thigh": 0.2, "left_shank": 0.2, "right_thigh": 0.4, "right_shank": 0.4},
            set(LEGS),
        ),
    ],
)
def test_what_no_person_has_is_left_out_and_said(sizes, gone):
    found = person(**sizes)
    assert set(sizes) - set(found.sizes) == gone
    assert found.remarks
    assert all("not used" in remark for remark in found.remarks)


def test_a_height_that_does_not_go_with_measured_legs_is_the_one_that_goes():
    legs = person("markers", **dict.fromkeys(LEGS, 0.44))
    both = legs.over(person(stature=1.30))
    assert "stature" not in both.sizes
    assert set(LEGS) <= set(both.sizes)
    assert "does not go with" in both.remarks[0]


values = st.one_of(st.floats(), st.floats(0.05, 3.0), st.floats(10, 2000))


@given(
    st.dictionaries(
        st.sampled_from(["stature", "mass", "hip_width", *LEGS, "left_ankle_height", "left_foot_length"]),
        values,
    )
)
def test_whatever_a_file_states_there_is_a_body(sizes):
    assert 0.5 <= sized_body(person(**sizes)).body.stature <= 2.6


def test_a_body_file_holds_every_size_and_options_change_single_ones():
    found = body_of_file(Body.from_stature(1.6), "anna.toml", {"thigh": 0.4})
    assert found.body.legs[0].thigh == found.body.legs[1].thigh == 0.4
    assert found.measures["left_thigh"].origin == "command line"
    assert found.measures["left_shank"] == Measure(found.body.left_shank, "body file", "anna.toml")
    with pytest.raises(UnknownNameError):
        body_of_file(Body.from_stature(), "anna.toml", {"thig": 0.4})


def test_the_hip_lies_inwards_behind_and_below_the_front_spine():
    forward, inwards, up = from_front_spine(0.9)
    assert forward < 0 < inwards
    assert up < 0
    # Davis's distances of an adult: 4 to 12 cm below, by construction of the regression on X-rays
    assert 0.04 < -up < 0.12


def test_a_clinical_leg_is_longer_than_hip_to_ankle_by_the_hips_depth(shared):
    lengths = np.linspace(0.4, 1.1, 8)
    depths = lengths - [hip_to_ankle(length) for length in lengths]
    assert (np.diff(depths) > 0).all()
    # HC036A: PROCESSING has leg lengths of 700 and 710 mm, femur and tibia of 626.4 and 625.6 mm together
    for clinical, centres in ((0.700, 0.6264), (0.710, 0.6256)):
        assert hip_to_ankle(clinical) == pytest.approx(centres, rel=0.03)
    assert len(SIDES) == 2
