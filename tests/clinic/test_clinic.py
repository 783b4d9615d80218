"""Clinical cycles, normal bands and the Gait Profile Score against plain NumPy and SciPy."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from exo_pin import clinic
from exo_pin.anatomy import JOINTS, SIDES, Body
from exo_pin.errors import FormatError, GaitError
from exo_pin.formats import load_gait, open_trial
from exo_pin.gait import SPEEDS, Event, Gait, normative_gait
from exo_pin.gait.further_angles import FurtherAngles
from exo_pin.gait.heading import turned
from exo_pin.robot import load_robot

PERIOD = 1.0  # [s]
CYCLES = 3


@pytest.fixture(scope="module")
def robot():
    return load_robot(Body.from_stature(1.7))


def pelvis(t):
    """Tilt, obliquity and rotation of the left side [deg] at times [s]."""
    phase = 2 * np.pi * np.asarray(t) / PERIOD
    return 12 + 3 * np.cos(2 * phase), 5 * np.sin(phase), 8 * np.cos(phase)


@pytest.fixture(scope="module")
def known():
    """A walk over ground along y of known angles; each foot strikes once a second."""
    t = np.arange(0, CYCLES * PERIOD + 1e-9, 0.01)
    phase = 2 * np.pi * t / PERIOD
    q = np.radians([[(10 + k) * math.sin(p + 0.3 * k) for k in range(12)] for p in phase])
    tilt, obliquity, rotation = pelvis(t)
    turns = Rotation.from_euler("YXZ", np.stack([tilt, obliquity, -rotation], axis=1), degrees=True)
    base = np.tile(np.eye(4), (len(t), 1, 1))
    base[:, :3, :3] = (Rotation.from_euler("z", 90, degrees=True) * turns).as_matrix()
    base[:, 1, 3], base[:, 2, 3] = 1.2 * t, 0.9
    strikes = [Event(k * PERIOD, "heel_strike", "left", "test") for k in range(CYCLES + 1)]
    strikes += [Event((k + 0.5) * PERIOD, "heel_strike", "right", "test") for k in range(CYCLES)]
    offs = [Event((k + 0.62) * PERIOD, "toe_off", "left", "test") for k in range(CYCLES)]
    offs += [Event((k + 0.12) * PERIOD, "toe_off", "right", "test") for k in range(CYCLES)]
    return Gait(t, q, base=base, events=(*strikes, *offs))


def test_a_speed_of_the_normal_walk_scores_nothing_against_itself(robot):
    for speed in SPEEDS:
        cycles = clinic.clinical_cycles(robot, normative_gait(speed))
        found = clinic.gait_profile(cycles, clinic.published_band(speed))
        assert found.overall == 0.0
        assert set(found.sides.values()) == {0.0}
    other = clinic.gait_profile(cycles, clinic.published_band("free"))
    assert np.degrees(other.overall) > 3


def test_scores_of_known_angles_are_those_of_plain_numpy(robot, known):
    toe_in = {"left": 4.0, "right": -7.0}
    angles = {(s, "foot_progression"): np.full(len(known), np.radians(x)) for s, x in toe_in.items()}
    further = FurtherAngles(known.time, angles, "test")
    cycles = clinic.clinical_cycles(robot, known, further)
    band = clinic.published_band("free")
    found = clinic.gait_profile(cycles, band)
    scores = {}
    for side, start, sign in (("left", 0.0, 1), ("right", 0.5, -1)):
        t = start + PERIOD * np.linspace(0, 1, 101)
        tilt, obliquity, rotation = pelvis(t)
        curves = {"pelvis_tilt": tilt, "pelvis_obliquity": sign * obliquity}
        curves["pelvis_rotation"] = sign * rotation
        for name in ("hip_flexion", "hip_adduction", "hip_rotation", "knee_flexion", "ankle_dorsiflexion"):
            k = JOINTS.index(f"{side}_{name}")
            curves[name] = (10 + k) * np.sin(2 * np.pi * t / PERIOD + 0.3 * k)
        curves["foot_progression"] = np.full(101, toe_in[side])
        for name, curve in curves.items():
            scores[side, name] = np.sqrt(np.mean((curve - np.degrees(band.curves[name].mean)) ** 2))
    assert set(scores) == set(found.variables)
    for key, score in scores.items():  # interpolation between samples of 10 ms: below 0.02 deg
        assert np.degrees(found.variables[key]) == pytest.approx(score, abs=0.02), key
    for side in SIDES:
        nine = [score for (s, _), score in scores.items() if s == side]
        assert np.degrees(found.sides[side]) == pytest.approx(np.sqrt(np.mean(np.square(nine))), abs=0.02)
    fifteen = [x for (s, name), x in scores.items() if s == "left" or "pelvis" not in name]
    assert len(fifteen) == 15
    assert np.degrees(found.overall) == pytest.approx(np.sqrt(np.mean(np.square(fifteen))), abs=0.02)
    assert max(found.spread.values()) < 1e-6, "every cycle is the same"


def test_the_direction_of_the_walk_in_the_laboratory_does_not_matter(robot, known):
    one, other = (clinic.clinical_cycles(robot, turned(known, angle)) for angle in (0.0, 1.0))
    for a, b in zip(one, other, strict=True):
        assert set(a.curves) == set(b.curves)
        for angle, curve in a.curves.items():
            np.testing.assert_allclose(curve, b.curves[angle], atol=1e-6)
        np.testing.assert_allclose(a.toe_off, 62, atol=1e-9)


def test_a_hip_turned_in_turns_the_toes_in(robot, known):
    means = []
    for degrees in (0, 10):
        q = np.zeros_like(known.q)
        q[:, [JOINTS.index(f"{side}_hip_rotation") for side in SIDES]] = np.radians(degrees)
        upright = np.tile(np.eye(4), (len(known), 1, 1))
        upright[:, 0, 3] = known.time
        cycles = clinic.clinical_cycles(robot, replace(known, q=q, base=upright))
        means.append([np.degrees(side.mean("foot_progression")).mean() for side in cycles])
    np.testing.assert_allclose(np.diff(means, axis=0), 10, atol=0.1)


def test_a_pelvis_that_was_not_recorded_leaves_no_score(robot, known):
    found = clinic.gait_profile(
        clinic.clinical_cycles(robot, replace(known, base=None)), clinic.published_band()
    )
    assert math.isnan(found.overall)
    assert found.missing == ("pelvis_tilt", "pelvis_obliquity", "pelvis_rotation", "foot_progression")


def test_plug_in_gait_s_own_pelvis_is_the_computed_one(robot, shared):
    """The file's rotation counts from the laboratory's axis, ours from the way, which is 1-3 deg off."""
    file = open_trial(shared / "c3d_pig_walk_HC036A" / "HC036A10_walk.c3d")
    walk, further = load_gait(file), file.further_angles()
    for own, given in zip(
        clinic.clinical_cycles(robot, walk), clinic.clinical_cycles(robot, walk, further), strict=True
    ):
        assert len(given.curves) == 12
        apart = {x: np.degrees(np.abs(own.curves[x] - given.curves[x]).max()) for x in own.curves}
        assert apart["pelvis_tilt"] < 0.5
        assert apart["pelvis_obliquity"] < 1.0
        assert apart["pelvis_rotation"] < 4.0
        assert "Plug-in Gait" in given.sources["foot_progression"]
    assert file.session()["person"] == "HC036A"


def test_a_band_of_recordings_is_their_mean_and_spread_and_survives_its_file(robot, known, tmp_path):
    smaller = replace(known, q=0.5 * known.q)
    walks = [clinic.clinical_cycles(robot, walk) for walk in (known, smaller)]
    band = clinic.recorded_band(walks, "two")
    knee = band.curves["knee_flexion"]
    each = [np.mean([side.mean("knee_flexion") for side in sides], axis=0) for sides in walks]
    np.testing.assert_allclose(knee.mean, 0.75 * each[0], atol=1e-9)
    np.testing.assert_allclose(knee.sd, np.abs(each[0] - each[1]) / np.sqrt(2), atol=1e-9)
    assert knee.n == 2
    clinic.save_band(band, tmp_path / "ours.csv")
    again = clinic.load_band(tmp_path / "ours.csv")
    assert again.population == band.population
    assert list(again.curves) == list(band.curves)
    for angle, curve in band.curves.items():  # the file has 1e-5 deg
        np.testing.assert_allclose(again.curves[angle].mean, curve.mean, atol=1e-6)
        np.testing.assert_allclose(again.curves[angle].sd, curve.sd, atol=1e-6)
    with pytest.raises(GaitError, match="2 recordings"):
        clinic.recorded_band(walks[:1], "one")


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("", "no band"),
        ("a,b\n1,2\n", "no band"),
        ("angle,percent,mean_deg,sd_deg,n\n", "holds no angle"),
        ("angle,percent,mean_deg,sd_deg,n\nelbow,0,1,1,3\n", "line 2"),
        ("angle,percent,mean_deg,sd_deg,n\nknee_flexion,0,1,-1,3\n", "line 2"),
        ("angle,percent,mean_deg,sd_deg,n\nknee_flexion,0,x,1,3\n", "line 2"),
        ("angle,percent,mean_deg,sd_deg,n\nknee_flexion,0,1,1\n", "4 cells"),
        ("angle,percent,mean_deg,sd_deg,n\nknee_flexion,0,1,nan,3\n", "line 2"),
        ("angle,percent,mean_deg,sd_deg,n\nknee_flexion,0,1,1,3\nknee_flexion,50,1,1,3\n", "from 0 to 100"),
    ],
)
def test_files_that_are_no_band_are_refused_in_a_line(tmp_path, text, why):
    (tmp_path / "x.csv").write_text(text)
    with pytest.raises(FormatError, match=why):
        clinic.load_band(tmp_path / "x.csv")
