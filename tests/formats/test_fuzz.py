"""Damaged files end in a FormatError that names the file, never in another exception, and quickly."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from exo_pin.anatomy import FEET, SIDES
from exo_pin.errors import FormatError
from exo_pin.formats import FORMATS, Poses, load_gait, load_poses, save_gait, save_poses
from exo_pin.gait import Gait, normative_gait

FILES = 100  # damaged files of each kind; enough to meet the common branches, few enough for seconds
FILES_C3D = 25  # each costs a process
SLOWEST = 5000  # [ms] bounded time, with room for a busy machine
PIECES = [  # what hurts readers
    *(
        b"",
        b"\0",
        b"\xff\xfe",
        b"\n",
        b"\r",
        b"\t",
        b",",
        b";",
        b'"',
        b"#",
        b"=",
        b"-",
        b" ",
        b"\xe2\x80\xa8",
    ),
    *(
        b"nan",
        b"inf",
        b"-inf",
        b"1e999",
        b"1e308",
        b"-1e308",
        b"1e-320",
        b"0",
        b"9" * 400,
        b"1_0",
        b"0x1p3",
        b"1+2j",
    ),
    *(
        b"nRows=99999999999999",
        b"nColumns=1e99",
        b"inDegrees=no",
        b"endheader",
        b"datarows -3",
        b"# preset: opensim-gait2392",
    ),
    *(
        b"# event: 1e308 toe_off left",
        b'# source: "\\ud800"',
        b"# periodic: true",
        b"/value",
        b"time",
        b"\xd9\xa1",
    ),
]


@st.composite
def damaged(draw, text):
    """The file with a few places overwritten, cut out or filled in."""
    data = bytearray(text)
    for _ in range(draw(st.integers(1, 3))):
        start = draw(st.integers(0, len(data)))
        length = draw(st.sampled_from([0, 1, 2, 5, 20, 200]))
        piece = draw(st.sampled_from(PIECES) | st.binary(max_size=4))
        data[start : start + length] = piece
    return bytes(data[: draw(st.sampled_from([len(data), len(data) // 2]))])


def examples():
    walk = normative_gait("free", samples=17)
    fast = Gait(walk.time[:3], walk.q[:3], base=walk.base[:3], events=walk.events[:1], source="é")
    return {
        **dict.fromkeys(FORMATS, fast),
        "poses": Poses(fast.time, fast.base, dict.fromkeys(FEET, fast.base)),
    }


def write_example(kind, path):
    """An undamaged file of the kind."""
    if kind == ".txt":  # only read: somebody's table
        save_gait(examples()[kind], path.with_suffix(".tsv"))
        lines = path.with_suffix(".tsv").read_text().splitlines()
        path.write_text("\n".join(line for line in lines if not line.startswith("#")))
    elif kind == ".subgait":  # only read: an exoskeleton's set points
        names = ("hip_fe", "hip_aa", "knee", "ankle")
        point = "  - {{position: 0.1, time_from_start: {{secs: 0, nsecs: {}}}, velocity: 0.0}}"
        points = [point.format(t) for t in (0, 20_000_000)]
        joints = ["\n".join([f"  {side}_{name}:", *points]) for side in SIDES for name in names]
        path.write_text("\n".join(["duration: {secs: 0, nsecs: 20000000}", "joints:", *joints, ""]))
    elif kind == "poses":
        save_poses(examples()[kind], path)
    else:
        save_gait(examples()[kind], path)


def attempt(read, path):
    try:
        return read(path), ""
    except FormatError as error:
        return None, str(error)


@pytest.mark.parametrize(
    "kind", [*{entry.name: entry.suffixes[0] for entry in FORMATS.values()}.values(), "poses"]
)
def test_damaged_files_are_read_or_refused_but_never_crash(tmp_path_factory, kind):
    folder = tmp_path_factory.mktemp("fuzz")
    path = folder / ("poses.csv" if kind == "poses" else f"walk{kind}")
    read, save = (load_poses, save_poses) if kind == "poses" else (load_gait, save_gait)
    written = kind == "poses" or FORMATS[kind].write
    again = folder / (f"again{path.suffix}" if written else "again.csv")
    write_example(kind, path)
    whole = path.read_bytes()
    assert read(path).time.shape == (3,)

    @settings(max_examples=FILES_C3D if kind == ".c3d" else FILES, deadline=SLOWEST)
    @given(damaged(whole))
    def once(data):
        path.write_bytes(data)
        result, message = attempt(read, path)
        if result is None:
            assert path.name in message
            assert "\n" not in message
            assert len(message) < 1000
        else:
            assert np.isfinite(result.time).all()
            save(result, again)  # what was read can be written

    once()
