"""Bodies: proportions, checks, files, inertias."""

import dataclasses
import math
import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from exo_pin.anatomy import JOINTS, MOVEMENTS, SIDES, Body
from exo_pin.anatomy.hip_cardan_angles import hip_angles, reorder
from exo_pin.anatomy.inertia import link_inertias
from exo_pin.anatomy.sizes import LEG_SIZES, SIZES
from exo_pin.errors import DescriptionError, FormatError, UnknownNameError

STATURES = st.floats(1.2, 2.1)
MASSES = st.floats(30.0, 150.0)
ROUNDING = 1e-9  # sums of a dozen doubles


def test_joint_order_is_left_then_right_from_the_hip_outwards():
    assert JOINTS[:6] == tuple(f"left_{movement}" for movement in MOVEMENTS)
    assert JOINTS[6:] == tuple(f"right_{movement}" for movement in MOVEMENTS)


def test_every_size_of_the_table_is_a_field_and_the_reverse():
    numbers = {f.name for f in dataclasses.fields(Body)} - {"sex", "wearer", "limits"}
    assert numbers == set(SIZES)
    assert set(Body.from_stature().leg("left")._fields) == set(LEG_SIZES)


def test_proportions_are_those_of_drillis_and_contini():
    leg = Body.from_stature(2.0).leg("left")
    assert (leg.thigh, leg.shank, leg.foot_length) == pytest.approx((0.490, 0.492, 0.304))


def test_segment_masses_are_those_of_de_leva():
    body = Body.from_stature(mass=100.0, sex="female")
    assert (body.left_thigh_mass, body.left_shank_mass, body.left_foot_mass) == (14.78, 4.81, 1.29)


@given(STATURES, MASSES, st.sampled_from(["male", "female"]), st.booleans())
def test_link_masses_sum_to_wearer_and_hardware(stature, mass, sex, wearer):
    body = Body.from_stature(stature, mass=mass, sex=sex, wearer=wearer)
    total = sum(part.mass for part in link_inertias(body).values())
    assert total == pytest.approx(body.hardware_mass + (mass if wearer else 0.0), abs=ROUNDING)


@given(STATURES, MASSES, st.sampled_from(["male", "female"]), st.booleans())
def test_inertias_are_those_of_real_bodies(stature, mass, sex, wearer):
    for part in link_inertias(Body.from_stature(stature, mass=mass, sex=sex, wearer=wearer)).values():
        a, b, c = np.linalg.eigvalsh(part.inertia)
        assert a > 0
        assert a + b >= c * (1 - ROUNDING)


def test_equal_legs_have_mirrored_inertias():
    links = link_inertias(Body.from_stature())
    flip = np.diag([1.0, -1.0, 1.0])
    for name in ("hip_1", "thigh", "shank", "sole_plate"):
        left, right = links[f"left_{name}"], links[f"right_{name}"]
        assert flip @ left.centre == pytest.approx(right.centre, abs=ROUNDING)
        assert flip @ left.inertia @ flip == pytest.approx(right.inertia, abs=ROUNDING)


def test_a_thigh_weighs_at_its_table_place_when_the_hardware_is_light():
    body = Body.from_stature(thigh_hardware=0.01)
    centre = link_inertias(body)["left_thigh"].centre
    assert centre[2] == pytest.approx(-0.4095 * body.left_thigh, rel=1e-3)  # 10 g of 9.9 kg


@given(st.floats(1.3, 2.1), st.floats(14.0, 60.0))
def test_breadths_grow_with_the_root_of_the_mass_and_joint_centres_do_not_move(stature, index):
    usual, other = (Body.from_stature(stature, mass=i * stature**2) for i in (70 / 1.75**2, index))
    ratio = math.sqrt(other.mass / usual.mass)
    assert usual.girth == 1.0
    assert other.hip_breadth == pytest.approx(ratio * usual.hip_breadth, abs=3e-6)  # sizes are whole um
    assert other.hip_width == usual.hip_width
    assert [leg.length for leg in other.legs] == [leg.length for leg in usual.legs]


def test_nobody_is_thinner_than_the_starving_nor_as_thin_as_the_bones():
    thin = Body.from_stature(1.9, mass=12.0)
    assert thin.girth == Body.from_stature(1.9, mass=8.0 * 1.9**2).girth
    assert thin.hip_breadth > thin.hip_width


def test_numbers_of_numpy_are_numbers():
    assert Body.from_stature(np.float32(1.5), mass=np.int64(60)).mass == 60.0


def test_a_name_without_side_sets_both_legs_and_a_side_wins():
    body = Body.from_stature(thigh=0.40, left_thigh=0.41)
    assert (body.left_thigh, body.right_thigh) == (0.41, 0.40)


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"stature": 17.5}, "17.5 m is not plausible"),
        ({"mass": 0}, "mass = 0 kg"),
        ({"thigh": -0.4}, "left_thigh = -0.4 m"),
        ({"left_shank": math.nan}, "left_shank is nan"),
        ({"thigh": "long"}, "'long'"),
        ({"waist_width": 0.15}, "must be more than hip_width"),
        ({"heel": 0.2, "ball": 0.2}, "foot_length"),
        ({"thigh_mass": 40.0}, "leave nothing"),
        ({"wearer": "yes"}, "true or false"),
        ({"thigh": 0.6, "shank": 0.7}, "does not go with stature"),
        ({"limits": 3}, "limits is 3"),
        ({"limits": {"left_knee_flexion": 3}}, "a pair"),
        ({"limits": {"left_knee_flexion": (1.0, 0.5)}}, "lower < upper"),
    ],
)
def test_absurd_measures_are_refused_by_name(values, words):
    with pytest.raises(DescriptionError, match=words):
        Body.from_stature(**values)


@pytest.mark.parametrize(
    "values", [{"tigh": 0.4}, {"sex": "other"}, {"limits": {"left_toe": (0.0, 1.0)}}], ids=str
)
def test_unknown_names_are_refused(values):
    with pytest.raises(UnknownNameError):
        Body.from_stature(**values)


@given(STATURES, MASSES, st.booleans())
def test_a_body_file_reads_back_equal(tmp_path_factory, stature, mass, wearer):
    path = tmp_path_factory.mktemp("body") / "patient.toml"
    body = Body.from_stature(
        stature,
        mass=mass,
        wearer=wearer,
        left_thigh=0.4,
        limits={"left_knee_flexion": (0.0, math.radians(95))},
    )
    body.save(path)
    assert Body.load(path) == body


def test_a_short_body_file_is_completed_from_the_stature(tmp_path):
    path = tmp_path / "short.toml"
    path.write_text("stature = 1.6\nleft_thigh = 0.37\n[limits_deg]\nleft_knee_flexion = [5, 90]\n")
    body = Body.load(path)
    assert (body.left_thigh, body.right_thigh) == (0.37, pytest.approx(1.6 * 0.245))
    assert body.limits["left_knee_flexion"] == pytest.approx((math.radians(5), math.radians(90)))


@pytest.mark.parametrize(
    "text",
    [
        "stature = ",
        "stature = 17.5",
        "tigh = 0.4",
        "stature = '1.7'",
        "limits_deg = 3",
        "sex = ['male']",
        "[limits]\nleft_knee_flexion = [0, 20]",  # not to be mistaken for limits_deg
        "\x00",
        "[limits_deg]\nleft_knee_flexion = [1]",
        "[limits_deg]\nleft_knee_flexion = ['a', 'b']",
    ],
)
def test_a_bad_body_file_is_a_format_error_that_names_it(tmp_path, text):
    path = tmp_path / "bad.toml"
    path.write_text(text)
    with pytest.raises(FormatError, match=r"bad\.toml"):
        Body.load(path)


def test_a_body_goes_to_another_process_whole():
    body = Body.from_stature(1.6, left_thigh=0.4, limits={"left_knee_flexion": (0.0, 1.9)})
    again = pickle.loads(pickle.dumps(body))
    assert again == body
    with pytest.raises(TypeError):
        again.limits["left_knee_flexion"] = (0, 1)


def test_a_missing_body_file_is_a_format_error(tmp_path):
    with pytest.raises(FormatError, match="no such file"):
        Body.load(tmp_path / "none.toml")


def _rotation(axis, angle):
    x, y, z = axis
    skew = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * skew + (1 - np.cos(angle)) * skew @ skew


@given(st.sampled_from(SIDES), st.tuples(*[st.floats(-1.2, 1.2)] * 3))
def test_reordered_hip_angles_make_the_same_rotation(side, angles):
    s = 1 if side == "left" else -1
    flexion, adduction, rotation = (0, -1, 0), (-s, 0, 0), (0, 0, -s)
    a, b, c = angles
    clinical = _rotation(flexion, a) @ _rotation(adduction, b) @ _rotation(rotation, c)
    a, b, c = reorder(angles, side, source="clinical", target="yaw_roll_pitch")
    humanoid = _rotation(rotation, c) @ _rotation(adduction, b) @ _rotation(flexion, a)
    assert humanoid == pytest.approx(clinical, abs=1e-12)
    back = reorder((a, b, c), side, source="yaw_roll_pitch", target="clinical")
    assert back == pytest.approx(angles, abs=1e-9)  # cos(1.2) costs two digits


@pytest.mark.parametrize(("side", "medial"), [("left", -1.0), ("right", 1.0)])
@pytest.mark.parametrize("angle", [0.3, -0.2])
def test_positive_hip_angles_flex_adduct_and_rotate_inwards(side, medial, angle):
    """The thigh goes forward, the thigh goes to the other leg, the toes turn to the other leg."""
    c, s = np.cos(angle), np.sin(angle)
    m = medial * s  # +y is the left: towards it the right leg goes inwards
    turns = {
        0: [[c, 0, -s], [0, 1, 0], [s, 0, c]],
        1: [[1, 0, 0], [0, c, -m], [0, m, c]],
        2: [[c, -m, 0], [m, c, 0], [0, 0, 1]],
    }
    down, forward = np.array([0.0, 0.0, -1.0]), np.array([1.0, 0.0, 0.0])
    assert (np.array(turns[0]) @ down)[0] == pytest.approx(s)
    assert (np.array(turns[1]) @ down)[1] == pytest.approx(m)
    assert (np.array(turns[2]) @ forward)[1] == pytest.approx(m)
    for column, R in turns.items():
        expected = np.zeros(3)
        expected[column] = angle
        assert hip_angles(R, side) == pytest.approx(expected, abs=ROUNDING)
