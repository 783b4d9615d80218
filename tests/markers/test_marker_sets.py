"""Marker sets as data: the shipped ones, one's own as TOML, and the recognition of a trial's set."""

from __future__ import annotations

import pytest

from exo_pin.anatomy import SIDES
from exo_pin.errors import FormatError, GaitError, UnknownNameError
from exo_pin.markers import SETS, find_set, load_set, recognise

LEGS = ["pelvis", *(f"{side} {part}" for side in SIDES for part in ("thigh", "shank", "foot"))]


@pytest.mark.parametrize("name", SETS)
def test_a_set_has_a_source_and_markers_on_every_segment(name):
    chosen = SETS[name]
    assert chosen.name == name
    assert len(chosen.source) > 20
    assert {f"{spot.side or ''} {spot.segment}".strip() for spot in chosen.spots.values()} == set(LEGS)


@pytest.mark.parametrize("name", SETS)
def test_lateral_landmarks_lie_outside_and_sides_mirror_each_other(name):
    for marker, spot in SETS[name].spots.items():
        if spot.landmark in ("lateral_epicondyle", "lateral_malleolus", "asis", "psis", "mt5"):
            assert (spot.place[1] > 0) == marker.upper().startswith(("L", "FOOT_L")), marker
    for mark in ("lateral_epicondyle", "heel", "asis"):
        left, right = (SETS[name].spots[SETS[name].marking(mark, side)[0]] for side in SIDES)
        assert left.place == (right.place[0], -right.place[1], right.place[2])


@pytest.mark.parametrize("name", SETS)
def test_a_set_is_recognised_by_its_own_names_in_any_case_with_prefix_suffix_and_strangers(name):
    own = list(SETS[name].spots)
    for spelled in (
        own,
        [marker.lower().replace(".", "_") for marker in own],
        [f"Subject_01_{marker}" for marker in own],
        [f"{marker}Marker" for marker in own],
    ):
        found = recognise([*spelled, "C7", "STRN"])
        assert found.chosen.name == name
        assert len(found.own) == len(own)
        assert found.unused == ("C7", "STRN")
        assert f"marker set {name}: {len(own)} of its {len(own)} markers" in found.sentence
        assert "not used: 2 of the file's (C7, STRN)" in found.sentence


USUAL = ("THI", "KNE", "TIB", "ANK", "HEE", "TOE")
MORE = ("THAP", "KNM", "TIAP", "MED", "SMH", "FMH", "VMH")


def test_the_usual_markers_of_plug_in_gait_are_no_larger_set():
    own = ["LASI", "RASI", "SACR", *(f"{S}{marker}" for S in "LR" for marker in USUAL)]
    assert recognise(own).chosen.name == "plug-in-gait"
    assert recognise([*own, *(f"{S}{marker}" for S in "LR" for marker in MORE)]).chosen.name == "cgm2"


def test_sets_have_further_names_and_unknown_ones_are_refused():
    assert find_set("opensim-gait2354") is SETS["opensim-gait2392"]
    with pytest.raises(UnknownNameError, match="marker set 'cgm'; did you mean 'cgm2'"):
        find_set("cgm")
    with pytest.raises(GaitError, match="are of no known set"):
        recognise(["a", "b"])


OWN = """
name = "mine"
hips = 0.7
[markers]
BACK = "sacrum"
"{Side}Hip" = "asis"
"{S}_thigh" = { segment = "thigh", place = [0.1, 0.2, -0.5], spread_mm = 80 }
left_cluster = { segment = "left shank", place = [0.0, 0.2, -0.4], spread_mm = 80 }
"{S}_knee" = { landmark = "lateral_epicondyle", spread_mm = 20 }
"{S}_ankle" = "lateral_malleolus"
"{S}_heel" = "heel"
"{S}_toe" = "mt2"
[also]
"{S}_toe" = ["{Side}Toe"]
"""


def test_a_set_of_ones_own(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(OWN)
    mine = load_set(path)
    assert mine.name == "mine"
    assert mine.spots["LeftHip"].place[1] > 0 > mine.spots["RightHip"].place[1]
    assert mine.spots["R_thigh"].place == (0.1, -0.2, -0.5)
    assert mine.spots["left_cluster"].link == "left_shank"
    assert mine.spots["R_knee"].spread == 0.02
    assert mine.names("R_toe") == ("R_toe", "RightToe")
    assert find_set(str(path)).hips == 0.7


@pytest.mark.parametrize(
    ("change", "why"),
    [
        (('"sacrum"', '"sakrum"'), "landmark 'sakrum'; did you mean 'sacrum'"),
        (("hips = 0.7", "hips = 7"), "hips is 7; davis, harrington or 0.2 .. 1.5 is accepted"),
        (("hips = 0.7", "hip = 0.7"), "entry of a marker set 'hip'; did you mean 'hips'"),
        (("[0.1, 0.2, -0.5]", "[0.1, 0.2]"), "place of marker '{S}_thigh' is .* three numbers"),
        (("[0.1, 0.2, -0.5]", "[0.1, nan, -0.5]"), r"\{S\}_thigh.place is no finite number"),
        (("spread_mm = 20", "spread_mm = 0"), "spread_mm of marker '{S}_knee' is 0"),
        (('"left shank"', '"shank"'), "'left_cluster' is on a shank without its side"),
        (('"left shank"', '"tibia"'), "segment of marker 'left_cluster' 'tibia'"),
        (('"{S}_ankle"', '"{S}_knee."'), "marker 'L_knee.' occurs more than once"),
        (('["{Side}Toe"]', '"x"'), "a list of names is accepted"),
        (('"{S}_heel" = "heel"', '"{S}_heel" = 4'), "a landmark or a table is accepted"),
        (("[markers]", "[marker]"), "entry of a marker set 'marker'"),
        (('name = "mine"', "name = mine"), "is not TOML"),
    ],
)
def test_a_wrong_set_is_refused_in_one_line(tmp_path, change, why):
    assert change[0] in OWN
    path = tmp_path / "mine.toml"
    path.write_text(OWN.replace(*change))
    with pytest.raises(FormatError, match=why) as caught:
        load_set(path)
    assert "\n" not in str(caught.value)
    assert str(path) in str(caught.value)
