"""Two readers of C3D files: the same content, one where the other fails; force plates by their signals."""

from __future__ import annotations

from importlib.util import find_spec

import numpy as np
import pytest

from exo_pin.errors import FormatError
from exo_pin.formats import load_gait, open_trial, save_gait
from exo_pin.formats.c3d import reader
from exo_pin.formats.c3d.parameters import C3dParameters
from exo_pin.formats.c3d.plate_signals import plates_of
from exo_pin.formats.c3d.reader import read_content
from exo_pin.gait import Gait, normative_gait

EZC3D_ADDS = {"ANALOG:FORMAT", "ANALOG:BITS", "FORCE_PLATFORM:CAL_MATRIX"}
"""Parameters that ezc3d invents, empty, where a file has none."""


@pytest.fixture
def path(tmp_path):
    walk = normative_gait("free", samples=51).resampled(50)
    gait = Gait(0.02 * np.arange(50), walk.q, base=walk.base, events=walk.events[:1])
    save_gait(gait, tmp_path / "walk.c3d")
    return tmp_path / "walk.c3d"


def same(one, other):
    for name in (
        "columns",
        "angles",
        "outputs",
        "length_unit",
        "angle_unit",
        "vertical",
        "analog_rate",
    ):
        assert getattr(one, name) == getattr(other, name), name
    for name in ("time", "points"):
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name))
    assert (one.events.labels, one.events.contexts) == (other.events.labels, other.events.contexts)
    np.testing.assert_array_equal(one.events.times, other.events.times)
    assert len(one.plates) == len(other.plates)
    for plate, again in zip(one.plates, other.plates, strict=True):
        for name in ("force", "point", "moment"):
            np.testing.assert_array_equal(getattr(plate, name), getattr(again, name))
    texts = [{k: v for k, v in c.parameters.texts.items() if k not in EZC3D_ADDS} for c in (one, other)]
    numbers = [
        {k: v.tolist() for k, v in c.parameters.numbers.items() if k not in EZC3D_ADDS} for c in (one, other)
    ]
    assert texts[0] == texts[1]
    assert numbers[0] == numbers[1]
    assert one.analysis == other.analysis


def test_both_readers_find_the_same_in_every_file_at_hand(shared, path):
    files = [path, *sorted(shared.glob("*/*.c3d")), *sorted((shared.parent / "trials").rglob("*.c3d"))]
    for file in files:
        same(read_content(file, ("ezc3d",)), read_content(file, ("c3d",)))
    assert len(files) > 1


def test_a_childs_measures_stand_in_the_parameters(shared):
    for name in reader.READERS:
        content = read_content(shared / "c3d_pig_walk_HC036A/HC036A10_walk.c3d", (name,))
        number = content.parameters.number
        assert [number(f"PROCESSING:{key}") for key in ("HEIGHT", "LLEGLENGTH")] == [1340, 700]
        assert number("PROCESSING:BODYMASS") == 33
        assert content.parameters.texts["SUBJECTS:NAMES"] == ("HC036A",)
        assert content.parameters.number("PROCESSING:SHOE_SIZE") is None


@pytest.mark.parametrize("code", ["raise RuntimeError('bad_alloc')", "import os; os.kill(os.getpid(), 11)"])
def test_where_the_first_reader_fails_the_second_reads_and_that_is_said(path, tmp_path, monkeypatch, code):
    expected = load_gait(path)
    script = tmp_path / "child_process.py"
    script.write_text(reader.CHILD_SCRIPT.read_text())
    (tmp_path / "by_ezc3d.py").write_text(code)
    (tmp_path / "by_c3d.py").write_text(reader.CHILD_SCRIPT.with_name("by_c3d.py").read_text())
    monkeypatch.setattr(reader, "CHILD_SCRIPT", script)
    gait = load_gait(path)
    np.testing.assert_array_equal(gait.q, expected.q)
    assert gait.remarks[0] == "ezc3d cannot read it, c3d does"


def test_without_ezc3d_the_other_reader_serves_and_without_both_the_packages_are_named(path, monkeypatch):
    expected, found = load_gait(path), find_spec
    monkeypatch.setattr(reader, "find_spec", lambda name: found(name) if name == "c3d" else None)
    gait = load_gait(path)
    np.testing.assert_array_equal(gait.q, expected.q)
    assert gait.remarks == ()
    monkeypatch.setattr(reader, "find_spec", lambda name: None)
    with pytest.raises(FormatError, match="ezc3d or c3d: not installed"):
        open_trial(path)


def plate(kind, rows, corners, origin, **more):
    """One plate of FORCE_PLATFORM, its signals `(c, m)`."""
    numbers = {"USED": [1], "TYPE": [kind], "CORNERS": corners, "ORIGIN": origin, **more}
    numbers |= {"CHANNEL": np.arange(1, len(rows) + 1)[:, None]}
    parameters = {f"FORCE_PLATFORM:{name}": np.asarray(value, float) for name, value in numbers.items()}
    return plates_of(C3dParameters({"POINT:UNITS": ("mm",)}, parameters), np.asarray(rows, float))


CORNERS = np.array([[300, 0, 0, 300], [200, 200, -200, -200], [0, 0, 0, 0]], float)[:, [0, 1, 2, 3]]
"""Columns are corners 1 to 4 of the user guide: +x +y, -x +y, -x -y, +x -y."""


def test_a_load_on_a_plate_of_each_type_stands_where_it_was_put():
    """700 N at 50 and -30 mm from the middle, sensors 40 mm below (z points down); closed form."""
    x, y, depth, force = 50.0, -30.0, 40.0, np.array([20.0, 10.0, 700.0])
    two = [*force, *(turning := np.cross([x, y, -depth], force))]
    a, b = 120.0, 150.0  # of the four sensors from the middle, which stand at +x+y, -x+y, -x-y, +x-y
    flat = np.cross([x, y, 0], force)
    z = np.linalg.solve([[1, 1, 1, 1], [b, b, -b, -b], [-a, a, a, -a], [1, -1, 1, -1]], [700, *flat[:2], 0])
    y14, y23 = 0.5 * (force[1] + turning[2] / a), 0.5 * (force[1] - turning[2] / a)
    matrix = np.diag([2.0, 1, 1, 1, 1, 4])
    # the sensors feel the horizontal force below the surface, too
    mx, my = np.cross([0, 0, -depth], force)[:2]
    tilt = np.linalg.solve([[1, 1, 1, 1], [b, b, -b, -b], [-a, a, a, -a], [1, -1, 1, -1]], [0, mx, my, 0])
    cases = (
        (1, [*force, x, y, 0.0], [0, 0, 0], {}),
        (2, two, [0, 0, -depth], {}),
        (2, two, [0, 0, depth], {}),  # seen from the surface
        (3, [10, 10, y14, y23, *(z + tilt)], [a, b, -depth], {}),
        (4, np.linalg.solve(matrix, two), [0, 0, -depth], {"CAL_MATRIX": matrix[:, :, None]}),
    )
    for kind, channels, origin, more in cases:
        rows = np.array(channels)[:, None].repeat(2, axis=1)
        found = plate(kind, rows, CORNERS[:, :, None], np.c_[origin], **more)
        (only,) = found.plates
        assert found.remarks == ()
        np.testing.assert_allclose(only.force[0], force, atol=1e-9, err_msg=str(kind))
        np.testing.assert_allclose(only.point[0], [150 + x, y, 0], atol=1e-6, err_msg=str(kind))
        np.testing.assert_allclose(only.moment[0], [0, 0, 0], atol=1e-6, err_msg=str(kind))


def test_plates_are_those_of_ezc3d_in_the_recording(shared):
    """An independent path: ezc3d's own force platform filter."""
    ezc3d = pytest.importorskip("ezc3d")
    file = shared / "c3d_pig_walk_HC036A/HC036A10_walk.c3d"
    theirs = ezc3d.c3d(str(file), extract_forceplat_data=True)["data"]["platform"]
    ours = read_content(file).plates
    assert len(ours) == len(theirs) == 2
    for plate, other in zip(ours, theirs, strict=True):
        np.testing.assert_allclose(plate.force.T, other["force"], atol=1e-9)
        loaded = np.abs(plate.force[:, 2]) > 20  # else a moment is divided by nearly nothing
        np.testing.assert_allclose(
            plate.point.T[:, loaded], other["center_of_pressure"][:, loaded], atol=1e-6
        )
        np.testing.assert_allclose(plate.moment.T[:, loaded], other["Tz"][:, loaded], atol=1e-6)


@pytest.mark.parametrize(
    ("kind", "change"),
    [
        (5, {}),
        (2, {"CORNERS": np.zeros((3, 4, 1))}),
        (2, {"ORIGIN": np.zeros((2, 1))}),
        (3, {}),
        (np.nan, {}),
    ],
)
def test_a_plate_that_is_not_understood_is_left_out_and_named(kind, change):
    found = plate(
        kind,
        np.ones((6, 2)),
        **(
            {"corners": CORNERS[:, :, None], "origin": np.zeros((3, 1))}
            | {key.lower(): value for key, value in change.items()}
        ),
    )
    assert found.plates == ()
    assert "force plate 1" in found.remarks[0]
