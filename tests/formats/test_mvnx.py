"""Xsens MVN recordings: every sign against the segments' orientations, the pelvis, contacts, XML's limits."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from exo_pin.anatomy import JOINTS
from exo_pin.errors import FormatError
from exo_pin.formats import load_gait
from exo_pin.formats.xsens.mvnx_file import _ANGLES
from exo_pin.gait import Gait, normative_gait

DIGITS = 2e-8  # [rad, m] the file has nine decimals of degrees, metres and quaternions


@pytest.fixture
def walk():
    gait = normative_gait("free", samples=65).resampled(66).repeated(2)
    base = np.tile(np.eye(4), (len(gait), 1, 1))
    turned = Rotation.from_euler("zyx", np.random.default_rng(5).uniform(-0.2, 0.2, (len(gait), 3)))
    base[:, :3, :3], base[:, 0, 3], base[:, 2, 3] = turned.as_matrix(), np.arange(len(gait)) / 60, 0.9
    return Gait(np.arange(len(gait)) / 60, gait.q, base=base, events=_scaled(gait))


def _scaled(gait):
    from dataclasses import replace

    factor = (len(gait) - 1) / 60 / float(gait.time[-1])
    return tuple(replace(e, time=e.time * factor) for e in gait.events)


@pytest.fixture
def path(tmp_path):
    return tmp_path / "walk.mvnx"


def test_the_walk_comes_back_from_orientations_of_segments(lab, path, walk):
    path.write_text(lab.mvnx(walk))
    back = load_gait(path)
    np.testing.assert_allclose(back.q, walk.q, atol=DIGITS)
    np.testing.assert_allclose(back.base, walk.base, atol=DIGITS)
    np.testing.assert_allclose(back.time, walk.time, atol=1e-12)
    assert "Xsens MVN 2019.0.0" in back.source
    assert back.remarks == ()


def test_contacts_are_heel_strikes_and_toe_offs(lab, path, walk):
    path.write_text(lab.mvnx(walk))
    back = load_gait(path)
    inside = [e for e in walk.events if 0.05 < e.time < walk.time[-1] - 0.05]
    assert [(e.kind, e.side) for e in back.events] == [(e.kind, e.side) for e in inside]
    np.testing.assert_allclose([e.time for e in back.events], [e.time for e in inside], atol=1 / 60)
    path.write_text(lab.mvnx(walk, contacts=False))
    assert load_gait(path).events == ()


# One standing frame of a public recording (robotology-playground/xsens-mvn, Meri-020.mvnx, frame 0):
# orientations of pelvis, right and left upper leg, lower leg, foot (w x y z), and joint angles [deg].
PUBLIC = [
    [0.997286, 0.000878, -0.073481, 0.004489],
    [0.999720, -0.012293, 0.020027, 0.002841],
    [0.994623, -0.038518, 0.044450, -0.085243],
    [0.995117, -0.017264, 0.000333, -0.097184],
    [0.999475, 0.022691, 0.021202, 0.009223],
    [0.998255, 0.032124, 0.045161, 0.020407],
    [0.997596, 0.007292, 0.019211, 0.066180],
]
ANGLES = {
    "right": {
        "Hip": (1.456553, -0.225317, -10.732640),
        "Knee": (2.529772, -10.204804, 3.180902),
        "Ankle": (-2.853714, -1.564298, 4.812733),
    },
    "left": {
        "Hip": (2.536962, -0.589502, -10.860195),
        "Knee": (1.051345, -1.268811, 2.778345),
        "Ankle": (-3.007412, -5.285477, 2.881475),
    },
}


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("movement", _ANGLES)
def test_every_sign_is_that_of_the_segments_in_a_public_recording(lab, side, movement):
    """Rotation about our axes (x forward, y left, z up) of the distal segment in the proximal one."""
    name, component, sign = _ANGLES[movement]
    turns = Rotation.from_quat(np.roll(PUBLIC, -1, axis=1))
    below = {"Hip": 1, "Knee": 2, "Ankle": 3}[name] + (3 if side == "left" else 0)
    above = 0 if name == "Hip" else below - 1
    z, x, y = (lab.ISB * turns[above].inv() * turns[below] * lab.ISB.inv()).as_euler("ZXY", degrees=True)
    inward = (
        1 if side == "right" else -1
    )  # about x forward and y up: adduction and inversion, internal rotation
    flexion = -z if name == "Knee" else z
    expected = {0: inward * x, 1: inward * y, 2: flexion}[component]
    assert sign * ANGLES[side][name][component] == pytest.approx(
        expected, abs=2e-3
    )  # six decimals of quaternions


def test_time_is_that_of_the_frames_numbers_or_milliseconds(lab, path, walk):
    path.write_text(lab.mvnx(walk, first=120))
    np.testing.assert_allclose(load_gait(path).time, 2 + walk.time, atol=1e-12)
    path.write_text(lab.mvnx(walk).replace(' index="', ' number="'))
    back = load_gait(path)
    assert "evened to 60 Hz" in back.remarks[-1]
    np.testing.assert_allclose(back.time - back.time[0], walk.time, atol=1e-3)


def test_a_document_type_that_names_a_file_is_ignored_but_definitions_are_refused(lab, path, walk):
    bare = '<?xml version="1.0"?><!DOCTYPE mvnx SYSTEM "file:///etc/passwd">'
    path.write_text(lab.mvnx(walk, head=bare))
    np.testing.assert_allclose(load_gait(path).q, walk.q, atol=DIGITS)
    path.write_text(lab.mvnx(walk, head='<?xml version="1.0"?><!DOCTYPE mvnx [<!ENTITY a "b">]>'))
    with pytest.raises(FormatError, match="document type with definitions"):
        load_gait(path)
    path.write_text(lab.mvnx(walk, head=bare).replace("<velocity>1", "<velocity>&a;"))
    with pytest.raises(FormatError, match="entity 'a'"):
        load_gait(path)


@pytest.mark.parametrize(
    ("old", "new", "match"),
    [
        ("jointAngle>", "angle>", "export the joint angles"),
        ('label="jLeftKnee"', 'label="jLeftKnie"', "no joint jLeftKnee"),
        ("<mvnx", "<mvny", "no XML"),
        ('type="normal"', 'type="tpose"', "0 frames of type normal"),
        ("1.000000000 ", "1e999 ", "finite"),
        ("</velocity><jointAngle>", "</velocity><jointAngle>1 ", "expected 18"),
        ("</velocity><jointAngle>", "</velocity><jointAngle>x ", "no numbers"),
    ],
)
def test_what_is_no_recording_is_refused_with_the_reason(lab, path, walk, old, new, match):
    still = Gait(walk.time, walk.q, base=np.tile(np.eye(4), (len(walk), 1, 1)), events=walk.events)
    path.write_text(lab.mvnx(still).replace(old, new))
    with pytest.raises(FormatError, match=match):
        load_gait(path)


def test_without_the_pelvis_the_joints_alone_are_read(lab, path, walk):
    path.write_text(lab.mvnx(walk).replace("position>", "place>"))
    back = load_gait(path)
    assert back.base is None
    assert "it does not move" in back.remarks[0]
    assert back.q.shape[1] == len(JOINTS)
