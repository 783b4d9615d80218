"""NumPy archives and ROS trajectories: exact round trips through every pair of formats, hostile files."""

from __future__ import annotations

import io
import itertools
import json
import pickle
import re
import tracemalloc
import zipfile

import numpy as np
import pytest
import yaml

from exo_pin.anatomy import JOINTS
from exo_pin.errors import FormatError
from exo_pin.formats import FORMATS, load_gait, save_gait
from exo_pin.gait import Gait, normative_gait

ROUND_TRIP = 1e-12  # [rad, m] text keeps every digit; degrees and back cost about 1e-16
NANOSECOND = 1e-9  # [s] what a ROS time can hold
WRITTEN = sorted(
    {entry.suffixes[0] for entry in FORMATS.values() if entry.write} - {".c3d"}
)  # 32 bits, no source: test_formats_c3d
BOMB = 192 * 2**20  # [bytes] the cap on a file, 128 MiB, and some; the hostile headers claim a terabyte


@pytest.fixture
def walk():
    gait = normative_gait("free", samples=20)
    return Gait(gait.time, gait.q, base=gait.base, events=gait.events, periodic=True, source='a "walk", é')


@pytest.mark.parametrize(("first", "second"), [*itertools.product(WRITTEN, WRITTEN)])
def test_every_pair_of_formats_keeps_the_walk(tmp_path, walk, first, second):
    save_gait(walk, tmp_path / f"one{first}")
    save_gait(load_gait(tmp_path / f"one{first}"), tmp_path / f"two{second}")
    back = load_gait(tmp_path / f"two{second}")
    np.testing.assert_allclose(back.q, walk.q, atol=ROUND_TRIP)
    np.testing.assert_allclose(back.time, walk.time, atol=NANOSECOND)
    assert (back.periodic, back.source) == (walk.periodic, walk.source)
    assert [(e.kind, e.side, e.source) for e in back.events] == [
        (e.kind, e.side, e.source) for e in walk.events
    ]
    np.testing.assert_allclose(back.base, walk.base, atol=ROUND_TRIP)


def test_an_archive_brings_back_the_same_bits(tmp_path, walk):
    save_gait(walk, tmp_path / "walk.npz")
    back = load_gait(tmp_path / "walk.npz")
    for name in ("time", "q", "base"):
        np.testing.assert_array_equal(getattr(back, name), getattr(walk, name))
    assert back.events == walk.events


def test_a_trajectory_is_what_ros_expects(tmp_path, walk):
    late = Gait(walk.time + 0.4, walk.q, source="late")
    save_gait(late, tmp_path / "walk.yaml")
    save_gait(late, tmp_path / "walk.json")
    message = yaml.safe_load((tmp_path / "walk.yaml").read_text())
    assert set(message) == {"header", "joint_names", "points"}  # no key that a ROS message lacks
    assert message["joint_names"] == list(JOINTS)
    point = message["points"][3]
    np.testing.assert_allclose(point["velocities"], late.dq[3], atol=ROUND_TRIP)
    np.testing.assert_allclose(point["accelerations"], late.ddq[3], atol=ROUND_TRIP)
    assert message["points"][0]["time_from_start"] == {"sec": 0, "nanosec": 0}
    assert json.loads((tmp_path / "walk.json").read_text())["points"] == message["points"]
    for name in ("walk.yaml", "walk.json"):
        np.testing.assert_allclose(load_gait(tmp_path / name).time, late.time, atol=NANOSECOND)


@pytest.mark.parametrize("around", [("joint_trajectory",), ("trajectory",), ("goal", "trajectory")])
def test_a_trajectory_inside_another_ros_message_is_read(tmp_path, walk, around):
    save_gait(walk, tmp_path / "walk.json")
    message = json.loads((tmp_path / "walk.json").read_text())
    for key in reversed(around):
        message = {key: message}
    path = tmp_path / "goal.yaml"
    path.write_text(yaml.safe_dump(message))
    np.testing.assert_allclose(load_gait(path).q, walk.q, atol=ROUND_TRIP)


@pytest.mark.parametrize("suffix", [".yaml", ".json"])
def test_the_pelvis_travels_beside_the_message_and_must_be_whole(tmp_path, walk, suffix):
    path = tmp_path / f"walk{suffix}"
    save_gait(walk, path)
    whole = path.read_text()
    line = re.search(r"# pelvis: [^\"\n]+", whole)[0]
    for wrong, match in (
        ("# pelvis: 1 2 3", "seven numbers"),
        ("# pelvis: 0 0 0 1 nan 0 0", "seven numbers"),
        ("# pelvis: 0 0 0 1 1 0 0", "not of length 1"),
        ("# other: 1", "19 lines '# pelvis: ...' for 20 points"),
    ):
        path.write_text(whole.replace(line, wrong))
        with pytest.raises(FormatError, match=match):
            load_gait(path)


def test_numbers_without_a_point_are_numbers_for_yaml_too(tmp_path):
    gait = Gait([0, 1], np.full((2, 12), 1e-05))
    save_gait(gait, tmp_path / "walk.yaml")
    np.testing.assert_array_equal(load_gait(tmp_path / "walk.yaml").q, gait.q)


def test_a_foreign_trajectory_is_read_in_its_own_order_and_names(tmp_path):
    names = [f"{joint}_joint" for joint in reversed(JOINTS)]
    points = [{"positions": [i / 100 + k for i in range(12)], "time_from_start": k} for k in (0, 1)]
    path = tmp_path / "t.json"
    path.write_text(json.dumps({"joint_names": names, "points": points}))
    gait = load_gait(path, mapping={f"{joint}_joint": joint for joint in JOINTS})
    np.testing.assert_allclose(gait.q[0], np.arange(11, -1, -1) / 100)
    with pytest.raises(FormatError, match="must be there once each"):
        load_gait(path)


@pytest.mark.parametrize(
    ("change", "match"),
    [
        (lambda m: m.pop("points"), "no JointTrajectory"),
        (lambda m: m["points"][1]["positions"].pop(), "point 1: positions must be 12 numbers"),
        (lambda m: m["points"][1].update(velocities=[1.0]), "point 1: velocities must be 12 numbers"),
        (lambda m: m["points"][1].update(time_from_start="1"), "point 1: time_from_start must be"),
        (lambda m: m["points"][1].update(time_from_start=0), "time does not increase"),
        (lambda m: m["points"][1]["positions"].__setitem__(0, 90.0), "more than half a turn"),
        (lambda m: m["points"][1]["positions"].__setitem__(0, True), "must be 12 numbers"),
        (lambda m: m["joint_names"].__setitem__(0, "right_hip_flexion"), "once each"),
    ],
)
@pytest.mark.parametrize("suffix", [".json", ".yaml"])
def test_malformed_trajectories_are_refused_with_the_point(tmp_path, walk, change, match, suffix):
    save_gait(walk, tmp_path / "walk.json")
    message = json.loads((tmp_path / "walk.json").read_text())
    change(message)
    path = tmp_path / f"bad{suffix}"
    path.write_text(json.dumps(message) if suffix == ".json" else yaml.safe_dump(message))
    with pytest.raises(FormatError, match=match):
        load_gait(path)


LAUGHS = "a: &a [x,x]\nb: &b [*a,*a]\nc: [*b,*b]\n"


@pytest.mark.parametrize(
    ("suffix", "text", "match"),
    [
        (".yaml", "[" * 100_000, "no YAML|levels deep"),
        (".yaml", "- " * 50_000, "no YAML|levels deep"),
        (".yaml", LAUGHS, "holds an alias"),
        (".yaml", "!!python/object/apply:os.system [id]", "no YAML"),
        (".yaml", "a: [1, 2\nb: 3", "no YAML"),
        (".yaml", "{[1]: 2, ? [a] : b}", "no"),
        (".json", "[" * 100_000, "deep"),
        (".json", '{"a": 1', "no JSON"),
        (".json", "9" * 10_000, "no JSON"),
    ],
)
def test_hostile_texts_are_refused(tmp_path, suffix, text, match):
    path = tmp_path / f"bad{suffix}"
    path.write_text(text)
    with pytest.raises(FormatError, match=match):
        load_gait(path)


def archive(path, **arrays):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as file:
        for name, data in arrays.items():
            file.writestr(f"{name}.npy", data)


def npy(array):
    out = io.BytesIO()
    np.save(out, array, allow_pickle=True)
    return out.getvalue()


def test_hostile_archives_are_refused_before_memory_is_spent(tmp_path, monkeypatch):
    path = tmp_path / "bad.npz"
    tracemalloc.start()
    header = npy(np.zeros(2)).replace(b"(2,), }           ", b"(200000000000,), }")
    archive(path, time=header)
    with pytest.raises(FormatError, match="not as long as it says"):
        load_gait(path)
    archive(path, time=npy(np.array([print, 1], dtype=object)))
    with pytest.raises(FormatError, match="pickled data are not read"):
        load_gait(path)
    archive(path, **{f"a{i}": b"" for i in range(100)})
    with pytest.raises(FormatError, match="at most 64"):
        load_gait(path)
    path.write_bytes(pickle.dumps([1]))
    with pytest.raises(FormatError, match="not a NumPy archive"):
        load_gait(path)
    assert tracemalloc.get_traced_memory()[1] < BOMB
    tracemalloc.stop()
    archive(path, time=bytes(300 * 2**20))
    assert path.stat().st_size < 2**20
    with pytest.raises(FormatError, match="MiB unpacked"):
        load_gait(path)


@pytest.mark.parametrize(
    ("change", "match"),
    [
        ({"q": None}, "no array 'q'"),
        ({"q": np.zeros((20, 11))}, "q has shape"),
        ({"joints": np.array(["x"] * 12)}, "expected left_hip_flexion"),
        ({"q": np.array([["x"] * 12] * 20)}, "holds no numbers"),
        ({"time": np.zeros(20)}, "time does not increase"),
        ({"event_kind": None}, "must be there together"),
        ({"event_kind": np.array(["jump"] * 4)}, "expected 'heel_strike' or 'toe_off'"),
        ({"base": np.zeros((20, 4, 4))}, "no rigid pose"),
    ],
)
def test_archives_that_are_no_walk_say_why(tmp_path, walk, change, match):
    save_gait(walk, tmp_path / "walk.npz")
    with np.load(tmp_path / "walk.npz") as file:
        arrays = dict(file) | change
    np.savez(tmp_path / "bad.npz", **{name: x for name, x in arrays.items() if x is not None})
    with pytest.raises(FormatError, match=match):
        load_gait(tmp_path / "bad.npz")
