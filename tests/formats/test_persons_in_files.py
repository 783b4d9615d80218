"""The person in C3D files and OpenSim models: height, mass and lengths of the legs, side by side."""

from __future__ import annotations

import numpy as np
import pytest

from exo_pin.anatomy.sized_body import sized_body
from exo_pin.errors import FormatError
from exo_pin.formats import open_trial, save_gait
from exo_pin.formats.c3d.joint_centres import measured_person
from exo_pin.formats.c3d.parameters import C3dParameters
from exo_pin.formats.c3d.subject_parameters import stated_person
from exo_pin.formats.opensim.osim_person import model_person
from exo_pin.gait import normative_gait
from exo_pin.gait.trial import Markers

WALK = "c3d_pig_walk_HC036A/HC036A10_walk.c3d"
MODEL = "opensim_subject01_walk/subject01_simbody.osim"


def stated(**parameters):
    return stated_person(
        C3dParameters({}, {f"PROCESSING:{k.upper()}": np.array([x]) for k, x in parameters.items()})
    )


def values(person):
    return {name: round(measure.value, 6) for name, measure in person.sizes.items()}


@pytest.mark.parametrize(
    "names",
    [
        ("Height", "Bodymass", "LFemurLength", "RFemurLength"),
        ("HEIGHT", "BODYMASS", "LFEMURLENGTH", "RFEMURLENGTH"),
        ("Body Height", "Body_Mass", "LeftThighLength", "RightThighLength"),
        ("HC036A:Height", "HC036A:Bodymass", "HC036A:LFemurLength", "HC036A:RFemurLength"),
    ],
)
def test_names_of_several_laboratories_are_understood(names):
    found = values(stated(**dict(zip(names, (1340.0, 33.0, 298.0, 292.0), strict=True))))
    assert found == {"stature": 1.34, "mass": 33.0, "left_thigh": 0.298, "right_thigh": 0.292}


def test_nothing_and_zero_state_nothing():
    found = stated(Height=0.0, Bodymass=0.0, LLegLength=0.0, RLegLength=np.nan)
    assert found == stated()
    assert not found.sizes
    assert not found.remarks


def test_each_leg_has_its_own_clinical_length():
    found = stated(LLegLength=880.0, RLegLength=910.0)
    legs = {
        side: found.sizes[f"{side}_thigh"].value + found.sizes[f"{side}_shank"].value
        for side in ("left", "right")
    }
    assert 0.025 < legs["right"] - legs["left"] < 0.030
    assert {name: round(x.value, 3) for name, x in found.others.items()} == {
        "left_leg_length": 0.88,
        "right_leg_length": 0.91,
    }
    assert "Davis 1991" in found.sizes["left_thigh"].detail


def test_lengths_between_joint_centres_go_before_the_clinical_length():
    found = stated(LLegLength=700.0, LFemurLength=298.0, LTibiaLength=328.0)
    assert values(found) == {"left_thigh": 0.298, "left_shank": 0.328}


@pytest.mark.parametrize(("height", "unit"), [(1.34, "m"), (134.0, "cm")])
def test_metres_and_centimetres_are_recognised_and_said(height, unit):
    found = stated(Height=height)
    assert found.sizes["stature"].value == pytest.approx(1.34)
    assert f"taken as {unit}" in found.remarks[0]


@pytest.mark.parametrize("parameters", [{"Height": 13.4}, {"Bodymass": 3300.0}, {"LLegLength": -700.0}])
def test_what_no_unit_makes_a_persons_is_not_used_and_said(parameters):
    found = stated(**parameters)
    assert not found.sizes
    assert "no person's and is not used" in found.remarks[0]


def test_sizes_of_several_subjects_are_the_first_ones_and_that_is_said():
    numbers = {"SUBJECTS:USED": np.array([2.0]), "PROCESSING:HEIGHT": np.array([1700.0, 1650.0])}
    found = stated_person(C3dParameters({"SUBJECTS:NAMES": ("Anna", "Ben")}, numbers))
    assert found.sizes["stature"].value == 1.7
    assert "2 subjects" in found.remarks[0]


def test_a_c3d_file_of_vicon_gives_its_person(shared):
    found = open_trial(shared / WALK).person()
    assert (found.sizes["stature"].value, found.sizes["mass"].value) == (1.34, 33.0)
    # PROCESSING: LFemurLength 298.07, RFemurLength 292.47, LTibiaLength 328.29, RTibiaLength 333.14, from
    # the static trial; in the walk the knee's centre moves against the hip's by some mm
    for name, length in (
        ("left_thigh", 0.29807),
        ("right_thigh", 0.29247),
        ("left_shank", 0.32829),
        ("right_shank", 0.33314),
    ):
        assert found.sizes[name].origin == "joint centres"
        assert found.sizes[name].value == pytest.approx(length, abs=0.006)
    assert found.others["left_knee_width"].value == pytest.approx(0.098)
    assert found.remarks == ()


def test_parameters_are_read_from_the_file_itself(tmp_path):
    import ezc3d

    path = tmp_path / "walk.c3d"
    save_gait(normative_gait().sampled(100), path)
    assert not open_trial(path).person().sizes
    file = ezc3d.c3d(str(path))
    file.add_parameter("PROCESSING", "Height", [1812.0])
    file.add_parameter("PROCESSING", "LLegLength", [940.0])
    file.add_parameter("SUBJECTS", "Bodymass", [81.5])
    file.add_parameter("SUBJECTS", "NAMES", ["Anna"])
    file.write(str(path))
    body = sized_body(open_trial(path).person()).body
    assert (body.stature, body.mass) == (1.812, 81.5)
    assert body.left_thigh == body.right_thigh


def joint_points(rng, **lengths):
    """A trial with Plug-in Gait's segment axes: hip, knee and ankle of the left leg in any pose."""
    hip = rng.normal(size=(50, 3))
    directions = rng.normal(size=(2, 50, 3))
    directions /= np.linalg.norm(directions, axis=2, keepdims=True)
    knee = hip + lengths["thigh"] * directions[0]
    ankle = knee + lengths["shank"] * directions[1]
    ankle[:, 2] = 0.06 + 0.2 * rng.random(50) ** 2
    return Markers(np.arange(50) / 100, ("LFEP", "LFEO", "LTIO"), np.stack([hip, knee, ankle], axis=1))


def test_joint_centres_give_lengths_in_any_pose_and_points_of_no_one_segment_give_none(rng):
    found = measured_person(joint_points(rng, thigh=0.41, shank=0.4))
    assert found.sizes["left_thigh"].value == pytest.approx(0.41)
    assert "left_shank" not in found.sizes  # its points do not keep their distance: the ankle was lifted


def test_the_ankles_height_needs_a_vertical(rng):
    trial = joint_points(rng, thigh=0.41, shank=0.4)
    up = Markers(trial.time, trial.names, trial.position, up="+z")
    assert "left_ankle_height" not in measured_person(trial).sizes
    assert measured_person(up).sizes["left_ankle_height"].value == pytest.approx(0.06, abs=0.005)


def test_an_opensim_model_gives_its_mass_and_the_distances_of_its_joints(shared):
    found = values(model_person(shared / MODEL))
    assert found["mass"] == pytest.approx(72.6)
    # OpenSim 4.6: distances of hip_l, knee_l and ankle_l in ground; its knee follows a cubic spline between
    # the same knots
    assert found["left_thigh"] == pytest.approx(0.4541307, abs=2e-4)
    assert found["left_shank"] == pytest.approx(0.425065, abs=1e-6)
    assert found["hip_width"] == pytest.approx(0.1711044, abs=1e-6)


def test_each_side_of_a_model_is_its_own(shared):
    trial = shared.parent / "trials" / "lai_arnold_walk"
    found = values(open_trial(trial / "walking1_ik.mot").person(trial / "scaled.osim"))
    # OpenSim 4.6, as above
    assert found["left_thigh"] == pytest.approx(0.3970323, abs=2e-4)
    assert found["right_thigh"] == pytest.approx(0.4043061, abs=2e-4)
    assert found["right_shank"] == pytest.approx(0.4077962, abs=2e-4)


def test_a_model_that_is_none_is_refused_and_one_of_no_legs_gives_what_it_has(tmp_path):
    (tmp_path / "arm.osim").write_text(
        '<OpenSimDocument Version="30000"><Model name="arm"><BodySet><objects><Body name="humerus">'
        '<mass>2.5</mass><Joint><PinJoint name="shoulder"><parent_body>ground</parent_body><CoordinateSet>'
        '<objects><Coordinate name="r_shoulder"/></objects></CoordinateSet></PinJoint></Joint></Body>'
        "</objects></BodySet></Model></OpenSimDocument>"
    )
    assert values(model_person(tmp_path / "arm.osim")) == {"mass": 2.5}
    (tmp_path / "none.osim").write_text("<a/>")
    with pytest.raises(FormatError, match="not an OpenSim model"):
        model_person(tmp_path / "none.osim")
