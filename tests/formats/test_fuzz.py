"""Damaged files end in a FormatError that names the file, never in another exception, and quickly."""

from __future__ import annotations

import time

import numpy as np
import pytest
from hypothesis import given, settings

from exo_pin.anatomy import FEET, SIDES
from exo_pin.errors import FormatError
from exo_pin.formats import (
    FORMATS,
    Markers,
    Poses,
    load_forces,
    load_gait,
    load_markers,
    load_poses,
    load_torques,
    save_gait,
    save_poses,
)
from exo_pin.formats.c3d import C3dFile
from exo_pin.formats.c3d.reader import read_content
from exo_pin.gait import Event, Gait, normative_gait
from tests.damaged_files import FILES, SLOWEST, damaged, files_of_processes

FILES_C3D = files_of_processes(5, 15)
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
        b"n/a",
        b"<!DOCTYPE a [",
        b"&lt;",
        b"<frame>",
        b"Devices",
        b"!LeftSpeed",
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


LARGEST = {"angle": np.pi, "place": 1e4, "force": 1e5}  # [rad, m, N] what may be read at most


def walk(samples=17):
    gait = normative_gait("free", samples=samples)
    time = np.arange(3) / 100
    return Gait(time, gait.q[:3], base=gait.base[:3], events=[Event(0.01, "heel_strike", "left")], source="é")


def subgait():
    """An exoskeleton's set points."""
    names = ("hip_fe", "hip_aa", "knee", "ankle")
    point = "  - {{position: 0.1, time_from_start: {{secs: 0, nsecs: {}}}, velocity: 0.0}}"
    points = [point.format(t) for t in (0, 20_000_000)]
    joints = ["\n".join([f"  {side}_{name}:", *points]) for side in SIDES for name in names]
    return "\n".join(["duration: {secs: 0, nsecs: 20000000}", "joints:", *joints, ""])


def trc():
    head = ["PathFileType\t4\t(X/Y/Z)\twalk.trc", "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits"]
    head += ["60\t60\t3\t2\tmm", "Frame#\tTime\tA:LASI\t\t\tRASI\t\t", "\t\tX1\tY1\tZ1\tX2\tY2\tZ2", ""]
    return "\n".join([*head, *(f"{k + 1}\t{k / 60}\t1\t2\t3\t4\t5\t6" for k in range(3)), ""])


def nexus(lab):
    devices = [
        "Devices",
        "1000",
        ",,P - Force,,,P - CoP,,",
        "Frame,Sub Frame,Fx,Fy,Fz,Cx,Cy,Cz",
        ",,N,N,N,mm,mm,mm",
    ]
    devices += [f"{f},{k},1,2,700,250,100,0" for f in (1, 2, 3) for k in (0, 1)]
    events = ["", "Events", "100", "Subject,Context,Name,Time (s)", "A,Left,Foot Strike,0.01", ""]
    markers = lab.nexus_section("Trajectories", 100, range(1, 4), {"LASI": np.ones((3, 3))}, "mm")
    return lab.nexus(walk(), more=[*devices, *events, *markers])


def forces():
    names = [f"ground_{what}{axis}" for what in ("force_v", "force_p", "torque_") for axis in "xyz"]
    rows = ["\t".join(map(str, [k / 100, *range(9)])) for k in range(3)]
    return "\n".join(["forces", "inDegrees=yes", "endheader", "\t".join(["time", *names]), *rows, ""])


def torques():
    rows = ["\t".join(map(str, [k / 100, 1, 2])) for k in range(3)]
    return "\n".join(["moments", "endheader", "time\tknee_angle_r_moment\thip_flexion_l_moment", *rows, ""])


def coordinate_csv(folder):
    save_gait(walk(), folder / "walk.mot")
    table = (folder / "walk.mot").read_text().split("endheader\n")[1]
    return table.replace("\t", ",")


def cycle(lab):
    return lab.gcd(normative_gait("free", samples=18))


BIDS = "sub-1_task-w_tracksys-a_"
ONLY_READ = {  # name of the file -> its text and how it is read
    "walk.txt": (None, load_gait),
    "walk.subgait": (lambda lab, folder: subgait(), load_gait),
    "walk.mvnx": (lambda lab, folder: lab.mvnx(walk(), contacts=False), load_gait),
    "walk.gcd": (lambda lab, folder: cycle(lab), load_gait),
    "nexus.csv": (lambda lab, folder: nexus(lab), load_gait),
    "nexus_markers.csv": (lambda lab, folder: nexus(lab), load_markers),
    "nexus_forces.csv": (lambda lab, folder: nexus(lab), load_forces),
    "opencap.csv": (lambda lab, folder: coordinate_csv(folder), load_gait),
    "markers.trc": (lambda lab, folder: trc(), load_markers),
    "forces.mot": (lambda lab, folder: forces(), load_forces),
    "torques.sto": (
        lambda lab, folder: torques(),
        lambda path: load_torques(path, preset="opensim-rajagopal"),
    ),
}
WRITTEN = {  # files of this package
    **{f"walk{e.suffixes[0]}": load_gait for e in FORMATS.values() if e.write},
    **{f"{BIDS}{part}": load_gait for part in ("motion.tsv", "channels.tsv", "motion.json", "events.tsv")},
    "poses.csv": load_poses,
    "c3d_markers.c3d": load_markers,
}
C3D_READERS = ("ezc3d", "c3d")


def write_example(name, folder, lab):
    """An undamaged file of that name, and what must stand beside it."""
    path, make = folder / name, ONLY_READ.get(name, (None,))[0]
    if make:
        path.write_text(make(lab, folder))
    elif name.startswith(BIDS):
        save_gait(walk(), folder / f"{BIDS}motion.tsv")
    elif name == "poses.csv":
        save_poses(Poses(walk().time, walk().base, dict.fromkeys(FEET, walk().base)), path)
    elif name == "walk.txt":  # somebody's table
        save_gait(walk(), path.with_suffix(".tsv"))
        lines = path.with_suffix(".tsv").read_text().splitlines()
        path.write_text("\n".join(line for line in lines if not line.startswith("#")))
    else:
        save_gait(walk(), path)
    return path


def attempt(read, path):
    try:
        return read(path), ""
    except FormatError as error:
        return None, str(error)


def check_plausible(found):
    """What was read is no damaged number."""
    if isinstance(found, Gait):
        assert np.abs(found.q).max() <= LARGEST["angle"]
        assert found.base is None or np.abs(found.base[:, :3, 3]).max() <= LARGEST["place"]
    elif isinstance(found, Markers):
        assert not (np.abs(found.position) > LARGEST["place"]).any()
        check_plausible(found.plates)
    elif isinstance(found, tuple):
        assert all(np.abs(plate.force).max() <= LARGEST["force"] for plate in found)


@pytest.mark.parametrize("name", [*ONLY_READ, *WRITTEN, *(f"walk.c3d by {reader}" for reader in C3D_READERS)])
def test_damaged_files_are_read_or_refused_but_never_crash(tmp_path_factory, lab, monkeypatch, name):
    """EXO_PIN_MUTATIONS=5000 tries as many of each kind (C3D: a fifth)."""
    folder = tmp_path_factory.mktemp("fuzz")
    name, _, reader = name.partition(" by ")
    read = WRITTEN[name] if name in WRITTEN else ONLY_READ[name][1]
    if reader:
        read = lambda path: load_gait(C3dFile(path, read_content(path, (reader,))))  # noqa: E731
    path = write_example(name, folder, lab)
    entry = folder / f"{BIDS}motion.tsv" if name.startswith(BIDS) else path
    again = folder / ("again.csv" if read is not load_poses else "poses_again.csv")
    whole = path.read_bytes()
    read(entry)

    @settings(max_examples=FILES_C3D if name.endswith(".c3d") else FILES, deadline=None)
    @given(damaged(whole, PIECES))
    def once(data):
        path.write_bytes(data)
        start = time.process_time()
        result, message = attempt(read, entry)
        assert time.process_time() - start < SLOWEST
        if result is None:
            assert folder.name in message
            assert "\n" not in message
            assert len(message) < 1000
            return
        check_plausible(result)
        if isinstance(result, Gait):
            save_gait(result, again)  # what was read can be written
        elif isinstance(result, Poses):
            save_poses(result, again)

    once()
