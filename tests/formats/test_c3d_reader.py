"""C3D files: angles, base, events, plates and markers in SI units; damaged files end in one line."""

from __future__ import annotations

import dataclasses
import sys
import time

import numpy as np
import pytest

from exo_pin.anatomy import JOINTS
from exo_pin.errors import FormatError
from exo_pin.formats import load_gait, load_markers, save_gait
from exo_pin.formats.c3d import header, reader
from exo_pin.formats.c3d.plug_in_gait import model_angles
from exo_pin.gait import Gait, normative_gait
from exo_pin.gait.trial import to_z_up

ANGLE = 1e-5  # [deg] C3D holds 32-bit numbers
LENGTH = 1e-6  # [m]
CLOCK = 1e-6  # [s] event times are 32-bit seconds
RELATION = 1e-3  # [deg] the promise; the file's own 32-bit numbers allow 1e-4
WALK = "c3d_pig_walk_HC036A/HC036A10_walk.c3d"


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """A gait whose samples begin at 0.5 s, and its file."""
    walk = normative_gait("free", samples=101).resampled(100)
    gait = Gait(0.5 + 0.01 * np.arange(100), walk.q, base=walk.base, events=[])
    events = [type(e)(0.5 + e.time / walk.duration * 0.98, e.kind, e.side) for e in walk.events]
    gait = Gait(gait.time, gait.q, base=gait.base, events=events)
    path = tmp_path_factory.mktemp("c3d") / "walk.c3d"
    save_gait(gait, path)
    return gait, path


def test_a_written_file_brings_the_walk_back(written):
    gait, path = written
    back = load_gait(path)
    np.testing.assert_allclose(np.degrees(back.q), np.degrees(gait.q), atol=ANGLE)
    np.testing.assert_allclose(back.base, gait.base, atol=LENGTH)
    np.testing.assert_allclose(back.time, gait.time, atol=CLOCK)
    assert [(e.kind, e.side) for e in back.events] == [(e.kind, e.side) for e in gait.events]
    assert [e.time for e in back.events] == pytest.approx([e.time for e in gait.events], abs=CLOCK)
    assert "Plug-in Gait" in back.source


def test_a_pelvis_without_a_stated_vertical_stands_upright_and_one_seen_in_part_is_kept(written):
    gait, path = written
    trial = load_markers(path)
    for up in ("+y", "-x"):  # a laboratory with another vertical, which the file does not state
        turned = trial.turned(to_z_up(up).T)
        base = model_angles(path, dataclasses.replace(turned, up="")).base
        np.testing.assert_allclose(base[:, 2, 3], gait.base[:, 2, 3], atol=LENGTH)
        np.testing.assert_allclose(base[:, 2, :3], gait.base[:, 2, :3], atol=LENGTH)
    angles = {name: values.copy() for name, values in trial.angles.items()}
    position = trial.position.copy()
    for values in (*angles.values(), position):
        values[:10] = np.nan
    part = model_angles(path, dataclasses.replace(trial, angles=angles, position=position))
    np.testing.assert_allclose(part.base, gait.base[10:], atol=LENGTH)
    position[50] = np.nan
    assert model_angles(path, dataclasses.replace(trial, angles=angles, position=position)).base is None


def test_uneven_samples_are_refused_and_nothing_is_written(tmp_path):
    with pytest.raises(FormatError, match="sample the walk at a rate first"):
        save_gait(Gait([0, 0.1, 0.25], np.zeros((3, 12))), tmp_path / "walk.c3d")
    assert not list(tmp_path.iterdir())


def test_times_rounded_to_milliseconds_come_back_on_the_grid(tmp_path):
    time = np.round(0.5 + np.arange(61) / 60, 3)
    walk = normative_gait("free", samples=61)
    save_gait(Gait(time, walk.q, base=walk.base), tmp_path / "walk.c3d")
    back = load_gait(tmp_path / "walk.c3d")
    np.testing.assert_allclose(back.time, 0.5 + np.arange(61) / 60, atol=CLOCK)
    np.testing.assert_allclose(np.degrees(back.q), np.degrees(walk.q), atol=ANGLE)


def test_only_what_fits_a_c3d_file_may_be_said_of_it(written):
    with pytest.raises(FormatError, match="does not fit a C3D file"):
        load_gait(written[1], preset="opensim-gait2392")
    with pytest.raises(FormatError, match="mapping is not for this kind of file"):
        load_gait(written[1], mapping={"a": "left_knee_flexion"})


def damaged(path, tmp_path, change):
    data = bytearray(path.read_bytes())
    changed = change(data)
    out = tmp_path / "bad.c3d"
    out.write_bytes(data if changed is None else changed)
    return out


@pytest.mark.parametrize(
    ("change", "match"),
    [
        (lambda d: d[:-600], "cut short"),
        (lambda d: d[:300], "not a C3D file"),
        (lambda d: d[:0], "not a C3D file"),
        (lambda d: b"\x00" * len(d), "not a C3D file"),
        (lambda d: d.__setitem__(0, 200), "outside the file"),
        (lambda d: d.__setitem__(515, 85), " Hz; expected a recording"),  # as DEC numbers these are others
        (lambda d: d.__setitem__(515, 7), "processor 7"),
        (lambda d: d.__setitem__(slice(2, 4), b"\xff\x7f"), "bytes, the file has|points in one place"),
        (lambda d: d.__setitem__(slice(516, 518), b"\x7f\x01"), "damaged|points or frames|bytes"),
    ],
)
def test_damaged_files_are_refused_in_one_line(written, tmp_path, change, match):
    path = damaged(written[1], tmp_path, change)
    with pytest.raises(FormatError, match=match) as caught:
        load_gait(path)
    assert "\n" not in str(caught.value)


def test_a_rate_of_0_in_the_header_is_that_of_the_parameters(written, tmp_path):
    path = damaged(written[1], tmp_path, lambda d: d.__setitem__(slice(20, 24), b"\0\0\0\0"))
    np.testing.assert_allclose(load_gait(path).time, load_gait(written[1]).time, atol=1e-9)


def test_every_truncation_is_noticed_by_the_header_check(written, tmp_path):
    data = written[1].read_bytes()
    layout = header.check(written[1], data)
    assert (layout.frames, layout.first) == (100, 51)
    used = len(data) - 512  # the last block may be padding
    for size in range(0, used, 997):
        with pytest.raises(FormatError):
            header.check(written[1], data[:size])


@pytest.mark.parametrize(
    ("code", "match"),
    [
        ("import os; os.kill(os.getpid(), 11)", "crash the reader"),
        ("import time; time.sleep(60)", "takes more than 2 s"),
        ("raise SystemExit('std::out_of_range')", "do not fit the C3D format"),
        ("x = bytearray(1 << 42)", "too much memory"),
    ],
)
def test_a_crash_a_hang_or_a_glutton_stays_in_the_child(written, tmp_path, monkeypatch, code, match):
    fake = tmp_path / "child_process.py"
    fake.write_text(code)
    monkeypatch.setattr(reader, "TIME_LIMIT", 0.5)
    monkeypatch.setattr(reader, "CHILD_SCRIPT", fake)
    start = time.perf_counter()
    with pytest.raises(FormatError, match=match) as caught:
        load_gait(written[1])
    assert "std::" not in str(caught.value)
    assert "signal" not in str(caught.value)
    assert time.perf_counter() - start < 20  # slow machines; the limit is 1 s


def test_no_reader_is_loaded_into_this_process_by_reading(written):
    for package in reader.READERS:
        sys.modules.pop(package, None)
    load_gait(written[1])
    assert not set(reader.READERS) & set(sys.modules)


def rotations(trial, name):
    """`(n, 3, 3)` of a segment: columns anterior, left, proximal."""
    origin = trial.of(f"{name}O")
    R = np.stack([trial.of(f"{name}{axis}") - origin for axis in "ALP"], axis=2)
    return R / np.linalg.norm(R, axis=1, keepdims=True)


def cardan(R):
    """Angles a, b, g [deg] of R = Ry(a) Rx(b) Rz(g)."""
    a = np.arctan2(R[:, 0, 2], R[:, 2, 2])
    b = np.arcsin(-R[:, 1, 2])
    g = np.arctan2(R[:, 1, 0], R[:, 1, 1])
    return np.degrees(np.stack([a, b, g], axis=1))


@pytest.mark.parametrize(("side", "sign"), [("left", -1), ("right", 1)])
def test_angles_recomputed_from_the_segments_are_those_of_the_file(shared, side, sign):
    trial, gait = load_markers(shared / WALK), load_gait(shared / WALK)
    S = side[0].upper()
    pelvis, femur, tibia, foot = (rotations(trial, name) for name in ("PEL", f"{S}FE", f"{S}TI", f"{S}FO"))
    hip = cardan(pelvis.transpose(0, 2, 1) @ femur)
    knee = cardan(femur.transpose(0, 2, 1) @ tibia)
    ankle = cardan(tibia.transpose(0, 2, 1) @ foot)
    expected = {
        "hip_flexion": -hip[:, 0],
        "hip_adduction": sign * hip[:, 1],
        "hip_rotation": sign * hip[:, 2],
        "knee_flexion": knee[:, 0],
        "ankle_dorsiflexion": -ankle[:, 0] - 90,
        "ankle_inversion": -sign * ankle[:, 2],  # Plug-in Gait's own angle is eversion
    }
    for movement, angle in expected.items():
        ours = np.degrees(gait.q[:, JOINTS.index(f"{side}_{movement}")])
        np.testing.assert_allclose(ours, angle, atol=RELATION, err_msg=movement)


def test_the_recording_has_its_units_events_and_plates(shared):
    trial = load_markers(shared / WALK)
    assert (len(trial), trial.time[0], trial.up) == (178, 0.78, "+z")
    assert 0.6 < np.nanmean(trial.of("LASI")[:, 2]) < 0.9  # a child's pelvis [m]
    assert len(trial.events) == 9
    first, second = trial.plates
    standing = first.force[:, 2] > 20
    assert first.time[standing][[0, -1]] == pytest.approx([1.17, 1.64], abs=0.01)  # the file's own events
    assert 0.9 < first.force[:, 2].max() / (33 * 9.81) < 1.6  # body weights of a walking child
    assert np.abs(first.point[standing]).max() < 1
    assert second.force.shape == (1780, 3)


def test_the_static_trial_stands(shared):
    gait = load_gait(shared / WALK.replace("10_walk", "01_static"))
    assert np.ptp(np.degrees(gait.q), axis=0).max() < 5
    assert gait.events == ()
